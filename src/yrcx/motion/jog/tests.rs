use std::time::Duration;

use crate::testing::{Bench, Reply, Scripted, answer, run_on};
use armctl_controller::yrcx::image::Words;
use armctl_frame::failure::Kind;

const REST: u16 = 0x0041;
const HELD: u16 = 0x0001;
const JOG: [&str; 4] = ["jog", "pulse", "1", "-"];
const TWO_SECONDS: [&str; 6] = ["jog", "pulse", "1", "-", "--for", "2s"];

fn ends(scans: u32, head: &[u16]) -> Reply {
    let mut words: Words = [0; 16];
    words[..head.len()].copy_from_slice(head);
    Reply::AddressPair(scans, words)
}

#[test]
fn jog_runs_for_its_time_and_reports_its_position() {
    let (outcome, peer) = run_on(Scripted::new([Reply::UntilStop(answer("4.2.6-pulse"))]), &TWO_SECONDS);
    let report = outcome.unwrap();
    assert_eq!(report["position"]["text"], "--pulse 12345,-123,2000,0");
    let elapsed = report["elapsed_ms"].as_u64().unwrap();
    assert!((2000..2030).contains(&elapsed), "{elapsed} ms");
    assert_eq!(peer.bits, [REST, HELD, REST]);
    assert_eq!(peer.taken.len(), 1);
}

#[test]
fn interrupt_ends_the_jog_and_reports_its_position() {
    for ms in [100, 500, 60_000] {
        let mut bench = Bench::new(Scripted::new([Reply::UntilStop(answer("4.2.6-cartesian"))]));
        bench.interrupt(&["jog", "cartesian", "1", "-"], Duration::from_millis(ms));
        let told = bench.halt().unwrap();
        assert!(told.ends_with("on again; position: 12.345, -0.123, 2.000, 0.000 mm"), "{told}");
        assert_eq!(bench.into_peer().bits, [REST, HELD, REST]);
    }
}

#[test]
fn on_interrupt_leave_still_stops_a_jog() {
    use crate::link::Yrcx;
    use armctl_frame::Family as _;

    let mut bench = Bench::new(Scripted::new([Reply::UntilStop(answer("4.2.6-pulse"))]));
    bench.interrupt(&JOG, Duration::from_secs(1));
    assert!(Yrcx::needs_halt(&bench.link));
    bench.halt().unwrap();
    let mut bench = Bench::new(Scripted::new([ends(u32::MAX, &[0])]));
    bench.interrupt(&["move", "--point", "1"], Duration::from_secs(1));
    assert!(!Yrcx::needs_halt(&bench.link));
}

#[test]
fn reports_a_jog_that_ended_by_itself() {
    // A soft limit ends the jog.
    let (outcome, peer) = run_on(Scripted::new([ends(100, &[0x4000, 2, 334])]), &TWO_SECONDS);
    let failure = outcome.unwrap_err();
    assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Refused, Some("2.334")));
    assert_eq!(peer.bits, [REST]);
    // Another client ends the jog by the stop input.
    let (outcome, _) = run_on(Scripted::new([Reply::AddressPair(100, answer("4.2.6-pulse"))]), &TWO_SECONDS);
    assert_eq!(outcome.unwrap_err().code.as_deref(), Some("12.400"));
    // The jog ends with the normal reply of the manual.
    let (outcome, _) = run_on(Scripted::new([ends(100, &[0x0200, 0, 0, 0, 5])]), &TWO_SECONDS);
    assert_eq!(outcome.unwrap()["position"]["joints"][0]["pulses"], 5);
}

#[test]
fn stop_input_stays_off_if_the_jog_does_not_end() {
    let stays = |reply: Reply, line: &[&str]| {
        let (outcome, peer) = run_on(Scripted::new([reply]), line);
        let failure = outcome.unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown, "{failure}");
        assert!(failure.message.contains("the stop input SI(06) stays off"), "{failure}");
        assert_eq!(peer.bits, [REST, HELD]);
    };
    // The axis does not stop when the stop input is off.
    stays(ends(u32::MAX, &[0]), &TWO_SECONDS);
    // The controller does not accept the command, or stops reporting that it runs.
    stays(Reply::Ignores, &JOG);
    stays(ends(20, &[0]), &JOG);
    // The controller reports an invalid status.
    stays(ends(20, &[0x1234]), &JOG);
}

#[test]
fn stops_a_jog_sent_as_raw_words() {
    let (outcome, peer) = run_on(Scripted::new([ends(20, &[0])]), &["raw", "--wi", "0x20,0,0x81"]);
    assert!(outcome.unwrap_err().message.contains("the stop input SI(06) stays off"));
    assert_eq!(peer.bits, [REST, HELD]);
    let mut bench = Bench::new(Scripted::new([Reply::UntilStop(answer("4.2.6-pulse"))]));
    bench.interrupt(&["raw", "--wi", "0x20,0,0x81"], Duration::from_secs(1));
    assert!(bench.halt().unwrap().starts_with("the robot was stopped"));
}

#[test]
fn closing_the_link_stops_the_jog() {
    let mut bench = Bench::new(Scripted::new([Reply::UntilStop(answer("4.2.6-pulse"))]));
    bench.interrupt(&JOG, Duration::from_secs(1));
    assert_eq!(bench.into_peer().bits, [REST, HELD, REST]);
}

#[test]
fn lost_link_restarts_with_the_stop_input_off() {
    let mut bench = Bench::new(Scripted::new([Reply::Loses(20, Duration::from_secs(1)), ends(0, &[0x0200])]));
    let failure = bench.run(&JOG).unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(failure.message.contains("the connection is up again, and the stop input SI(06) is off"), "{failure}");
    bench.run(&["alarm", "reset"]).unwrap();
    assert_eq!(bench.peer(|peer| peer.bits.clone()), [REST, HELD]);
    bench.run(&["io", "set", "stop=on"]).unwrap();
    assert_eq!(bench.into_peer().bits, [REST, HELD, REST]);
}

#[test]
fn makes_no_statement_about_the_stop_input_without_a_link() {
    let mut bench = Bench::new(Scripted::new([Reply::Loses(20, Duration::from_secs(3600))]));
    let failure = bench.run(&JOG).unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(failure.message.ends_with("the connection was lost; the connection is still down"), "{failure}");
}

use crate::prelude::*;
use crate::testing::{Bench, Reply, Scripted, run_on};
use armctl_controller::yrcx::image::Words;

fn words(head: &[u16]) -> Words {
    let mut words = [0; 16];
    words[..head.len()].copy_from_slice(head);
    words
}

fn ends(scans: u32, head: &[u16]) -> Reply {
    Reply::AddressPair(scans, words(head))
}

const MOVE: &[&str] = &["move", "--point", "19", "--speed", "50"];
const STOPPED: &[u16] = &[0x4000, 12, 400];
/// Word of the dedicated inputs in the resting image: the emergency-stop input and the stop input are on. In `HELD`,
/// the stop input is off.
const REST: u16 = 0x0041;
const HELD: u16 = 0x0001;

#[test]
fn a_motion_is_awaited_and_reported() {
    let (moved, peer) =
        run_on(Scripted::new([ends(100, &[0x0200, 0, 0, 0, 0x3039])]), &[MOVE, &["--report", "mm"]].concat());
    let moved = moved.unwrap();
    let elapsed = moved["elapsed_ms"].as_u64().unwrap();
    assert!((500..520).contains(&elapsed), "100 scans of 5 ms take {elapsed} ms");
    assert_eq!(moved["position"]["x_mm"], 12.345);
    assert_eq!(peer.taken, [words(&[1, 0x8004, 0, 50, 19])]);
    assert_eq!(peer.bits, [REST]);
}

#[test]
fn accepts_a_short_command_without_run_status() {
    let (reset, peer) = run_on(Scripted::new([ends(0, &[0x0200])]), &["alarm", "reset"]);
    assert_eq!(reset.unwrap()["alarm"], false);
    assert_eq!(peer.taken, [words(&[0x0604])]);
}

#[test]
fn an_alarm_is_a_refusal_with_its_code() {
    let (moved, _) = run_on(Scripted::new([ends(3, &[0x4000, 2, 334])]), MOVE);
    let failure = moved.unwrap_err();
    assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Refused, Some("2.334")));
}

#[test]
fn one_command_after_the_other_over_one_link() {
    let mut bench = Bench::new(Scripted::new([ends(0, &[0x0200]), ends(9, &[0x4000, 12, 600]), ends(1, &[0x0200])]));
    bench.run(&["alarm", "reset"]).unwrap();
    assert_eq!(bench.run(&["shift", "select", "1"]).unwrap_err().code.as_deref(), Some("12.600"));
    bench.run(&["motor", "on"]).unwrap();
    let peer = bench.into_peer();
    assert_eq!(peer.taken, [words(&[0x604]), words(&[0x3B, 0, 1]), words(&[0x42])]);
    assert_eq!(peer.image.0[0], 0, "the status was reset each time");
}

#[test]
fn a_command_left_over_by_another_master_is_reset_first() {
    let mut scripted = Scripted::new([ends(0, &[0x0200])]);
    scripted.image.0[0] = 0x4000;
    let (reset, peer) = run_on(scripted, &["alarm", "reset"]);
    reset.unwrap();
    assert_eq!(peer.taken.len(), 1);
}

#[test]
fn repeats_reads_but_not_changes_after_a_loss() {
    let gone = Duration::from_millis(300);
    let lost = || Reply::Loses(1, gone);
    let answer = ends(1, &[0x0200, 0, 1, 1, 1, 9, 9, 9]);
    let (servos, peer) = run_on(Scripted::new([lost(), answer.clone()]), &["info", "servo"]);
    assert_eq!((servos.unwrap()["axes"].as_array().unwrap().len(), peer.taken.len()), (3, 2));
    for line in [MOVE, &["alarm", "reset"], &["motor", "on"]] {
        let (outcome, peer) = run_on(Scripted::new([lost(), answer.clone()]), line);
        let failure = outcome.unwrap_err();
        assert_eq!((failure.kind, peer.taken.len()), (Kind::OutcomeUnknown, 1), "{line:?}");
        assert!(failure.message.contains("the connection was lost"), "{failure}");
        assert!(failure.hint.is_some());
    }
}

#[test]
fn link_continues_at_rest_after_a_loss() {
    let mut bench = Bench::new(Scripted::new([Reply::Loses(1, Duration::from_secs(1)), ends(0, &[0x0200])]));
    assert_eq!(bench.run(MOVE).unwrap_err().kind, Kind::OutcomeUnknown);
    bench.run(&["alarm", "reset"]).unwrap();
    assert_eq!(bench.into_peer().taken.len(), 2);
}

#[test]
fn reports_a_controller_that_accepts_no_command() {
    let (servos, peer) = run_on(Scripted::new([]), &["info", "servo"]);
    let failure = servos.unwrap_err();
    assert_eq!(failure.kind, Kind::NoAnswer);
    assert!(failure.message.contains("did not start the command"), "{failure}");
    assert!(!peer.taken.is_empty());
    let (moved, _) = run_on(Scripted::new([]), MOVE);
    assert_eq!(moved.unwrap_err().kind, Kind::OutcomeUnknown);
}

#[test]
fn interrupt_stops_the_motion_and_restores_the_stop_input() {
    let mut bench = Bench::new(Scripted::new([Reply::UntilStop(words(STOPPED)), ends(0, &[0x0200])]));
    bench.interrupt(MOVE, Duration::from_secs(2));
    assert_eq!(bench.halt().unwrap(), "the robot was stopped by the stop input SI(06), which is on again");
    bench.run(&["alarm", "reset"]).unwrap();
    let peer = bench.into_peer();
    assert_eq!(peer.bits, [REST, HELD, REST]);
    assert_eq!(peer.taken.len(), 2, "the motion was sent once");
}

#[test]
fn interrupt_reports_an_unobserved_end() {
    let mut bench = Bench::new(Scripted::new([ends(u32::MAX, &[0])]));
    bench.interrupt(MOVE, Duration::from_secs(2));
    let failure = bench.halt().unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(failure.message.contains("SI(06) stays off"), "{failure}");
    assert_eq!(bench.into_peer().bits, [REST, HELD], "it is not released while the robot may move");
}

#[test]
fn interrupt_before_the_command_sends_nothing() {
    let mut bench = Bench::new(Scripted::new([]));
    assert_eq!(bench.halt().unwrap(), "no motion command was sent");
    assert_eq!(bench.into_peer().bits, [REST]);
}

#[test]
fn a_program_that_was_started_is_stopped_by_an_interrupt() {
    let mut bench = Bench::new(Scripted::new([]));
    bench.run(&["run"]).unwrap();
    bench.halt().unwrap();
    let peer = bench.into_peer();
    assert_eq!(peer.bits, [REST, REST | 1 << 10, REST, HELD, REST]);
}

#[test]
fn signals_are_switched_while_a_command_runs() {
    let mut bench = Bench::new(Scripted::new([ends(200, &[0x0200]), ends(0, &[0x0200])]));
    let begun = bench.run(&[MOVE, &["--no-wait"]].concat()).unwrap();
    assert_eq!((&begun["reached"], &begun["elapsed_ms"]), (&Value::Null, &Value::Null));
    let switched = bench.run(&["io", "set", "20=on"]).unwrap();
    let item = &switched["items"][0];
    assert_eq!((&item["name"], &item["old"], &item["new"]), (&json!("SI(20)"), &json!(false), &json!(true)));
    let busy = bench.run(&["alarm", "reset"]).unwrap_err();
    assert!(busy.message.contains("move-ptp still runs"), "{busy}");
    bench.runtime.block_on(async { tokio::time::sleep(Duration::from_secs(2)).await });
    // The client notices that the command has ended, and sends the next command.
    bench.run(&["alarm", "reset"]).unwrap();
    assert_eq!(bench.into_peer().taken.len(), 2);
}

#[test]
fn distinguishes_the_ends_of_consecutive_commands() {
    let mut bench = Bench::new(Scripted::new([ends(10, &[0x4000, 2, 334]), ends(0, &[0x0200])]));
    bench.run(&[MOVE, &["--no-wait"]].concat()).unwrap();
    // The command ends during the pulse.
    bench.run(&["io", "pulse", "20"]).unwrap();
    bench.run(&["alarm", "reset"]).unwrap();
    assert_eq!(bench.into_peer().taken.len(), 2);
}

#[test]
fn procedure_switches_and_confirms_signals() {
    let (done, peer) = run_on(Scripted::new([]), &["power-on"]);
    assert!(done.unwrap()["elapsed_ms"].as_u64().unwrap() >= 100);
    assert_eq!(peer.bits, [REST, REST | 1 << 1, REST]);
}

#[test]
fn sends_only_granted_commands() {
    let mut bench = Bench::grant(Scripted::new([]), Risk::Read);
    for line in [MOVE, &["alarm", "reset"], &["run"], &["io", "set", "20=on"]] {
        let failure = bench.run(line).unwrap_err();
        assert_eq!(failure.kind, Kind::Local, "{line:?}");
    }
    let peer = bench.into_peer();
    assert!(peer.taken.is_empty() && peer.bits == [REST]);
}

#[test]
fn a_watch_begins_with_the_state() {
    let mut bench = Bench::new(Scripted::new([]));
    let first = bench.run(&["io", "watch", "servo-on", "20"]).unwrap();
    let told = first["changes"].as_array().unwrap().iter().map(|change| (&change["name"], &change["old"]));
    assert_eq!(told.collect::<Vec<_>>(), [(&json!("servo-on"), &json!(null)), (&json!("SO(20)"), &json!(null))]);
    assert_eq!(first["items"][1]["name"], "SO(20)");
}

#[test]
fn status_combines_signals_servos_and_position() {
    let servos = ends(1, &[0x0200, 0, 1, 1, 0, 9, 9, 9]);
    let position = ends(1, &[0x0200, 0, 0, 0, 0x2710, 0, 0xD8F0, 0xFFFF]);
    let (status, peer) = run_on(Scripted::new([servos, position]), &["status"]);
    let status = status.unwrap();
    assert_eq!((&status["mode"], &status["emergency_stop"]), (&"automatic".into(), &false.into()));
    assert_eq!((&status["servos"][2]["state"], &status["joints"][1]["mm"]), (&"brake".into(), &(-10.0).into()));
    assert_eq!(peer.taken, [words(&[0x503]), words(&[0x506])]);
}

#[test]
fn compact_image_supports_signals_only() {
    let mut bench = Bench::signals_alone(Scripted::new([]));
    for line in [&["info", "servo"][..], &["move", "--point", "19"], &["raw", "--wi", "0x604"]] {
        let failure = bench.run(line).unwrap_err();
        assert_eq!(failure.kind, Kind::Rejected, "{line:?}: {failure}");
        assert!(failure.message.contains("Compact"), "{failure}");
    }
    let at_rest = bench.peer(|peer| (peer.taken.clone(), peer.bits.clone()));
    assert_eq!(at_rest, (vec![], vec![0x0041]), "SI(00) and SI(06) on, from the first image on");
    bench.run(&["run"]).unwrap();
    bench.run(&["stop"]).unwrap();
    assert_eq!(bench.run(&["io", "get", "SO1"]).unwrap()["items"][0]["value"], true);
    let peer = bench.into_peer();
    assert!(peer.taken.is_empty() && peer.bits.len() > 3, "{:?}", peer.bits);
}

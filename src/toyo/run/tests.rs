//! Tests of `toyo run` on simulators in virtual time.

use super::*;
use crate::testing::{Bench, Fault};

/// A program that waits half a second, and then moves 100 mm at 100 mm/s.
const PROGRAM: &str = "origin = true\nspeeds = { 1 = 100.0 }\npoints = { 1 = { 1 = [100.0, 0.0, 0.0, 0.0] } }\n\
    steps = { 1 = [\"TIM TM=000.5\", \"MOVP a PT=001 CN=00 S V=01 POST\", \"OUT STN=0 PN01=.......1\", \"END\"] }\n";

#[test]
fn run_with_wait_ends_with_the_program() {
    let (mut bench, received) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
    let data = bench.data(&["run", "sequential", "1", "--wait"]);
    assert_eq!((&data["state"], &data["position"]["x_mm"]), (&"ended".into(), &100.0.into()));
    let elapsed = data["elapsed_ms"].as_u64().unwrap();
    assert!((1600..2000).contains(&elapsed), "{elapsed}");
    assert_eq!(received.borrow().iter().filter(|block| block.starts_with("@SPST")).count(), 1);
}

#[test]
fn a_program_that_never_shows_execution_has_an_unknown_outcome() {
    let state = "origin = true\nsteps = { 1 = [\"OUT STN=0 PN01=.......1\", \"END\"] }\n";
    let failure = Bench::with_faults(state, |_, _| Fault::None).0.run(&["run", "sequential", "--wait"]).unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(
        failure.message.contains("the status never showed that the controller executed the command"),
        "{}",
        failure.message
    );
}

#[test]
fn a_stop_instruction_holds_the_program_and_an_external_stop_fails() {
    let state = "origin = true\nsteps = { 1 = [\"NOP\", \"STOP\", \"NOP\", \"TIM TM=010.0\", \"END\"] }\n\
        [[event]]\nat_ms = 3000\ndo = \"stop\"\n";
    let (mut bench, _) = Bench::with_faults(state, |_, _| Fault::None);
    let data = bench.data(&["run", "sequential", "1", "--wait"]);
    assert_eq!((&data["state"], &data["step"]), (&"held".into(), &3.into()));
    let failure = bench.run(&["run", "sequential", "--wait"]).unwrap_err();
    assert_eq!(failure.kind, Kind::ConditionNotMet);
    assert!(failure.message.contains("the program was stopped at step 4 (TIM TM=010.0)"), "{}", failure.message);
}

#[test]
fn in_step_mode_the_wait_ends_after_one_step() {
    let (mut bench, _) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
    bench.data(&["mode", "step"]);
    assert_eq!(bench.data(&["run", "sequential", "1", "--wait"])["state"], "held");
}

#[test]
fn an_error_during_the_program_fails() {
    let state = format!("{PROGRAM}[[event]]\nat_ms = 1000\ndo = \"estop\"\n");
    let failure =
        Bench::with_faults(&state, |_, _| Fault::None).0.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
    assert_eq!((failure.kind, failure.code.as_deref()), (Kind::ConditionNotMet, Some("13")));
    assert!(
        failure
            .message
            .starts_with("the start was accepted, but an error occurred (13: emergency stop); the axes are at X "),
        "{}",
        failure.message
    );
    assert!(failure.hint.unwrap().contains("toyo alarm reset"));
}

#[test]
fn a_refused_start_names_the_missing_condition_and_changes_nothing() {
    let refused = |state: &str| {
        let (mut bench, received) = Bench::with_faults(state, |_, _| Fault::None);
        let failure = bench.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
        assert_eq!(failure.kind, Kind::Refused);
        let changes = ["@MAUT", "@SVON", "@HOME", "@CERR", "@MSEQ"];
        assert!(!received.borrow().iter().any(|block| changes.contains(&block.as_str())), "{received:?}");
        failure.message
    };
    assert!(refused(&format!("mode = \"program\"\n{PROGRAM}")).ends_with("the controller is in program mode"));
    assert!(refused(&format!("palletizing = true\n{PROGRAM}")).ends_with("the controller is in palletizing mode"));
    assert!(refused(&format!("error = \"A1\"\n{PROGRAM}")).ends_with("error A1: tag undefined"));
    assert!(refused(&format!("pendant = true\n{PROGRAM}")).contains("the teach pendant is ON"));
}

#[test]
fn an_unanswered_start_is_sent_once() {
    for fault in [Fault::Lost, Fault::Unanswered, Fault::Answered("@O")] {
        let (mut bench, received) =
            Bench::with_faults(PROGRAM, move |block, _| if block.starts_with("@SPST") { fault } else { Fault::None });
        let failure = bench.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
        assert_eq!(failure.kind, Kind::OutcomeUnknown, "{fault:?}");
        assert!(failure.hint.unwrap().contains("`toyo status`"));
        assert_eq!(received.borrow().iter().filter(|block| block.starts_with("@SPST")).count(), 1);
    }
}

#[test]
fn after_a_lost_connection_the_outcome_is_unknown() {
    let lost = |block: &str, count| if block == "@STAS SNO=0" && count > 2 { Fault::Lost } else { Fault::None };
    let failure = Bench::with_faults(PROGRAM, lost).0.run(&["run", "sequential", "1", "--wait"]).unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(failure.message.starts_with("the start was accepted, but its result is unknown: "), "{}", failure.message);
    assert!(
        failure.hint.unwrap().starts_with("do not send the command again; keep clear of the robot; use `toyo status`")
    );
}

#[test]
fn a_refused_status_read_is_repeated() {
    let busy = |block: &str, count| {
        if block == "@STAS SNO=0" && count % 2 == 0 { Fault::Answered("@NG") } else { Fault::None }
    };
    assert_eq!(
        Bench::with_faults(PROGRAM, busy).0.data(&["run", "sequential", "1", "--wait"])["position"]["x_mm"],
        100.0
    );
}

#[test]
fn ctrl_c_stops_what_runs() {
    for (words, state) in
        [(&["run", "sequential", "1", "--wait"][..], PROGRAM), (&["home"], "position = [300.0, 0.0, 0.0, 0.0]\n")]
    {
        for ms in (200..1400).step_by(170) {
            let (mut bench, received) = Bench::with_faults(state, |_, _| Fault::None);
            let message = bench.run_and_interrupt(words, Duration::from_millis(ms)).unwrap();
            assert!(
                message.starts_with("the robot was stopped (@STOP); the axes are at X "),
                "{words:?} {ms}: {message}"
            );
            assert!(received.borrow().iter().any(|block| block == "@STOP"));
            let position = bench.data(&["position"]);
            bench.wait(Duration::from_secs(10));
            assert_eq!(bench.data(&["position"]), position, "{words:?} {ms}");
            assert_eq!(bench.data(&["status"])["running"], false);
        }
    }
}

#[test]
fn a_late_ok_to_the_start_does_not_confirm_the_stop() {
    // The start is answered after 400 ms. Ctrl-C comes before the answer, and the first stop is lost.
    let (mut bench, received) = Bench::with_faults(PROGRAM, |block, count| match block {
        "@SPST 0001" => Fault::Late(Duration::from_millis(400)),
        "@STOP" if count == 1 => Fault::Lost,
        _ => Fault::None,
    });
    bench.run_and_interrupt(&["run", "sequential", "1", "--wait"], Duration::from_millis(250)).unwrap();
    assert!(received.borrow().iter().filter(|block| *block == "@STOP").count() >= 2);
    assert_eq!(bench.data(&["status"])["running"], false);
}

#[test]
fn on_interrupt_leave_still_stops_a_jog() {
    let must_halt = |words: &[&str]| {
        let (mut bench, _) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
        bench.run_and_abandon(words, Duration::from_millis(450))
    };
    assert!(!must_halt(&["run", "sequential", "1", "--wait"]));
    assert!(must_halt(&["jog", "X", "+", "low", "--for", "5s"]));
}

#[test]
fn the_host_is_released_while_a_program_runs() {
    let (mut bench, received) = Bench::with_faults(PROGRAM, |_, _| Fault::None);
    assert_eq!(bench.data(&["run", "sequential", "1", "--no-wait"])["state"], "running");
    bench.close().unwrap();
    assert_eq!(received.borrow().last().unwrap(), "@HSOF");
}

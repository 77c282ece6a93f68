use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::*;
use crate::testing::{Bench, Fault, ReceivedBlocks};

const LOW: [&str; 6] = ["jog", "X", "+", "low", "--for", "500ms"];
const STOP: &str = "@JGST X=SP Y=SP Z=SP R=SP";
const GO: &str = "@JGST X=+L Y=SP Z=SP R=SP";
const READY: &str = "origin = true\n";

fn count(received: &ReceivedBlocks, block: &str) -> usize {
    received.borrow().iter().filter(|received| *received == block).count()
}

/// Asserts that the last block that moves an axis is followed by the stop.
#[track_caller]
fn assert_stop_is_last(received: &ReceivedBlocks) {
    let received = received.borrow();
    let moved_mm = received.iter().rposition(|block| block.contains("=+") || block.contains("=-"));
    let stopped = received.iter().rposition(|block| block == STOP);
    assert!(moved_mm.is_some() && moved_mm < stopped, "{received:#?}");
}

#[test]
fn an_axis_moves_for_its_time() {
    let (mut bench, received) = Bench::with_faults(READY, |_, _| Fault::None);
    let data = bench.data(&LOW);
    // The axis moves at 10 mm/s for half a second, with ramps of 0.1 s at both ends.
    let moved_mm = data["moved_mm"].as_f64().unwrap();
    assert!((4.9..5.2).contains(&moved_mm), "{data}");
    assert_eq!(data["position"]["x_mm"], data["moved_mm"]);
    assert_eq!(count(&received, GO), 1);
    assert_stop_is_last(&received);
}

#[test]
fn inching_steps_are_sent_one_by_one() {
    let (mut bench, received) = Bench::with_faults(READY, |_, _| Fault::None);
    let data = bench.data(&["jog", "y", "-", "inch", "--steps", "3"]);
    assert_eq!((&data["moved_mm"], &data["steps"]), (&(-0.03).into(), &3.into()));
    assert_eq!(count(&received, "@JGST X=SP Y=-C Z=SP R=SP"), 3);
    assert_stop_is_last(&received);

    let (mut bench, received) = Bench::with_faults(
        "origin = true\nwrite = [\"WPAR P12 AX1=00.00 AX2=00.01 AX3=00.01 AX4=00.01\"]\n",
        |_, _| Fault::None,
    );
    let failure = bench.run(&["jog", "x", "+", "inch", "--steps", "3"]).unwrap_err();
    assert!(
        failure.message.starts_with(
            "step 1 of 3: the controller accepted the step, but the axis did not move; the axis was stopped"
        )
    );
    assert_eq!(count(&received, "@JGST X=+C Y=SP Z=SP R=SP"), 1);
    assert_stop_is_last(&received);
}

/// Result of `LOW` if this fault occurs. The stop must be sent, and the axis must be at rest.
#[track_caller]
fn with_faults(
    fault: impl FnMut(&str, usize) -> Fault + Send + 'static,
) -> (Result<serde_json::Value>, ReceivedBlocks, f64) {
    let (mut bench, received) = Bench::with_faults(READY, fault);
    let outcome = bench.run(&LOW).map(|(data, _)| data);
    assert_stop_is_last(&received);
    assert_eq!(count(&received, GO), 1, "what moves is sent once");
    let place = |bench: &mut Bench| bench.data(&["position"])["positions"][0]["x_mm"].as_f64().unwrap();
    let position = place(&mut bench);
    bench.wait(Duration::from_secs(60));
    assert!((place(&mut bench) - position).abs() < 1e-9, "it stands");
    (outcome, received, position)
}

#[test]
fn an_unanswered_jog_is_sent_once_and_stopped() {
    let (outcome, _, moved_mm) = with_faults(|block, _| if block == GO { Fault::Unanswered } else { Fault::None });
    let failure = outcome.unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(failure.hint.unwrap().contains("toyo stop --jog"));
    assert!(failure.message.contains("the axis was stopped at X "), "{}", failure.message);
    assert!((2.0..4.0).contains(&moved_mm), "a silence of 300 ms ends it: {moved_mm} mm");

    let (outcome, _, moved_mm) = with_faults(|block, _| if block == GO { Fault::Lost } else { Fault::None });
    assert_eq!((outcome.unwrap_err().kind, moved_mm), (Kind::OutcomeUnknown, 0.0));
}

#[test]
fn a_lost_answer_during_a_jog_stops_the_axis() {
    for lost in ["@STAS SNO=0", "@MPST"] {
        for fault in [Fault::Lost, Fault::Unanswered, Fault::Late(Duration::from_millis(700))] {
            let (outcome, _, moved_mm) =
                with_faults(move |block, count| if block == lost && count == 2 { fault } else { Fault::None });
            let failure = outcome.unwrap_err();
            assert_eq!(failure.kind, Kind::NoAnswer, "{lost} {fault:?}");
            assert!((2.0..5.0).contains(&moved_mm), "{lost} {fault:?}: {moved_mm} mm");
        }
    }
}

#[test]
fn an_unconfirmed_stop_is_repeated() {
    let late = Fault::Late(Duration::from_millis(450));
    for (fault, min_count) in [(Fault::Lost, 4), (Fault::Unanswered, 4), (Fault::Answered("@NG"), 4), (late, 2)] {
        let (outcome, received, moved_mm) =
            with_faults(move |block, count| if block == STOP && count <= 3 { fault } else { Fault::None });
        assert!(outcome.is_ok(), "{fault:?}: {outcome:?}");
        assert!(count(&received, STOP) >= min_count, "{fault:?}: {received:#?}");
        assert!(moved_mm < 20.0, "{fault:?}: {moved_mm} mm");
    }
}

#[test]
fn a_lost_line_has_a_hint_to_press_the_emergency_stop() {
    let dead = Arc::new(AtomicBool::new(false));
    let is_dead = Arc::clone(&dead);
    let (mut bench, received) = Bench::with_faults(READY, move |block, _| {
        let fault = if is_dead.load(Relaxed) { Fault::Lost } else { Fault::None };
        is_dead.fetch_or(block == GO, Relaxed);
        fault
    });
    let failure = bench.run(&LOW).unwrap_err();
    assert_eq!(failure.kind, Kind::OutcomeUnknown);
    assert!(
        failure.message.contains("the axis can still move: it is unknown whether the robot stopped"),
        "{}",
        failure.message
    );
    let hint = failure.hint.unwrap();
    assert!(hint.starts_with("press the emergency stop") && hint.contains("`toyo stop --jog`"), "{hint}");
    assert!(count(&received, STOP) > 10);
    assert_stop_is_last(&received);
    // Now the line works again.
    dead.store(false, Relaxed);
    assert!(bench.data(&["stop", "--jog"])["position"]["x_mm"].as_f64().unwrap() > 20.0);
    assert_eq!(bench.data(&["status"])["running"], false);
}

#[test]
fn a_controller_that_does_not_stop_is_an_error() {
    let (mut bench, received) =
        Bench::with_faults(READY, |block, _| if block == STOP { Fault::Answered("@OK") } else { Fault::None });
    let failure = bench.run(&LOW).unwrap_err();
    assert_eq!(failure.kind, Kind::ConditionNotMet);
    assert!(failure.message.contains("can still move: the controller answered @OK, but the robot still moves"));
    assert!(failure.hint.unwrap().starts_with("press the emergency stop"));
    assert_stop_is_last(&received);
}

#[test]
fn a_refused_jog_is_explained_and_still_stopped() {
    let (mut bench, received) = Bench::with_faults("servo = false\n", |_, _| Fault::None);
    let failure = bench.run(&LOW).unwrap_err();
    assert_eq!(failure.message, "the controller refused JGST X=+L Y=SP Z=SP R=SP (@NG): servo power is off");
    assert_stop_is_last(&received);
}

#[test]
fn a_controller_error_ends_a_jog() {
    let state = "origin = true\nposition = [998.0, 0.0, 0.0, 0.0]\n";
    let (mut bench, received) = Bench::with_faults(state, |_, _| Fault::None);
    let failure = bench.run(&LOW).unwrap_err();
    assert_eq!((failure.kind, failure.code.as_deref()), (Kind::ConditionNotMet, Some("28")));
    assert!(
        failure
            .message
            .starts_with("an error occurred (28: axis 1: beyond the plus soft limit while moving); the axis")
    );
    assert_stop_is_last(&received);
}

#[test]
fn ctrl_c_at_any_moment_stops_the_axis() {
    for ms in (0..600).step_by(19) {
        let (mut bench, received) = Bench::with_faults(READY, |_, _| Fault::None);
        let message = bench.run_and_interrupt(&LOW, Duration::from_millis(ms)).unwrap();
        let has_moved = count(&received, GO) > 0 || message.starts_with("the robot was stopped");
        if has_moved {
            assert_stop_is_last(&received);
            assert!(message.contains("the axes are at X "), "{ms}: {message}");
        }
        let position = bench.data(&["position"]);
        bench.wait(Duration::from_secs(10));
        assert_eq!(bench.data(&["position"]), position, "{ms}");
    }
}

#[test]
fn an_unanswered_inching_step_is_not_repeated() {
    let step = "@JGST X=+C Y=SP Z=SP R=SP";
    let (mut bench, received) =
        Bench::with_faults(
            READY,
            move |block, count| {
                if block == step && count == 2 { Fault::Unanswered } else { Fault::None }
            },
        );
    let failure = bench.run(&["jog", "X", "+", "inch", "--steps", "5"]).unwrap_err();
    assert_eq!((failure.kind, count(&received, step)), (Kind::OutcomeUnknown, 2));
    assert!(failure.message.starts_with("step 2 of 5: ") && failure.message.contains("the axis was stopped at X 0.02"));
    assert_stop_is_last(&received);
}

#[test]
fn the_shortest_jog_moves_the_axis() {
    let (mut bench, received) = Bench::with_faults(READY, |_, _| Fault::None);
    let data = bench.data(&["jog", "X", "+", "high", "--for", "100ms"]);
    // 50 mm/s, which the axis reaches after 0.1 s.
    assert!((2.0..8.0).contains(&data["moved_mm"].as_f64().unwrap()), "{data}");
    assert_stop_is_last(&received);
}

#[test]
fn a_refused_jog_does_not_stop_a_running_program() {
    let program = "origin = true\nsteps = { 1 = [\"SPD V=01\", \"MOV a X=+0500.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=01 \
                   POST\", \"END\"] }\n";
    let (mut bench, received) = Bench::with_faults(program, |block, _| {
        if block.contains("=+L") || block == STOP { Fault::Answered("@NG") } else { Fault::None }
    });
    bench.data(&["run", "sequential", "1", "--no-wait"]);
    let failure = bench.run(&LOW).unwrap_err();
    assert_eq!((failure.kind, failure.code.as_deref()), (Kind::Refused, Some("NG")), "{failure}");
    assert!(failure.message.contains("the controller executes a program or command"), "{failure}");
    assert_eq!(count(&received, STOP), 1, "the stop goes out nevertheless");
    assert_eq!(bench.data(&["status"])["running"], true, "what somebody else runs goes on");
    bench.close().unwrap();
    assert_eq!(received.borrow().last().unwrap(), "@HSOF");
}

#[test]
fn a_letter_selects_the_axis_with_this_letter_on_the_machine() {
    let lettered = "origin = true\nwrite = [\"WPAR E01 AX1=X AX2=Z AX3=Y AX4=R\"]\n";
    let (mut bench, received) = Bench::with_faults(lettered, |_, _| Fault::None);
    let data = bench.data(&["jog", "z", "+", "low", "--for", "300ms"]);
    assert_eq!((&data["axis"], &data["axis_number"]), (&"Z".into(), &2.into()));
    assert_eq!(count(&received, "@JGST X=SP Y=+L Z=SP R=SP"), 1);
    assert!(data["position"]["z_mm"].as_f64().unwrap() > 1.0, "{data}");
    let position = bench.data(&["position"]);
    let axes = position["positions"][0]["joints"].as_array().unwrap().iter().map(|joint| joint["axis"].clone());
    assert_eq!(axes.collect::<serde_json::Value>(), serde_json::json!(["X", "Z", "Y", "R"]));
    assert_eq!(bench.data(&["point", "get", "1"])["items"][0]["value"]["joints"][1]["axis"], "Z");

    // Two axes have the same letter, so only the number identifies the axis.
    let twice = "origin = true\nwrite = [\"WPAR E01 AX1=X AX2=X AX3=Z AX4=R\"]\n";
    let (mut bench, received) = Bench::with_faults(twice, |_, _| Fault::None);
    let failure = bench.run(&["jog", "x", "+", "low", "--for", "300ms"]).unwrap_err();
    assert_eq!(failure.message, "the axis of X is unknown: axes 1 to 4 have the letters X, X, Z, R");
    assert!(!received.borrow().iter().any(|block| block.starts_with("@JGST")));
    assert_eq!(bench.data(&["jog", "2", "+", "low", "--for", "300ms"])["axis"], "X");
}

#[test]
fn a_jog_stopped_by_another_client_reports_it() {
    let state = format!("{READY}[[event]]\nat_ms = 1000\ndo = \"stop\"\n");
    let stopped = Bench::with_faults(&state, |_, _| Fault::None).0.run(&["jog", "X", "+", "low", "--for", "10s"]);
    let failure = stopped.unwrap_err();
    assert_eq!(failure.kind, Kind::ConditionNotMet);
    assert!(
        failure.message.starts_with("the axis stopped early: another client stopped it; the axis was stopped"),
        "{failure}"
    );
}

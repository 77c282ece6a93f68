//! Replays of recorded answers, and the state that follows them.

use super::*;
use crate::simulator::recording::{Answers, Recording, Replayable as _, Sample};

/// Answers of a controller to requests.
fn read(start: &str, requests: &[&str]) -> Answers {
    let mut bench = Bench::new(start);
    requests.iter().map(|request| ((*request).to_owned(), bench.ask(request))).collect()
}

/// A simulator that replays a sample each second.
fn replay(samples: impl IntoIterator<Item = Option<Answers>>) -> Bench {
    let samples = (0..).zip(samples).map(|(seconds, answers)| Sample { at: Duration::from_secs(seconds), answers });
    let start = Start::default().with_recording(Recording::new(samples.collect(), None));
    Bench { sim: Simulator::new(start), now: Now::ZERO }
}

const PAGES: [&str; 5] = ["@STAS SNO=0", "@STAS SNO=1", "@STAS SNO=2", "@STAS SNO=3", "@STAS SNO=4"];

#[test]
fn changes_are_checked_in_the_recorded_state() {
    let states = [
        ("host = true", "@OK"),
        ("", "@NG"),
        ("pendant = true", "@NG"),
        ("host = true\nservo = false\nerror = \"28\"\norigin = true", "@NG"),
        ("host = true\nmode = \"step\"", "@OK"),
    ];
    let mut bench = replay(states.map(|(state, _)| Some(read(state, &PAGES))));
    for (state, answer) in states {
        let recorded = PAGES.map(|page| Bench::new(state).ask(page));
        assert_eq!(PAGES.map(|page| bench.ask(page)), recorded, "{state}");
        let state_of = |bench: &Bench| {
            let state = bench.sim.state();
            (state.host, state.servo, state.error, state.origin)
        };
        assert_eq!(state_of(&bench), state_of(&Bench::new(state)), "{state}");
        // A change does not change what was recorded.
        assert_eq!(bench.ask("@HOME"), answer, "{state}");
        bench.ask("@CERR");
        assert_eq!(PAGES.map(|page| bench.ask(page)), recorded, "{state}");
        bench.now += Duration::from_secs(1);
    }
}

#[test]
fn position_and_counters_follow_the_recording() {
    let answers =
        read("origin = true\nposition = [12.5, -3.0, 0.0, 7.0]\ncounters = { 5 = 33 }", &["@MPST", "@MCNT CN=05"]);
    let mut bench = replay([Some(answers.clone())]);
    assert_eq!(bench.ask("@MPST"), answers["@MPST"]);
    assert!(answers.values().all(|answer| answer != "@NG"), "{answers:?}");
    assert_eq!((bench.sim.state().position, bench.sim.counter(5)), ([12.5, -3.0, 0.0, 7.0], Some(33)));
}

#[test]
fn silent_controller_answers_nothing() {
    let mut bench = replay([Some(Answers::new()), None, Some(Answers::new())]);
    for answers in [true, false, true] {
        bench.sim.receive(bench.now, b"@MPST\r\n");
        assert_eq!(bench.sim.transmit(bench.now).is_some(), answers);
        bench.now += Duration::from_secs(1);
    }
}

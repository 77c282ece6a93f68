//! Replays of recorded answers, and the state that follows them.

use super::*;
use crate::simulator::recording::{Answers, Recording, Replayable as _, Sample};
use crate::yrcx::recording::{IMAGE, signals_text, words_text};

/// Signals and answers of a controller.
fn read(start: &str, commands: &[Draft]) -> Answers {
    let mut bench = Bench::new(start);
    let image = (IMAGE.to_owned(), signals_text(bench.simulator.output()));
    let exchange = |command: &Draft| {
        let order = command.clone().build().unwrap();
        bench.begin(order.words());
        (words_text(order.words()), words_text(&bench.end()))
    };
    let exchanges: Vec<_> = commands.iter().map(exchange).collect();
    exchanges.into_iter().chain([image]).collect()
}

/// A simulator that replays a sample each 10 seconds.
fn replay(samples: impl IntoIterator<Item = Option<Answers>>) -> Bench {
    let at = |number: u64| Duration::from_secs(10 * number);
    let samples = (0..).zip(samples).map(|(number, answers)| Sample { at: at(number), answers });
    let start = Start::default().with_recording(Recording::new(samples.collect(), None));
    let mut bench = Bench { simulator: Simulator::new(start), now: Now::ZERO, image: resting() };
    bench.wait(200);
    bench
}

#[test]
fn signals_and_checks_follow_the_recording() {
    let states = ["servo = true", "servo = false\nmode = \"manual\"", "ports = { \"SO2()\" = 129 }", "servo = false"];
    let mut bench = replay(states.map(|state| Some(read(state, &[]))));
    let on = Signal::new(Side::Output, 27).unwrap();
    for (state, (motor, is_auto, port)) in
        states.into_iter().zip([(true, true, false), (false, false, false), (true, true, true), (false, true, false)])
    {
        let signals = [output::SERVO_ON, output::AUTO_MODE, on].map(|signal| bench.is_on(signal));
        assert_eq!(signals, [motor, is_auto, port], "{state}");
        assert_eq!((bench.simulator.world.motor, bench.simulator.world.may_run().is_ok()), (motor, is_auto), "{state}");
        // A change does not change what was recorded.
        bench.pulse(input::SERVO_ON);
        bench.wait(2000);
        assert_eq!(bench.is_on(output::SERVO_ON), motor, "{state}");
        while bench.now.as_secs() % 10 != 1 {
            bench.wait(1000);
        }
    }
}

#[test]
fn remote_command_gets_the_recorded_answer() {
    let commands = [Command::PositionMm.order(), Command::AlarmHistory.order().with(Key::History, 1)];
    let start = "[[robot]]\nposition = [12345, -2000, 0, 500]";
    let answers = read(start, &commands);
    let mut bench = replay([Some(answers.clone())]);
    for command in &commands {
        let order = command.clone().build().unwrap();
        bench.begin(order.words());
        assert_eq!(words_text(&bench.end()), answers[&words_text(order.words())]);
    }
    let other = Command::PositionPulse.order().build().unwrap();
    bench.begin(other.words());
    assert!(matches!(Answer::parse(&other, &bench.end()), Some(Answer::Done(_))), "not recorded");
}

#[test]
fn alarm_follows_the_recording() {
    let history = [Command::AlarmHistory.order().with(Key::History, 1)];
    let mut alarm = Bench::new("servo = true");
    alarm.console("alarm 17.800");
    alarm.wait(200);
    let order = history[0].clone().build().unwrap();
    alarm.begin(order.words());
    let answer = (words_text(order.words()), words_text(&alarm.end()));
    let image = (IMAGE.to_owned(), signals_text(alarm.simulator.output()));
    let mut bench = replay([Some([answer, image].into()), None, Some(read("servo = true", &[]))]);
    assert!(bench.is_on(output::ALARM) && !bench.is_on(output::SERVO_ON));
    assert_eq!(bench.simulator.world.alarms.active().map(|alarm| alarm.to_string()).as_deref(), Some("17.800"));
    assert!(!bench.simulator.is_silent());
    bench.wait(10_000);
    assert!(bench.simulator.is_silent());
    bench.wait(10_000);
    assert!(!bench.simulator.is_silent() && !bench.is_on(output::ALARM));
    assert_eq!(bench.simulator.world.alarms.active(), None);
}

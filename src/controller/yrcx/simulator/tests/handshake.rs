//! The handshake of remote commands (chapter 2, sections 1 and 2).

use super::*;

fn to_19() -> Words {
    words(&[0x0001, 0x0004, 0, 0x0032, 0x0013])
}

#[test]
fn the_walkthrough_of_the_manual() {
    let mut bench = Bench::default();
    bench.begin(&to_19());
    assert_eq!(bench.words(), words(&[0x0100]), "the run status");
    assert_eq!(bench.end(), words(&[0x0200]));
    assert_eq!(bench.steps(1), [150_000, 50_000, 10_000, 45_000]);
}

#[test]
fn a_quick_command_ends_in_the_scan_that_takes_it() {
    let mut bench = Bench::default();
    bench.begin(&words(&[0x0503]));
    assert_eq!(bench.words(), words(&[0x0200, 0, 1, 1, 1, 1, 9, 9]));
    bench.wait(60_000);
    assert_eq!(bench.words()[0], 0x0200, "held as long as the command");
    assert_eq!(bench.simulator.wake(), None, "nothing happens by itself");
}

#[test]
fn the_run_status_can_be_shown_for_quick_commands() {
    let mut seen = [false; 2];
    for seed in 0..20 {
        let start = Start::parse("run_scans = 3").unwrap().with_seed(seed);
        let mut bench = Bench { simulator: Simulator::new(start), now: Now::ZERO, image: resting() };
        bench.begin(&words(&[0x0503]));
        seen[usize::from(bench.words()[0] == 0x0100)] = true;
        assert_eq!(bench.end()[..3], [0x0200, 0, 1]);
    }
    assert_eq!(seen, [true, true]);
}

#[test]
fn accepts_no_command_before_the_status_reset() {
    let mut bench = Bench::default();
    bench.begin(&words(&[0x0503]));
    bench.image.set_command(&words(&[0x0501]));
    bench.wait(50);
    assert_eq!(bench.words()[..3], [0x0200, 0, 1], "still the old answer");
    bench.image.set_command(&[0; 16]);
    bench.wait(5);
    assert_eq!(bench.words(), [0; 16]);
}

#[test]
fn executes_a_withdrawn_command_without_an_answer() {
    let mut bench = Bench::default();
    bench.begin(&to_19());
    bench.image.set_command(&[0; 16]);
    bench.wait(50);
    assert_eq!(bench.words(), words(&[0x0100]), "it still runs");
    bench.wait(5000);
    assert_eq!(bench.words(), [0; 16], "ready, without the end");
    assert_eq!(bench.steps(1), [150_000, 50_000, 10_000, 45_000]);
}

#[test]
fn ignores_a_command_that_changes_while_another_runs() {
    let mut bench = Bench::default();
    bench.begin(&to_19());
    bench.image.set_command(&words(&[0x0503]));
    bench.wait(5000);
    assert_eq!(bench.words(), words(&[0x0100]));
    bench.image.set_command(&[0; 16]);
    bench.wait(5);
    assert_eq!(bench.words(), [0; 16]);
    assert_eq!(bench.send(&words(&[0x0503]))[0], 0x0200);
}

#[test]
fn continuous_output_follows_the_robot() {
    let mut bench = Bench::new(
        "[[program]]\nnumber = 9\nname = \"GO\"\ntext = \"MOVE P,P19\"\n[[task]]\nnumber = 9\nprogram = 9\n",
    );
    bench.done(Command::ProgramRun.order().with(Key::Task, 9));
    bench.begin(&words(&[0x0506, 1]));
    let mut seen = Vec::new();
    for _ in 0..20 {
        assert_eq!(bench.words()[0], 0x0100);
        seen.push(bench.words()[4]);
        bench.wait(5);
    }
    seen.dedup();
    assert_eq!(seen.len(), 20, "new in every scan");
    bench.wait(5000);
    assert_eq!((bench.words()[0], bench.words()[8]), (0x0100, 10_000));
    bench.image.set_command(&[0; 16]);
    bench.wait(5);
    assert_eq!(bench.words(), [0; 16]);
}

#[test]
fn next_master_gets_the_result_after_a_link_loss() {
    let mut bench = Bench::default();
    bench.begin(&to_19());
    bench.wait(100);
    bench.simulator.input(bench.now, None);
    bench.now += Duration::from_secs(1);
    bench.simulator.advance(bench.now);
    // The next master sends a command at once. The controller ignores it, because it first requires a status reset.
    bench.image.set_command(&words(&[0x0503]));
    bench.wait(20);
    assert_eq!(bench.words(), words(&[0x4000, 12, 551]));
    assert!(bench.is_on(output::ALARM) && !bench.is_on(output::SERVO_ON) && !bench.is_on(output::EMERGENCY_STOP));
    bench.image.set_command(&[0; 16]);
    bench.wait(120);
    assert_eq!(bench.words(), [0; 16]);
    assert_eq!(bench.refused(Command::MovePtp.order().with(Key::Point, 19)), "12.551");
    let place = bench.done(Command::LatestAlarm.order());
    assert_eq!((place.int(Key::AlarmCategory), place.int(Key::Place2)), (Some(551), Some(0)));
    bench.pulse(input::ALARM_RESET);
    bench.pulse(input::SERVO_ON);
    bench.wait(300);
    bench.done(Command::MovePtp.order().with(Key::Point, 19));
}

#[test]
fn missing_master_raises_an_alarm() {
    let mut simulator = Simulator::new(Start::parse("link_within_ms = 1000").unwrap());
    simulator.advance(Duration::from_millis(999));
    assert!(!output::ALARM.is_on(simulator.output()));
    simulator.advance(Duration::from_secs(1));
    assert!(output::ALARM.is_on(simulator.output()));
    assert!(simulator.console(Duration::from_millis(1001), "state").unwrap().contains("12.552"));
}

#[test]
fn the_alarm_of_a_lost_link_is_that_of_its_bus() {
    for (bus, lost, too_long) in [(551, "12.551", "12.552"), (541, "12.541", "12.542"), (571, "12.571", "12.572")] {
        let served = |start: &str| Simulator::new(Start::parse(start).unwrap()).with_link_alarm(Alarm::new(12, bus));
        let mut simulator = served("");
        simulator.input(Duration::from_millis(10), Some(&resting()));
        simulator.input(Duration::from_millis(20), None);
        assert!(simulator.console(Duration::from_millis(30), "state").unwrap().contains(lost));
        let mut simulator = served("link_within_ms = 1000");
        assert!(simulator.console(Duration::from_millis(1001), "state").unwrap().contains(too_long));
    }
}

#[test]
fn scans_only_when_needed_every_5_ms() {
    let mut simulator = Simulator::new(Start::default());
    assert_eq!(simulator.wake(), None);
    let mut image = resting();
    simulator.input(Duration::from_millis(12), Some(&image));
    assert_eq!(simulator.wake(), Some(Duration::from_millis(15)));
    simulator.advance(Duration::from_millis(15));
    image.0[0] = 0x0503;
    simulator.input(Duration::from_millis(15), Some(&image));
    assert_eq!(simulator.wake(), Some(Duration::from_millis(20)), "one scan at a time");
    simulator.advance(Duration::from_millis(19));
    assert_eq!(simulator.output().0[0], 0);
    simulator.advance(Duration::from_millis(20));
    assert_eq!(simulator.output().0[0], 0x0200);
    // A repeated image changes nothing.
    simulator.input(Duration::from_millis(40), Some(&image));
    assert_eq!(simulator.wake(), None);
    // A day passes in one call.
    simulator.advance(Duration::from_secs(86_400));
    simulator.advance(Now::MAX);
    assert_eq!(simulator.output().0[0], 0x0200);
}

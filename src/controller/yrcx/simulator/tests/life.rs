//! Programming box, safety settings, alarms, clock, start state.

use super::*;

#[test]
fn programming_box_allows_reads_only() {
    let mut bench = Bench::default();
    bench.console("box on");
    bench.wait(5);
    assert!(!bench.is_on(output::AUTO_MODE));
    for row in crate::yrcx::table::ROWS.iter().filter(|row| row.command != Command::StatusReset) {
        let Some((_, request, _)) = examples::examples().into_iter().find(|(_, words, _)| {
            crate::yrcx::table::Row::from_word(words[0]).is_some_and(|of| of.command == row.command)
        }) else {
            continue;
        };
        let answer = bench.send(&request);
        if row.enabled_under_programming_box() {
            assert_eq!(answer[0], 0x0200, "{}", row.id);
        } else {
            assert_eq!(answer[..3], [0x4000, 12, 76], "{}", row.id);
        }
    }
    bench.pulse(input::AUTO_START);
    assert!(!bench.is_on(output::PROGRAM_RUNNING));
    bench.console("box off");
    bench.console("inputs off");
    assert_eq!(bench.refused(Command::ServoStatus.order()), "12.76", "all remote commands");
    bench.console("inputs on");
    bench.done(Command::ServoStatus.order());
}

#[test]
fn alarms_keep_power_off_until_they_are_reset() {
    let mut bench = Bench::default();
    bench.console("alarm 17.1");
    bench.wait(10);
    assert!(bench.is_on(output::ALARM) && bench.is_on(output::CPU_OK) && !bench.is_on(output::SERVO_ON));
    assert_eq!(bench.refused(Command::MotorOn.order()), "17.1");
    bench.done(Command::AlarmReset.order());
    assert!(!bench.is_on(output::ALARM));
    bench.console("alarm 22.101 fatal");
    bench.done(Command::AlarmReset.order());
    assert!(bench.is_on(output::ALARM) && !bench.is_on(output::CPU_OK), "only power off and on helps");
    bench.console("power");
    bench.wait(10);
    assert!(!bench.is_on(output::ALARM) && bench.is_on(output::CPU_OK));
    let entry = |bench: &mut Bench, number| {
        let values = bench.done(Command::AlarmHistory.order().with(Key::History, number));
        (values.int(Key::AlarmGroup).unwrap(), values.int(Key::AlarmCategory).unwrap())
    };
    assert_eq!((entry(&mut bench, 1), entry(&mut bench, 2)), ((22, 101), (17, 1)));
    assert_eq!(entry(&mut bench, 500), (0, 0));
    bench.console("warning on");
    bench.wait(5);
    assert!(bench.is_on(output::WARNING));
}

#[test]
fn stores_refusals_in_the_history() {
    let mut bench = Bench::default();
    assert_eq!(bench.refused(Command::MovePulse.order().with(Key::Axes, "1").with(Key::Axis1, 1_000_001)), "2.334");
    assert!(bench.console("why").contains("2.334 R1A1"));
    let latest = bench.done(Command::LatestAlarm.order());
    let keys = [Key::AlarmGroup, Key::AlarmCategory, Key::Place1, Key::Place1Number, Key::Place2, Key::Place2Number];
    assert_eq!(keys.map(|key| latest.int(key).unwrap()), [2, 334, 0, 1, 1, 1]);
    assert!(!bench.is_on(output::ALARM), "nothing serious");
}

#[test]
fn the_clock_goes_on() {
    let mut bench = Bench::new("clock = \"2026/02/28 23:59:50\"");
    bench.wait(15_000);
    let date = bench.done(Command::DateGet.order());
    assert_eq!([Key::Year, Key::Month, Key::Day].map(|key| date.int(key).unwrap()), [26, 3, 1]);
    let date = |month, day| Command::DateSet.order().with(Key::Year, 28).with(Key::Month, month).with(Key::Day, day);
    assert_eq!(bench.refused(date(2, 30)), "4.202");
    bench.done(date(2, 29));
    bench.done(Command::TimeSet.order().with(Key::Hour, 8).with(Key::Minute, 45).with(Key::Second, 0));
    bench.wait(61_000);
    let time = bench.done(Command::TimeGet.order());
    assert_eq!([Key::Hour, Key::Minute, Key::Second].map(|key| time.int(key).unwrap()), [8, 46, 1]);
    assert_eq!(bench.done(Command::DateGet.order()).int(Key::Day), Some(29));
}

#[test]
fn missing_robots_have_no_axes() {
    let mut bench = Bench::new("[[robot]]\naxes = 2");
    let states = |bench: &mut Bench, draft: Draft| bench.done(draft).axes().unwrap();
    assert_eq!(states(&mut bench, Command::ServoStatus.order()), [1, 1, 9, 9]);
    assert_eq!(states(&mut bench, Command::ServoStatus.order().with(Key::Robot, 2)), [9; 4]);
    assert_eq!(states(&mut bench, Command::System.order()), [2000, 2000, 0, 0]);
    assert_eq!(bench.pulses(4), [0; 4]);
    assert_eq!(bench.done(Command::SpeedStatus.order().with(Key::Robot, 3)).int(Key::AutoSpeed), Some(0));
    assert_eq!(bench.refused(Command::ServoOn.order().with(Key::Robot, 2)), "4.901");
    assert_eq!(bench.refused(Command::ServoOn.order().with(Key::Axes, "3")), "4.902");
    assert_eq!(bench.refused(Command::Slots.order().with(Key::Controller, 2)), "4.906");
}

#[test]
fn events_come_at_their_time() {
    let mut bench = Bench::new("[[event]]\nat_ms = 1003\ndo = \"estop on\"");
    bench.wait(800);
    assert!(!bench.is_on(output::EMERGENCY_STOP));
    bench.wait(5);
    assert!(bench.is_on(output::EMERGENCY_STOP));
}

#[test]
fn the_example_names_every_key() {
    Start::parse(EXAMPLE).unwrap();
    for (text, error) in [
        ("mode = \"x\"", "line 1: "),
        ("\nmodel = 1", "line 2: unknown field `model`"),
        ("[[event]]\nat_ms = 1\ndo = \"x\"", "line 1: unknown command"),
        ("[points]\n30000 = { pulse = [0, 0, 0, 0] }", "line 2: points must be from 0 to 29999"),
        ("[points]\n1 = { }", "line 2: a point must have either pulse or mm"),
        ("[[robot]]\naxes = 5", "line 1: a robot must have 1 to 4 axes"),
        ("[[robot]]\naxes = 1\nposition = [0, 0]", "line 1: the list is longer than the 1 axes"),
        ("[[robot]]\nhand = 7", "line 1: hand 7 is not defined for robot 1"),
        ("[[robot]]\n[[robot]]\n[[robot]]\n[[robot]]\n[[robot]]", "line 5: at most 4 robots are possible"),
        ("slots = { 1 = [\"Profinet\", \"none\", \"none\", \"none\"] }", "line 1: 'Profinet' is unknown"),
        ("variables = { SGX1 = 1 }", "line 1: 'SGX1' is not a valid variable"),
        ("ports = { \"DO(28)\" = 1 }", "line 1: 'DO(28)' is not a valid port"),
        ("[[task]]\nnumber = 1\nprogram = 77", "line 1: no program 77"),
        ("[latest_remote]\nalarm = \"2\"", "line 1: '2' is not a valid alarm number"),
    ] {
        let found = Start::parse(text).unwrap_err();
        assert!(found.starts_with(error), "{text}: {found}");
    }
}

#[test]
fn console_reports_unknown_commands() {
    let mut bench = Bench::default();
    assert!(bench.console("help").contains("box on|off"));
    assert!(bench.console("robot").contains("robot 2  0 9000 0 0 pulses, servos ++++"));
    assert_eq!(bench.console("why"), "no command was refused");
    assert_eq!(bench.console("DI(25)=1"), "DI2() is 127");
    for line in ["", "estop", "estop x", "alarm 1", "obstacle R9A1 1", "load R1A1 101", "SI(20)=1", "mode x"] {
        assert!(bench.simulator.console(bench.now, line).is_err(), "{line}");
    }
}

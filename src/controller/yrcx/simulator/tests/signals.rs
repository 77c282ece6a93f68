//! Dedicated signals with the timing of the charts (chapter 1, section 3).

use super::*;

#[test]
fn new_controller_shows_its_state() {
    let bench = Bench::default();
    let on: Vec<&str> = Signal::of_side(Side::Output)
        .filter(|dedicated| bench.is_on(dedicated.signal))
        .map(|dedicated| dedicated.name)
        .collect();
    assert_eq!(on, ["cpu-ok", "servo-on", "mp-ready", "auto-mode", "origin-complete"]);
}

#[test]
fn servos_go_on_after_power_on() {
    let mut bench = Bench::new("servo = false");
    assert!(!bench.is_on(output::SERVO_ON) && bench.is_on(output::MP_READY));
    bench.set(input::SERVO_ON, true);
    bench.wait(200);
    assert!(bench.is_on(output::SERVO_ON));
    bench.set(input::SERVO_ON, false);
    assert!(bench.is_on(output::SERVO_ON));
}

#[test]
fn into_emergency_stop_and_out_of_it() {
    let mut bench = Bench::default();
    input::EMERGENCY_STOP.set(&mut bench.image, false);
    bench.wait(5);
    assert!(bench.is_on(output::EMERGENCY_STOP) && bench.is_on(output::ALARM) && !bench.is_on(output::MP_READY));
    bench.wait(10);
    assert!(!bench.is_on(output::SERVO_ON));
    bench.wait(120);
    bench.pulse(input::SERVO_ON);
    bench.wait(300);
    assert!(!bench.is_on(output::SERVO_ON), "not while SI(00) is off");
    bench.pulse(input::ALARM_RESET);
    assert!(bench.is_on(output::ALARM), "not while SI(00) is off");
    bench.set(input::EMERGENCY_STOP, true);
    assert!(!bench.is_on(output::EMERGENCY_STOP) && bench.is_on(output::ALARM));
    bench.pulse(input::SERVO_ON);
    bench.wait(300);
    assert!(!bench.is_on(output::SERVO_ON), "the alarm comes first");
    bench.pulse(input::ALARM_RESET);
    assert!(!bench.is_on(output::ALARM));
    bench.pulse(input::SERVO_ON);
    bench.wait(100);
    assert!(bench.is_on(output::SERVO_ON));
    // The history contains the alarm and the failed attempts.
    let newest = bench.done(Command::AlarmHistory.order().with(Key::History, 3));
    assert_eq!((newest.int(Key::AlarmGroup), newest.int(Key::AlarmCategory)), (Some(12), Some(600)));
}

#[test]
fn wired_emergency_stop_is_independent() {
    let mut bench = Bench::default();
    bench.console("estop on");
    bench.wait(20);
    assert!(bench.is_on(output::EMERGENCY_STOP) && !bench.is_on(output::SERVO_ON));
    assert_eq!(bench.refused(Command::MotorOn.order()), "12.600");
    bench.console("estop off");
    bench.wait(20);
    assert!(!bench.is_on(output::EMERGENCY_STOP) && bench.is_on(output::ALARM));
    assert_eq!(bench.refused(Command::MotorOn.order()), "12.600", "the alarm is there still");
    bench.done(Command::AlarmReset.order());
    bench.done(Command::MotorOn.order());
    assert!(bench.is_on(output::SERVO_ON));
}

#[test]
fn ignores_edges_within_100_ms() {
    let mut bench = Bench::new("servo = false");
    input::PROGRAM_RESET.set(&mut bench.image, true);
    bench.wait(95);
    input::SERVO_ON.set(&mut bench.image, true);
    bench.wait(400);
    assert!(!bench.is_on(output::SERVO_ON));
    assert!(bench.console("why").contains("less than 100 ms"));
    bench.set(input::SERVO_ON, false);
    // Two edges in one scan are also too close to each other.
    input::PROGRAM_RESET.set(&mut bench.image, false);
    input::SERVO_ON.set(&mut bench.image, true);
    bench.wait(400);
    assert!(!bench.is_on(output::SERVO_ON));
    bench.set(input::SERVO_ON, false);
    bench.set(input::SERVO_ON, true);
    bench.wait(200);
    assert!(bench.is_on(output::SERVO_ON));
    // A stop is accepted even directly after another edge.
    input::EMERGENCY_STOP.set(&mut bench.image, false);
    bench.wait(5);
    assert!(bench.is_on(output::EMERGENCY_STOP));
}

#[test]
fn a_master_that_begins_with_si_00_off_stops_everything() {
    let mut simulator = Simulator::new(Start::default());
    simulator.input(Now::ZERO, Some(&Image::default()));
    simulator.advance(Duration::from_millis(20));
    let image = *simulator.output();
    assert!(output::EMERGENCY_STOP.is_on(&image) && output::ALARM.is_on(&image) && !output::SERVO_ON.is_on(&image));
}

#[test]
fn a_new_master_does_not_start_anything() {
    let mut bench = Bench::new("servo = false");
    bench.simulator.input(bench.now, None);
    bench.wait(500);
    bench.simulator.input(bench.now, None);
    input::ALARM_RESET.set(&mut bench.image, true);
    bench.wait(500);
    assert!(bench.is_on(output::ALARM), "the first image of a master has no edges");
    bench.set(input::ALARM_RESET, false);
    bench.pulse(input::ALARM_RESET);
    assert!(!bench.is_on(output::ALARM));
}

#[test]
fn origin_by_signals() {
    let mut bench = Bench::new(
        "di17 = \"abs/org\"\n[[robot]]\nmethods = [\"sensor\", \"mark\"]\nposition = [5000, 6000, 0, 0]\n\
         [[robot]]\naxes = 2\nmotors = [\"incremental\", \"semi-absolute\"]\nmethods = [\"sensor\", \"stroke\"]\n\
         origin = [false, false]\nposition = [1000, 1000]\n",
    );
    assert!(!bench.is_on(output::ORIGIN_COMPLETE));
    bench.pulse(input::ORIGIN);
    bench.wait(2000);
    assert!(bench.is_on(output::ORIGIN_COMPLETE));
    assert_eq!((bench.pulses(1), bench.pulses(2)), ([5000, 6000, 0, 0], [0; 4]));
    bench.pulse(input::ORIGIN_ABSOLUTE);
    bench.wait(2000);
    assert_eq!(bench.pulses(1), [0, 6000, 0, 0], "an axis of the mark type stays");
}

#[test]
fn general_signals_are_ports() {
    let mut bench = Bench::default();
    let signal = |side, number| Signal::new(side, number).unwrap();
    bench.done(
        Command::PortSetBit
            .order()
            .with(Key::PortType, "SO")
            .with(Key::Port, 12)
            .with(Key::PortBit, 3)
            .with(Key::Value, 1),
    );
    bench.wait(5);
    assert!(bench.is_on(signal(Side::Output, 123)));
    bench.set(signal(Side::Input, 27), true);
    let read = |bench: &mut Bench, port| {
        let draft = Command::PortGet.order().with(Key::PortType, "SI").with(Key::Port, port);
        bench.done(draft).int(Key::Value)
    };
    assert_eq!((read(&mut bench, 2), read(&mut bench, 0)), (Some(0x80), Some(0b0100_0001)));
    let so = Command::PortGet.order().with(Key::PortType, "SO").with(Key::Port, 0);
    assert_eq!(bench.done(so).int(Key::Value), Some(0b0001_0110), "CPU OK, servo on, MP RDY");
}

#[test]
fn the_sequence_program_runs_while_its_input_is_on() {
    let mut bench = Bench::new("sequence = true");
    bench.set(input::SEQUENCE_CONTROL, true);
    assert!(bench.is_on(output::SEQUENCE_RUNNING));
    bench.set(input::SEQUENCE_CONTROL, false);
    assert!(!bench.is_on(output::SEQUENCE_RUNNING));
}

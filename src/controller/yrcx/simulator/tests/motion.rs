//! Motion: distances, speeds, limits, pushes, origins.

use super::geometry::whole;
use super::*;

const SCARA: &str = "[[robot]]\nkind = \"scara\"\nmethods = [\"sensor\", \"sensor\", \"sensor\", \"sensor\"]\n\
                     position = [0, 9000, 0, 0]\n[[robot]]\n";

fn to(point: i32) -> Draft {
    Command::MovePtp.order().with(Key::Point, point)
}

impl Bench {
    /// Milliseconds until a command ends.
    fn time(&mut self, draft: Draft) -> u128 {
        let begun = self.now;
        self.done(draft);
        self.now.saturating_sub(begun).as_millis()
    }

    /// Current tool position of robot 1.
    fn pose(&mut self) -> [f64; 4] {
        self.console("state");
        self.simulator.world.pose(0).unwrap()
    }

    fn go_to(&mut self, mm: [&str; 4]) {
        let mut draft = Command::MoveMm.order();
        for (key, text) in Key::AXES.into_iter().zip(mm) {
            draft = draft.with(key, text);
        }
        self.done(draft);
    }
}

#[test]
fn speeds_are_those_of_the_commands() {
    let mut bench = Bench::new("[points]\n1 = { pulse = [500000, 0, 0, 0] }");
    let near = |found: u128, wanted: u128| found.abs_diff(wanted) <= 15;
    // 500 mm at 1000 mm/s take 0.5 s. The ramps of 0.2 s and about three scans are added.
    let full = bench.time(to(1));
    assert!(near(full, 700 + 15), "{full}");
    let half = bench.time(to(0).with(Key::SpeedPercent, 50));
    assert!(near(half, 1100 + 15), "{half}");
    bench.done(Command::SpeedAuto.order().with(Key::SpeedPercent, 50));
    let quarter = bench.time(to(1).with(Key::SpeedPercent, 50));
    assert!(near(quarter, 2050 + 15), "the automatic speed counts as well: {quarter}");
    bench.done(Command::SpeedProgram.order().with(Key::SpeedPercent, 10));
    let slow = bench.time(to(0));
    assert!(near(slow, 10_010 + 15), "{slow}");
    let direct = bench.time(to(1).with(Key::SpeedOfMax, "100.00"));
    assert!(near(direct, full), "but not with a share of the greatest: {direct}");
    let linear = bench.time(Command::MoveLinear.order().with(Key::Point, 0).with(Key::SpeedMmS, 100));
    assert!(near(linear, 5020 + 15), "{linear}");
    let gentle = bench.time(to(1).with(Key::SpeedOfMax, "100.00").with(Key::Accel, 20).with(Key::Decel, 50));
    assert!(near(gentle, 500 + 500 + 200 + 15), "{gentle}");
}

#[test]
fn positions_are_reported_as_they_were_commanded() {
    let mut bench = Bench::new(SCARA);
    for (arm, sign) in [("right", 1), ("left", -1)] {
        bench.done(Command::ArmSelect.order().with(Key::Arm, arm));
        bench.go_to(["200.123", "-150.456", "12.345", "-33.333"]);
        assert_eq!(bench.steps(1), [200_123, -150_456, 12_345, -33_333]);
        assert_eq!(bench.pulses(1)[1].signum(), sign);
        let shown = bench.done(Command::ArmStatus.order()).int(Key::Arm);
        assert_eq!(shown, Some(i32::from(arm == "left")));
    }
    // The hand system in the command has priority over the current one.
    let draft = Command::MoveMm.order().with(Key::HandSystem, "right").with(Key::Report, "mm");
    let draft =
        ["200", "-100", "0", "0"].into_iter().zip(Key::AXES).fold(draft, |draft, (at, key)| draft.with(key, at));
    assert_eq!(bench.done(draft).axes(), Some([200_000, -100_000, 0, 0]));
    assert!(bench.pulses(1)[1] > 0);
    assert_eq!(bench.done(Command::PositionMm.order()).int(Key::HandSystem), Some(1));
}

#[test]
fn scara_axis_can_move_other_axes() {
    let mut bench = Bench::new(SCARA);
    bench.go_to(["200", "100", "0", "0"]);
    let before = bench.pulses(1);
    // Only R rotates. The values of X and Y in the command also count, although the command does not name these axes.
    // Here they are the current values.
    let turn = |x, y| Command::MoveMm.order().with(Key::Axes, "4").with(Key::Axis1, x).with(Key::Axis2, y);
    bench.done(turn("200", "100").with(Key::Axis4, "30"));
    assert_eq!(bench.steps(1), [200_000, 100_000, 0, 30_000]);
    // A value of 0 is a target too. Here the robot cannot reach it.
    assert_eq!(bench.refused(turn("0", "0").with(Key::Axis4, "40")), "2.905");
    // A move of X alone moves both arms and rotates R back.
    bench.done(turn("250", "100").with(Key::Axes, "1"));
    assert_eq!(bench.steps(1), [250_000, 100_000, 0, 30_000]);
    assert!(bench.pulses(1).iter().zip(before).all(|(a, b)| *a != b || b == 0));
}

#[test]
fn lines_stay_on_their_line_and_arcs_on_their_arc() {
    let mut bench = Bench::new(&format!(
        "{SCARA}[points]\n1 = {{ mm = [150, 200, 0, 0] }}\n2 = {{ mm = [300, 100, 0, 0] }}\n\
         3 = {{ mm = [200, 250, 0, 0] }}\n4 = {{ mm = [100, 250, 0, 0] }}\n"
    ));
    bench.done(to(1));
    bench.begin(Command::MoveLinear.order().with(Key::Point, 2).with(Key::SpeedMmS, 50).build().unwrap().words());
    let mut seen = 0;
    while bench.words()[0] == 0x0100 {
        let pose = bench.pose();
        // The line is 2 X + 3 Y = 900.
        assert!((2.0 * pose[0] + 3.0 * pose[1] - 900.0).abs() < 1e-6, "{pose:?}");
        seen += 1;
        bench.wait(5);
    }
    assert!(seen > 500);
    bench.end();
    bench.done(to(1));
    let arc = Command::MoveCircular.order().with(Key::Point, 3).with(Key::Point2, 4).with(Key::SpeedMmS, 50);
    bench.begin(arc.build().unwrap().words());
    let mut highest = 0.0_f64;
    while bench.words()[0] == 0x0100 {
        let pose = bench.pose();
        let radius = (pose[0] - 150.0).hypot(pose[1] - 250.0);
        assert!((radius - 50.0).abs() < 1e-6, "{pose:?}");
        highest = highest.max(pose[1]);
        bench.wait(5);
    }
    assert!(highest > 299.9, "the long way round: {highest}");
    bench.end();
    assert_eq!(bench.steps(1), [100_000, 250_000, 0, 0]);
    assert_eq!(bench.refused(Command::MoveCircular.order().with(Key::Point, 4).with(Key::Point2, 4)), "2.906");
}

#[test]
fn an_arch_goes_over_its_axis() {
    let mut bench = Bench::new("[points]\n1 = { mm = [100, 50, -5, 0] }");
    let arch = Command::MoveArch
        .order()
        .with(Key::Point, 1)
        .with(Key::ArchAxis, "3")
        .with(Key::ArchUnit, "mm")
        .with(Key::ArchPosition, "20");
    bench.begin(arch.build().unwrap().words());
    let mut across = 0;
    while bench.words()[0] == 0x0100 {
        let [x, _, z, _] = bench.pose();
        assert!((z - 20.0).abs() < 1e-9 || x < 1e-9 || (x - 100.0).abs() < 1e-9, "{x} {z}");
        across += i32::from(x > 1.0 && x < 99.0);
        bench.wait(5);
    }
    assert!(across > 10);
    bench.end();
    assert_eq!(bench.steps(1), [100_000, 50_000, -5000, 0]);
}

#[test]
fn relative_moves_of_every_kind() {
    let mut bench = Bench::new("[points]\n1 = { mm = [10, 20, 3, 90] }\n2 = { pulse = [5, 6, 7, 8] }");
    let point = |command: Command, point: i32| command.order().with(Key::Point, point);
    bench.done(point(Command::MoveiPtp, 1));
    bench.done(point(Command::MoveiLinear, 2));
    assert_eq!(bench.pulses(1), [10_005, 20_006, 3007, 90_008]);
    bench.done(point(Command::MoveiPtp, 1).with(Key::Axes, "2"));
    assert_eq!(bench.pulses(1), [10_005, 40_006, 3007, 90_008]);
    bench.done(point(Command::DriveiPoint, 2).with(Key::Axes, "1"));
    bench.done(Command::DriveiMm.order().with(Key::Axes, "3").with(Key::Distance, "-3.007"));
    bench.done(Command::DriveiPulse.order().with(Key::Axes, "4").with(Key::Distance, -8));
    assert_eq!(bench.pulses(1), [10_010, 40_006, 0, 90_000]);
    // The distances are in tool coordinates, which are rotated by 90 degrees.
    bench.done(point(Command::MovetLinear, 1));
    assert_eq!(bench.pulses(1), [-9990, 50_006, 3000, 180_000]);
    assert_eq!(bench.refused(point(Command::MovetPtp, 2)), "4.905", "a point in pulses");
    bench.done(Command::DrivePulse.order().with(Key::Axes, "1").with(Key::Target, 7));
    bench.done(point(Command::DrivePoint, 1).with(Key::Axes, "3"));
    assert_eq!(bench.pulses(1), [7, 50_006, 3000, 180_000]);
}

#[test]
fn a_relative_move_that_was_stopped_keeps_its_target() {
    for (start, kept) in [("keep", true), ("reset", false)] {
        let mut bench = Bench::new(&format!("movei_start = \"{start}\""));
        let movei = || Command::DriveiMm.order().with(Key::Axes, "1").with(Key::Distance, "300");
        bench.begin(movei().build().unwrap().words());
        bench.wait(200);
        bench.set(input::STOP, false);
        assert_eq!(bench.end()[..3], [0x4000, 12, 400]);
        assert_eq!(bench.refused(movei()), "12.400", "nothing moves while SI(06) is off");
        bench.set(input::STOP, true);
        let [there, ..] = bench.pulses(1);
        assert!((10_000..290_000).contains(&there));
        bench.done(movei());
        assert_eq!(bench.pulses(1)[0], if kept { 300_000 } else { there + 300_000 });
        bench.done(movei());
        assert_eq!(bench.pulses(1)[0], if kept { 600_000 } else { there + 600_000 }, "anew after it arrived");
    }
}

#[test]
fn push_stops_at_an_obstacle() {
    let mut bench = Bench::new("[[robot]]\nobstacles = { 3 = 9000 }");
    let push = |target: i32, axis: &str| {
        Command::PushPulse
            .order()
            .with(Key::Axes, axis)
            .with(Key::Target, target)
            .with(Key::PushForce, 150)
            .with(Key::PushTime, 2000)
    };
    assert_eq!(bench.done(push(8000, "3")).int(Key::PushResult), Some(0));
    let order = push(10_000, "3").with(Key::Report, "pulse").build().unwrap();
    bench.begin(order.words());
    bench.wait(1000);
    assert_eq!(bench.words()[0], 0x0100);
    assert_eq!(bench.simulator.world.robots[0].torque(2), 30, "150 % of the rated torque is 30 % of the greatest");
    let begun = bench.now;
    let Answer::Done(values) = Answer::parse(&order, &bench.end()).unwrap() else { panic!() };
    assert_eq!((values.int(Key::PushResult), values.int(Key::Axis3)), (Some(1), Some(9000)));
    assert!(bench.now.saturating_sub(begun).as_millis() > 900);
    bench.console("obstacle R1A3 off");
    assert_eq!(bench.done(push(10_000, "3")).int(Key::PushResult), Some(0));
}

#[test]
fn torque_limit_applies_to_the_next_motion() {
    let mut bench = Bench::new("[[robot]]\nload = [60, 0, 0, 0]");
    let torque = |bench: &mut Bench, command: Command| bench.done(command.order().with(Key::Axes, "1")).int(Key::Axis1);
    assert_eq!(torque(&mut bench, Command::TorqueOfMax), Some(60));
    assert_eq!(torque(&mut bench, Command::TorqueOfRated), Some(300));
    bench.done(Command::TorqueLimit.order().with(Key::Axes, "1").with(Key::Torque, 50));
    assert_eq!(torque(&mut bench, Command::TorqueOfMax), Some(50));
    bench.done(Command::ServoOff.order());
    assert_eq!(torque(&mut bench, Command::TorqueOfMax), Some(0));
}

#[test]
fn jog_ends_at_the_soft_limit() {
    let mut bench = Bench::new(SCARA);
    let jog = |command: Command, axis: &str, direction: &str| {
        command.order().with(Key::Axes, axis).with(Key::Direction, direction).with(Key::Report, "pulse")
    };
    assert_eq!(bench.refused(jog(Command::JogPulse, "1", "-")), "2.334");
    assert_eq!(bench.pulses(1)[0], -26_000);
    assert_eq!(bench.refused(jog(Command::JogPulse, "1", "-")), "2.334", "at once");
    bench.go_to(["200", "100", "0", "0"]);
    let before = bench.steps(1);
    assert_eq!(bench.refused(jog(Command::JogCartesian, "1", "+")), "2.905", "as far as the arms reach");
    let after = bench.steps(1);
    assert!(after[0] > before[0] + 180_000 && after[1] == before[1], "{after:?}");
    bench.begin(jog(Command::JogTool, "2", "-").build().unwrap().words());
    bench.wait(300);
    bench.set(input::STOP, false);
    let order = jog(Command::JogTool, "2", "-").build().unwrap();
    let Answer::Refused { alarm, positions } = Answer::parse(&order, &bench.end()).unwrap() else { panic!() };
    bench.set(input::STOP, true);
    assert_eq!((alarm.to_string().as_str(), positions.axes().unwrap()), ("12.400", bench.pulses(1)));
    bench.set(input::STOP, false);
    let Answer::Refused { positions, .. } = bench.ask(jog(Command::JogPulse, "1", "+")) else { panic!() };
    assert_eq!(positions.axes().unwrap(), bench.pulses(1), "not begun, and told in the same way");
}

#[test]
fn inching_goes_its_amount() {
    let mut bench = Bench::default();
    let inch = |command: Command, axis: &str| command.order().with(Key::Axes, axis).with(Key::Direction, "+");
    bench.done(Command::InchAmountSet.order().with(Key::InchingAmount, 50));
    for command in [Command::InchPulse, Command::InchCartesian, Command::InchTool] {
        bench.done(inch(command, "2"));
    }
    assert_eq!(bench.pulses(1), [0, 150, 0, 0]);
    assert_eq!(bench.done(Command::InchAmountGet.order()).int(Key::InchingAmount), Some(50));
    bench.done(inch(Command::InchPulse, "2").with(Key::Robot, 2));
    assert_eq!(bench.pulses(2), [0, 9100, 0, 0]);
}

#[test]
fn origin_return_makes_the_position_known() {
    let mut bench = Bench::new(
        "[[robot]]\nmethods = [\"sensor\", \"mark\"]\norigin = [false, true]\nposition = [5000, 5000, 0, 0]\n\
         [[robot]]\naxes = 1\nmethods = [\"sensor\"]\nmotors = [\"incremental\"]\norigin = [false]\nposition = [100]\n",
    );
    assert_eq!(bench.refused(to(0)), "2.902");
    assert_eq!(bench.refused(to(0).with(Key::Robot, 2)), "2.902");
    let status = |bench: &mut Bench| bench.done(Command::OriginStatus.order()).int(Key::System);
    assert_eq!(status(&mut bench), Some(0));
    bench.done(Command::OriginRobot.order().with(Key::OriginAxes, "incomplete"));
    assert_eq!(status(&mut bench), Some(1), "robot 0 is every robot");
    assert_eq!((bench.pulses(1), bench.pulses(2)), ([0, 5000, 0, 0], [0; 4]));
    bench.done(Command::OriginAxis.order().with(Key::Axes, "2"));
    assert_eq!(bench.pulses(1), [0; 4]);
    let draft = Command::OriginStatus.order().with(Key::Robot, 2).with(Key::MotorType, "absolute");
    assert_eq!(bench.done(draft).axes(), Some([9; 4]));
}

#[test]
fn absolute_reset_is_for_marks() {
    let mut bench = Bench::new("[[robot]]\nmethods = [\"mark\", \"sensor\"]\norigin = [false]\nposition = [100]");
    let axis = |command: Command, axis: &str| command.order().with(Key::Axes, axis);
    assert_eq!(bench.refused(axis(Command::OriginAxis, "1")), "2.907", "a mark needs an absolute reset first");
    assert_eq!(bench.refused(axis(Command::AbsoluteReset, "1")), "2.907", "not at a place for it");
    assert_eq!(bench.refused(axis(Command::AbsoluteReset, "2")), "2.907", "not of the mark type");
    bench.done(axis(Command::AbsoluteResetMove, "1").with(Key::Direction, "-"));
    assert_eq!(bench.pulses(1)[0], 0);
    bench.done(axis(Command::AbsoluteResetMove, "1").with(Key::Direction, "+"));
    assert_eq!(bench.pulses(1)[0], 4096);
    bench.done(axis(Command::AbsoluteReset, "1"));
    bench.done(to(0));
}

#[test]
fn shifts_and_hands_move_the_coordinates() {
    let mut bench = Bench::default();
    bench.go_to(["100", "50", "10", "0"]);
    bench.done(Command::ShiftSelect.order().with(Key::Shift, 5));
    // The origin of shift 5 is at X = 10, Y = -20, Z = 5, and the shift is rotated by -18 degrees.
    let [x, y, z, r] = bench.steps(1);
    assert_eq!((z, r), (5000, 18_000));
    assert!((f64::from(x).hypot(f64::from(y)) - 90_000_f64.hypot(70_000.0)).abs() < 2.0);
    bench.go_to(["0", "0", "0", "0"]);
    assert_eq!(bench.pulses(1), [10_000, -20_000, 5000, -18_000]);
    bench.done(Command::ShiftSelect.order().with(Key::Shift, 0));
    bench.done(Command::HandSelect.order().with(Key::Hand, 1));
    assert_eq!(bench.steps(1), [20_000, -22_000, 10_000, -18_000], "the hand is 10, -2, 5 long");
    assert_eq!(bench.refused(Command::HandSelect.order().with(Key::Hand, 2)), "4.904");
    bench.done(Command::Teach.order().with(Key::Point, 7).with(Key::Unit, "mm"));
    assert_eq!(
        bench.done(Command::PointGet.order().with(Key::Point, 7)).axes(),
        Some([20_000, -22_000, 10_000, -18_000])
    );
}

#[test]
fn nothing_moves_without_power() {
    let mut bench = Bench::new("servo = false");
    assert_eq!(bench.refused(to(19)), "2.901");
    assert_eq!(bench.refused(Command::ServoOn.order()), "2.901", "motor power comes first");
    bench.done(Command::MotorPower.order());
    assert!(bench.is_on(output::SERVO_ON));
    assert_eq!(bench.refused(to(19)), "2.901");
    bench.done(Command::ServoOn.order().with(Key::Axes, "3"));
    bench.done(Command::DrivePulse.order().with(Key::Axes, "3").with(Key::Target, 1000));
    assert_eq!(bench.refused(to(19)), "2.901");
    bench.done(Command::ServoOn.order());
    bench.done(to(19));
    bench.done(Command::ServoFree.order().with(Key::Axes, "1"));
    assert_eq!(bench.done(Command::ServoStatus.order()).axes(), Some([2, 1, 1, 1]));
    bench.done(Command::MotorOff.order());
    assert!(!bench.is_on(output::SERVO_ON));
    assert_eq!(bench.done(Command::ServoStatus.order()).axes(), Some([0; 4]));
}

#[test]
fn an_emergency_stop_ends_a_motion_on_the_spot() {
    let mut bench = Bench::default();
    bench.begin(to(19).with(Key::SpeedPercent, 10).build().unwrap().words());
    bench.wait(300);
    input::EMERGENCY_STOP.set(&mut bench.image, false);
    bench.wait(5);
    assert_eq!(bench.words(), words(&[0x4000, 12, 600]));
    let there = bench.pose().map(whole);
    bench.wait(1000);
    assert_eq!(bench.pose().map(whole), there);
}

#[test]
fn soft_limits_apply_during_a_motion() {
    let mut bench = Bench::new(SCARA);
    bench.go_to(["-150", "200", "0", "0"]);
    // The line between these positions goes through the middle of the range, which the arms cannot reach.
    let through = Command::MoveiLinear.order().with(Key::Point, 9);
    bench.done(
        Command::PointSet
            .order()
            .with(Key::Point, 9)
            .with(Key::Unit, "mm")
            .with(Key::Axis1, "300")
            .with(Key::Axis2, "-400")
            .with(Key::Axis3, "0")
            .with(Key::Axis4, "0"),
    );
    let refused = bench.refused(through);
    assert!(["2.334", "2.905"].contains(&refused.as_str()), "{refused}");
    assert_eq!(bench.steps(1), [-150_000, 200_000, 0, 0]);
    assert_eq!(bench.refused(to(50)), "2.905", "too close to the first axis");
    assert_eq!(bench.refused(to(77)), "2.904", "never defined");
}

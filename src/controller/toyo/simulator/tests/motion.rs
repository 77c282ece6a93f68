//! Moves over time: ramps, speeds, limits, origin, JOG, obstacles.

use std::time::Duration;

use super::{Bench, What, fails, ran};

/// A move of X to 100 mm with speed row 5 (200 mm/s) and ramps of 0.1 s. It takes 0.6 s; the two ramps together are 20
/// mm long.
const TO_100: &str = "MOV a X=+0100.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST";

fn mov(x: f64, y: f64, tail: &str) -> String {
    format!("MOV a X={x:+08.2} Y={y:+08.2} Z=+0000.00 R=+0000.00 {tail}")
}

/// Run time of the steps. A step that is not a move takes no time.
fn time_of(steps: &[&str], toml: &str) -> (Bench, Duration) {
    let bench = Bench::ran(steps, &format!("instruction_us = 1\n{toml}"));
    assert_eq!(bench.error(), None);
    let time = bench.now;
    (bench, time)
}

#[track_caller]
fn about(time: Duration, seconds: f64) {
    assert!((time.as_secs_f64() - seconds).abs() < 1e-4, "{time:?}, not {seconds} s");
}

#[test]
fn a_move_has_a_trapezoid_profile() {
    let mut bench = Bench::with(&[TO_100, "END"], "");
    bench.ok("@SPST 0001");
    for (ms, x) in [(50, 2.5), (100, 10.0), (300, 50.0), (500, 90.0), (550, 97.5), (600, 100.0)] {
        bench.pass(ms - u64::try_from(bench.now.as_millis()).unwrap());
        bench.at([x, 0.0, 0.0, 0.0]);
    }
    let (_, time) = time_of(&[TO_100, "END"], "");
    about(time, 0.6);
}

#[test]
fn speed_and_ramps_come_from_tables_and_override() {
    // At half the speed with the same ramp time: 10 mm of ramps in 0.2 s, and 90 mm at 100 mm/s.
    about(time_of(&[TO_100, "END"], "write = [\"WPAR T2 V05=0100.0\"]").1, 1.1);
    let mut bench = Bench::with(&[TO_100, "END"], "instruction_us = 1");
    bench.ok("@WOVR OV=050");
    bench.run();
    about(bench.now, 1.1);
    // Ramps of 0.4 s and 0.2 s are 40 mm and 20 mm long, with 40 mm between them.
    about(time_of(&["ACC A=04", "DEC D=02", TO_100, "END"], "").1, 0.8);
    // Row 0 means the speed of the last SPD.
    about(time_of(&["SPD V=04", &mov(100.0, 0.0, "S V=00 POST"), "END"], "").1, 1.1);
    // An axis never moves faster than its maximum speed (E06).
    about(time_of(&[TO_100, "END"], "write = [\"WPAR E06 AX1=0100 AX2=1000 AX3=1000 AX4=1000\"]").1, 1.1);
}

#[test]
fn path_speed_is_along_the_line_and_axis_speed_is_of_the_longest_axis() {
    // 30 mm and 40 mm make a line of 50 mm. The ramps are 20 mm long.
    about(time_of(&[&mov(30.0, 40.0, "T V=05 POST"), "END"], "").1, 0.2 + 30.0 / 200.0);
    about(time_of(&[&mov(30.0, 40.0, "S V=05 POST"), "END"], "").1, 0.2 + 20.0 / 200.0);
    let mut bench = Bench::with(&[&mov(30.0, 40.0, "S V=05 POST"), "END"], "");
    bench.start(150);
    bench.at([15.0, 20.0, 0.0, 0.0]);
}

#[test]
fn override_takes_effect_at_the_next_start() {
    let mut bench = Bench::with(&[TO_100, "END"], "");
    bench.ok("@SPST 0001");
    bench.ng("@WOVR OV=050", "or jog runs");
    bench.rest();
    bench.ok("@WOVR OV=050");
    bench.answers("@ROVR", "@ROVR OV=050");
}

#[test]
fn pass_points_are_rounded_and_do_not_stop() {
    let (first, second) = (mov(100.0, 0.0, "S V=05 PASS"), mov(100.0, 100.0, "S V=05 POST"));
    // Two moves of 0.6 s each. They overlap by a ramp of 0.1 s.
    about(time_of(&[&first, &second, "END"], "").1, 1.1);
    about(time_of(&["PASS PASS=050.0", &first, &second, "END"], "").1, 1.15);
    let mut bench = Bench::with(&[&first, "OUT STN=0 PN01=.......1", &second, "END"], "instruction_us = 1");
    bench.start(501);
    assert_eq!(bench.port(1), 1, "what follows is done while it moves");
    bench.pass(49);
    let [x, y, ..] = bench.sim.state().position;
    assert!((97.0..98.0).contains(&x) && (2.0..3.0).contains(&y), "{x} {y}");
    bench.rest();
    bench.at([100.0, 100.0, 0.0, 0.0]);
    // A program ends when its last move ends.
    about(time_of(&[&first, "END"], "").1, 0.6);
}

#[test]
fn targets_come_from_rows_counters_and_increments() {
    let toml = "points.1 = { 1 = [1.0, 0.0, 0.0, 0.0], 12 = [12.0, 1.0, 0.0, 0.0] }\ncounters = { 3 = 11 }";
    let bench = Bench::ran(&["MOVP a PT=001 CN=03 S V=05 POST", "MOVP i PT=001 CN=00 S V=05 POST", "END"], toml);
    bench.at([13.0, 1.0, 0.0, 0.0]);
    let bench = Bench::ran(
        &["MOVP a PT=000 CN=03 S V=05 POST", "END"],
        "counters = { 3 = 1 }\npoints.1.1 = [5.0, 0.0, 0.0, 0.0]",
    );
    bench.at([5.0, 0.0, 0.0, 0.0]);
    fails(&["MOVP a PT=000 CN=01 S V=05 POST", "END"], 0xB6);
    fails(&["CNT CN01=0500", "MOVP a PT=500 CN=01 S V=05 POST", "END"], 0xB6);
}

#[test]
fn offsets_are_added_to_absolute_positions() {
    let steps = [
        "OFS X=+0010.00 Y=+0000.00 Z=+0000.00 R=+0000.00",
        TO_100,
        "TIM TM=001.0",
        "MOV i X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST",
        "STOP",
        "END",
    ];
    let mut bench = ran(&steps);
    bench.at([111.0, 0.0, 0.0, 0.0]);
    bench.answers("@MOFF", "@MOFF X=+0010.00 Y=+0000.00 Z=+0000.00 R=+0000.00");
    let steps = ["OFSP PT=002 CN=00", TO_100, "MVB S V=05 POST", "END"];
    let bench = Bench::ran(&steps, "points.1.2 = [0.0, 5.0, 0.0, 0.0]");
    bench.at([0.0, 0.0, 0.0, 0.0]);
}

#[test]
fn arcs_go_through_their_points() {
    let steps = [
        "MOV a X=+0100.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST",
        "MVC a X=+0000.00 Y=+0100.00 Z=+0000.00 R=+0010.00 V=05 POST",
        "MVCP a PT=001 CN=00 V=00 POST",
        "OUT STN=0 PN01=.......1",
        "END",
    ];
    let mut bench = Bench::with(&steps, "points.1.1 = [-100.0, 0.0, 0.0, 20.0]");
    bench.start(600);
    // Half a circle has 314.16 mm: two ramps of 0.1 s, and 294.16 mm at 200 mm/s. After half the time, the axes are at
    // the top of the circle.
    let half = f64::midpoint(0.2, (std::f64::consts::PI * 100.0 - 20.0) / 200.0);
    bench.now = Duration::from_secs_f64(0.6 + half);
    bench.sim.advance(bench.now);
    let [x, y, _, r] = bench.sim.state().position;
    assert!(x.abs() < 0.5 && (y - 100.0).abs() < 0.01 && (r - 10.0).abs() < 0.1, "{x} {y} {r}");
    bench.rest();
    bench.at([-100.0, 0.0, 0.0, 20.0]);
    assert_eq!(bench.port(1), 1, "the second point is no step of its own");
}

#[test]
fn an_arc_without_its_data_is_an_error() {
    fails(&["MVC a X=+0000.00 Y=+0100.00 Z=+0000.00 R=+0000.00 V=05 POST", "END"], 0xA5);
    fails(
        &[
            "MVC a X=+0010.00 Y=+0010.00 Z=+0000.00 R=+0000.00 V=05 POST",
            "MVC a X=+0020.00 Y=+0020.00 Z=+0000.00 R=+0000.00 V=05 POST",
            "END",
        ],
        0xA6,
    );
}

#[test]
fn soft_limits_are_checked_before_and_during_moves() {
    for (step, code) in [
        ("MOV a X=+1000.01 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", 0xC0),
        ("MOV a X=-1000.01 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", 0xC1),
        ("MOV a X=+0000.00 Y=+2000.00 Z=+0000.00 R=+0000.00 S V=05 POST", 0xC2),
        ("MOV a X=+0000.00 Y=-2000.00 Z=+0000.00 R=+0000.00 S V=05 POST", 0xC3),
        ("MOV a X=+0000.00 Y=+0000.00 Z=+2000.00 R=+0000.00 S V=05 POST", 0xC4),
        ("MOV a X=+0000.00 Y=+0000.00 Z=-2000.00 R=+0000.00 S V=05 POST", 0xC5),
        ("MOV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=+2000.00 S V=05 POST", 0xC6),
        ("MOV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=-2000.00 S V=05 POST", 0xC7),
    ] {
        fails(&[step, "END"], code).at([0.0; 4]);
    }
    fails(
        &[
            "MOV a X=+1000.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=10 POST",
            "MOV i X=+0000.01 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST",
            "END",
        ],
        0xC0,
    )
    .at([1000.0, 0.0, 0.0, 0.0]);
    let offset = "OFS X=+0000.00 Y=-0950.00 Z=+0000.00 R=+0000.00";
    fails(&[offset, "MOV a X=+0000.00 Y=-0051.00 Z=+0000.00 R=+0000.00 S V=05 POST", "END"], 0x39).at([0.0; 4]);
    // The points of the arc are within the limits, but the arc itself extends beyond the limits.
    let bench = Bench::ran(
        &[
            "MVC a X=+0070.00 Y=+0070.00 Z=+0000.00 R=+0000.00 V=05 POST",
            "MVC a X=+0000.00 Y=+0140.00 Z=+0000.00 R=+0000.00 V=05 POST",
            "END",
        ],
        "write = [\"WPAR P01 AX1=+0060.00 AX2=+1000.00 AX3=+1000.00 AX4=+1000.00\"]",
    );
    assert_eq!(bench.error(), Some(0xC0));
}

#[test]
fn a_move_needs_origin_and_servo_power() {
    let mut bench = Bench::new("host = true\nsteps.1 = [\"MVB S V=05 POST\", \"END\"]");
    bench.run();
    assert_eq!(bench.error(), Some(0x61));
    let mut bench = Bench::ready("servo = false\nsteps.1 = [\"MVB S V=05 POST\", \"END\"]");
    bench.ng("@HOME", "servo power is off");
    bench.run();
    assert_eq!(bench.error(), Some(0x62));
    bench.ng("@SPST 0001", "an error is active");
    bench.ok("@CERR");
    bench.ok("@SVON");
    bench.run();
    assert_eq!(bench.error(), None);
}

#[test]
fn a_start_after_a_stop_continues_the_move() {
    let steps = ["MOV i X=+0100.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", "CNT+ CN01=0001", "END"];
    let mut bench = Bench::with(&steps, "");
    bench.start(300);
    bench.ok("@STOP");
    assert_eq!(bench.page(0) & 0b110, 0b110, "it still slows down");
    bench.rest();
    bench.at([60.0, 0.0, 0.0, 0.0]);
    assert_eq!(bench.page(0), 0b0011_0100);
    bench.resume();
    bench.at([100.0, 0.0, 0.0, 0.0]);
    assert_eq!(bench.counter(1), 1);
    // A start at the first step discards the interrupted move and begins a new one.
    bench.start(300);
    bench.ok("@STOP");
    bench.pass(1000);
    bench.run();
    bench.at([260.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_jog_during_a_stop_does_not_shift_the_target() {
    let steps = ["MOV i X=+0100.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST", "END"];
    let mut bench = Bench::with(&steps, "");
    bench.start(300);
    bench.ok("@STOP");
    bench.pass(1000);
    bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
    bench.ok("@JGST X=+L Y=SP Z=SP R=SP");
    bench.pass(1000);
    bench.ok("@JGST X=SP Y=SP Z=SP R=SP");
    bench.pass(1000);
    bench.at([70.0, 0.0, 0.0, 0.0]);
    bench.resume();
    bench.at([100.0, 0.0, 0.0, 0.0]);
}

#[test]
fn an_emergency_stop_stops_at_once() {
    let mut bench = Bench::with(&[TO_100, "END"], "");
    bench.start(300);
    bench.console("estop");
    bench.at([50.0, 0.0, 0.0, 0.0]);
    assert_eq!((bench.page(0), bench.page(1), bench.page(3) & 1), (0b0011_0001, 0x13, 0));
    bench.pass(1000);
    bench.at([50.0, 0.0, 0.0, 0.0]);
    bench.ng("@CERR", "emergency stop");
    bench.console("estop off");
    bench.ok("@CERR");
    bench.ok("@SVON");
    bench.resume();
    bench.at([100.0, 0.0, 0.0, 0.0]);
}

#[test]
fn the_origin_return_moves_axis_by_axis() {
    let mut bench = Bench::new(
        "host = true\nposition = [20.0, 0.0, 10.0, 0.0]\naxes = 3\nwrite = [\"WPAR P06 AX1=+0005.00 AX2=+0000.00 AX3=+0000.00 AX4=+0000.00\"]",
    );
    bench.at([0.0; 4]);
    assert_eq!(bench.page(0), 0b0010_0000);
    bench.ok("@HOME");
    assert_eq!(bench.page(0), 0b0000_1010, "it is executed, returns, and is not complete");
    bench.ng("@SPST 0001", "or jog runs");
    bench.pass(500);
    bench.at([0.0, 0.0, bench.sim.state().position[2], 0.0]);
    assert!(bench.sim.state().position[2] < -5.0, "Z comes first (P07)");
    bench.rest();
    // Z: 10 mm at 20 mm/s take 0.6 s with ramps; two moves of 1 mm at 2 mm/s take 1.2 s. Then X: 1.1 s and 1.2 s; Y:
    // 1.2 s.
    about(bench.now, 0.6 + 1.2 + 1.1 + 1.2);
    assert_eq!(bench.page(0), 0b0011_0000);
    bench.at([5.0, 0.0, 0.0, 0.0]);
    // The second time, the origin is known. The axis moves fast to the position of E13, and then 5 mm to the sensor.
    bench.ok("@HOME");
    bench.rest();
    assert_eq!(bench.page(0), 0b0011_0000);
    bench.at([5.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_stopped_return_to_origin_is_not_complete() {
    let mut bench = Bench::ready("position = [100.0, 0.0, 0.0, 0.0]");
    bench.ok("@HOME");
    bench.pass(300);
    bench.ok("@STOP");
    bench.rest();
    assert_eq!(bench.page(0), 0b0010_0000);
    bench.ok("@HOME");
    bench.rest();
    assert_eq!(bench.page(0), 0b0011_0000);
    bench.at([0.0; 4]);
    // A program that is stopped in HOME starts the return to origin again when it continues.
    let mut bench = Bench::with(&["HOME", TO_100, "END"], "position = [50.0, 0.0, 0.0, 0.0]");
    bench.start(200);
    assert_eq!(bench.page(0) & 0b1000, 0b1000);
    bench.ok("@STOP");
    bench.pass(2000);
    bench.resume();
    assert_eq!(bench.error(), None);
    bench.at([100.0, 0.0, 0.0, 0.0]);
}

#[test]
fn a_jog_needs_a_reset_and_moves_one_axis() {
    let mut bench = Bench::ready("");
    bench.ng("@JGST X=+H Y=SP Z=SP R=SP", "not reset");
    bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
    bench.ng("@JGST X=+H Y=+H Z=SP R=SP", "one axis at a time");
    bench.ng("@JGST X=+H Y=RS Z=SP R=SP", "SP");
    bench.ok("@JGST X=+H Y=SP Z=SP R=SP");
    bench.ok("@JGST X=+H Y=SP Z=SP R=SP");
    bench.ng("@JGST X=-H Y=SP Z=SP R=SP", "or jog runs");
    bench.pass(1000);
    bench.ok("@JGST X=SP Y=SP Z=SP R=SP");
    assert_eq!(bench.page(0) & 0b10, 0b10);
    bench.rest();
    bench.at([50.0, 0.0, 0.0, 0.0]);
    bench.ok("@JGST X=SP Y=-C Z=SP R=SP");
    bench.rest();
    bench.at([50.0, -0.01, 0.0, 0.0]);
    bench.ok("@HSOF");
    bench.ok("@HSON");
    bench.ng("@JGST X=SP Y=-C Z=SP R=SP", "not reset");
}

#[test]
fn a_jog_stops_when_the_host_goes_off() {
    for action in ["@HSOF", "pendant on", "@STOP"] {
        let mut bench = Bench::ready("");
        bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
        bench.ok("@JGST X=+L Y=SP Z=SP R=SP");
        bench.pass(1000);
        if action.starts_with('@') {
            bench.ok(action);
        } else {
            bench.console(action);
        }
        bench.pass(5000);
        bench.at([10.0, 0.0, 0.0, 0.0]);
    }
}

#[test]
fn a_jog_stops_at_the_soft_limit() {
    let toml = "position = [990.0, 0.0, 0.0, 0.0]";
    let mut bench = Bench::ready(toml);
    bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
    bench.ok("@JGST X=+L Y=SP Z=SP R=SP");
    bench.pass(10_000);
    assert_eq!(bench.error(), Some(0x28));
    bench.at([1000.5, 0.0, 0.0, 0.0]);
    bench.ok("@CERR");
    bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
    bench.ok("@JGST X=+C Y=SP Z=SP R=SP");
    assert_eq!(bench.error(), Some(0xC0), "not even a little");
    bench.ok("@CERR");
    bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
    bench.ok("@JGST X=-L Y=SP Z=SP R=SP");
    bench.pass(500);
    assert_eq!(bench.error(), None, "but back");
    // Without a known origin an axis has no limits.
    let mut bench = Bench::new("host = true");
    bench.ok("@JGST X=RS Y=RS Z=RS R=RS");
    bench.ok("@JGST X=-H Y=SP Z=SP R=SP");
    bench.pass(30_000);
    assert_eq!(bench.error(), None);
    assert!(bench.sim.state().position[0] < -1400.0);
}

#[test]
fn an_escape_input_ends_a_move() {
    let toml = "points.1.1 = [100.0, 0.0, 0.0, 0.0]\nwrite = [\"WPAR M03 0/01/1\"]";
    let bench = Bench::ran(&["MVE a PT=001 CN=00 S V=05", "CNT CN01=0001", "END"], toml);
    bench.at([100.0, 0.0, 0.0, 0.0]);
    let mut bench = Bench::with(&["MVE a PT=001 CN=00 S V=05", "CNT CN01=0001", "END"], toml);
    bench.start(300);
    bench.console("input 0/01/1 on");
    assert_eq!(bench.page(4) & 1, 1);
    bench.rest();
    bench.at([60.0, 0.0, 0.0, 0.0]);
    assert_eq!((bench.counter(1), bench.error()), (1, None));
    bench.run();
    bench.at([60.0, 0.0, 0.0, 0.0]);
}

#[test]
fn position_outputs_follow_the_position() {
    let steps = [
        "OUTS TA=0 STN=0 PN01=.......1 X>=+0050.00",
        "OUTS TA=1 STN=0 PN01=......1. X<=+0010.00",
        "OUTS TA=0 STN=0 PN01=.....1.. X>=+0200.00",
        TO_100,
        "CANS TA=0",
        "MOV a X=+0300.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 POST",
        "END",
    ];
    let mut bench = Bench::with(&steps, "instruction_us = 1\nwrite = [\"WPAR P13 AX1>=+0060.00 0/02/8\"]");
    bench.sim.record_trace(true);
    bench.start(10);
    assert_eq!(bench.port(1), 2, "what is there already is set at once");
    bench.rest();
    assert_eq!((bench.port(1), bench.port(2)), (3, 0x80), "the third was cancelled");
    let events = bench.sim.take_trace();
    let changes: Vec<(f64, u8)> = events
        .iter()
        .filter_map(|event| match event.what {
            What::Output { port, bits, .. } if port == 1 || port == 2 => Some((event.position[0], bits)),
            _ => None,
        })
        .collect();
    assert_eq!(changes.len(), 3);
    assert!((changes[1].0 - 50.0).abs() < 1e-3 && changes[1].1 == 3, "{changes:?}");
    assert!((changes[2].0 - 60.0).abs() < 1e-3 && changes[2].1 == 0x80, "{changes:?}");
    fails(&["OUTS TA=2 STN=0 PN01=.......1 X>=+0050.00", "END"], 0xBA);
}

#[test]
fn an_obstacle_causes_overflow_or_overload() {
    let mut bench = Bench::with(&[TO_100, "END"], "");
    bench.console("obstacle X 30");
    bench.start(500);
    bench.at([30.0, 0.0, 0.0, 0.0]);
    bench.rest();
    assert_eq!(bench.error(), Some(0x24), "70 mm are more than the 50 of E03");
    bench.at([30.0, 0.0, 0.0, 0.0]);
    let mut bench = Bench::with(&[TO_100, "END"], "");
    bench.console("obstacle X 80");
    bench.run();
    assert_eq!(bench.error(), Some(0x23), "a second of all its force");
    let mut bench = Bench::new("host = true\nposition = [30.0, 0.0, 0.0, 0.0]");
    bench.console("obstacle X -10");
    bench.ok("@HOME");
    bench.rest();
    assert_eq!(bench.error(), Some(0x27));
    assert_eq!(bench.page(0) & 0b11000, 0);
}

#[test]
fn torque_limits_end_moves() {
    let toml = "write = [\"WPAR M24 TA1=0/01/1 TA2=0/01/0 TA3=0/01/0 TA4=0/01/0\", \"WPAR M25 TA1=0/01/2 TA2=0/01/0 TA3=0/01/0 TA4=0/01/0\", \
        \"WPAR M26 TA1=0/01/3 TA2=0/01/0 TA3=0/01/0 TA4=0/01/0\"]";
    let steps = |limits: &str| {
        vec![format!("TLMV X TT=01 TM=000.5 {limits}"), TO_100.to_owned(), "CNT CN01=0001".to_owned(), "END".to_owned()]
    };
    let bench = |limits: &str, wall: bool| {
        let steps = steps(limits);
        let mut bench = Bench::with(&steps.iter().map(String::as_str).collect::<Vec<_>>(), toml);
        if wall {
            bench.console("obstacle X 80");
        }
        bench.ok("@SPST 0001");
        bench
    };
    // With torque end or lock end, the move ends at the obstacle, half a second after contact.
    for limits in ["TE=ON LE=OFF AE=OFF DD=ON", "TE=OFF LE=ON AE=OFF DD=ON"] {
        let mut bench = bench(limits, true);
        bench.pass(700);
        assert_eq!(bench.port(1), 0b011, "load and limit");
        bench.rest();
        assert_eq!((bench.error(), bench.counter(1)), (None, 1));
        bench.at([80.0, 0.0, 0.0, 0.0]);
    }
    // With neither torque end nor lock end, the locked axis pushes until the obstacle is removed.
    let mut bench1 = bench("TE=OFF LE=OFF AE=OFF DD=ON", true);
    bench1.pass(5000);
    assert_eq!((bench1.error(), bench1.counter(1), bench1.port(1)), (None, 0, 0b111));
    bench1.console("obstacle X off");
    bench1.rest();
    assert_eq!((bench1.error(), bench1.counter(1), bench1.port(1)), (None, 1, 0));
    bench1.at([100.0, 0.0, 0.0, 0.0]);
    // Without an obstacle, the axis arrives at its target. The arrival ends the move only if AE is on.
    let mut bench2 = bench("TE=ON LE=OFF AE=ON DD=ON", false);
    bench2.rest();
    assert_eq!(bench2.counter(1), 1);
    let mut bench3 = bench("TE=ON LE=OFF AE=OFF DD=ON", false);
    bench3.pass(5000);
    assert_eq!((bench3.counter(1), bench3.page(0) & 0b10), (0, 0b10));
    // Runs with and without overflow detection.
    for (watch, code) in [("ON", Some(0x24)), ("OFF", None)] {
        let limits = format!("TE=OFF LE=OFF AE=OFF DD={watch}");
        let steps = [format!("TLMV X TT=01 TM=000.5 {limits}"), TO_100.to_owned(), "END".to_owned()];
        let mut bench = Bench::with(&steps.iter().map(String::as_str).collect::<Vec<_>>(), toml);
        bench.console("obstacle X 30");
        bench.start(5000);
        assert_eq!(bench.error(), code);
    }
}

#[test]
fn the_host_supplies_coordinates() {
    let steps = [
        "RSMV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 PASS",
        "CNT+ CN01=0001",
        "JMPC TAG=001 CN01< 0002",
        "END",
    ];
    let mut steps = steps.map(str::to_owned).to_vec();
    steps.insert(0, "TAG TAG=001".to_owned());
    let mut bench = Bench::with(&steps.iter().map(String::as_str).collect::<Vec<_>>(), "");
    bench.start(1000);
    bench.answers("@RSTX 0000", "@RSTX 0002 RSMV a X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00 S V=05 PASS");
    assert_eq!(bench.page(4) & 0b100, 0, "that is no input");
    bench.ok("@MRSS TASK=01 X=+0010.00 Y=+0000.00 Z=+0000.00 R=+0000.00 V=00");
    bench.ok("@MRSS TASK=01 X=+0020.00 Y=+0000.00 Z=+0000.00 R=+0000.00 V=10");
    bench.ng("@MRSS TASK=01 X=+0030.00 Y=+0000.00 Z=+0000.00 R=+0000.00 V=00", "still waiting");
    bench.rest();
    assert_eq!((bench.error(), bench.counter(1)), (None, 2));
    bench.at([20.0, 0.0, 0.0, 0.0]);
}

#[test]
fn synchronized_axes_move_together() {
    let toml = "model = \"KCA-20-M00\"\nwrite = [\"WPAR E26 AX1=M AX2=S AX3=0 AX4=0\"]";
    let mut bench = Bench::ran(&[TO_100, "END"], toml);
    assert_eq!(bench.error(), Some(0x64));
    bench.ok("@CERR");
    bench.ng("@SORG 2", "no driven axis");
    bench.ok("@SORG 1");
    bench.rest();
    bench.run();
    assert_eq!(bench.error(), None);
    bench.at([100.0, 100.0, 0.0, 0.0]);
    let bench = Bench::new("model = \"KCA-20-M00\"\nwrite = [\"WPAR E26 AX1=M AX2=0 AX3=0 AX4=0\"]");
    assert_eq!(bench.error(), Some(0x66));
}

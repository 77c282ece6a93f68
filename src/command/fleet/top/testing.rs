//! Robots and samples for tests.

use armctl_frame::face::overview::OverviewReport;
use armctl_frame::face::sample::{Axis, Bank, Indicator, Sample, SignalByte, Whole};
use armctl_frame::prelude::*;
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::robot::state::{Fault, Mode, PositionMm, State};
use armctl_frame::settings::inventory::Inventory;
use armctl_frame::settings::{Selection, Sources};

/// Robots cell1, cell2 and so on, of the three families in turn.
pub fn fleet(robots: usize) -> Vec<Robot> {
    let target = |number: usize| match number % 3 {
        0 => "serial:///dev/ttyUSB0".to_owned(),
        1 => format!("udp://192.168.1.{number}"),
        _ => format!("eip://192.168.1.{number}"),
    };
    let entries: Vec<String> = (1..=robots)
        .map(|number| format!("[[robot]]\nname = \"cell{number}\"\ntarget = \"{}\"\n", target(number)))
        .collect();
    let inventory = Inventory::parse(&entries.concat(), "robots.toml").unwrap();
    let selection = Selection { all: true, ..Selection::default() };
    let sources = Sources { selection, inventory, ..Sources::default() };
    if robots == 0 { Vec::new() } else { sources.robots(None).unwrap() }
}

/// A running robot with all data of a screen; its first axis is at `position`.
pub fn sample(position: f64) -> Sample {
    let state = State {
        reachable: true,
        mode: Some(Mode::Automatic),
        controller_mode: Some("play"),
        servo_on: Some(true),
        running: Some(true),
        held: Some(false),
        fault: Fault::new(false, None),
        position: Some(PositionMm { x_mm: 1000.5, y_mm: -20.25, z_mm: 1234.0 }),
        ..State::default()
    };
    let line = OverviewReport { state, ..OverviewReport::default() };
    let joint = |name: &str, position, torque| Axis {
        name: name.to_owned(),
        position,
        unit: "pulses",
        torque: Some(torque),
        error: Some(0.0),
        ..Axis::default()
    };
    let coordinate = |name: &str, position, limits| Axis {
        name: name.to_owned(),
        position,
        unit: "mm",
        decimals: 3,
        limits,
        ..Axis::default()
    };
    let indicator = Indicator::new;
    let whole = Whole {
        indicators: vec![
            indicator("teach", false, Tone::Warning),
            indicator("play", true, Tone::Good),
            indicator("servo", true, Tone::Good),
            indicator("running", true, Tone::Good),
            indicator("hold", false, Tone::Warning),
            indicator("alarm", false, Tone::Bad),
            Indicator::expected("CPU OK", true, Tone::Bad),
        ],
        axes: vec![
            joint("S", position, 12.0),
            joint("L", -90_000.0, -3.0),
            coordinate("X", 1000.5, Some((-2000.0, 2000.0))),
            coordinate("Y", -20.25, None),
        ],
        torque_unit: Some("raw"),
        banks: vec![
            Bank { name: "inputs", groups: (1..=4).map(|at| SignalByte::rising(format!("#{at}0"), at)).collect() },
            Bank { name: "outputs", groups: (1..=4).map(|at| SignalByte::rising(format!("#100{at}0"), 0)).collect() },
        ],
        not_asked: None,
    };
    Sample { line, answered_in: Some(Duration::from_micros(4200)), alarms: Vec::new(), full: Some(whole) }
}

/// The same sample with two alarms, whose text contains terminal control characters.
pub fn with_alarm() -> Sample {
    let mut alarmed = sample(0.0);
    alarmed.line.state.running = Some(false);
    let alarm =
        |code: &str, text: &str| Alarm { code: Some(code.to_owned()), text: Some(text.to_owned()), ..Alarm::default() };
    alarmed.alarms = vec![alarm("4315", "COLLISION DETECT [SLURBT]"), alarm("1020", "衝突\x1b[2J検出")];
    alarmed.alarms[0].remedy = Some("look for what the robot ran into".to_owned());
    alarmed.line.state.fault = Fault::new(true, alarmed.alarms.first());
    alarmed
}

/// No answer.
pub fn fail() -> Failure {
    Failure::new(Kind::NoAnswer, "cell2 (udp://192.168.1.2): no answer within 3s")
        .hint("check address, cable and firewall")
}

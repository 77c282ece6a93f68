//! Keys of `armctl teach` as `yerc` command lines.

use serde_json::Value;

use armctl_frame::face::teach_panel::{Panel, Step, System, words};

const COORDINATES: [(&str, &str); 6] =
    [("X", "mm"), ("Y", "mm"), ("Z", "mm"), ("Rx", "deg"), ("Ry", "deg"), ("Rz", "deg")];
const AXES: [(&str, &str); 6] =
    [("S", "pulses"), ("L", "pulses"), ("U", "pulses"), ("R", "pulses"), ("B", "pulses"), ("T", "pulses")];
const FLAGS: [&str; 6] = ["--x", "--y", "--z", "--rx", "--ry", "--rz"];
const JOINT: &str = "joint";

/// Keys for this family. See [`Panel`].
pub const PANEL: Panel = Panel {
    systems: &[
        coordinates("base", |step| relative(step, "base")),
        coordinates("tool", |step| relative(step, "tool")),
        System {
            name: JOINT,
            axes: &AXES,
            steps: &[10.0, 100.0, 1000.0, 5000.0],
            speeds: &[1, 2, 5, 10],
            speed_unit: "%",
            step: joint,
        },
    ],
    position: &["position"],
    stop: &["hold", "on"],
    release: Some(&["hold", "off"]),
    stored: |point| words(&format!("var get P{point}")),
    store: |point, system| {
        let kind = if system.name == JOINT { " --coordinates pulse" } else { "" };
        words(&format!("teach P{point}{kind}"))
    },
    go: |point, system, speed| match system.name {
        JOINT => words(&format!("move joint --to P{point} --speed {speed}%")),
        _ => words(&format!("move linear --to P{point} --speed {speed}mm/s")),
    },
    point: |point| format!("P{point}"),
    small_step: None,
};

const fn coordinates(name: &'static str, step: fn(&Step<'_>) -> Option<Vec<String>>) -> System {
    System {
        name,
        axes: &COORDINATES,
        steps: &[0.01, 0.1, 1.0, 10.0],
        speeds: &[1, 5, 10, 25, 50],
        speed_unit: "mm/s, deg/s",
        step,
    }
}

fn relative(step: &Step<'_>, system: &str) -> Option<Vec<String>> {
    let flag = FLAGS.get(step.axis)?;
    let unit = if step.axis < 3 { "mm/s" } else { "deg/s" };
    Some(words(&format!("move relative {flag} {} --coordinate {system} --speed {}{unit}", step.by, step.speed)))
}

/// The protocol has no relative joint motion. For this reason the target is computed from the current position.
fn joint(step: &Step<'_>) -> Option<Vec<String>> {
    let pulse = &step.from["pulse"];
    let axes = pulse["pulses"].as_object()?;
    let mut pulses: Vec<f64> = axes.values().map(Value::as_f64).collect::<Option<_>>()?;
    *pulses.get_mut(step.axis)? += step.by;
    let pulses: Vec<String> = pulses.iter().map(f64::to_string).collect();
    let tool = pulse["tool"].as_u64()?;
    let line = format!("move pulse joint --pulses={} --tool {tool} --speed {}%", pulses.join(","), step.speed);
    Some(words(&line))
}

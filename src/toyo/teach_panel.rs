//! Keys of `armctl teach` as command lines of `toyo`.

use serde_json::Value;

use armctl_frame::face::teach_panel::{Panel, SmallStep, System, words};

const AXES: [(&str, &str); 4] = [("X", "mm"), ("Y", "mm"), ("Z", "mm"), ("R", "mm")];

/// See [`Panel`]. Each command moves the axis once by the inching step of the controller (parameter P12).
pub const PANEL: Panel = Panel {
    systems: &[System {
        name: "axes",
        axes: &AXES,
        steps: &[1.0, 10.0, 100.0],
        speeds: &[],
        speed_unit: "",
        step: |step| {
            let (axis, _) = AXES.get(step.axis)?;
            let direction = if step.by < 0.0 { "-" } else { "+" };
            Some(words(&format!("jog {axis} {direction} inch --steps {}", step.by.abs())))
        },
    }],
    position: &["position"],
    stop: &["stop", "--jog"],
    release: None,
    stored: |point| words(&format!("point get {point}")),
    store: |point, _| words(&format!("teach {point}")),
    go: |point, _, _| words(&format!("run point {point}")),
    point: |point| format!("point {point}"),
    small_step: Some(SmallStep { words: &["param", "get", "P12"], size: small_step }),
};

fn small_step(parameter: &Value, axis: usize) -> Option<f64> {
    parameter["items"][0]["value"].get(axis)?["value"].as_f64()
}

//! Keys of `armctl teach` as `yrcx` command lines.

use armctl_frame::face::teach_panel::{Panel, System, words};

/// Keys of the teach panel; see [`Panel`].
pub const PANEL: Panel = Panel {
    systems: &[
        System {
            name: "cartesian",
            axes: &[("X", "mm"), ("Y", "mm"), ("Z", "mm"), ("R", "deg")],
            steps: &[0.01, 0.1, 1.0, 10.0],
            speeds: &[1, 2, 5, 10],
            speed_unit: "%",
            step: |step| Some(words(&format!("movei --by {}={} --speed {}", step.axis + 1, step.by, step.speed))),
        },
        System {
            name: "axes",
            axes: &[("1", "mm or deg"), ("2", "mm or deg"), ("3", "mm or deg"), ("4", "mm or deg")],
            steps: &[0.01, 0.1, 1.0, 10.0],
            speeds: &[1, 2, 5, 10],
            speed_unit: "%",
            step: |step| {
                Some(words(&format!("drivei --axis {} --by={} --speed {}", step.axis + 1, step.by, step.speed)))
            },
        },
    ],
    position: &["position"],
    stop: &["stop"],
    release: None,
    stored: |point| words(&format!("point get {point}")),
    store: |point, _| words(&format!("teach {point}")),
    go: |point, _, speed| words(&format!("move --point {point} --speed {speed}")),
    point: |point| format!("point {point}"),
    small_step: None,
};

//! Axes of a robot, as topics and recordings contain them.

use armctl_frame::face::sample::Sample;
use armctl_frame::prelude::*;

/// All axes and coordinates of a robot.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Axes {
    /// Axes of the first group or robot, then its coordinates in base coordinates with their rotation.
    axes: Vec<AxisValue>,
    /// Reason why the axes were not read; null if they were read.
    not_asked: Option<&'static str>,
}

/// An axis or a coordinate.
#[derive(Debug, Clone, Serialize, JsonSchema)]
struct AxisValue {
    /// Name: `S`, `X`, `Rz`, `1`.
    axis: String,
    /// Position.
    position: f64,
    /// Unit of the position: `pulses`, `mm` or `deg`.
    unit: &'static str,
    /// Torque; null if the protocol does not report it.
    torque: Option<f64>,
    /// Unit of the torque: `% of max`, or `raw` if the unit is not known.
    torque_unit: Option<&'static str>,
}

impl Axes {
    /// Axes of a sample.
    pub fn of(sample: &Sample) -> Self {
        let Some(whole) = &sample.full else { return Self { axes: Vec::new(), not_asked: sample.line.not_asked } };
        let axes = whole.axes.iter().map(|axis| AxisValue {
            axis: axis.name.clone(),
            position: axis.position,
            unit: axis.unit,
            torque: axis.torque,
            torque_unit: axis.torque.and(whole.torque_unit),
        });
        Self { axes: axes.collect(), not_asked: whole.not_asked }
    }
}

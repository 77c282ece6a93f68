//! `yrcx info torque` (4.7.12, 4.7.18).

use crate::prelude::*;
use crate::single_command::one_row;
use armctl_controller::yrcx::table::Command;

one_row! {
    /// Reads the torque of axes; the sign is the direction.
    Torque(self) "yrcx.info.torque" -> Torques {
        /// Torque that counts as 100 %
        #[arg(long, value_name = "TORQUE", default_value = "max")]
        of: Reference,
        /// Axes, for example 1,3 [default: all axes]
        #[arg(long, value_name = "AXES", value_delimiter = ',', value_parser = clap::value_parser!(u8).range(1..=4))]
        axes: Vec<u8>,
    }
    gives match self.of {
        Reference::Max => Command::TorqueOfMax,
        Reference::Rated => Command::TorqueOfRated,
    },
    with draft => {
        let bits = self.axes.iter().fold(0, |bits, axis| bits | 1 << (axis - 1));
        draft.with(Key::Axes, bits)
    },
    done as answer => {
        let axes = (1..).zip(Key::AXES).filter(|(axis, _)| self.axes.is_empty() || self.axes.contains(axis));
        let axes =
            axes.map(|(axis, key)| AxisTorque { axis, torque_percent: answer.values.int(key).unwrap_or_default() });
        Torques { of: self.of, axes: axes.collect() }
    };
}

/// Reference of the torque percentage.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// Percent of the maximum torque
    Max,
    /// Percent of the rated torque
    Rated,
}

/// Torques of the selected axes.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Torques {
    /// Torque that is 100 %: the maximum or the rated torque.
    of: Reference,
    axes: Vec<AxisTorque>,
}

/// The torque of an axis.
#[derive(Debug, Serialize, JsonSchema)]
struct AxisTorque {
    /// Axis number, 1 to 4.
    #[serde(rename = "axis_number")]
    axis: u8,
    /// Torque in percent; also 0 for an axis that does not exist.
    torque_percent: i32,
}

impl Report for Torques {
    fn view(&self) -> View {
        let column = match self.of {
            Reference::Max => "% of maximum",
            Reference::Rated => "% of rated",
        };
        let mut table = Table::new(&["axis", column], "no axes");
        for AxisTorque { axis, torque_percent } in &self.axes {
            table.row([(*axis).into(), (*torque_percent).into()]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, objection, run_on};

    #[test]
    fn torques_have_a_sign_and_all_axes_are_read() {
        let mut end = [0; 16];
        (end[0], end[2]) = (0x0200, 0xFFEC);
        let (read, peer) = run_on(Scripted::new([Reply::AddressPair(1, end)]), &["info", "torque"]);
        let read = read.unwrap();
        assert_eq!((&read["axes"][0]["torque_percent"], &read["axes"][3]["axis_number"]), (&json!(-20), &json!(4)));
        assert_eq!(peer.taken[0][2], 0);
        assert!(objection(&["info", "torque", "--axes", "5"]).contains("1..=4"));
    }
}

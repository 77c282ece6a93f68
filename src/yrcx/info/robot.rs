//! Commands whose report comes from a single answer: `yrcx info version` (4.7.1), `system` (4.7.2), `speed` (4.7.8),
//! `inch` (4.7.16).

use crate::prelude::*;
use crate::single_command::{format_field, one_row};
use armctl_controller::yrcx::table::Command;

one_row! {
    /// Reads the versions.
    Version(self) "yrcx.info.version" -> Versions {}
    gives Command::Versions,
    done as answer => {
        let told = |key| format_field(Command::Versions, &answer.values, key);
        Versions {
            host_version: told(Key::HostVersion),
            host_revision: told(Key::HostRevision),
            fpga_version: told(Key::FpgaVersion),
            driver_versions: DRIVERS.map(told),
        }
    };

    /// Reads the model numbers of a robot and its axes.
    System(self) "yrcx.info.system" -> Models {}
    gives Command::System,
    done as answer => {
        // The controller reports 0 for a robot or axis that is not present.
        let model = |key| answer.values.int(key).filter(|number| *number != 0);
        Models { robot_type: model(Key::RobotType), axis_types: Key::AXES.map(model) }
    };

    /// Reads the speed settings.
    Speed(self) "yrcx.info.speed" -> Speeds {}
    gives Command::SpeedStatus,
    done as answer => {
        // The controller reports 0 for a robot without axes.
        let speed = |key| answer.values.int(key).filter(|percent| *percent != 0);
        Speeds {
            manual_speed_percent: speed(Key::ManualSpeed),
            auto_speed_percent: speed(Key::AutoSpeed),
            program_speed_percent: speed(Key::ProgramSpeed),
        }
    };

    /// Reads the inching distance.
    Inch(self) "yrcx.info.inch" -> Amount {}
    gives Command::InchAmountGet,
    done as answer => {
        let amount = answer.values.int(Key::InchingAmount).unwrap_or_default();
        Amount { amount_pulses: amount, amount_mm: f64::from(amount) / 1000.0 }
    };
}

const DRIVERS: [Key; 4] = [Key::DriverVersion1, Key::DriverVersion2, Key::DriverVersion3, Key::DriverVersion4];

/// Versions in normal notation. The manual does not say whether the digits after the point are decimal.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Versions {
    host_version: Option<String>,
    host_revision: Option<String>,
    /// Version of the FPGA of the driver.
    fpga_version: Option<String>,
    /// Versions of the drivers of axes 1 to 4.
    driver_versions: [Option<String>; 4],
}

impl Report for Versions {
    fn view(&self) -> View {
        let cell = |text: &Option<String>| Cell::optional(text.as_deref());
        let [first, second, third, fourth] = &self.driver_versions;
        View::fields([
            ("host", cell(&self.host_version)),
            ("host revision", cell(&self.host_revision)),
            ("driver FPGA", cell(&self.fpga_version)),
            ("driver of axis 1", cell(first)),
            ("driver of axis 2", cell(second)),
            ("driver of axis 3", cell(third)),
            ("driver of axis 4", cell(fourth)),
        ])
    }
}

/// Model numbers; null for a robot or axis that is not present.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Models {
    robot_type: Option<i32>,
    /// Model numbers of axes 1 to 4.
    axis_types: [Option<i32>; 4],
}

impl Report for Models {
    fn view(&self) -> View {
        let cell = |model: Option<i32>| Cell::optional(model.map(|number| number.to_string()));
        let [first, second, third, fourth] = self.axis_types.map(cell);
        View::fields([
            ("robot type", cell(self.robot_type)),
            ("type of axis 1", first),
            ("type of axis 2", second),
            ("type of axis 3", third),
            ("type of axis 4", fourth),
        ])
    }
}

/// Speed settings, 1 to 100 %; null for a robot without axes.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Speeds {
    manual_speed_percent: Option<i32>,
    auto_speed_percent: Option<i32>,
    program_speed_percent: Option<i32>,
}

impl Report for Speeds {
    fn view(&self) -> View {
        let cell = |speed: Option<i32>| Cell::optional(speed.map(|percent| format!("{percent} %")));
        View::fields([
            ("manual", cell(self.manual_speed_percent)),
            ("automatic", cell(self.auto_speed_percent)),
            ("program", cell(self.program_speed_percent)),
        ])
    }
}

/// Inching distance: one number, whose unit depends on the inching command.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Amount {
    /// Distance for a single axis, in pulses.
    amount_pulses: i32,
    /// Distance along a Cartesian or tool axis, in mm.
    amount_mm: f64,
}

impl Report for Amount {
    fn view(&self) -> View {
        View::fields([
            ("inching an axis", format!("{} pulses", self.amount_pulses).into()),
            ("Cartesian or tool", Cell::from(format!("{:.3} mm", self.amount_mm))),
        ])
    }
}

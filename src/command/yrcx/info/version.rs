//! `yrcx info version` (4.7.1).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::yrcx::single::{one_row, shown};
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::output::view::{Cell, View};

one_row! {
    /// Reads the versions.
    Version(self) "yrcx.info.version" -> Versions {}
    gives Command::Versions,
    done as answer => {
        let told = |key| shown(Command::Versions, &answer.values, key);
        Versions {
            host_version: told(Key::HostVersion),
            host_revision: told(Key::HostRevision),
            fpga_version: told(Key::FpgaVersion),
            driver_versions: DRIVERS.map(told),
        }
    };
}

const DRIVERS: [Key; 4] = [Key::DriverVersion1, Key::DriverVersion2, Key::DriverVersion3, Key::DriverVersion4];

/// Versions as people write them. The manual leaves open whether the digits after the point are decimal.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Versions {
    host_version: Option<String>,
    host_revision: Option<String>,
    /// Of the driver's FPGA.
    fpga_version: Option<String>,
    /// Of the drivers of axes 1 to 4.
    driver_versions: [Option<String>; 4],
}

impl Report for Versions {
    fn view(&self) -> View {
        let cell = |text: &Option<String>| Cell::maybe(text.as_deref());
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["info", "version"]).unwrap(), [example("4.7.1-reference")]);
        let versions = read_example("4.7.1-reference", &["info", "version"]);
        let driver = ["V1.01"; 4];
        assert_eq!(
            versions,
            json!({"host_version": "V1.08", "host_revision": "R0048", "fpga_version": "V1.001", "driver_versions": driver})
        );
    }
}

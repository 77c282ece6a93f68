//! Argument `--unit`: the robot of the controller that a command applies to.

use clap::Args;

use armctl_frame::AnyFamilyArguments;
use armctl_frame::gate::Intent;

/// Argument that selects a robot.
#[derive(Debug, Args)]
pub struct Unit {
    /// Robot of the controller, 1 to 4 [default: all robots if the command can apply to all, otherwise 1]
    #[arg(long, global = true, value_name = "N", default_value_t = 0, hide_default_value = true, help_heading = "Which \
        robot",
        value_parser = clap::value_parser!(u8).range(0..=4))]
    unit: u8,
}

impl Unit {
    /// Returns the robot number; 0 if the user selected none.
    pub fn number(&self) -> u8 {
        self.unit
    }
}

impl AnyFamilyArguments for Unit {
    fn complete(&self, mut intent: Intent) -> Intent {
        let robot = format!("robot {}", self.unit);
        if self.unit > 0 && !intent.text.is_empty() && !intent.text.contains(&robot) {
            intent.text.push_str(&format!(", {robot}"));
        }
        intent
    }

    fn words(&self) -> Vec<String> {
        if self.unit == 0 { Vec::new() } else { vec!["--unit".to_owned(), self.unit.to_string()] }
    }
}

//! `yrcx speed` (4.2.14 to 4.2.16).

use clap::{Args, ValueEnum};

use super::link;
use super::single::Single;
use crate::command::frame::orders::Done;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;

/// Sets a speed.
#[derive(Debug, Args)]
#[command(after_help = "`yrcx info speed` reads them.")]
pub struct Speed {
    /// Which one
    setting: Setting,
    /// Percent, 1 to 100
    percent: String,
}

/// Which speed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Setting {
    /// Of jogs and inching
    Manual,
    /// Of automatic operation; reduces all others
    Auto,
    /// Of programs, and of motions without a speed of their own
    Program,
}

impl Single for Speed {
    type Report = Done;
    const ID: &'static str = "yrcx.speed";

    fn command(&self) -> Command {
        match self.setting {
            Setting::Manual => Command::SpeedManual,
            Setting::Auto => Command::SpeedAuto,
            Setting::Program => Command::SpeedProgram,
        }
    }

    fn fill(&self, draft: Draft) -> Draft {
        draft.with(Key::SpeedPercent, self.percent.trim_end_matches('%'))
    }

    fn report(&self, _done: &link::Done) -> Result<Done, Failure> {
        let setting = match self.setting {
            Setting::Manual => "manual",
            Setting::Auto => "automatic",
            Setting::Program => "program",
        };
        Ok(Done::new(format!("set the {setting} speed to {} %", self.percent.trim_end_matches('%'))))
    }
}

#[cfg(test)]
mod tests {
    use crate::command::yrcx::testing::{objection, words};

    #[test]
    fn each_speed_has_its_command_and_the_same_range() {
        assert_eq!(words(&["speed", "auto", "100%", "--unit", "2"]).unwrap()[0][..3], ["0x2039", "0x0000", "0x0064"]);
        for wrong in ["0", "101", "5.5", "fast"] {
            let failure = words(&["speed", "manual", wrong]).unwrap_err();
            assert!(failure.message.contains("speed_percent"), "{wrong}: {failure}");
        }
        assert!(objection(&["speed", "jog", "5"]).contains("manual, auto, program"));
    }
}

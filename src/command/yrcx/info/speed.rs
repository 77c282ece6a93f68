//! `yrcx info speed` (4.7.8).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::yrcx::single::one_row;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::output::view::{Cell, View};

one_row! {
    /// Reads the speed settings.
    Speed(self) "yrcx.info.speed" -> Speeds {}
    gives Command::SpeedStatus,
    done as answer => {
        // 0 is that of a robot without axes.
        let speed = |key| answer.values.int(key).filter(|percent| *percent != 0);
        Speeds {
            manual_speed_percent: speed(Key::ManualSpeed),
            auto_speed_percent: speed(Key::AutoSpeed),
            program_speed_percent: speed(Key::ProgramSpeed),
        }
    };
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
        let cell = |speed: Option<i32>| Cell::maybe(speed.map(|percent| format!("{percent} %")));
        View::fields([
            ("manual", cell(self.manual_speed_percent)),
            ("automatic", cell(self.auto_speed_percent)),
            ("program", cell(self.program_speed_percent)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["info", "speed"]).unwrap(), [example("4.7.8-reference")]);
        assert_eq!(
            read_example("4.7.8-reference", &["info", "speed"]),
            json!({"manual_speed_percent": 50, "auto_speed_percent": 50, "program_speed_percent": 50})
        );
        assert_eq!(words(&["info", "speed", "--unit", "4"]).unwrap()[0][0], "0x450A");
    }
}

//! `yrcx info system` (4.7.2).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::yrcx::single::one_row;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::output::view::{Cell, View};

one_row! {
    /// Reads the model numbers of a robot and its axes.
    System(self) "yrcx.info.system" -> Models {}
    gives Command::System,
    done as answer => {
        // 0 is what is not there.
        let model = |key| answer.values.int(key).filter(|number| *number != 0);
        Models { robot_type: model(Key::RobotType), axis_types: Key::AXES.map(model) }
    };
}

/// Model numbers; null for what is not there.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Models {
    robot_type: Option<i32>,
    /// Of axes 1 to 4.
    axis_types: [Option<i32>; 4],
}

impl Report for Models {
    fn view(&self) -> View {
        let cell = |model: Option<i32>| Cell::maybe(model.map(|number| number.to_string()));
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["info", "system"]).unwrap(), [example("4.7.2-reference")]);
        let read = read_example("4.7.2-reference", &["info", "system"]);
        assert_eq!(read, json!({"robot_type": 2000, "axis_types": [2000, 2000, 2000, 2000]}));
    }
}

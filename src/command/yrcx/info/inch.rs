//! `yrcx info inch` (4.7.16).

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::yrcx::single::one_row;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::output::view::{Cell, View};

one_row! {
    /// Reads the inching amount.
    Inch(self) "yrcx.info.inch" -> Amount {}
    gives Command::InchAmountGet,
    done as answer => {
        let amount = answer.values.int(Key::InchingAmount).unwrap_or_default();
        Amount { amount_pulses: amount, amount_mm: f64::from(amount) / 1000.0 }
    };
}

/// How far inching goes: one number, in the unit of the inching command.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Amount {
    /// Of an axis.
    amount_pulses: i32,
    /// The same along a Cartesian axis, or one of the tool.
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

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_example_of_the_manual() {
        assert_eq!(words(&["info", "inch"]).unwrap(), [example("4.7.16-reference")]);
        let read = read_example("4.7.16-reference", &["info", "inch"]);
        assert_eq!(read, json!({"amount_pulses": 100, "amount_mm": 0.1}));
    }
}

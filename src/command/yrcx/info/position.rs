//! `yrcx info position` (4.7.4).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::yrcx::link::Done;
use crate::command::yrcx::position::{Position, Unit};
use crate::command::yrcx::single::{Single, shown};
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::view::{Section, View};

/// Reads the position.
#[derive(Debug, Args)]
pub struct Where {
    /// Unit of the position
    #[arg(long, value_name = "UNIT", default_value = "mm")]
    report: Unit,
}

impl Single for Where {
    type Report = Place;
    const ID: &'static str = "yrcx.info.position";

    fn command(&self) -> Command {
        match self.report {
            Unit::Mm => Command::PositionMm,
            Unit::Pulse => Command::PositionPulse,
        }
    }

    fn report(&self, done: &Done) -> Result<Place, Failure> {
        Ok(Place {
            position: Position::of(&done.values, Some(self.report)),
            hand: shown(Command::PositionMm, &done.values, Key::HandSystem),
        })
    }
}

/// Where a robot is.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Place {
    #[serde(flatten)]
    position: Position,
    /// `right`, `left` or `none`: the hand system of a position in millimetres.
    hand: Option<String>,
}

impl Report for Place {
    fn view(&self) -> View {
        let table = self.position.table().map(Section::Table);
        let hand = self.hand.as_ref().filter(|hand| *hand != "none");
        let hand = hand.map(|hand| Section::Fields(vec![("hand system", hand.as_str().into())]));
        View { sections: table.into_iter().chain(hand).collect() }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, read_example, words};

    #[test]
    fn the_examples_of_the_manual() {
        assert_eq!(words(&["info", "position", "--report", "pulse"]).unwrap(), [example("4.7.4-pulse")]);
        assert_eq!(words(&["info", "position"]).unwrap(), [example("4.7.4-mm")]);
        let pulses = read_example("4.7.4-pulse", &["info", "position", "--report", "pulse"]);
        assert_eq!((&pulses["position_mm"], &pulses["hand"]), (&json!(null), &json!(null)));
        assert_eq!(pulses["position_pulses"].as_array().unwrap().len(), 4);
        let place = read_example("4.7.4-mm", &["info", "position"]);
        assert_eq!(place["hand"], json!("none"), "bit 0, which the example has, is not used");
        assert!(place["position_mm"][0].is_f64() && place["position_pulses"].is_null(), "{place}");
    }
}

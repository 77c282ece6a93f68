//! `yrcx info origin` (4.7.11).

use crate::prelude::*;
use crate::refusal::invalid_words;
use crate::single_command::format_field;

/// Reads the origin return status: with --unit, of each axis of that robot; without --unit, of all robots together.
#[derive(Debug, Args)]
pub struct Origin {
    /// Read only the axes with this type of motor (needs --unit)
    #[arg(long, value_name = "TYPE", value_parser = ["incremental", "absolute"])]
    motor: Option<String>,
}

impl Command for Origin {
    type Family = Yrcx;
    type Report = Origins;
    const ID: &'static str = "yrcx.info.origin";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Origins> {
        let link = context.link;
        let draft = link.draft(table::Command::OriginStatus)?.with_some(Key::MotorType, self.motor.clone());
        let order = draft.build().map_err(|error| match error.place.key {
            Some(Key::MotorType) => {
                Failure::usage("--motor needs one robot").hint("select the robot, such as --unit 1")
            }
            _ => invalid_words(&error),
        })?;
        let values = link.ask(&order).await?.values;
        let state = |key| format_field(table::Command::OriginStatus, &values, key);
        let axes = (1..).zip(Key::AXES).filter_map(|(axis, key)| Some(AxisOrigin { axis, state: state(key)? }));
        Ok(match state(Key::System) {
            Some(system) => Origins { system: Some(system), axes: Vec::new() },
            None => Origins { system: None, axes: axes.collect() },
        })
    }
}

/// Origin return status.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Origins {
    /// Status of all robots together: `complete` or `incomplete`; null with --unit.
    system: Option<String>,
    /// Axes of the robot that --unit selects; empty without --unit.
    axes: Vec<AxisOrigin>,
}

/// Origin return status of an axis.
#[derive(Debug, Serialize, JsonSchema)]
struct AxisOrigin {
    /// Axis number, 1 to 4.
    #[serde(rename = "axis_number")]
    axis: usize,
    /// Status of the axis: `complete`, `incomplete`, or `not applicable`.
    state: String,
}

fn cell(state: &str) -> Cell {
    let tone = match state {
        "complete" => Tone::Good,
        "incomplete" => Tone::Warning,
        _ => Tone::Plain,
    };
    Cell::from(state).tone(tone)
}

impl Report for Origins {
    fn view(&self) -> View {
        if let Some(system) = &self.system {
            return View::fields([("origin", cell(system))]);
        }
        let mut table = Table::new(&["axis", "origin"], "this robot has no axes");
        for AxisOrigin { axis, state } in &self.axes {
            table.row([(*axis).into(), cell(state)]);
        }
        View::table(table)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, run_on, words};

    #[test]
    fn reads_the_system_origin_without_a_robot() {
        let mut end = [0; 16];
        (end[0], end[2]) = (0x0200, 1);
        let (read, peer) = run_on(Scripted::new([Reply::AddressPair(1, end)]), &["info", "origin"]);
        assert_eq!(read.unwrap(), json!({"system": "complete", "axes": []}));
        assert_eq!(peer.taken[0][0], 0x050F);
        assert_eq!(words(&["info", "origin", "--unit", "2", "--motor", "absolute"]).unwrap()[0][2], "0x0002");
        assert!(words(&["info", "origin", "--motor", "absolute"]).unwrap_err().message.contains("one robot"));
    }
}

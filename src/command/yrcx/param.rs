//! `yrcx param` (4.4.2): parameters of the robot and of its axes.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::link::Yrcx;
use super::numbers::single;
use super::overwrite::Stored;
use super::several::ask_each;
use super::single::one_row;
use crate::command::robot::item::{Columns, Item, Items};
use crate::command::yrcx::complete;
use crate::command::{Command, Context, commands};
use crate::controller::nearest::nearest;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table;
use crate::controller::yrcx::table::parameter::{PARAMETERS, Parameter};
use crate::controller::yrcx::value::Key;
use crate::failure::Failure;
use crate::output::view::Cell;

commands! {
    /// Commands for parameters.
    pub enum Param {
        /// Read parameters: WEIGHT, or TOLE --axis 1,3
        Get(Get),
        /// Set a parameter: TOLE 1000 --axis 3
        Set(Set),
    }
}

/// List of the parameters.
fn listing() -> String {
    let line = |parameter: &Parameter| {
        let Parameter { number, name, meaning, span: (least, most), .. } = *parameter;
        let unit = if parameter.unit.is_empty() { String::new() } else { format!(" ({})", parameter.unit) };
        let most = if most == i32::MAX { "maximum payload".to_owned() } else { most.to_string() };
        format!("  {name:<8} {number:>3}  {meaning}{unit}, {least} to {most}")
    };
    let of = |per_axis| PARAMETERS.iter().filter(move |parameter| parameter.per_axis == per_axis).map(line);
    let lines = |per_axis| of(per_axis).collect::<Vec<_>>().join("\n");
    format!("Of the robot:\n{}\n\nOf an axis:\n{}", lines(false), lines(true))
}

fn parameter(text: &str) -> Result<&'static Parameter, String> {
    let number = single(table::Command::ParamGet, Key::Parameter, text).map_err(|why| {
        match nearest(text, PARAMETERS.iter().map(|parameter| parameter.name)) {
            Some(near) => format!("{why}; did you mean {near}?"),
            None => why,
        }
    })?;
    Parameter::from_number(number).ok_or_else(|| format!("parameter {number} does not exist"))
}

/// Reads parameters one after the other.
#[derive(Debug, Args)]
#[command(after_help = listing())]
pub struct Get {
    /// Parameters by name or number, as in TOLE or 259
    #[arg(required = true, value_name = "PARAMETER", value_delimiter = ',', value_parser = parameter, add = complete::PARAMETER)]
    parameters: Vec<&'static Parameter>,
    /// Axes, 1 to 4: 3, or 1,2,3,4; for parameters of an axis
    #[arg(long, value_name = "AXES", value_delimiter = ',', value_parser = clap::value_parser!(u8).range(1..=4))]
    axis: Vec<u8>,
}

impl Command for Get {
    type Family = Yrcx;
    type Report = Items<i32, Setting>;
    const ID: &'static str = "yrcx.param.get";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Items<i32, Setting>, Failure> {
        let Context { link, screen, .. } = context;
        let axes: Vec<Option<u8>> =
            if self.axis.is_empty() { vec![None] } else { self.axis.iter().copied().map(Some).collect() };
        let wanted = self.parameters.iter().flat_map(|parameter| axes.iter().map(|axis| (*parameter, *axis)));
        let wanted: Vec<(&Parameter, Option<u8>)> = wanted.collect();
        let order = |(parameter, axis): &(&Parameter, Option<u8>)| {
            let draft = link.draft(table::Command::ParamGet)?.with(Key::Parameter, parameter.number);
            Ok(draft.with_some(Key::Axes, axis.map(|axis| axis.to_string())).build()?)
        };
        let orders = wanted.iter().map(order).collect::<Result<Vec<Order>, Failure>>()?;
        let answers = ask_each(link, screen, "reading parameters", &orders).await?;
        let items = wanted.iter().zip(answers.outcomes).map(|((parameter, axis), outcome)| {
            let Parameter { name, number, unit, meaning, .. } = **parameter;
            let unit = Some(unit).filter(|unit| !unit.is_empty());
            let value = outcome.map(|values| Some(values.int(Key::Value).unwrap_or_default()));
            let more = Setting { number, axis: *axis, unit, meaning };
            let of_axis = axis.map_or_else(|| "-".into(), Cell::from);
            let cells = |value: &i32| vec![of_axis.clone(), (*value).into(), Cell::optional(unit), meaning.into()];
            let item = Item::with("parameter", name, more, value);
            if item.ok { item.with_cells(cells) } else { Item { cells: vec![of_axis], ..item } }
        });
        let columns =
            Columns { name: "parameter", values: vec!["axis", "value", "unit", "meaning"], empty: "no parameters" };
        Items::new(columns, items.collect()).asked(answers.asked).single_failure()
    }
}

/// Attributes of a parameter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Setting {
    /// Number in the robot language.
    number: u16,
    /// 1 to 4; null for a parameter of the robot.
    #[serde(rename = "axis_number")]
    axis: Option<u8>,
    /// Unit; null if the manual does not define it.
    unit: Option<&'static str>,
    meaning: &'static str,
}

one_row! {
    /// Sets a parameter.
    #[command(after_help = listing())]
    Set(self) "yrcx.param.set" -> Stored {
        /// Parameter by name or number, as in TOLE or 259
        #[arg(value_name = "PARAMETER", value_parser = parameter, add = complete::PARAMETER)]
        parameter: &'static Parameter,
        /// A whole number in the unit of the parameter
        #[arg(value_name = "VALUE", allow_negative_numbers = true)]
        value: String,
        /// Axis, 1 to 4; for a parameter of an axis
        #[arg(long, value_name = "AXIS")]
        axis: Option<String>,
    }
    gives table::Command::ParamSet,
    with draft => {
        let draft = draft.with(Key::Parameter, self.parameter.number).with(Key::Value, self.value.as_str());
        draft.with_some(Key::Axes, self.axis.clone())
    },
    done {
        let Parameter { name, unit, .. } = self.parameter;
        let axis = self.axis.as_ref().map(|axis| format!(" of axis {axis}")).unwrap_or_default();
        format!("{name}{axis} = {} {unit}", self.value).trim_end().to_owned()
    };
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::command::yrcx::testing::{example, objection, read_example, words, written};

    #[test]
    fn the_examples_of_the_manual() {
        let set = ["param", "set", "TOLE", "1000", "--axis", "3"];
        assert_eq!(written(&set).unwrap(), [example("4.4.2-assign")]);
        assert_eq!(read_example("4.4.2-assign", &set)["items"][0]["new"], 1000);
        let read = read_example("4.4.2-reference", &["param", "get", "outpos", "--axis", "1"]);
        let row = json!({
            "name": "OUTPOS", "label": null, "kind": "parameter", "number": 260, "axis_number": 1, "unit": "pulses",
            "meaning": "OUT effective position", "ok": true, "value": 131_071,
        });
        assert_eq!(read, json!({"items": [row]}));
    }

    #[test]
    fn several_parameters_of_several_axes() {
        let sent = words(&["param", "get", "TOLE,260", "--axis", "1,4", "--unit", "2"]).unwrap();
        let heads: Vec<String> = sent.iter().map(|words| words[..4].join(" ")).collect();
        assert_eq!(
            heads,
            [
                "0x2224 0x0000 0x0103 0x0001",
                "0x2224 0x0000 0x0103 0x0008",
                "0x2224 0x0000 0x0104 0x0001",
                "0x2224 0x0000 0x0104 0x0008",
            ]
        );
        assert_eq!(written(&["param", "set", "2", "500"]).unwrap()[0][2..5], ["0x0002", "0x0000", "0x01F4"]);
    }

    #[test]
    fn axis_and_range_are_checked() {
        for (line, part) in [
            ("param set TOLE 16385 --axis 3", "16385 is out of range for TOLE; allowed: 1 to 16384 pulses"),
            ("param set PSHFRC -1001 --axis 3", "allowed: -1000 to 1000"),
            ("param set TOLE 1", "TOLE belongs to an axis; set the axis"),
            ("param get TOLE", "TOLE belongs to an axis; set the axis"),
            ("param set WEIGHT 1 --axis 1", "WEIGHT belongs to the robot, not to an axis"),
            ("param set TOLE 1 --axis 1,2", "axes"),
            ("param set TOLE 1.5 --axis 1", "value"),
        ] {
            let failure = words(&line.split(' ').collect::<Vec<_>>()).unwrap_err();
            assert!(failure.message.contains(part), "{line}: {failure}");
        }
        assert!(objection(&["param", "get", "TOLL", "--axis", "1"]).contains("259 = TOLE"));
        assert!(objection(&["param", "get", "261"]).contains("261"));
        assert!(objection(&["param", "get", "TOLE", "--axis", "5"]).contains("1..=4"));
    }
}

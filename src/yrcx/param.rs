//! Commands `yrcx param` (4.4.2): a table of the parameters of the robot that `--unit` selects, and of its axes. Rows
//! have names such as `WEIGHT` and `TOLE.3`.

use std::sync::LazyLock;

use super::number_arguments::single;
use super::read_requests::{ask_each, is_undefined};
use crate::prelude::*;
use armctl_controller::yrcx::table::parameter::{PARAMETERS, Parameter};
use armctl_frame::store::Row;

table_commands! {
    /// Commands for parameters.
    Param of Parameters {}
}

/// The parameters of a robot.
#[derive(Debug)]
pub struct Parameters {
    /// Robot number, 1 to 4; 0 for the first robot.
    pub robot: u8,
}

/// A parameter, and the axis for a parameter that each axis has.
pub type Setting = (&'static Parameter, Option<u8>);

/// Content of a parameter: value and unit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Amount {
    value: i32,
    unit: Option<&'static str>,
}

impl Amount {
    /// Content of this parameter.
    pub fn new((parameter, _): Setting, value: i32) -> Self {
        Self { value, unit: unit(parameter) }
    }
}

/// Attributes of a parameter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct More {
    /// Number of the parameter in the robot language.
    number: u16,
    /// Axis, 1 to 4; null for a parameter of the robot.
    axis_number: Option<u8>,
    /// Unit; null if the manual does not define it.
    unit: Option<&'static str>,
    meaning: &'static str,
}

impl Parameters {
    /// Starts a request for a parameter.
    fn draft_for(&self, command: table::Command, (parameter, axis): Setting) -> Draft {
        let draft = command.order().with(Key::Robot, i32::from(self.robot)).with(Key::Parameter, parameter.number);
        draft.with_some(Key::Axes, axis.map(|axis| axis.to_string()))
    }

    /// The request that reads a parameter.
    pub fn read_order(&self, key: Setting) -> Result<Order> {
        self.draft_for(table::Command::ParamGet, key).valid_order()
    }

    /// The request that writes a parameter.
    pub fn write_order(&self, key: Setting, value: &str) -> Result<Order> {
        self.draft_for(table::Command::ParamSet, key).with(Key::Value, value).valid_order()
    }
}

impl Store for Parameters {
    type Family = Yrcx;
    type Key = Setting;
    type Wire = Amount;
    type Value = i32;
    type More = More;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["parameter", "parameters"],
        placeholder: "PARAMETER",
        range: "Name or number of a parameter, such as WEIGHT. With an axis: TOLE.3, TOLE.1-4 or 259.3. TOLE selects \
                all axes",
        reading: None,
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.param");
    const COMPLETE: ValueKind = complete::PARAMETER;
    const UNDEFINED_IS_NULL: bool = true;

    fn help() -> Option<&'static str> {
        static LISTING: LazyLock<String> = LazyLock::new(listing);
        Some(&LISTING)
    }

    fn keys(text: &str) -> Result<Vec<Setting>, String> {
        let (name, axes) = text.split_once('.').map_or((text, None), |(name, axes)| (name, Some(axes)));
        let parameter = parameter(name)?;
        match (parameter.per_axis, axes) {
            (false, None) => Ok(vec![(parameter, None)]),
            (false, Some(_)) => Err(format!("{} belongs to the robot, not to an axis", parameter.name)),
            (true, axes) => {
                let axes = user_input::range(axes.unwrap_or("1-4"), axis)?;
                Ok(axes.map(|axis| (parameter, Some(axis))).collect())
            }
        }
    }

    /// Returns all parameters except the payload in kilograms. That parameter is the payload in grams, rounded, so a
    /// restore of it would lose the grams.
    fn all() -> Vec<Setting> {
        let all = PARAMETERS.iter().filter(|parameter| parameter.name != "WEIGHT");
        all.flat_map(|parameter| Self::keys(parameter.name).unwrap_or_default()).collect()
    }

    fn name((parameter, axis): Setting) -> String {
        axis.map_or_else(|| parameter.name.to_owned(), |axis| format!("{}.{axis}", parameter.name))
    }

    async fn open(link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self { robot: link.unit() })
    }

    fn table_suffix(&self) -> String {
        format!(" of robot {}", self.robot.max(1))
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::number("value", "value")]
    }

    fn texts(&self, amount: &Amount) -> Vec<String> {
        vec![amount.value.to_string()]
    }

    fn headings(&self) -> Vec<&'static str> {
        vec!["value", "unit", "meaning"]
    }

    fn cells(&self, (parameter, _): Setting, amount: &Amount) -> Vec<Cell> {
        vec![amount.value.into(), Cell::optional(amount.unit), parameter.meaning.into()]
    }

    fn difference(&self, old: &Amount, new: &Amount) -> [String; 2] {
        [old, new]
            .map(|Amount { value, unit }| unit.map_or_else(|| value.to_string(), |unit| format!("{value} {unit}")))
    }

    fn value(&self, amount: &Amount) -> Option<i32> {
        Some(amount.value)
    }

    fn more(&self, (parameter, axis_number): Setting, _amount: Option<&Amount>) -> More {
        let Parameter { number, meaning, .. } = *parameter;
        More { number, axis_number, unit: unit(parameter), meaning }
    }

    fn is_undefined(failure: &Failure) -> bool {
        is_undefined(failure)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, keys: &[Setting]) -> Result<Answers<Amount>> {
        let orders = keys.iter().map(|key| self.read_order(*key)).collect::<Result<Vec<Order>>>()?;
        let answers = ask_each(link, screen, "reading parameters", &orders).await?;
        let amount = |key: &Setting, values: Values| Amount::new(*key, values.int(Key::Value).unwrap_or_default());
        let rows = keys.iter().zip(answers.outcomes);
        let rows = rows.map(|(key, outcome)| outcome.map(|values| Some(amount(key, values))));
        Ok(Answers { rows: rows.collect(), asked: answers.asked })
    }
}

impl Writable for Parameters {
    /// New value; `None` if no value is given, for example in a dry run, in which the value is unknown.
    type Draft = Option<i32>;

    const RISK: Risk = Risk::Destroy;

    fn draft(&self, key: Setting, texts: &[Option<&str>]) -> Result<Option<i32>, String> {
        let value = |text: &&str| self.write_order(key, text).map(|order| order.values().int(Key::Value));
        let value = texts[0].as_ref().map(value).transpose().map_err(|failure| failure.message)?;
        Ok(value.flatten())
    }

    fn complete_draft(&self, key: Setting, draft: &Option<i32>, old: Option<&Amount>) -> Result<Amount> {
        draft
            .map(|value| Amount::new(key, value))
            .or(old.copied())
            .ok_or_else(|| Failure::usage(format!("{} has no value to keep", Self::name(key))).hint("give a value"))
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        for (key, draft) in rows {
            let least = key.0.span.0;
            let [one, other] = draft.map_or([least, least + 1], |value| [value; 2]);
            let [one, other] = [one, other].map(|value| self.write_order(*key, &value.to_string()));
            let about = Self::asked(*key);
            let reason = Reason::about(&about).depending_on("the current value: written if different");
            link.plan_depending(&one?, &other?, reason);
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (key, _, new) in rows {
            link.ask(&self.write_order(*key, &new.value.to_string())?).await?;
        }
        Ok(())
    }
}

/// Returns the unit of a parameter; `None` if the manual does not define it.
fn unit(parameter: &Parameter) -> Option<&'static str> {
    Some(parameter.unit).filter(|unit| !unit.is_empty())
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

fn axis(text: &str) -> Result<u8, String> {
    let axis = text.parse().ok().filter(|axis| (1..=4).contains(axis));
    axis.ok_or_else(|| format!("axis '{text}' does not exist; the axes are 1 to 4"))
}

/// Lists the parameters, for the help.
fn listing() -> String {
    let line = |parameter: &Parameter| {
        let Parameter { number, name, meaning, span: (least, most), .. } = *parameter;
        let unit = unit(parameter).map_or_else(String::new, |unit| format!(" ({unit})"));
        let most = if most == i32::MAX { "maximum payload".to_owned() } else { most.to_string() };
        format!("  {name:<8} {number:>3}  {meaning}{unit}, {least} to {most}")
    };
    let of = |per_axis| PARAMETERS.iter().filter(move |parameter| parameter.per_axis == per_axis).map(line);
    let lines = |per_axis| of(per_axis).collect::<Vec<_>>().join("\n");
    format!("Parameters of the robot:\n{}\n\nParameters of an axis:\n{}", lines(false), lines(true))
}

//! A parameter in a report.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::toyo::items::{Answers, in_a_word, read_each_twice};
use crate::command::toyo::link;
use crate::command::toyo::link::Link;
use crate::command::toyo::values::{self, Shown};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Parameter;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::{Cell, Table, Tone};

/// A parameter with its values.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Entry {
    /// `soft-limit-plus`.
    pub name: &'static str,
    /// `parameter`.
    pub kind: &'static str,
    /// `P01`.
    pub id: &'static str,
    /// `mode`, `axis`, `machine` or `special`.
    pub group: &'static str,
    /// What it holds.
    pub about: &'static str,
    /// Its values; none if the controller refuses it.
    #[schemars(length(max = 8))]
    pub value: Vec<Shown>,
    /// Whether it was answered.
    pub ok: bool,
    /// Whether the controller refuses it: mostly because it does not have it.
    pub refused: bool,
    /// Whether the manual lists all that it holds; the values tell which it does not.
    pub in_manual: bool,
    /// Why there are no values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Failure>,
    /// Controllers that have it; none if all have.
    pub only_on: &'static [&'static str],
}

impl Entry {
    /// What the controller said of a parameter.
    pub fn new(parameter: &Parameter, answer: &Result<Record, Failure>) -> Self {
        let content = answer.as_ref().ok();
        Self {
            id: parameter.id,
            name: parameter.name,
            kind: "parameter",
            group: parameter.group().name(),
            about: parameter.about,
            value: content.map_or_else(Vec::new, values::shown),
            ok: answer.is_ok(),
            refused: is_refused(answer),
            in_manual: content.is_none_or(Record::is_listed),
            error: answer.as_ref().err().cloned(),
            only_on: parameter.only_on,
        }
    }

    /// A line for each.
    pub fn table(entries: &[Self]) -> Table {
        let mut table = Table::new(&["id", "name", "value"], "no parameters");
        for entry in entries {
            let value = match (&entry.error, entry.refused, entry.only_on) {
                (Some(_), true, []) => Cell::from("refused").tone(Tone::Warning),
                (Some(_), true, _) => Cell::from("not on this controller").tone(Tone::Warning),
                (Some(error), ..) => Cell::from(in_a_word(error.kind)).tone(Tone::Bad),
                (None, ..) => Cell::from(values::in_a_line(&entry.value)),
            };
            table.row([Cell::from(entry.id).whole(), entry.name.into(), value]);
        }
        table
    }
}

/// Whether an answer is a "no".
pub fn is_refused(answer: &Result<Record, Failure>) -> bool {
    answer.as_ref().is_err_and(|failure| failure.kind == Kind::Refused)
}

/// Reads parameters. A dry run notes them and ends.
pub async fn read_all(
    link: &mut Link,
    screen: &Screen,
    parameters: &[&'static Parameter],
) -> Result<Vec<Entry>, Failure> {
    let keys: Vec<Key> = parameters.iter().map(|parameter| (*parameter, None)).collect();
    let contents = read_keys(link, screen, &keys).await?;
    Ok(parameters.iter().zip(&contents).map(|(parameter, content)| Entry::new(parameter, content)).collect())
}

/// A parameter, or a row of a table.
pub type Key = (&'static Parameter, Option<i32>);

/// Reads parameters and rows, one after the other; each answer counts for itself. If the controller refuses all of them,
/// that is a failure. A dry run notes them and ends.
pub async fn read_keys(link: &mut Link, screen: &Screen, keys: &[Key]) -> Result<Answers, Failure> {
    let requests: Result<Vec<Request>, _> =
        keys.iter().map(|(parameter, row)| Request::read_parameter(parameter, *row)).collect();
    let requests = requests.map_err(|error| link::wrong(&error))?;
    let answers = read_each_twice(link, screen, "reading parameters", &requests).await;
    if let Err(failure) = &answers
        && failure.kind == Kind::Refused
    {
        let failure = failure.clone();
        let rare = keys.iter().find(|(parameter, _)| !parameter.only_on.is_empty());
        return Err(match (rare, &failure.hint) {
            (Some((parameter, _)), Some(hint)) => {
                let models = parameter.only_on.join(", ");
                let hint = format!("only some controllers have {}: {models}; or {hint}", parameter.id);
                failure.hint(hint)
            }
            _ => failure,
        });
    }
    answers
}

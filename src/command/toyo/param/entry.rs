//! A parameter in a report.

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::toyo::link::Link;
use crate::command::toyo::values::{self, Shown};
use crate::command::toyo::{link, refusal};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::{Command, Parameter};
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::{Cell, Table, Tone};

/// A parameter with its values.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Entry {
    /// `P01`.
    pub id: &'static str,
    /// `soft-limit-plus`.
    pub name: &'static str,
    /// `mode`, `axis`, `machine` or `special`.
    pub group: &'static str,
    /// What it holds.
    pub about: &'static str,
    /// Its values; none if the controller refuses it.
    pub values: Vec<Shown>,
    /// Whether the controller refuses it: mostly because it does not have it.
    pub refused: bool,
    /// Controllers that have it; none if all have.
    pub only_on: &'static [&'static str],
}

impl Entry {
    /// What the controller said of a parameter.
    pub fn new(parameter: &Parameter, content: Option<&Record>) -> Self {
        Self {
            id: parameter.id,
            name: parameter.name,
            group: parameter.group().name(),
            about: parameter.about,
            values: content.map_or_else(Vec::new, values::shown),
            refused: content.is_none(),
            only_on: parameter.only_on,
        }
    }

    /// A line for each.
    pub fn table(entries: &[Self]) -> Table {
        let mut table = Table::new(&["id", "name", "value"], "no parameters");
        for entry in entries {
            let value = match (entry.refused, entry.only_on) {
                (false, _) => Cell::from(values::in_a_line(&entry.values)),
                (true, []) => Cell::from("refused").tone(Tone::Warning),
                (true, _) => Cell::from("not on this controller").tone(Tone::Warning),
            };
            table.row([Cell::from(entry.id).whole(), entry.name.into(), value]);
        }
        table
    }
}

/// Reads parameters. A dry run notes them and ends.
pub async fn read_all(
    link: &mut Link,
    screen: &Screen,
    parameters: &[&'static Parameter],
) -> Result<Vec<Entry>, Failure> {
    let keys: Vec<Key> = parameters.iter().map(|parameter| (*parameter, None)).collect();
    let contents = read_keys(link, screen, &keys).await?;
    Ok(parameters.iter().zip(&contents).map(|(parameter, content)| Entry::new(parameter, content.as_ref())).collect())
}

/// A parameter, or a row of a table.
pub type Key = (&'static Parameter, Option<i32>);

/// Reads parameters and rows, one after the other; what the controller refuses is `None`. If it refuses all of them,
/// that is a failure. A dry run notes them and ends.
pub async fn read_keys(link: &mut Link, screen: &Screen, keys: &[Key]) -> Result<Vec<Option<Record>>, Failure> {
    let requests: Result<Vec<Request>, _> =
        keys.iter().map(|(parameter, row)| Request::read_parameter(parameter, *row)).collect();
    let requests = requests.map_err(|error| link::wrong(&error))?;
    link.rehearse(&requests)?;
    let mut progress = (requests.len() > 1).then(|| screen.items_progress("reading parameters", requests.len() as u64));
    let mut contents = Vec::with_capacity(requests.len());
    for request in &requests {
        contents.push(link.read_if_there(request).await?);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    if !contents.is_empty() && contents.iter().all(Option::is_none) {
        let failure = refusal::explained(link, Command::Rpar).await;
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
    Ok(contents)
}

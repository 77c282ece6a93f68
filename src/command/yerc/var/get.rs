//! `yerc var get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::entry::Entry;
use super::read::{once, read_all};
use super::{Choice, in_form, model_of};
use crate::command::frame::watch::{Watchable, Watched};
use crate::command::frame::{items, names};
use crate::command::yerc::complete;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context, Report};
use crate::controller::names::Kind;
use crate::controller::yerc::variables::{Reference, parse_references};
use crate::failure::Failure;
use crate::output::view::{Cell, Table, View};

/// Reads variables.
#[derive(Debug, Args)]
#[command(after_help = "A position that was never taught is shown as undefined (null in JSON). Each variable has its \
                        own result. The exit code is 9 if some were refused, and 3 if all were refused or none has a \
                        value. armctl reads many variables with few requests. The standard numbers are 0-99 (positions \
                        0-127); the controller's parameters can define more.")]
pub struct Get {
    /// Variables, such as B0, I1..I20, D5, R3, S2, P10, BP1, EX1, or names
    #[arg(required = true, value_name = "REF", value_delimiter = ',', value_parser = Named::parse, add = complete::VARIABLE)]
    variables: Vec<Named>,
    /// Read strings with the 16-byte commands, even from a DX200
    #[arg(long)]
    s16: bool,
}

/// A variable or a range of variables.
#[derive(Debug, Clone)]
pub struct Named(pub Vec<Reference>);

impl Named {
    /// Parses `B0`, `B0..B99`, `B0..99`, or a name.
    pub fn parse(text: &str) -> Result<Self, String> {
        names::read(&[Kind::Variable], "B0", text, |text| {
            parse_references(text).map(Self).map_err(|error| error.to_string())
        })
    }
}

impl Command for Get {
    type Family = Yerc;
    type Report = Variables;
    const ID: &'static str = "yerc.var.get";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Variables, Failure> {
        let Context { link, robot, screen, .. } = context;
        let names = names::of(robot, screen);
        let given = || self.variables.iter().flat_map(|given| &given.0);
        let model = model_of(link, given(), self.s16).await?;
        let references = once(given().map(|reference| in_form(*reference, model, self.s16)));
        let answers = read_all(link, &references, |_, _| {}).await?;
        let entries = references.iter().filter_map(|reference| {
            let answer = answers.get(reference)?;
            Some(Entry::new(*reference, answer, link.encoding).labelled(names))
        });
        let report = Variables { items: entries.collect() };
        items::nothing(report.items.len(), report.items.iter().filter_map(Entry::error))?;
        Ok(report)
    }
}

/// Reads variables, and shows those that hold something.
#[derive(Debug, Args)]
#[command(
    after_help = "Numbers that are not 0, texts that are not empty, and positions that were taught. 884 variables take \
                        a few seconds."
)]
pub struct List {
    #[command(flatten)]
    choice: Choice,
    /// Those that hold nothing, too
    #[arg(long)]
    empty: bool,
}

impl Command for List {
    type Family = Yerc;
    type Report = Variables;
    const ID: &'static str = "yerc.var.list";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Variables, Failure> {
        let Context { link, robot, screen, .. } = context;
        let names = names::of(robot, screen);
        let model = link.model().await?;
        let references = once(self.choice.references().map(|reference| in_form(reference, model, false)));
        let progress = screen.spinner("reading variables");
        let answers = read_all(link, &references, |_, known| {
            progress.say(&format!("reading variables ({known} of {})", references.len()));
        })
        .await?;
        drop(progress);
        let entries = references.iter().filter_map(|reference| {
            let entry = Entry::new(*reference, answers.get(reference)?, link.encoding);
            (self.empty || !entry.is_blank()).then(|| entry.labelled(names))
        });
        Ok(Variables { items: entries.collect() })
    }
}

impl Watchable for Get {
    const WATCH: &'static str = "yerc.var.watch";
    const WATCHED: Watched = Watched::ITEMS;
}

/// Variables in the order requested.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Variables {
    items: Vec<Entry>,
}

impl Report for Variables {
    fn view(&self) -> View {
        let mut table = Table::new(&["name", "label", "value"], "no variables");
        let numbers = self.items.iter().all(Entry::is_number);
        for entry in &self.items {
            let value = if numbers { Cell::number(entry.shown()) } else { entry.shown().into() };
            table.row([entry.name().into(), Cell::maybe(entry.label()), value]);
        }
        View::table(table.without_blank("label"))
    }

    fn failure(&self) -> Option<Failure> {
        let variables = &self.items;
        if variables.iter().any(Entry::has_value) {
            return items::verdict(variables.len(), variables.iter().filter_map(Entry::error));
        }
        items::verdict(variables.len(), variables.iter().filter_map(Entry::missing))
    }
}

//! `toyo param get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::entry::{self, Entry};
use super::parse_name;
use crate::command::toyo::complete;
use crate::command::toyo::items;
use crate::command::toyo::link::Toyo;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::table::Parameter;
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::View;

/// Which parameters.
#[derive(Debug, Args)]
#[command(after_help = "`param list` shows all names. In JSON, each value has its unit, and what stands on the line \
                        beside what it means.")]
pub struct Get {
    /// Names or ids in any case: soft-limit-plus, P01
    #[arg(required = true, value_name = "NAME", value_parser = parse_name, add = complete::PARAMETER)]
    names: Vec<&'static Parameter>,
}

impl Command for Get {
    type Family = Toyo;
    type Report = Parameters;
    const ID: &'static str = "toyo.param.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Parameters, Failure> {
        let parameters = entry::read_all(context.link, context.screen, &self.names).await?;
        Ok(Parameters { items: parameters })
    }
}

/// What was asked for.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Parameters {
    items: Vec<Entry>,
}

impl Report for Parameters {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        View::table(Entry::table(&self.items))
    }

    fn failure(&self) -> Option<Failure> {
        let failure = items::failure(self.items.len(), self.items.iter().map(|entry| entry.error.as_ref()))?;
        let refused = self.items.iter().any(|entry| entry.refused);
        let hint = "some parameters are only on some controllers; `only_on` in the JSON names them";
        Some(if refused { failure.hint(hint) } else { failure })
    }
}

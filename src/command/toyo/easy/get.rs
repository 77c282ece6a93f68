//! `toyo easy get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Program, field, read};
use crate::command::toyo::Family;
use crate::command::toyo::numbers::{Numbers, read_contents};
use crate::command::{Command, Context, Report};
use crate::controller::toyo::request::Request;
use crate::failure::Failure;
use crate::output::view::View;

/// Which programs.
#[derive(Debug, Args)]
pub struct Get {
    /// Programs and ranges of them, 1 to 8; without any, all
    #[arg(value_name = "PROGRAM", value_delimiter = ',', value_parser = |text: &str| Numbers::parse(field(), text))]
    programs: Vec<Numbers>,
}

impl Command for Get {
    type Family = Family;
    type Report = Programs;
    const ID: &'static str = "toyo.easy.get";

    async fn run(&self, context: Context<'_, Family>) -> Result<Programs, Failure> {
        let programs = Numbers::of(&self.programs, field());
        let requests = programs.into_iter().map(read).collect::<Result<Vec<Request>, Failure>>()?;
        let records = read_contents(context.link, context.screen, "reading programs", &requests).await?;
        Ok(Programs { programs: records.iter().map(Program::of).collect() })
    }
}

/// Easy programs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Programs {
    programs: Vec<Program>,
}

impl Report for Programs {
    fn view(&self) -> View {
        View::table(Program::table(&self.programs))
    }
}

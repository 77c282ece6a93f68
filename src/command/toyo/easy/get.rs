//! `toyo easy get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Program, field, read};
use crate::command::toyo::items::{self, Item, read_each};
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::Numbers;
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
    type Family = Toyo;
    type Report = Programs;
    const ID: &'static str = "toyo.easy.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Programs, Failure> {
        let programs = Numbers::of(&self.programs, field());
        let requests = programs.iter().copied().map(read).collect::<Result<Vec<Request>, Failure>>()?;
        let answers = read_each(context.link, context.screen, "reading programs", &requests).await?;
        let items = programs.iter().zip(&answers);
        let items = items.map(|(program, answer)| Item::of("program", *program, answer, Program::of));
        Ok(Programs { programs: items.collect() })
    }
}

/// Easy programs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Programs {
    programs: Vec<Item<Program>>,
}

impl Report for Programs {
    fn view(&self) -> View {
        View::table(Program::table(&self.programs))
    }

    fn failure(&self) -> Option<Failure> {
        items::failure_of(&self.programs)
    }
}

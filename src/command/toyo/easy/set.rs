//! `toyo easy set`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Program, cell, field, read, sketch, values};
use crate::command::toyo::eeprom::Cells;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::number;
use crate::command::toyo::stores::{self, Store, StoreTask};
use crate::command::toyo::values::Changes;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::output::view::View;

/// A program, and what it shall be.
#[derive(Debug, Args)]
#[command(after_help = "What the controller holds already is not written: its EEPROM takes about a million rewrites.")]
pub struct Set {
    /// Program, 1 to 8
    #[arg(value_name = "PROGRAM", value_parser = |text: &str| number(field(), text))]
    program: i32,
    /// Start tag, repetitions and end tag, or some by name, such as loop=5, which keeps the others
    #[arg(required = true, value_name = "VALUE")]
    values: Vec<String>,
}

const WORK: StoreTask = StoreTask {
    doing: "storing an easy program",
    noun: "program",
    things: ["an easy program", "easy programs"],
    resumes: false,
};

impl Command for Set {
    type Family = Toyo;
    type Report = Stored;
    const ID: &'static str = "toyo.easy.set";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite an easy program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stored, Failure> {
        let Context { link, screen, authority, .. } = context;
        let changes = Changes::read(&format!("easy program {}", self.program), &values(), &self.values)?;
        let (values, found) =
            changes.completed(link, &read(self.program)?, |values| sketch(self.program, values)).await?;
        let cell = cell(self.program, values)?;
        let program = Program::of(&cell.wanted);
        let stores = [Store::new(self.program.to_string(), cell).over(found)];
        authority.confirm(&stores::replacing(WORK, &stores, "")).await?;
        let cells = stores::sum(&stores::store_all(link, screen, WORK, &stores, 0).await?);
        Ok(Stored { program, items: stores::written(&stores), cells })
    }
}

/// What a program is now.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stored {
    #[serde(flatten)]
    program: Program,
    /// What it held and holds.
    items: stores::WrittenCells,
    #[serde(flatten)]
    cells: Cells,
}

impl Report for Stored {
    fn view(&self) -> View {
        let Program { program, start_tag, loops, end_tag } = self.program;
        let words = format!("easy program {program}: start tag {start_tag}, {loops} loops, end tag {end_tag}");
        View::text(format!("{words}\n{}", self.cells.in_words()))
    }
}

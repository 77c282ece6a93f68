//! `toyo palletizing copy` and `toyo palletizing select`.

use clap::Args;

use super::{parse_program, reads};
use crate::command::frame::orders::Done;
use crate::command::toyo::copies::{self, Copied};
use crate::command::toyo::link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::{not_held, read_back};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::failure::Failure;
use crate::gate::Confirmation;

/// Copies a program over another one, unless they are the same already.
#[derive(Debug, Args)]
pub struct Copy {
    /// Program to copy, 1 to 16
    #[arg(value_parser = parse_program)]
    from: i32,
    /// Program to replace, 1 to 16
    #[arg(value_parser = parse_program)]
    to: i32,
}

/// Chooses the program that `toyo run palletizing` starts.
#[derive(Debug, Args)]
pub struct Select {
    /// Program, 1 to 16
    #[arg(value_parser = parse_program)]
    program: i32,
}

impl Command for Copy {
    type Family = Toyo;
    type Report = Copied;
    const ID: &'static str = "toyo.palletizing.copy";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a palletizing program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Copied, Failure> {
        let Self { from, to } = *self;
        let order = Request::new(table::Command::Cppl, vec![Value::Number(from), Value::Number(to)]);
        let order = order.map_err(|error| link::wrong(&error))?;
        let records: Vec<_> = RECORDS.iter().collect();
        let reads = [reads(from, &records)?, reads(to, &records)?];
        let copy = copies::Copy { what: "palletizing program", from, to, order, reads };
        copy.make(context.link, context.screen, &context.authority).await
    }
}

impl Command for Select {
    type Family = Toyo;
    type Report = Done;
    const ID: &'static str = "toyo.palletizing.select";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Done, Failure> {
        let (link, order) = (context.link, Request::of(table::Command::Spln, [Value::Number(self.program)]));
        link.ask(&order).await?;
        let found = read_back(link, &order, &Request::bare(table::Command::Rpld)).await?.number("program");
        if let Some(found) = found.filter(|found| *found != self.program) {
            return Err(
                not_held(&order, &format!("program {found} is chosen")).hint("a program that runs stays chosen")
            );
        }
        Ok(Done::new(format!("palletizing program {} is chosen; `toyo run palletizing` starts it", self.program)))
    }
}

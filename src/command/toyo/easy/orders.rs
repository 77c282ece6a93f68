//! `toyo easy copy` and `toyo easy select`.

use clap::Args;

use super::{field, read};
use crate::command::frame::orders::Done;
use crate::command::toyo::copies::{self, Copied};
use crate::command::toyo::link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::number;
use crate::command::toyo::numbers::{not_held, read_back};
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table;
use crate::failure::Failure;
use crate::gate::Confirmation;

/// Copies a program over another one, unless they are the same already.
#[derive(Debug, Args)]
pub struct Copy {
    /// Program to copy, 1 to 8
    #[arg(value_name = "FROM", value_parser = |text: &str| number(field(), text))]
    from: i32,
    /// Program to replace, 1 to 8
    #[arg(value_name = "TO", value_parser = |text: &str| number(field(), text))]
    to: i32,
}

/// Chooses the program that `toyo run easy` starts.
#[derive(Debug, Args)]
pub struct Select {
    /// Program, 1 to 8
    #[arg(value_name = "PROGRAM", value_parser = |text: &str| number(field(), text))]
    program: i32,
}

impl Command for Copy {
    type Family = Toyo;
    type Report = Copied;
    const ID: &'static str = "toyo.easy.copy";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite an easy program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Copied, Failure> {
        let Self { from, to } = *self;
        let order = Request::new(table::Command::Cesy, vec![Value::Number(from), Value::Number(to)]);
        let order = order.map_err(|error| link::wrong(&error))?;
        let reads = [vec![read(from)?], vec![read(to)?]];
        let copy = copies::Copy { what: "easy program", from, to, order, reads };
        copy.make(context.link, context.screen, &context.authority).await
    }
}

impl Command for Select {
    type Family = Toyo;
    type Report = Done;
    const ID: &'static str = "toyo.easy.select";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Done, Failure> {
        let (link, order) = (context.link, Request::of(table::Command::Sesn, [Value::Number(self.program)]));
        link.ask(&order).await?;
        let found = read_back(link, &order, &Request::bare(table::Command::Resd)).await?.number("program");
        if let Some(found) = found.filter(|found| *found != self.program) {
            return Err(
                not_held(&order, &format!("program {found} is chosen")).hint("a program that runs stays chosen")
            );
        }
        Ok(Done::new(format!("easy program {} is chosen; `toyo run easy` starts it", self.program)))
    }
}

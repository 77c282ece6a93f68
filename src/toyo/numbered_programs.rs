//! `copy` and `select` of `toyo easy` and `toyo palletizing`. The programs of both have numbers.

use std::fmt::Debug;
use std::marker::PhantomData;

use super::number_arguments::{number, read_back, read_back_mismatch};
use super::program_copy::{self, Copied};
use crate::prelude::*;
use armctl_controller::toyo::field::Field;

/// A type of program that has numbers.
pub trait NumberedProgram: Debug + 'static {
    /// Name of the type, such as `easy program`.
    const TYPE_NAME: &'static str;
    /// Word of the type in `toyo run`.
    const WORD: &'static str;
    /// Name of the report of `copy`.
    const COPY_ID: &'static str;
    /// Name of the report of `select`.
    const SELECT_ID: &'static str;
    /// Name of the report of `toyo run`.
    const RUN_ID: &'static str;
    /// Number of programs.
    const COUNT: i64;
    /// Text for a copy that completes "This will …".
    const INTENT: &'static str;
    /// Help text of the program to copy.
    const FROM_HELP: &'static str;
    /// Help text of the program to replace.
    const TO_HELP: &'static str;
    /// Help text of the program to select.
    const SELECT_HELP: &'static str;
    /// Command that starts the selected program.
    const RUN: &'static str;
    /// Protocol command that copies a program.
    const COPY: table::Command;
    /// Protocol command that selects a program.
    const SELECT: table::Command;
    /// Protocol command that reports the selected program.
    const SELECTED: table::Command;
    /// Protocol command that starts the selected program.
    const START: table::Command;
    /// Additional help of `toyo run`.
    const RUN_HELP: Option<&'static str> = None;

    /// Field of the program number.
    fn field() -> &'static Field;
    /// Requests that read a whole program.
    fn reads(program: i32) -> Result<Vec<Request>>;
}

/// Copy a program to another number, if the two programs differ.
#[derive(Debug, Args)]
pub struct Copy<K: NumberedProgram> {
    #[arg(value_name = "FROM", help = K::FROM_HELP, value_parser = |text: &str| number(K::field(), text))]
    from: i32,
    #[arg(value_name = "TO", help = K::TO_HELP, value_parser = |text: &str| number(K::field(), text))]
    to: i32,
    #[arg(skip)]
    of: PhantomData<K>,
}

/// Select the program that `toyo run` starts.
#[derive(Debug, Args)]
pub struct Select<K: NumberedProgram> {
    #[arg(value_name = "PROGRAM", help = K::SELECT_HELP, value_parser = |text: &str| number(K::field(), text))]
    program: i32,
    #[arg(skip)]
    of: PhantomData<K>,
}

impl<K: NumberedProgram> Command for Copy<K> {
    type Family = Toyo;
    type Report = Copied;
    const ID: &'static str = K::COPY_ID;
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = K::INTENT;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Copied> {
        let Self { from, to, .. } = *self;
        let order = Request::new(K::COPY, vec![Value::Number(from), Value::Number(to)]);
        let order = order.map_err(|error| wrong(&error))?;
        let copy = program_copy::Copy { what: K::TYPE_NAME, from, to, order, reads: [K::reads(from)?, K::reads(to)?] };
        copy.make(context.link, context.screen, &context.confirmer).await
    }
}

impl<K: NumberedProgram> Command for Select<K> {
    type Family = Toyo;
    type Report = SetReport;
    const ID: &'static str = K::SELECT_ID;
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<SetReport> {
        let (link, order) = (context.link, Request::of(K::SELECT, [Value::Number(self.program)]));
        let selection_read = Request::bare(K::SELECTED);
        let old = Old::read(link.before(&selection_read).await?.and_then(|record| record.number("program")));
        link.ask(&order).await?;
        let selected = read_back(link, &order, &selection_read).await?.number("program");
        if let Some(selected) = selected.filter(|selected| *selected != self.program) {
            return Err(read_back_mismatch(&order, &format!("program {selected} is selected"))
                .hint("wait until the program has ended; a running program stays selected"));
        }
        let words = format!("{} {} is selected; use `{}` to start it", K::TYPE_NAME, self.program, K::RUN);
        Ok(NewValue::of(K::TYPE_NAME.replace(' ', "_"), self.program, words).replaces(old))
    }
}

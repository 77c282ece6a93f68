//! `toyo palletizing get`.

use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Entry, parse_program, parse_record, reads};
use crate::command::toyo::complete;
use crate::command::toyo::files;
use crate::command::toyo::items::{self, read_each};
use crate::command::toyo::link::Toyo;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::bulk::pallets;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::table::Pallet;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::failure::Failure;
use crate::output::view::View;

/// Which program, and which records of it.
#[derive(Debug, Args)]
#[command(after_help = "The file of --toml is whole or is not written; `palletizing set --from` reads it.")]
pub struct Get {
    /// Program, 1 to 16
    #[arg(value_parser = parse_program)]
    program: i32,
    /// Records by name or number: start source-p0 6; without any, all 16
    #[arg(value_name = "RECORD", value_parser = parse_record, add = complete::RECORD)]
    records: Vec<&'static Pallet>,
    /// Write them into this new file
    #[arg(long, value_name = "FILE")]
    toml: Option<PathBuf>,
    /// Replace the file if it exists
    #[arg(long, requires = "toml")]
    force: bool,
}

impl Command for Get {
    type Family = Toyo;
    type Report = Program;
    const ID: &'static str = "toyo.palletizing.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Program, Failure> {
        let Context { link, screen, several, .. } = context;
        let target = files::target(self.toml.as_deref(), self.force, several)?;
        let wanted = if self.records.is_empty() { RECORDS.iter().collect() } else { self.records.clone() };
        let letters = super::letters(link, &wanted, target.is_some()).await?;
        let answers = read_each(link, screen, "reading records", &reads(self.program, &wanted)?).await?;
        let records =
            wanted.iter().copied().zip(&answers).map(|(pallet, answer)| Entry::answered(pallet, answer, letters));
        let records = records.collect();
        let kept = wanted.into_iter().zip(answers);
        let kept = kept.filter_map(|(pallet, answer)| Some((pallet, answer.ok().filter(Record::is_listed)?)));
        let kept: Vec<_> = kept.collect();
        let file = target.map(|target| files::write(&target, &pallets::write(&kept))).transpose()?;
        Ok(Program { program: self.program, records, file })
    }
}

/// A palletizing program.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Program {
    /// 1 to 16.
    program: i32,
    records: Vec<Entry>,
    /// Where they went; null without `--toml`.
    file: Option<String>,
}

impl Report for Program {
    fn view(&self) -> View {
        match &self.file {
            Some(file) => View::fields([
                ("file", file.as_str().into()),
                ("program", self.program.into()),
                ("records", self.records.len().into()),
            ]),
            None => View::table(Entry::table(&self.records)),
        }
    }

    fn failure(&self) -> Option<Failure> {
        items::failure(self.records.len(), self.records.iter().map(|entry| entry.error.as_ref()))
    }
}

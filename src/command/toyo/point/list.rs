//! `toyo point list`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{OTHER_TASK, OfTask, items, read_all};
use crate::command::frame::items::verdict;
use crate::command::frame::names;
use crate::command::frame::sheet::{self, SheetOptions, SheetTarget};
use crate::command::robot::item::{Item, Items};
use crate::command::robot::position::Position;
use crate::command::toyo::files;
use crate::command::toyo::link::Toyo;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::bulk::{Setting, points};
use crate::controller::toyo::layout::Record;
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::{Section, View};

/// Which points, and where to.
#[derive(Debug, Args)]
#[command(
    after_help = format!(
        "999 points take a minute and a half at 9600 baud. The file of --csv is whole or is not written; `point set \
         --from` reads it. With --update, a file that is there keeps its comments (columns whose names begin with \
         comment), its order and its points: without --from and \
         --to, only those are read.\n\n{OTHER_TASK}"
    )
)]
pub struct List {
    /// First point; without it, 1
    #[arg(long, value_name = "POINT", value_parser = clap::value_parser!(i32).range(1..=999))]
    from: Option<i32>,
    /// Last point; without it, 999
    #[arg(long, value_name = "POINT", value_parser = clap::value_parser!(i32).range(1..=999))]
    to: Option<i32>,
    /// Task, 1 to 4, instead of the current one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
    #[command(flatten)]
    sheet: SheetOptions,
}

impl Command for List {
    type Family = Toyo;
    type Report = Listing;
    const ID: &'static str = "toyo.point.list";

    fn risk(&self) -> Risk {
        if self.task.is_some() { Risk::Write } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Listing, Failure> {
        let Context { robot, link, screen, several, .. } = context;
        let (from, to) = (self.from.unwrap_or(1), self.to.unwrap_or(999));
        if to < from {
            return Err(
                Failure::usage(format!("--to {to} is before --from {from}")).hint("name the lower row with --from")
            );
        }
        let target = self.sheet.target(several)?;
        let old = target.as_ref().and_then(SheetTarget::old).filter(|_| self.from.is_none() && self.to.is_none());
        let points = match old {
            Some(old) => points::numbers(old).map_err(|errors| files::faulty("the file of --csv", &errors))?,
            None => (from..=to).collect(),
        };
        let letters = link.letters().await?;
        let (task, answers) = read_all(link, screen, self.task, &points).await?;
        let items = items(task, &points, &answers, letters, names::of(robot, screen));
        let Some(target) = target else { return Ok(Listing::Points(items)) };
        let setting = |record: &Record| Setting { parameter: points::table(), values: record.values().to_vec() };
        let settings: Vec<Setting> =
            answers.iter().flatten().filter(|record| record.is_listed()).map(setting).collect();
        let file = target.write(
            &points::columns_by([0, 1, 2, 3].map(|axis| letters.name(axis))),
            &points::rows(&settings),
            sheet::number,
        )?;
        let left_out = items.items.into_iter().filter(|item| item.value.is_none()).collect();
        Ok(Listing::File(Saved { task, file, saved: settings.len(), asked: points.len(), left_out }))
    }
}

/// Every point has four coordinates, whatever axes there are.
pub const AXES: usize = 4;

/// Points, or where they went.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Listing {
    /// Without a file.
    Points(Items<Position, OfTask>),
    /// With `--csv`.
    File(Saved),
}

/// Where points went.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Saved {
    /// Whose points these are.
    task: u8,
    file: String,
    /// How many it holds.
    saved: usize,
    /// How many were asked for.
    #[serde(skip)]
    asked: usize,
    /// Points that it does not hold: refused, or with something that the manual does not list.
    left_out: Vec<Item<Position, OfTask>>,
}

impl Report for Listing {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        match self {
            Self::Points(points) => points.view(),
            Self::File(Saved { task, file, saved, left_out, .. }) => {
                let mut fields =
                    vec![("file", file.as_str().into()), ("task", (*task).into()), ("points", (*saved).into())];
                if !left_out.is_empty() {
                    fields.push(("left out", left_out.len().into()));
                }
                View { sections: vec![Section::Fields(fields)] }
            }
        }
    }

    fn failure(&self) -> Option<Failure> {
        match self {
            Self::Points(points) => points.failure(),
            Self::File(saved) => verdict(saved.asked, saved.left_out.iter().filter_map(|item| item.error.as_ref())),
        }
    }
}

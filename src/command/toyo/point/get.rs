//! `toyo point get`.

use clap::Args;

use super::{OTHER_TASK, OfTask, field, items, parse_points, read_all};
use crate::command::frame::names;
use crate::command::robot::item::Items;
use crate::command::robot::position::Position;
use crate::command::toyo::complete;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::Numbers;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::failure::Failure;

/// Which points.
#[derive(Debug, Args)]
#[command(after_help = OTHER_TASK)]
pub struct Get {
    /// Rows of the coordinate table, 1 to 999: 1-10,20; or names
    #[arg(required = true, value_name = "POINT", value_delimiter = ',', value_parser = parse_points, add = complete::POINT)]
    points: Vec<Numbers>,
    /// Task, 1 to 4, instead of the current one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

impl Command for Get {
    type Family = Toyo;
    type Report = Items<Position, OfTask>;
    const ID: &'static str = "toyo.point.get";

    fn risk(&self) -> Risk {
        if self.task.is_some() { Risk::Write } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Items<Position, OfTask>, Failure> {
        let Context { robot, link, screen, .. } = context;
        let points = Numbers::of(&self.points, &field());
        let letters = link.letters().await?;
        let (task, answers) = read_all(link, screen, self.task, &points).await?;
        Ok(items(task, &points, &answers, letters, names::of(robot, screen)))
    }
}

//! `toyo point get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{OTHER_TASK, Row, field, parse_points, read_all};
use crate::command::toyo::complete;
use crate::command::toyo::items::{self, Item};
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::Numbers;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::output::view::View;

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
    type Report = Points;
    const ID: &'static str = "toyo.point.get";

    fn risk(&self) -> Risk {
        if self.task.is_some() { Risk::Write } else { Risk::Read }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Points, Failure> {
        let Context { link, screen, .. } = context;
        let points = Numbers::of(&self.points, &field());
        let letters = link.letters().await?;
        let (task, answers) = read_all(link, screen, self.task, &points).await?;
        Ok(Points { task, points: Row::items(&points, &answers, letters), axes: letters.all() })
    }
}

/// Points of a task.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Points {
    /// Whose points these are.
    pub task: u8,
    pub points: Vec<Item<Row>>,
    /// The letters of axes 1 to 4; empty where the controller does not tell.
    pub axes: [String; 4],
}

impl Report for Points {
    fn view(&self) -> View {
        View::table(Row::table(&self.points, &self.axes))
    }

    fn failure(&self) -> Option<Failure> {
        items::failure_of(&self.points)
    }
}

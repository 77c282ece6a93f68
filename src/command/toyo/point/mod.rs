//! `toyo point`: rows of the coordinate table, which each task has for itself.

mod get;
mod list;
mod set;
mod teach;

pub use list::AXES;
pub use teach::Teach;

use schemars::JsonSchema;
use serde::Serialize;

use super::items::{Answers, Item, read_each};
use super::link::{self, Link};
use super::numbers::{Numbers, named, number};
use super::position::{Coordinates, heading};
use super::tasks;
use crate::client::toyo::Letters;
use crate::command::commands;
use crate::controller::names::Kind;
use crate::controller::toyo::bulk::points::table;
use crate::controller::toyo::field::Field;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::{Cell, Table};

commands! {
    /// What can be done with points.
    pub enum Point {
        /// Read points: 1-10,20
        Get(get::Get),
        /// Write a point, or all that a CSV file has
        Set(set::Set),
        /// Read all points, also into a CSV file
        List(list::List),
    }
}

/// What every command of points says in its help.
const OTHER_TASK: &str = "Each task has its own points. With --task, that task is made the current one for a while, which \
                          is a change: a read-only robot refuses it.";

/// A point of the coordinate table.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Row {
    /// Its row, from 1.
    point: i32,
    #[serde(flatten)]
    place: Coordinates,
}

impl Row {
    fn of(record: &Record, letters: Letters) -> Self {
        Self { point: record.number("row").unwrap_or_default(), place: Coordinates::of(record, letters) }
    }

    /// With the columns of a CSV file that `point set --from` reads.
    fn table(rows: &[Item<Self>], letters: &[String; 4]) -> Table {
        let [x, y, z, r] = [0, 1, 2, 3].map(|index| heading(index, &letters[index]));
        let mut table = Table::new(&["point", x, y, z, r], "no points");
        let mm = |value: f64| Cell::number(format!("{value:.2}"));
        for row in rows {
            row.show(&mut table, |Self { point, place }| {
                std::iter::once((*point).into()).chain(place.mm().map(mm)).collect()
            });
        }
        table
    }

    /// Of what was answered for these points.
    fn items(points: &[i32], answers: &Answers, letters: Letters) -> Vec<Item<Self>> {
        points
            .iter()
            .zip(answers)
            .map(|(point, answer)| Item::of("point", *point, answer, |record| Self::of(record, letters)))
            .collect()
    }
}

/// The number of a point, 1 to 999.
fn field() -> Field {
    table().key.fields[0].named("point")
}

/// Points on a command line.
fn parse_points(text: &str) -> Result<Numbers, String> {
    named(Kind::Point, text, |text| Numbers::parse(&field(), text))
}

/// A point on a command line: its number, or its name.
pub fn parse_point(text: &str) -> Result<i32, String> {
    named(Kind::Point, text, |text| number(&field(), text))
}

/// Reads points of a task, or of the current one, one after the other; says which task that is. A dry run notes them
/// and ends.
pub async fn read_all(
    link: &mut Link,
    screen: &Screen,
    task: Option<u8>,
    points: &[i32],
) -> Result<(u8, Answers), Failure> {
    let requests: Result<Vec<Request>, _> =
        points.iter().map(|point| Request::read_parameter(table(), Some(*point))).collect();
    let requests = requests.map_err(|error| link::wrong(&error))?;
    let task = tasks::choose(link, task).await?;
    let read = read_each(link, screen, "reading points", &requests).await;
    Ok((task, tasks::done(link, read).await?))
}

#[cfg(test)]
mod tests;

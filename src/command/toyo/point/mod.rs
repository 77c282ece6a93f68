//! `toyo point`: rows of the coordinate table, which each task has for itself.

mod get;
mod list;
mod set;
mod teach;

pub use list::AXES;
pub use teach::Teach;

use schemars::JsonSchema;
use serde::Serialize;

use super::items::{Answers, read_each};
use super::link::{self, Link};
use super::numbers::{Numbers, named, number};
use super::position::{Coordinates, heading};
use super::rows::Listed;
use super::tasks;
use super::values::NOT_IN_MANUAL;
use crate::client::toyo::Letters;
use crate::command::commands;
use crate::command::frame::names;
use crate::command::robot::item::{Columns, Item, Items};
use crate::command::robot::position::Position;
use crate::controller::names::{Kind, Names};
use crate::controller::toyo::bulk::points::table;
use crate::controller::toyo::field::Field;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::names as names_of;
use crate::controller::toyo::request::Request;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::Cell;

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

/// What a point has besides.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OfTask {
    /// Whose point it is.
    pub task: u8,
    #[serde(flatten)]
    listed: Listed,
}

/// A point that was read, or why it was not.
fn item(task: u8, point: i32, answer: Result<&Record, Failure>, letters: Letters) -> Item<Position, OfTask> {
    let listed = Listed::of(answer.as_ref().ok().copied());
    let place = answer.map(|record| record.is_listed().then(|| Coordinates::of(record, letters)));
    let cells = match (place.as_ref().ok().copied().flatten(), &listed.raw) {
        (Some(place), _) => place.mm().map(|mm| Cell::number(format!("{mm:.2}"))).into(),
        (None, raw) => raw.iter().map(|raw| format!("{raw} ({NOT_IN_MANUAL})").into()).collect(),
    };
    let position = place.map(|place| place.map(|place| place.position()));
    Item { cells, ..Item::with("point", point.to_string(), OfTask { task, listed }, position) }
}

/// What was answered for these points.
fn items(task: u8, points: &[i32], answers: &Answers, letters: Letters, names: &Names) -> Items<Position, OfTask> {
    let items = points.iter().zip(answers).map(|(point, answer)| {
        let address = names_of::address_of(Kind::Point, *point).unwrap_or_default();
        let label = names::label(names, Kind::Point, &address);
        item(task, *point, answer.as_ref().map_err(Clone::clone), letters).labelled(label)
    });
    Items::new(columns(letters), items.collect())
}

/// With the columns of a CSV file that `point set --from` reads.
fn columns(letters: Letters) -> Columns {
    let letters = letters.all();
    Columns { name: "point", values: (0..4).map(|axis| heading(axis, &letters[axis])).collect(), empty: "no points" }
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

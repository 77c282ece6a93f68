//! `toyo point`: rows of the coordinate table. Each task has its own table.

mod teach;

pub use teach::Teach;

use super::eeprom::{Cell, parameter_sketch};
use super::eeprom_tables::{EepromRow, Listed, is_zero, row_cell, texts, unlisted};
use super::field_values;
use super::item_reads::{Answers as Records, read_each};
use super::number_arguments::{Numbers, named, number};
use super::position::{Coordinates, heading};
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::toyo::field;
use armctl_controller::toyo::layout::Layout;
use armctl_controller::toyo::names as names_of;
use armctl_frame::robot::position::FourAxes;
use armctl_frame::teach::parse_printed_position;

table_commands! {
    /// Commands for points.
    Point of Points {}
}

/// Number of coordinates of a point. It does not depend on the number of axes.
pub const AXES: usize = 4;

/// The coordinate table of a task.
#[derive(Debug)]
pub struct Points {
    /// Letters of the axes.
    pub letters: Letters,
    selected_task: Option<u8>,
    /// Task that the points belong to.
    pub task: u8,
}

impl Points {
    /// The table of a task, or of the current task.
    pub async fn of_task(link: &mut Link, task: Option<u8>) -> Result<Self> {
        Ok(Self { letters: link.letters().await?, selected_task: task, task: task.unwrap_or_default() })
    }

    /// The table of a task, on a machine whose axes have these letters.
    pub const fn with_letters(task: u8, letters: Letters) -> Self {
        Self { letters, selected_task: Some(task), task }
    }
}

/// Argument that selects the task of the points.
#[derive(Debug, Clone, Args)]
pub struct TaskOptions {
    /// Task, 1 to 4. armctl selects another task temporarily, which a read-only robot does not allow [default: the
    /// current task]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    pub task: Option<u8>,
}

/// Fields that toyo adds to a point.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct OfTask {
    /// Task that the point belongs to.
    pub task: u8,
    #[serde(flatten)]
    listed: Listed,
}

/// Returns the parameter that is the coordinate table, T1.
pub fn table() -> &'static Parameter {
    Parameter::named("T1").expect("the parameter table has the coordinate table")
}

/// Field of the point number, 1 to 999.
fn field() -> field::Field {
    table().key.fields[0].named("point")
}

/// Parses a point number, or a name that the user assigned.
pub fn parse_point(text: &str) -> Result<i32, String> {
    named(Kind::Point, text, |text| number(&field(), text))
}

/// Request that reads a point.
fn request(point: i32) -> Result<Request> {
    Request::read_parameter(table(), Some(point)).map_err(|error| wrong(&error))
}

/// Reads points of the selected task. Each point has its own result.
pub async fn read(link: &mut Link, screen: &Screen, points: &[i32]) -> Result<Records> {
    let requests = points.iter().copied().map(request).collect::<Result<Vec<Request>>>()?;
    read_each(link, screen, "reading points", &requests).await
}

impl Store for Points {
    type Family = Toyo;
    type Key = i32;
    type Wire = Record;
    type Value = FourAxes;
    type More = OfTask;
    type Options = TaskOptions;

    const WORDS: TableWords = TableWords {
        nouns: ["point", "points"],
        placeholder: "POINT",
        range: "Rows of the coordinate table (1 to 999), such as 5 or 1-10,20, or names",
        reading: Some("At 9600 baud, a read of 999 points takes a minute and a half."),
        writing: Some(
            "The values are x, y, z and r in mm. Type all values in this order, or only some values by name, for \
             example z=12.5; the other values do not change. The names are the letters on the teach pendant (parameter E01). If the \
             letters are not X, Y, Z and R in this order, names are necessary. ax1 to ax4 are axes 1 to 4 on every \
             machine. @FILE reads the output of `position --json`, @- reads it from stdin, `here` is the current \
             position. armctl does not write equal values, because an EEPROM cell wears out after about a million \
             writes.",
        ),
    };
    const IDS: Ids = ids!("toyo.point");
    const LABELS: Option<Kind> = Some(Kind::Point);
    const COMPLETE: ValueKind = complete::POINT;

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Ok(Numbers::of(&[Numbers::parse(&field(), text)?], &field()))
    }

    fn all() -> Vec<i32> {
        Numbers::of(&[], &field())
    }

    fn name(point: i32) -> String {
        point.to_string()
    }

    fn address(point: i32) -> String {
        names_of::address_of(Kind::Point, point).unwrap_or_default()
    }

    async fn open(link: &mut Link, options: &TaskOptions) -> Result<Self> {
        Self::of_task(link, options.task).await
    }

    fn risk_of_reading(options: &TaskOptions) -> Risk {
        if options.task.is_some() { Risk::Write } else { Risk::Read }
    }

    async fn select(&mut self, link: &mut Link) -> Result<()> {
        self.task = task_selection::select_task(link, self.selected_task).await?;
        Ok(())
    }

    async fn deselect<T>(&self, link: &mut Link, outcome: Result<T>) -> Result<T> {
        task_selection::restore_task(link, outcome).await
    }

    fn table_suffix(&self) -> String {
        format!(" of task {}", self.task)
    }

    fn fields(&self) -> Vec<Field> {
        const NUMBERED: [&str; AXES] = ["ax1_mm", "ax2_mm", "ax3_mm", "ax4_mm"];
        let letters = self.letters.all();
        let field = |(axis, alias): (usize, &'static str)| Field {
            name: format!("{}_mm", self.letters.name(axis)).into(),
            alias: Some(alias),
            heading: heading(axis, &letters[axis]),
            is_number: true,
            is_optional: false,
        };
        NUMBERED.into_iter().enumerate().map(field).collect()
    }

    fn texts(&self, record: &Record) -> Vec<String> {
        texts(record, AXES)
    }

    fn difference(&self, old: &Record, new: &Record) -> [String; 2] {
        field_values::difference(old, new, &self.letters)
    }

    fn value(&self, record: &Record) -> Option<FourAxes> {
        record.is_listed().then(|| FourAxes(Coordinates::of(record, self.letters).position()))
    }

    fn more(&self, _point: i32, record: Option<&Record>) -> OfTask {
        OfTask { task: self.task, listed: Listed::of(record) }
    }

    fn is_blank(&self, record: &Record) -> bool {
        is_zero(record, AXES)
    }

    fn unsaved(&self, _point: i32, record: Option<&Record>) -> Option<String> {
        unlisted(record)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, points: &[i32]) -> Result<Answers<Record>> {
        Ok(Answers::of(read(link, screen, points).await?))
    }
}

impl EepromRow for Points {
    fn letters(&self) -> Letters {
        self.letters
    }

    fn words(&self, words: &[String]) -> Result<Vec<String>> {
        let [only] = words else { return Ok(words.to_vec()) };
        let Some(file) = only.strip_prefix('@') else { return Ok(words.to_vec()) };
        let text = parse_printed_position(Path::new(file))?;
        Ok(text.split_whitespace().map(ToOwned::to_owned).collect())
    }

    fn body(&self, _point: i32) -> Layout {
        table().body()
    }

    fn request(&self, point: i32) -> Result<Request> {
        request(point)
    }

    fn cell(&self, point: i32, values: Vec<Value>) -> Result<Cell> {
        row_cell(table(), point, values)
    }

    fn sketch(&self, point: i32, values: &[Option<Value>]) -> String {
        parameter_sketch(table(), Some(point), values)
    }
}

#[cfg(test)]
mod tests;

//! `yrcx point dump` and `restore`: points and their comments as a spreadsheet table.

use std::collections::HashMap;
use std::path::PathBuf;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::content::{Store, ask};
use super::parts::{COMMENTS, POINTS, Part};
use super::restore::{Comparison, IF_IT_DIFFERS, Job, carry_out, named};
use super::rows::Row as Cells;
use crate::command::backup::{RETRY_HINT, add_hint};
use crate::command::frame::dry_run::{Reason, unknown};
use crate::command::frame::sheet::{self, SheetManner};
use crate::command::frame::text_files;
use crate::command::robot::file::{FILES, FileItem, Files};
use crate::command::yrcx::link::{Link, Yrcx};
use crate::command::yrcx::numbers::{Numbers, runs, single};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::findings::{Finding, Findings};
use crate::controller::sheet::{Column, Row, Sheet};
use crate::controller::yrcx::table;
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::output::csv::RowsOf;
use crate::output::view::{Section, View};

/// Arguments of `point dump`.
#[derive(Debug, Args)]
#[command(
    after_help = "The columns are point, unit (mm or pulse), axis_1 to axis_4, hand_system and comment (the comment on \
                  the controller). `point restore` writes them back. Undefined points are left out. With --update, an \
                  existing file keeps its own columns (such as comment_…), its order and the points that are not read."
)]
pub struct Dump {
    /// A new CSV file
    file: PathBuf,
    /// Points, 0 to 29999: 100, 0..29 or 0..29,100
    #[arg(required = true, value_name = "POINT", value_delimiter = ',', value_parser = |text: &str| POINTS.parse(text))]
    points: Vec<Numbers>,
    #[command(flatten)]
    manner: SheetManner,
}

/// Arguments of `point restore`.
#[derive(Debug, Args)]
#[command(
    after_help = "Commas, semicolons or tabs separate cells. Decimal commas are allowed unless commas separate the \
                  cells. Values without a column stay unchanged on the controller. A comment also stays unchanged if \
                  its cell is empty. The whole file is checked before anything is sent. Columns whose names begin with \
                  comment_ are free for your use."
)]
pub struct Restore {
    /// File from `point dump` or with the same columns; - is stdin
    file: PathBuf,
}

const AXES: [&str; 4] = ["axis_1", "axis_2", "axis_3", "axis_4"];
const UNIT: &str = "unit";
const HAND: &str = "hand_system";
const COMMENT: &str = "comment";
const EXPECTED: &str = "the columns are point, unit, axis_1 to axis_4, hand_system and comment";

/// Columns of points in their order, and the comment.
fn columns() -> Vec<Column> {
    let axes = AXES.into_iter().map(Column::number);
    let before = [Column::number("point"), Column::text(UNIT)].into_iter();
    before.chain(axes).chain([Column::text(HAND), Column::text(COMMENT)]).collect()
}

impl Command for Dump {
    type Family = Yrcx;
    type Report = Dumped;
    const ID: &'static str = "yrcx.point.dump";

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Dumped, Failure> {
        let Context { link, screen, several, .. } = context;
        link.no_unit("points belong to the whole controller")?;
        let target = self.manner.target(self.file.clone(), several)?;
        let numbers = Numbers::of(&self.points);
        if link.is_dry() {
            for number in numbers {
                plan_reads(link, number)?;
            }
            return Err(unknown());
        }
        let mut progress = screen.items_progress("reading points", numbers.len() as u64);
        let (mut rows, mut left_out) = (Vec::new(), Vec::new());
        for number in numbers {
            match ask(link, &POINTS.read(number)?).await? {
                Ok(values) => {
                    let comment = ask(link, &COMMENTS.read(number)?).await?.ok();
                    let comment = comment.as_ref().and_then(|values| values.text(Key::Comment)).unwrap_or_default();
                    rows.push([POINTS.row(number, &values), vec![comment.to_owned()]].concat());
                }
                Err(_) => left_out.push(number),
            }
            progress.advance(1);
        }
        let file = target.write(&columns(), &rows, sheet::number)?;
        Ok(Dumped { file, points: rows.len(), not_defined: runs(&left_out) })
    }
}

fn plan_reads(link: &mut Link, number: i32) -> Result<(), Failure> {
    link.plan(&POINTS.read(number)?, &format!("point {number}"));
    link.plan(&COMMENTS.read(number)?, &format!("comment of point {number}"));
    Ok(())
}

/// Result of `point dump`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Dumped {
    file: String,
    /// Number of points in the file.
    points: usize,
    /// Requested points that the controller refused, usually because they are not defined, as in `3, 7..9`.
    not_defined: String,
}

impl Report for Dumped {
    fn view(&self) -> View {
        let mut fields = vec![("file", self.file.as_str().into()), ("points", self.points.into())];
        if !self.not_defined.is_empty() {
            fields.push(("not defined", self.not_defined.as_str().into()));
        }
        View { sections: vec![Section::Fields(fields)] }
    }
}

/// A point of a file: its cells by column.
#[derive(Debug, PartialEq)]
struct Point {
    number: i32,
    line: usize,
    cells: HashMap<&'static str, String>,
    comment: Option<String>,
}

fn read(bytes: &[u8]) -> Result<Vec<Point>, Vec<Finding>> {
    let mut findings = Findings::default();
    let mut points = Vec::new();
    if let Some(sheet) = Sheet::read(bytes, EXPECTED, &mut findings) {
        let names = ["point", UNIT, AXES[0], AXES[1], AXES[2], AXES[3], HAND, COMMENT];
        let places = sheet.columns(&names, EXPECTED, &mut findings);
        let has_axes = places[2..6].iter().any(Option::is_some);
        for (name, is_missing) in [("point", places[0].is_none()), (UNIT, has_axes && places[1].is_none())] {
            if is_missing {
                let hint = Some(EXPECTED.to_owned());
                findings.error(sheet.end_of_head(), format!("column {name} is missing"), hint);
            }
        }
        let mut seen = HashMap::new();
        for row in sheet.rows().iter().filter(|_| places[0].is_some()) {
            let given: Vec<(&'static str, usize)> =
                names.into_iter().zip(&places).filter_map(|(name, at)| Some((name, (*at)?))).collect();
            match point(&sheet, row, &given) {
                Ok(point) => {
                    if let Some(other) = seen.insert(point.number, row.line) {
                        let message = format!("point {} is already in line {other}", point.number);
                        findings.error(row.place(usize::MAX), message, None);
                    }
                    points.push(point);
                }
                Err((at, message)) => findings.error(row.place(at), message, None),
            }
        }
    }
    if findings.errors() == 0 { Ok(points) } else { Err(findings.into_errors()) }
}

/// Parses a row. An error includes the column of the cell.
fn point(sheet: &Sheet, row: &Row, given: &[(&'static str, usize)]) -> Result<Point, (usize, String)> {
    let mut point = Point { number: 0, line: row.line, cells: HashMap::new(), comment: None };
    for &(name, at) in given {
        let text = row.text(at);
        match name {
            "point" => {
                let number = single(table::Command::PointSet, Key::Point, text);
                point.number = number.map_err(|error| (at, error))?;
            }
            COMMENT => point.comment = Some(row.string(at).to_owned()).filter(|text| !text.is_empty()),
            HAND => drop(point.cells.insert(name, text.to_owned())),
            _ if text.is_empty() => {
                return Err((at, format!("{name} is empty; remove the column to keep the value")));
            }
            UNIT => drop(point.cells.insert(name, text.to_owned())),
            _ => {
                let number =
                    sheet.number(row, at).map_err(|why| (at, format!("{name}: '{text}' is not clear: {why}")))?;
                point.cells.insert(name, number.into_owned());
            }
        }
    }
    Ok(point)
}

impl Point {
    /// The new row: the cells of the file over the current point.
    fn over(&self, old: Option<&Cells>) -> Result<Option<Store>, String> {
        if self.cells.is_empty() {
            return Ok(None);
        }
        let columns = || columns().into_iter().map(|column| column.name).take(1 + 1 + AXES.len() + 1);
        let unit = self.cells.get(UNIT);
        let old = old.filter(|old| unit.is_none_or(|unit| old.get(1) == Some(unit)));
        let mut row = Vec::new();
        for (index, name) in columns().enumerate() {
            let kept = old.and_then(|old| old.get(index)).cloned();
            let cell = match (self.cells.get(&*name), kept) {
                _ if index == 0 => self.number.to_string(),
                (Some(given), _) => given.clone(),
                (None, Some(kept)) => kept,
                (None, None) if name == HAND => String::new(),
                (None, None) => {
                    return Err(format!(
                        "the controller has no point in {}, so {name} is needed",
                        unit.map_or("it", |unit| unit)
                    ));
                }
            };
            row.push(cell);
        }
        POINTS.store(&row).map(Some).map_err(|failure| failure.message)
    }
}

impl Point {
    /// Two current points that differ in every column but the unit, for a dry run.
    fn sketch(&self) -> [Cells; 2] {
        let unit = self.cells.get(UNIT).map_or("mm", String::as_str);
        let axes = if unit == "mm" { ["0", "-0.001"] } else { ["0", "-1"] };
        let of = |axis: &str, hand: &str| -> Cells {
            [&[&self.number.to_string(), unit][..], &[axis; 4], &[hand]]
                .concat()
                .into_iter()
                .map(str::to_owned)
                .collect()
        };
        [of(axes[0], ""), of(axes[1], if unit == "mm" { "left" } else { "" })]
    }
}

impl Command for Restore {
    type Family = Yrcx;
    type Report = Restored;
    const ID: &'static str = "yrcx.point.restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite points with those of a file";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Restored, Failure> {
        let Context { link, screen, authority, .. } = context;
        link.no_unit("points belong to the whole controller")?;
        let name = text_files::display_path(&self.file);
        let points = read(&text_files::read(&self.file)?).map_err(|errors| text_files::file_failure(&name, &errors))?;
        if points.is_empty() {
            return Err(
                Failure::usage(format!("{name} has no points")).hint("`yrcx point dump` writes a file with points")
            );
        }
        let wrong = |point: &Point, why: &str| {
            Failure::usage(format!("{name}:{}: point {}: {why}", point.line, point.number))
                .hint("nothing was written; correct the file")
        };
        if link.is_dry() {
            return dry_run(link, &points, wrong);
        }
        let mut jobs = [Part::Points(0), Part::Comments(0)].map(|part| Job {
            part,
            called: part.kind().to_owned(),
            stores: Vec::new(),
        });
        let mut found = Comparison { differ: vec![Vec::new(), Vec::new()], ..Comparison::default() };
        let mut items = ["points", "comments"].map(FileItem::values);
        let mut progress = screen.items_progress("comparing points", points.len() as u64);
        for point in &points {
            let number = point.number;
            if !point.cells.is_empty() {
                let old = ask(link, &POINTS.read(number)?).await?.ok();
                let cells = old.as_ref().map(|values| POINTS.row(number, values));
                let store = point.over(cells.as_ref()).map_err(|why| wrong(point, &why))?;
                add(&mut jobs, &mut found, &mut items, 0, store, old.as_ref());
            }
            if let Some(comment) = &point.comment {
                let store = COMMENTS.store(&vec![number.to_string(), comment.clone()]);
                let store = store.map_err(|failure| wrong(point, &failure.message))?;
                let old = ask(link, &store.read).await.map_err(|failure| named(&store, failure))?.ok();
                let old = old.filter(|values| values.text(Key::Comment) != Some(""));
                add(&mut jobs, &mut found, &mut items, 1, Some(store), old.as_ref());
            }
            progress.advance(1);
        }
        drop(progress);
        carry_out((link, screen, &authority), &jobs, &found, &mut items, &name).await?;
        let items = items.into_iter().zip(&jobs).filter(|(_, job)| !job.stores.is_empty()).map(|(item, _)| item);
        let items = Files::new(items.collect(), |files| FileItem::results(files, ["written", "unchanged"]));
        Ok(Restored { file: name, items })
    }
}

/// Adds a value to those to be written, unless it is equal.
fn add(
    jobs: &mut [Job],
    found: &mut Comparison,
    items: &mut [FileItem],
    at: usize,
    store: Option<Store>,
    old: Option<&Values>,
) {
    let Some(store) = store else { return };
    let number = jobs[at].stores.len();
    if found.sort(jobs[at].part, &store, old, &mut items[at]) {
        found.differ[at].push(number);
    }
    jobs[at].stores.push(store);
}

fn dry_run(link: &mut Link, points: &[Point], wrong: impl Fn(&Point, &str) -> Failure) -> Result<Restored, Failure> {
    for point in points {
        if !point.cells.is_empty() {
            link.plan(&POINTS.read(point.number)?, &format!("point {}, to compare", point.number));
        }
        if let Some(comment) = &point.comment {
            let store = COMMENTS.store(&vec![point.number.to_string(), comment.clone()]);
            let store = store.map_err(|failure| wrong(point, &failure.message))?;
            link.plan(&store.read, &format!("comment of point {}, to compare", point.number));
        }
    }
    for point in points {
        let about = format!("point {}; values without a column stay unchanged", point.number);
        let reason = Reason::about(&about).depending_on(IF_IT_DIFFERS);
        // Values that the file does not contain are unknown before the controller is read.
        let [one, other] = point.sketch().map(|old| point.over(Some(&old)).map_err(|why| wrong(point, &why)));
        if let (Some(one), Some(other)) = (one?, other?) {
            link.plan_depending(&one.write, &other.write, reason);
        }
        if let Some(comment) = &point.comment {
            let store = COMMENTS.store(&vec![point.number.to_string(), comment.clone()])?;
            let about = format!("comment of point {}", point.number);
            link.plan_depending(&store.write, &store.write, Reason::about(&about).depending_on(IF_IT_DIFFERS));
        }
    }
    Err(unknown())
}

/// Result of `point restore`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    file: String,
    #[serde(flatten)]
    items: Files,
}

impl Report for Restored {
    fn view(&self) -> View {
        self.items.view()
    }

    fn failure(&self) -> Option<Failure> {
        Some(add_hint(self.items.failure()?, RETRY_HINT))
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn old() -> Cells {
        ["7", "mm", "1.000", "2.000", "3.000", "4.000", "right"].map(str::to_owned).into()
    }

    #[test]
    fn a_point_keeps_what_has_no_column() {
        let points = read(b"comment_mine;unit;axis_2;point\nx;mm;-2,5;7\n").unwrap();
        let store = points[0].over(Some(&old())).unwrap().unwrap();
        assert_eq!(store.wanted(), "mm 1.000 -2.500 3.000 4.000 right");
        assert!(points[0].over(None).unwrap_err().contains("axis_1"));
        let pulses: Cells = ["7", "pulse", "1", "2", "3", "4", ""].map(str::to_owned).into();
        assert!(points[0].over(Some(&pulses)).is_err(), "millimetres and pulses are not mixed");
        assert_eq!(read(b"point,comment\n7,WAIT\n").unwrap()[0].over(Some(&old())), Ok(None));
    }

    #[test]
    fn mistakes_are_told_with_their_place() {
        let error = |text: &str| read(text.as_bytes()).unwrap_err()[0].to_string();
        assert!(error("point,axis_1\n1,2\n").contains("column unit is missing"));
        assert!(error("point,unit,axis_1\n1,mm,\n").contains("axis_1 is empty"));
        assert!(error("point,unit\n30000,mm\n").contains("allowed: 0 to 29999"));
        assert!(error("point,unit\n1,mm\n1,mm\n").contains("point 1 is already in line 2"));
    }
}

//! `toyo point set`.

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{OTHER_TASK, OfTask, item, parse_point};
use crate::client::toyo::Letters;
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::{Known as _, unknown};
use crate::command::frame::teach::printed_position;
use crate::command::robot::item::Written;
use crate::command::robot::position::Position;
use crate::command::toyo::complete;
use crate::command::toyo::eeprom::Cells;
use crate::command::toyo::link::Link;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::runs;
use crate::command::toyo::position::Coordinates;
use crate::command::toyo::stores::{self, CellState, Store, StoreResult, StoreTask, parameter_cell, parameter_sketch};
use crate::command::toyo::values::Changes;
use crate::command::toyo::{files, link, tasks};
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::bulk::points::{self, Partial};
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::output::Screen;
use crate::output::csv::RowsOf;
use crate::output::view::View;

/// A point and its coordinates, or a file of them.
#[derive(Debug, Args)]
#[command(
    after_help = format!(
        "Names and columns are the letters that the teach pendant shows (parameter E01). Where those are not X, Y, Z and R \
         in this order, coordinates need their names; ax1 to ax4, and columns ax1_mm to ax4_mm, are axes 1 to 4 everywhere.\n\n\
         A file begins with point,x_mm,y_mm,z_mm,r_mm and has a point a line, as `point list --csv` writes it; with \
         commas, semicolons or tabs, and with decimal commas where cells are not parted by commas. Coordinates that it \
         has no column for stay as they are on the controller. Columns beginning with comment are yours. All of it is \
         checked before anything is sent. What the controller holds already is not written: its EEPROM takes about \
         a million rewrites. If the work is cut off, it says what is done; the same command, or --resume, goes on.\n\n\
         {OTHER_TASK}"
    )
)]
pub struct Set {
    /// Row of the coordinate table, 1 to 999, or a name
    #[arg(required_unless_present = "from", conflicts_with = "from", value_name = "POINT", value_parser = parse_point, add = complete::POINT)]
    point: Option<i32>,
    /// X, Y, Z and R in mm, or some of them by name, such as z=12.5, which keeps the others; names are the letters of the
    /// teach pendant, or ax1 to ax4; or @FILE with what `position --json` printed, @- for stdin, or here
    #[arg(required_unless_present = "from", conflicts_with = "from", value_name = "MM", allow_negative_numbers = true)]
    values: Vec<String>,
    /// Write the points of this CSV file; - is stdin
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
    /// Task, 1 to 4, instead of the current one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
    /// Go on with a file that was cut off; with a point, those before it are not even compared
    #[arg(long, value_name = "POINT", num_args = 0..=1, require_equals = true, default_missing_value = "", conflicts_with = "point")]
    resume: Option<String>,
}

pub(super) const WORK: StoreTask =
    StoreTask { doing: "storing points", noun: "point", things: ["a point", "points"], resumes: true };

impl Command for Set {
    type Family = Toyo;
    type Report = Stored;
    const ID: &'static str = "toyo.point.set";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite points";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stored, Failure> {
        let Context { link, screen, authority, .. } = context;
        let Some(file) = &self.from else {
            let point = self.point.unwrap_or_default();
            let given = printed_values(&self.values)?;
            let values = given.as_ref().unwrap_or(&self.values);
            let letters = link.letters().await?;
            let changes = Changes::read_by(&format!("point {point}"), &points::table().body(), &letters, values)?;
            let task = tasks::choose(link, self.task).await?;
            let stored = self.store_one(link, screen, &authority, (task, point), letters, &changes).await;
            return tasks::done(link, stored).await;
        };
        let name = files::shown(file);
        let text = files::read(file)?;
        let letters = link.letters().await?;
        let names = [0, 1, 2, 3].map(|axis| letters.name(axis));
        let points = points::read_partial(&text, names).map_err(|errors| files::faulty(&name, &errors))?;
        if points.is_empty() {
            return Err(
                Failure::usage(format!("{name} has no points")).hint("`toyo point list --csv FILE` writes such a file")
            );
        }
        let task = tasks::choose(link, self.task).await?;
        let stored = self.store_file(link, screen, &authority, (task, &points), letters).await;
        tasks::done(link, stored).await
    }
}

impl Set {
    /// Stores one point, with what it keeps.
    async fn store_one(
        &self,
        link: &mut Link,
        screen: &Screen,
        authority: &Authority<'_>,
        (task, point): (u8, i32),
        letters: Letters,
        changes: &Changes,
    ) -> Result<Stored, Failure> {
        let read = Request::read_parameter(points::table(), Some(point)).map_err(|error| link::wrong(&error))?;
        let sketch = |values: &[Option<Value>]| parameter_sketch(points::table(), Some(point), values);
        let (coordinates, found) = changes.completed(link, &read, sketch).await?;
        let stored = store(std::iter::once(Value::Number(point)).chain(coordinates).collect(), letters)?;
        self.store_all(link, screen, authority, (task, vec![stored.over(found)]), 0).await
    }

    /// Stores the points of a file. What it has no column for is read first, and kept.
    async fn store_file(
        &self,
        link: &mut Link,
        screen: &Screen,
        authority: &Authority<'_>,
        (task, points): (u8, &[Partial]),
        letters: Letters,
    ) -> Result<Stored, Failure> {
        // With zeros for what is not known yet.
        let whole = |point: &Partial| {
            store(point.values.iter().map(|v| v.clone().unwrap_or(Value::Number(0))).collect(), letters)
        };
        let mut stores = points.iter().map(whole).collect::<Result<Vec<Store>, Failure>>()?;
        let left_out = stores::left_out(&stores, self.resume.as_deref())?;
        if points.iter().all(|point| point.values.iter().all(Option::is_some)) {
            return self.store_all(link, screen, authority, (task, stores), left_out).await;
        }
        if link.is_dry() {
            for point in &points[left_out..] {
                let row = Some(point.row());
                let read = Request::read_parameter(points::table(), row).map_err(|error| link::wrong(&error))?;
                link.ask(&read).await.known()?;
                link.plan_overwriting(&read, &parameter_sketch(points::table(), row, &point.values[1..])).await?;
            }
            return Err(unknown());
        }
        stores::look(link, screen, &mut stores[left_out..]).await?;
        for (point, store) in points.iter().zip(&mut stores).skip(left_out) {
            let CellState::This(found) = &store.found else { continue };
            let whole = Changes::of(point.values[1..].to_vec()).over(found)?;
            let number = std::iter::once(Value::Number(point.row()));
            store.cell = self::store(number.chain(whole).collect(), letters)?.cell;
        }
        self.store_all(link, screen, authority, (task, stores), left_out).await
    }

    /// Stores points once it is confirmed that they are replaced.
    async fn store_all(
        &self,
        link: &mut Link,
        screen: &Screen,
        authority: &Authority<'_>,
        (task, mut points): (u8, Vec<Store>),
        left_out: usize,
    ) -> Result<Stored, Failure> {
        stores::look(link, screen, &mut points[left_out..]).await?;
        authority.confirm(&stores::replacing(WORK, &points[left_out..], &format!(" of task {task}"))).await?;
        let fates = stores::store_all(link, screen, WORK, &points, left_out).await?;
        Ok(Stored::new(task, &points, &fates))
    }
}

pub(super) fn store(values: Vec<Value>, letters: Letters) -> Result<Store, Failure> {
    let cell = parameter_cell(points::table(), values).map_err(|error| link::wrong(&error))?;
    let row = cell.wanted.number("row").unwrap_or_default();
    Ok(Store::new(row.to_string(), cell).by(letters))
}

/// The values of a position that another command printed, where a file of one is given.
fn printed_values(values: &[String]) -> Result<Option<Vec<String>>, Failure> {
    let [only] = values else { return Ok(None) };
    let Some(file) = only.strip_prefix('@') else { return Ok(None) };
    let text = printed_position(Path::new(file))?;
    Ok(Some(text.split_whitespace().map(ToOwned::to_owned).collect()))
}

/// Points that were written.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stored {
    items: Vec<Written<Position, OfTask>>,
    #[serde(flatten)]
    cells: Cells,
    /// What became of each, by its number; what it shall hold.
    #[serde(skip)]
    results: Vec<(i32, StoreResult, Coordinates)>,
    #[serde(skip)]
    task: u8,
}

impl Stored {
    fn new(task: u8, stores: &[Store], fates: &[StoreResult]) -> Self {
        let (mut items, mut results) = (Vec::new(), Vec::new());
        for (store, fate) in stores.iter().zip(fates) {
            let wanted = &store.cell.wanted;
            let point = wanted.number("row").unwrap_or_default();
            let place = |record: &Record| Coordinates::of(record, store.letters);
            let old = if let CellState::This(found) = &store.found { Some(place(found).position()) } else { None };
            let mut item = item(task, point, Ok(wanted), store.letters);
            if *fate == StoreResult::LeftOut {
                item.value = None;
            }
            items.push(Written::new(item, old, *fate == StoreResult::Written));
            results.push((point, *fate, place(wanted)));
        }
        Self { items, cells: stores::sum(fates), results, task }
    }
}

impl Report for Stored {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        let of = |fate: StoreResult| {
            let points = self.results.iter().filter(move |(_, result, _)| *result == fate);
            runs(&points.map(|(point, ..)| *point).collect::<Vec<_>>())
        };
        let mut lines = Vec::new();
        if let [(point, _, place)] = &self.results[..] {
            lines.push(format!("point {point} of task {}: {} (mm)", self.task, place.in_a_line()));
        } else {
            for (words, fate) in [
                ("written", StoreResult::Written),
                ("unchanged", StoreResult::Unchanged),
                ("left out", StoreResult::LeftOut),
            ] {
                let points = of(fate);
                if !points.is_empty() {
                    lines.push(format!("points of task {} {words}: {points}", self.task));
                }
            }
        }
        lines.push(self.cells.in_words());
        View::text(lines.join("\n"))
    }
}

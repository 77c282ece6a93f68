//! `toyo speed-table`, `accel-table`, `torque-table`: tables with a value or two in a row.

use std::fmt::Debug;
use std::marker::PhantomData;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::eeprom::Cells;
use super::items::{self, Item, read_each};
use super::link;
use super::link::Toyo;
use super::numbers::{Numbers, number};
use super::stores::{self, Store, StoreTask, parameter_cell, parameter_sketch};
use super::values::{Changes, in_a_line, shown};
use crate::command::{Command, Context, Report, commands};
use crate::controller::Risk;
use crate::controller::toyo::field::{Field, Form, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Parameter;
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::output::view::{Cell, Table, View};

commands! {
    /// Speeds that programs name by their row.
    pub enum SpeedTable {
        /// Read rows: 1-5,20; without any, all 20
        Get(Get<Speed>),
        /// Write a row: 5 250
        Set(Set<Speed>),
    }
}

commands! {
    /// Acceleration times that programs name by their row.
    pub enum AccelTable {
        /// Read rows: 1-5,20; without any, all 20
        Get(Get<Accel>),
        /// Write a row: 5 0.25
        Set(Set<Accel>),
    }
}

commands! {
    /// Torque limits that programs name by their row.
    pub enum TorqueTable {
        /// Read rows: 1-3; without any, all 8
        Get(Get<Torque>),
        /// Write a row: 3 2.5 2.0
        Set(Set<Torque>),
    }
}

/// A table, and how a row of it is reported.
pub trait Kind: Debug + Send + Sync + 'static {
    /// Its id.
    const TABLE: &'static str;
    /// `toyo.speed-table.get`, `toyo.speed-table.set`.
    const IDS: [&'static str; 2];
    /// What one row of it holds, beside its number.
    type Content: Debug + Serialize + JsonSchema;
    /// Columns of its values.
    const COLUMNS: &'static [&'static str];

    /// The values of a row.
    fn content(record: &Record) -> Self::Content;
}

/// Table T2.
#[derive(Debug)]
pub struct Speed;

/// Table T3.
#[derive(Debug)]
pub struct Accel;

/// Table T5.
#[derive(Debug)]
pub struct Torque;

/// A row of the speed table. The unit is that of the manual.
#[derive(Debug, Serialize, JsonSchema)]
pub struct SpeedRow {
    speed_mm_s: f64,
}

/// A row of the acceleration table.
#[derive(Debug, Serialize, JsonSchema)]
pub struct AccelRow {
    /// From standstill to full speed, and back.
    time_s: f64,
}

/// A row of the torque limit table; the manual gives no unit.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TorqueRow {
    limit: f64,
    /// Torque from which on the load output is on.
    load: f64,
}

impl Kind for Speed {
    const TABLE: &'static str = "T2";
    const IDS: [&'static str; 2] = ["toyo.speed-table.get", "toyo.speed-table.set"];
    type Content = SpeedRow;
    const COLUMNS: &'static [&'static str] = &["row", "speed (mm/s)"];

    fn content(record: &Record) -> SpeedRow {
        SpeedRow { speed_mm_s: decimal(record, "speed") }
    }
}

impl Kind for Accel {
    const TABLE: &'static str = "T3";
    const IDS: [&'static str; 2] = ["toyo.accel-table.get", "toyo.accel-table.set"];
    type Content = AccelRow;
    const COLUMNS: &'static [&'static str] = &["row", "time (s)"];

    fn content(record: &Record) -> AccelRow {
        AccelRow { time_s: decimal(record, "time") }
    }
}

impl Kind for Torque {
    const TABLE: &'static str = "T5";
    const IDS: [&'static str; 2] = ["toyo.torque-table.get", "toyo.torque-table.set"];
    type Content = TorqueRow;
    const COLUMNS: &'static [&'static str] = &["row", "limit", "load"];

    fn content(record: &Record) -> TorqueRow {
        TorqueRow { limit: decimal(record, "limit"), load: decimal(record, "load") }
    }
}

/// Which rows.
#[derive(Debug, Args)]
pub struct Get<K: Kind> {
    /// Rows and ranges of them, from 1; without any, all
    #[arg(value_name = "ROW", value_delimiter = ',', value_parser = |text: &str| Numbers::parse(row_field(table::<K>()), text))]
    rows: Vec<Numbers>,
    #[arg(skip)]
    of: PhantomData<K>,
}

/// A row, and what it shall hold.
#[derive(Debug, Args)]
#[command(after_help = "What the controller holds already is not written: its EEPROM takes about a million rewrites.")]
pub struct Set<K: Kind> {
    /// Row, from 1
    #[arg(value_name = "ROW", value_parser = |text: &str| number(row_field(table::<K>()), text))]
    row: i32,
    /// What it shall hold; where a row has two values, one of them by name keeps the other
    #[arg(required = true, value_name = "VALUE")]
    values: Vec<String>,
    #[arg(skip)]
    of: PhantomData<K>,
}

fn table<K: Kind>() -> &'static Parameter {
    Parameter::named(K::TABLE).expect("every kind of table is in the table of parameters")
}

const WORK: StoreTask = StoreTask { doing: "storing rows", noun: "row", things: ["a row", "rows"], resumes: false };

/// The number of a row.
pub fn row_field(table: &'static Parameter) -> &'static Field {
    &table.key.fields[0]
}

impl<K: Kind> Command for Get<K> {
    type Family = Toyo;
    type Report = Rows<K>;
    const ID: &'static str = K::IDS[0];

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Rows<K>, Failure> {
        let table = table::<K>();
        let rows = Numbers::of(&self.rows, row_field(table));
        let requests: Result<Vec<Request>, _> =
            rows.iter().map(|row| Request::read_parameter(table, Some(*row))).collect();
        let requests = requests.map_err(|error| link::wrong(&error))?;
        let answers = read_each(context.link, context.screen, "reading rows", &requests).await?;
        let items = rows.iter().zip(&answers).map(|(row, answer)| Item::of("row", *row, answer, Row::of));
        Ok(Rows { rows: items.collect() })
    }
}

impl<K: Kind> Command for Set<K> {
    type Family = Toyo;
    type Report = Stored<K>;
    const ID: &'static str = K::IDS[1];
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a row of a table";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stored<K>, Failure> {
        let Context { link, screen, authority, .. } = context;
        let table = table::<K>();
        let changes = Changes::read(&format!("row {}", self.row), &table.body(), &self.values)?;
        let read = Request::read_parameter(table, Some(self.row)).map_err(|error| link::wrong(&error))?;
        let sketch = |values: &[Option<Value>]| parameter_sketch(table, Some(self.row), values);
        let (values, found) = changes.completed(link, &read, sketch).await?;
        let body = table.body().record(values.clone()).map_err(|error| link::wrong(&error))?;
        let values = std::iter::once(Value::Number(self.row)).chain(values).collect();
        let cell = parameter_cell(table, values).map_err(|error| link::wrong(&error))?;
        let row = Row::of(&cell.wanted);
        let stores = [Store::new(self.row.to_string(), cell).over(found)];
        authority.confirm(&stores::replacing(WORK, &stores, &format!(" of the {}", table.name))).await?;
        let cells = stores::sum(&stores::store_all(link, screen, WORK, &stores, 0).await?);
        Ok(Stored { row, items: stores::written(&stores), cells, text: in_a_line(&shown(&body)) })
    }
}

/// Rows of a table.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(bound = "")]
#[schemars(bound = "")]
pub struct Rows<K: Kind> {
    rows: Vec<Item<Row<K>>>,
}

/// A row of a table.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(bound = "")]
#[schemars(bound = "")]
pub struct Row<K: Kind> {
    /// Its number, from 1.
    row: i32,
    #[serde(flatten)]
    content: K::Content,
    #[serde(skip)]
    cells: Vec<Cell>,
}

/// What a row holds now.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(bound = "")]
#[schemars(bound = "")]
pub struct Stored<K: Kind> {
    #[serde(flatten)]
    row: Row<K>,
    /// What it held and holds.
    items: stores::WrittenCells,
    #[serde(flatten)]
    cells: Cells,
    /// The values as typed.
    #[serde(skip)]
    text: String,
}

impl<K: Kind> Row<K> {
    fn of(record: &Record) -> Self {
        let cell = |(field, value): (&Field, &Value)| match (field.form, value) {
            (Form::Number(form), Value::Number(units)) => Cell::number(form.plain(*units)),
            _ => Cell::from(field.written(value)),
        };
        let row = record.number("row").unwrap_or_default();
        Self { row, content: K::content(record), cells: record.pairs().map(cell).collect() }
    }
}

impl<K: Kind> Report for Rows<K> {
    fn view(&self) -> View {
        let mut table = Table::new(K::COLUMNS, "no rows");
        for row in &self.rows {
            row.show(&mut table, |row| row.cells.clone());
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        items::failure_of(&self.rows)
    }
}

impl<K: Kind> Report for Stored<K> {
    fn view(&self) -> View {
        let table = table::<K>().name;
        View::text(format!("{table} {}: {}\n{}", self.row.row, self.text, self.cells.in_words()))
    }
}

/// A number in its unit; 0 if the record does not have it.
fn decimal(record: &Record, name: &str) -> f64 {
    record
        .pairs()
        .find_map(|(field, value)| match (field.form, value) {
            (Form::Number(form), Value::Number(units)) if field.name == name => {
                Some(f64::from(*units) / f64::from(form.scale()))
            }
            _ => None,
        })
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{Bench, blocks, objection};

    #[test]
    fn rows_are_read_alone_or_all() {
        assert_eq!(
            blocks(&["speed-table", "get", "1-2,20"]).unwrap(),
            ["@RPAR T2 V01", "@RPAR T2 V02", "@RPAR T2 V20"]
        );
        assert_eq!(blocks(&["accel-table", "get"]).unwrap().len(), 20);
        assert_eq!(blocks(&["torque-table", "get"]).unwrap().len(), 8);
        assert!(objection(&["torque-table", "get", "9"]).contains("9 is out of range (a number, 1 to 8)"));
    }

    #[test]
    fn a_row_is_compared_before_it_is_written() {
        assert_eq!(
            blocks(&["speed-table", "set", "5", "250"]).unwrap(),
            ["@RPAR T2 V05", "@WPAR T2 V05=0250.0", "@RPAR T2 V05"]
        );
        assert_eq!(blocks(&["accel-table", "set", "5", "time=0.25"]).unwrap()[1], "@WPAR T3 A05=0.25");
        assert_eq!(blocks(&["torque-table", "set", "3", "2.5", "2"]).unwrap()[1], "@WPAR T5 LIM03 T=2.50 L=2.00");
        assert_eq!(
            blocks(&["speed-table", "set", "5", "0.5"]).unwrap_err().message,
            "row 5: speed: 0.5 is out of range (a number, 1.0 to 9999.9 mm/s)"
        );
    }

    #[test]
    fn a_row_keeps_what_is_not_named() {
        let mut bench = Bench::new("sim:");
        bench.data(&["torque-table", "set", "2", "1.5", "1.25"]);
        let stored = bench.data(&["torque-table", "set", "2", "load=1"]);
        assert_eq!(
            (&stored["limit"], &stored["load"], &stored["cells_written"]),
            (&1.5.into(), &1.0.into(), &1.into())
        );
        let read = bench.data(&["torque-table", "get", "2"]);
        assert_eq!(read, serde_json::json!({ "rows": [{ "ok": true, "row": 2, "limit": 1.5, "load": 1.0 }] }));
    }
}

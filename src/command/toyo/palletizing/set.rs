//! `toyo palletizing set`.

use std::path::{Path, PathBuf};

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Entry, parse_program, parse_record};
use crate::client::toyo::Letters;
use crate::command::toyo::complete;
use crate::command::toyo::eeprom::Cells;
use crate::command::toyo::files;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::link::wrong;
use crate::command::toyo::stores::{self, CellState, Store, StoreResult, StoreTask};
use crate::command::toyo::values::Changes;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::toyo::bulk::pallets::{self, Filled};
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Pallet;
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::output::csv::RowsOf;
use crate::output::view::{Section, View};

/// A record of a program and its values, or a file of records.
#[derive(Debug, Args)]
#[command(after_help = "All values of a record in their order, or some by name, which keeps the others: `palletizing \
                        set 1 source-p1 100 0 0`, `palletizing set 1 start mode=M-M`. `palletizing get 1` shows the \
                        names.\n\nA file is what `palletizing get --toml` writes. All of it is checked before anything \
                        is sent; records that it does not have stay as they are. What the controller holds already is \
                        not written: its EEPROM takes about a million rewrites.")]
pub struct Set {
    /// Program, 1 to 16
    #[arg(value_parser = parse_program)]
    program: i32,
    /// Record by name or number: source-p1, 3
    #[arg(required_unless_present = "from", conflicts_with = "from", value_name = "RECORD", value_parser = parse_record, add = complete::RECORD)]
    record: Option<&'static Pallet>,
    /// All values in their order, or some as name=value
    #[arg(
        required_unless_present = "from",
        conflicts_with = "from",
        value_name = "VALUE",
        allow_negative_numbers = true
    )]
    values: Vec<String>,
    /// Write the records of this TOML file; - is stdin
    #[arg(long, value_name = "FILE")]
    from: Option<PathBuf>,
}

const WORK: StoreTask =
    StoreTask { doing: "storing records", noun: "", things: ["a record", "records"], resumes: false };

impl Command for Set {
    type Family = Toyo;
    type Report = Stored;
    const ID: &'static str = "toyo.palletizing.set";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a palletizing program";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Stored, Failure> {
        let Context { link, screen, authority, .. } = context;
        let mut letters = Letters::USUAL;
        let records = match (&self.from, self.record) {
            (Some(file), _) => {
                let filled = from_file(file)?;
                letters =
                    super::letters(link, &filled.iter().map(|(record, _)| *record).collect::<Vec<_>>(), true).await?;
                filled.into_iter().map(|filled| (filled, CellState::NotAsked)).collect()
            }
            (None, Some(record)) => {
                letters = super::letters(link, &[record], false).await?;
                let changes = Changes::read_by(record.name, &record.layout, &letters, &self.values)?;
                let read = Request::read_pallet(self.program, record).map_err(|error| wrong(&error))?;
                let sketch = |values: &[Option<Value>]| super::sketch(self.program, record, values);
                let (values, found) = changes.completed(link, &read, sketch).await?;
                vec![((record, values), CellState::from(found))]
            }
            (None, None) => Vec::new(),
        };
        let mut entries = Vec::with_capacity(records.len());
        let mut stores = Vec::with_capacity(records.len());
        for ((record, values), found) in records {
            let store = Store { found, ..super::store(self.program, record, values)?.by(letters) };
            entries.push(Entry::of(record, &store.cell.wanted, letters));
            stores.push(store);
        }
        stores::look(link, screen, &mut stores).await?;
        let of = format!(" of palletizing program {}", self.program);
        authority.confirm(&stores::replacing(WORK, &stores, &of)).await?;
        let fates = stores::store_all(link, screen, WORK, &stores, 0).await?;
        let records = entries.into_iter().zip(&fates).map(|(entry, fate)| StoredRecord { entry, result: *fate });
        let (records, items) = (records.collect(), stores::written(&stores));
        Ok(Stored { program: self.program, records, items, cells: stores::sum(&fates) })
    }
}

fn from_file(file: &Path) -> Result<Vec<Filled>, Failure> {
    let name = files::shown(file);
    let records = pallets::read(&files::read(file)?).map_err(|errors| files::faulty(&name, &errors))?;
    if records.is_empty() {
        return Err(Failure::usage(format!("{name} has no records"))
            .hint("`toyo palletizing get PROGRAM --toml FILE` writes such a file"));
    }
    Ok(records)
}

/// Result of records of a program.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Stored {
    /// 1 to 16.
    program: i32,
    records: Vec<StoredRecord>,
    /// What each held and holds.
    items: stores::WrittenCells,
    #[serde(flatten)]
    cells: Cells,
}

/// A record, and what became of it.
#[derive(Debug, Serialize, JsonSchema)]
pub struct StoredRecord {
    #[serde(flatten)]
    entry: Entry,
    result: StoreResult,
}

impl Report for Stored {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        let mut table = Entry::table(&[]);
        table.columns.push("result");
        for StoredRecord { entry, result } in &self.records {
            let result = if *result == StoreResult::Written { "written" } else { "unchanged" };
            let row = Entry::table(std::slice::from_ref(entry)).rows.concat();
            table.rows.push([row, vec![result.into()]].concat());
        }
        View::table(table).and(Section::Text(self.cells.in_words()))
    }
}

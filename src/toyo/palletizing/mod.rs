//! `toyo palletizing`: the sixteen palletizing programs with sixteen records each.

mod progress;

use std::hash::{Hash, Hasher};

use super::eeprom::Cell;
use super::eeprom_tables::{EepromRow, Listed, is_zero, unlisted};
use super::field_values::{self, NamedValue};
use super::item_reads::read_each;
use super::number_arguments;
use super::numbered_programs::{Copy, NumberedProgram, Select};
use crate::prelude::*;
use armctl_controller::toyo::field;
use armctl_controller::toyo::layout::Layout;
use armctl_controller::toyo::table::palletizing::RECORDS;
use armctl_controller::toyo::table::{Command, Pallet};
use armctl_frame::output::view;
use armctl_frame::store::{Dump, Get, List, Restore, Set};

commands! {
    /// Commands for palletizing programs.
    pub enum Palletizing {
        /// Read the records of a program, for example `3 source-p1`
        Get(Get<Records>),
        /// List the records of a program that contain data
        List(List<Records>),
        /// Write a record, for example `1 source-p1 x=100`
        Set(Set<Records>),
        /// Copy a program to another number
        Copy(Copy<Numbered>),
        /// Save a program to a CSV file, for example `pallet3.csv 3`
        Dump(Dump<Records>),
        /// Write a program from a CSV file, for example `pallet3.csv 3`
        Restore(Restore<Records>),
        /// Select the program that `run palletizing` starts
        Select(Select<Numbered>),
        /// Show the progress of the running program
        Progress(progress::Progress),
    }
}

/// The palletizing programs, as a type of numbered programs.
#[derive(Debug)]
pub struct Numbered;

impl NumberedProgram for Numbered {
    const TYPE_NAME: &'static str = "palletizing program";
    const WORD: &'static str = "palletizing";
    const COPY_ID: &'static str = "toyo.palletizing.copy";
    const SELECT_ID: &'static str = "toyo.palletizing.select";
    const RUN_ID: &'static str = "toyo.run.palletizing";
    const COUNT: i64 = 16;
    const INTENT: &'static str = "overwrite a palletizing program";
    const FROM_HELP: &'static str = "Program to copy, 1 to 16";
    const TO_HELP: &'static str = "Program to replace, 1 to 16";
    const SELECT_HELP: &'static str = "Program, 1 to 16";
    const RUN: &'static str = "toyo run palletizing";
    const COPY: Command = Command::Cppl;
    const SELECT: Command = Command::Spln;
    const SELECTED: Command = Command::Rpld;
    const START: Command = Command::Ppst;

    fn field() -> &'static field::Field {
        field()
    }

    fn reads(program: i32) -> Result<Vec<Request>> {
        reads(program, &RECORDS.iter().collect::<Vec<_>>())
    }
}

/// Field of the program number, 1 to 16.
fn field() -> &'static field::Field {
    &Command::Rplt.row().requests[0].fields[0]
}

/// Parses a program number.
fn parse_program(text: &str) -> Result<i32, String> {
    number_arguments::number(field(), text)
}

/// Requests that read records of a program.
pub fn reads(program: i32, records: &[&Pallet]) -> Result<Vec<Request>> {
    let read = |record: &&Pallet| Request::read_pallet(program, record);
    records.iter().map(read).collect::<Result<_, _>>().map_err(|error| wrong(&error))
}

/// EEPROM cell of a record with these values.
pub fn cell(program: i32, record: &'static Pallet, values: Vec<Value>) -> Result<Cell> {
    Ok(Cell {
        read: Request::read_pallet(program, record).map_err(|error| wrong(&error))?,
        write: Request::write_pallet(program, record, &values).map_err(|error| wrong(&error))?,
        wanted: record.layout.record(values).map_err(|error| wrong(&error))?,
    })
}

/// The records of a program.
#[derive(Debug)]
pub struct Records {
    program: i32,
    letters: Letters,
}

impl Records {
    /// Records of a program, on a machine whose axes have these letters.
    pub const fn new(program: i32, letters: Letters) -> Self {
        Self { program, letters }
    }
}

/// Argument that selects the program.
#[derive(Debug, Clone, Args)]
pub struct ProgramOptions {
    /// Program, 1 to 16
    #[arg(value_parser = parse_program)]
    program: i32,
}

/// Key of a record of a program.
#[derive(Debug, Clone, Copy)]
pub struct Key(&'static Pallet);

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        self.0.number == other.0.number
    }
}

impl Eq for Key {}

impl Hash for Key {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.number.hash(state);
    }
}

/// Fields that toyo adds to a record.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct About {
    /// Number of the program, 1 to 16.
    #[serde(rename = "number")]
    program: i32,
    /// Number of the record, 1 to 16.
    record: u8,
    /// Description of the content.
    about: &'static str,
    #[serde(flatten)]
    listed: Listed,
}

impl Store for Records {
    type Family = Toyo;
    type Key = Key;
    type Wire = Record;
    type Value = Vec<NamedValue>;
    type More = About;
    type Options = ProgramOptions;

    const WORDS: TableWords = TableWords {
        nouns: ["record", "records"],
        placeholder: "RECORD",
        range: "Records by name or number, such as start source-p0 6",
        reading: None,
        writing: Some(
            "Type all values of a record in order, or only some values by name; the other values do \
             not change. For example: `palletizing set 1 source-p1 100 0 0`, `palletizing set 1 start mode=M-M`. `palletizing get 1` shows the names. \
             armctl does not write equal values, because an EEPROM cell wears out after about a million writes.",
        ),
    };
    const IDS: Ids = ids!("toyo.palletizing");
    const COMPLETE: ValueKind = complete::RECORD;

    fn keys(text: &str) -> Result<Vec<Key>, String> {
        let record = Pallet::named(&text.to_lowercase()).ok_or_else(|| {
            let near = nearest(text, RECORDS.iter().map(|record| record.name));
            let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
            format!("unknown record{near}")
        });
        Ok(vec![Key(record?)])
    }

    fn all() -> Vec<Key> {
        RECORDS.iter().map(Key).collect()
    }

    fn name(Key(record): Key) -> String {
        record.name.to_owned()
    }

    async fn open(link: &mut Link, options: &ProgramOptions) -> Result<Self> {
        Ok(Self { program: options.program, letters: link.letters().await? })
    }

    fn table_suffix(&self) -> String {
        format!(" of palletizing program {}", self.program)
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::text("value", "value")]
    }

    fn texts(&self, record: &Record) -> Vec<String> {
        vec![field_values::as_typed(&field_values::named_values_with(record, &self.letters))]
    }

    fn headings(&self) -> Vec<&'static str> {
        vec!["number", "value"]
    }

    fn cells(&self, Key(pallet): Key, record: &Record) -> Vec<view::Cell> {
        let value = field_values::in_a_line(&field_values::named_values_with(record, &self.letters));
        vec![pallet.number.into(), value.into()]
    }

    fn difference(&self, old: &Record, new: &Record) -> [String; 2] {
        field_values::difference(old, new, &self.letters)
    }

    fn value(&self, record: &Record) -> Option<Vec<NamedValue>> {
        Some(field_values::named_values_with(record, &self.letters))
    }

    fn more(&self, Key(pallet): Key, record: Option<&Record>) -> About {
        let Pallet { number, about, .. } = *pallet;
        About { program: self.program, record: number, about, listed: Listed::of(record) }
    }

    fn is_blank(&self, record: &Record) -> bool {
        is_zero(record, record.values().len())
    }

    fn unsaved(&self, _key: Key, record: Option<&Record>) -> Option<String> {
        unlisted(record)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, keys: &[Key]) -> Result<Answers<Record>> {
        let records: Vec<&Pallet> = keys.iter().map(|Key(record)| *record).collect();
        Ok(Answers::of(read_each(link, screen, "reading records", &reads(self.program, &records)?).await?))
    }
}

impl EepromRow for Records {
    const IS_MIXED: bool = true;

    fn letters(&self) -> Letters {
        self.letters
    }

    fn body(&self, Key(record): Key) -> Layout {
        record.layout
    }

    fn request(&self, Key(record): Key) -> Result<Request> {
        Request::read_pallet(self.program, record).map_err(|error| wrong(&error))
    }

    fn cell(&self, Key(record): Key, values: Vec<Value>) -> Result<Cell> {
        cell(self.program, record, values)
    }

    /// Block that writes a record. `?` stands for unchanged values.
    fn sketch(&self, Key(record): Key, values: &[Option<Value>]) -> String {
        let body = record.layout.sketch(values).unwrap_or_default();
        format!("@WPLT {:02} SNO={:02} {body}", self.program, record.number)
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::Bench;

    #[test]
    fn a_program_is_dumped_restored_and_copied() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        let (first, second) = (path("first.csv"), path("second.csv"));
        std::fs::write(&first, "name,value\nend,7\nstart,tag=5 mode=1-M\nsource-pieces,p1=3\n").unwrap();
        let mut bench = Bench::new("sim:");
        let written = |report: &serde_json::Value| {
            let items = report["items"].as_array().unwrap().iter();
            items.map(|item| (item["name"].clone(), item["written"].clone())).collect::<Vec<_>>()
        };
        let restored = |bench: &mut Bench| written(&bench.data(&["palletizing", "restore", &first, "2"]));
        let all = |is_written: bool| ["end", "start", "source-pieces"].map(|name| (name.into(), is_written.into()));
        assert_eq!(restored(&mut bench), all(true));
        assert_eq!(restored(&mut bench), all(false));
        let copied = bench.data(&["palletizing", "copy", "2", "9"]);
        assert_eq!((&copied["cells_written"], &copied["cells_unchanged"]), (&3.into(), &13.into()));
        bench.data(&["palletizing", "dump", &first, "2", "--force"]);
        bench.data(&["palletizing", "dump", &second, "9"]);
        let text = std::fs::read_to_string(&first).unwrap();
        assert_eq!(text, std::fs::read_to_string(&second).unwrap());
        assert!(text.starts_with("name,value\nstart,tag=5 mode=1-M\n"), "{text}");
        let restored = bench.data(&["palletizing", "restore", &second, "1"]);
        assert_eq!(written(&restored).iter().filter(|(_, is_written)| *is_written == true).count(), 3, "{restored}");
        assert_eq!(bench.run(&["palletizing", "dump", &second, "9"]).unwrap_err().kind.exit(), 1);
    }

    #[test]
    fn progress_reports_the_selected_program() {
        let mut bench = Bench::new("sim:");
        bench.data(&["palletizing", "select", "4"]);
        let progress = bench.data(&["palletizing", "progress"]);
        assert_eq!((&progress["number"], &progress["directions"][0]["done"]), (&4.into(), &0.into()), "{progress}");
    }
}

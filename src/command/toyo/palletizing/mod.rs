//! `toyo palletizing`: the sixteen palletizing programs, of sixteen records each.

mod get;
mod progress;
mod set;

use schemars::JsonSchema;
use serde::Serialize;

use super::eeprom::Cell;
use super::items::in_a_word;
use super::link::{Link, wrong};
use super::numbers;
use super::programs::{Copy, Kind, Select};
use super::stores::Store;
use super::values::{self, Shown};
use crate::client::toyo::Letters;
use crate::command::commands;
use crate::controller::nearest::nearest;
use crate::controller::toyo::field::{Field, Value};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::controller::toyo::table::{Command, Pallet};
use crate::failure::Failure;
use crate::output::view::{self, Table, Tone};

commands! {
    /// What can be done with palletizing programs.
    pub enum Palletizing {
        /// Read the records of a program, also into a TOML file
        Get(get::Get),
        /// Write a record, or those of a TOML file: 1 source-p1 x=100
        Set(set::Set),
        /// Copy a program to another number
        Copy(Copy<Numbered>),
        /// Select the program that `run palletizing` starts
        Select(Select<Numbered>),
        /// Progress of the running program
        Progress(progress::Progress),
    }
}

/// Palletizing programs as such.
#[derive(Debug)]
pub struct Numbered;

impl Kind for Numbered {
    const WHAT: &'static str = "palletizing program";
    const IDS: [&'static str; 2] = ["toyo.palletizing.copy", "toyo.palletizing.select"];
    const INTENT: &'static str = "overwrite a palletizing program";
    const HELP: [&'static str; 3] = ["Program to copy, 1 to 16", "Program to replace, 1 to 16", "Program, 1 to 16"];
    const RUN: &'static str = "toyo run palletizing";
    const COMMANDS: [Command; 3] = [Command::Cppl, Command::Spln, Command::Rpld];

    fn field() -> &'static Field {
        field()
    }

    fn reads(program: i32) -> Result<Vec<Request>, Failure> {
        reads(program, &RECORDS.iter().collect::<Vec<_>>())
    }
}

/// The number of a program, 1 to 16.
fn field() -> &'static Field {
    &Command::Rplt.row().requests[0].fields[0]
}

/// A program on a command line.
fn parse_program(text: &str) -> Result<i32, String> {
    numbers::number(field(), text)
}

/// A record by its name or number.
fn parse_record(text: &str) -> Result<&'static Pallet, String> {
    Pallet::named(&text.to_lowercase()).ok_or_else(|| {
        let near = nearest(text, RECORDS.iter().map(|record| record.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean {near}?"));
        format!("there is no such record{near}")
    })
}

/// What reads records of a program.
pub fn reads(program: i32, records: &[&Pallet]) -> Result<Vec<Request>, Failure> {
    let read = |record: &&Pallet| Request::read_pallet(program, record);
    records.iter().map(read).collect::<Result<_, _>>().map_err(|error| wrong(&error))
}

/// The letters by which coordinates of these records are told, if there are any. A file of records has axes 1 to 4 as x,
/// y, z and r: it is refused where the machine has other letters.
async fn letters(link: &mut Link, records: &[&Pallet], is_file: bool) -> Result<Letters, Failure> {
    if !records.iter().any(|record| values::has_coordinates(&record.layout)) {
        return Ok(Letters::USUAL);
    }
    let letters = link.letters().await?;
    if is_file && !letters.are_usual() {
        let message = format!("a file of records means X, Y and Z of the usual axes: {}", values::machine(&letters));
        return Err(Failure::usage(message).hint(
            "`toyo palletizing set PROGRAM RECORD` takes coordinates by their letters; `armctl backup` keeps all",
        ));
    }
    Ok(letters)
}

/// A record of a program as something that is stored.
pub fn store(program: i32, record: &'static Pallet, values: Vec<Value>) -> Result<Store, Failure> {
    let cell = Cell {
        read: Request::read_pallet(program, record).map_err(|error| wrong(&error))?,
        write: Request::write_pallet(program, record, &values).map_err(|error| wrong(&error))?,
        wanted: record.layout.record(values).map_err(|error| wrong(&error))?,
    };
    Ok(Store::new(record.name, cell))
}

/// The block that writes a record; `?` stands for values that are kept.
fn sketch(program: i32, record: &Pallet, values: &[Option<Value>]) -> String {
    let body = record.layout.sketch(values).unwrap_or_default();
    format!("@WPLT {program:02} SNO={:02} {body}", record.number)
}

/// A record of a program.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Entry {
    /// 1 to 16.
    record: u8,
    /// `source-p0`.
    name: &'static str,
    /// What it holds.
    about: &'static str,
    values: Vec<Shown>,
    /// Whether it was answered, or stored.
    ok: bool,
    /// Why it was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    error: Option<Failure>,
}

impl Entry {
    fn of(pallet: &'static Pallet, record: &Record, letters: Letters) -> Self {
        let values = values::shown_by(record, &letters);
        let (record, name, about) = (pallet.number, pallet.name, pallet.about);
        Self { record, name, about, values, ok: true, error: None }
    }

    /// What was answered.
    fn answered(pallet: &'static Pallet, answer: &Result<Record, Failure>, letters: Letters) -> Self {
        match answer {
            Ok(record) => Self::of(pallet, record, letters),
            Err(failure) => Self {
                record: pallet.number,
                name: pallet.name,
                about: pallet.about,
                values: Vec::new(),
                ok: false,
                error: Some(failure.clone()),
            },
        }
    }

    fn table(entries: &[Self]) -> Table {
        let mut table = Table::new(&["record", "name", "value"], "no records");
        for Self { record, name, values, error, .. } in entries {
            let value = match error {
                Some(error) => view::Cell::from(in_a_word(error.kind)).tone(Tone::Bad),
                None => values::in_a_line(values).into(),
            };
            table.row([(*record).into(), (*name).into(), value]);
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use crate::command::toyo::testing::{Bench, blocks, objection};

    #[test]
    fn a_program_is_sixteen_records() {
        let blocks = |words: &[&str]| blocks(words).unwrap();
        assert_eq!(blocks(&["palletizing", "get", "3"]).len(), 16);
        assert_eq!(blocks(&["palletizing", "get", "3", "source-p1", "16"]), ["@RPLT 03 SNO=03", "@RPLT 03 SNO=16"]);
        assert_eq!(blocks(&["palletizing", "progress"]), ["@RPLD"]);
        assert_eq!(blocks(&["palletizing", "select", "16"]), ["@SPLN PR=16", "@RPLD"]);
        let copied = blocks(&["palletizing", "copy", "1", "2"]);
        assert_eq!((copied.len(), &copied[32][..]), (49, "@CPPL STA=01 TOP=02"));
        assert!(objection(&["palletizing", "get", "17"]).contains("17 is out of range (a number, 1 to 16)"));
        let error = objection(&["palletizing", "get", "1", "sorce-p1"]);
        assert!(error.contains("there is no such record; did you mean source-p1?"), "{error}");
    }

    #[test]
    fn a_record_is_compared_before_it_is_written() {
        assert_eq!(
            blocks(&["palletizing", "set", "1", "Source-P1", "1.5", "-2", "0"]).unwrap(),
            ["@RPLT 01 SNO=03", "@WPLT 01 SNO=03 X=+0001.50 Y=-0002.00 Z=+0000.00", "@RPLT 01 SNO=03"]
        );
        assert_eq!(
            blocks(&["palletizing", "set", "1", "1", "5", "m-m"]).unwrap()[1],
            "@WPLT 01 SNO=01 TAG=005 MOD=M-M"
        );
        assert_eq!(blocks(&["palletizing", "set", "1", "7", "aim=incremental"]).unwrap()[2..], ["@RPLT 01 SNO=07"]);
        assert_eq!(
            blocks(&["palletizing", "set", "1", "7", "aim=x"]).unwrap_err().message,
            "source-approach: aim: 'x' is not a (absolute) or i (incremental)"
        );
    }

    #[test]
    fn a_program_goes_through_a_file_and_is_copied() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
        let (first, second) = (path("first.toml"), path("second.toml"));
        std::fs::write(
            &first,
            "16 = 7\nstart = { tag = 5, mode = '1-M' }\nsource-pieces = { p1 = 3, p2 = 0, p3 = 0 }\n",
        )
        .unwrap();
        let mut bench = Bench::new("sim:");
        let stored = bench.data(&["palletizing", "set", "2", "--from", &first]);
        let names: Vec<_> = stored["records"].as_array().unwrap().iter().map(|record| &record["name"]).collect();
        assert_eq!(names, ["start", "source-pieces", "end"]);
        assert_eq!(stored["cells_written"], 3);
        assert_eq!(bench.data(&["palletizing", "set", "2", "--from", &first])["cells_unchanged"], 3);
        let copied = bench.data(&["palletizing", "copy", "2", "9"]);
        assert_eq!((&copied["cells_written"], &copied["cells_unchanged"]), (&3.into(), &13.into()));
        bench.data(&["palletizing", "get", "2", "--toml", &first, "--force"]);
        bench.data(&["palletizing", "get", "9", "--toml", &second]);
        let text = std::fs::read_to_string(&first).unwrap();
        assert_eq!(text, std::fs::read_to_string(&second).unwrap());
        assert!(text.contains("start = { tag = 5, mode = \"1-M\" }"), "{text}");
        assert_eq!(bench.data(&["palletizing", "set", "1", "--from", &second])["cells_written"], 3);
        assert_eq!(bench.run(&["palletizing", "get", "9", "--toml", &second]).unwrap_err().kind.exit(), 1);
    }

    #[test]
    fn progress_tells_the_program_that_was_chosen() {
        let mut bench = Bench::new("sim:");
        bench.data(&["palletizing", "select", "4"]);
        let progress = bench.data(&["palletizing", "progress"]);
        assert_eq!((&progress["program"], &progress["directions"][0]["done"]), (&4.into(), &0.into()), "{progress}");
    }
}

//! `toyo easy`: the eight easy programs. Each repeats a part of the sequential program.

mod progress;

use super::eeprom::Cell;
use super::eeprom_tables::{self, Rows, WRITING};
use super::numbered_programs::{Copy, NumberedProgram, Select};
use crate::prelude::*;
use armctl_controller::toyo::field;
use armctl_controller::toyo::layout::Layout;
use armctl_controller::toyo::table::Command;
use armctl_frame::store::{Dump, Get, List, Restore, Set};

commands! {
    /// Commands for easy programs.
    pub enum Easy {
        /// Read programs, for example 1-3. Without a number, armctl reads all 8 programs
        Get(Get<Rows<Numbered>>),
        /// List programs that are not empty
        List(List<Rows<Numbered>>),
        /// Write a program: type its number, start tag, repetitions and end tag
        Set(Set<Rows<Numbered>>),
        /// Copy a program to another number
        Copy(Copy<Numbered>),
        /// Save programs to a CSV file
        Dump(Dump<Rows<Numbered>>),
        /// Write programs from a CSV file
        Restore(Restore<Rows<Numbered>>),
        /// Select the program that `run easy` starts
        Select(Select<Numbered>),
        /// Show the progress of the running program
        Progress(progress::Progress),
    }
}

/// The easy programs, as a table and as a type of numbered programs.
#[derive(Debug)]
pub struct Numbered;

impl NumberedProgram for Numbered {
    const TYPE_NAME: &'static str = "easy program";
    const WORD: &'static str = "easy";
    const COPY_ID: &'static str = "toyo.easy.copy";
    const SELECT_ID: &'static str = "toyo.easy.select";
    const RUN_ID: &'static str = "toyo.run.easy";
    const COUNT: i64 = 8;
    const INTENT: &'static str = "overwrite an easy program";
    const FROM_HELP: &'static str = "Program to copy, 1 to 8";
    const TO_HELP: &'static str = "Program to replace, 1 to 8";
    const SELECT_HELP: &'static str = "Program, 1 to 8";
    const RUN: &'static str = "toyo run easy";
    const COPY: Command = Command::Cesy;
    const SELECT: Command = Command::Sesn;
    const SELECTED: Command = Command::Resd;
    const START: Command = Command::Sesy;
    const RUN_HELP: Option<&'static str> = Some("Parameter M10 selects easy mode: `armctl toyo param set M10 E`.");

    fn field() -> &'static field::Field {
        key()
    }

    fn reads(program: i32) -> Result<Vec<Request>> {
        Ok(vec![read(program)?])
    }
}

/// Field of the program number, 1 to 8.
fn key() -> &'static field::Field {
    &Command::Resy.row().requests[0].fields[0]
}

/// Request that reads a program.
pub fn read(program: i32) -> Result<Request> {
    Request::new(Command::Resy, vec![Value::Number(program), Value::Number(0)]).map_err(|error| wrong(&error))
}

/// EEPROM cell of a program with these values.
pub fn cell(program: i32, values: Vec<Value>) -> Result<Cell> {
    let all: Vec<Value> = [Value::Number(program), Value::Number(0)].into_iter().chain(values).collect();
    let write = Request::new(Command::Wesy, all.clone()).map_err(|error| wrong(&error))?;
    let wanted = Command::Resy.row().answers[0].record(all).map_err(|error| wrong(&error))?;
    Ok(Cell { read: read(program)?, write, wanted })
}

impl eeprom_tables::Kind for Numbered {
    type Value = Program;
    const WORDS: TableWords = TableWords {
        nouns: ["easy program", "easy programs"],
        placeholder: "PROGRAM",
        range: "Programs (1 to 8), such as 5 or 1-3",
        reading: None,
        writing: Some(WRITING),
    };
    const IDS: Ids = ids!("toyo.easy");
    const FIELDS: &'static [Field] = &[
        Field::number("start_tag", "start tag"),
        Field::number("loops", "loops"),
        Field::number("end_tag", "end tag"),
    ];
    const ZERO_IS_BLANK: bool = true;

    fn key() -> &'static field::Field {
        key()
    }

    fn body() -> Layout {
        Layout::new("START={} LOOP={} END={}", &Command::Wesy.row().requests[0].fields[2..])
    }

    fn read(program: i32) -> Result<Request> {
        read(program)
    }

    fn cell(program: i32, values: Vec<Value>) -> Result<Cell> {
        cell(program, values)
    }

    fn sketch(program: i32, values: &[Option<Value>]) -> String {
        let keys = [program, 0].map(|key| Some(Value::Number(key)));
        let all: Vec<_> = keys.into_iter().chain(values.iter().cloned()).collect();
        format!("@{}", Command::Wesy.row().requests[0].sketch(&all).unwrap_or_default())
    }

    fn value(record: &Record) -> Program {
        let number = |name| record.number(name).unwrap_or_default();
        Program { start_tag: number("start"), loops: number("loop"), end_tag: number("end") }
    }
}

/// An easy program.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Program {
    /// Tag in the sequential program at which the easy program starts.
    start_tag: i32,
    /// Number of repetitions.
    loops: i32,
    /// Tag in the sequential program at which the easy program ends.
    end_tag: i32,
}

#[cfg(test)]
mod tests {
    use crate::testing::Bench;

    #[test]
    fn a_second_copy_writes_nothing() {
        let mut bench = Bench::new("sim:");
        bench.data(&["easy", "set", "1", "10", "5", "20"]);
        assert_eq!(bench.data(&["easy", "set", "1", "loop=6"])["items"][0]["new"]["loops"], 6);
        let copied = |bench: &mut Bench| bench.data(&["easy", "copy", "1", "8"])["cells_written"].clone();
        assert_eq!((copied(&mut bench), copied(&mut bench)), (1.into(), 0.into()));
        let read = bench.data(&["easy", "get", "8"]);
        let value = serde_json::json!({ "start_tag": 10, "loops": 6, "end_tag": 20 });
        assert_eq!((&read["items"][0]["name"], &read["items"][0]["value"]), (&"8".into(), &value));
        assert_eq!(bench.run(&["easy", "copy", "1", "1"]).unwrap_err().kind.exit(), 2);
        bench.data(&["easy", "select", "8"]);
        assert_eq!(bench.data(&["easy", "progress"])["number"], 8);
    }
}

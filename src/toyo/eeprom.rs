//! Cells of the EEPROM. Each cell lasts for about a million writes (TO 2-1, note 2).
//!
//! For this reason, a value that is already equal is not written. Each write is read back, because a worn cell answers
//! `@OK` and keeps its old value (ambiguity R29).

use super::number_arguments::read_back;
use crate::prelude::*;
use armctl_controller::toyo::layout::LayoutProblem;
use armctl_controller::toyo::table::{Command, Op};

/// A stored value: its read request, its write request, and the new value.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Request that reads the value.
    pub read: Request,
    /// Request that writes the value.
    pub write: Request,
    /// New value, with the field names of the answer to the read request.
    pub wanted: Record,
}

/// Numbers of written and unchanged cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, JsonSchema)]
pub struct Cells {
    /// Number of cells that were written and read back.
    pub cells_written: u32,
    /// Number of cells whose value was already equal.
    pub cells_unchanged: u32,
}

/// Purpose of the read before a write, for dry runs.
pub const STORED_VALUE: &str = "the stored value";
/// Condition for the write.
const DIFFERS: &str = "whether the new value differs from the stored value";

impl Cells {
    /// Describes the numbers in a report, for example `2 EEPROM cells written, 1 unchanged`.
    pub fn in_words(self) -> String {
        let Self { cells_written: written, cells_unchanged: unchanged } = self;
        let cells = if written == 1 { "cell" } else { "cells" };
        match (written, unchanged) {
            (0, _) => "nothing was written, because all values are equal".to_owned(),
            (_, 0) => format!("{written} EEPROM {cells} written"),
            _ => format!("{written} EEPROM {cells} written, {unchanged} unchanged"),
        }
    }
}

impl Link {
    /// Writes one cell, unless its value is already equal. A dry run records the requests and continues.
    ///
    /// # Errors
    /// Like [`Link::ask`]. [`Kind::OutcomeUnknown`] if the cell cannot be read back, and [`Kind::Malformed`] if it has
    /// another value after the write.
    pub async fn store(&mut self, screen: &Screen, cell: &Cell, cells: &mut Cells) -> Result<Option<Record>> {
        if self.is_dry_run() {
            self.plan(&cell.read, STORED_VALUE);
            return self.plan_overwriting(&cell.read, &cell.write.text()).await.map(|()| None);
        }
        let found = self.ask(&cell.read).await?;
        if cell.is(&found) {
            cells.cells_unchanged += 1;
        } else {
            self.overwrite(screen, cell, cells).await?;
        }
        Ok(Some(found))
    }

    /// In a dry run, records the requests of [`Link::overwrite`] for a cell that differs: the block that writes it, in
    /// which `?` stands for values that are kept, and the request that reads it back.
    pub async fn plan_overwriting(&mut self, read: &Request, write: &str) -> Result<()> {
        self.plan_order(write, DIFFERS).await?;
        self.plan_if(read, DIFFERS);
        Ok(())
    }

    /// Writes one cell whose value is known to differ, and reads it back.
    ///
    /// # Errors
    /// Like [`Link::store`].
    pub async fn overwrite(&mut self, screen: &Screen, cell: &Cell, cells: &mut Cells) -> Result<()> {
        self.ask(&cell.write).await?;
        if let Some(warning) = self.write_log.written(cell.read.text().trim_start_matches('@')) {
            screen.note(&format!("warning: {warning}"));
        }
        if !cell.is(&read_back(self, &cell.write, &cell.read).await?) {
            return Err(Failure::new(
                Kind::Malformed,
                format!("the controller accepted {}, but the stored value differs", cell.write.text()),
            )
            .hint("check for a second client that writes the same cell, and for a worn EEPROM"));
        }
        cells.cells_written += 1;
        Ok(())
    }

    /// Reads data that only some controllers have. Returns `None` if the request is refused twice. A busy controller
    /// also refuses, so a single refusal is not enough.
    pub async fn read_if_present(&mut self, request: &Request) -> Result<Option<Record>> {
        for _ in 0..2 {
            if let Ok(content) = self.try_ask(request).await? {
                return Ok(Some(content));
            }
        }
        Ok(None)
    }
}

impl Cell {
    /// Whether the content equals the new value.
    pub fn is(&self, found: &Record) -> bool {
        // A step contains an instruction, and some instructions have fields with the same names.
        let is_other = self.read.command() == Command::Rstx && found.layout() != self.wanted.layout();
        !is_other && self.wanted.pairs().all(|(field, wanted)| found.value(field.name) == Some(wanted))
    }
}

/// Block that writes a parameter or a row of a table. `?` stands for values that are kept.
pub fn parameter_sketch(parameter: &Parameter, row: Option<i32>, values: &[Option<Value>]) -> String {
    let values: Vec<_> = row.map(|row| Some(Value::Number(row))).into_iter().chain(values.iter().cloned()).collect();
    format!("@WPAR {}", parameter.layout.sketch(&values).unwrap_or_default())
}

/// Cell of a parameter or of a row of a table, with all fields of its layout.
pub fn parameter_cell(parameter: &'static Parameter, values: Vec<Value>) -> Result<Cell, LayoutProblem> {
    let row = parameter
        .row()
        .and(values.first())
        .and_then(|row| if let Value::Number(row) = row { Some(*row) } else { None });
    Ok(Cell {
        read: Request::read_parameter(parameter, row)?,
        write: Request::write_parameter(parameter, &values)?,
        wanted: parameter.layout.record(values)?,
    })
}

/// Whether the answer to a read is empty: a NOP, or zeros in a table whose cleared rows are zeros. The manuals do not
/// list factory values of parameters.
pub fn is_blank(read: &Request, found: &Record) -> bool {
    let content = read.content().ok().flatten();
    let key = content.as_ref().unwrap_or(read.record());
    let is_zero = || {
        let values = found.pairs().filter(|(field, _)| key.value(field.name).is_none());
        found.is_listed() && values.into_iter().all(|(_, value)| *value == Value::Number(0))
    };
    match read.command() {
        Command::Rstx => found.layout() == Op::Nop.row().layout,
        Command::Rpar => {
            read.parameter().is_some_and(|table| table.id.starts_with("T1") || table.id.starts_with("T4")) && is_zero()
        }
        Command::Rplt | Command::Resy => is_zero(),
        _ => false,
    }
}

//! Tables that people keep in a spreadsheet, as files: where one goes, and what stays of the one that is there.

use std::path::PathBuf;

use clap::Args;

use super::local::Target;
use super::text_files;
use crate::controller::findings::Findings;
use crate::controller::sheet::{Column, Dialect, update, write};
use crate::failure::Failure;

/// How a file is written.
#[derive(Debug, Args)]
#[group(skip)]
pub struct SheetManner {
    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
    /// Put values into the CSV file if it exists; comments and order stay
    #[arg(long, conflicts_with_all = ["force", "decimal_comma"])]
    update: bool,
    /// CSV with commas in numbers and semicolons between cells
    #[arg(long)]
    decimal_comma: bool,
}

/// Where rows go, known before anything is asked.
#[derive(Debug)]
pub struct SheetTarget {
    target: Target,
    dialect: Dialect,
    /// What is there and stays.
    old: Option<Vec<u8>>,
}

impl SheetManner {
    /// Whether any of it was asked for that only a table in a file can have.
    pub fn is_given(&self) -> bool {
        self.force || self.is_of_tables()
    }

    /// Whether something was asked for that only tables have.
    pub fn is_of_tables(&self) -> bool {
        self.update || self.decimal_comma
    }

    /// Where rows of one robot go.
    pub fn target(&self, file: PathBuf, several: bool) -> Result<SheetTarget, Failure> {
        if several {
            return Err(text_files::of_one_robot(&file));
        }
        let is_there = file.symlink_metadata().is_ok();
        let old = if self.update && is_there { Some(text_files::read(&file)?) } else { None };
        let target = Target::new(file, self.force || self.update);
        let advice = "--update puts the values into it and keeps its comments; --force replaces it";
        let target = target.map_err(|failure| if is_there { failure.hint(advice) } else { failure })?;
        let dialect = if self.decimal_comma { Dialect::DECIMAL_COMMA } else { Dialect::COMMAS };
        Ok(SheetTarget { target, dialect, old })
    }
}

impl SheetTarget {
    /// The file that is there, whose rows get new values.
    pub fn old(&self) -> Option<&[u8]> {
        self.old.as_deref()
    }

    /// Writes rows, whole or not at all, and says where. The first column tells a row; `canonical` gives it one spelling.
    pub fn write(
        &self,
        columns: &[Column],
        rows: &[Vec<String>],
        canonical: impl Fn(&str) -> String,
    ) -> Result<String, Failure> {
        let text = match &self.old {
            None => write(self.dialect, columns, rows),
            Some(old) => {
                let mut findings = Findings::default();
                let updated = update(old, columns, rows, canonical, &mut findings);
                let name = self.target.path().display().to_string();
                updated.ok_or_else(|| text_files::faulty(&name, &findings.into_errors()))?
            }
        };
        text_files::write(&self.target, &text)
    }
}

/// One spelling of a number: `007` is `7`.
pub fn number(text: &str) -> String {
    text.trim().parse::<i64>().map_or_else(|_| text.trim().to_owned(), |number| number.to_string())
}

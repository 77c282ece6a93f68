//! Table files for spreadsheets: the path, and the content that an update keeps.

use super::local_names::Target;
use super::text_files;
use crate::prelude::basics::*;
use armctl_controller::findings::Findings;
use armctl_controller::sheet::{Column, Dialect, update, write};

/// File options.
#[derive(Debug, Args)]
#[group(skip)]
pub struct SheetManner {
    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
    /// Update the values in an existing CSV file. Keep its comments and its order
    #[arg(long, conflicts_with_all = ["force", "decimal_comma"])]
    update: bool,
    /// Write the CSV file with decimal commas, and with semicolons between the cells
    #[arg(long)]
    decimal_comma: bool,
}

/// File for the rows. It is checked before any request to the controller.
#[derive(Debug)]
pub struct SheetTarget {
    target: Target,
    dialect: Dialect,
    /// Content of the existing file, which an update keeps.
    pub old: Option<Vec<u8>>,
}

impl SheetManner {
    /// Whether the user gave an option that needs a table file.
    pub fn is_given(&self) -> bool {
        self.force || self.is_of_tables()
    }

    /// Whether the user gave an option that only tables have.
    pub fn is_of_tables(&self) -> bool {
        self.update || self.decimal_comma
    }

    /// File for the rows of one robot.
    pub fn target(&self, file: PathBuf, several: bool) -> Result<SheetTarget> {
        if several {
            return Err(text_files::of_one_robot(&file));
        }
        let exists = file.symlink_metadata().is_ok();
        let old = if self.update && exists { Some(text_files::read(&file)?) } else { None };
        let target = Target::new(file, self.force || self.update);
        let advice = "add --update to update the values of the file and keep its comments, or --force to replace the \
                      file";
        let target = target.map_err(|failure| if exists { failure.hint(advice) } else { failure })?;
        let dialect = if self.decimal_comma { Dialect::DECIMAL_COMMA } else { Dialect::COMMAS };
        Ok(SheetTarget { target, dialect, old })
    }
}

impl SheetTarget {
    /// Writes the rows atomically, and returns the path. The first column identifies a row; `canonical` normalizes its
    /// text.
    pub fn write(
        &self,
        columns: &[Column],
        rows: &[Vec<String>],
        canonical: impl Fn(&str) -> String,
    ) -> Result<String> {
        let text = match &self.old {
            None => write(self.dialect, columns, rows),
            Some(old) => {
                let mut warnings = Findings::default();
                let updated = update(old, columns, rows, canonical, &mut warnings);
                let name = self.target.path().display().to_string();
                updated.ok_or_else(|| text_files::file_failure(&name, &warnings.into_errors()))?
            }
        };
        text_files::write(&self.target, &text)
    }
}

/// Canonical spelling of a number: `007` becomes `7`.
pub fn number(text: &str) -> String {
    text.trim().parse::<i64>().map_or_else(|_| text.trim().to_owned(), |number| number.to_string())
}

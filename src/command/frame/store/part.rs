//! A table as a part of a backup: converts all rows to text, and back.

use std::fmt::Debug;

use futures_util::future::LocalBoxFuture;

use super::change::{ComparedRow, Row, compare, differing, replaced, write_each};
use super::file::{Answer, Kept, LeftOut, leave_out_unused, parse};
use super::get::defined;
use super::{Writable, read, sheet};
use crate::command::frame::connection::Family;
use crate::controller::findings::{Finding, Findings};
use crate::controller::sheet::{self, Dialect};
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// Text of a part.
#[derive(Debug)]
pub struct Text {
    /// Text as CSV.
    pub text: String,
    /// Rows that are not in the text.
    pub left_out: Vec<LeftOut>,
}

/// Result of writing a part.
#[derive(Debug, Default)]
pub struct PartResult {
    /// Number of written rows.
    pub written: usize,
    /// Number of rows that were already equal on the controller.
    pub unchanged: usize,
    /// Rows that this controller does not have.
    pub left_out: Vec<LeftOut>,
    /// First failure, with the number of rows that were written and not written.
    pub failure: Option<Failure>,
}

/// A part of a backup, for any type of rows.
pub trait TablePart<F: Family>: Debug {
    /// Singular and plural of the name of a row, such as `point`, `points`.
    fn nouns(&self) -> [&'static str; 2];

    /// Number of rows to write.
    fn count(&self) -> usize;

    /// Reads all rows. A dry run records the requests.
    fn read<'t>(&'t mut self, link: &'t mut F::Link, screen: &'t Screen) -> LocalBoxFuture<'t, Result<Text, Failure>>;

    /// Compares the rows of the file with the controller. A dry run records the requests.
    fn compare<'t>(&'t mut self, link: &'t mut F::Link, screen: &'t Screen) -> LocalBoxFuture<'t, Result<(), Failure>>;

    /// Names of the rows that will be written.
    fn differing(&self) -> Vec<String>;

    /// Values that a person wrote and that will be replaced: name, old value, new value.
    fn replaced(&self) -> Vec<[String; 3]>;

    /// Consequences of the writes, for the question to the user.
    fn consequences(&self) -> Vec<String>;

    /// Writes the rows that differ. A dry run records the requests.
    ///
    /// # Errors
    /// If no row was tried. A failure of a row is in the result.
    fn write<'t>(
        &'t mut self,
        link: &'t mut F::Link,
        screen: &'t Screen,
    ) -> LocalBoxFuture<'t, Result<PartResult, Failure>>;
}

/// A table with the rows of a file.
#[derive(Debug)]
pub struct Part<S: Writable> {
    table: S,
    rows: Vec<Row<S>>,
    compared: Vec<ComparedRow<S>>,
    absent: Vec<LeftOut>,
}

impl<S: Writable> Part<S> {
    /// A table that is read, or to which these rows are written.
    pub fn new(table: S, rows: Vec<Row<S>>) -> Self {
        Self { table, rows, compared: Vec::new(), absent: Vec::new() }
    }

    /// Parses the rows of a file.
    ///
    /// # Errors
    /// If the file has mistakes. All of them are returned.
    pub fn parse(table: S, bytes: &[u8]) -> Result<Self, Vec<Finding>> {
        let mut findings = Findings::default();
        let rows = parse(&table, bytes, &mut findings);
        if findings.errors() > 0 { Err(findings.into_errors()) } else { Ok(Self::new(table, rows)) }
    }

    /// Splits the rows: the first part has the rows for which `is_first` is true, the second part has the others.
    #[must_use]
    pub fn split(self, other: S, is_first: impl Fn(S::Key) -> bool) -> [Self; 2] {
        let (first, second) = self.rows.into_iter().partition(|(key, _)| is_first(*key));
        [Self::new(self.table, first), Self::new(other, second)]
    }

    /// First failure, with the number of rows that were written and not written.
    fn failure(&self) -> Option<Failure> {
        let failed = self.compared.iter().filter(|row| row.outcome.is_err());
        let (written, unchanged) = self.counts();
        let skipped: Vec<String> = failed.clone().filter(|row| row.is_skipped).map(|row| S::name(row.key)).collect();
        let first = failed.clone().find(|row| !row.is_skipped)?;
        let failure = first.outcome.as_ref().err()?.clone();
        let mut parts = vec![failure.message.trim_end_matches('.').to_owned()];
        if written + unchanged > 0 {
            parts.push(format!("{written} written, {unchanged} unchanged"));
        }
        // Only these kinds of failure prove that the row did not change.
        let is_unwritten =
            |failure: &Failure| matches!(failure.kind, Kind::Refused | Kind::NoAnswer | Kind::Rejected | Kind::Usage);
        let tried = || failed.clone().filter(|row| !row.is_skipped);
        let is_unknown = |row: &&ComparedRow<S>| row.outcome.as_ref().is_err_and(|failure| !is_unwritten(failure));
        let unknown: Vec<String> = tried().filter(is_unknown).map(|row| S::name(row.key)).collect();
        let refused = tried().filter(|row| !is_unknown(row)).map(|row| S::name(row.key));
        let not_written: Vec<String> = refused.chain(skipped).collect();
        for (state, names) in [("unknown", unknown), ("not written", not_written)] {
            if !names.is_empty() {
                parts.push(format!("{state}: {}", span(&names)));
            }
        }
        let again = "repeat the command to continue; it skips stored values".to_owned();
        let hint = failure.hint.as_ref().map_or(again.clone(), |hint| format!("{hint}; then {again}"));
        Some(Failure { message: parts.join("; "), ..failure }.hint(hint))
    }

    /// Number of written rows and of equal rows.
    fn counts(&self) -> (usize, usize) {
        let count = |wanted| self.compared.iter().filter(|row| row.outcome == Ok(wanted)).count();
        (count(true), count(false))
    }
}

/// Text for names: all names if they are few, otherwise the first and the last.
fn span(names: &[String]) -> String {
    match names {
        [first, _, _, .., last] => format!("{first} to {last}"),
        few => few.join(", "),
    }
}

impl<S: Writable> TablePart<S::Family> for Part<S> {
    fn nouns(&self) -> [&'static str; 2] {
        S::WORDS.nouns
    }

    fn count(&self) -> usize {
        self.rows.len()
    }

    fn read<'t>(
        &'t mut self,
        link: &'t mut <S::Family as Family>::Link,
        screen: &'t Screen,
    ) -> LocalBoxFuture<'t, Result<Text, Failure>> {
        Box::pin(async move {
            let keys = S::saved();
            self.table.prepare(link, &keys).await?;
            let answers = read(&mut self.table, link, screen, &keys).await?;
            let mut kept = Kept::default();
            for (key, outcome) in keys.into_iter().zip(answers.rows) {
                match defined::<S>(outcome) {
                    // The connection is lost, so the part is not complete.
                    Err(failure) if failure.kind == Kind::NoAnswer => return Err(failure),
                    Err(failure) => kept.left_out.push(LeftOut { name: S::name(key), why: failure.message }),
                    Ok(wire) => {
                        if let Answer::Row(wire) = kept.add(&self.table, key, Ok(wire)) {
                            kept.save(&self.table, key, Some(&wire));
                        }
                    }
                }
            }
            let Kept { mut rows, left_out, .. } = kept;
            let mut columns = sheet(&self.table);
            leave_out_unused(&self.table, &mut columns, &mut rows);
            Ok(Text { text: sheet::write(Dialect::COMMAS, &columns, &rows), left_out })
        })
    }

    fn compare<'t>(
        &'t mut self,
        link: &'t mut <S::Family as Family>::Link,
        screen: &'t Screen,
    ) -> LocalBoxFuture<'t, Result<(), Failure>> {
        Box::pin(async move {
            self.table.select(link).await?;
            let keys: Vec<S::Key> = self.rows.iter().map(|(key, _)| *key).collect();
            self.table.prepare(link, &keys).await?;
            if let Some(compared) = compare(&self.table, link, screen, &self.rows).await? {
                let (absent, compared): (Vec<_>, Vec<_>) =
                    compared.into_iter().partition(|row| row.is_undefined() && S::is_absent(row.key));
                let why = "missing on the controller";
                let left_out = absent.into_iter().map(|row| LeftOut { name: S::name(row.key), why: why.to_owned() });
                self.absent = left_out.collect();
                self.compared = compared;
            }
            Ok(())
        })
    }

    fn differing(&self) -> Vec<String> {
        self.compared.iter().filter(|row| row.is_different()).map(|row| S::name(row.key)).collect()
    }

    fn replaced(&self) -> Vec<[String; 3]> {
        replaced(&self.table, &differing(&self.compared))
    }

    fn consequences(&self) -> Vec<String> {
        self.table.consequences(&differing(&self.compared))
    }

    fn write<'t>(
        &'t mut self,
        link: &'t mut <S::Family as Family>::Link,
        screen: &'t Screen,
    ) -> LocalBoxFuture<'t, Result<PartResult, Failure>> {
        Box::pin(async move {
            if self.compared.is_empty() && self.absent.is_empty() {
                if !self.rows.is_empty() {
                    self.table.select(link).await?;
                    self.table.plan(link, &self.rows).await?;
                }
                return Ok(PartResult::default());
            }
            self.table.select(link).await?;
            write_each(&self.table, link, screen, &mut self.compared).await;
            let (written, unchanged) = self.counts();
            Ok(PartResult { written, unchanged, left_out: self.absent.clone(), failure: self.failure() })
        })
    }
}

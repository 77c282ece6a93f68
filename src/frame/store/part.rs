//! A table as a part of a backup: converts all rows to text, and back.

use std::fmt::Debug;

use super::change::{ComparedRow, Row, compare, differing, replaced, write_each};
use super::file::{Answer, LeftOut, SavedRows, leave_out_unused, parse};
use super::get::defined;
use super::{LinkOf, Store, Writable, read, sheet};
use crate::connection::Family;
use crate::prelude::basics::*;
use armctl_controller::findings::{Finding, Findings};
use armctl_controller::sheet;
use armctl_controller::sheet::Dialect;

/// Content of a part as text.
#[derive(Debug)]
pub struct Text {
    /// Text as CSV.
    pub text: String,
    /// Rows that are not in the text.
    pub left_out: Vec<LeftOut>,
    /// Rows that the controller refused because they are not defined, grouped by the reason.
    pub undefined: Vec<LeftOut>,
}

/// Result of writing a part.
#[derive(Debug, Default)]
pub struct PartResult {
    /// Number of written rows.
    pub written: usize,
    /// Number of rows that were already equal on the controller.
    pub unchanged: usize,
    /// Rows that this controller does not have, or that it refused.
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
    fn read<'t>(&'t mut self, link: &'t mut F::Link, screen: &'t Screen) -> LocalBoxFuture<'t, Result<Text>>;

    /// Compares the rows of the file with the controller. A dry run records the requests.
    fn compare<'t>(&'t mut self, link: &'t mut F::Link, screen: &'t Screen) -> LocalBoxFuture<'t, Result<()>>;

    /// Names of the rows that will be written.
    fn differing(&self) -> Vec<String>;

    /// User data that the write replaces: name, old value, new value.
    fn replaced(&self) -> Vec<[String; 3]>;

    /// Consequences of the writes, for the question to the user.
    fn consequences(&self) -> Vec<String>;

    /// Writes the rows that differ. A dry run records the requests.
    ///
    /// # Errors
    /// If no row was tried. A failure of a row is in the result.
    fn write<'t>(&'t mut self, link: &'t mut F::Link, screen: &'t Screen) -> LocalBoxFuture<'t, Result<PartResult>>;
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

    /// Number of written rows and of unchanged rows.
    fn counts(&self) -> (usize, usize) {
        let count = |wanted| self.compared.iter().filter(|row| row.outcome == Ok(wanted)).count();
        (count(true), count(false))
    }
}

/// Text of rows that were read. The text contains a row only if `restore` can read the row from it.
///
/// # Errors
/// The connection was lost: the part is not complete.
pub fn part_text<S: Writable>(table: &S, keys: &[S::Key], rows: Vec<Result<Option<S::Wire>>>) -> Result<Text> {
    let (mut kept, mut refused) = (SavedRows::default(), Vec::new());
    let fields = table.fields();
    for (key, outcome) in keys.iter().zip(rows) {
        if let Some(failure) = outcome.as_ref().err().filter(|failure| S::is_undefined(failure)) {
            refused.push((*key, failure.message.clone()));
        }
        match defined::<S>(outcome) {
            Err(failure) if failure.kind == Kind::NoAnswer => return Err(failure),
            Err(failure) => kept.left_out.push(LeftOut { name: S::name(*key), why: failure.message }),
            Ok(wire) => {
                let Answer::Row(wire) = kept.add(table, *key, Ok(wire)) else { continue };
                let texts = table.texts(&wire);
                let cells = fields.iter().zip(&texts);
                let cells =
                    cells.map(|(field, text)| Some(&**text).filter(|text| !field.is_optional || !text.is_empty()));
                match table.draft(*key, &cells.collect::<Vec<_>>()) {
                    Ok(_) => kept.save(table, *key, Some(&wire)),
                    Err(why) => {
                        let why = format!("{} cannot be written back: {why}", texts.join(" "));
                        kept.left_out.push(LeftOut { name: S::name(*key), why });
                    }
                }
            }
        }
    }
    let SavedRows { mut rows, left_out, .. } = kept;
    let mut columns = sheet(table);
    leave_out_unused(table, &mut columns, &mut rows);
    let text = sheet::write(Dialect::COMMAS, &columns, &rows);
    Ok(Text { text, left_out, undefined: by_reason::<S>(refused) })
}

/// Entries for these rows. Rows with the same reason share one entry.
fn by_reason<S: Store>(rows: Vec<(S::Key, String)>) -> Vec<LeftOut> {
    let mut groups: Vec<(String, Vec<S::Key>)> = Vec::new();
    for (key, why) in rows {
        match groups.iter_mut().find(|(reason, _)| *reason == why) {
            Some((_, keys)) => keys.push(key),
            None => groups.push((why, vec![key])),
        }
    }
    groups.into_iter().map(|(why, keys)| LeftOut { name: S::names(&keys), why }).collect()
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

    fn read<'t>(&'t mut self, link: &'t mut LinkOf<S>, screen: &'t Screen) -> LocalBoxFuture<'t, Result<Text>> {
        Box::pin(async move {
            let keys = S::saved();
            self.table.prepare(link, &keys).await?;
            let answers = read(&mut self.table, link, screen, &keys).await?;
            part_text(&self.table, &keys, answers.rows)
        })
    }

    fn compare<'t>(&'t mut self, link: &'t mut LinkOf<S>, screen: &'t Screen) -> LocalBoxFuture<'t, Result<()>> {
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

    fn write<'t>(&'t mut self, link: &'t mut LinkOf<S>, screen: &'t Screen) -> LocalBoxFuture<'t, Result<PartResult>> {
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
            let refused = self.compared.iter().filter_map(|row| {
                let failure = row.outcome.as_ref().err().filter(|failure| failure.kind == Kind::Refused)?;
                Some(LeftOut { name: S::name(row.key), why: failure.message.clone() })
            });
            let left_out = self.absent.iter().cloned().chain(refused).collect();
            Ok(PartResult { written, unchanged, left_out, failure: self.failure() })
        })
    }
}

//! `dump` and `restore`: save rows to a CSV file for spreadsheets, and write them back.

use std::collections::HashMap;

use super::change::{Row, TableWrite, confirmation, intent, write};
use super::get::{Rows, defined};
use super::{Store, Writable, WrittenOf, read, read_keys, sheet};
use crate::items::{ItemError, verdict};
use crate::prelude::basics::*;
use crate::robot::item::as_requested;
use crate::table_file::SheetManner;
use crate::text_files;
use crate::{Command, Context};
use armctl_controller::findings::Findings;
use armctl_controller::sheet::{Column, Sheet};

/// Saves rows to a CSV file.
#[derive(Debug, Args)]
#[command(
    after_help = "The file has one row per line: the name of the row, then its values, each value in its own column. \
                  `restore` writes the rows back. Empty rows are omitted. With --update, an existing file keeps its \
                  own columns (columns whose names begin with `comment`) and the order of its rows."
)]
pub struct Dump<S: Store> {
    /// CSV file to write
    file: PathBuf,
    #[command(flatten)]
    options: S::Options,
    #[arg(required = S::all().is_empty(), value_name = S::WORDS.placeholder, value_delimiter = ',',
        value_parser = Rows::<S>::parse, help = S::WORDS.range)]
    rows: Vec<Rows<S>>,
    #[command(flatten)]
    manner: SheetManner,
}

impl<S: Store> Command for Dump<S> {
    type Family = S::Family;
    type Report = DumpReport;
    const ID: &'static str = S::IDS.dump;

    fn risk(&self) -> Risk {
        S::risk_of_reading(&self.options)
    }

    async fn run(&self, context: Context<'_, S::Family>) -> Result<DumpReport> {
        let Context { link, screen, several, .. } = context;
        let target = self.manner.target(self.file.clone(), several)?;
        // An update writes all rows of the file, including rows that are blank now.
        let old = target.old.as_deref();
        let keys = old
            .filter(|_| self.rows.is_empty())
            .map_or_else(|| Ok(self.chosen()), |old| keys_of::<S>(&self.file, old))?;
        let mut table = S::open(link, &self.options).await?;
        table.prepare(link, &keys).await?;
        let answers = read(&mut table, link, screen, &keys).await?;
        let (mut kept, mut undefined) = (SavedRows::default(), Vec::new());
        for (key, outcome) in keys.iter().zip(answers.rows) {
            let is_wanted = |wire: &S::Wire| S::SAVES_BLANK || old.is_some() || !table.is_blank(wire);
            match kept.add(&table, *key, outcome) {
                Answer::Row(wire) if is_wanted(&wire) => kept.save(&table, *key, Some(&wire)),
                // `restore` accepts a row without values.
                Answer::Undefined if old.is_some() && table.fields().iter().all(|field| field.is_optional) => {
                    kept.save(&table, *key, None);
                }
                Answer::Undefined => undefined.push(*key),
                Answer::Row(_) | Answer::LeftOut => {}
            }
        }
        let SavedRows { mut rows, left_out, failed } = kept;
        let mut columns = sheet(&table);
        if old.is_none() {
            leave_out_unused(&table, &mut columns, &mut rows);
        }
        let file = target.write(&columns, &rows, canonical::<S>)?;
        Ok(DumpReport { file, saved: rows.len(), not_defined: S::names(&undefined), left_out, failed })
    }
}

impl<S: Store> Dump<S> {
    fn chosen(&self) -> Vec<S::Key> {
        if self.rows.is_empty() { S::saved() } else { Rows::of(&self.rows) }
    }
}

/// Rows for a file, as they were read.
#[derive(Debug, Default)]
pub struct SavedRows {
    /// Name and values of each row in the file.
    pub rows: Vec<Vec<String>>,
    /// Rows that cannot be written back.
    pub left_out: Vec<LeftOut>,
    /// Rows that were not read.
    pub failed: Vec<ItemError>,
}

/// A row that is not in the file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LeftOut {
    /// Name of the row, as it can be typed.
    pub name: String,
    /// Reason why the row is not in the file.
    pub why: String,
}

/// What an answer means for a file.
#[derive(Debug)]
pub enum Answer<W> {
    /// The row can be in the file.
    Row(W),
    /// The row is not defined.
    Undefined,
    /// The row cannot be in the file, or was not read.
    LeftOut,
}

impl SavedRows {
    /// Decides whether an answer can be in the file. Records a row that cannot.
    pub fn add<S: Store>(&mut self, table: &S, key: S::Key, outcome: Result<Option<S::Wire>>) -> Answer<S::Wire> {
        match defined::<S>(outcome) {
            Ok(wire) => match table.unsaved(key, wire.as_ref()) {
                Some(why) => {
                    self.left_out.push(LeftOut { name: S::name(key), why });
                    Answer::LeftOut
                }
                None => wire.map_or(Answer::Undefined, Answer::Row),
            },
            Err(failure) => {
                self.failed.push(ItemError::new(as_requested(S::WORDS.nouns[0], &S::name(key)), failure));
                Answer::LeftOut
            }
        }
    }

    /// Adds a row to the file.
    pub fn save<S: Store>(&mut self, table: &S, key: S::Key, wire: Option<&S::Wire>) {
        let empty = || vec![String::new(); table.fields().len()];
        let texts = wire.map_or_else(empty, |wire| table.texts(wire));
        self.rows.push([vec![S::name(key)], texts].concat());
    }
}

/// Removes the optional columns that have no value in any row.
pub fn leave_out_unused<S: Store>(table: &S, columns: &mut Vec<Column>, rows: &mut [Vec<String>]) {
    let optional = std::iter::once(false).chain(table.fields().into_iter().map(|field| field.is_optional));
    let is_used = |(at, is_optional): (usize, bool)| !is_optional || rows.iter().any(|row| !row[at].is_empty());
    let used_columns: Vec<bool> = optional.enumerate().map(is_used).collect();
    let mut kept = used_columns.iter();
    columns.retain(|_| kept.next().is_some_and(|used| *used));
    for row in rows {
        let mut kept = used_columns.iter();
        row.retain(|_| kept.next().is_some_and(|used| *used));
    }
}

/// Reads and checks the rows of a file.
///
/// # Errors
/// If the file has mistakes. The failure lists all of them.
pub fn rows_of_file<S: Writable>(table: &S, path: &Path) -> Result<Vec<Row<S>>> {
    let bytes = text_files::read(path)?;
    let mut findings = Findings::default();
    let rows = parse(table, &bytes, &mut findings);
    if findings.errors() > 0 {
        return Err(text_files::file_failure(&text_files::display_path(path), &findings.into_errors()));
    }
    Ok(rows)
}

/// Keys of the rows in a file, in the order of the file.
pub fn keys_of<S: Store>(path: &Path, bytes: &[u8]) -> Result<Vec<S::Key>> {
    let (mut findings, mut keys) = (Findings::default(), Vec::new());
    let expected = "the first column is `name`";
    if let Some(sheet) = Sheet::read(bytes, expected, &mut findings) {
        let Some(at) = sheet.column("name") else {
            let message = format!("column `name` is missing ({expected})");
            return Err(Failure::usage(format!("{}: {message}", text_files::display_path(path)))
                .hint("add --force to replace the file; nothing was read from the controller"));
        };
        for row in sheet.rows() {
            match read_keys::<S>(row.text(at)) {
                Ok(row) => keys.extend(row),
                Err(why) => findings.error(row.place(at), why, None),
            }
        }
    }
    if findings.errors() > 0 {
        return Err(text_files::file_failure(&text_files::display_path(path), &findings.into_errors()));
    }
    Ok(keys)
}

/// Canonical spelling of the key of a row.
fn canonical<S: Store>(text: &str) -> String {
    match S::keys(text).as_deref() {
        Ok([key]) => S::name(*key),
        _ => text.trim().to_owned(),
    }
}

/// Report of `dump`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DumpReport {
    file: String,
    /// Number of rows in the file.
    saved: usize,
    /// Rows that are not defined on the controller, for example `3, 7..9`.
    not_defined: String,
    /// Rows that cannot be written back, or that the controller does not have.
    left_out: Vec<LeftOut>,
    /// Rows that were not read.
    failed: Vec<ItemError>,
}

impl Report for DumpReport {
    fn view(&self) -> View {
        let mut fields = vec![("file", self.file.as_str().into()), ("rows", self.saved.into())];
        if !self.not_defined.is_empty() {
            fields.push(("not defined", self.not_defined.as_str().into()));
        }
        let left_out: Vec<&str> = self.left_out.iter().map(|row| row.name.as_str()).collect();
        if !left_out.is_empty() {
            fields.push(("left out", left_out.join(", ").into()));
        }
        View { sections: vec![Section::Fields(fields)] }
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.saved + self.failed.len(), &self.failed)
    }
}

/// Writes rows from a CSV file.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl checks the whole file before it sends anything. A value without a column stays as it is on \
                  the controller. armctl does not write values that are already stored, so the same command continues \
                  after an interruption. Columns whose names begin with `comment` are for your own use."
)]
pub struct Restore<S: Writable> {
    /// CSV file that `dump` wrote, or with the same columns; - means stdin
    file: PathBuf,
    #[command(flatten)]
    options: S::Options,
    #[arg(value_name = S::WORDS.placeholder, value_delimiter = ',', value_parser = Rows::<S>::parse,
        help = "Only these")]
    rows: Vec<Rows<S>>,
}

impl<S: Writable> Command for Restore<S> {
    type Family = S::Family;
    type Report = WrittenOf<S>;
    const ID: &'static str = S::IDS.restore;
    const RISK: Risk = S::RISK;
    const CONFIRMATION: Confirmation = confirmation::<S>();

    fn intent(&self) -> String {
        intent::<S>()
    }

    async fn run(&self, context: Context<'_, S::Family>) -> Result<WrittenOf<S>> {
        let Context { robot, link, screen, confirmer, .. } = context;
        let name = text_files::display_path(&self.file);
        let mut table = S::open(link, &self.options).await?;
        let bytes = text_files::read(&self.file)?;
        table.prepare(link, &keys_of::<S>(&self.file, &bytes).unwrap_or_default()).await?;
        let mut warnings = Findings::default();
        let mut rows = parse(&table, &bytes, &mut warnings);
        if warnings.errors() > 0 {
            return Err(text_files::file_failure(&name, &warnings.into_errors()));
        }
        if self.rows.is_empty() {
            let left = rows.extract_if(.., |(key, _)| !S::is_restored(*key)).count();
            if left > 0 {
                screen.note(&format!("skipped {left} {}: {}", S::WORDS.nouns[1], S::NOT_RESTORED));
            }
        } else {
            let selected = Rows::of(&self.rows);
            rows.retain(|(key, _)| selected.contains(key));
        }
        if rows.is_empty() {
            let message = format!("{name}: the file has no {} to write", S::WORDS.nouns[1]);
            return Err(Failure::usage(message).hint("use `dump FILE` to write such a file"));
        }
        write(TableWrite { table, robot, link, screen, confirmer }, rows).await
    }
}

/// Whether the first line has a column that is the alias of a field.
fn has_aliases<S: Store>(table: &S, bytes: &[u8]) -> bool {
    let head = bytes.split(|byte| *byte == b'\n').find(|line| !line.trim_ascii().is_empty()).unwrap_or_default();
    let head = String::from_utf8_lossy(head).to_lowercase();
    let columns = || head.split([',', ';', '\t']).map(|column| column.trim().trim_matches('"'));
    table.fields().iter().any(|field| field.alias.is_some_and(|alias| columns().any(|column| column == alias)))
}

/// Parses the rows of a file, each with its new content.
pub fn parse<S: Writable>(table: &S, bytes: &[u8], findings: &mut Findings) -> Vec<(S::Key, S::Draft)> {
    let mut columns = sheet(table);
    if has_aliases(table, bytes) {
        for (column, field) in columns.iter_mut().skip(1).zip(table.fields()) {
            column.name = field.alias.map_or_else(|| field.name.into_owned(), ToOwned::to_owned);
        }
    }
    let names: Vec<&str> = columns.iter().map(|column| &*column.name).collect();
    let expected = format!("the columns are {}", names.join(", "));
    let mut rows = Vec::new();
    let Some(sheet) = Sheet::read(bytes, &expected, findings) else { return rows };
    let places = sheet.columns(&names, &expected, findings);
    let Some(of_name) = places[0] else {
        findings.error(sheet.end_of_head(), "column `name` is missing".to_owned(), Some(expected));
        return rows;
    };
    let (fields, mut seen) = (table.fields(), HashMap::new());
    for row in sheet.rows() {
        let key = match read_keys::<S>(row.text(of_name)).as_deref() {
            Ok([key]) => *key,
            Ok(_) => {
                findings.error(row.place(of_name), "a line can have only one row".to_owned(), None);
                continue;
            }
            Err(why) => {
                findings.error(row.place(of_name), why, None);
                continue;
            }
        };
        if let Some(other) = seen.insert(key, row.line) {
            findings.error(row.place(of_name), format!("{} is already in line {other}", S::name(key)), None);
        }
        let mut texts = Vec::new();
        for ((column, place), field) in columns.iter().zip(&places).skip(1).zip(&fields) {
            texts.push(match place {
                None => None,
                Some(at) if field.is_optional && row.string(*at).is_empty() => None,
                Some(at) if column.is_number => match sheet.number(row, *at) {
                    Ok(number) if !number.is_empty() => Some(number.into_owned()),
                    Ok(_) => {
                        let message = format!("{} is empty; remove the column to keep the stored value", column.name);
                        findings.error(row.place(*at), message, None);
                        None
                    }
                    Err(why) => {
                        findings.error(row.place(*at), format!("{}: {why}", column.name), None);
                        None
                    }
                },
                Some(at) => Some(row.string(*at).to_owned()),
            });
        }
        // In a file, an undefined row is a row without values.
        if fields.iter().all(|field| field.is_optional) && texts.iter().all(Option::is_none) {
            continue;
        }
        let texts: Vec<Option<&str>> = texts.iter().map(Option::as_deref).collect();
        match table.draft(key, &texts) {
            Ok(draft) => rows.push((key, draft)),
            Err(why) => findings.error(row.place(usize::MAX), why, None),
        }
    }
    rows
}

//! Alarms and errors: common keys of `alarm list` and `alarm history` in every family, `explain`, `top` and topics.

use crate::face::shared_commands::CommonReport;
use crate::items::{ItemError, ItemOutcome, verdict};
use crate::prelude::basics::*;
use crate::settings::alarms::Explanation;

/// An alarm or error. A field is null if the protocol does not report it, or if its value is unknown.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Alarm {
    /// Code in the notation of the controller: `4315`, `12.600`, `28`.
    pub code: Option<String>,
    /// Text; the text of `alarms.toml` has priority.
    pub text: Option<String>,
    /// Alarm, error or warning.
    pub kind: Option<Kind>,
    /// Level in the terms of the family.
    pub severity: Option<&'static str>,
    /// Time, as the controller reports it.
    pub time: Option<String>,
    /// Usual cause.
    pub cause: Option<String>,
    /// Remedy.
    pub remedy: Option<String>,
    /// Source of the texts.
    pub source: Source,
}

/// Hint after an alarm that ended a motion or program, with its code if it was read.
pub fn hint_after(family: Family, code: Option<&str>) -> String {
    let first = match code {
        Some(code) => format!("use `armctl explain {family} {code}` to see what to do"),
        None => format!("use `armctl {family} alarm history` to see the alarm; remove the cause"),
    };
    format!("{first}, then use `armctl {family} alarm reset`")
}

/// Alarm, error or warning.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// An alarm (yerc, yrcx).
    Alarm,
    /// An error (toyo).
    Error,
    /// A warning (yrcx).
    Warning,
}

/// Source of the texts of an alarm.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Source {
    /// Controller.
    #[default]
    Controller,
    /// Operator: `alarms.toml`.
    Site,
    /// This program.
    Armctl,
}

impl Alarm {
    /// Adds the texts of `alarms.toml`, which have priority.
    #[must_use]
    pub fn with(self, site: Option<Explanation>) -> Self {
        let Some(Explanation { text, cause, remedy }) = site else { return self };
        let text = match self.text {
            Some(own) if own != text => format!("{text} ({own})"),
            _ => text,
        };
        let [cause, remedy] = [cause.or(self.cause), remedy.or(self.remedy)];
        Self { text: Some(text), cause, remedy, source: Source::Site, ..self }
    }

    /// Code and text in one line.
    pub fn line(&self) -> String {
        let parts = [&self.code, &self.text].into_iter().flatten().map(String::as_str);
        parts.collect::<Vec<_>>().join(": ")
    }
}

/// Family-specific data of an alarm.
pub trait ExtraColumns {
    /// Columns and values; `None` if there is no value.
    fn cells(&self) -> Vec<(&'static str, Option<String>)>;
}

/// Family-specific data as text, for reports of all families.
#[derive(Debug, Clone, Default, Serialize, JsonSchema)]
pub struct InWords {
    /// A sub-code, an axis, a source.
    data: Option<String>,
}

impl ExtraColumns for InWords {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        vec![("data", self.data.clone())]
    }
}

/// Family-specific data of the whole list.
pub trait AlarmState {
    /// Text for an empty list.
    fn none(&self) -> &'static str {
        "no alarm"
    }
}

/// No data of the whole list.
#[derive(Debug, Clone, Copy, Default, Serialize, JsonSchema)]
pub struct Nothing {}

impl AlarmState for Nothing {}

/// Present or past alarms: report of `alarm list` and `alarm history`.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Alarms<T, S = Nothing> {
    /// Latest first.
    pub alarms: Vec<Row<T>>,
    /// Data of the whole list.
    #[serde(flatten)]
    pub standing: S,
    /// Number of requested entries.
    #[serde(skip)]
    pub asked: usize,
}

/// An entry of a list.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Row<T> {
    /// List of the history, if a controller has several: `major`, `monitor`, `system`, `user`, `offline` (yerc).
    pub list: Option<&'static str>,
    /// Number of the entry. The latest entry has number 1.
    pub index: u16,
    /// Alarm, or the reason why it could not be read.
    #[serde(flatten)]
    pub outcome: ItemOutcome<AlarmEntry<T>>,
}

/// An alarm with family-specific data.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct AlarmEntry<T> {
    /// Alarm.
    #[serde(flatten)]
    pub alarm: Alarm,
    /// Family-specific data.
    #[serde(flatten)]
    pub own: T,
}

impl<T> Row<T> {
    /// Entry at an index of a list; `asked` is its name in errors.
    pub fn new(index: u16, asked: impl Into<String>, outcome: Result<AlarmEntry<T>>) -> Self {
        Self { list: None, index, outcome: ItemOutcome::new(asked, outcome) }
    }
}

impl<T: ExtraColumns, S> CommonReport for Alarms<T, S> {
    type Core = AllAlarms;

    fn core(&self) -> AllAlarms {
        let own = |own: &T| {
            let data: Vec<String> = own.cells().into_iter().filter_map(|(_, told)| told).collect();
            InWords { data: Some(data.join(", ")).filter(|data| !data.is_empty()) }
        };
        let entry = |entry: &AlarmEntry<T>| AlarmEntry { alarm: entry.alarm.clone(), own: own(&entry.own) };
        let row = |row: &Row<T>| Row { list: row.list, index: row.index, outcome: row.outcome.map(entry) };
        AllAlarms { alarms: self.alarms.iter().map(row).collect() }
    }
}

/// Alarms of a robot of any family.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct AllAlarms {
    /// Latest first.
    alarms: Vec<Row<InWords>>,
}

impl AllAlarms {
    /// Report of active alarms.
    pub fn present(alarms: Vec<Alarm>) -> Self {
        let row = |(index, alarm)| Row::new(index, "alarm", Ok(AlarmEntry { alarm, own: InWords::default() }));
        Self { alarms: (1..).zip(alarms).map(row).collect() }
    }

    /// View in the form of a family.
    pub fn for_robot(&self) -> View {
        shown(&self.alarms, "no alarm")
    }
}

impl Report for AllAlarms {
    /// Table for several robots.
    fn view(&self) -> View {
        let mut table = Table::new(&["list", "#", "code", "alarm", "data", "time"], "no alarm");
        for row in &self.alarms {
            table.rows.push(cells(row, table.columns.len()));
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.alarms.len(), self.alarms.iter().filter_map(|row| row.outcome.error()))
    }
}

impl<T, S> Alarms<T, S> {
    /// Errors of entries that could not be read.
    pub fn errors(&self) -> impl Iterator<Item = &ItemError> {
        self.alarms.iter().filter_map(|row| row.outcome.error())
    }

    /// Entries that could be read.
    pub fn known_alarms(&self) -> impl Iterator<Item = (&Row<T>, &AlarmEntry<T>)> {
        self.alarms.iter().filter_map(|row| Some((row, row.outcome.data()?)))
    }
}

impl<T: ExtraColumns> AlarmEntry<T> {
    /// Row of a table with all columns.
    fn cells(&self, list: Option<&'static str>, index: u16) -> Vec<Cell> {
        let Alarm { code, text, time, .. } = &self.alarm;
        let code = Cell::optional(code.as_deref().map(|code| Cell::from(code).tone(Tone::Bad)));
        let first = [Cell::optional(list), index.into(), code, Cell::optional(text.as_deref())];
        let own = self.own.cells().into_iter().map(|(_, told)| Cell::optional(told));
        first.into_iter().chain(own).chain([Cell::optional(time.as_deref()).whole()]).collect()
    }

    fn fields(&self, list: Option<&'static str>) -> Vec<(&'static str, Cell)> {
        let Alarm { time, cause, remedy, .. } = &self.alarm;
        let list = list.map(|list| ("list", Cell::from(list)));
        let own = self.own.cells().into_iter().filter_map(|(name, told)| Some((name, told?.into())));
        let known = [("time", time), ("cause", cause), ("what to do", remedy)];
        let known = known.into_iter().filter_map(|(name, told)| Some((name, told.as_deref()?.into())));
        let first = ("alarm", Cell::from(self.alarm.line()).tone(Tone::Bad));
        list.into_iter().chain([first]).chain(own).chain(known).collect()
    }
}

impl<T: ExtraColumns + Serialize + JsonSchema, S: AlarmState + Serialize + JsonSchema> Report for Alarms<T, S> {
    fn view(&self) -> View {
        shown(&self.alarms, self.standing.none())
    }

    fn failure(&self) -> Option<Failure> {
        verdict(self.asked, self.errors())
    }
}

/// Shows a single alarm with all fields, and several alarms as a table. `none` is the text for an empty list.
fn shown<T: ExtraColumns>(rows: &[Row<T>], none: &str) -> View {
    let known = || rows.iter().filter_map(|row| row.outcome.data());
    let entry_text: Vec<Cell> = known().filter_map(|entry| add_site_text(&entry.alarm)).map(Cell::from).collect();
    match (rows, known().next()) {
        ([], _) => View::text(none),
        ([row], Some(entry)) => View::default().append(Section::Fields(entry.fields(row.list))),
        _ if entry_text.is_empty() => View::table(table(rows)),
        _ => View::table(table(rows)).append(Section::Lines(entry_text)),
    }
}

/// Text of `alarms.toml` for an alarm, as a line below a table.
fn add_site_text(alarm: &Alarm) -> Option<String> {
    let Alarm { code, cause, remedy, source: Source::Site, .. } = alarm else { return None };
    let parts: Vec<&str> = [cause, remedy].into_iter().flatten().map(String::as_str).collect();
    (!parts.is_empty()).then(|| format!("{}: {}", code.as_deref().unwrap_or_default(), parts.join("; ")))
}

/// Table with one row per entry and only the columns that have a value.
fn table<T: ExtraColumns>(rows: &[Row<T>]) -> Table {
    let own = rows.iter().find_map(|row| Some(row.outcome.data()?.own.cells())).unwrap_or_default();
    let own = own.into_iter().map(|(name, _)| name);
    let columns: Vec<_> = ["list", "#", "code", "alarm"].into_iter().chain(own).chain(["time"]).collect();
    let rows = rows.iter().map(|row| cells(row, columns.len())).collect();
    let table = Table { columns: columns.clone(), rows, empty: "no alarm" };
    columns.into_iter().fold(table, Table::without_blank)
}

/// Row with this number of columns.
fn cells<T: ExtraColumns>(row: &Row<T>, columns: usize) -> Vec<Cell> {
    let mut cells = match (row.outcome.data(), row.outcome.error()) {
        (Some(entry), _) => entry.cells(row.list, row.index),
        (None, error) => {
            vec![Cell::optional(row.list), row.index.into(), "-".into(), Cell::optional(error.map(ItemError::cell))]
        }
    };
    cells.resize(columns, "-".into());
    cells
}

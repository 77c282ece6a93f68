//! Backup and restore for all families: options, and results of files and parts.

pub mod check;
mod compare;
pub mod dated;
mod diff;
pub mod manifest;
pub mod options;
pub mod saving;
pub mod text_diff;
mod tolerance;
pub mod words;

use std::fmt;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value, json};

use super::Report;
use super::backup::manifest::{LeftOut, MANIFEST, Saved, State};
use crate::controller::nearest::nearest;
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Table, Tone, View};
use crate::settings::inventory::fits;

/// Selection of files or parts by name patterns; empty selects all.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Only(pub Vec<String>);

impl Only {
    /// Whether a name is selected.
    pub fn has(&self, name: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|pattern| fits(pattern, name))
    }

    /// Whether an item with several names is selected.
    pub fn has_any<S: AsRef<str>>(&self, names: &[S]) -> bool {
        names.iter().any(|name| self.has(name.as_ref()))
    }

    /// Notation in the scope of a backup.
    pub fn scope(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|pattern| format!("{ONLY}{pattern}"))
    }

    /// Parses the scope of a backup.
    pub fn of_scope(scope: &[String]) -> Self {
        Self(scope.iter().filter_map(|word| word.strip_prefix(ONLY)).map(ToOwned::to_owned).collect())
    }

    /// Rejects patterns without a match, such as mistyped ones.
    pub fn check<S: AsRef<str>>(&self, names: &[S]) -> Result<(), Failure> {
        let unknown = self.0.iter().find(|pattern| !names.iter().any(|name| fits(pattern, name.as_ref())));
        let Some(pattern) = unknown else { return Ok(()) };
        let near = nearest(pattern, names.iter().map(AsRef::as_ref));
        let near = near.map_or(String::new(), |near| format!("did you mean {near}? "));
        Err(Failure::usage(format!("no name matches '{pattern}'"))
            .hint(format!("{near}use names from the backup, with * and ?, such as 'points*' or '*.JBI'")))
    }
}

/// Prefix of a pattern in the scope of a backup.
const ONLY: &str = "only ";

/// Options of a backup.
#[derive(Debug, Clone, Default)]
pub struct Making {
    /// Target folder.
    pub folder: PathBuf,
    /// Selection in the notation of the manifest: patterns as in `only points*`, and family selections such as
    /// `points 0..999`. Empty selects everything; `None` if not given.
    pub scope: Option<Vec<String>>,
    /// Continue an existing backup.
    pub resume: bool,
    /// Replace an existing backup.
    pub force: bool,
}

/// Options of a restore.
#[derive(Debug, Clone, Default)]
pub struct Restoring {
    /// Folder of the backup.
    pub folder: PathBuf,
    /// Selection.
    pub only: Only,
    /// Include data that changes the machine itself.
    pub machine: bool,
    /// Allow another model or robot.
    pub force: bool,
}

/// Result of a file or part.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Item {
    /// Name on the controller, or name of the part: `TESTJOB.JBI`, `points-1`.
    pub name: String,
    /// Bytes of the name, if the text does not convert back to them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name_hex: Option<String>,
    /// Result.
    pub state: State,
    /// File in the folder of the backup.
    pub file: Option<String>,
    /// Size of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Number of values written, if they are written one by one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written: Option<usize>,
    /// Number of equal values.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unchanged: Option<usize>,
    /// Items that are not in the file, or were not written.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// Notes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Reason for the failure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Failure>,
}

impl Item {
    /// Initial result.
    pub fn pending(name: impl fmt::Display) -> Self {
        Self {
            name: name.to_string(),
            name_hex: None,
            state: State::NotTried,
            file: None,
            bytes: None,
            written: None,
            unchanged: None,
            left_out: Vec::new(),
            notes: Vec::new(),
            error: None,
        }
    }

    /// Records a failure. Returns whether the next item can be tried: yes after a refusal of this item, no after a
    /// lost connection.
    pub fn fail(&mut self, failure: Failure) -> bool {
        let goes_on = goes_on(&failure);
        self.state = State::Failed;
        self.error = Some(failure);
        goes_on
    }

    /// Records a copy that was made now or earlier.
    pub fn saved(&mut self, state: State, copy: &Saved, left_out: &[LeftOut]) {
        self.state = state;
        self.file = Some(copy.file.clone());
        self.bytes = Some(copy.bytes);
        self.left_out = left_out.to_vec();
    }

    /// Text of the result; `done` now, or `before`.
    fn result(&self, [done, before]: [&str; 2]) -> Cell {
        let counted = |n: usize, words: &str| (n > 0).then(|| format!("{n} {words}"));
        let counts = match (self.written, self.unchanged) {
            (None, None) => None,
            (Some(0) | None, _) => Some(NO_DIFFERENCE.to_owned()),
            (written, unchanged) => {
                let parts = [counted(written.unwrap_or(0), "written"), counted(unchanged.unwrap_or(0), "unchanged")];
                Some(parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
            }
        };
        let cell = match (self.state, &self.error) {
            (State::Failed, error) => {
                let error = error.as_ref().map_or("failed", |error| error.message.as_str());
                let counts = counts.filter(|_| self.written > Some(0)).map(|counts| format!("{counts}; then "));
                Cell::from(counts.unwrap_or_default() + error).tone(Tone::Bad)
            }
            (State::NotTried, _) => {
                let counts = counts.map(|counts| format!("{counts}; the rest "));
                Cell::from(counts.unwrap_or_default() + "not tried").tone(Tone::Warning)
            }
            (State::Kept, _) => Cell::from(before),
            (State::Done, _) => Cell::from(counts.unwrap_or_else(|| done.to_owned())).tone(Tone::Good),
        };
        let notes = self.notes.iter().fold(String::new(), |text, note| text + ", " + note);
        let keys: Vec<&str> = self.left_out.iter().map(|left| left.key.as_str()).collect();
        let without = match &keys[..] {
            [] => String::new(),
            [first, .., last] if keys.len() > MOST_KEYS => {
                format!("; without {} values, {first} to {last}", keys.len())
            }
            few => format!("; without {}", few.join(", ")),
        };
        Cell { text: cell.text + &notes + &without, ..cell }
    }
}

/// Text if nothing had to be written.
const NO_DIFFERENCE: &str = "nothing differed";
/// Maximum number of left-out items in a table.
const MOST_KEYS: usize = 6;

/// Whether the next file or part can be tried after a failure.
pub fn goes_on(failure: &Failure) -> bool {
    matches!(failure.kind, Kind::Refused | Kind::Malformed | Kind::Usage | Kind::Rejected)
}

/// Severity of a failure kind: first that an action may have been executed, then that the work ended early.
pub fn gravity(kind: Kind) -> u8 {
    match kind {
        Kind::OutcomeUnknown => 4,
        Kind::NoAnswer | Kind::Local | Kind::Interrupted => 3,
        Kind::Malformed => 2,
        Kind::Refused => 1,
        _ => 0,
    }
}

/// Note in a dry run for a file or part that would be written, with its size in `bytes` or `values`.
pub fn would_write(item: impl fmt::Display, (unit, count): (&str, u64), depends_on: &str) -> Value {
    json!({ "item": item.to_string(), "action": "write", unit: count, "depends_on": depends_on })
}

/// Note in a dry run for a file or part that is not written.
pub fn would_leave(item: impl fmt::Display, why: &str) -> Value {
    json!({ "item": item.to_string(), "action": "leave", "why": why })
}

/// Reason for an item that is not selected.
pub const NOT_CHOSEN: &str = "not selected";
/// Reason for an item that changes the machine itself.
pub const NOT_MACHINE: &str = "changes the machine itself; written only with --machine";

/// Results of files or parts, in the order of processing.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Items {
    /// Results.
    pub files: Vec<Item>,
    /// Number of completed items, including earlier ones.
    done: usize,
    /// Number of failed items.
    failed: usize,
    /// Number of items that were not tried.
    not_tried: usize,
}

impl Items {
    /// Counts the results.
    pub fn new(files: Vec<Item>) -> Self {
        let count = |states: &[State]| files.iter().filter(|item| states.contains(&item.state)).count();
        let (done, failed) = (count(&[State::Done, State::Kept]), count(&[State::Failed]));
        let not_tried = count(&[State::NotTried]);
        Self { files, done, failed, not_tried }
    }

    /// Whether all items are complete.
    pub fn is_complete(&self) -> bool {
        self.failed + self.not_tried == 0
    }

    /// One row per item; `words` are the texts for done now and done earlier.
    pub fn view(&self, words: [&str; 2]) -> View {
        let mut table = Table::new(&["name", "result"], "nothing");
        for item in &self.files {
            table.row([item.name.as_str().into(), item.result(words)]);
        }
        View::table(table)
    }

    /// Most severe failure (the first of equal severity), with the number of failures.
    fn gravest(&self) -> Option<Failure> {
        let failures = self.files.iter().filter_map(|item| Some((&item.name, item.error.as_ref()?)));
        let (name, gravest) = failures.rev().max_by_key(|(_, failure)| gravity(failure.kind))?;
        let total = self.files.len();
        let failed = match self.not_tried {
            0 => format!("{} of {total} failed", self.failed),
            left => format!("{} of {total} failed, {left} not tried", self.failed),
        };
        // Some items succeeded and some failed.
        let kind = if self.done > 0 { Kind::Mixed } else { gravest.kind };
        Some(Failure { kind, message: format!("{failed}: {name}: {}", gravest.message), ..gravest.clone() })
    }

    /// Most severe failure, with the way to continue.
    pub fn failure(&self, again: &str) -> Option<Failure> {
        Some(with_hint(self.gravest()?, again))
    }
}

/// Adds the way to continue to the hint of a failure.
pub fn with_hint(failure: Failure, again: &str) -> Failure {
    let hint = failure.hint.as_ref().map_or(again.to_owned(), |hint| format!("{hint}\n{again}"));
    failure.hint(hint)
}

/// Content of a folder after a backup.
#[derive(Debug, Serialize, JsonSchema)]
pub struct BackedUp {
    /// Folder.
    pub folder: String,
    /// Manifest.
    pub manifest: String,
    /// Whether all selected data is present.
    pub complete: bool,
    /// Selection, if not everything.
    pub scope: Vec<String>,
    /// Results of files or parts.
    #[serde(flatten)]
    pub items: Items,
}

impl BackedUp {
    /// Result for a folder.
    pub fn new(folder: &Path, scope: Vec<String>, complete: bool, items: Items) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        Self { folder: folder.display().to_string(), manifest, complete, scope, items }
    }

    /// Most severe failure of a file or part.
    pub fn gravest(&self) -> Option<Failure> {
        self.items.gravest()
    }
}

impl Report for BackedUp {
    fn view(&self) -> View {
        self.items.view(["saved", "kept"])
    }

    fn failure(&self) -> Option<Failure> {
        self.items.failure("read the missing parts with --resume")
    }
}

/// Result of a restore.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    /// Folder of the backup.
    folder: String,
    #[serde(flatten)]
    items: Items,
    /// Machine parameters were changed and nothing else was written: first switch the controller's power off and on
    /// (toyo).
    pub needs_power_cycle: bool,
}

impl Restored {
    /// Result for a folder.
    pub fn new(folder: &Path, items: Items) -> Self {
        Self { folder: folder.display().to_string(), items, needs_power_cycle: false }
    }
}

/// Next step after machine parameters were written.
pub const POWER_CYCLE: &str = "machine parameters were changed: switch the controller's power off and on, then restore \
                               again without --machine";

impl Report for Restored {
    fn view(&self) -> View {
        self.items.view(["written", NO_DIFFERENCE])
    }

    fn failure(&self) -> Option<Failure> {
        let not_done = self.needs_power_cycle.then(|| Failure::new(Kind::ConditionNotMet, POWER_CYCLE));
        self.items.failure("run the same command again to continue; equal values are not written again").or(not_done)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::render;

    fn items() -> Items {
        let mut files: Vec<Item> = ["a", "b", "c", "d"].map(Item::pending).into();
        files[0].saved(State::Done, &Saved { file: "a.csv".into(), bytes: 3, sha256: String::new() }, &[]);
        files[1].written = Some(2);
        assert!(files[1].fail(Failure::new(Kind::Refused, "no")));
        assert!(!files[2].fail(Failure::new(Kind::NoAnswer, "silence").hint("cable")));
        Items::new(files)
    }

    #[test]
    fn the_gravest_failure_decides() {
        let report = BackedUp::new("here".as_ref(), Vec::new(), false, items());
        let failure = report.failure().unwrap();
        assert_eq!(failure.kind, Kind::Mixed, "one was saved");
        assert_eq!(failure.message, "2 of 4 failed, 1 not tried: c: silence");
        assert_eq!(failure.hint.as_deref(), Some("cable\nread the missing parts with --resume"));
        let text = render::text(&report.view(), 80, false);
        assert_eq!(text, "NAME  RESULT\na     saved\nb     2 written; then no\nc     silence\nd     not tried\n");
    }

    #[test]
    fn what_was_left_out_is_told_as_far_as_it_fits() {
        let mut item = Item { state: State::Done, written: Some(0), unchanged: Some(9), ..Item::pending("p") };
        let left_out = |key: usize| LeftOut { key: key.to_string(), why: String::new() };
        item.left_out = (1..3).map(left_out).collect();
        assert_eq!(item.result(["", ""]).text, "nothing differed; without 1, 2");
        item.left_out = (1..30).map(left_out).collect();
        assert_eq!(item.result(["", ""]).text, "nothing differed; without 29 values, 1 to 29");
    }

    #[test]
    fn patterns_choose_by_name() {
        let only = Only(vec!["points*".into(), "A?.JBI".into()]);
        assert!(only.has("points-00000") && only.has("AB.JBI") && !only.has("ABC.JBI"));
        assert!(Only::default().has("anything"));
        let names = ["points-1", "easy"];
        assert!(Only(vec!["easy".into()]).check(&names).is_ok());
        assert_eq!(Only(vec!["esay".into()]).check(&names).unwrap_err().kind, Kind::Usage);
    }
}

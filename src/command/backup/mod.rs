//! Backups as all families make and restore them: what is asked for, and what became of each file or part.

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

/// Which files or parts, by patterns of their names; without any, all.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Only(pub Vec<String>);

impl Only {
    /// Whether a name is meant.
    pub fn has(&self, name: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|pattern| fits(pattern, name))
    }

    /// Whether a thing with several names is meant.
    pub fn has_any<S: AsRef<str>>(&self, names: &[S]) -> bool {
        names.iter().any(|name| self.has(name.as_ref()))
    }

    /// As it stands in the scope of a backup.
    pub fn scope(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|pattern| format!("{ONLY}{pattern}"))
    }

    /// As it was put into the scope of a backup.
    pub fn of_scope(scope: &[String]) -> Self {
        Self(scope.iter().filter_map(|word| word.strip_prefix(ONLY)).map(ToOwned::to_owned).collect())
    }

    /// Refuses patterns that fit nothing, as mistyped ones do.
    pub fn check<S: AsRef<str>>(&self, names: &[S]) -> Result<(), Failure> {
        let unknown = self.0.iter().find(|pattern| !names.iter().any(|name| fits(pattern, name.as_ref())));
        let Some(pattern) = unknown else { return Ok(()) };
        let near = nearest(pattern, names.iter().map(AsRef::as_ref));
        let near = near.map_or(String::new(), |near| format!("did you mean {near}? "));
        Err(Failure::usage(format!("nothing is called '{pattern}'")).hint(format!(
            "{near}--only takes names as the backup lists them, with * and ?, such as 'points*' or '*.JBI'"
        )))
    }
}

/// Before a pattern, in the scope of a backup.
const ONLY: &str = "only ";

/// What is asked for of a backup that is made.
#[derive(Debug, Clone, Default)]
pub struct Making {
    /// Where it goes.
    pub folder: PathBuf,
    /// What goes into it, in the words of its list: patterns as in `only points*`, and what a family has beside, such as
    /// `points 0..999`. Nothing is everything; `None` if nobody says.
    pub scope: Option<Vec<String>>,
    /// Go on with the one that is there.
    pub resume: bool,
    /// Replace the one that is there.
    pub force: bool,
}

/// What is asked for of a backup that is restored.
#[derive(Debug, Clone, Default)]
pub struct Restoring {
    /// Where it is.
    pub folder: PathBuf,
    /// What of it.
    pub only: Only,
    /// What makes the controller another machine as well.
    pub machine: bool,
    /// To another model or robot than it is of.
    pub force: bool,
}

/// Result of a file or part.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Item {
    /// Its name on the controller, or the name of the part: `TESTJOB.JBI`, `points-1`.
    pub name: String,
    /// The name in bytes, where the text does not lead back to them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name_hex: Option<String>,
    /// What was done.
    pub state: State,
    /// Its file in the folder of the backup.
    pub file: Option<String>,
    /// Size of the file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Values written, where they are written one by one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub written: Option<usize>,
    /// Values that were the same already.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unchanged: Option<usize>,
    /// What is not in the file, or was not written.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// What there is to say beside.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Why it failed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Failure>,
}

impl Item {
    /// Before it is tried.
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

    /// It failed. Says whether the next one can be tried: after a "no" to this one it can, on a broken line it cannot.
    pub fn fail(&mut self, failure: Failure) -> bool {
        let goes_on = goes_on(&failure);
        self.state = State::Failed;
        self.error = Some(failure);
        goes_on
    }

    /// The copy is there, by `state` now or before.
    pub fn saved(&mut self, state: State, copy: &Saved, left_out: &[LeftOut]) {
        self.state = state;
        self.file = Some(copy.file.clone());
        self.bytes = Some(copy.bytes);
        self.left_out = left_out.to_vec();
    }

    /// In words; `done` now, or before.
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

/// Said where nothing had to be written.
const NO_DIFFERENCE: &str = "nothing differed";
/// Longer lists of what was left out do not fit a table.
const MOST_KEYS: usize = 6;

/// Whether the next file or part can be tried after a failure.
pub fn goes_on(failure: &Failure) -> bool {
    matches!(failure.kind, Kind::Refused | Kind::Malformed | Kind::Usage | Kind::Rejected)
}

/// What a person must know first: that something may have been done, then that the work ended early.
pub fn gravity(kind: Kind) -> u8 {
    match kind {
        Kind::OutcomeUnknown => 4,
        Kind::NoAnswer | Kind::Local | Kind::Interrupted => 3,
        Kind::Malformed => 2,
        Kind::Refused => 1,
        _ => 0,
    }
}

/// What a dry run says of a file or a part that would be written: how much it is, as `bytes` or `values`.
pub fn would_write(item: impl fmt::Display, (unit, count): (&str, u64), depends_on: &str) -> Value {
    json!({ "item": item.to_string(), "action": "write", unit: count, "depends_on": depends_on })
}

/// What a dry run says of a file or a part of the backup that is not written.
pub fn would_leave(item: impl fmt::Display, why: &str) -> Value {
    json!({ "item": item.to_string(), "action": "leave", "why": why })
}

/// Why a dry run leaves what is not among the chosen ones.
pub const NOT_CHOSEN: &str = "not chosen";
/// Why it leaves what makes another machine of it.
pub const NOT_MACHINE: &str = "makes it another machine: written with --machine only";

/// Result of each file or part, in the order of working.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Items {
    /// Each of them.
    pub files: Vec<Item>,
    /// How many are done, now or before.
    done: usize,
    /// How many failed.
    failed: usize,
    /// How many were not tried.
    not_tried: usize,
}

impl Items {
    /// Counts.
    pub fn new(files: Vec<Item>) -> Self {
        let count = |states: &[State]| files.iter().filter(|item| states.contains(&item.state)).count();
        let (done, failed) = (count(&[State::Done, State::Kept]), count(&[State::Failed]));
        let not_tried = count(&[State::NotTried]);
        Self { files, done, failed, not_tried }
    }

    /// Whether every one is done.
    pub fn is_complete(&self) -> bool {
        self.failed + self.not_tried == 0
    }

    /// A row each; `words` say that it was done, now or before.
    pub fn view(&self, words: [&str; 2]) -> View {
        let mut table = Table::new(&["name", "result"], "nothing");
        for item in &self.files {
            table.row([item.name.as_str().into(), item.result(words)]);
        }
        View::table(table)
    }

    /// The gravest failure, and how many there are; of equally grave ones, the first.
    fn gravest(&self) -> Option<Failure> {
        let failures = self.files.iter().filter_map(|item| Some((&item.name, item.error.as_ref()?)));
        let (name, gravest) = failures.rev().max_by_key(|(_, failure)| gravity(failure.kind))?;
        let total = self.files.len();
        let failed = match self.not_tried {
            0 => format!("{} of {total} failed", self.failed),
            left => format!("{} of {total} failed, {left} not tried", self.failed),
        };
        // Some done, some not.
        let kind = if self.done > 0 { Kind::Mixed } else { gravest.kind };
        Some(Failure { kind, message: format!("{failed}: {name}: {}", gravest.message), ..gravest.clone() })
    }

    /// The same with how it goes on.
    pub fn failure(&self, again: &str) -> Option<Failure> {
        Some(with_hint(self.gravest()?, again))
    }
}

/// A failure with how the work goes on, below what it hints at already.
pub fn with_hint(failure: Failure, again: &str) -> Failure {
    let hint = failure.hint.as_ref().map_or(again.to_owned(), |hint| format!("{hint}\n{again}"));
    failure.hint(hint)
}

/// What is in a folder after a backup.
#[derive(Debug, Serialize, JsonSchema)]
pub struct BackedUp {
    /// The folder.
    pub folder: String,
    /// The list of what is in it.
    pub manifest: String,
    /// Whether nothing is missing of what was asked for.
    pub complete: bool,
    /// What was asked for, where that is not everything.
    pub scope: Vec<String>,
    /// Each file or part.
    #[serde(flatten)]
    pub items: Items,
}

impl BackedUp {
    /// Of a folder.
    pub fn new(folder: &Path, scope: Vec<String>, complete: bool, items: Items) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        Self { folder: folder.display().to_string(), manifest, complete, scope, items }
    }

    /// The gravest failure of a file or part.
    pub fn gravest(&self) -> Option<Failure> {
        self.items.gravest()
    }
}

impl Report for BackedUp {
    fn view(&self) -> View {
        self.items.view(["saved", "kept"])
    }

    fn failure(&self) -> Option<Failure> {
        self.items.failure("--resume reads what is missing")
    }
}

/// What is on a controller after a restore.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Restored {
    /// The folder of the backup.
    folder: String,
    #[serde(flatten)]
    items: Items,
    /// Machine parameters were changed, and nothing else was written: the controller's power must be switched off and on
    /// first (toyo).
    pub needs_power_cycle: bool,
}

impl Restored {
    /// Of a folder.
    pub fn new(folder: &Path, items: Items) -> Self {
        Self { folder: folder.display().to_string(), items, needs_power_cycle: false }
    }
}

/// What to do after machine parameters were written.
pub const POWER_CYCLE: &str = "machine parameters were changed: switch the controller's power off and on, then restore \
                               again without --machine";

impl Report for Restored {
    fn view(&self) -> View {
        self.items.view(["written", NO_DIFFERENCE])
    }

    fn failure(&self) -> Option<Failure> {
        let not_done = self.needs_power_cycle.then(|| Failure::new(Kind::ConditionNotMet, POWER_CYCLE));
        self.items.failure("the same command goes on: what is the same already is not written again").or(not_done)
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
        assert_eq!(failure.hint.as_deref(), Some("cable\n--resume reads what is missing"));
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

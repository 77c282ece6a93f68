//! Backup and restore for all families: options, and results of files and parts.

pub mod arguments;
pub mod check;
pub mod compare;
mod diff;
pub mod family_backup;
pub mod job_date;
pub mod manifest;
pub mod parts;
pub mod recording;
pub mod save;
pub mod text_diff;
pub mod tolerance;
pub mod twin;

use super::backup::manifest::MANIFEST;
use super::robot::file::{FILES, FileItem, Files, NO_DIFFERENCE};
use crate::items::ItemError;
use crate::prelude::basics::*;
use crate::settings::inventory::matches_pattern;

/// Selection of files or parts by name patterns; an empty list selects all.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Only(pub Vec<String>);

impl Only {
    /// Whether a name is selected.
    pub fn has(&self, name: &str) -> bool {
        self.0.is_empty() || self.0.iter().any(|pattern| matches_pattern(pattern, name))
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

    /// Rejects patterns without a match, such as mistyped patterns.
    pub fn check<S: AsRef<str>>(&self, names: &[S]) -> Result<()> {
        let unknown = self.0.iter().find(|pattern| !names.iter().any(|name| matches_pattern(pattern, name.as_ref())));
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
pub struct SaveOptions {
    /// Target folder.
    pub folder: PathBuf,
    /// Selection in the notation of the manifest: patterns as in `only points*`, and family selections such as `points
    /// 0..999`. An empty selection selects everything. `None` means that the user gave no selection.
    pub scope: Option<Vec<String>>,
    /// Continue an existing backup.
    pub resume: bool,
    /// Replace an existing backup.
    pub force: bool,
}

/// Options of a restore.
#[derive(Debug, Clone, Default)]
pub struct RestoreSelection {
    /// Folder of the backup.
    pub folder: PathBuf,
    /// Selection.
    pub only: Only,
    /// Include data that changes the machine itself.
    pub machine: bool,
    /// Allow another model or robot.
    pub force: bool,
}

/// Whether the next file or part can be tried after a failure.
pub fn continues_after(failure: &Failure) -> bool {
    matches!(failure.kind, Kind::Refused | Kind::Malformed | Kind::Usage | Kind::Rejected)
}

/// Severity of a failure kind. The highest is an unknown outcome; next are failures that ended the work early.
pub fn severity(kind: Kind) -> u8 {
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
pub const NOT_MACHINE: &str = "changes the machine itself; armctl writes such data only with --machine";

/// Adds the way to continue the work to the hint of a failure.
pub fn add_hint(failure: Failure, again: &str) -> Failure {
    let hint = failure.hint.as_ref().map_or(again.to_owned(), |hint| format!("{hint}\n{again}"));
    failure.hint(hint)
}

/// Content of a folder after a backup.
#[derive(Debug, Serialize, JsonSchema)]
pub struct BackupReport {
    /// Folder.
    pub folder: String,
    /// Manifest.
    pub manifest: String,
    /// Whether all selected data is present.
    pub complete: bool,
    /// Selection, if not everything.
    pub scope: Vec<String>,
    #[serde(flatten)]
    files: Files,
}

impl BackupReport {
    /// Result for a folder.
    pub fn new(folder: &Path, scope: Vec<String>, complete: bool, files: Vec<FileItem>) -> Self {
        let manifest = folder.join(MANIFEST).display().to_string();
        let files = Files::new(files, |files| FileItem::results(files, ["saved", "kept"]));
        Self { folder: folder.display().to_string(), manifest, complete, scope, files }
    }

    /// Most severe failure of a file, unless the controller refused it.
    pub fn unread(&self) -> Option<Failure> {
        self.files.most_severe().filter(|failure| failure.kind != Kind::Refused)
    }
}

impl Report for BackupReport {
    fn view(&self) -> View {
        self.files.view()
    }

    fn failure(&self) -> Option<Failure> {
        Some(add_hint(self.files.failure()?, "use --resume to read the missing parts"))
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

/// Result of a restore.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RestoreReport {
    /// Folder of the backup.
    folder: String,
    #[serde(flatten)]
    files: Files,
    /// Whether the controller's power must be switched off and on first. This is the case if machine parameters were
    /// changed, so that nothing else was written yet (toyo).
    pub needs_power_cycle: bool,
}

impl RestoreReport {
    /// Result for a folder.
    pub fn new(folder: &Path, files: Vec<FileItem>) -> Self {
        let files = Files::new(files, |files| FileItem::results(files, ["written", NO_DIFFERENCE]));
        Self { folder: folder.display().to_string(), files, needs_power_cycle: false }
    }

    /// Whether Ctrl-C ended the restore.
    pub fn is_interrupted(&self) -> bool {
        let errors = self.files.files.iter().filter_map(|file| file.error.as_ref());
        errors.map(ItemError::failure).any(|failure| failure.kind == Kind::Interrupted)
    }
}

/// Next step after machine parameters were written.
const POWER_CYCLE: &str = "machine parameters were changed: switch the controller's power off and on, then restore \
                           again without --machine";

impl Report for RestoreReport {
    fn view(&self) -> View {
        self.files.view()
    }

    fn failure(&self) -> Option<Failure> {
        match self.files.failure() {
            None => self.needs_power_cycle.then(|| Failure::new(Kind::ConditionNotMet, POWER_CYCLE)),
            Some(failure) => Some(add_hint(failure, RETRY_HINT)),
        }
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

/// Way to continue a restore.
pub const RETRY_HINT: &str = "run the same command again to continue; armctl does not write equal values again";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failure_hints_at_the_next_step() {
        let mut part = FileItem::pending("a");
        part.fail(Failure::new(Kind::NoAnswer, "silence").hint("cable"));
        let hint = |report: &dyn Fn(Vec<FileItem>) -> Option<Failure>| report(vec![part.clone()]).unwrap().hint;
        let backed_up = |files| BackupReport::new("here".as_ref(), Vec::new(), false, files).failure();
        assert_eq!(hint(&backed_up).as_deref(), Some("cable\nuse --resume to read the missing parts"));
        let restored = |files| RestoreReport::new("here".as_ref(), files).failure();
        assert_eq!(hint(&restored).as_deref(), Some(format!("cable\n{RETRY_HINT}").as_str()));
    }

    #[test]
    fn patterns_select_by_name() {
        let only = Only(vec!["points*".into(), "A?.JBI".into()]);
        assert!(only.has("points-00000") && only.has("AB.JBI") && !only.has("ABC.JBI"));
        assert!(Only::default().has("anything"));
        let names = ["points-1", "easy"];
        assert!(Only(vec!["easy".into()]).check(&names).is_ok());
        assert_eq!(Only(vec!["esay".into()]).check(&names).unwrap_err().kind, Kind::Usage);
    }
}

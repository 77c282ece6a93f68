//! Comparison of two backups of a family, file by file.

use std::io::Read as _;

use super::job_date::{DATE_LINE, align_files};
use super::tolerance::Tolerance;
use crate::backup::manifest::{Entry, Manifest, Saved};
use crate::backup::text_diff::{Change, Hunk, MAX_TEXT, TextDifference, unified};
use crate::backup::{Only, severity};
use crate::items::ItemError;
use crate::output::escape;
use crate::prelude::basics::*;
use crate::robot::file::{FILES, FileItem};
use armctl_controller::text::Encoding;

/// One side of a comparison.
#[derive(Debug)]
pub struct BackupSide {
    /// Folder.
    pub folder: PathBuf,
    /// Manifest.
    pub manifest: Manifest,
    /// Whether this side was read from a controller for this comparison.
    pub is_controller: bool,
}

/// What counts as a difference.
#[derive(Debug, Clone, Copy)]
pub struct CompareOptions {
    tolerance: Tolerance,
    /// Whether every byte counts, including the dates of jobs.
    exact: bool,
}

impl CompareOptions {
    /// Every byte counts.
    pub const EXACT: Self = Self { tolerance: Tolerance::NONE, exact: true };

    /// Ignores positions within the default tolerance and lines that controllers rewrite.
    pub fn usual_tolerance() -> Self {
        Self::usual(Tolerance::of(&[]))
    }

    /// Ignores positions within the tolerance and lines that controllers rewrite.
    pub const fn usual(tolerance: Tolerance) -> Self {
        Self { tolerance, exact: false }
    }
}

/// Differences between two backups, or a backup and a controller.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Differences {
    old: SideReport,
    new: SideReport,
    /// Whether nothing differs, apart from the tolerance and ignored lines.
    equal: bool,
    tolerance: Tolerance,
    /// Files and parts. The entry `controller` compares the model and the versions in the two manifests.
    files: Vec<Difference>,
}

/// One side in the report.
#[derive(Debug, Serialize, JsonSchema)]
struct SideReport {
    /// Folder of the backup; null for the controller.
    folder: Option<String>,
    robot: String,
    /// Time when the backup started, or when the controller was read.
    taken_at: String,
}

/// Fields of a file that was compared.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Compared {
    /// Result.
    pub state: State,
    /// Different lines that are ignored: the line `///DATE` of a job, which a controller rewrites. With --exact, no
    /// line is ignored.
    pub ignored: Vec<&'static str>,
    /// Changes from the old file to the new file; null if one of them is not text, is too large or is missing.
    pub hunks: Option<Vec<Hunk>>,
    /// Whether only line endings differ; null if a file is not text or too large.
    pub only_line_endings: Option<bool>,
    /// Name of the file in the folder, for headings.
    #[serde(skip)]
    file: String,
}

/// A file that was compared.
pub type Difference = FileItem<Compared>;

/// Result of comparing two files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Equal in all bytes.
    Same,
    /// Equal except for the line `///DATE`.
    SameButDate,
    /// Equal except for positions within the tolerance.
    WithinTolerance,
    /// Different.
    Changed,
    /// Only in the old backup.
    OnlyOld,
    /// Only in the new backup.
    OnlyNew,
    /// Unknown: one of the files was not saved, or was changed since the backup.
    Unknown,
}

/// Content type of a job entry, which has a header.
const JOB: &str = "jbi";
/// Name of the entry for the controller data of a manifest.
const CONTROLLER: &str = "controller";

impl Differences {
    /// Compares two sides.
    pub fn of(old: &BackupSide, new: &BackupSide, only: &Only, manner: CompareOptions) -> Result<Self> {
        let (a, b) = (&old.manifest, &new.manifest);
        if a.family != b.family {
            return Err(Failure::usage(format!(
                "one backup is from a {} controller, the other from {}",
                a.family, b.family
            ))
            .hint("compare backups of the same family"));
        }
        let both = a.files.iter().chain(&b.files).map(|entry| entry.name.as_str());
        only.check(&both.chain([CONTROLLER]).collect::<Vec<_>>())?;
        let mut files: Vec<Difference> = Vec::new();
        if only.has(CONTROLLER) {
            files.extend(compare_controllers(a, b)?);
        }
        let partner = |entry: &Entry, of: &Manifest| of.files.iter().find(|other| key(other) == key(entry)).cloned();
        for entry in a.files.iter().filter(|entry| only.has(&entry.name)) {
            files.push(compare_files(old, new, Some(entry), partner(entry, b).as_ref(), manner));
        }
        for entry in b.files.iter().filter(|entry| only.has(&entry.name) && partner(entry, a).is_none()) {
            files.push(compare_files(old, new, None, Some(entry), manner));
        }
        let equal = files.iter().all(|file| file.more.state.is_equal());
        Ok(Self { old: SideReport::new(old), new: SideReport::new(new), equal, tolerance: manner.tolerance, files })
    }

    /// Files and parts that differ.
    pub fn changed(self) -> Vec<Difference> {
        self.files.into_iter().filter(|file| !file.more.state.is_equal()).collect()
    }

    fn count(&self, states: &[State]) -> usize {
        self.files.iter().filter(|file| states.contains(&file.more.state)).count()
    }

    fn summary(&self) -> String {
        let named = [
            (self.count(&[State::Changed, State::OnlyOld, State::OnlyNew]), "different"),
            (self.count(&[State::Unknown]), "not compared"),
            (self.count(&[State::SameButDate]), "the same except ///DATE"),
            (self.count(&[State::WithinTolerance]), "the same within the tolerance"),
            (self.count(&[State::Same]), "the same"),
        ];
        let parts = named.iter().filter(|(count, _)| *count > 0).map(|(count, words)| format!("{count} {words}"));
        let parts: Vec<String> = parts.collect();
        let files = if self.files.len() == 1 { "file" } else { "files" };
        format!("{} and {}: {} {files}, {}", self.old, self.new, self.files.len(), parts.join(", "))
    }
}

impl fmt::Display for SideReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.folder {
            Some(folder) => f.write_str(folder),
            None => write!(f, "the controller of {}", self.robot),
        }
    }
}

impl SideReport {
    fn new(side: &BackupSide) -> Self {
        let BackupSide { folder, manifest, is_controller } = side;
        let folder = (!is_controller).then(|| folder.display().to_string());
        Self { folder, robot: manifest.robot.clone(), taken_at: manifest.taken_at.to_string() }
    }

    /// Heading of a file in the diff with the other side.
    fn of(&self, file: &str, other: &Self) -> String {
        match (&self.folder, &other.folder) {
            (Some(folder), _) => Path::new(folder).join(file).display().to_string(),
            (None, Some(_)) => format!("{file} (controller)"),
            (None, None) => format!("{file} ({})", self.robot),
        }
    }
}

/// Key of an entry.
fn key(entry: &Entry) -> String {
    entry.name_hex.as_ref().map_or_else(|| entry.name.clone(), |digits| digits.to_lowercase())
}

/// Difference of the controller data, if any.
fn compare_controllers(old: &Manifest, new: &Manifest) -> Result<Option<Difference>> {
    if old.controller == new.controller {
        return Ok(None);
    }
    let text = |manifest: &Manifest| {
        let text = escape::json_pretty(&manifest.controller);
        text.map(|text| text + "\n").map_err(|error| Failure::local(format!("manifest as JSON: {error}")))
    };
    let (old, new) = (text(old)?, text(new)?);
    let found = TextDifference::of(Encoding::Utf8, old.as_bytes(), new.as_bytes());
    Ok(Some(FileItem::new(CONTROLLER, Compared::texts(found), Ok(()))))
}

/// Compares a file that one or both sides have.
fn compare_files(
    old: &BackupSide,
    new: &BackupSide,
    entry: Option<&Entry>,
    partner: Option<&Entry>,
    manner: CompareOptions,
) -> Difference {
    let name = entry.or(partner).map(|entry| entry.name.clone()).unwrap_or_default();
    // The file of the old side, or of the only side that has the file.
    let (side, saved) = if entry.is_some() { (old, entry) } else { (new, partner) };
    let described = |file: Difference| match saved.and_then(|entry| entry.copy.as_ref()) {
        Some(copy) if side.is_controller => Difference { path: None, ..file.from_copy(&side.folder, copy) },
        Some(copy) => file.from_copy(&side.folder, copy),
        None => file,
    };
    let state = match (entry, partner) {
        (Some(_), None) if is_in_scope(&new.manifest, &old.manifest, &name) => State::OnlyOld,
        (None, Some(_)) if is_in_scope(&old.manifest, &new.manifest, &name) => State::OnlyNew,
        (Some(entry), Some(partner)) => {
            return match pair_files(old, new, entry, partner, manner) {
                Ok(more) => described(FileItem::new(name, more, Ok(()))),
                Err(failure) => described(FileItem::new(name, Compared::new(State::Unknown), Err(failure))),
            };
        }
        _ => {
            let other = if entry.is_some() { new } else { old };
            let why = if other.manifest.complete { "the file was not selected" } else { "the backup is incomplete" };
            let why = format!("{} does not contain this file: {why}", SideReport::new(other));
            let failure = Failure::new(Kind::ConditionNotMet, why);
            let failure = failure.hint("complete the backup with `armctl backup --resume`");
            return described(FileItem::new(name, Compared::new(State::Unknown), Err(failure)));
        }
    };
    described(FileItem::new(name, Compared::new(state), Ok(())))
}

/// Whether a file that is missing in a backup was also missing on the controller. This is the case if the backup would
/// have included the file.
fn is_in_scope(backup: &Manifest, other: &Manifest, name: &str) -> bool {
    let is_common = |word: &String| Only::of_scope(std::slice::from_ref(word)) != Only::default();
    backup.complete
        && Only::of_scope(&backup.scope).has(name)
        && backup.scope.iter().all(|word| is_common(word) || other.scope.contains(word))
}

fn pair_files(
    old: &BackupSide,
    new: &BackupSide,
    entry: &Entry,
    partner: &Entry,
    manner: CompareOptions,
) -> Result<Compared> {
    let (ours, theirs) = (copy(old, entry)?, copy(new, partner)?);
    let file = |more: Compared| Compared { file: ours.file.clone(), ..more };
    if ours.sha256.eq_ignore_ascii_case(&theirs.sha256) {
        return Ok(file(Compared::new(State::Same)));
    }
    let most = MAX_TEXT as u64;
    if ours.bytes > most || theirs.bytes > most {
        return Ok(file(Compared::new(State::Changed)));
    }
    let (mut before, mut after) = (read(&old.folder, ours)?, read(&new.folder, theirs)?);
    let mut ignored = Vec::new();
    if !manner.exact && entry.holds == JOB {
        let dates_differ;
        ([before, after], dates_differ) = align_files(before, after);
        if dates_differ {
            ignored.push(DATE_LINE);
        }
        if before == after {
            return Ok(file(Compared { ignored, ..Compared::new(State::SameButDate) }));
        }
    }
    let encoding = old.manifest.controller.get("encoding").and_then(|name| name.as_str()?.parse().ok());
    let after = if manner.exact { after } else { manner.tolerance.align(entry, &before, &after) };
    let found = TextDifference::of(encoding.unwrap_or(Encoding::Utf8), &before, &after);
    let is_within = found.as_ref().is_some_and(|found| found.hunks.is_empty());
    let more = if is_within { Compared::new(State::WithinTolerance) } else { Compared::texts(found) };
    Ok(file(Compared { ignored, ..more }))
}

/// Copy of an entry, unless it is missing or was changed since the backup.
fn copy<'e>(side: &BackupSide, entry: &'e Entry) -> Result<&'e Saved> {
    let copy = entry.copy.as_ref().ok_or_else(|| {
        let why = entry.error.as_ref().map_or("no reason recorded", |reason| &reason.message);
        Failure::new(Kind::ConditionNotMet, format!("{} does not contain this file: {why}", SideReport::new(side)))
            .hint("see manifest.json: the backup does not contain data that the controller refused")
    })?;
    copy.check(&side.folder)?;
    Ok(copy)
}

fn read(folder: &Path, copy: &Saved) -> Result<Vec<u8>> {
    let path = folder.join(&copy.file);
    let place = || path.display().to_string();
    let file = files::open(&path).with_context(place)?;
    let mut bytes = Vec::new();
    file.take(MAX_TEXT as u64 + 1).read_to_end(&mut bytes).with_context(place)?;
    Ok(bytes)
}

impl State {
    fn is_equal(self) -> bool {
        matches!(self, Self::Same | Self::SameButDate | Self::WithinTolerance)
    }
}

impl Compared {
    /// Result without details.
    pub fn new(state: State) -> Self {
        let (hunks, only_line_endings) = state.is_equal().then(|| (Vec::new(), false)).unzip();
        Self { state, ignored: Vec::new(), hunks, only_line_endings, file: String::new() }
    }

    /// Files that differ, with the changes if they are texts.
    pub fn texts(found: Option<TextDifference>) -> Self {
        let (hunks, only_line_endings) = found.map(|found| (found.hunks, found.only_line_endings)).unzip();
        Self { hunks, only_line_endings, ..Self::new(State::Changed) }
    }

    /// Changes to show line by line.
    pub fn changes(&self) -> Option<&[Hunk]> {
        self.hunks.as_deref().filter(|hunks| !hunks.is_empty() && self.only_line_endings == Some(false))
    }
}

impl Difference {
    fn result(&self, old: &SideReport, new: &SideReport) -> Cell {
        let are_robots = old.folder.is_none() && new.folder.is_none();
        let only = |of: &SideReport| match &of.folder {
            Some(folder) => Cell::from(format!("only in {folder}")).tone(Tone::Warning),
            None if are_robots => Cell::from(format!("only on {}", of.robot)).tone(Tone::Warning),
            None => Cell::from("only on the controller").tone(Tone::Warning),
        };
        let count = |change| {
            let lines = self.more.hunks.iter().flatten().flat_map(|hunk| &hunk.lines);
            lines.filter(|line| line.change == change).count()
        };
        let Compared { state, ignored, hunks, only_line_endings, .. } = &self.more;
        match (state, &self.error) {
            (State::Same, _) => Cell::from("the same").tone(Tone::Good),
            (State::SameButDate, _) => Cell::from("the same except ///DATE, which is ignored").tone(Tone::Good),
            (State::WithinTolerance, _) => Cell::from("the same within the tolerance").tone(Tone::Good),
            (State::OnlyOld, _) => only(old),
            (State::OnlyNew, _) => only(new),
            (State::Unknown, error) => {
                let why = error.as_ref().map(|error| error.cell().text).unwrap_or_default();
                Cell::from(format!("not compared: {why}")).tone(Tone::Bad)
            }
            (State::Changed, _) if hunks.is_none() => Cell::from("differs").tone(Tone::Bad),
            (State::Changed, _) if *only_line_endings == Some(true) => {
                Cell::from("only line endings differ").tone(Tone::Bad)
            }
            (State::Changed, _) => {
                let (less, more) = (count(Change::Removed), count(Change::Added));
                let date = if ignored.is_empty() { "" } else { "; ///DATE is ignored" };
                Cell::from(format!("differs: -{less} +{more} lines{date}")).tone(Tone::Bad)
            }
        }
    }
}

impl Report for Differences {
    fn view(&self) -> View {
        let mut view = View::default();
        for file in &self.files {
            let Some(hunks) = file.more.changes() else { continue };
            let named = |of: &SideReport, other: &SideReport| match &*file.more.file {
                "" => format!("{of}: {}", file.name),
                own => of.of(own, other),
            };
            let (old, new) = (named(&self.old, &self.new), named(&self.new, &self.old));
            view = view.append(Section::Lines(unified(&old, &new, hunks)));
        }
        let mut table = Table::new(&["name", "result"], "");
        for file in self.files.iter().filter(|file| file.more.state != State::Same) {
            table.row([file.name.as_str().into(), file.result(&self.old, &self.new)]);
        }
        if !table.rows.is_empty() {
            view = view.append(Section::Table(table));
        }
        // A file that could not be compared is an error, and the error has the summary.
        let is_complete = self.files.iter().all(|file| file.error.is_none());
        if is_complete { view.append(Section::Text(self.summary())) } else { view }
    }

    fn failure(&self) -> Option<Failure> {
        if self.equal {
            return None;
        }
        let failures = self.files.iter().filter_map(|file| file.error.as_ref()).map(ItemError::failure);
        Some(match failures.max_by_key(|failure| severity(failure.kind)) {
            Some(gravest) => Failure { message: self.summary(), code: None, ..gravest },
            None => Failure::difference(self.summary()),
        })
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

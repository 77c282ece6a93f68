//! Files: data that is listed, transferred, saved, written back or compared under a name.
//!
//! Reports have `files[]` with `name`, `bytes`, `sha256`, `path`, `ok` and, after a failure, `error`. Each file has its
//! own result. Parts of a backup, such as `points-1`, are files.

use crate::backup::manifest::{Hash, LeftOut, Saved};
use crate::backup::{continues_after, severity};
use crate::items::ItemError;
use crate::prelude::basics::*;

/// A file.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct FileItem<M = Transfer> {
    /// Name on the controller, or name of a part of a backup: `TESTJOB.JBI`, `points-1`.
    pub name: String,
    /// Size; null if it is unknown.
    pub bytes: Option<u64>,
    /// SHA-256 of the content in hexadecimal; null if the content is unknown.
    pub sha256: Option<String>,
    /// Local file; null if there is none.
    pub path: Option<String>,
    /// Other fields of the command or family.
    #[serde(flatten)]
    pub more: M,
    /// Whether the work on this file succeeded; false if it failed or was not tried.
    pub ok: bool,
    /// Reason for the failure.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    pub error: Option<ItemError>,
}

impl<M> FileItem<M> {
    /// File without content, with its result.
    pub fn new(name: impl fmt::Display, more: M, outcome: Result<()>) -> Self {
        let name = name.to_string();
        let error = outcome.err().map(|failure| ItemError::new(name.as_str(), failure));
        Self { name, bytes: None, sha256: None, path: None, more, ok: error.is_none(), error }
    }

    /// Adds the local file.
    #[must_use]
    pub fn with_path(self, path: &Path) -> Self {
        Self { path: Some(path.display().to_string()), ..self }
    }

    /// Adds a file of a backup in `folder`.
    #[must_use]
    pub fn from_copy(self, folder: &Path, Saved { file, bytes, sha256 }: &Saved) -> Self {
        Self { bytes: Some(*bytes), sha256: Some(sha256.clone()), ..self.with_path(&folder.join(file)) }
    }

    /// Adds the content.
    #[must_use]
    pub fn with_content(self, content: Hash) -> Self {
        Self { bytes: Some(content.bytes), sha256: Some(content.hex()), ..self }
    }
}

/// Fields of a file that is transferred, deleted, saved or written back.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Transfer {
    /// Bytes of the name in hexadecimal, if the text cannot be converted back to these bytes.
    pub name_hex: Option<String>,
    /// Progress.
    pub state: State,
    /// Number of values that were written, if they are written one by one.
    pub written: Option<usize>,
    /// Number of values that were equal, if they are written one by one.
    pub unchanged: Option<usize>,
    /// Values that are not in the file, or were not written.
    pub left_out: Vec<LeftOut>,
    /// Additional steps: `replaced`, `verified`, `line_endings_fixed`, `name_differs`, `empty`.
    pub notes: Vec<String>,
}

/// Progress of a transfer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// Done now.
    Done,
    /// Done earlier, or nothing to do.
    Kept,
    /// Failed; see `error`.
    Failed,
    /// Not tried because of an earlier failure.
    #[default]
    NotTried,
}

impl FileItem {
    /// File that was not tried yet.
    pub fn pending(name: impl fmt::Display) -> Self {
        Self { ok: false, ..Self::new(name, Transfer::default(), Ok(())) }
    }

    /// Part of a backup that is written value by value and was not tried yet.
    pub fn values(name: impl fmt::Display) -> Self {
        let mut file = Self::pending(name);
        (file.more.written, file.more.unchanged) = (Some(0), Some(0));
        file
    }

    /// Records the success, now or earlier.
    pub fn succeed(&mut self, state: State) {
        (self.more.state, self.ok) = (state, true);
    }

    /// Records a failure. Returns whether the next file can be tried: yes after a refusal of this file, no after a lost
    /// connection or a full disk.
    pub fn fail(&mut self, failure: Failure) -> bool {
        let continues = continues_after(&failure);
        (self.more.state, self.ok) = (State::Failed, false);
        self.error = Some(ItemError::new(self.name.as_str(), failure));
        continues
    }

    /// Records the content, or the failure. Returns whether the next file can be tried.
    pub fn finish(&mut self, outcome: Result<Option<Hash>>) -> bool {
        match outcome {
            Ok(content) => {
                if let Some(content) = content {
                    (self.bytes, self.sha256) = (Some(content.bytes), Some(content.hex()));
                }
                self.succeed(State::Done);
                true
            }
            Err(failure) => self.fail(failure),
        }
    }

    /// Cell of the result; `done` now, or `kept`.
    fn result(&self, [done, kept]: [&str; 2]) -> Cell {
        let Transfer { state, written, unchanged, left_out, notes, .. } = &self.more;
        let counted = |count: Option<usize>, words: &str| {
            count.filter(|count| *count > 0).map(|count| format!("{count} {words}"))
        };
        let counts = match written {
            None => None,
            Some(0) => Some(NO_DIFFERENCE.to_owned()),
            written => {
                let parts = [counted(*written, "written"), counted(*unchanged, "unchanged")];
                Some(parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
            }
        };
        let partly = counts.clone().filter(|_| *written > Some(0));
        let cell = match (state, &self.error) {
            (State::Done, _) => Cell::from(counts.unwrap_or_else(|| done.to_owned())).tone(Tone::Good),
            (State::Kept, _) => Cell::from(kept),
            (State::Failed, error) => {
                let error = error.as_ref().map_or_else(|| "failed".into(), ItemError::cell);
                let text = partly.map_or(String::new(), |counts| format!("{counts}; then ")) + &error.text;
                Cell::from(text).tone(Tone::Bad)
            }
            (State::NotTried, _) => {
                let before = partly.map_or(String::new(), |counts| format!("{counts}; the rest "));
                Cell::from(before + "not tried").tone(Tone::Warning)
            }
        };
        let notes = notes.iter().fold(String::new(), |text, note| text + ", " + &note.replace('_', " "));
        let keys: Vec<&str> = left_out.iter().map(|left| left.key.as_str()).collect();
        let without = match &keys[..] {
            [] => String::new(),
            [first, .., last] if keys.len() > MAX_KEYS => {
                format!("; without {} values, {first} to {last}", keys.len())
            }
            few => format!("; without {}", few.join(", ")),
        };
        Cell { text: cell.text + &notes + &without, ..cell }
    }

    /// Table of names and results; `words` are the texts for done and kept.
    pub fn results(files: &[Self], words: [&str; 2]) -> View {
        let mut table = Table::new(&["name", "result"], "no files");
        for file in files {
            table.row([file.name.as_str().into(), file.result(words)]);
        }
        View::table(table)
    }

    /// Table with sizes and local files, if any.
    pub fn transfers(files: &[Self], done: &str) -> View {
        let mut table = Table::new(&["name", "bytes", "file", "result"], "no files");
        for file in files {
            let bytes = file.bytes.map_or_else(|| Cell::number("-"), Cell::from);
            let result = file.result([done, "kept"]);
            table.row([file.name.as_str().into(), bytes, Cell::optional(file.path.as_deref()), result]);
        }
        View::table(table.without_blank("bytes").without_blank("file"))
    }
}

/// Text if nothing had to be written.
pub const NO_DIFFERENCE: &str = "nothing differed";
/// Maximum number of left-out values in a table.
const MAX_KEYS: usize = 6;

/// Files in the order of processing.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Files<M = Transfer> {
    /// Files, each with its own result.
    pub files: Vec<FileItem<M>>,
    /// Number of results that were requested.
    #[serde(skip)]
    asked: usize,
    #[serde(skip)]
    show: fn(&[FileItem<M>]) -> View,
}

impl<M> Files<M> {
    /// Report of files with its view.
    pub fn new(files: Vec<FileItem<M>>, show: fn(&[FileItem<M>]) -> View) -> Self {
        Self { asked: files.len(), files, show }
    }

    /// Sets the number of requested results, if this number differs from the number of files. This is the case for
    /// lists of files.
    #[must_use]
    pub fn asked(self, asked: usize) -> Self {
        Self { asked, ..self }
    }

    /// The failure, if there is only one file and it failed.
    pub fn single_failure(self) -> Result<Self> {
        match &self.files[..] {
            [FileItem { error: Some(error), .. }] => Err(error.failure()),
            _ => Ok(self),
        }
    }

    /// The most severe failure of a file; the first of equal severity.
    pub fn most_severe(&self) -> Option<Failure> {
        let failures = self.files.iter().filter_map(|file| file.error.as_ref()).map(ItemError::failure);
        failures.rev().max_by_key(|failure| severity(failure.kind))
    }

    /// View for people.
    pub fn view(&self) -> View {
        (self.show)(&self.files)
    }

    /// Failure of the report: some files failed and some did not, unless an outcome is unknown or the work was
    /// interrupted.
    pub fn failure(&self) -> Option<Failure> {
        let most_severe = self.most_severe()?;
        if self.asked <= 1 {
            return Some(most_severe);
        }
        let failed = self.files.iter().filter(|file| file.error.is_some()).count();
        let not_tried = self.files.iter().filter(|file| !file.ok && file.error.is_none()).count();
        let counts = match not_tried {
            0 => format!("{failed} of {} failed", self.asked),
            _ => format!("{failed} of {} failed, {not_tried} not tried", self.asked),
        };
        let kind = match most_severe.kind {
            kind @ (Kind::OutcomeUnknown | Kind::Interrupted) => kind,
            _ if self.asked > failed + not_tried => Kind::Mixed,
            kind => kind,
        };
        Some(Failure { kind, message: format!("{counts}: {}", most_severe.message), ..most_severe })
    }
}

impl<M: Serialize + JsonSchema> Report for Files<M> {
    fn view(&self) -> View {
        self.view()
    }

    fn failure(&self) -> Option<Failure> {
        self.failure()
    }

    fn rows(&self) -> RowsOf {
        FILES
    }
}

/// Rows of a report with files.
pub const FILES: RowsOf = RowsOf::List("files");

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::render;

    fn files() -> Vec<FileItem> {
        let mut files: Vec<FileItem> = ["A.JBI", "B.JBI", "C.JBI", "D.JBI"].map(FileItem::pending).into();
        assert!(files[0].finish(Ok(Some(Hash::of(b"abc")))));
        assert!(files[1].finish(Err(Failure::new(Kind::Refused, "no. Never").code("0xE29C"))));
        assert!(!files[2].finish(Err(Failure::new(Kind::NoAnswer, "silence").hint("cable"))));
        files
    }

    fn saved(files: Vec<FileItem>) -> Files {
        Files::new(files, |files| FileItem::transfers(files, "saved"))
    }

    #[test]
    fn every_file_has_all_keys() {
        let json = serde_json::to_value(saved(files())).unwrap();
        let sha256 = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        let first = serde_json::json!({
            "name": "A.JBI", "bytes": 3, "sha256": sha256, "path": null, "name_hex": null, "state": "done",
            "written": null, "unchanged": null, "left_out": [], "notes": [], "ok": true,
        });
        assert_eq!(json["files"][0], first);
        assert_eq!((&json["files"][1]["ok"], &json["files"][1]["error"]["code"]), (&false.into(), &"0xE29C".into()));
        assert_eq!((&json["files"][3]["ok"], &json["files"][3]["state"]), (&false.into(), &"not_tried".into()));
    }

    #[test]
    fn most_severe_failure_decides() {
        let report = saved(files());
        let failure = report.failure().unwrap();
        assert_eq!((failure.kind, failure.kind.exit()), (Kind::Mixed, 9));
        assert_eq!(failure.message, "2 of 4 failed, 1 not tried: C.JBI: silence");
        assert_eq!(failure.hint.as_deref(), Some("cable"));
        let text = render::text(&report.view(), 80, false);
        assert_eq!(
            text,
            "NAME   BYTES  RESULT\nA.JBI      3  saved\nB.JBI      -  no [0xE29C]\nC.JBI      -  silence\nD.JBI      \
             -  not tried\n"
        );
    }

    #[test]
    fn lost_answers_and_interrupts_keep_their_exit_codes() {
        for kind in [Kind::OutcomeUnknown, Kind::Interrupted] {
            let mut files = files();
            files[2].finish(Err(Failure::new(kind, "lost")));
            assert_eq!(saved(files).failure().unwrap().kind, kind);
        }
        let mut files = files();
        files[0].fail(Failure::new(Kind::Refused, "no"));
        assert_eq!(saved(files).failure().unwrap().kind, Kind::NoAnswer, "nothing was done");
    }

    #[test]
    fn single_file_fails_with_its_own_error() {
        let failed = saved(files().drain(1..2).collect()).single_failure().unwrap_err();
        assert_eq!((failed.kind, failed.message.as_str()), (Kind::Refused, "B.JBI: no. Never"));
        assert!(saved(files()).single_failure().is_ok());
        assert!(saved(files().drain(..1).collect()).single_failure().unwrap().failure().is_none());
    }

    #[test]
    fn counts_written_and_omitted_values() {
        let mut part = FileItem::values("p");
        part.more.unchanged = Some(9);
        part.succeed(State::Done);
        let left_out = |key: usize| LeftOut { key: key.to_string(), why: String::new() };
        part.more.left_out = (1..3).map(left_out).collect();
        assert_eq!(part.result(["", ""]).text, "nothing differed; without 1, 2");
        part.more.left_out = (1..30).map(left_out).collect();
        part.more.written = Some(2);
        assert_eq!(part.result(["", ""]).text, "2 written, 9 unchanged; without 29 values, 1 to 29");
        part.more.left_out.clear();
        part.fail(Failure::new(Kind::Refused, "no"));
        assert_eq!(part.result(["", ""]).text, "2 written, 9 unchanged; then no");
    }
}

//! Results of several files.
//!
//! A single file that fails is a failed command. With several files, each has its own result, and a refusal does not
//! stop the others. The exit code is 9 if some files succeeded, otherwise that of the most severe failure.

use schemars::JsonSchema;
use serde::Serialize;

use super::name::Shown;
use super::transfer::about;
use crate::command::Report;
use crate::command::backup::manifest::State;
use crate::command::backup::{self, Item, Items, gravity};
use crate::command::frame::items::brief;
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Table, Tone, View};

/// Result of one file.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct FileResult {
    /// Name on the controller.
    #[serde(flatten)]
    pub name: Shown,
    /// State of the transfer.
    pub state: State,
    /// Local file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub path: Option<String>,
    /// Size of the whole file.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes: Option<u64>,
    /// Additional steps: `replaced`, `verified`, `line_endings_fixed`, `name_differs`, `empty`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Reason for the failure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<Failure>,
}

impl FileResult {
    /// Result of a file that is still to be processed.
    pub fn pending(name: Shown, path: Option<&std::path::Path>) -> Self {
        let path = path.map(|path| path.display().to_string());
        Self { name, state: State::NotTried, path, bytes: None, notes: Vec::new(), error: None }
    }

    /// Records the size or the failure. Returns whether the next file can be tried: yes after a refusal of this file,
    /// no after a lost connection or a full disk.
    pub fn settle(&mut self, outcome: Result<Option<u64>, Failure>) -> bool {
        match outcome {
            Ok(bytes) => {
                self.state = State::Done;
                self.bytes = bytes;
                true
            }
            Err(failure) => {
                let goes_on = backup::goes_on(&failure);
                self.state = State::Failed;
                self.error = Some(failure);
                goes_on
            }
        }
    }
}

/// Results of all files of a command.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Results {
    /// In the order of processing.
    pub files: Vec<FileResult>,
    /// Number of completed files, including those of an earlier run.
    pub done: usize,
    /// Number of failed files.
    pub failed: usize,
    /// Number of files that were not tried.
    pub not_tried: usize,
    #[serde(skip)]
    shape: Shape,
}

/// Display options of results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shape {
    /// Verb for a completed file, such as `deleted`.
    pub done: &'static str,
    /// Whether there are local files.
    pub has_paths: bool,
    /// Whether there are sizes.
    pub has_bytes: bool,
}

impl Results {
    /// Counts the results.
    pub fn new(files: Vec<FileResult>, shape: Shape) -> Self {
        let count = |states: &[State]| files.iter().filter(|file| states.contains(&file.state)).count();
        let (done, failed) = (count(&[State::Done, State::Kept]), count(&[State::Failed]));
        let not_tried = count(&[State::NotTried]);
        Self { files, done, failed, not_tried, shape }
    }

    /// Report, or the failure of a single file.
    pub fn report(mut self) -> Result<Self, Failure> {
        match &mut self.files[..] {
            [only] => match only.error.take() {
                Some(failure) => Err(about(&only.name.name, failure)),
                None => Ok(self),
            },
            _ => Ok(self),
        }
    }

    /// Table without totals.
    pub fn table(&self) -> Table {
        let Shape { done, has_paths, has_bytes } = self.shape;
        let mut table = Table::new(&[], "no files");
        let all = [("name", true), ("bytes", has_bytes), ("file", has_paths), ("result", true)];
        let shown =
            |cells: [Cell; 4]| all.into_iter().zip(cells).filter(|((_, shown), _)| *shown).map(|(_, cell)| cell);
        table.columns = all.into_iter().filter(|(_, shown)| *shown).map(|(name, _)| name).collect();
        for file in &self.files {
            let result = match (file.state, &file.error) {
                (State::Done, _) => Cell::from(done).tone(Tone::Good),
                (State::Kept, _) => Cell::from("kept"),
                (State::Failed, Some(error)) => Cell::from(brief(error)).tone(Tone::Bad),
                (State::Failed, None) => Cell::from("failed").tone(Tone::Bad),
                (State::NotTried, _) => Cell::from("not tried").tone(Tone::Warning),
            };
            let text = notes(file).fold(result.text, |text, note| text + ", " + note);
            let result = Cell { text, ..result };
            let name = file.name.name.as_str().into();
            table.rows.push(
                shown([
                    name,
                    file.bytes.map_or_else(|| Cell::number("-"), Cell::from),
                    Cell::maybe(file.path.as_deref()),
                    result,
                ])
                .collect(),
            );
        }
        table
    }
}

impl From<Results> for Items {
    fn from(results: Results) -> Self {
        let item = |file: FileResult| {
            let notes = notes(&file).map(ToOwned::to_owned).collect();
            let FileResult { name: Shown { name, name_hex }, state, path, bytes, error, .. } = file;
            Item { name_hex, state, file: path, bytes, notes, error, ..Item::pending(name) }
        };
        Self::new(results.files.into_iter().map(item).collect())
    }
}

impl Report for Results {
    fn view(&self) -> View {
        View::table(self.table())
    }

    fn failure(&self) -> Option<Failure> {
        let failures = self.files.iter().filter_map(|file| Some((&file.name.name, file.error.as_ref()?)));
        // The first one of equal severity.
        let (name, gravest) = failures.rev().max_by_key(|(_, failure)| gravity(failure.kind))?;
        let total = self.files.len();
        let failed = match self.not_tried {
            0 => format!("{} of {total} files failed", self.failed),
            left => format!("{} of {total} files failed, {left} not tried", self.failed),
        };
        // Some files succeeded and some failed.
        let kind = if self.done > 0 { Kind::Mixed } else { gravest.kind };
        Some(Failure { kind, message: format!("{failed}: {name}: {}", gravest.message), ..gravest.clone() })
    }
}

fn notes(file: &FileResult) -> impl Iterator<Item = &str> {
    file.notes.iter().map(|note| match note.as_str() {
        "line_endings_fixed" => "line endings fixed",
        "name_differs" => "//NAME differs",
        note => note,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::text::Encoding;
    use crate::output::render;

    const SHAPE: Shape = Shape { done: "saved", has_paths: false, has_bytes: true };

    fn files() -> Vec<FileResult> {
        let pending = |name: &[u8]| FileResult::pending(Shown::new(Encoding::ShiftJis, name), None);
        let mut files = vec![pending(b"A.JBI"), pending(b"B.JBI"), pending(b"C.JBI"), pending(b"D.JBI")];
        assert!(files[0].settle(Ok(Some(10))));
        assert!(files[1].settle(Err(Failure::new(Kind::Refused, "no. Never").code("0xE29C"))));
        assert!(!files[2].settle(Err(Failure::new(Kind::NoAnswer, "silence").hint("cable"))));
        files
    }

    #[test]
    fn the_gravest_failure_decides() {
        let results = Results::new(files(), SHAPE);
        assert_eq!((results.done, results.failed, results.not_tried), (1, 2, 1));
        let failure = results.failure().unwrap();
        assert_eq!((failure.kind, failure.kind.exit()), (Kind::Mixed, 9));
        assert_eq!(failure.message, "2 of 4 files failed, 1 not tried: C.JBI: silence");
        assert_eq!(failure.hint.as_deref(), Some("cable"));
        let text = render::text(&results.view(), 80, false);
        assert_eq!(
            text,
            "NAME   BYTES  RESULT\nA.JBI     10  saved\nB.JBI      -  no [0xE29C]\nC.JBI      -  silence\nD.JBI      \
             -  not tried\n"
        );
    }

    #[test]
    fn one_file_fails_as_itself() {
        let failed = Results::new(files().drain(1..2).collect(), SHAPE).report().unwrap_err();
        assert_eq!((failed.kind, failed.message.as_str()), (Kind::Refused, "B.JBI: no. Never"));
        assert!(Results::new(files(), SHAPE).report().is_ok());
        assert!(Results::new(files().drain(..1).collect(), SHAPE).report().unwrap().failure().is_none());
    }
}

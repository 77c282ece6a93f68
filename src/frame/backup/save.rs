//! Backup procedure of all families. Complete parts are kept, each part has its own result, and the manifest always
//! shows the progress. A family supplies the list of parts and the code that reads them.

use tokio::time::Instant;

use super::manifest::{self, About, Entry, Hash, LeftOut, MANIFEST, Manifest, Reason, Saved};
use super::{BackupReport, SaveOptions};
use crate::interrupt::interruptible;
use crate::local_names::{Target, make_folder, private_folder};
use crate::prelude::basics::*;
use crate::robot::file::{FileItem, State};

/// Maximum progress that may be lost from the manifest after a power failure.
const WRITE_EVERY: Duration = Duration::from_secs(1);

/// A requested backup, before the controller is read.
#[derive(Debug)]
pub struct Task<C> {
    /// Target folder.
    pub folder: PathBuf,
    /// Selection.
    pub scope: Vec<String>,
    earlier: Option<Manifest<C>>,
}

/// A part that was read.
#[derive(Debug)]
pub struct SavedPart {
    /// Content of its file.
    pub content: Content,
    /// Content type, if known only after reading.
    pub holds: Option<String>,
    /// Items that are not in the file.
    pub left_out: Vec<LeftOut>,
    /// Items that the controller does not have. Only the manifest lists them.
    pub is_absent: Vec<LeftOut>,
    /// Notes.
    pub notes: Vec<String>,
}

/// Content of the file of a part.
#[derive(Debug)]
pub enum Content {
    /// New file with this name and text.
    Text(String, String),
    /// Existing file.
    File(Saved),
}

impl SavedPart {
    /// Part without notes.
    pub fn new(content: Content) -> Self {
        Self { content, holds: None, left_out: Vec::new(), is_absent: Vec::new(), notes: Vec::new() }
    }
}

impl<C: About> Task<C> {
    /// Reads the target folder. If the user gave no selection, an existing backup supplies the selection.
    pub fn new(making: SaveOptions, robot: &Robot, several: bool) -> Result<Self> {
        let SaveOptions { folder, scope, resume, force } = making;
        let folder = folder_for(&folder, robot, several)?;
        let earlier: Option<Manifest<C>> =
            manifest::find_earlier_backup(&folder, robot, scope.as_deref(), resume, force)?;
        let scope = scope.or_else(|| earlier.as_ref().map(|earlier| earlier.scope.clone())).unwrap_or_default();
        Ok(Self { folder, scope, earlier })
    }

    /// Starts the backup and writes the manifest at once to check that the folder is writable. The manifest contains
    /// the existing parts that are complete and that `is_kept` accepts, based on the earlier manifest and its entry.
    pub fn begin<'a>(
        &'a self,
        (screen, robot): (&'a Screen, &Robot),
        controller: C,
        is_kept: impl Fn(&Manifest<C>, &Entry) -> bool,
    ) -> Result<BackupWriter<'a, C>> {
        let folder = &self.folder;
        make_folder(folder)?;
        let mut list = Manifest::new(robot, controller, self.scope.clone());
        // Earlier parts stay in the manifest. So they are not lost if the backup is interrupted.
        if let Some(earlier) = &self.earlier {
            let is_whole = |entry: &&Entry| entry.copy.as_ref().is_some_and(|copy| copy.check(folder).is_ok());
            let kept_entry = earlier.files.iter().filter(|entry| is_kept(earlier, entry)).filter(is_whole);
            list.files = kept_entry.cloned().collect();
        }
        list.write(folder)?;
        Ok(BackupWriter { list, folder, screen, files: Vec::new(), written: Instant::now(), is_closed: false })
    }
}

/// Folder for the backup of a robot: with several robots, a folder for each of them within `folder`.
///
/// # Errors
/// `folder` is itself the backup of a robot.
pub fn folder_for(folder: &Path, robot: &Robot, several: bool) -> Result<PathBuf> {
    if several && let Some(earlier) = manifest::read::<Value>(folder)? {
        let backup = format!("{} is the backup of {}", folder.display(), earlier.robot);
        return Err(Failure::usage(format!("{backup}, not a folder for several backups")).hint("use another folder"));
    }
    Ok(private_folder(folder, &robot.name, several))
}

/// Runs a backup until it ends or Ctrl-C; a failure reports what is saved.
pub async fn interrupted_failure<T>(folder: &Path, work: impl Future<Output = Result<T>>) -> Result<T> {
    // Ctrl-C ends the work here, before the caller handles it, so that the saved files are reported.
    let outcome = interruptible(work).await.and_then(|outcome| outcome);
    outcome.map_err(|failure| match manifest::read::<Value>(folder) {
        Ok(Some(list)) if failure.kind != Kind::Usage => {
            with_resume_hint(failure, folder, list.files.iter().filter(|entry| entry.copy.is_some()).count())
        }
        _ => failure,
    })
}

/// Failure that ended a backup, with the number of saved files.
fn with_resume_hint(failure: Failure, folder: &Path, saved: usize) -> Failure {
    let message = format!("{}; {saved} files are in {}", failure.message.trim_end_matches('.'), folder.display());
    let again = "continue with --resume";
    let hint = failure.hint.as_ref().map_or(again.to_owned(), |hint| format!("{hint}; then {again}"));
    Failure { message, ..failure }.hint(hint)
}

/// A backup in progress.
#[derive(Debug)]
pub struct BackupWriter<'a, C: About> {
    list: Manifest<C>,
    folder: &'a Path,
    screen: &'a Screen,
    files: Vec<FileItem>,
    written: Instant,
    is_closed: bool,
}

impl<C: About> BackupWriter<'_, C> {
    /// Manifest entry of a part.
    pub fn entry(&self, name: &str) -> Option<&Entry> {
        self.list.entry(name)
    }

    /// Results so far.
    pub fn files(&mut self) -> &mut Vec<FileItem> {
        &mut self.files
    }

    /// Reads a part into its file, unless the file exists. Returns whether the next part can be tried.
    pub async fn part(&mut self, mut entry: Entry, read: impl Future<Output = Result<SavedPart>>) -> Result<bool> {
        let mut file = FileItem::pending(&entry.name);
        let unchanged = |known: &&Entry| known.name == entry.name && known.name_hex == entry.name_hex;
        if let Some(Entry { copy: Some(copy), left_out, .. }) = self.list.files.iter().find(unchanged) {
            file.more.left_out.clone_from(left_out);
            self.files.push(self.saved(file, State::Kept, copy));
            return Ok(true);
        }
        let continues = match read.await {
            Ok(part) => {
                let copy = match part.content {
                    Content::Text(file, text) => write_text(self.folder, file, &text)?,
                    Content::File(copy) => copy,
                };
                (file.more.left_out, file.more.notes) = (part.left_out.clone(), part.notes);
                file = self.saved(file, State::Done, &copy);
                entry.copy = Some(copy);
                entry.holds = part.holds.unwrap_or(entry.holds);
                entry.left_out = [part.left_out, part.is_absent].concat();
                true
            }
            Err(failure) => {
                entry.error = Some(Reason::from(&failure));
                file.fail(failure)
            }
        };
        self.files.push(file);
        self.list.files.push(entry);
        if self.written.elapsed() >= WRITE_EVERY {
            self.list.write(self.folder)?;
            self.written = Instant::now();
        }
        Ok(continues)
    }

    /// Result of a part whose file is in the folder.
    fn saved(&self, mut file: FileItem, state: State, copy: &Saved) -> FileItem {
        file.succeed(state);
        file.from_copy(self.folder, copy)
    }

    /// Ends the backup. `rest` are the parts that were not read.
    pub fn end(mut self, rest: impl IntoIterator<Item = FileItem>) -> Result<BackupReport> {
        self.is_closed = true;
        self.files.extend(rest);
        let files = std::mem::take(&mut self.files);
        self.list.complete = files.iter().all(|file| file.ok);
        self.list.write(self.folder)?;
        Ok(BackupReport::new(self.folder, self.list.scope.clone(), self.list.complete, files))
    }
}

impl<C: About> Drop for BackupWriter<'_, C> {
    /// Ctrl-C, or an error that ended the work early.
    fn drop(&mut self) {
        if let (false, Err(failure)) = (self.is_closed, self.list.write(self.folder)) {
            self.screen.note(&format!("{MANIFEST} was not written: {failure}"));
        }
    }
}

/// Writes a text file to a folder atomically.
fn write_text(folder: &Path, file: String, text: &str) -> Result<Saved> {
    let mut draft = Target::new(folder.join(&file), true)?.begin()?;
    draft.write(text.as_bytes())?;
    draft.commit()?;
    Ok(Hash::of(text.as_bytes()).saved(file))
}

//! Text that a user edits between a read from a controller and the write back to it. The text is always in a file. The
//! file is kept until the text is on the controller.

use super::interrupt::catch_interrupts;
use super::local_names::state_folder;
use crate::failure::plain;
use crate::output::editor;
use crate::prelude::basics::*;

/// Environment variables with the name of the editor, in the order of priority.
const VARIABLES: [&str; 2] = ["VISUAL", "EDITOR"];
/// Default editor.
const DEFAULT_EDITOR: &str = if cfg!(windows) { "notepad" } else { "vi" };
/// Maximum size of an edited text.
const SIZE_LIMIT: u64 = 16 << 20;

/// A text that a user has edited. Its file is removed when the text is no longer needed.
#[derive(Debug)]
pub struct EditedText {
    path: PathBuf,
    original: Vec<u8>,
    screen: Screen,
    is_needed: bool,
    is_path_reported: bool,
}

impl EditedText {
    /// Opens the editor for a text in a file whose name ends in `name`.
    pub fn new(name: &str, text: &[u8], screen: Screen) -> Result<Self> {
        let folder = state_folder().map_or_else(std::env::temp_dir, |folder| folder.join("edited"));
        let place = || folder.display().to_string();
        std::fs::create_dir_all(&folder).with_context(place)?;
        let file = tempfile::Builder::new().prefix("").suffix(&format!("-{name}")).tempfile_in(&folder);
        let path =
            file.with_context(place)?.into_temp_path().keep().map_err(|error| error.error).with_context(place)?;
        let mut edited = Self { path, original: text.to_vec(), screen, is_needed: false, is_path_reported: false };
        edited.replace(text)?;
        let opened = open_editor(&edited.path);
        // If the editor fails after the user changed the text, the text must be kept.
        edited.is_needed = edited.is_changed().unwrap_or(true);
        match opened {
            Err(failure) if edited.is_needed => {
                Err(edited.keep_file(failure, |path| format!("your text is in {path}")))
            }
            Err(failure) => Err(failure),
            Ok(()) => Ok(edited),
        }
    }

    /// Path of the file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Current text.
    pub fn text(&self) -> Result<Vec<u8>> {
        files::read(&self.path, SIZE_LIMIT).map_err(|error| Failure::io(self.path.display(), &error))
    }

    /// Whether the user changed the text.
    pub fn is_changed(&self) -> Result<bool> {
        Ok(self.text()? != self.original)
    }

    /// Replaces the text.
    pub fn replace(&self, text: &[u8]) -> Result<()> {
        Ok(files::replace(&self.path, text).with_context(|| self.path.display().to_string())?)
    }

    /// Marks the text as stored on the controller.
    pub fn mark_stored(&mut self) {
        self.is_needed = false;
    }

    /// Adds the location of the file and the next step to a failure. The file is kept.
    pub fn keep_file(&mut self, failure: Failure, how: impl FnOnce(&str) -> String) -> Failure {
        if !self.is_needed {
            return failure;
        }
        self.is_path_reported = true;
        let how = how(&self.path.display().to_string());
        let hint = failure.hint.as_ref().map_or_else(|| how.clone(), |hint| format!("{hint}\n{how}"));
        failure.hint(hint)
    }
}

impl Drop for EditedText {
    fn drop(&mut self) {
        if !self.is_needed {
            // A file that cannot be removed does no harm, so the error is ignored.
            let _ = std::fs::remove_file(&self.path);
        } else if !self.is_path_reported {
            self.screen.note(&format!("your text is in {}", self.path.display()));
        }
    }
}

/// Runs the editor of the user and waits until the user closes it.
pub fn open_editor(path: &Path) -> Result<()> {
    let named = VARIABLES.iter().find_map(|name| std::env::var(name).ok().filter(|line| !line.trim().is_empty()));
    let line = named.unwrap_or_else(|| DEFAULT_EDITOR.to_owned());
    let hint = || format!("set {} to the editor of your choice", VARIABLES.join(" or "));
    let words = shlex::split(&line).filter(|words| !words.is_empty());
    let words = words.ok_or_else(|| Failure::usage(format!("the editor '{line}' is not a command")).hint(hint()))?;
    // The editor itself handles Ctrl-C.
    catch_interrupts();
    let ended = editor::wait_for(&words, path);
    let ended = ended.map_err(|error| Failure::usage(format!("editor '{line}': {}", plain(&error))).hint(hint()))?;
    if ended.success() {
        return Ok(());
    }
    Err(Failure::local(format!("the editor '{line}' failed ({ended}); nothing was changed")).hint(hint()))
}

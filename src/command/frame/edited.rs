//! What a person edits between reading it from a controller and writing it back. It is in a file from the first moment on,
//! and stays there unless what it says is on the controller.

use std::path::{Path, PathBuf};

use anyhow::Context as _;

use super::interrupt::catch_interrupts;
use super::local::state_folder;
use crate::failure::{Failure, plain};
use crate::files;
use crate::output::{Screen, editor};

/// What editors are named by, the first that is set.
const VARIABLES: [&str; 2] = ["VISUAL", "EDITOR"];
/// The editor where none is named.
const USUAL: &str = if cfg!(windows) { "notepad" } else { "vi" };
/// Room for what a person edits.
const MOST: u64 = 16 << 20;

/// A text that a person has edited. Its file goes only when it is not needed any more.
#[derive(Debug)]
pub struct Edited {
    path: PathBuf,
    before: Vec<u8>,
    screen: Screen,
    is_needed: bool,
    is_told: bool,
}

impl Edited {
    /// Has a text edited in a file whose name ends in `name`.
    pub fn new(name: &str, text: &[u8], screen: Screen) -> Result<Self, Failure> {
        let folder = state_folder().map_or_else(std::env::temp_dir, |folder| folder.join("edited"));
        let place = || folder.display().to_string();
        std::fs::create_dir_all(&folder).with_context(place)?;
        let file = tempfile::Builder::new().prefix("").suffix(&format!("-{name}")).tempfile_in(&folder);
        let path =
            file.with_context(place)?.into_temp_path().keep().map_err(|error| error.error).with_context(place)?;
        let mut edited = Self { path, before: text.to_vec(), screen, is_needed: false, is_told: false };
        edited.replace(text)?;
        let opened = open_editor(&edited.path);
        // Whoever wrote something before his editor died wants it back.
        edited.is_needed = edited.is_changed().unwrap_or(true);
        match opened {
            Err(failure) if edited.is_needed => {
                Err(edited.kept(failure, |path| format!("what you wrote is in {path}")))
            }
            Err(failure) => Err(failure),
            Ok(()) => Ok(edited),
        }
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// What it says now.
    pub fn text(&self) -> Result<Vec<u8>, Failure> {
        files::read(&self.path, MOST).map_err(|error| Failure::io(self.path.display(), &error))
    }

    /// Whether it says something else than before.
    pub fn is_changed(&self) -> Result<bool, Failure> {
        Ok(self.text()? != self.before)
    }

    /// Puts a text in its place.
    pub fn replace(&self, text: &[u8]) -> Result<(), Failure> {
        Ok(files::replace(&self.path, text).with_context(|| self.path.display().to_string())?)
    }

    /// What it says is on the controller.
    pub fn done(&mut self) {
        self.is_needed = false;
    }

    /// A failure that says where the file is, and how it goes on.
    pub fn kept(&mut self, failure: Failure, how: impl FnOnce(&str) -> String) -> Failure {
        if !self.is_needed {
            return failure;
        }
        self.is_told = true;
        let how = how(&self.path.display().to_string());
        let hint = failure.hint.as_ref().map_or_else(|| how.clone(), |hint| format!("{hint}\n{how}"));
        failure.hint(hint)
    }
}

impl Drop for Edited {
    fn drop(&mut self) {
        if !self.is_needed {
            // What cannot be removed is in nobody's way.
            let _ = std::fs::remove_file(&self.path);
        } else if !self.is_told {
            self.screen.note(&format!("what you wrote is in {}", self.path.display()));
        }
    }
}

/// Waits until the editor of the user has ended.
pub fn open_editor(path: &Path) -> Result<(), Failure> {
    let named = VARIABLES.iter().find_map(|name| std::env::var(name).ok().filter(|line| !line.trim().is_empty()));
    let line = named.unwrap_or_else(|| USUAL.to_owned());
    let hint = || format!("set {} to the editor of your choice", VARIABLES.join(" or "));
    let words = shlex::split(&line).filter(|words| !words.is_empty());
    let words = words.ok_or_else(|| Failure::usage(format!("the editor '{line}' is not a command")).hint(hint()))?;
    // Ctrl-C in the editor is the editor's.
    catch_interrupts();
    let ended = editor::wait_for(&words, path);
    let ended = ended.map_err(|error| Failure::usage(format!("editor '{line}': {}", plain(&error))).hint(hint()))?;
    if ended.success() {
        return Ok(());
    }
    Err(Failure::local(format!("the editor '{line}' failed ({ended}); nothing was changed")).hint(hint()))
}

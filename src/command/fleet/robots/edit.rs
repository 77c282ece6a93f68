//! `armctl robots edit` and `path`: the inventory file.

use std::io::Write as _;

use super::file;
use armctl_frame::editor_session::open_editor;
use armctl_frame::prelude::*;
use armctl_frame::settings::inventory::Inventory;

/// Content of a new file.
const TEMPLATE: &str = "# The robots of this site. `armctl help inventory` describes this file.\n";

/// Opens a copy of the file in an editor. If the copy is valid, it replaces the file.
pub fn edit(run: &Run) -> Result<(), RunError> {
    let path = file::path(run)?;
    let place = || path.display().to_string();
    let before = file::read(path)?;
    let folder = files::folder_of(path);
    std::fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
    let folder = folder.canonicalize().with_context(|| folder.display().to_string())?;
    let copy = tempfile::Builder::new().prefix("robots-").suffix(".toml").tempfile_in(&folder);
    let mut copy = copy.with_context(|| folder.display().to_string())?;
    copy.write_all(if before.is_empty() { TEMPLATE } else { &before }.as_bytes()).with_context(place)?;
    // Only the path is kept, because an editor can replace the file.
    let copy = copy.into_temp_path();
    open_editor(&copy)?;
    let after = files::text(&copy, files::SETTINGS).with_context(|| copy.display().to_string())?;
    if after == before || before.is_empty() && after == TEMPLATE {
        let robots = Inventory::parse(&before, &place())?.robots.len();
        return run.local("robots.edit", &Edited { file: place(), changed: false, robots });
    }
    // The file name in an error is the name of the copy, so that line and column belong to the file in the editor.
    let parsed = Inventory::parse(&after, &copy.display().to_string()).and_then(|_| {
        file::replace(path, |now| {
            if now == before {
                Ok(after)
            } else {
                Err(Failure::usage(format!("{} was changed by another program during the edit", place()))
                    .hint("merge both versions"))
            }
        })
    });
    match parsed {
        Ok(inventory) => {
            let robots = inventory.robots.len();
            run.local("robots.edit", &Edited { file: place(), changed: true, robots })
        }
        Err(failure) => {
            let message = copy.keep().map_err(|error| Failure::io(place(), &error.error))?;
            let why = failure.hint.map_or_else(String::new, |hint| format!("{hint}; "));
            let hint = format!("{why}correct your text, which is in {}; the inventory is unchanged", message.display());
            Err(Failure { hint: Some(hint), ..failure }.into())
        }
    }
}

/// Result of an edit.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Edited {
    file: String,
    /// Whether the file was changed.
    changed: bool,
    /// Number of robots in the file.
    robots: usize,
}

impl Report for Edited {
    fn view(&self) -> View {
        let Self { file, changed, robots } = self;
        let plural = if *robots == 1 { "" } else { "s" };
        View::text(format!("{file}: {}, {robots} robot{plural}", if *changed { "changed" } else { "not changed" }))
    }
}

/// Prints the path of the inventory.
pub fn path(run: &Run) -> Result<(), RunError> {
    let path = file::path(run)?;
    run.local("robots.path", &InventoryPath { file: path.display().to_string(), exists: path.exists() })
}

/// Location of the inventory.
#[derive(Debug, Serialize, JsonSchema)]
pub struct InventoryPath {
    file: String,
    /// Whether the file exists; `robots add` and `setup` create it.
    exists: bool,
}

impl Report for InventoryPath {
    fn view(&self) -> View {
        View::text(self.file.clone())
    }
}

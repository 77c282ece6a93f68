//! Twin of a robot: a simulator that starts with the data of the robot's backup.
//!
//! The dry run of a restore plans the frames that write the backup. The start state of a twin is the result of these
//! frames, so there is no second list of the data of a family.

use std::any::Any;
use std::sync::OnceLock;

use super::manifest::{self, Manifest};
use super::parts::Table;
use crate::connection::Access;
use crate::output::{ColorChoice, Format};
use crate::prelude::basics::*;
use crate::settings::Sources;
use crate::settings::target::{self, Target};
use crate::{ConnectMode, Family};

/// Makes the start state of a family's simulator from a backup.
type Make = fn(target::Family, &Path) -> Result<Box<dyn Any>>;

/// A link to a simulator needs the tables of a backup, and the tables need a link. This value is between them.
static MAKE: OnceLock<Make> = OnceLock::new();

/// Sets how start states are made. Only the first call has an effect.
pub fn register(make: Make) {
    let _ = MAKE.set(make);
}

/// Start state of a family's simulator with the data of a backup.
///
/// # Errors
/// The folder contains no backup of the family, or a file that the simulator cannot use.
pub fn start<S: 'static>(family: target::Family, folder: &Path) -> Result<S> {
    let internal = || Failure::local(format!("internal error: {family} has no twins"));
    let start = MAKE.get().ok_or_else(internal)?(family, folder)?;
    start.downcast().map(|start| *start).map_err(|_| internal())
}

/// Frames that a restore of these tables sends, without the comparison before it.
///
/// # Errors
/// A row that cannot be written.
pub fn frames<F: Family>(tables: &mut [Table<F>]) -> Result<Vec<Value>> {
    let family = F::FAMILY.ok_or_else(|| Failure::local("internal error: a twin needs a family"))?;
    let robot = Sources::default().at(&Target::simulator(), family)?;
    let access = Access { dry_run: true, ..Access::reading(ConnectMode::Control) };
    let screen = silent();
    let planned = async {
        let mut link = F::connect(&robot, access, &screen).await?;
        for table in tables {
            table.write(&mut link, &screen).await?;
        }
        Ok(F::planned(&mut link).frames)
    };
    planned.now_or_never().ok_or_else(|| Failure::local("internal error: a dry run waited for an answer"))?
}

/// What a user must know about a twin: what a backup does not contain, and the number of changed files.
///
/// # Errors
/// The manifest cannot be read.
pub fn note(folder: &Path, unknown: &str) -> Result<String> {
    let manifest: Manifest = manifest::open_existing(folder)?;
    let copies = manifest.files.iter().filter_map(|entry| entry.copy.as_ref());
    let changed: Vec<&str> = copies.filter(|copy| copy.check(folder).is_err()).map(|copy| &copy.file[..]).collect();
    let shown = match changed[..] {
        [] => String::new(),
        [one] => format!("\n{one} differs from the manifest of the backup; the twin has the changed file"),
        [first, ..] => format!(
            "\n{} files differ from the manifest of the backup, for example {first}; the twin has the changed files",
            changed.len()
        ),
    };
    Ok(format!("{unknown}{shown}"))
}

/// Output settings for a start, which prints nothing.
pub fn silent() -> Screen {
    Screen::new(Format::Table, ColorChoice::Never, true, 0)
}

/// Failure: a simulator cannot hold the data of a backup.
pub fn impossible(folder: &Path, why: &str) -> Failure {
    Failure::usage(format!("{}: {why}", folder.display())).hint(
        "if you changed a file of the backup, correct it; otherwise, this simulator cannot be a twin of the robot",
    )
}

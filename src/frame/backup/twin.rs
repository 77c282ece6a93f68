//! Twin of a robot: a simulator that starts with the data of the robot's backup.
//!
//! The dry run of a restore plans the frames that write the backup. The start state of a twin is the result of these
//! frames, so there is no second list of the data of a family.

use std::path::Path;

use futures_util::FutureExt as _;
use serde_json::Value;

use super::parts::Table;
use crate::connection::Access;
use crate::output::{ColorChoice, Format};
use crate::prelude::basics::*;
use crate::settings::Sources;
use crate::settings::target::Target;
use crate::{ConnectMode, Family};

/// Frames that a restore of these tables sends, without the comparison before it.
///
/// # Errors
/// A row that cannot be written.
pub fn frames<F: Family>(tables: &mut [Table<F>]) -> Result<Vec<Value>, Failure> {
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

//! `armctl restore`.

use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use super::{family_of, opened, place};
use crate::command::backup::manifest;
use crate::command::backup::{Only, Restored, Restoring};
use crate::command::fleet::status::Fleet;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::Confirmation;
use crate::settings::target::Family;

/// Writes back what a backup holds.
#[derive(Debug, Args)]
#[command(
    after_help = "All files are checked against their hashes first, and what differs from the controller is written. So \
                  after a restore that was cut off the same command goes on where it ended. What the controller has \
                  beyond the backup stays.\n\nWhat makes it another machine is left out unless --machine is given: \
                  parameters and system data (yerc), parameters and settings (yrcx), machine parameters (toyo). More \
                  choice have `yerc file restore`, `yrcx restore` and `toyo restore`."
)]
pub struct Restore {
    /// Folder of the backup
    folder: PathBuf,
    /// Files or parts whose names fit, such as '*.JBI' or 'points*' (repeatable)
    #[arg(long, value_name = "PATTERN", value_delimiter = ',')]
    only: Vec<String>,
    /// Write what makes it another machine, too; needs --yes
    #[arg(long)]
    machine: bool,
    /// Write the backup of one robot or model to another
    #[arg(long)]
    force: bool,
}

impl Restore {
    /// The family of the backup.
    pub fn family(&self) -> Option<Family> {
        family_of(&self.folder)
    }
}

impl Command for Restore {
    type Family = Fleet;
    type Report = Restored;
    const ID: &'static str = "restore";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite what the controller stores by the backup";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Fleet>) -> Result<Restored, Failure> {
        let robot = context.robot;
        let folder = place(&self.folder, robot, context.several);
        manifest::check_origin(&manifest::existing::<Value>(&folder)?, robot, self.force)?;
        let only = Only(self.only.clone());
        let restoring = Restoring { folder, only, machine: self.machine, force: self.force };
        let (face, context) = opened(context)?;
        face.restore(context, &restoring).await
    }
}

//! `armctl schema ID`: the JSON Schema of a report.

use clap::Args;
use serde_json::json;

use crate::command::ValueKind;
use crate::command::backup::check::Checked;
use crate::command::backup::words::{Backup, Diff, Restore};
use crate::command::families::FAMILIES;
use crate::command::fleet::status::{Fleet, Overview};
#[cfg(feature = "plant")]
use crate::command::fleet::{metrics, publish};
use crate::command::fleet::{names, robots, session, shared, tools};
use crate::command::frame::background::Opened;
use crate::command::frame::dry_run::DryRun;
use crate::command::frame::run::Run;
use crate::command::{CommandSet as _, SchemaEntry};
use crate::controller::nearest::nearest;
use crate::failure::Failure;
use crate::output::envelope::{Envelope, ErrorBody};

/// Print the JSON Schema of `data` in the envelope, or the names of all reports.
///
/// Three schemas belong to all commands: `envelope` (the output of `--json`), `failure` (its `error`), and `dry-run` (the
/// data with --dry-run).
#[derive(Debug, Args)]
pub struct SchemaOf {
    /// Name of the report, such as yerc.status [default: list all names]
    #[arg(add = ValueKind::Schema)]
    id: Option<String>,
}

impl SchemaOf {
    /// Prints the schema.
    pub fn run(self, run: &Run) -> Result<(), Failure> {
        let all = all();
        let Some(id) = self.id else {
            let names: String = all.iter().map(|entry| format!("{}\n", entry.id)).collect();
            return run.screen.data(&names);
        };
        let Some(entry) = all.iter().find(|entry| entry.id == id) else {
            let failure = Failure::usage(format!("unknown report '{id}'"));
            return Err(match nearest(&id, all.iter().map(|entry| entry.id)) {
                Some(near) => failure.hint(format!("did you mean '{near}'?")),
                None => failure.hint("list the reports: `armctl schema`"),
            });
        };
        run.screen.json(&json!((entry.schema)()))
    }
}

/// Schemas of all reports, of the envelope, and of its failure and dry-run data.
pub fn all() -> Vec<SchemaEntry> {
    let mut all: Vec<SchemaEntry> = FAMILIES.iter().flat_map(|face| face.schemas()).collect();
    all.extend(Overview::schemas());
    all.extend(shared::schemas());
    all.extend(names::schemas());
    all.extend(Backup::<Fleet>::schemas());
    all.extend(Restore::<Fleet>::schemas());
    all.extend(Diff::<Fleet>::schemas());
    let mut others = tools::schemas();
    others.extend([
        SchemaEntry::of::<Checked>("backup.check"),
        SchemaEntry::of::<DryRun>("dry-run"),
        SchemaEntry::of::<Envelope>("envelope"),
        SchemaEntry::of::<ErrorBody>("failure"),
        SchemaEntry::of::<robots::entry::Changed>("robots.add"),
        SchemaEntry::of::<robots::check::CheckReport>("robots.check"),
        SchemaEntry::of::<robots::discover::Discovered>("robots.discover"),
        SchemaEntry::of::<robots::entry::WasChosen>("robots.default"),
        SchemaEntry::of::<robots::edit::Edited>("robots.edit"),
        SchemaEntry::of::<robots::List>("robots.list"),
        SchemaEntry::of::<robots::edit::InventoryPath>("robots.path"),
        SchemaEntry::of::<robots::entry::Changed>("robots.remove"),
        SchemaEntry::of::<robots::entry::Renamed>("robots.rename"),
        SchemaEntry::of::<robots::entry::WasSet>("robots.set"),
        SchemaEntry::of::<robots::Shown>("robots.show"),
        #[cfg(feature = "plant")]
        SchemaEntry::of::<metrics::Listening>("serve.metrics"),
        SchemaEntry::of::<session::Closed>("session.close"),
        SchemaEntry::of::<session::Sessions>("session.list"),
        SchemaEntry::of::<Opened>("session.open"),
        SchemaEntry::of::<robots::entry::Changed>("setup"),
        SchemaEntry::of::<tools::Simulators>("sim"),
    ]);
    #[cfg(feature = "plant")]
    others.extend(publish::schemas());
    others.sort_unstable_by_key(|entry| entry.id);
    all.extend(others);
    all
}

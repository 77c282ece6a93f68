//! `armctl schema ID`: the JSON Schema of a report.

use clap::Args;
use serde_json::json;

use crate::command::ValueKind;
use crate::command::families::FAMILIES;
use crate::command::fleet::status::Overview;
use crate::command::frame::dry_run::DryRun;
use crate::command::frame::run::Run;
use crate::command::{CommandSet, SchemaEntry};
use crate::controller::nearest::nearest;
use crate::failure::Failure;
use crate::output::envelope::{Envelope, ErrorBody};

/// Prints the schema of `data` in the envelope, or the names of all reports.
///
/// Beside those of the commands there are `envelope`, what `--json` prints around them; `failure`, its `error`; and
/// `dry-run`, the data of every command under --dry-run.
#[derive(Debug, Args)]
pub struct SchemaOf {
    /// The command, such as yerc.status; without it, all names
    #[arg(add = ValueKind::Schema)]
    id: Option<String>,
}

impl SchemaOf {
    /// Does it.
    pub fn run(self, run: &Run) -> Result<(), Failure> {
        let all = all();
        let Some(id) = self.id else {
            let names: String = all.iter().map(|entry| format!("{}\n", entry.id)).collect();
            return run.screen.data(&names);
        };
        let Some(entry) = all.iter().find(|entry| entry.id == id) else {
            let failure = Failure::usage(format!("there is no report '{id}'"));
            return Err(match nearest(&id, all.iter().map(|entry| entry.id)) {
                Some(near) => failure.hint(format!("did you mean '{near}'?")),
                None => failure.hint("`armctl schema` lists them"),
            });
        };
        run.screen.json(&json!((entry.schema)()))
    }
}

/// The schemas of all reports, of the envelope and of what it holds when there is none.
pub fn all() -> Vec<SchemaEntry> {
    let mut all: Vec<SchemaEntry> = FAMILIES.iter().flat_map(|face| face.schemas()).collect();
    all.extend(<Overview as CommandSet>::schemas());
    all.extend(<crate::command::fleet::backup::Backup as CommandSet>::schemas());
    all.extend(<crate::command::fleet::backup::Restore as CommandSet>::schemas());
    all.extend(<crate::command::fleet::backup::Diff as CommandSet>::schemas());
    all.extend([
        SchemaEntry::of::<crate::command::fleet::backup::Checked>("backup.check"),
        SchemaEntry::of::<crate::command::common::decode::toyo::Lines>("decode.toyo"),
        SchemaEntry::of::<
            crate::command::common::decode::capture::Capture<crate::command::common::decode::toyo::FieldRow>,
        >("decode.toyo.capture"),
        SchemaEntry::of::<crate::command::common::decode::yerc::Frames>("decode.yerc"),
        SchemaEntry::of::<
            crate::command::common::decode::capture::Capture<crate::command::common::decode::yerc::FieldRow>,
        >("decode.yerc.capture"),
        SchemaEntry::of::<crate::command::common::decode::yrcx::Explained>("decode.yrcx"),
        SchemaEntry::of::<
            crate::command::common::decode::capture::Capture<crate::command::common::decode::yrcx::FieldRow>,
        >("decode.yrcx.capture"),
        SchemaEntry::of::<DryRun>("dry-run"),
        SchemaEntry::of::<Envelope>("envelope"),
        SchemaEntry::of::<crate::command::common::explain::ToyoCode>("explain.toyo"),
        SchemaEntry::of::<crate::command::common::explain::Codes>("explain.yerc"),
        SchemaEntry::of::<crate::command::common::explain::YrcxAlarm>("explain.yrcx"),
        SchemaEntry::of::<ErrorBody>("failure"),
        SchemaEntry::of::<crate::command::fleet::robots::Changed>("robots.add"),
        SchemaEntry::of::<crate::command::fleet::robots::check::CheckReport>("robots.check"),
        SchemaEntry::of::<crate::command::fleet::robots::discover::Discovered>("robots.discover"),
        SchemaEntry::of::<crate::command::fleet::robots::List>("robots.list"),
        SchemaEntry::of::<crate::command::fleet::robots::Changed>("robots.remove"),
        SchemaEntry::of::<crate::command::fleet::robots::Shown>("robots.show"),
        SchemaEntry::of::<crate::command::fleet::session::Closed>("session.close"),
        SchemaEntry::of::<crate::command::fleet::session::Sessions>("session.list"),
        SchemaEntry::of::<crate::command::frame::background::Opened>("session.open"),
        SchemaEntry::of::<crate::command::common::sim::toyo::Serving>("sim.toyo"),
        SchemaEntry::of::<crate::command::common::sim::yerc::Serving>("sim.yerc"),
        SchemaEntry::of::<crate::command::common::sim::yrcx::Serving>("sim.yrcx"),
    ]);
    all
}

//! `armctl schema ID`: the JSON Schema of a report.

use clap::Args;
use serde_json::json;

use crate::command::ValueKind;
use crate::command::dry_run::DryRun;
use crate::command::overview::{Fleet, Overview};
use crate::command::run::Run;
use crate::command::toyo::{self, Toyo};
use crate::command::yerc::{self, Yerc};
use crate::command::yrcx::{self, Yrcx};
use crate::command::{Noun, SchemaEntry};
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
    pub(super) fn run(self, run: &Run) -> Result<(), Failure> {
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
    let mut all = <Yerc as Noun<yerc::Family>>::schemas();
    all.extend(<Yrcx as Noun<yrcx::Family>>::schemas());
    all.extend(<Toyo as Noun<toyo::Family>>::schemas());
    all.extend(<Overview as Noun<Fleet>>::schemas());
    all.extend(<super::backup::Backup as Noun<Fleet>>::schemas());
    all.extend(<super::backup::Restore as Noun<Fleet>>::schemas());
    all.extend(<super::backup::Diff as Noun<Fleet>>::schemas());
    all.push(SchemaEntry::of::<super::backup::Checked>("backup.check"));
    all.extend(super::decode::Decode::schemas());
    all.extend([SchemaEntry::of::<DryRun>("dry-run"), SchemaEntry::of::<Envelope>("envelope")]);
    all.extend(super::explain::Explain::schemas());
    all.extend([
        SchemaEntry::of::<ErrorBody>("failure"),
        SchemaEntry::of::<super::robots::Changed>("robots.add"),
        SchemaEntry::of::<super::robots::check::CheckReport>("robots.check"),
        SchemaEntry::of::<super::robots::discover::Discovered>("robots.discover"),
        SchemaEntry::of::<super::robots::List>("robots.list"),
        SchemaEntry::of::<super::robots::Changed>("robots.remove"),
        SchemaEntry::of::<super::robots::Shown>("robots.show"),
        SchemaEntry::of::<super::session::Closed>("session.close"),
        SchemaEntry::of::<super::session::Sessions>("session.list"),
        SchemaEntry::of::<super::session::Opened>("session.open"),
    ]);
    all.extend(super::sim::Sim::schemas());
    all
}

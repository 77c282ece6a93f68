//! Completion values by kind.

use std::ffi::OsString;

use clap::parser::ValueSource;
use clap::{ArgMatches, Args as _, Command, FromArgMatches as _};

use super::live;
use crate::app::prepare::{Need, sources};
use crate::command::about::{help, schema};
use crate::command::families::{self, FAMILIES};
use armctl_frame::Candidate;
use armctl_frame::backup::manifest;
use armctl_frame::flags::Globals;
use armctl_frame::prelude::*;
use armctl_frame::settings::Sources;
use armctl_frame::settings::inventory::{Inventory, Location};
use armctl_frame::value_kind::Named;
use armctl_transport::session::location::{SessionFolder, SessionPath};

/// Data from the rest of the line that the values depend on: the selected robots and the settings.
#[derive(Debug)]
pub(super) struct Context {
    globals: Option<Globals>,
    /// Whether other lines run in this process.
    is_among: bool,
    /// Whether a connection to a controller is allowed without a session.
    connects: bool,
    /// Time limit for reading values from a controller.
    time_limit: Duration,
}

impl Context {
    /// Creates the context from the parsed part of a line. A mistake in a flag of the command does not affect the
    /// global flags.
    pub fn new(matches: &ArgMatches, (is_among, connects): (bool, bool), time_limit: Duration) -> Self {
        let command = Globals::augment_args(Command::new("armctl"));
        let value_of_argument = command.get_arguments().flat_map(|argument| {
            let id = argument.get_id().as_str();
            let long = argument.get_long().unwrap_or_default();
            let is_given = matches.value_source(id) == Some(ValueSource::CommandLine);
            let raw = if is_given { matches.get_raw(id) } else { None };
            let takes_value = argument.get_action().takes_values();
            raw.into_iter().flatten().map(move |value| {
                let mut word = OsString::from(format!("--{long}"));
                if takes_value {
                    word.push("=");
                    word.push(value);
                }
                word
            })
        });
        let words: Vec<_> = std::iter::once("armctl".into()).chain(value_of_argument).collect();
        let parsed = command.try_get_matches_from(words);
        let globals = parsed.and_then(|matches| Globals::from_arg_matches(&matches)).ok();
        Self { globals, is_among, connects, time_limit }
    }

    /// Whether a connection to a controller is allowed.
    pub fn connects(&self) -> bool {
        self.connects
    }

    fn parse_sources(&self) -> Option<Sources> {
        sources(self.globals.clone()?, Need::Inventory, self.is_among).ok()
    }

    fn inventory(&self) -> Option<Inventory> {
        let named = self.globals.as_ref()?.config.clone();
        let named = named.or_else(|| std::env::var_os("ARMCTL_CONFIG").filter(|path| !path.is_empty()).map(Into::into));
        Inventory::load(&Location::find(named)).ok()
    }
}

/// Values of a kind that start with the typed text.
pub(super) fn of(kind: ValueKind, typed: &str, context: &Context) -> Vec<Candidate> {
    matching_candidates(typed, all(kind, context))
}

/// Returns the candidates with the typed prefix. If there are none, upper and lower case are ignored, because many
/// names are in capital letters.
fn matching_candidates(typed: &str, all: Vec<Candidate>) -> Vec<Candidate> {
    let begins = |candidate: &&Candidate| candidate.value.starts_with(typed);
    let exact: Vec<Candidate> = all.iter().filter(begins).cloned().collect();
    if !exact.is_empty() {
        return exact;
    }
    let begins = |value: &str| value.get(..typed.len()).is_some_and(|start| start.eq_ignore_ascii_case(typed));
    all.into_iter().filter(|candidate| begins(&candidate.value)).collect()
}

fn all(kind: ValueKind, context: &Context) -> Vec<Candidate> {
    match kind {
        ValueKind::Robot => robots(context),
        ValueKind::RobotOrUrl => [robots(context), urls()].concat(),
        ValueKind::Tag => tags(context),
        ValueKind::Url => urls(),
        ValueKind::Family => FAMILIES.map(|face| Candidate::new(face.family.name(), face.title)).into(),
        ValueKind::HelpWord => help::topics().map(|(name, about)| Candidate::new(name, about)).collect(),
        ValueKind::Schema => schema::all().iter().map(|entry| Candidate::new(entry.id, "")).collect(),
        ValueKind::Code(family) => {
            (families::of(family).codes)().into_iter().map(|(code, name)| Candidate::new(code, name)).collect()
        }
        ValueKind::Session => sessions(),
        ValueKind::Backup => backups(),
        ValueKind::Listed(candidates) => candidates(),
        ValueKind::Named(family, Named { kinds, endings, listed }) => {
            let robots =
                context.parse_sources().and_then(|sources| sources.robots(Some(family)).ok()).unwrap_or_default();
            let named = endings.iter().flat_map(|ending| names::candidates(&robots, kinds, ending));
            named.chain(listed()).collect()
        }
        ValueKind::FromRobot(family, ask) => {
            let (time_limit, connects) = (context.time_limit, context.connects);
            context
                .parse_sources()
                .map_or_else(Vec::new, |sources| live::values(family, ask, &sources, (time_limit, connects)))
        }
    }
}

fn robots(context: &Context) -> Vec<Candidate> {
    let inventory = context.inventory().unwrap_or_default();
    inventory.robots.iter().map(|robot| Candidate::new(&robot.name, robot.target.url())).collect()
}

fn tags(context: &Context) -> Vec<Candidate> {
    let inventory = context.inventory().unwrap_or_default();
    let mut tags: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for robot in &inventory.robots {
        for tag in robot.all_tags() {
            tags.entry(tag).or_default().push(&robot.name);
        }
    }
    tags.into_iter().map(|(tag, robots)| Candidate::new(tag, robots.join(", "))).collect()
}

/// Prefixes of target URLs.
fn urls() -> Vec<Candidate> {
    let simulator = ("sim:".to_owned(), "the built-in simulator");
    let urls = FAMILIES.iter().flat_map(|face| (face.urls)());
    std::iter::once(simulator).chain(urls).map(|(url, about)| Candidate::new(url, about).incomplete()).collect()
}

/// Returns the subfolders of the current folder that contain a backup.
fn backups() -> Vec<Candidate> {
    let folders = manifest::folders_in(Path::new("."));
    let name = |folder: &PathBuf| Some(folder.file_name()?.to_str()?.to_owned());
    folders.iter().filter_map(name).map(|name| Candidate::new(name, "")).collect()
}

/// Robots with an open session.
fn sessions() -> Vec<Candidate> {
    let spots = SessionFolder::find().ok().flatten().and_then(|place| place.locations().ok()).unwrap_or_default();
    spots.iter().filter_map(SessionPath::owner).map(|info| Candidate::new(info.robot, info.target)).collect()
}

//! Family interface for the rest of the program. Each family implements it in `face.rs`;
//! `command/families.rs` lists them.

pub mod explain;
pub mod family_command;
pub mod layers;
pub mod overview;
pub mod registration;
pub mod sample;
pub mod shared_commands;
pub mod teach_panel;
pub mod tool;

use std::any::Any;
use std::ffi::OsString;

use clap::ArgMatches;

use self::family_command::FamilyLine;
pub use self::layers::Layer;
pub use self::overview::OverviewReport;
pub use self::registration::Declaration;
pub use self::sample::{Detail, Sample, Traffic};
use self::shared_commands::SharedVerb;
pub use self::teach_panel::Panel;
use self::tool::{Tool, ToolKind};
use super::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use super::robot::alarm::Alarm;
use super::serve::NamedServer;
use crate::prelude::basics::*;
use crate::{Access, AnyCommand, AnyContext, Connection, Driver, Outcome, SchemaEntry};
use armctl_transport::session::host::Guard;
use armctl_transport::session::host::shared_link::SharedLink;

/// Interface of a family for the rest of the program; [`registration`] derives it from the declaration.
pub struct Face {
    /// Family.
    pub family: Family,
    /// Manufacturers and models, for completion.
    pub title: &'static str,
    /// Prefixes of the family's target URLs, with the text that can follow each prefix.
    pub urls: fn() -> Vec<(String, &'static str)>,
    /// Codes that `explain` supports, with their names.
    pub codes: fn() -> Vec<(String, String)>,
    /// Whether `explain` supports a code. For an unknown code: whether it has the form of a code of this family.
    pub explains: fn(code: &str) -> bool,
    /// Help topic `NAME-setup`: summary and text.
    pub setup: (&'static str, &'static str),
    /// Additional help topics: name, summary and text.
    pub topics: fn() -> Vec<(&'static str, &'static str, String)>,
    /// URL of the simulator that `sim` starts without arguments.
    pub simulator: &'static str,
    /// Nouns whose `list` has values that a backup does not contain.
    pub unsaved: &'static [&'static str],
    /// Example of a simulator start state.
    pub start_state: &'static str,

    /// Command of the family with all subcommands and arguments.
    pub augment: fn(clap::Command) -> clap::Command,
    /// Command of the family with only the named subcommands.
    pub lay_out: fn(clap::Command, &IsNamed<'_>) -> clap::Command,
    /// Parses the arguments after the name of the family.
    pub read: fn(&mut ArgMatches) -> Result<FamilyLine, clap::Error>,
    /// Schemas of all reports of the family.
    pub schemas: fn() -> Vec<SchemaEntry>,

    /// Serves a simulator with these arguments of `armctl sim FAMILY`.
    pub serve: fn(name: String, arguments: Vec<OsString>) -> Work<'static, NamedServer>,
    /// Start state of the family's simulator with the data of a backup.
    pub twin: fn(folder: &Path) -> Result<Box<dyn Any>>,

    /// Dissector of the protocol for Wireshark, in Lua, without the functions that all families use.
    pub dissector: fn() -> String,

    /// Tool of the family of this kind.
    pub tool: fn(ToolKind) -> Tool,

    /// Driver of the family's robots.
    pub driver: &'static Driver,
    /// Summary for `status`.
    pub overview: for<'a> fn(&'a mut dyn Connection) -> Work<'a, OverviewReport>,
    /// Active alarms, for `alarm list`.
    pub alarms: for<'a> fn(&'a mut dyn Connection) -> Work<'a, Vec<Alarm>>,
    /// Command of the family for a shared verb.
    pub shared: fn(SharedVerb) -> Box<dyn AnyCommand>,
    /// Keys of `armctl teach`.
    pub panel: Panel,
    /// Layers of `robots check`.
    pub check: for<'a> fn(&'a Robot, Access, &'a Screen) -> Work<'a, Vec<Layer>>,
    /// Opens a connection for repeated reads.
    pub watch: for<'a> fn(&'a Robot, Access, &'a Screen) -> Work<'a, Box<dyn Watch>>,

    /// Opens a link for a session.
    pub open_session_link: for<'a> fn(&'a Robot, &'a Access, &'a Screen) -> Work<'a, HeldLink>,
    /// Filter of the requests that may reach a read-only robot through a session.
    pub guard: Guard,
    /// Whether a session records the traffic; otherwise each command records its own traffic.
    pub session_records: bool,
    /// Whether an open session commands the controller. A read-only robot does not allow such a session.
    pub session_commands: bool,

    /// Risk of reading all data of a controller.
    pub backup_risk: fn(&Robot) -> Risk,
    /// Makes a backup.
    pub back_up: for<'a> fn(AnyContext<'a>, SaveOptions) -> Work<'a, BackupReport>,
    /// Restores a backup.
    pub restore: for<'a> fn(AnyContext<'a>, &'a RestoreSelection) -> Work<'a, RestoreReport>,
}

/// Whether a command line contains the name of a subcommand.
pub type IsNamed<'a> = dyn Fn(&str) -> bool + 'a;

/// Work of a family that can fail.
pub type Work<'a, T> = LocalBoxFuture<'a, Result<T>>;

/// Repeated reads of a robot, for the poller.
pub trait Watch {
    /// Reads once.
    fn look(&mut self, detail: Detail) -> Work<'_, Sample>;
    /// Runs a command of the family on the same connection. Only reads are sent.
    fn ask<'a>(
        &'a mut self,
        command: &'a dyn AnyCommand,
        robot: &'a Robot,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Outcome>;
    /// Traffic counted on the connection so far.
    fn traffic(&mut self) -> Traffic;
    /// Closes the connection.
    fn close(self: Box<Self>, screen: &Screen) -> Work<'_, ()>;
}

/// A link for a session.
pub struct HeldLink {
    /// The link.
    pub held: SharedLink,
    /// Action after the link is closed: the end of the trace.
    pub finish: Option<Box<dyn FnOnce() -> Result<()>>>,
}

impl From<SharedLink> for HeldLink {
    fn from(held: SharedLink) -> Self {
        Self { held, finish: None }
    }
}

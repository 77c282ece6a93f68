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
use std::path::Path;

use clap::ArgMatches;
use futures_util::future::LocalBoxFuture;

use self::family_command::FamilyLine;
use self::layers::Layer;
use self::overview::OverviewReport;
use self::sample::{Detail, Sample, Traffic};
use self::shared_commands::SharedVerb;
use self::teach_panel::Panel;
use self::tool::{Tool, ToolKind};
use super::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use super::robot::alarm::Alarm;
use super::serve::NamedServer;
use crate::prelude::basics::*;
use crate::settings::target::Family;
use crate::{Access, AnyCommand, AnyContext, Connection, Driver, Outcome, SchemaEntry};
use armctl_transport::session::host::Guard;
use armctl_transport::session::host::shared_link::SharedLink;

/// Interface of a family for the rest of the program; [`registration`] derives it from the declaration.
pub trait Face: Sync {
    /// Family.
    fn family(&self) -> Family;
    /// Manufacturers and models, for completion.
    fn title(&self) -> &'static str;
    /// Prefixes of the family's target URLs, with the text that can follow each prefix.
    fn urls(&self) -> Vec<(String, &'static str)>;
    /// Codes that `explain` supports, with their names.
    fn codes(&self) -> Vec<(String, String)>;
    /// Whether `explain` supports a code. For an unknown code: whether it has the form of a code of this family.
    fn explains(&self, code: &str) -> bool;
    /// Help topic `NAME-setup`: summary and text.
    fn setup(&self) -> (&'static str, &'static str);
    /// Additional help topics: name, summary and text.
    fn topics(&self) -> Vec<(&'static str, &'static str, String)>;
    /// URL of the simulator that `sim` starts without arguments.
    fn simulator(&self) -> &'static str;
    /// Nouns whose `list` has values that a backup does not contain.
    fn unsaved(&self) -> &'static [&'static str];
    /// Example of a simulator start state.
    fn start_state(&self) -> &'static str;

    /// Command of the family with all subcommands and arguments.
    fn augment(&self, command: clap::Command) -> clap::Command;
    /// Command of the family with only the named subcommands.
    fn lay_out(&self, command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command;
    /// Parses the arguments after the name of the family.
    fn read(&self, matches: &mut ArgMatches) -> Result<FamilyLine, clap::Error>;
    /// Schemas of all reports of the family.
    fn schemas(&self) -> Vec<SchemaEntry>;

    /// Serves a simulator with these arguments of `armctl sim FAMILY`.
    fn serve(&self, name: String, arguments: Vec<OsString>) -> LocalBoxFuture<'static, Result<NamedServer, Failure>>;
    /// Start state of the family's simulator with the data of a backup.
    fn twin(&self, folder: &Path) -> Result<Box<dyn Any>, Failure>;

    /// Dissector of the protocol for Wireshark, in Lua, without the functions that all families use.
    fn dissector(&self) -> String;

    /// Tool of the family of this kind.
    fn tool(&self, kind: ToolKind) -> Tool;

    /// Driver of the family's robots.
    fn driver(&self) -> &'static dyn Driver;
    /// Summary for `status`.
    fn overview<'a>(&self, connection: &'a mut dyn Connection) -> LocalBoxFuture<'a, Result<OverviewReport, Failure>>;
    /// Active alarms, for `alarm list`.
    fn alarms<'a>(&self, connection: &'a mut dyn Connection) -> LocalBoxFuture<'a, Result<Vec<Alarm>, Failure>>;
    /// Command of the family for a shared verb.
    fn shared(&self, verb: SharedVerb) -> Box<dyn AnyCommand>;
    /// Keys of `armctl teach`.
    fn panel(&self) -> Panel;
    /// Layers of `robots check`.
    fn check<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Vec<Layer>, Failure>>;
    /// Opens a connection for repeated reads.
    fn watch<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Watch>, Failure>>;

    /// Opens a link for a session.
    fn open_session_link<'a>(
        &self,
        robot: &'a Robot,
        access: &'a Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<HeldLink, Failure>>;
    /// Words of the family's stop command, after the name of the family.
    fn stop(&self) -> &'static [&'static str];
    /// Filter of the requests that may reach a read-only robot through a session.
    fn guard(&self) -> Guard;
    /// Whether a session records the traffic; otherwise each command records its own traffic.
    fn session_records(&self) -> bool;
    /// Whether an open session commands the controller. A read-only robot does not allow such a session.
    fn session_commands(&self) -> bool;

    /// Risk of reading all data of a controller.
    fn backup_risk(&self, robot: &Robot) -> Risk;
    /// Makes a backup.
    fn back_up<'a>(
        &self,
        context: AnyContext<'a>,
        making: SaveOptions,
    ) -> LocalBoxFuture<'a, Result<BackupReport, Failure>>;
    /// Restores a backup.
    fn restore<'a>(
        &self,
        context: AnyContext<'a>,
        restoring: &'a RestoreSelection,
    ) -> LocalBoxFuture<'a, Result<RestoreReport, Failure>>;
}

/// Repeated reads of a robot, for the poller.
pub trait Watch {
    /// Reads once.
    fn look(&mut self, detail: Detail) -> LocalBoxFuture<'_, Result<Sample, Failure>>;
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
    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>>;
}

/// A link for a session.
pub struct HeldLink {
    /// The link.
    pub held: SharedLink,
    /// Action after the link is closed: the end of the trace.
    pub finish: Option<Box<dyn FnOnce() -> Result<(), Failure>>>,
}

impl From<SharedLink> for HeldLink {
    fn from(held: SharedLink) -> Self {
        Self { held, finish: None }
    }
}

//! What the rest of the house may ask of a family. Each has its own in `face.rs`; [`families`](super::families) lists them.

pub mod declared;
pub mod explain;
pub mod layers;
pub mod overview;
pub mod panel;
pub mod sample;
pub mod shared;
pub mod tool;
pub mod words;

use clap::ArgMatches;
use futures_util::future::LocalBoxFuture;

use self::layers::Layer;
use self::overview::OverviewReport;
use self::panel::Panel;
use self::sample::{Detail, Sample, Traffic};
use self::shared::SharedVerb;
use self::tool::{Tool, ToolKind};
use self::words::Typed;
use super::backup::{BackedUp, Making, Restored, Restoring};
use super::frame::{Access, AnyCommand, AnyContext, Connection, Driver, Outcome, SchemaEntry};
use super::robot::alarm::Alarm;
use crate::controller::Risk;
use crate::failure::Failure;
use crate::output::Screen;
use crate::settings::{Robot, target::Family};
use crate::transport::session::host::Guard;
use crate::transport::session::host::held::Held;

/// A family, as the rest of the house sees it: [`declared`] makes it of what the family says of itself.
pub trait Face: Sync {
    /// Which it is.
    fn family(&self) -> Family;
    /// Makers and models, as a completion shows them.
    fn title(&self) -> &'static str;
    /// How its target URLs begin, with what follows.
    fn urls(&self) -> Vec<(String, &'static str)>;
    /// Codes and words that `explain` explains, with their names.
    fn codes(&self) -> Vec<(String, String)>;
    /// The topic `NAME-setup` of `help`: a line about it, and its text.
    fn setup(&self) -> (&'static str, &'static str);
    /// Further topics of `help`: the name, a line about it, and its text.
    fn topics(&self) -> Vec<(&'static str, &'static str, String)>;
    /// The URL of the simulator that `sim` serves without arguments.
    fn simulator(&self) -> &'static str;
    /// The start state of a simulator, as an example.
    fn start_state(&self) -> &'static str;

    /// Its word with all that can stand behind it.
    fn augment(&self, command: clap::Command) -> clap::Command;
    /// Its word with as much as is named.
    fn lay_out(&self, command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command;
    /// What stands behind its word.
    fn read(&self, matches: &mut ArgMatches) -> Result<Typed, clap::Error>;
    /// The schemas of all its reports.
    fn schemas(&self) -> Vec<SchemaEntry>;

    /// What it does behind a common word.
    fn tool(&self, kind: ToolKind) -> Tool;

    /// What opens connections to its robots.
    fn driver(&self) -> &'static dyn Driver;
    /// A line for `status`.
    fn overview<'a>(&self, connection: &'a mut dyn Connection) -> LocalBoxFuture<'a, Result<OverviewReport, Failure>>;
    /// The alarms that are present, for `alarm list`.
    fn alarms<'a>(&self, connection: &'a mut dyn Connection) -> LocalBoxFuture<'a, Result<Vec<Alarm>, Failure>>;
    /// What it does behind a verb that every family has.
    fn shared(&self, verb: SharedVerb) -> Box<dyn AnyCommand>;
    /// The keys of `armctl teach`.
    fn panel(&self) -> Panel;
    /// What `robots check` finds.
    fn check<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Vec<Layer>, Failure>>;
    /// Connects to look again and again.
    fn watch<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Watch>, Failure>>;

    /// Opens a link for a session to hold.
    fn hold<'a>(
        &self,
        robot: &'a Robot,
        access: &'a Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<HeldLink, Failure>>;
    /// The words of the command that stops a robot, behind the word of the family.
    fn stop(&self) -> &'static [&'static str];
    /// What may pass to a read-only robot, whoever sends it through a session.
    fn guard(&self) -> Guard;
    /// Whether a session records what passes; otherwise each command does.
    fn session_records(&self) -> bool;
    /// Whether a session commands the controller by being there, which a read-only robot does not allow.
    fn session_commands(&self) -> bool;

    /// What it takes to read all of a controller.
    fn backup_risk(&self, robot: &Robot) -> Risk;
    /// Makes a backup.
    fn back_up<'a>(&self, context: AnyContext<'a>, making: Making) -> LocalBoxFuture<'a, Result<BackedUp, Failure>>;
    /// Writes a backup back.
    fn restore<'a>(
        &self,
        context: AnyContext<'a>,
        restoring: &'a Restoring,
    ) -> LocalBoxFuture<'a, Result<Restored, Failure>>;
}

/// Looks at a robot again and again, for the poller.
pub trait Watch {
    /// Looks once.
    fn look(&mut self, detail: Detail) -> LocalBoxFuture<'_, Result<Sample, Failure>>;
    /// Runs a command of the family over the same connection. Nothing but reads can leave.
    fn ask<'a>(
        &'a mut self,
        command: &'a dyn AnyCommand,
        robot: &'a Robot,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Outcome>;
    /// What was counted on the connection so far.
    fn traffic(&mut self) -> Traffic;
    /// Closes the connection.
    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>>;
}

/// A link that a session can hold.
pub struct HeldLink {
    /// The link.
    pub held: Held,
    /// What is to be done once it is closed: the end of a record.
    pub finish: Option<Box<dyn FnOnce() -> Result<(), Failure>>>,
}

impl From<Held> for HeldLink {
    fn from(held: Held) -> Self {
        Self { held, finish: None }
    }
}

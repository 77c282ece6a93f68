//! Declaration of a family in its own types. [`Registered`] converts it to the [`Face`] for the rest of the program.

use std::any::Any;
use std::ffi::OsString;
use std::marker::PhantomData;
use std::path::Path;

use clap::{ArgMatches, FromArgMatches as _, Subcommand};
use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::explain::{Explain, RecordedAlarm};
use super::family_command::{self, FamilyLine};
use super::layers::Layer;
use super::overview::OverviewReport;
use super::sample::{Detail, Sample, Traffic};
use super::shared_commands::{self, CommonReport, SharedVerb};
use super::teach_panel::Panel;
use super::tool::{Tool, ToolKind};
use super::{Face, HeldLink, Watch};
use crate::backup::family_backup::Backups;
use crate::backup::{BackupReport, RestoreReport, RestoreSelection, SaveOptions};
use crate::confirmation::Confirmer;
use crate::connection;
use crate::decode::Decode;
use crate::prelude::basics::*;
use crate::robot::alarm::Alarm;
use crate::serve::{NamedServer, Serve, Started};
use crate::settings::alarms::{Alarms, Origin};
use crate::settings::target;
use crate::{Access, AnyCommand, AnyContext, Command, CommandSet, Driver, FamilyArguments, Outcome, SchemaEntry};
use armctl_controller::simulator::recording::Replayable;
use armctl_transport::session::host::Guard;

/// A family, declared in its `face.rs`.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Declaration: Backups {
    /// Commands after the name of the family.
    type Commands: CommandSet + Subcommand;
    /// `armctl decode`.
    type Decode: Decode + Args + 'static;
    /// `armctl explain`.
    type Explain: Explain + Args + 'static;
    /// Command that lists active alarms.
    type Alarms: Command<Family = Self, Report: RecordedAlarm> + Args;
    /// Command that lists past alarms.
    type AlarmHistory: Command<Family = Self, Report: RecordedAlarm + CommonReport> + Args;
    /// Command that resets alarms.
    type AlarmReset: Command<Family = Self, Report: CommonReport> + Args;
    /// Command that reads the position.
    type Position: Command<Family = Self, Report: CommonReport> + Args;
    /// Command that stops the robot.
    type Stop: Command<Family = Self, Report: CommonReport> + 'static;
    /// `armctl sim`.
    type Serve: Serve + Args + 'static;
    /// Start state of the simulator.
    type Start: Replayable + 'static;
    /// Poller for live views.
    type Poller: Poller<Family = Self>;

    /// Family.
    const NAME: target::Family;
    /// See [`Face::title`].
    const TITLE: &'static str;
    /// Help text of the family's command.
    const ABOUT: &'static str;
    /// Text below the help of the family's command.
    const AFTER_HELP: &'static str;
    /// See [`Face::setup`].
    const SETUP: (&'static str, &'static str);
    /// See [`Face::unsaved`].
    const UNSAVED: &'static [&'static str];
    /// See [`Face::start_state`].
    const START_STATE: &'static str;
    /// See [`Face::guard`].
    const GUARD: Guard;
    /// See [`Face::panel`].
    const PANEL: Panel;
    /// See [`Face::session_records`].
    const SESSION_RECORDS: bool = false;
    /// See [`Face::session_commands`].
    const SESSION_COMMANDS: bool = false;

    /// See [`Face::urls`].
    fn urls() -> Vec<(String, &'static str)>;
    /// See [`Face::codes`].
    fn codes() -> Vec<(String, String)>;
    /// See [`Face::dissector`].
    fn dissector() -> String;
    /// Start state of the simulator with the data of a backup.
    fn twin(folder: &Path) -> Result<Self::Start, Failure>;
    /// See [`Face::topics`].
    fn topics() -> Vec<(&'static str, &'static str, String)> {
        Vec::new()
    }

    /// Adds arguments between the name of the family and a command.
    fn arguments(command: clap::Command) -> clap::Command {
        command
    }
    /// Reads the arguments between the name of the family and a command.
    fn read_arguments(_matches: &mut ArgMatches) -> Result<FamilyArguments, clap::Error> {
        Ok(FamilyArguments::default())
    }
    /// Stop command, equivalent to the words of [`STOP`](connection::Family::STOP).
    fn stop_command() -> Self::Stop;
    /// Active alarms, the latest first, as far as they can be read.
    async fn alarms(link: &mut Self::Link) -> Result<Vec<Alarm>, Failure>;
    /// Traffic counted on a link so far.
    fn traffic(link: &Self::Link) -> Traffic;
    /// Summary for `status`.
    async fn overview(link: &mut Self::Link) -> Result<OverviewReport, Failure>;
    /// Layers of `robots check`.
    async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>, Failure>;
    /// Opens a link for a session.
    async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink, Failure>;
}

/// Poller that reads a robot repeatedly.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Poller: Sized + 'static {
    /// Family of the robot.
    type Family: Declaration;

    /// Connects.
    async fn open(robot: &Robot, access: Access, screen: &Screen) -> Result<Self, Failure>;
    /// Reads once.
    async fn look(&mut self, detail: Detail) -> Result<Sample, Failure>;
    /// Connection, for a read-only command.
    fn link(&mut self) -> &mut <Self::Family as connection::Family>::Link;
    /// Closes the connection.
    async fn close(self, screen: &Screen) -> Result<(), Failure>;
}

/// [`Face`] of a declared family.
pub struct Registered<F>(PhantomData<fn() -> F>);

impl<F> Registered<F> {
    /// The only value.
    pub const FACE: Self = Self(PhantomData);
}

impl<F: Declaration> Face for Registered<F> {
    fn family(&self) -> target::Family {
        F::NAME
    }

    fn title(&self) -> &'static str {
        F::TITLE
    }

    fn urls(&self) -> Vec<(String, &'static str)> {
        F::urls()
    }

    fn codes(&self) -> Vec<(String, String)> {
        F::codes()
    }

    fn explains(&self, code: &str) -> bool {
        let command = F::Explain::augment_args(clap::Command::new("explain").no_binary_name(true));
        let parsed = command.try_get_matches_from([code]).and_then(|matches| F::Explain::from_arg_matches(&matches));
        parsed.is_ok_and(|explain| explain.explain(&Alarms::default(), Origin::any(F::NAME)).is_ok())
    }

    fn setup(&self) -> (&'static str, &'static str) {
        F::SETUP
    }

    fn topics(&self) -> Vec<(&'static str, &'static str, String)> {
        F::topics()
    }

    fn simulator(&self) -> &'static str {
        F::Serve::TARGET
    }

    fn unsaved(&self) -> &'static [&'static str] {
        F::UNSAVED
    }

    fn start_state(&self) -> &'static str {
        F::START_STATE
    }

    fn augment(&self, command: clap::Command) -> clap::Command {
        family_command::augment::<F::Commands>(F::arguments(command), F::ABOUT).after_help(F::AFTER_HELP)
    }

    fn lay_out(&self, command: clap::Command, is_named: &dyn Fn(&str) -> bool) -> clap::Command {
        F::Commands::lay_out(F::arguments(command), is_named)
    }

    fn read(&self, matches: &mut ArgMatches) -> Result<FamilyLine, clap::Error> {
        let own = F::read_arguments(matches)?;
        Ok(FamilyLine { arguments: own, command: family_command::read::<F::Commands>(matches)? })
    }

    fn schemas(&self) -> Vec<SchemaEntry> {
        F::Commands::schemas()
    }

    fn serve(&self, name: String, arguments: Vec<OsString>) -> LocalBoxFuture<'static, Result<NamedServer, Failure>> {
        async move {
            let command = F::Serve::augment_args(clap::Command::new("sim").no_binary_name(true));
            let parsed = command.try_get_matches_from(arguments).and_then(|found| F::Serve::from_arg_matches(&found));
            let serve = parsed.map_err(|error| Failure::local(format!("internal error: {error}")))?;
            let Started { target, server, replay, .. } = serve.start().await?;
            Ok(NamedServer { name, target, server: Box::new(server), replay })
        }
        .boxed_local()
    }

    fn twin(&self, folder: &Path) -> Result<Box<dyn Any>, Failure> {
        Ok(Box::new(F::twin(folder)?))
    }

    fn dissector(&self) -> String {
        F::dissector()
    }

    fn tool(&self, kind: ToolKind) -> Tool {
        match kind {
            ToolKind::Decode => Tool::decode::<F::Decode>(),
            ToolKind::Explain => Tool::explain::<F>(),
            ToolKind::Simulate => Tool::simulate::<F::Serve>(),
        }
    }

    fn driver(&self) -> &'static dyn Driver {
        connection::driver::<F>()
    }

    fn overview<'a>(
        &self,
        connection: &'a mut dyn connection::Connection,
    ) -> LocalBoxFuture<'a, Result<OverviewReport, Failure>> {
        async move { F::overview(connection::link::<F>(connection)?).await }.boxed_local()
    }

    fn alarms<'a>(
        &self,
        connection: &'a mut dyn connection::Connection,
    ) -> LocalBoxFuture<'a, Result<Vec<Alarm>, Failure>> {
        async move { F::alarms(connection::link::<F>(connection)?).await }.boxed_local()
    }

    fn shared(&self, verb: SharedVerb) -> Box<dyn AnyCommand> {
        shared_commands::command::<F>(verb)
    }

    fn check<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Vec<Layer>, Failure>> {
        F::check(robot, access, screen).boxed_local()
    }

    fn watch<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Watch>, Failure>> {
        async move { Ok(Box::new(F::Poller::open(robot, access, screen).await?) as Box<dyn Watch>) }.boxed_local()
    }

    fn open_session_link<'a>(
        &self,
        robot: &'a Robot,
        access: &'a Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<HeldLink, Failure>> {
        F::open_session_link(robot, access, screen).boxed_local()
    }

    fn panel(&self) -> Panel {
        F::PANEL
    }

    fn stop(&self) -> &'static [&'static str] {
        F::STOP
    }

    fn guard(&self) -> Guard {
        F::GUARD
    }

    fn session_records(&self) -> bool {
        F::SESSION_RECORDS
    }

    fn session_commands(&self) -> bool {
        F::SESSION_COMMANDS
    }

    fn backup_risk(&self, robot: &Robot) -> Risk {
        F::backup_risk(robot)
    }

    fn back_up<'a>(
        &self,
        context: AnyContext<'a>,
        making: SaveOptions,
    ) -> LocalBoxFuture<'a, Result<BackupReport, Failure>> {
        async move { F::back_up(context.of()?, making).await }.boxed_local()
    }

    fn restore<'a>(
        &self,
        context: AnyContext<'a>,
        restoring: &'a RestoreSelection,
    ) -> LocalBoxFuture<'a, Result<RestoreReport, Failure>> {
        async move { F::restore(context.of()?, restoring).await }.boxed_local()
    }
}

impl<E: Poller> Watch for E {
    fn look(&mut self, detail: Detail) -> LocalBoxFuture<'_, Result<Sample, Failure>> {
        Poller::look(self, detail).boxed_local()
    }

    fn ask<'a>(
        &'a mut self,
        command: &'a dyn AnyCommand,
        robot: &'a Robot,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Outcome> {
        async move {
            let confirmer = Confirmer::reading(screen, robot);
            let mut borrowed = connection::Borrowed::<E::Family>(self.link());
            command.run(AnyContext { robot, connection: &mut borrowed, screen, several: false, confirmer }).await
        }
        .boxed_local()
    }

    fn traffic(&mut self) -> Traffic {
        E::Family::traffic(self.link())
    }

    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>> {
        Poller::close(*self, screen).boxed_local()
    }
}

//! Declaration of a family in its own types. [`Face::of`] converts it to the [`Face`] for the rest of the program.

use std::ffi::OsString;

use clap::{ArgMatches, FromArgMatches as _, Subcommand};

use super::explain::{Explain, RecordedAlarm};
use super::family_command::{self, FamilyLine};
use super::layers::Layer;
use super::overview::OverviewReport;
use super::sample::{Detail, Sample, Traffic};
use super::shared_commands::{self, CommonReport};
use super::teach_panel::Panel;
use super::tool::{Tool, ToolKind};
use super::{Face, HeldLink, Watch, Work};
use crate::backup::family_backup::Backups;
use crate::confirmation::Confirmer;
use crate::connection;
use crate::decode::Decode;
use crate::prelude::basics::*;
use crate::robot::alarm::Alarm;
use crate::serve::{NamedServer, Serve, Started};
use crate::settings::alarms::{Alarms, Origin};
use crate::{Access, AnyCommand, AnyContext, Command, CommandSet, FamilyArguments, Outcome};
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
    const NAME: Family;
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
    fn twin(folder: &Path) -> Result<Self::Start>;
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
    async fn alarms(link: &mut Self::Link) -> Result<Vec<Alarm>>;
    /// Traffic counted on a link so far.
    fn traffic(link: &Self::Link) -> Traffic;
    /// Summary for `status`.
    async fn overview(link: &mut Self::Link) -> Result<OverviewReport>;
    /// Layers of `robots check`.
    async fn check(robot: &Robot, access: Access, screen: &Screen) -> Result<Vec<Layer>>;
    /// Opens a link for a session.
    async fn open_session_link(robot: &Robot, access: &Access, screen: &Screen) -> Result<HeldLink>;
}

/// Poller that reads a robot repeatedly.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Poller: Sized + 'static {
    /// Family of the robot.
    type Family: Declaration;

    /// Connects.
    async fn open(robot: &Robot, access: Access, screen: &Screen) -> Result<Self>;
    /// Reads once.
    async fn look(&mut self, detail: Detail) -> Result<Sample>;
    /// Connection, for a read-only command.
    fn link(&mut self) -> &mut <Self::Family as connection::Family>::Link;
    /// Closes the connection.
    async fn close(self, screen: &Screen) -> Result<()>;
}

impl Face {
    /// Interface of a declared family.
    pub const fn of<F: Declaration>() -> Self {
        Self {
            family: F::NAME,
            title: F::TITLE,
            urls: F::urls,
            codes: F::codes,
            explains: explains::<F>,
            setup: F::SETUP,
            topics: F::topics,
            simulator: F::Serve::TARGET,
            unsaved: F::UNSAVED,
            start_state: F::START_STATE,
            augment: |command| {
                family_command::augment::<F::Commands>(F::arguments(command), F::ABOUT).after_help(F::AFTER_HELP)
            },
            lay_out: |command, is_named| F::Commands::lay_out(F::arguments(command), is_named),
            read: |matches| {
                let own = F::read_arguments(matches)?;
                Ok(FamilyLine { arguments: own, command: family_command::read::<F::Commands>(matches)? })
            },
            schemas: F::Commands::schemas,
            serve: |name, arguments| serve::<F::Serve>(name, arguments).boxed_local(),
            twin: |folder| Ok(Box::new(F::twin(folder)?)),
            dissector: F::dissector,
            tool: |kind| match kind {
                ToolKind::Decode => Tool::decode::<F::Decode>(),
                ToolKind::Explain => Tool::explain::<F>(),
                ToolKind::Simulate => Tool::simulate::<F::Serve>(),
            },
            driver: connection::driver::<F>(),
            overview: |connection| async move { F::overview(connection::link::<F>(connection)?).await }.boxed_local(),
            alarms: |connection| async move { F::alarms(connection::link::<F>(connection)?).await }.boxed_local(),
            shared: shared_commands::command::<F>,
            panel: F::PANEL,
            check: |robot, access, screen| F::check(robot, access, screen).boxed_local(),
            watch: |robot, access, screen| {
                let poller = F::Poller::open(robot, access, screen);
                async move { Ok(Box::new(poller.await?) as Box<dyn Watch>) }.boxed_local()
            },
            open_session_link: |robot, access, screen| F::open_session_link(robot, access, screen).boxed_local(),
            guard: F::GUARD,
            session_records: F::SESSION_RECORDS,
            session_commands: F::SESSION_COMMANDS,
            backup_risk: F::backup_risk,
            back_up: |context, making| async move { F::back_up(context.of()?, making).await }.boxed_local(),
            restore: |context, restoring| async move { F::restore(context.of()?, restoring).await }.boxed_local(),
        }
    }
}

fn explains<F: Declaration>(code: &str) -> bool {
    let command = F::Explain::augment_args(clap::Command::new("explain").no_binary_name(true));
    let parsed = command.try_get_matches_from([code]).and_then(|matches| F::Explain::from_arg_matches(&matches));
    parsed.is_ok_and(|explain| explain.explain(&Alarms::default(), Origin::any(F::NAME)).is_ok())
}

async fn serve<S: Serve + Args + 'static>(name: String, arguments: Vec<OsString>) -> Result<NamedServer> {
    let command = S::augment_args(clap::Command::new("sim").no_binary_name(true));
    let parsed = command.try_get_matches_from(arguments).and_then(|found| S::from_arg_matches(&found));
    let serve = parsed.map_err(|error| Failure::local(format!("internal error: {error}")))?;
    let Started { target, server, replay, .. } = serve.start().await?;
    Ok(NamedServer { name, target, server: Box::new(server), replay })
}

impl<E: Poller> Watch for E {
    fn look(&mut self, detail: Detail) -> Work<'_, Sample> {
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
            let mut borrowed = connection::Linked::<E::Family>::Borrowed(self.link());
            command.run(AnyContext { robot, connection: &mut borrowed, screen, several: false, confirmer }).await
        }
        .boxed_local()
    }

    fn traffic(&mut self) -> Traffic {
        E::Family::traffic(self.link())
    }

    fn close(self: Box<Self>, screen: &Screen) -> Work<'_, ()> {
        Poller::close(*self, screen).boxed_local()
    }
}

//! Command interface: arguments, risk, execution.

use futures_util::TryFutureExt as _;
use futures_util::future::ready;

use super::confirmation::Confirmer;
use super::connection::{self, Access, ConnectMode, Connection, ConnectionEffect, Driver, Family};
use super::report::{Outcome, sheet_of};
use crate::gate::Intent;
use crate::output::csv::Sheet;
use crate::output::envelope::Envelope;
use crate::prelude::basics::*;
use crate::settings::target;

/// Execution context of a command.
#[derive(Debug)]
pub struct Context<'a, F: Family> {
    /// Robot that the command runs on.
    pub robot: &'a Robot,
    /// Connection to the robot.
    pub link: &'a mut F::Link,
    /// Screen for progress and notes. Reports are not written to it, but returned.
    pub screen: &'a Screen,
    /// Whether other robots may run the same command. In that case, files need one folder per robot.
    pub several: bool,
    /// Authority with which the command confirms deletions and overwrites, as soon as it has read the data that they
    /// affect.
    pub confirmer: Confirmer<'a>,
}

/// [`Context`] with a connection of any family.
pub struct AnyContext<'a> {
    /// See [`Context::robot`].
    pub robot: &'a Robot,
    /// Connection to the robot.
    pub connection: &'a mut dyn Connection,
    /// See [`Context::screen`].
    pub screen: &'a Screen,
    /// See [`Context::several`].
    pub several: bool,
    /// See [`Context::confirmer`].
    pub confirmer: Confirmer<'a>,
}

impl<'a> AnyContext<'a> {
    /// Converts to the context of one family. The connection must belong to this family.
    pub fn of<F: Family>(self) -> Result<Context<'a, F>> {
        let Self { robot, connection, screen, several, confirmer } = self;
        Ok(Context { robot, link: connection::link::<F>(connection)?, screen, several, confirmer })
    }
}

/// A parsed command for a robot.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Command {
    /// Family of the command.
    type Family: Family;
    /// Type of the report.
    type Report: Report + 'static;
    /// Name in envelopes and schemas, such as `yerc.status`.
    const ID: &'static str;
    /// Maximum risk of the command.
    const RISK: Risk = Risk::Read;
    /// Text that completes "This will …" in the question before a motion.
    const INTENT: &'static str = "";
    /// Kind of confirmation that motion, deletion and overwriting need.
    const CONFIRMATION: Confirmation = Confirmation::Question;
    /// Connection that the command needs.
    const CONNECT_MODE: ConnectMode = ConnectMode::Control;
    /// Whether the command is a jog. A jog is stopped even with `--on-interrupt leave`.
    const JOGS: bool = false;
    /// Whether the command reads or writes files of this machine, even if the user names no file.
    const USES_FILES: bool = false;

    /// Risk with these arguments. The default is [`RISK`](Self::RISK).
    fn risk(&self) -> Risk {
        Self::RISK
    }

    /// Risk on this robot. It is at most [`risk`](Self::risk).
    fn risk_on(&self, _robot: &Robot) -> Risk {
        self.risk()
    }

    /// Intent with these arguments. The default is [`INTENT`](Self::INTENT).
    fn intent(&self) -> String {
        Self::INTENT.to_owned()
    }

    /// Confirmation with these arguments. The default is [`CONFIRMATION`](Self::CONFIRMATION).
    fn confirmation(&self) -> Confirmation {
        Self::CONFIRMATION
    }

    /// Whether the command stops the robot. A stop is always allowed.
    fn is_stop(&self) -> bool {
        false
    }

    /// Whether the command moves the robot until it is stopped: a jog without `--for`.
    fn moves_until_stopped(&self) -> bool {
        false
    }

    /// Whether the command runs again and again until it is stopped, and each run waits for an event.
    fn is_endless(&self) -> bool {
        false
    }

    /// Whether the command needs a robot with these arguments.
    fn takes_robot(&self) -> bool {
        true
    }

    /// Runs the command without a robot, if it needs none.
    fn run_alone(&self) -> Result<Self::Report> {
        Err(Failure::local("internal error: this command needs a robot"))
    }

    /// Required connection with these arguments. The default is [`CONNECT_MODE`](Self::CONNECT_MODE).
    fn connect_mode(&self) -> ConnectMode {
        Self::CONNECT_MODE
    }

    /// Line below the table with the reports of several robots.
    fn summary(&self, _envelopes: &[Envelope]) -> Option<String> {
        None
    }

    /// Outcome for a robot that did not answer before the end of `--for`.
    fn without_answer(&self, _robot: &Robot, failure: Failure) -> Result<Self::Report> {
        Err(failure)
    }

    /// Executes the command. In a dry run, requests that change something are recorded and count as successful. In a
    /// dry run, a read ends with the failure [`unknown`](super::dry_run::unknown). Unless the command handles this
    /// failure, the requests after the read are not planned.
    async fn run(&self, context: Context<'_, Self::Family>) -> Result<Self::Report>;
}

/// [`Command`] without its associated types, for the common run loop.
pub trait AnyCommand {
    /// See [`Command::ID`].
    fn id(&self) -> &'static str;
    /// Intent for the gate. With a robot, this is the intent on this robot. Without a robot, it is the intent with the
    /// highest risk.
    fn intent(&self, robot: Option<&Robot>) -> Intent;
    /// Runs the command and returns its report, if the command needs no robot.
    fn without_robot(&self, _screen: &Screen) -> Option<Outcome> {
        None
    }
    /// See [`Command::moves_until_stopped`].
    fn moves_until_stopped(&self) -> bool {
        false
    }
    /// See [`Command::JOGS`].
    fn jogs(&self) -> bool {
        false
    }
    /// See [`Command::is_endless`].
    fn is_endless(&self) -> bool {
        false
    }
    /// See [`Command::USES_FILES`].
    fn uses_files(&self) -> bool {
        false
    }
    /// Driver for the connections of the command; `None` if it needs no robot.
    fn driver(&self) -> Option<&'static Driver> {
        None
    }
    /// See [`Command::connect_mode`].
    fn connect_mode(&self, _robot: &Robot) -> ConnectMode {
        ConnectMode::default()
    }
    /// See [`Command::summary`].
    fn summary(&self, _envelopes: &[Envelope]) -> Option<String> {
        None
    }
    /// See [`Command::without_answer`].
    fn without_answer(&self, _robot: &Robot, failure: Failure) -> Outcome {
        Err(failure)
    }
    /// Columns of the report, if they are known before there is a report.
    fn sheet(&self) -> Option<Sheet> {
        None
    }
    /// See [`Command::run`]. The answers are not settled yet: use `run` of the trait object.
    fn run_unsettled<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome>;
}

impl dyn AnyCommand + '_ {
    /// Runs the command, then checks that all answers belong to its requests ([`connection::Family::settle`]).
    pub async fn run(&self, context: AnyContext<'_>) -> Outcome {
        let AnyContext { robot, connection, screen, several, confirmer } = context;
        let context = AnyContext { robot, connection: &mut *connection, screen, several, confirmer };
        let report = self.run_unsettled(context).await?;
        connection.settle().await?;
        Ok(report)
    }

    /// Family of the command; `None` for commands of all families or without a robot.
    pub fn family(&self) -> Option<target::Family> {
        self.driver()?.family
    }

    /// Effect that opening a connection for the command has on a robot.
    pub fn connection_effect(&self, robot: &Robot) -> ConnectionEffect {
        let effect = |driver: &Driver| (driver.connection_effect)(robot, self.connect_mode(robot));
        self.driver().map_or(ConnectionEffect::Harmless, effect)
    }

    /// Connects to a robot.
    pub async fn connect(&self, robot: &Robot, access: Access, screen: &Screen) -> Result<Box<dyn Connection>> {
        let driver = self.driver().ok_or_else(|| Failure::local("internal error: this command needs no robot"))?;
        (driver.connect)(robot, access, screen).await
    }
}

impl<C: Command> AnyCommand for C {
    fn id(&self) -> &'static str {
        C::ID
    }

    fn intent(&self, robot: Option<&Robot>) -> Intent {
        Intent {
            risk: robot.map_or_else(|| Command::risk(self), |robot| Command::risk_on(self, robot)),
            text: Command::intent(self),
            confirmation: Command::confirmation(self),
            is_stop: Command::is_stop(self),
        }
    }

    fn moves_until_stopped(&self) -> bool {
        Command::moves_until_stopped(self)
    }

    fn jogs(&self) -> bool {
        C::JOGS
    }

    fn is_endless(&self) -> bool {
        Command::is_endless(self)
    }

    fn uses_files(&self) -> bool {
        C::USES_FILES
    }

    fn without_robot(&self, _screen: &Screen) -> Option<Outcome> {
        let alone = || Ok(Box::new(Command::run_alone(self)?) as Box<_>);
        (!Command::takes_robot(self)).then(alone)
    }

    fn driver(&self) -> Option<&'static Driver> {
        Command::takes_robot(self).then(connection::driver::<C::Family>)
    }

    fn connect_mode(&self, _robot: &Robot) -> ConnectMode {
        Command::connect_mode(self)
    }

    fn summary(&self, envelopes: &[Envelope]) -> Option<String> {
        Command::summary(self, envelopes)
    }

    fn without_answer(&self, robot: &Robot, failure: Failure) -> Outcome {
        Ok(Box::new(Command::without_answer(self, robot, failure)?))
    }

    fn sheet(&self) -> Option<Sheet> {
        Some(sheet_of::<C::Report>())
    }

    fn run_unsettled<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        match context.of::<C::Family>() {
            // Combinators, because a state machine per command is code per command.
            Ok(context) => Command::run(self, context).map_ok(|report| Box::new(report) as Box<_>).boxed_local(),
            Err(failure) => ready(Err(failure)).boxed_local(),
        }
    }
}

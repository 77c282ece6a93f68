//! What a command is: its arguments, what it does at most, and how it is done.

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::authority::Authority;
use super::connection::{self, Access, ConnectMode, Connection, Driver, Entry, Family};
use super::report::{Outcome, Report};
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::{Confirmation, Intent};
use crate::output::Screen;
use crate::output::envelope::Envelope;
use crate::settings::{Robot, target};

/// What a command line needs beside its own arguments.
#[derive(Debug)]
pub struct Context<'a, F: Family> {
    /// The robot.
    pub robot: &'a Robot,
    /// The connection to it.
    pub link: &'a mut F::Link,
    /// For progress and notes; reports go back to the caller.
    pub screen: &'a Screen,
    /// Whether other robots may run the same command, so that files need a folder for each.
    pub several: bool,
    /// Confirms what is deleted or overwritten, once that is known.
    pub authority: Authority<'a>,
}

/// [`Context`] with a connection of whichever family.
pub struct AnyContext<'a> {
    /// See [`Context::robot`].
    pub robot: &'a Robot,
    /// The connection to it.
    pub connection: &'a mut dyn Connection,
    /// See [`Context::screen`].
    pub screen: &'a Screen,
    /// See [`Context::several`].
    pub several: bool,
    /// See [`Context::authority`].
    pub authority: Authority<'a>,
}

impl<'a> AnyContext<'a> {
    /// The same for a command of one family, whose connection it must be.
    pub fn of<F: Family>(self) -> Result<Context<'a, F>, Failure> {
        let Self { robot, connection, screen, several, authority } = self;
        Ok(Context { robot, link: connection::link::<F>(connection)?, screen, several, authority })
    }
}

/// A parsed command line for a robot.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Command {
    /// The family it is for.
    type Family: Family;
    /// What it reports.
    type Report: Report + 'static;
    /// `yerc.status`: its name in envelopes and schemas.
    const ID: &'static str;
    /// The most that it does.
    const RISK: Risk = Risk::Read;
    /// Completes "This will …" in the question before a motion.
    const INTENT: &'static str = "";
    /// How a yes is given to what moves, deletes or overwrites.
    const CONFIRMATION: Confirmation = Confirmation::Question;
    /// What it wants of the connection.
    const CONNECT_MODE: ConnectMode = ConnectMode::Control;

    /// [`RISK`](Self::RISK), where that depends on its arguments.
    fn risk(&self) -> Risk {
        Self::RISK
    }

    /// The most that it does to this robot, where that depends on it; not more than [`risk`](Self::risk).
    fn risk_on(&self, _robot: &Robot) -> Risk {
        self.risk()
    }

    /// [`INTENT`](Self::INTENT), where that depends on its arguments.
    fn intent(&self) -> String {
        Self::INTENT.to_owned()
    }

    /// [`CONFIRMATION`](Self::CONFIRMATION), where that depends on its arguments.
    fn confirmation(&self) -> Confirmation {
        Self::CONFIRMATION
    }

    /// Whether it stops the robot, which is always allowed.
    fn is_stop(&self) -> bool {
        false
    }

    /// Whether it moves the robot until somebody ends it: a jog without `--for`.
    fn moves_until_stopped(&self) -> bool {
        false
    }

    /// Whether it jogs: such a motion is stopped even where `--on-interrupt` says to leave it.
    fn jogs(&self) -> bool {
        false
    }

    /// Whether it is repeated until something ends it, each run waiting for the next thing to tell.
    fn is_endless(&self) -> bool {
        false
    }

    /// Whether it reads or writes files of this machine, also where none is named.
    fn uses_files(&self) -> bool {
        false
    }

    /// Whether it takes a robot, where that depends on its arguments.
    fn takes_robot(&self) -> bool {
        true
    }

    /// Does it without a robot, where it takes none.
    fn run_alone(&self) -> Result<Self::Report, Failure> {
        Err(Failure::local("internal error: this command takes a robot"))
    }

    /// [`CONNECT_MODE`](Self::CONNECT_MODE), where that depends on its arguments.
    fn connect_mode(&self) -> ConnectMode {
        Self::CONNECT_MODE
    }

    /// What is said below the table of several robots, of their envelopes.
    fn summary(&self, _envelopes: &[Envelope]) -> Option<String> {
        None
    }

    /// Does it. In a dry run orders are noted and count as done; what reads ends in a failure that says its answer is not
    /// known ([`unknown`](super::dry_run::unknown)), behind which nothing can be foreseen unless the command does.
    async fn run(&self, context: Context<'_, Self::Family>) -> Result<Self::Report, Failure>;
}

/// [`Command`] without its types, for the one loop that runs them all.
pub trait AnyCommand {
    /// See [`Command::ID`].
    fn id(&self) -> &'static str;
    /// What the gate is told: of this robot, or at the most.
    fn intent(&self, robot: Option<&Robot>) -> Intent;
    /// What it reports, if it takes no robot to do it.
    fn without_robot(&self, _screen: &Screen) -> Option<Outcome> {
        None
    }
    /// See [`Command::moves_until_stopped`].
    fn moves_until_stopped(&self) -> bool {
        false
    }
    /// See [`Command::jogs`].
    fn jogs(&self) -> bool {
        false
    }
    /// See [`Command::is_endless`].
    fn is_endless(&self) -> bool {
        false
    }
    /// See [`Command::uses_files`].
    fn uses_files(&self) -> bool {
        false
    }
    /// What opens connections for it, unless it takes no robot.
    fn driver(&self) -> Option<&'static dyn Driver> {
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
    /// See [`Command::run`].
    fn run<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome>;
}

impl dyn AnyCommand + '_ {
    /// The family it is for; `None` if it is for robots of any, or for none.
    pub fn family(&self) -> Option<target::Family> {
        self.driver()?.family()
    }

    /// What its connection does to a robot by being there.
    pub fn entry(&self, robot: &Robot) -> Entry {
        self.driver().map_or(Entry::Harmless, |driver| driver.entry(robot, self.connect_mode(robot)))
    }

    /// Connects to a robot.
    pub async fn connect(
        &self,
        robot: &Robot,
        access: Access,
        screen: &Screen,
    ) -> Result<Box<dyn Connection>, Failure> {
        let driver = self.driver().ok_or_else(|| Failure::local("internal error: this command takes no robot"))?;
        driver.connect(robot, access, screen).await
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
        Command::jogs(self)
    }

    fn is_endless(&self) -> bool {
        Command::is_endless(self)
    }

    fn uses_files(&self) -> bool {
        Command::uses_files(self)
    }

    fn without_robot(&self, _screen: &Screen) -> Option<Outcome> {
        let alone = || Ok(Box::new(Command::run_alone(self)?) as Box<_>);
        (!Command::takes_robot(self)).then(alone)
    }

    fn driver(&self) -> Option<&'static dyn Driver> {
        Command::takes_robot(self).then(connection::driver::<C::Family>)
    }

    fn connect_mode(&self, _robot: &Robot) -> ConnectMode {
        Command::connect_mode(self)
    }

    fn summary(&self, envelopes: &[Envelope]) -> Option<String> {
        Command::summary(self, envelopes)
    }

    fn run<'a>(&'a self, context: AnyContext<'a>) -> LocalBoxFuture<'a, Outcome> {
        async move {
            let Context { robot, link, screen, several, authority } = context.of::<C::Family>()?;
            let report = Command::run(self, Context { robot, link: &mut *link, screen, several, authority }).await?;
            C::Family::settle(link).await?;
            Ok(Box::new(report) as Box<_>)
        }
        .boxed_local()
    }
}

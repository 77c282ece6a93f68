//! Connections to robots: how they may be used, and what the one loop does with them whatever their family.

use std::any::Any;
use std::fmt;
use std::marker::PhantomData;
use std::path::PathBuf;
use std::sync::Arc;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::dry_run::Plan;
use crate::controller::Risk;
use crate::failure::Failure;
use crate::gate::{Grant, Intent};
use crate::output::Screen;
use crate::settings::{Robot, target};

/// How a link may be used.
#[derive(Debug, Clone)]
pub struct Access {
    /// Nothing riskier leaves: the last check, after the gate.
    pub granted: Grant,
    /// Note what would be sent instead of sending it.
    pub dry_run: bool,
    /// Where frames are recorded.
    pub trace: Option<PathBuf>,
    /// What the command wants of the connection.
    pub mode: ConnectMode,
    /// The command line, where it is not that of the process.
    pub typed: Option<Arc<str>>,
    /// What was typed between the word of the family and the command.
    pub own: Own,
    /// Whether the robot moves on if this process dies.
    pub leaves_motion: bool,
    /// Whether it is for a stop, which waits for nobody.
    pub is_stop: bool,
}

impl Access {
    /// For what only looks.
    pub fn reading(mode: ConnectMode) -> Self {
        let (granted, own) = (Grant::of(Risk::Read), Own::default());
        Self { granted, dry_run: false, trace: None, mode, typed: None, own, leaves_motion: false, is_stop: false }
    }
}

/// What was typed between the word of a family and a command, for all commands of the family. What it says, the family
/// alone knows.
#[derive(Debug, Clone, Default)]
pub struct Own(Option<Arc<dyn OwnArguments>>);

/// What a family takes between its word and a command.
pub trait OwnArguments: Any + fmt::Debug + Send + Sync {
    /// Completes what a command will do.
    fn complete(&self, intent: Intent) -> Intent;

    /// The words that say the same.
    fn words(&self) -> Vec<String>;
}

impl Own {
    /// These.
    pub fn of(arguments: impl OwnArguments) -> Self {
        Self(Some(Arc::new(arguments)))
    }

    /// As the family knows them, if it has typed any.
    pub fn get<T: OwnArguments>(&self) -> Option<&T> {
        let own: &dyn Any = &**self.0.as_ref()?;
        own.downcast_ref()
    }

    /// See [`OwnArguments::complete`].
    pub fn complete(&self, intent: Intent) -> Intent {
        match &self.0 {
            Some(own) => own.complete(intent),
            None => intent,
        }
    }

    /// See [`OwnArguments::words`].
    pub fn words(&self) -> Vec<String> {
        self.0.as_ref().map(|own| own.words()).unwrap_or_default()
    }
}

/// What a command wants of the connection. Where a controller takes the end of a connection for a fault, as YRCX does,
/// nothing is opened that is more than this.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ConnectMode {
    /// To ask and to command.
    #[default]
    Control,
    /// To see what the controller shows by itself.
    Monitor,
    /// To ask its network board, which answers without a connection to the controller (yrcx).
    Explicit,
}

/// What a connection does to a controller by being there.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Entry {
    /// Nothing.
    Harmless,
    /// Nothing, as a session holds it; another way would not be harmless.
    ThroughSession,
    /// It stops the robot when it ends; completes "This will …".
    Stops(String),
}

/// A controller family as its commands see it.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Family: Sized + 'static {
    /// Its name; `None` for what is for robots of any family.
    const FAMILY: Option<target::Family>;
    /// A connection to one robot.
    type Link: 'static;
    /// Words of the command that stops a robot, behind the word of the family; none where nothing moves.
    const STOP: &'static [&'static str];

    /// Connects. With `dry_run` nothing is opened.
    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Self::Link, Failure>;

    /// Stops what this link set in motion, and says what was done: "the robot was stopped: HOLD is on".
    async fn halt(link: &mut Self::Link) -> Result<String, Failure>;

    /// Whether what this link set in motion is stopped even if `--on-interrupt` says to leave it.
    fn must_halt(_link: &Self::Link) -> bool {
        false
    }

    /// What a dry run would have sent, in the order of sending.
    fn planned(link: &mut Self::Link) -> Plan;

    /// Makes sure, before a command reports, that the answers it took were those to what it sent.
    async fn settle(_link: &mut Self::Link) -> Result<(), Failure> {
        Ok(())
    }

    /// What a connection of this kind does to the controller by being opened, and closed at the end.
    fn entry(_robot: &Robot, _mode: ConnectMode) -> Entry {
        Entry::Harmless
    }

    /// Whether only one client at a time can reach the controller of a robot, so that those on this machine share its link.
    fn takes_one_client(_robot: &Robot) -> bool {
        false
    }

    /// All addresses of a robot, asked of its network where each robot there has several; without them, none.
    fn addresses(_robot: &Robot) -> Result<Vec<target::Address>, Failure> {
        Ok(Vec::new())
    }

    /// Closes the connection, and says at `-v` what it was like.
    async fn close(link: Self::Link, screen: &Screen) -> Result<(), Failure>;
}

/// A connection to one robot, whatever its family: what [`Family`] says, without its type.
pub trait Connection {
    /// See [`Family::halt`].
    fn halt(&mut self) -> LocalBoxFuture<'_, Result<String, Failure>>;
    /// See [`Family::must_halt`].
    fn must_halt(&self) -> bool;
    /// See [`Family::planned`].
    fn planned(&mut self) -> Plan;
    /// See [`Family::close`].
    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>>;
    /// The [`Family::Link`].
    fn as_any(&mut self) -> &mut dyn Any;
}

/// What opens connections to the robots of a family: what [`Family`] says, without its type.
pub trait Driver: Sync {
    /// See [`Family::FAMILY`].
    fn family(&self) -> Option<target::Family>;
    /// See [`Family::STOP`].
    fn stop(&self) -> &'static [&'static str];
    /// See [`Family::entry`].
    fn entry(&self, robot: &Robot, mode: ConnectMode) -> Entry;
    /// See [`Family::takes_one_client`].
    fn takes_one_client(&self, robot: &Robot) -> bool;
    /// See [`Family::addresses`].
    fn addresses(&self, robot: &Robot) -> Result<Vec<target::Address>, Failure>;
    /// See [`Family::connect`].
    fn connect<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Connection>, Failure>>;
}

/// The driver of a family.
pub fn driver<F: Family>() -> &'static dyn Driver {
    &Drives::<F>(PhantomData)
}

struct Drives<F>(PhantomData<fn() -> F>);

impl<F: Family> Driver for Drives<F> {
    fn family(&self) -> Option<target::Family> {
        F::FAMILY
    }

    fn stop(&self) -> &'static [&'static str] {
        F::STOP
    }

    fn entry(&self, robot: &Robot, mode: ConnectMode) -> Entry {
        F::entry(robot, mode)
    }

    fn takes_one_client(&self, robot: &Robot) -> bool {
        F::takes_one_client(robot)
    }

    fn addresses(&self, robot: &Robot) -> Result<Vec<target::Address>, Failure> {
        F::addresses(robot)
    }

    fn connect<'a>(
        &self,
        robot: &'a Robot,
        access: Access,
        screen: &'a Screen,
    ) -> LocalBoxFuture<'a, Result<Box<dyn Connection>, Failure>> {
        let connected = F::connect(robot, access, screen);
        async move { Ok(Box::new(Connected::<F>(connected.await?)) as Box<dyn Connection>) }.boxed_local()
    }
}

/// The link of a family behind a connection; anything else is a fault of this program.
pub fn link<F: Family>(connection: &mut dyn Connection) -> Result<&mut F::Link, Failure> {
    let link = connection.as_any().downcast_mut();
    link.ok_or_else(|| Failure::local("internal error: this connection is one of another family"))
}

/// The link of a family, lent as a [`Connection`] for a command that is run over it.
pub struct Lent<'a, F: Family>(pub &'a mut F::Link);

impl<F: Family> Connection for Lent<'_, F> {
    fn halt(&mut self) -> LocalBoxFuture<'_, Result<String, Failure>> {
        F::halt(self.0).boxed_local()
    }

    fn must_halt(&self) -> bool {
        F::must_halt(self.0)
    }

    fn planned(&mut self) -> Plan {
        F::planned(self.0)
    }

    /// It is closed by who has lent it.
    fn close(self: Box<Self>, _screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>> {
        async { Ok(()) }.boxed_local()
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self.0
    }
}

/// The link of a family as a [`Connection`].
struct Connected<F: Family>(F::Link);

impl<F: Family> Connection for Connected<F> {
    fn halt(&mut self) -> LocalBoxFuture<'_, Result<String, Failure>> {
        F::halt(&mut self.0).boxed_local()
    }

    fn must_halt(&self) -> bool {
        F::must_halt(&self.0)
    }

    fn planned(&mut self) -> Plan {
        F::planned(&mut self.0)
    }

    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<(), Failure>> {
        F::close(self.0, screen).boxed_local()
    }

    fn as_any(&mut self) -> &mut dyn Any {
        &mut self.0
    }
}

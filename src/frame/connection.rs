//! Connections to robots: what a command may do with a link, and the family-independent interface for the run loop.

use std::any::Any;
use std::marker::PhantomData;

use super::dry_run::Plan;
use super::session_manager::OwnSession;
use crate::gate::{Grant, Intent};
use crate::prelude::basics::*;
use crate::settings::target;
use armctl_controller::simulator::recording::AnswerLog;

/// What a command may do with a link.
#[derive(Debug, Clone)]
pub struct Access {
    /// Maximum risk of the frames that may be sent. This is the last check, after the gate.
    pub grant: Grant,
    /// Whether frames are recorded instead of sent.
    pub dry_run: bool,
    /// Trace file.
    pub trace: Option<PathBuf>,
    /// Log of the answers to reads, for a recording.
    pub answers: Option<AnswerLog>,
    /// Connection that the command needs.
    pub mode: ConnectMode,
    /// Command line of the command, if it is not the command line of the process.
    pub typed: Option<Arc<str>>,
    /// Arguments of the family that precede the command.
    pub own: FamilyArguments,
    /// Whether a motion continues if this process ends.
    pub leaves_motion: bool,
    /// Whether the access is for a stop, which must not wait.
    pub is_stop: bool,
    /// Session of this process that has the link, for a line of a prompt or command file.
    pub session: Option<OwnSession>,
}

impl Access {
    /// Read-only access.
    pub fn reading(mode: ConnectMode) -> Self {
        let (grant, own) = (Grant::up_to(Risk::Read), FamilyArguments::default());
        let (leaves_motion, is_stop) = (false, false);
        Self {
            grant,
            dry_run: false,
            trace: None,
            answers: None,
            mode,
            typed: None,
            own,
            leaves_motion,
            is_stop,
            session: None,
        }
    }
}

/// Arguments of a family that precede the command, and apply to all its commands. Only the family can interpret them.
#[derive(Debug, Clone, Default)]
pub struct FamilyArguments(Option<Arc<dyn AnyFamilyArguments>>);

/// Arguments of a family that precede a command.
pub trait AnyFamilyArguments: Any + fmt::Debug + Send + Sync {
    /// Adds the effect of the arguments to the intent of a command.
    fn complete(&self, intent: Intent) -> Intent;

    /// Words of the command line that are equivalent to the arguments.
    fn words(&self) -> Vec<String>;
}

impl FamilyArguments {
    /// Stores the arguments.
    pub fn of(arguments: impl AnyFamilyArguments) -> Self {
        Self(Some(Arc::new(arguments)))
    }

    /// Arguments in the type of the family, if the user gave any.
    pub fn get<T: AnyFamilyArguments>(&self) -> Option<&T> {
        let own: &dyn Any = &**self.0.as_ref()?;
        own.downcast_ref()
    }

    /// See [`AnyFamilyArguments::complete`].
    pub fn complete(&self, intent: Intent) -> Intent {
        match &self.0 {
            Some(own) => own.complete(intent),
            None => intent,
        }
    }

    /// See [`AnyFamilyArguments::words`].
    pub fn words(&self) -> Vec<String> {
        self.0.as_ref().map(|own| own.words()).unwrap_or_default()
    }
}

/// Connection that a command needs. Some controllers, such as a YRCX, treat the end of a connection as a fault. For
/// this reason, armctl opens only the connection that the command needs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ConnectMode {
    /// A connection that reads and commands.
    #[default]
    Control,
    /// A connection that receives only the signals that the controller sends on its own.
    Monitor,
    /// Explicit messages to the network board. They need no connection to the controller (yrcx).
    Explicit,
}

/// Effect that a connection has on a controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ConnectionEffect {
    /// No effect.
    Harmless,
    /// No effect, because the link belongs to a session. A direct connection would have an effect.
    ThroughSession,
    /// The robot stops when the connection ends. The text completes "This will …".
    Stops(String),
}

/// A controller family, as its commands see it.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Family: Sized + 'static {
    /// Family; `None` for commands of all families.
    const FAMILY: Option<target::Family>;
    /// Connection to one robot.
    type Link: 'static;
    /// Words of the stop command after the family name; empty if the family cannot move anything.
    const STOP: &'static [&'static str];

    /// Connects to the robot. A dry run opens no connection.
    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Self::Link>;

    /// Stops motion that this link started. Returns the result as a text, such as "the robot was stopped: HOLD is on".
    async fn halt(link: &mut Self::Link) -> Result<String>;

    /// Whether the motion of this link is stopped even with `--on-interrupt leave`.
    fn needs_halt(_link: &Self::Link) -> bool {
        false
    }

    /// Frames that a dry run would have sent, in their order.
    fn planned(link: &mut Self::Link) -> Plan;

    /// Checks, before a report is made, that all answers belong to the requests.
    async fn settle(_link: &mut Self::Link) -> Result<()> {
        Ok(())
    }

    /// Effect of opening and closing a connection of this kind.
    fn connection_effect(_robot: &Robot, _mode: ConnectMode) -> ConnectionEffect {
        ConnectionEffect::Harmless
    }

    /// What the controller does when the client that sends commands closes its connection; `None` if it does nothing.
    fn end_effect(_robot: &Robot) -> Option<String> {
        None
    }

    /// Whether the controller accepts only one client. In that case, all commands of this computer share its link.
    fn takes_one_client(_robot: &Robot) -> bool {
        false
    }

    /// All addresses of a robot, resolved from its network; empty if robots of this family have only one address.
    fn addresses(_robot: &Robot) -> Result<Vec<target::Address>> {
        Ok(Vec::new())
    }

    /// Closes the connection. With `-v`, prints statistics.
    async fn close(link: Self::Link, screen: &Screen) -> Result<()>;
}

/// A connection to one robot of any family: [`Family`] without its associated types.
pub trait Connection {
    /// See [`Family::halt`].
    fn halt(&mut self) -> LocalBoxFuture<'_, Result<String>>;
    /// See [`Family::needs_halt`].
    fn needs_halt(&mut self) -> bool;
    /// See [`Family::planned`].
    fn planned(&mut self) -> Plan;
    /// See [`Family::settle`].
    fn settle(&mut self) -> LocalBoxFuture<'_, Result<()>>;
    /// See [`Family::close`].
    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<()>>;
    /// The link, whose type is [`Family::Link`].
    fn as_any(&mut self) -> &mut dyn Any;
}

/// Driver for the robots of a family: [`Family`] without its associated types.
pub struct Driver {
    /// See [`Family::FAMILY`].
    pub family: Option<target::Family>,
    /// See [`Family::STOP`].
    pub stop: &'static [&'static str],
    /// See [`Family::connection_effect`].
    pub connection_effect: fn(&Robot, ConnectMode) -> ConnectionEffect,
    /// See [`Family::end_effect`].
    pub end_effect: fn(&Robot) -> Option<String>,
    /// See [`Family::takes_one_client`].
    pub takes_one_client: fn(&Robot) -> bool,
    /// See [`Family::addresses`].
    pub addresses: fn(&Robot) -> Result<Vec<target::Address>>,
    /// See [`Family::connect`].
    pub connect: for<'a> fn(&'a Robot, Access, &'a Screen) -> Connecting<'a>,
}

/// Connection that is being opened.
pub type Connecting<'a> = LocalBoxFuture<'a, Result<Box<dyn Connection>>>;

/// The driver of a family.
pub const fn driver<F: Family>() -> &'static Driver {
    &Driving::<F>::DRIVER
}

struct Driving<F>(PhantomData<F>);

impl<F: Family> Driving<F> {
    const DRIVER: Driver = Driver {
        family: F::FAMILY,
        stop: F::STOP,
        connection_effect: F::connection_effect,
        end_effect: F::end_effect,
        takes_one_client: F::takes_one_client,
        addresses: F::addresses,
        connect: |robot, access, screen| {
            let connected = F::connect(robot, access, screen);
            async move { Ok(Box::new(Linked::<F>::Owned(connected.await?)) as Box<dyn Connection>) }.boxed_local()
        },
    };
}

/// The link of a family, from a connection. A connection of another family is an internal error.
pub fn link<F: Family>(connection: &mut dyn Connection) -> Result<&mut F::Link> {
    let link = connection.as_any().downcast_mut();
    link.ok_or_else(|| Failure::local("internal error: this connection belongs to another family"))
}

/// Link of a family as a [`Connection`].
pub enum Linked<'a, F: Family> {
    /// The connection owns the link.
    Owned(F::Link),
    /// The link is borrowed for a command. Its owner closes it.
    Borrowed(&'a mut F::Link),
}

impl<F: Family> Linked<'_, F> {
    fn link(&mut self) -> &mut F::Link {
        match self {
            Self::Owned(link) => link,
            Self::Borrowed(link) => link,
        }
    }
}

impl<F: Family> Connection for Linked<'_, F> {
    fn halt(&mut self) -> LocalBoxFuture<'_, Result<String>> {
        F::halt(self.link()).boxed_local()
    }

    fn needs_halt(&mut self) -> bool {
        F::needs_halt(self.link())
    }

    fn planned(&mut self) -> Plan {
        F::planned(self.link())
    }

    fn settle(&mut self) -> LocalBoxFuture<'_, Result<()>> {
        F::settle(self.link()).boxed_local()
    }

    fn close(self: Box<Self>, screen: &Screen) -> LocalBoxFuture<'_, Result<()>> {
        match *self {
            Self::Owned(link) => F::close(link, screen).boxed_local(),
            Self::Borrowed(_) => async { Ok(()) }.boxed_local(),
        }
    }

    fn as_any(&mut self) -> &mut dyn Any {
        self.link()
    }
}

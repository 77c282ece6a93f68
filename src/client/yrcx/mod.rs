//! The client of an OMRON / Yamaha YRCX: the one driver that moves images between sessions and a link over a fieldbus.
//!
//! At most one remote command is under way, and beside it one procedure of signals: both are polled in every turn, as the
//! controller takes them at the same time (chapters 1 and 2 of the manual). Calls may be dropped at any await; what was
//! under way stays in the client, so that [`Client::stop`] can end it properly. What a dropped call leaves behind goes on
//! only while another call is awaited.
//!
//! Any [`ImageLink`] will do: over EtherNet/IP, DeviceNet or PROFIBUS, through a session that holds one, or to a simulator
//! in this process.

mod error;
mod hold;
mod jog;
mod order;
mod output;
mod plan;
mod shared;
mod signals;
mod simulated;
mod stop;
#[cfg(test)]
mod tests;
mod turns;
mod words;

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::yrcx::alarm::Alarm;
use armctl_controller::yrcx::answer::Status;
use armctl_controller::yrcx::image::{Image, Output, Words};
use armctl_controller::yrcx::sequence::{self, Sequence};
use armctl_controller::yrcx::session::{Exchange, Outcome, Policy};
use armctl_controller::yrcx::signal::resting;
use armctl_controller::yrcx::simulator::Start;
use armctl_controller::yrcx::table::Command;
use armctl_transport::image::{ImageLink, LinkError, Traffic};
use tokio::time::Instant;

pub use self::error::{Error, Refusal};
pub use self::hold::hold;
pub use self::order::{Done, Reply};
pub use self::plan::hex;
pub use self::simulated::Simulated;
pub use self::stop::Stopped;
use crate::{Grant, Plan, STOP_WITHIN, Watcher};

/// A connection to one controller.
///
/// It is for one thread: links over a fieldbus are.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct Client {
    transport: Transport,
    /// Bytes of what is shown; 0 where nothing is.
    size: usize,
    /// Whether this connection may show something; else it only sees.
    is_owner: bool,
    /// What the controller is shown.
    output: Output,
    /// What was handed to the transport last.
    shown: Option<Image>,
    /// Whether that has not left yet. Nothing else is shown meanwhile: a command must not overtake its data.
    in_flight: bool,
    /// What the controller shows; `None` while the link is down.
    input: Option<Image>,
    is_up: bool,
    /// The remote command that is under way, and how the last one ended.
    exchange: Option<Exchange>,
    ended: Option<Outcome>,
    /// The procedure that is under way, and how the last one ended.
    sequence: Option<Sequence>,
    finished: Option<sequence::Outcome>,
    policy: Policy,
    /// For an output of a procedure.
    patience: Duration,
    timeout: Duration,
    retries: u32,
    granted: Grant,
    /// Whether something was started that goes on by itself: a program, or what signals set in motion.
    has_started: bool,
    /// General-purpose words that were shown before a remote command, to be put back after it.
    words: Words,
    /// Whether the link outlives the client, so that what it began may go on.
    is_held: bool,
    /// Whether a session holds it, and others may use it at the same time.
    is_shared: bool,
    /// Whether a remote command has ended, so that somebody else may give the next one.
    is_over: bool,
    started: Instant,
    watcher: Box<dyn Watcher<Event>>,
    totals: Totals,
}

/// How the images travel.
#[derive(Debug)]
enum Transport {
    Image(Box<ImageLink>),
    /// A dry run: what would be sent is noted.
    Notes(Plan),
    /// Not at all.
    Nothing,
}

/// How a client asks.
#[derive(Debug, Clone)]
pub struct Options {
    /// Whether it commands the controller; else it only sees the signals that this shows.
    pub commands: bool,
    /// Whether the connection outlives the client, so that a motion or a program may go on behind it. A controller stops
    /// when its connection ends.
    pub is_held: bool,
    /// The most that may leave.
    pub granted: Grant,
    /// The longest wait of one try: for the controller to be ready, to take a command, and to show something. What it
    /// carries out has patience of its own: 10 s at least, 30 s for what switches motor power, and no end for motions.
    pub timeout: Duration,
    /// Further tries of a command that changes nothing. No try begins after `timeout` times (`retries` + 1).
    pub retries: u32,
}

impl Default for Options {
    /// To read, over a connection that commands the controller, with the usual patience: 3 s, and 3 repeats.
    fn default() -> Self {
        Self {
            commands: true,
            is_held: false,
            granted: Grant::default(),
            timeout: Policy::default().accept,
            retries: 3,
        }
    }
}

impl Options {
    /// The same, and what is not riskier than this may leave.
    #[must_use]
    pub fn granting(self, risk: Risk) -> Self {
        Self { granted: Grant::of(risk), ..self }
    }
}

/// What a client notices.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Event {
    /// This image has left for the controller.
    Shown(Image),
    /// The controller shows this image.
    Seen(Image),
    /// CPU OK (SO(01)) is off in the first image of a connection that only sees: the controller does not work, or this is
    /// nothing that a controller shows.
    CpuNotOk,
    /// The link was lost. Whatever was under way is over, and the controller stops.
    Lost {
        /// Why.
        why: LinkError,
        /// Whether it is being opened again.
        is_reopening: bool,
    },
    /// The link is open again.
    Reopened {
        /// How the stop input SI(06) is shown; `None` where this connection only sees.
        stop: Option<bool>,
    },
    /// There was a status before this command, which is reset now.
    Leftover(Command, Status),
    /// This command has ended, and the controller is not ready again.
    NotReleased(Command),
    /// A command that was left alone was refused or broken off.
    BrokenOff(Command, Alarm),
    /// A command that was left alone has ended without an answer.
    Unanswered(Error),
    /// Another client of the session had left a command alone, which has ended.
    LeftByOthers {
        /// WI0 to WI15.
        words: Words,
        /// WO0 to WO15.
        answer: Words,
    },
    /// The stop input SI(06) goes off now.
    Stopping,
}

/// What a client saw.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Remote commands given.
    pub commands: u32,
    /// Time from sending them to their ends.
    pub waited: Duration,
    /// How often the link was lost.
    pub losses: u32,
}

/// Least patience with what the manual gives no time for.
const QUICK: Duration = Duration::from_secs(10);
const POWER: Duration = Duration::from_secs(30);

impl Client {
    /// Takes over a link, and waits until the controller has shown something: [`over`](Self::over) and
    /// [`ready`](Self::ready). The controller is shown the resting image: emergency stop and stop inputs on, all else off.
    ///
    /// # Errors
    /// [`Error::Silent`] if it shows nothing within the time-out. The link is closed then.
    pub async fn connect(link: ImageLink, options: Options) -> Result<Self, Error> {
        let mut client = Self::over(link, options);
        match client.ready().await {
            Ok(()) => Ok(client),
            Err(error) => {
                // That the controller shows nothing is worth more than how the end of that went.
                let _ = client.close().await;
                Err(error)
            }
        }
    }

    /// Connects to a fresh simulator in this process.
    ///
    /// # Errors
    /// None is known.
    pub async fn simulated(start: Start, options: Options) -> Result<Self, Error> {
        let peer = Box::new(Simulated::new(start));
        Self::connect(ImageLink::in_process(peer), Options { is_held: true, ..options }).await
    }

    /// Takes over a link. Nothing is shown yet: see [`ready`](Self::ready). In a session it is shared with others, who
    /// take turns in giving remote commands.
    pub fn over(link: ImageLink, options: Options) -> Self {
        let size = link.output_size();
        let mut client = Self::new(Transport::Image(Box::new(link)), size, options);
        client.join();
        client
    }

    /// Sends nothing, but notes what would be sent ([`Client::take_plan`]). Orders count as done; what asks ends in
    /// [`Error::NotKnown`].
    pub fn dry_run(options: Options) -> Self {
        Self::new(Transport::Notes(Plan::default()), Image::BYTES, options)
    }

    /// Without a link: for whoever asks nothing of the controller, but of the device on its fieldbus. Whatever is asked
    /// of the controller ends in [`Error::Silent`].
    pub fn apart(options: Options) -> Self {
        Self::new(Transport::Nothing, Image::BYTES, Options { commands: false, ..options })
    }

    fn new(transport: Transport, size: usize, options: Options) -> Self {
        let Options { commands, is_held, granted, timeout, retries } = options;
        let policy = Policy {
            ready: timeout,
            accept: timeout,
            release: timeout,
            stop: STOP_WITHIN,
            quick: timeout.max(QUICK),
            power: timeout.max(POWER),
            ..Policy::default()
        };
        Self {
            transport,
            size,
            is_owner: commands,
            output: Output::new(resting()),
            shown: None,
            in_flight: false,
            input: None,
            is_up: true,
            exchange: None,
            ended: None,
            sequence: None,
            finished: None,
            policy,
            patience: timeout.max(QUICK),
            timeout,
            retries,
            granted,
            has_started: false,
            words: Words::default(),
            is_held,
            is_shared: false,
            is_over: false,
            started: Instant::now(),
            watcher: Box::new(()),
            totals: Totals::default(),
        }
    }

    /// Has this one told what happens from now on.
    pub fn watch(&mut self, watcher: impl Watcher<Event> + 'static) {
        self.watcher = Box::new(watcher);
    }

    /// What may leave from now on.
    pub fn grant(&mut self, granted: Grant) {
        self.granted = granted;
    }

    /// The last check before something leaves: whether `what` may.
    ///
    /// # Errors
    /// [`Error::NotAuthorized`].
    pub fn authorize(&self, what: &str, risk: Risk) -> Result<(), Error> {
        Ok(self.granted.check(risk, what)?)
    }

    /// Whether a session holds the link, and others may use it at the same time.
    pub fn is_shared(&self) -> bool {
        self.is_shared
    }

    /// Whether the connection outlives the client.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Whether commands can be given, or signals only be seen.
    pub fn commands(&self) -> bool {
        self.is_owner
    }

    /// Whether the fieldbus carries the words of remote commands, or signals alone.
    pub fn has_commands(&self) -> bool {
        self.size == 0 || Image::has_commands(self.size)
    }

    /// What was done so far.
    pub fn totals(&self) -> Totals {
        self.totals
    }

    /// What the link counted; `None` for what has no network of its own.
    pub fn traffic(&self) -> Option<Traffic> {
        match &self.transport {
            Transport::Image(link) => link.traffic(),
            Transport::Notes(_) | Transport::Nothing => None,
        }
    }

    /// Ends the connection: [`leave`](Self::leave), and [`end`](Self::end). A controller takes the end of a connection that
    /// no session holds for a fault of the link: it stops, and raises an alarm.
    ///
    /// # Errors
    /// What went wrong in leaving, or else in ending.
    pub async fn close(mut self) -> Result<Totals, Error> {
        let left = self.leave().await;
        let totals = self.totals;
        let ended = self.end().await;
        left?;
        ended?;
        Ok(totals)
    }

    /// Ends the connection as it stands; one that a session holds goes on.
    ///
    /// # Errors
    /// The other end did not hear of it.
    pub async fn end(self) -> Result<(), LinkError> {
        match self.transport {
            Transport::Image(link) => link.close().await,
            Transport::Notes(_) | Transport::Nothing => Ok(()),
        }
    }
}

//! OMRON / Yamaha YRCX client: drives the sessions over process images on a fieldbus.
//!
//! At most one remote command and one signal procedure run at a time; the controller accepts both together (chapters
//! 1 and 2 of the manual). Both are polled in every turn. Calls may be dropped at any await: the client keeps the
//! running command, and [`Client::stop`] can end it properly. A command of a dropped call advances only while another
//! call is awaited.
//!
//! Any [`ImageLink`] works: EtherNet/IP, DeviceNet, PROFIBUS, a session, or a simulator in this process.

mod continuous_output;
mod error;
mod event_loop;
mod exchange;
mod general_words;
mod jog;
mod plan;
mod session_rules;
mod shared;
mod signals;
mod simulated;
mod stop;
#[cfg(test)]
mod tests;

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
pub use self::exchange::{Done, Reply};
pub use self::plan::hex;
pub use self::session_rules::hold;
pub use self::simulated::Simulated;
pub use self::stop::StopResult;
use crate::{Grant, Plan, STOP_WITHIN, Watcher};

/// A connection to one controller. It belongs to one thread, as fieldbus links do.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent state")]
pub struct Client {
    transport: Transport,
    /// Size of the output image in bytes; 0 without one.
    size: usize,
    /// Whether this connection owns the output image; otherwise it only monitors.
    is_owner: bool,
    /// The output image to send.
    output: Output,
    /// The output image last passed to the transport.
    last_output: Option<Image>,
    /// Whether the transport has not sent it yet. No newer image is passed until then: a command must not overtake its
    /// data.
    in_flight: bool,
    /// The input image; `None` while the link is down.
    input: Option<Image>,
    is_up: bool,
    /// The running remote command, and the outcome of the last one.
    exchange: Option<Exchange>,
    ended: Option<Outcome>,
    /// The running procedure, and the outcome of the last one.
    sequence: Option<Sequence>,
    finished: Option<sequence::Outcome>,
    policy: Policy,
    /// Time limit of a procedure for one output signal.
    procedure_timeout: Duration,
    timeout: Duration,
    retries: u32,
    grant: Grant,
    /// Whether a program, or a motion by signals, was started that continues by itself.
    has_started: bool,
    /// General-purpose words before a remote command, which are restored after it.
    words: Words,
    /// Whether the link outlives the client, so that a motion or program can continue.
    is_held: bool,
    /// Whether a session holds the link, so that others may use it too.
    is_shared: bool,
    /// Whether a remote command has ended, so that another client may send the next one.
    is_turn_over: bool,
    started: Instant,
    watcher: Box<dyn Watcher<Event>>,
    totals: Totals,
}

#[derive(Debug)]
enum Transport {
    Image(Box<ImageLink>),
    /// A dry run: requests are only planned.
    DryRun(Plan),
    /// No transport.
    Nothing,
}

/// Settings of a client.
#[derive(Debug, Clone)]
pub struct Options {
    /// Whether the client commands the controller; otherwise it only monitors the signals.
    pub commands: bool,
    /// Whether the connection outlives the client, so that a motion or program can continue. A controller stops when
    /// its connection ends.
    pub is_held: bool,
    /// The highest risk that may be sent.
    pub grant: Grant,
    /// Time limit of one attempt: until the controller is ready, takes a command, or sends an image. Execution has its
    /// own limits: at least 10 s, 30 s for motor power, none for motions.
    pub timeout: Duration,
    /// Retries of a command that changes nothing. No attempt begins after `timeout` times (`retries` + 1).
    pub retries: u32,
}

impl Default for Options {
    /// Read only, on a connection that commands the controller, with the default limits: 3 s, 3 retries.
    fn default() -> Self {
        Self { commands: true, is_held: false, grant: Grant::default(), timeout: Policy::default().accept, retries: 3 }
    }
}

impl Options {
    /// Authorizes this risk and everything below it.
    #[must_use]
    pub fn with_risk(self, risk: Risk) -> Self {
        Self { grant: Grant::up_to(risk), ..self }
    }
}

/// An event of a client.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Event {
    /// This image was sent to the controller.
    ImageSent(Image),
    /// This image was received from the controller.
    ImageReceived(Image),
    /// CPU OK (SO(01)) is off in the first image of a monitoring connection: the controller is not working, or the data
    /// does not come from a controller.
    CpuNotOk,
    /// The link was lost. Everything that ran has ended, and the controller stops.
    Lost {
        /// The cause.
        why: LinkError,
        /// Whether the link is being reopened.
        is_reopening: bool,
    },
    /// The link is open again.
    Reopened {
        /// State of the stop input SI(06); `None` on a monitoring connection.
        stop: Option<bool>,
    },
    /// The controller had this status before the command; it is reset first.
    StatusReset(Command, Status),
    /// The command has ended, and the controller is not ready again.
    NotReleased(Command),
    /// A command that ran on without a caller was refused or aborted.
    Aborted(Command, Alarm),
    /// A command that ran on without a caller ended without an answer.
    Unanswered(Error),
    /// A command that another client of the session had left running has ended.
    OtherCommandEnded {
        /// WI0 to WI15.
        words: Words,
        /// WO0 to WO15.
        answer: Words,
    },
    /// The stop input SI(06) is about to go off.
    Stopping,
}

/// Activity of a client.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Remote commands sent.
    pub commands: u32,
    /// Total time from sending to the end of the commands.
    pub waited: Duration,
    /// Losses of the link.
    pub losses: u32,
}

/// Minimum time limit where the manual gives none.
const QUICK_WITHIN: Duration = Duration::from_secs(10);
const POWER_WITHIN: Duration = Duration::from_secs(30);

impl Client {
    /// Takes over a link and waits for the first image of the controller: [`over`](Self::over) and
    /// [`ready`](Self::ready). Sends the resting image: emergency stop and stop inputs on, everything else off.
    ///
    /// # Errors
    /// [`Error::Silent`] without an image within the time limit. The link is then closed.
    pub async fn connect(link: ImageLink, options: Options) -> Result<Self, Error> {
        let mut client = Self::over(link, options);
        match client.ready().await {
            Ok(()) => Ok(client),
            Err(error) => {
                // The missing image is the useful error, not a failed close.
                let _ = client.close().await;
                Err(error)
            }
        }
    }

    /// Connects to a new simulator in this process.
    ///
    /// # Errors
    /// None are known.
    pub async fn simulated(start: Start, options: Options) -> Result<Self, Error> {
        let peer = Box::new(Simulated::new(start));
        Self::connect(ImageLink::in_process(peer), Options { is_held: true, ..options }).await
    }

    /// Takes over a link. Sends nothing yet: see [`ready`](Self::ready). Clients of a session share the link and take
    /// turns with remote commands.
    pub fn over(link: ImageLink, options: Options) -> Self {
        let size = link.output_size();
        let mut client = Self::new(Transport::Image(Box::new(link)), size, options);
        client.join();
        client
    }

    /// Starts a dry run: requests are planned ([`Client::take_plan`]) and not sent. Orders count as carried out; a read
    /// returns [`Error::DryRun`].
    pub fn dry_run(options: Options) -> Self {
        Self::new(Transport::DryRun(Plan::default()), Image::BYTES, options)
    }

    /// A client without a link, for requests to the fieldbus device only. A request to the controller returns
    /// [`Error::Silent`].
    pub fn without_link(options: Options) -> Self {
        Self::new(Transport::Nothing, Image::BYTES, Options { commands: false, ..options })
    }

    fn new(transport: Transport, size: usize, options: Options) -> Self {
        let Options { commands, is_held, grant, timeout, retries } = options;
        let policy = Policy {
            ready: timeout,
            accept: timeout,
            release: timeout,
            stop: STOP_WITHIN,
            quick: timeout.max(QUICK_WITHIN),
            power: timeout.max(POWER_WITHIN),
            ..Policy::default()
        };
        Self {
            transport,
            size,
            is_owner: commands,
            output: Output::new(resting()),
            last_output: None,
            in_flight: false,
            input: None,
            is_up: true,
            exchange: None,
            ended: None,
            sequence: None,
            finished: None,
            policy,
            procedure_timeout: timeout.max(QUICK_WITHIN),
            timeout,
            retries,
            grant,
            has_started: false,
            words: Words::default(),
            is_held,
            is_shared: false,
            is_turn_over: false,
            started: Instant::now(),
            watcher: Box::new(()),
            totals: Totals::default(),
        }
    }

    /// Sets the observer.
    pub fn watch(&mut self, watcher: impl Watcher<Event> + 'static) {
        self.watcher = Box::new(watcher);
    }

    /// Sets the grant for all further requests.
    pub fn grant(&mut self, grant: Grant) {
        self.grant = grant;
    }

    /// Checks one request, as the last step before it is sent.
    ///
    /// # Errors
    /// [`Error::NotAuthorized`].
    pub fn authorize(&self, what: &str, risk: Risk) -> Result<(), Error> {
        Ok(self.grant.check(risk, what)?)
    }

    /// Whether a session holds the link, so that others may use it too.
    pub fn is_shared(&self) -> bool {
        self.is_shared
    }

    /// Whether the connection outlives the client.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Whether the client can send commands, or only monitors signals.
    pub fn commands(&self) -> bool {
        self.is_owner
    }

    /// Whether the fieldbus carries the words of remote commands, or only signals.
    pub fn has_commands(&self) -> bool {
        self.size == 0 || Image::has_commands(self.size)
    }

    /// Activity so far.
    pub fn totals(&self) -> Totals {
        self.totals
    }

    /// Traffic of the link; `None` without a network.
    pub fn traffic(&self) -> Option<Traffic> {
        match &self.transport {
            Transport::Image(link) => link.traffic(),
            Transport::DryRun(_) | Transport::Nothing => None,
        }
    }

    /// Ends the connection: [`leave`](Self::leave), then [`end`](Self::end). Without a session, a controller treats the
    /// end of the connection as a link fault: it stops and raises an alarm.
    ///
    /// # Errors
    /// The first error of the two.
    pub async fn close(mut self) -> Result<Totals, Error> {
        let left = self.leave().await;
        let totals = self.totals;
        let ended = self.end().await;
        left?;
        ended?;
        Ok(totals)
    }

    /// Ends the connection at once; a session keeps its own.
    ///
    /// # Errors
    /// The peer did not receive the close.
    pub async fn end(self) -> Result<(), LinkError> {
        match self.transport {
            Transport::Image(link) => link.close().await,
            Transport::DryRun(_) | Transport::Nothing => Ok(()),
        }
    }
}

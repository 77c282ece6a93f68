//! OMRON / Yamaha YRCX client: runs the protocol sessions over process images on a fieldbus.
//!
//! At most one remote command and one signal procedure run at a time; the controller accepts both together (chapters 1
//! and 2 of the manual). The client polls both in every turn. A call may be dropped at any await: the client keeps the
//! running command, and [`Client::stop`] can end it properly. The command of a dropped call advances only while another
//! call is awaited.
//!
//! Any [`ImageLink`] works: EtherNet/IP, DeviceNet, PROFIBUS, a session, or a simulator in this process.

mod continuous_output;
mod eip;
mod error;
mod event_loop;
mod exchange;
mod general_words;
mod jog;
mod plan;
mod protocol;
mod session_rules;
mod shared;
mod signals;
mod simulated;
mod stop;
#[cfg(test)]
mod tests;

use std::time::Duration;

use armctl_controller::Risk;
use armctl_controller::yrcx::image::Output;
use armctl_controller::yrcx::sequence::Sequence;
use armctl_controller::yrcx::session::{Exchange, Outcome, Policy};
use armctl_controller::yrcx::signal::resting;
use tokio::time::Instant;

pub use self::eip::{EIP_PORT, open_eip};
pub use self::error::{Error, Refusal};
pub use self::exchange::{CompletedCommand, Reply};
pub use self::plan::hex;
#[doc(inline)]
pub use self::protocol::*;
pub use self::session_rules::open_session_link;
pub use self::simulated::Simulated;
pub use self::stop::StopResult;
use crate::{Grant, LONGEST_TIMEOUT, Plan, STOP_TIMEOUT, Watcher};

/// A connection to one controller. The client must stay on one thread, because fieldbus links must too.
///
/// ```
/// use armctl_client::yrcx::{Client, Command, CompletedCommand, Key, Options, Procedure, Start, Totals, output};
/// use armctl_client::Risk;
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let options = Options { retries: 0, ..Options::default().with_risk(Risk::Motion) };
/// let mut robot = Client::simulated(Start::default(), options).await?;
/// robot.run_procedure(Procedure::power_on()).await?;
/// assert!(output::SERVO_ON.is_on(&robot.input_image().await?));
/// let read = Command::PointGet.order().with(Key::Point, 1).build()?;
/// let CompletedCommand { values, .. } = robot.ask(&read).await?;
/// println!("X is {:?}", values.millimetres(Key::Axis1));
/// let totals: Totals = robot.close().await?;
/// assert_eq!(totals.commands, 1);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent state")]
pub struct Client {
    transport: Transport,
    /// Size of the output image in bytes; 0 without an output image.
    size: usize,
    /// Whether this connection owns the output image. Otherwise it only monitors.
    is_owner: bool,
    /// The output image to send.
    output: Output,
    /// The output image last passed to the transport.
    last_output: Option<Image>,
    /// Whether the transport has not sent the last output image yet. The client passes no newer image until then: a
    /// command must not be sent before its data.
    in_flight: bool,
    /// The input image; `None` while the link is down.
    input: Option<Image>,
    is_up: bool,
    /// The running remote command. The field below is the outcome of the last command.
    exchange: Option<Exchange>,
    ended: Option<Outcome>,
    /// The running signal procedure. The field below is the outcome of the last procedure.
    sequence: Option<Sequence>,
    finished: Option<sequence::Outcome>,
    policy: Policy,
    /// Time limit for one output signal in a procedure.
    procedure_timeout: Duration,
    timeout: Duration,
    retries: u32,
    grant: Grant,
    /// Whether the client started a program, or a motion by signals, that continues by itself.
    has_started: bool,
    /// General-purpose words before a remote command. The client restores them after the command.
    words: Words,
    /// Whether the link stays open after the client ends, so that a motion or program can continue.
    is_held: bool,
    /// Whether a session owns the link, so that other clients may use the link too.
    is_shared: bool,
    /// Whether the remote command of this client has ended, so that another client may send the next command.
    is_turn_over: bool,
    /// The read whose status reset is not confirmed by the ready status; in a session, whose status reset is not sent.
    /// The next command waits for the ready status.
    resetting: Option<Command>,
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
///
/// Example: [`Client`]
#[derive(Debug, Clone)]
pub struct Options {
    /// Whether the client may send commands to the controller. If not, the client only monitors the signals.
    pub commands: bool,
    /// Whether the connection stays open after the client ends, so that a motion or program can continue. A controller
    /// stops the robot when its connection ends.
    pub is_held: bool,
    /// The highest risk that may be sent.
    pub grant: Grant,
    /// Time limit of one attempt: until the controller is ready, accepts a command, or sends an image. The execution of
    /// a command has other limits: at least 10 s, 30 s for motor power, no limit for motions.
    pub timeout: Duration,
    /// Number of retries of a command that changes nothing. No attempt starts later than `timeout` times (`retries` +
    /// 1).
    pub retries: u32,
}

impl Default for Options {
    /// Options for a connection that can command the controller. The grant authorizes only reads. The default limits
    /// are a timeout of 3 s and 3 retries.
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
///
/// Example: [`Watcher`]
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Event {
    /// This image was sent to the controller.
    ImageSent(Image),
    /// This image was received from the controller.
    ImageReceived(Image),
    /// CPU OK (SO(01)) is off in the first image of a monitoring connection. Either the controller does not work, or
    /// the data does not come from a controller.
    CpuNotOk,
    /// The link was lost. All running commands and procedures have ended, and the controller stops the robot.
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
    /// The controller had this status before the command. The client resets the status first.
    StatusReset(Command, Status),
    /// The command has ended, but the controller is not ready for the next command.
    NotReleased(Command),
    /// The controller refused or aborted a command that continued after its call was dropped.
    Aborted(Command, Alarm),
    /// A command that continued after its call was dropped ended without an answer.
    Unanswered(Error),
    /// A command of another client of the session has ended. The other client had not waited for its end.
    OtherCommandEnded {
        /// Words WI0 to WI15.
        words: Words,
        /// Words WO0 to WO15.
        answer: Words,
    },
    /// The client is about to switch the stop input SI(06) off.
    Stopping,
}

/// Activity of a client.
///
/// Example: [`Client`]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Remote commands sent.
    pub commands: u32,
    /// Total execution time of the commands, from sending to their end.
    pub waited: Duration,
    /// Number of times that the link was lost.
    pub losses: u32,
}

/// Shortest time limit of a command for which the manual gives no limit.
const QUICK_TIMEOUT: Duration = Duration::from_secs(10);
const POWER_TIMEOUT: Duration = Duration::from_secs(30);

impl Client {
    /// Creates a client on a link ([`over`](Self::over)) and waits for the first image of the controller
    /// ([`ready`](Self::ready)). Sends the resting image: emergency stop and stop inputs on, everything else off.
    ///
    /// # Errors
    /// [`Error::Silent`] without an image within the time limit. The link is then closed.
    pub async fn connect(link: ImageLink, options: Options) -> Result<Self, Error> {
        let mut client = Self::over(link, options);
        match client.ready().await {
            Ok(()) => Ok(client),
            Err(error) => {
                // An error of the close is ignored: the missing image is the more useful error.
                let _ = client.close().await;
                Err(error)
            }
        }
    }

    /// Connects to a new simulator in this process.
    ///
    /// # Errors
    /// No error is known.
    pub async fn simulated(start: Start, options: Options) -> Result<Self, Error> {
        let peer = Box::new(Simulated::new(start));
        Self::connect(ImageLink::in_process(peer), Options { is_held: true, ..options }).await
    }

    /// Creates a client on a link, and sends nothing yet: see [`ready`](Self::ready). Clients of a session share the
    /// link and take turns with remote commands.
    pub fn over(link: ImageLink, options: Options) -> Self {
        let size = link.output_size();
        let mut client = Self::new(Transport::Image(Box::new(link)), size, options);
        client.join();
        client
    }

    /// Creates a client for a dry run: it plans requests ([`Client::take_plan`]) and does not send them. Orders count
    /// as carried out; a read returns [`Error::DryRun`].
    pub fn dry_run(options: Options) -> Self {
        Self::new(Transport::DryRun(Plan::default()), Image::BYTES, options)
    }

    /// Creates a client without a link, only for requests to the fieldbus device. A request to the controller returns
    /// [`Error::Silent`].
    pub fn without_link(options: Options) -> Self {
        Self::new(Transport::Nothing, Image::BYTES, Options { commands: false, ..options })
    }

    fn new(transport: Transport, size: usize, options: Options) -> Self {
        let Options { commands, is_held, grant, timeout, retries } = options;
        let timeout = timeout.min(LONGEST_TIMEOUT);
        let policy = Policy {
            ready: timeout,
            accept: timeout,
            release: timeout,
            stop: STOP_TIMEOUT,
            quick: timeout.max(QUICK_TIMEOUT),
            power: timeout.max(POWER_TIMEOUT),
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
            procedure_timeout: timeout.max(QUICK_TIMEOUT),
            timeout,
            retries,
            grant,
            has_started: false,
            words: Words::default(),
            is_held,
            is_shared: false,
            is_turn_over: false,
            resetting: None,
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

    /// Checks one request, as the last step before the request is sent.
    ///
    /// # Errors
    /// [`Error::NotAuthorized`].
    pub fn authorize(&self, what: &str, risk: Risk) -> Result<(), Error> {
        Ok(self.grant.check(risk, what)?)
    }

    /// Whether a session owns the link, so that other clients may use the link too.
    pub fn is_shared(&self) -> bool {
        self.is_shared
    }

    /// Whether the connection stays open after the client ends.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Whether the client can send commands. If not, the client only monitors signals.
    pub fn commands(&self) -> bool {
        self.is_owner
    }

    /// Whether the fieldbus carries the words of remote commands. If not, the fieldbus carries only signals.
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

    /// Ends the connection: [`leave`](Self::leave), then [`end`](Self::end). Without a session, the controller handles
    /// the end of the connection as a link fault: it stops the robot and raises an alarm.
    ///
    /// # Errors
    /// The first error of the two calls.
    pub async fn close(mut self) -> Result<Totals, Error> {
        let left = self.leave().await;
        let totals = self.totals;
        let ended = self.end().await;
        left?;
        ended?;
        Ok(totals)
    }

    /// Ends the connection at once. A session keeps its own connection to the controller.
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

//! Toyo client: runs the protocol session over a serial line. `TO` is the manual of the host communication over
//! RS-232C.

mod axis_letters;
mod error;
mod fence;
mod options;
mod plan;
mod protocol;
mod simulated;
mod stop;
mod temporary_changes;
#[cfg(test)]
mod tests;
mod transport;

use std::io;
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::toyo::session::{ExchangeResult, LineSession, Policy};
use armctl_controller::{Risk, Session as _, Step};
use armctl_transport::session::client::SessionBusy;
use armctl_transport::tap::Direction;
use tokio::time::Instant;

pub use self::axis_letters::{Letters, letters_request};
pub use self::error::{Error, Refusal, Unanswered};
pub use self::fence::FENCE;
pub use self::options::{Event, Options, Totals};
#[doc(inline)]
pub use self::protocol::*;
pub use self::simulated::Simulated;
pub use self::stop::MotionKind;
use self::temporary_changes::{HostState, needs_host};
pub use self::transport::{BAUD, BITS, Endpoint, Line, Opening};
use self::transport::{Opener, Transport, no_addresses};
use crate::{AddressPair, Grant, LONGEST_TIMEOUT, NotAuthorized, Plan, Reason, Watcher};

/// A connection to one controller.
///
/// The client processes one request at a time. A call may be dropped before its end: the client stays usable, because
/// the session discards late answers.
///
/// ```
/// use std::time::Duration;
///
/// use armctl_client::toyo::{Client, Command, Endpoint, Options, Request, Totals, Value};
/// use armctl_client::Risk;
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let options = Options { timeout: Duration::from_secs(2), ..Options::default().with_risk(Risk::Write) };
/// let mut robot = Client::connect(Endpoint::simulator(), options).await?;
/// let write = Request::new(Command::Mcst, vec![Value::Number(1), Value::Number(42)])?;
/// robot.ask(&write).await?;
/// let read = Request::new(Command::Mcnt, vec![Value::Number(1)])?;
/// assert_eq!(robot.ask(&read).await?.number("count"), Some(42));
/// let (totals, closed): (Totals, _) = robot.close().await;
/// closed?;
/// println!("{:?}", totals.counters);
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Client {
    transport: Transport,
    session: LineSession,
    /// The policy from [`Options`]. The field below is the policy in use, which can have shorter time limits
    /// ([`Client::use_short_timeouts`]).
    configured_policy: Policy,
    policy: Policy,
    grant: Grant,
    /// The motion that this client started.
    moving: Option<MotionKind>,
    host: HostState,
    /// Requests that undo temporary changes, in the order of the changes.
    undo_requests: Vec<Request>,
    started: Instant,
    watcher: Box<dyn Watcher<Event>>,
    waited: Duration,
    /// Whether the line is lost. The client then sends only reads, and reopens the line first.
    is_line_lost: bool,
    opener: Option<Opener>,
    address_pair: Option<AddressPair>,
    /// Whether all answers to earlier requests have arrived, so that an order needs no fence.
    is_fenced: bool,
    /// Dry run: the earlier answer that decides whether the last planned frame is sent.
    plan_condition: Option<String>,
    /// Dry run: the blocks that undo temporary changes.
    planned_undo_blocks: Vec<String>,
    /// Axis letters; `None` until they are read.
    letters: Option<Letters>,
}

const BUFFER: usize = 1024;
/// Maximum number of characters in one exchange: about 5 s at the highest baud rate. Answers are much shorter.
const MAX_RECEIVED: usize = 64 * 1024;
/// Time limit of an answer while a motion is in progress that this client must stop.
const MOTION_TIMEOUT: Duration = Duration::from_millis(300);
/// The status page with the host state.
const HOST_PAGE: u8 = 2;
/// Longest wait in one turn of an exchange without a deadline.
const IDLE_POLL_INTERVAL: Duration = Duration::from_secs(3600);

impl Client {
    /// Opens the line to a controller. This function sends nothing: only the first answer shows that a controller is
    /// connected.
    ///
    /// # Errors
    /// [`Error::Port`] or [`Error::DeviceServer`] if the line cannot be opened.
    pub async fn connect(endpoint: Endpoint, options: Options) -> Result<Self, Error> {
        let timeout = options.timeout.min(LONGEST_TIMEOUT);
        let mut client = Self::over(endpoint.open(timeout).await?, endpoint.character(), options);
        client.reopen_by(move || {
            let endpoint = endpoint.clone();
            Box::pin(async move { endpoint.open(timeout).await })
        });
        Ok(client)
    }

    /// Creates a client on an open line. `character` is the transmission time of one character.
    pub fn over(line: Line, character: Duration, options: Options) -> Self {
        Self::with(Transport::Line(Box::new(line)), character, options)
    }

    /// Creates a client for a dry run: it plans requests ([`Client::take_plan`]) and does not send them. Orders count
    /// as carried out; a read returns [`Error::DryRun`].
    pub fn dry_run(options: Options) -> Self {
        Self::with(Transport::DryRun(Plan::default()), Duration::ZERO, options)
    }

    fn with(transport: Transport, character: Duration, options: Options) -> Self {
        let policy = Policy {
            timeout: options.timeout.min(LONGEST_TIMEOUT),
            retries: options.retries,
            character: character.min(LONGEST_TIMEOUT),
        };
        Self {
            address_pair: transport.address_pair(),
            transport,
            session: LineSession::new(policy),
            configured_policy: policy,
            policy,
            grant: options.grant,
            moving: None,
            host: HostState::Unknown,
            undo_requests: Vec::new(),
            started: Instant::now(),
            watcher: Box::new(()),
            waited: Duration::ZERO,
            is_line_lost: false,
            opener: None,
            is_fenced: false,
            plan_condition: None,
            planned_undo_blocks: Vec::new(),
            letters: None,
        }
    }

    /// Sets the observer. For a line without addresses, the observer gets unspecified addresses.
    pub fn watch(&mut self, watcher: impl Watcher<Event> + 'static) {
        self.watcher = Box::new(watcher);
    }

    /// Sets the function that reopens a lost line for a read.
    #[doc(hidden)]
    pub fn reopen_by(&mut self, open: impl Fn() -> Opening + Send + 'static) {
        self.opener = Some(Opener(Box::new(open)));
    }

    /// Sets the grant for all further requests.
    pub fn grant(&mut self, grant: Grant) {
        self.grant = grant;
    }

    /// Local and remote address of a TCP connection.
    pub fn address_pair(&self) -> Option<AddressPair> {
        self.address_pair
    }

    /// Sends one request, and returns a refusal as an error. The record of a parameter (RPAR), step (RSTX) or
    /// palletizing record (RPLT) contains the stored values, in the units of [`Record`]. The record of an order
    /// contains `OK`.
    pub async fn ask(&mut self, request: &Request) -> Result<Record, Error> {
        Ok(self.try_ask(request).await??)
    }

    /// Sends one request, and returns a refusal as a value. If the request is an order that requires the host, the
    /// client switches the host ON first. In a dry run, orders count as carried out and a read returns
    /// [`Error::DryRun`].
    pub async fn try_ask(&mut self, request: &Request) -> Result<Result<Record, Refusal>, Error> {
        if needs_host(request) {
            match self.take_host().await {
                // The manual does not say that this order requires the host (ambiguity C14): the controller decides.
                Err(Error::PendantOn) if !request.row().needs_host => {}
                taken => taken?,
            }
        }
        if request.risk() > Risk::Read {
            self.fence().await?;
        }
        self.ask_now(request).await
    }

    /// Sends one request like [`Self::try_ask`], but does not switch the host ON and sends no fence.
    async fn ask_now(&mut self, request: &Request) -> Result<Result<Record, Refusal>, Error> {
        let done = || Record::unlisted("OK");
        if self.is_dry_run() {
            self.authorize(request.risk(), &request.text())?;
            self.note(request, Reason::default());
            return if request.row().is_order() { Ok(Ok(done())) } else { Err(Error::DryRun) };
        }
        let record = match self.transact_fenced(request).await? {
            Answer::Refused => return Ok(Err(Refusal(request.clone()))),
            Answer::Done => done(),
            Answer::Data(record) => record,
        };
        if request.command() == Command::Mtsk && self.undo_requests.is_empty() {
            self.watcher.event(Event::Task(record.number("task")));
        }
        let content = request.answered(&record).map_err(|error| malformed(&record.written(), &error))?;
        Ok(Ok(content.unwrap_or(record)))
    }

    /// Sends a request and returns the answer, which may be a refusal. The client does not switch the host ON for this
    /// request.
    pub async fn raw(&mut self, request: &Request) -> Result<Answer, Error> {
        if request.risk() > Risk::Read && !is_stop(request) {
            self.fence().await?;
        }
        let planned = self.plan_all(std::slice::from_ref(request));
        if planned.is_err() && request.row().is_order() {
            // If an order is sent, a fence follows the order (see [`Self::settle`]).
            self.plan_fence();
        }
        planned?;
        self.transact_fenced(request).await
    }

    /// Sends a free-text block and returns the answer. The effect of the block is unknown, so the block counts as a
    /// motion.
    pub async fn raw_text(&mut self, block: &str) -> Result<String, Error> {
        self.authorize(Risk::Motion, block)?;
        self.fence().await?;
        if self.is_dry_run() {
            self.note_text(block, Reason::default());
            return Err(Error::DryRun);
        }
        self.acquire(Risk::Motion).await?;
        self.is_fenced = false;
        self.set_moving(Some(MotionKind::Program));
        self.session.begin_raw(block);
        match self.exchange(Risk::Motion).await? {
            ExchangeResult::Answered(answer) => Ok(answer),
            ended => Err(self.unanswered(ended, Risk::Motion, None)),
        }
    }

    /// Confirms that the last order received its own answer, and not the answer to another order. Sends a harmless
    /// read, unless a read was answered after the order. The controller answers in the order of the requests, so all
    /// answers to the order arrive before the answer to the read.
    ///
    /// # Errors
    /// [`Error::OutcomeUnknown`] if the order received two contradictory answers.
    pub async fn settle(&mut self) -> Result<(), Error> {
        let is_open = if self.is_dry_run() { self.transport.has_notes() } else { self.session.is_open() };
        if !is_open || self.is_line_lost {
            return Ok(());
        }
        self.fence_at_end().await
    }

    /// Reads all five status pages (TO 2-2).
    ///
    /// # Errors
    /// [`Error::StatusRefused`] if the controller refuses.
    pub async fn status(&mut self) -> Result<Status, Error> {
        self.status_of(&[0, 1, 2, 3, 4]).await
    }

    /// Reads some of the status pages 0 to 4. Pages that were not read are 0 in the result.
    ///
    /// # Errors
    /// [`Error::StatusRefused`] if the controller refuses.
    pub async fn status_of(&mut self, pages: &[u8]) -> Result<Status, Error> {
        self.plan_all(&pages.iter().copied().map(status_page).collect::<Vec<_>>())?;
        let mut status = Status::default();
        for page in pages {
            let record = self.ask_now(&status_page(*page)).await?.map_err(|_| Error::StatusRefused)?;
            let byte = record.byte("st1");
            status = status.with(*page, byte.ok_or_else(|| malformed(&record.written(), "it contains no status"))?);
        }
        if pages.contains(&HOST_PAGE) {
            self.watcher.event(Event::Host { status, is_taken: self.host == HostState::SwitchedOn });
        }
        Ok(status)
    }

    /// Reads the axis positions: `x`, `y`, `z` and `r` in hundredths of a millimeter (MPST, TO 2-8).
    ///
    /// # Errors
    /// [`Error::StatusRefused`] if the controller refuses.
    pub async fn read_position(&mut self) -> Result<Record, Error> {
        self.ask_now(&Request::bare(Command::Mpst)).await?.map_err(|_| Error::StatusRefused)
    }

    /// Line statistics so far.
    pub fn totals(&self) -> Totals {
        Totals { counters: self.session.counters(), waited: self.waited }
    }

    /// Undoes all temporary changes and closes the connection. The line statistics are returned even if there is an
    /// error.
    pub async fn close(mut self) -> (Totals, Result<(), Error>) {
        let put_back = self.put_back().await;
        let given_back = put_back.and(self.give_back().await);
        let totals = self.totals();
        if let Some(line) = self.into_line() {
            line.leave().await;
        }
        (totals, given_back)
    }

    /// Returns the line for further use; `None` in a dry run.
    pub fn into_line(self) -> Option<Line> {
        match self.transport {
            Transport::Line(line) => Some(*line),
            Transport::DryRun(_) => None,
        }
    }

    /// Uses a short time limit without retries until [`Client::stop`] is called. A jog runs until it is stopped, so the
    /// client must detect a lost connection at once.
    pub fn use_short_timeouts(&mut self) {
        self.set_policy(Policy { timeout: MOTION_TIMEOUT, retries: 0, ..self.configured_policy });
    }

    /// The motion that this client started, if it may still be in progress.
    pub fn moving(&self) -> Option<MotionKind> {
        self.moving
    }

    /// Records that the motion of this client has ended.
    pub fn end_motion(&mut self) {
        self.set_moving(None);
    }

    /// Whether the line is lost.
    pub fn is_line_lost(&self) -> bool {
        self.is_line_lost
    }

    fn set_policy(&mut self, policy: Policy) {
        self.policy = policy;
        self.session.set_policy(policy);
    }

    fn set_moving(&mut self, moving: Option<MotionKind>) {
        self.moving = moving;
        self.watcher.event(Event::Motion(moving));
    }

    fn authorize(&self, risk: Risk, block: &str) -> Result<(), NotAuthorized> {
        self.grant.check(risk, block)
    }

    /// Authorizes and sends one request. Only a read is repeated after a timeout.
    async fn transact_fenced(&mut self, request: &Request) -> Result<Answer, Error> {
        self.authorize(request.risk(), &request.text())?;
        self.transact(request, request.risk() == Risk::Read).await
    }

    async fn transact(&mut self, request: &Request, is_repeatable: bool) -> Result<Answer, Error> {
        let risk = request.risk();
        request.check()?;
        self.reopen_for_read(risk).await?;
        self.acquire(risk).await?;
        self.is_fenced = false;
        if risk == Risk::Destroy {
            // A request of this risk may change the axis letters (E01): it may be a write of E01, or a load from a
            // memory card.
            self.letters = None;
        }
        if risk == Risk::Motion {
            self.set_moving(Some(if request.command() == Command::Jgst {
                MotionKind::Jog
            } else {
                MotionKind::Program
            }));
        }
        self.session.begin(request, is_repeatable);
        let ended = self.exchange(risk).await?;
        if let Some((order, why)) = self.session.take_refuted() {
            return Err(self.unanswered(why, order.risk(), Some(&order)));
        }
        match ended {
            ExchangeResult::Answered(block) => {
                // The answer to an order may be the late answer to an earlier order. An answer to a read proves that no
                // earlier answer is pending.
                self.is_fenced = risk == Risk::Read;
                if risk == Risk::Read {
                    self.watcher.answered(&|| (request.text(), block.trim_end().to_owned()));
                }
                request.answer_kept(&block).map_err(|error| malformed(&block, &error))
            }
            ended => Err(self.unanswered(ended, risk, Some(request))),
        }
    }

    /// Runs the exchange to its end. The caller may drop the future: the next exchange then discards the pending
    /// answer.
    async fn exchange(&mut self, risk: Risk) -> Result<ExchangeResult, Error> {
        let ended = self.run_exchange(risk).await;
        if let Some(line) = self.transport.line() {
            line.release_line();
        }
        ended
    }

    /// Waits for the turn of this client on a shared session. The turn ends with the next [`Client::exchange`]. A
    /// client that moves the robot also prevents motions of the other clients.
    async fn acquire(&mut self, risk: Risk) -> Result<(), Error> {
        let Some(line) = self.transport.line() else { return Ok(()) };
        let until = Instant::now() + self.policy.timeout.max(self.configured_policy.timeout);
        if risk == Risk::Motion {
            line.claim_motion().await.map_err(Error::Session)?;
        }
        line.take(until).await.map_err(Error::Session)
    }

    async fn run_exchange(&mut self, risk: Risk) -> Result<ExchangeResult, Error> {
        let began = self.started.elapsed();
        let mut now = began;
        let mut is_sent = false;
        let mut total = 0;
        let mut buffer = [0; BUFFER];
        loop {
            let step = match self.session.poll(now) {
                Step::Send(bytes) => {
                    let sent = self.send(&bytes).await;
                    // A session sends a block completely or not at all. A line without a session may have sent a part
                    // of the block before the error.
                    is_sent |= sent.is_ok() || !self.transport.is_shared();
                    sent.map(|()| 0)
                }
                Step::Wait(until) => {
                    self.receive(&mut buffer, self.started + until.min(now + IDLE_POLL_INTERVAL)).await
                }
                Step::Done(ended) => {
                    self.waited += now.saturating_sub(began);
                    return Ok(ended);
                }
                Step::Data(_) | Step::Feed => Ok(0),
            };
            let received = step.map_err(|error| self.line_error(error, is_sent && risk > Risk::Read))?;
            total += received;
            if total > MAX_RECEIVED {
                let error = Error::TooMuchData { received: total };
                return Err(if is_sent && risk > Risk::Read {
                    Error::LostAfterSending(Box::new(error))
                } else {
                    error
                });
            }
            now = self.started.elapsed();
            self.session.handle(now, buffer.get(..received).unwrap_or_default());
        }
    }

    async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let Some(line) = self.transport.line() else { return Ok(()) };
        self.watcher.frame(Direction::Sent, self.address_pair.unwrap_or_else(no_addresses), bytes);
        line.send(bytes).await
    }

    /// Receives into the buffer; returns 0 at the deadline.
    async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<usize> {
        let Some(line) = self.transport.line() else { return Ok(0) };
        let received = line.receive(buffer, until).await?.unwrap_or(0);
        if received > 0 {
            self.watcher.frame(
                Direction::Received,
                self.address_pair.unwrap_or_else(no_addresses),
                buffer.get(..received).unwrap_or_default(),
            );
        }
        Ok(received)
    }

    fn unanswered(&self, ended: ExchangeResult, risk: Risk, request: Option<&Request>) -> Error {
        let invalid_answer = match ended {
            ExchangeResult::InvalidAnswer { block, why } => Some((block, why)),
            ExchangeResult::Answered(_) | ExchangeResult::NoAnswer => None,
        };
        let (waited, counters) = (self.policy.timeout, self.session.counters());
        let unanswered = Box::new(Unanswered { request: request.cloned(), waited, counters, invalid_answer });
        if risk > Risk::Read { Error::OutcomeUnknown(unanswered) } else { Error::NoAnswer(unanswered) }
    }

    /// Returns the error of a failed line. `is_open` is `true` if the client sent an order and received no answer yet.
    fn line_error(&mut self, error: io::Error, is_open: bool) -> Error {
        // A session that rejects a block has not sent it, and the line is unchanged.
        if let Some(busy) = SessionBusy::of(&error) {
            return Error::Session(busy);
        }
        self.is_line_lost = true;
        let error = Error::Io { is_shared: self.transport.is_shared(), error: Arc::new(error) };
        if is_open { Error::LostAfterSending(Box::new(error)) } else { error }
    }
}

fn malformed(block: &str, why: &(impl ToString + ?Sized)) -> Error {
    Error::Malformed { block: block.to_owned(), why: why.to_string() }
}

/// The request for a status page, 0 to 4 (STAS, TO 2-2).
pub fn status_page(page: u8) -> Request {
    Request::of(Command::Stas, [Value::Number(page.into())])
}

/// Whether the request stops a motion. A stop needs no fence.
pub fn is_stop(request: &Request) -> bool {
    match request.command() {
        Command::Stop => true,
        Command::Jgst => request.risk() < Risk::Motion,
        _ => false,
    }
}

/// A jog request (JGST, TO 2-7). The word applies to all axes, or to one axis (0 to 3) while the other axes stop.
/// Words: `RS` (reset), `SP` (stop), or a sign followed by `C` (inch), `L` (low speed) or `H` (high speed).
pub fn jog(word: &'static str, axis: Option<usize>) -> Request {
    let of = |index| if axis.is_none_or(|axis| axis == index) { word } else { "SP" };
    Request::of(Command::Jgst, [0, 1, 2, 3].map(|index| Value::Word(of(index))))
}

//! The client of a Toyo controller: the one driver that moves characters between the session and a line. `TO` is the
//! manual of its host communication over RS-232C.

mod borrowed;
mod error;
mod fence;
mod letters;
mod plan;
mod simulated;
mod stop;
#[cfg(test)]
mod tests;
mod transport;

use std::io;
use std::sync::Arc;
use std::time::Duration;

use armctl_controller::toyo::field::Value;
use armctl_controller::toyo::layout::Record;
use armctl_controller::toyo::request::{Answer, Request};
use armctl_controller::toyo::session::{Counters, Ended, LineSession, Policy};
use armctl_controller::toyo::status::Status;
use armctl_controller::toyo::table::commands::Command;
use armctl_controller::{Risk, Session as _, Step};
pub use armctl_transport::serial::OpenError;
use armctl_transport::session::client::SessionBusy;
use armctl_transport::tap::Direction;
pub use armctl_transport::tcp::ConnectError;
use tokio::time::Instant;

use self::borrowed::{Host, wants_host};
pub use self::error::{Error, Refusal, Unanswered};
pub use self::fence::FENCE;
pub use self::letters::{Letters, letters_request};
pub use self::simulated::Simulated;
pub use self::stop::Moving;
pub use self::transport::{BAUD, BITS, Endpoint, Line, Opening};
use self::transport::{Opener, Transport, no_ends};
use crate::{Ends, Grant, NotAuthorized, Plan, Reason, Watcher};

/// A connection to one controller.
///
/// It asks one thing at a time. A call that is dropped before it has ended leaves the client usable: what comes late is
/// told from what is asked next.
#[derive(Debug)]
pub struct Client {
    transport: Transport,
    session: LineSession,
    /// As the options want it, and as it is now.
    usual: Policy,
    policy: Policy,
    granted: Grant,
    /// What this client set in motion.
    moving: Option<Moving>,
    host: Host,
    /// What puts things back as they were found, the last change at the end.
    borrowed: Vec<Request>,
    started: Instant,
    watcher: Box<dyn Watcher<Event>>,
    waited: Duration,
    /// Whether the line is gone: nothing more is tried on it but what only reads, over a new one.
    is_gone: bool,
    /// How to open it again.
    opener: Option<Opener>,
    /// The addresses of a TCP connection.
    ends: Option<Ends>,
    /// Whether nothing can come any more that answers what was asked before.
    is_fenced: bool,
    /// In a dry run, what decides whether the last noted frame is sent.
    hangs_on: Option<String>,
    /// In a dry run, the blocks that put things back as they were found.
    owed: Vec<String>,
    /// Letters of the axes, once they were asked for.
    letters: Option<Letters>,
}

/// How a client asks.
#[derive(Debug, Clone)]
pub struct Options {
    /// The most that may leave.
    pub granted: Grant,
    /// The longest wait of one try, from the last character sent to the answer; the manual says one second (TO 1-3).
    pub timeout: Duration,
    /// Further tries, after silence, of a request that changes nothing.
    pub retries: u32,
}

impl Default for Options {
    /// To read, with the usual patience: 1 s, and 3 repeats.
    fn default() -> Self {
        Self { granted: Grant::default(), timeout: Duration::from_secs(1), retries: 3 }
    }
}

impl Options {
    /// The same, and what is not riskier than this may leave.
    #[must_use]
    pub fn granting(self, risk: Risk) -> Self {
        Self { granted: Grant::of(risk), ..self }
    }
}

/// What a client does beside what it is asked for, and what it notices. A change of the controller is told before it is
/// ordered: whoever writes it down can tell how to undo it if this process is killed.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum Event {
    /// This is set in motion; `None` when nothing of it moves any more.
    Moves(Option<Moving>),
    /// The host, which was OFF, is switched ON for a while; `false` when it is OFF again.
    TakesHost(bool),
    /// Something is changed for a while, and this puts it back.
    Borrows(Request),
    /// This was put back, or never changed.
    PutBack(Request),
    /// The line is gone, and this, which puts something back, is not sent.
    NotPutBack(Request),
    /// Who commands.
    Host {
        /// The page of the status that tells it, at least.
        status: Status,
        /// Whether this client has switched the host ON.
        is_taken: bool,
    },
    /// Which task is the current one, while none is borrowed.
    Task(Option<i32>),
    /// A line that was gone is there again.
    Reopened,
}

/// Room for what arrives in one piece.
const BUFFER: usize = 1024;
/// The most characters that may come in one exchange: 5 s of the fastest line, and answers are short.
const MOST_RECEIVED: usize = 64 * 1024;
/// The longest silence while something moves that must be stopped.
const SILENCE: Duration = Duration::from_millis(300);
/// The page of the status that tells who commands.
const HOST_PAGE: u8 = 2;
/// A session that waits for nothing is asked again after this.
const LONG: Duration = Duration::from_secs(3600);

impl Client {
    /// Connects to a controller. Nothing is sent: a line says nothing by itself, so only an answer shows that it is there.
    ///
    /// # Errors
    /// [`Error::Port`] and [`Error::DeviceServer`].
    pub async fn connect(endpoint: Endpoint, options: Options) -> Result<Self, Error> {
        let timeout = options.timeout;
        let mut client = Self::over(endpoint.open(timeout).await?, endpoint.character(), options);
        client.reopen_by(move || {
            let endpoint = endpoint.clone();
            Box::pin(async move { endpoint.open(timeout).await })
        });
        Ok(client)
    }

    /// Talks over a line that is open, on which one character takes so long.
    pub fn over(line: Line, character: Duration, options: Options) -> Self {
        Self::with(Transport::Line(Box::new(line)), character, options)
    }

    /// Sends nothing, but notes what would be sent ([`Client::take_plan`]). Orders count as done; what asks ends in
    /// [`Error::NotKnown`].
    pub fn dry_run(options: Options) -> Self {
        Self::with(Transport::Notes(Plan::default()), Duration::ZERO, options)
    }

    fn with(transport: Transport, character: Duration, options: Options) -> Self {
        let policy = Policy { timeout: options.timeout, retries: options.retries, character };
        Self {
            ends: transport.ends(),
            transport,
            session: LineSession::new(policy),
            usual: policy,
            policy,
            granted: options.granted,
            moving: None,
            host: Host::Unknown,
            borrowed: Vec::new(),
            started: Instant::now(),
            watcher: Box::new(()),
            waited: Duration::ZERO,
            is_gone: false,
            opener: None,
            is_fenced: false,
            hangs_on: None,
            owed: Vec::new(),
            letters: None,
        }
    }

    /// Has this one told what happens from now on. Frames of a line without addresses are told with unspecified ones.
    pub fn watch(&mut self, watcher: impl Watcher<Event> + 'static) {
        self.watcher = Box::new(watcher);
    }

    /// Has a line that is gone opened again by this, when something is asked that only reads.
    pub fn reopen_by(&mut self, open: impl Fn() -> Opening + Send + 'static) {
        self.opener = Some(Opener(Box::new(open)));
    }

    /// Lets through what this does, from now on.
    pub fn grant(&mut self, granted: Grant) {
        self.granted = granted;
    }

    /// Own and other address of a TCP connection.
    pub fn ends(&self) -> Option<Ends> {
        self.ends
    }

    /// Asks one question or gives one order; a refusal is an error. Of a parameter (RPAR), a step (RSTX) or a palletizing
    /// record (RPLT) the answer is what is stored, in the units and fields of [`Record`]; of an order it is `OK`.
    pub async fn ask(&mut self, request: &Request) -> Result<Record, Error> {
        Ok(self.try_ask(request).await??)
    }

    /// Asks one question or gives one order; a refusal is an answer. Before an order the host is taken, where that is
    /// needed. A dry run notes it: orders count as done then, and questions end in [`Error::NotKnown`].
    pub async fn try_ask(&mut self, request: &Request) -> Result<Result<Record, Refusal>, Error> {
        if wants_host(request) {
            match self.take_host().await {
                // The host is taken although the manual does not ask for it (ambiguity C14): then it decides itself.
                Err(Error::PendantOn) if !request.row().needs_host => {}
                taken => taken?,
            }
        }
        if request.risk() > Risk::Read {
            self.fence().await?;
        }
        self.ask_now(request).await
    }

    /// The same without the host, and whatever the line owes.
    async fn ask_now(&mut self, request: &Request) -> Result<Result<Record, Refusal>, Error> {
        let done = || Record::unlisted("OK");
        if self.is_dry() {
            self.authorize(request.risk(), &request.text())?;
            self.note(request, Reason::default());
            return if request.row().is_order() { Ok(Ok(done())) } else { Err(Error::NotKnown) };
        }
        let record = match self.transact_fenced(request).await? {
            Answer::Refused => return Ok(Err(Refusal(request.clone()))),
            Answer::Done => done(),
            Answer::Data(record) => record,
        };
        if request.command() == Command::Mtsk && self.borrowed.is_empty() {
            self.watcher.event(Event::Task(record.number("task")));
        }
        let content = request.answered(&record).map_err(|error| malformed(&record.written(), &error))?;
        Ok(Ok(content.unwrap_or(record)))
    }

    /// Sends a request as it is, without the host, and returns the whole answer as it stands on the line, good or bad.
    pub async fn raw(&mut self, request: &Request) -> Result<Answer, Error> {
        if request.risk() > Risk::Read && !is_stop(request) {
            self.fence().await?;
        }
        self.plan_all(std::slice::from_ref(request))?;
        self.transact_fenced(request).await
    }

    /// Sends a block that is in no table, and returns what came back. Nobody knows what it does, so it counts as a motion.
    pub async fn raw_text(&mut self, block: &str) -> Result<String, Error> {
        self.authorize(Risk::Motion, block)?;
        self.fence().await?;
        if self.is_dry() {
            self.note_text(block, Reason::default());
            return Err(Error::NotKnown);
        }
        self.acquire(Risk::Motion).await?;
        self.is_fenced = false;
        self.moves(Some(Moving::Program));
        self.session.begin_raw(block);
        match self.drive(Risk::Motion).await? {
            Ended::Answered(answer) => Ok(answer),
            ended => Err(self.unanswered(ended, Risk::Motion, None)),
        }
    }

    /// Makes sure that the last order has the answer that was taken for its own: asks something harmless, unless a question
    /// was answered since. A controller answers one block after the other, so whatever it says of the order comes before.
    ///
    /// # Errors
    /// [`Error::OutcomeUnknown`] if both answers came.
    pub async fn settle(&mut self) -> Result<(), Error> {
        let is_open = if self.is_dry() { self.transport.has_notes() } else { self.session.is_open() };
        if !is_open || self.is_gone {
            return Ok(());
        }
        self.fence_at_end().await
    }

    /// All five pages of the status (TO 2-2).
    ///
    /// # Errors
    /// [`Error::Mute`] if it is refused.
    pub async fn status(&mut self) -> Result<Status, Error> {
        self.status_of(&[0, 1, 2, 3, 4]).await
    }

    /// Some pages of the status, 0 to 4; the others are 0.
    ///
    /// # Errors
    /// [`Error::Mute`] if it is refused.
    pub async fn status_of(&mut self, pages: &[u8]) -> Result<Status, Error> {
        self.plan_all(&pages.iter().copied().map(status_page).collect::<Vec<_>>())?;
        let mut status = Status::default();
        for page in pages {
            let record = self.ask_now(&status_page(*page)).await?.map_err(|_| Error::Mute)?;
            let byte = record.byte("st1");
            status = status.with(*page, byte.ok_or_else(|| malformed(&record.written(), "there is no status in it"))?);
        }
        if pages.contains(&HOST_PAGE) {
            self.watcher.event(Event::Host { status, is_taken: self.host == Host::Taken });
        }
        Ok(status)
    }

    /// Where the axes are: `x`, `y`, `z` and `r` in hundredths of a millimetre (MPST, TO 2-8).
    ///
    /// # Errors
    /// [`Error::Mute`] if it is refused.
    pub async fn place(&mut self) -> Result<Record, Error> {
        self.ask_now(&Request::bare(Command::Mpst)).await?.map_err(|_| Error::Mute)
    }

    /// What the line was like so far.
    pub fn totals(&self) -> Totals {
        Totals { counters: self.session.counters(), waited: self.waited }
    }

    /// Puts everything back as it was found and ends the connection. What the line was like is told in any case.
    pub async fn close(mut self) -> (Totals, Result<(), Error>) {
        let put_back = self.put_back().await;
        let given_back = put_back.and(self.give_back().await);
        let totals = self.totals();
        if let Some(line) = self.into_line() {
            line.leave().await;
        }
        (totals, given_back)
    }

    /// The line, for somebody else to use; `None` in a dry run.
    pub fn into_line(self) -> Option<Line> {
        match self.transport {
            Transport::Line(line) => Some(*line),
            Transport::Notes(_) => None,
        }
    }

    /// Notices a silence at once, and asks nothing twice, until [`Client::stop`]: an axis will move until it is told to
    /// stop, and patience must not be in the way of that.
    pub fn use_short_timeouts(&mut self) {
        self.set_policy(Policy { timeout: SILENCE, retries: 0, ..self.usual });
    }

    /// What this client has set in motion, as far as it knows.
    pub fn moving(&self) -> Option<Moving> {
        self.moving
    }

    /// Nothing that this client set in motion moves any more.
    pub fn has_ended(&mut self) {
        self.moves(None);
    }

    /// Whether the line is gone.
    pub fn is_gone(&self) -> bool {
        self.is_gone
    }

    fn set_policy(&mut self, policy: Policy) {
        self.policy = policy;
        self.session.set_policy(policy);
    }

    fn moves(&mut self, moving: Option<Moving>) {
        self.moving = moving;
        self.watcher.event(Event::Moves(moving));
    }

    fn authorize(&self, risk: Risk, block: &str) -> Result<(), NotAuthorized> {
        self.granted.check(risk, block)
    }

    /// One request, one answer. Only what changes nothing is sent again after silence.
    async fn transact_fenced(&mut self, request: &Request) -> Result<Answer, Error> {
        self.authorize(request.risk(), &request.text())?;
        self.transact(request, request.risk() == Risk::Read).await
    }

    /// The same of what may be sent.
    async fn transact(&mut self, request: &Request, is_repeatable: bool) -> Result<Answer, Error> {
        let risk = request.risk();
        request.check()?;
        self.revive(risk).await?;
        self.acquire(risk).await?;
        self.is_fenced = false;
        if risk == Risk::Destroy {
            // It may write E01, or load it from a card.
            self.letters = None;
        }
        if risk == Risk::Motion {
            self.moves(Some(if request.command() == Command::Jgst { Moving::Jog } else { Moving::Program }));
        }
        self.session.begin(request, is_repeatable);
        let ended = self.drive(risk).await?;
        if let Some((order, why)) = self.session.take_refuted() {
            return Err(self.unanswered(why, order.risk(), Some(&order)));
        }
        match ended {
            Ended::Answered(block) => {
                // An order's answer tells nothing of what was before it; that of a question came after all else.
                self.is_fenced = risk == Risk::Read;
                request.answer_kept(&block).map_err(|error| malformed(&block, &error))
            }
            ended => Err(self.unanswered(ended, risk, Some(request))),
        }
    }

    /// Moves characters and time until the exchange has ended. The future may be dropped: the next exchange lets what
    /// is still owed pass.
    async fn drive(&mut self, risk: Risk) -> Result<Ended, Error> {
        let ended = self.drive_alone(risk).await;
        if let Some(line) = self.transport.line() {
            line.give();
        }
        ended
    }

    /// Where a session shares the line out: waits until it is this client's, until the end of the next [`Client::drive`].
    /// As long as this client moves the robot, no other does.
    async fn acquire(&mut self, risk: Risk) -> Result<(), Error> {
        let Some(line) = self.transport.line() else { return Ok(()) };
        let until = Instant::now() + self.policy.timeout.max(self.usual.timeout);
        if risk == Risk::Motion {
            line.claim_motion().await.map_err(Error::Session)?;
        }
        line.take(until).await.map_err(Error::Session)
    }

    async fn drive_alone(&mut self, risk: Risk) -> Result<Ended, Error> {
        let began = self.started.elapsed();
        let mut now = began;
        let mut has_left = false;
        let mut total = 0;
        let mut buffer = [0; BUFFER];
        loop {
            let step = match self.session.poll(now) {
                Step::Send(bytes) => {
                    let sent = self.send(&bytes).await;
                    // A session takes a block whole or not at all; of another line nobody knows what it took.
                    has_left |= sent.is_ok() || !self.transport.is_shared();
                    sent.map(|()| 0)
                }
                Step::Wait(until) => self.receive(&mut buffer, self.started + until.min(now + LONG)).await,
                Step::Done(ended) => {
                    self.waited += now.saturating_sub(began);
                    return Ok(ended);
                }
                Step::Data(_) | Step::Feed => Ok(0),
            };
            let received = step.map_err(|error| self.broken(error, has_left && risk > Risk::Read))?;
            total += received;
            if total > MOST_RECEIVED {
                let error = Error::Flooded { received: total };
                return Err(if has_left && risk > Risk::Read { Error::CutShort(Box::new(error)) } else { error });
            }
            now = self.started.elapsed();
            self.session.handle(now, &buffer[..received]);
        }
    }

    async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let Some(line) = self.transport.line() else { return Ok(()) };
        self.watcher.frame(Direction::Sent, self.ends.unwrap_or_else(no_ends), bytes);
        line.send(bytes).await
    }

    /// Waits for characters and puts them into the buffer; 0 if none came until then.
    async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<usize> {
        let Some(line) = self.transport.line() else { return Ok(0) };
        let received = line.receive(buffer, until).await?.unwrap_or(0);
        if received > 0 {
            self.watcher.frame(Direction::Received, self.ends.unwrap_or_else(no_ends), &buffer[..received]);
        }
        Ok(received)
    }

    /// No answer, or none that fits.
    fn unanswered(&self, ended: Ended, risk: Risk, request: Option<&Request>) -> Error {
        let unfitting = match ended {
            Ended::Unfitting { block, why } => Some((block, why)),
            Ended::Answered(_) | Ended::NoAnswer => None,
        };
        let (waited, counters) = (self.policy.timeout, self.session.counters());
        let unanswered = Box::new(Unanswered { request: request.cloned(), waited, counters, unfitting });
        if risk > Risk::Read { Error::OutcomeUnknown(unanswered) } else { Error::NoAnswer(unanswered) }
    }

    /// The line has bad news, maybe while an order is open.
    fn broken(&mut self, error: io::Error, is_open: bool) -> Error {
        // What the host did not pass on was not sent, and the line is as it was.
        if let Some(busy) = SessionBusy::of(&error) {
            return Error::Session(busy);
        }
        self.is_gone = true;
        let error = Error::Io { is_shared: self.transport.is_shared(), error: Arc::new(error) };
        if is_open { Error::CutShort(Box::new(error)) } else { error }
    }
}

/// What a line was like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Totals {
    /// Blocks sent and received, and what else came.
    pub counters: Counters,
    /// Time spent in exchanges.
    pub waited: Duration,
}

fn malformed(block: &str, why: &(impl ToString + ?Sized)) -> Error {
    Error::Malformed { block: block.to_owned(), why: why.to_string() }
}

/// Asks for a page of the status, 0 to 4 (STAS, TO 2-2).
pub fn status_page(page: u8) -> Request {
    Request::of(Command::Stas, [Value::Number(page.into())])
}

/// Whether it stops what moves: that waits for nothing.
pub fn is_stop(request: &Request) -> bool {
    match request.command() {
        Command::Stop => true,
        Command::Jgst => request.risk() < Risk::Motion,
        _ => false,
    }
}

/// JOG: one word for all axes, or one for an axis (0 to 3) while the others stop. Words are `RS` (reset), `SP` (stop), and
/// a sign with `C` (inch), `L` (low speed) or `H` (high speed) (JGST, TO 2-7).
pub fn jog(word: &'static str, axis: Option<usize>) -> Request {
    let of = |index| if axis.is_none_or(|axis| axis == index) { word } else { "SP" };
    Request::of(Command::Jgst, [0, 1, 2, 3].map(|index| Value::Word(of(index))))
}

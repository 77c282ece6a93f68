//! The connection to a controller: the one driver that moves characters between the session and a line.

mod borrowed;
pub(super) mod fence;
mod foreign;
mod left;
mod stop;
mod trouble;

use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use serde_json::json;
use tokio::time::Instant;

use super::chosen::Chosen;
use super::connect;
use super::debts::{Debts, Left};
use super::letters::Letters;
use super::position::Place;
use super::refusal;
use super::trace::Trace;
use super::wear::Wear;
use crate::command::frame::attach::session_busy;
use crate::command::frame::dry_run::{Plan, Reason, unknown};
use crate::command::{Access, Family};
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::{Answer, Request};
use crate::controller::toyo::session::{Counters, Ended, LineSession, Policy};
use crate::controller::toyo::status::Status;
use crate::controller::toyo::table::commands::{Command, Row};
use crate::controller::{Risk, Session as _, Step};
use crate::failure::Failure;
use crate::gate::Grant;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target;
#[cfg(test)]
use crate::transport::line::{InProcessLine, Pace};
use crate::transport::sim::Peer;
use crate::transport::stream::Stream;
use crate::transport::tap::Direction;
use borrowed::{Host, wants_host};
use foreign::Told;
pub use trouble::{misuse, wrong};

/// The toyo family.
#[derive(Debug)]
pub struct Toyo;

/// A connection to one controller.
#[derive(Debug)]
pub struct Link {
    transport: Transport,
    line: LineSession,
    /// As flags and settings want it, and as it is now.
    usual: Policy,
    policy: Policy,
    screen: Screen,
    granted: Grant,
    label: String,
    /// What this link set in motion.
    moving: Option<Moving>,
    host: Host,
    /// What puts things back as they were found, the last change at the end.
    borrowed: Vec<Request>,
    started: Instant,
    trace: Trace,
    waited: Duration,
    /// Whether the line is gone: nothing more is tried on it but what only reads, over a new one.
    is_gone: bool,
    /// What is changed for a while, for others to find if this process is killed; and what others have left.
    debts: Debts,
    left: Vec<Left>,
    /// What is meant to stay as it is; and what is not, and was told.
    chosen: Chosen,
    told: Told,
    /// How to open it again.
    again: Option<(Robot, Access)>,
    /// Whether nothing can come any more that answers what was asked before.
    is_fenced: bool,
    /// In a dry run, what decides whether the last noted frame is sent.
    hangs_on: Option<String>,
    /// In a dry run, the blocks that put things back as they were found.
    owed: Vec<String>,
    /// Letters of the axes, once they were asked for.
    letters: Option<Letters>,
    /// Writes to the EEPROM.
    pub(super) wear: Wear,
}

/// How the characters travel.
#[derive(Debug)]
enum Transport {
    Stream(Box<Stream<Box<dyn Peer>>>),
    /// A dry run: what would be sent is noted.
    Notes(Plan),
}

impl Transport {
    /// The addresses of a TCP connection, the own one first.
    fn ends(&self) -> Option<(SocketAddr, SocketAddr)> {
        match self {
            Self::Stream(stream) => match &**stream {
                Stream::Tcp(tcp) => tcp.ends().ok(),
                Stream::Serial(_) | Stream::InProcess(_) | Stream::Session(_) => None,
            },
            Self::Notes(_) => None,
        }
    }
}

/// What moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Moving {
    /// An axis, until it is told to stop.
    Jog,
    /// A program, a return to origin, servo power.
    Program,
}

/// A controller's "no" (`@NG`) to a request: it has no code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal(pub Request);

/// Room for what arrives in one piece.
const BUFFER: usize = 1024;
/// The longest silence while something moves that must be stopped.
const SILENCE: Duration = Duration::from_millis(300);
/// The page of the status that tells who commands.
const HOST_PAGE: u8 = 2;
/// A session that waits for nothing is asked again after this.
const LONG: Duration = Duration::from_secs(3600);

impl Family for Toyo {
    const FAMILY: Option<target::Family> = Some(target::Family::Toyo);
    type Link = Link;

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link, Failure> {
        let endpoint = connect::endpoint(robot)?;
        let transport = if access.dry_run {
            Transport::Notes(Plan::default())
        } else {
            Transport::Stream(Box::new(Box::pin(connect::open(robot, &access, screen)).await?))
        };
        let mut link = Link::new(robot, &access, screen, transport, endpoint.character())?;
        link.again = Some((robot.clone(), access));
        Ok(link)
    }

    async fn halt(link: &mut Link) -> Result<String, Failure> {
        let Some(moving) = link.moving else { return Ok("nothing was sent that moves the robot".to_owned()) };
        link.granted.raise(Risk::Write);
        let stop = moving.stop();
        // Before anything is written: a terminal that is held must not hold the stop.
        link.rush(&stop).await;
        link.screen.note(&format!("stopping the robot: {}", stop.text()));
        let place = Place::of(&link.stop(moving).await?);
        Ok(format!("the robot was stopped ({}); it stands at {}", stop.text(), place.in_a_line()))
    }

    fn must_halt(link: &Link) -> bool {
        link.moving == Some(Moving::Jog)
    }

    fn planned(link: &mut Link) -> Plan {
        link.plan_end();
        match &mut link.transport {
            Transport::Notes(plan) => std::mem::take(plan),
            Transport::Stream(_) => Plan::default(),
        }
    }

    async fn close(mut link: Link, screen: &Screen) -> Result<(), Failure> {
        link.tell_what_is_left().await;
        let put_back = link.put_back().await;
        let given_back = put_back.and(link.give_back().await);
        // What goes on now was told.
        link.debts.moving(None);
        let Counters { sent, received, noise, garbled, foreign, echoes } = link.line.counters();
        screen.detail(1, &format!("{sent} blocks sent, {received} received in {:.1?}", link.waited));
        let odd = [(noise, "stray characters"), (garbled, "garbled"), (foreign, "foreign or late"), (echoes, "echoes")];
        let odd: Vec<String> =
            odd.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        if !odd.is_empty() {
            screen.detail(1, &format!("on the line: {}", odd.join(", ")));
        }
        if let Transport::Stream(stream) = link.transport {
            stream.leave().await;
        }
        if let Err(error) = link.wear.keep() {
            screen.detail(1, &format!("what was written to the EEPROM was not noted: {error}"));
        }
        given_back.and(link.trace.finish())
    }
}

impl Link {
    fn new(
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        transport: Transport,
        character: Duration,
    ) -> Result<Self, Failure> {
        let policy = Policy { timeout: robot.timeout.value, retries: robot.retries.value, character };
        let trace = Trace::open(access, screen, transport.ends())?;
        let is_kept = !robot.target.value.is_simulated();
        let wear = if is_kept { Wear::of(&robot.target.value.to_string()) } else { Wear::without_diary() };
        let (debts, chosen) = if is_kept && !access.dry_run {
            let target = robot.target.value.to_string();
            (Debts::of(&target), Chosen::of(&target))
        } else {
            (Debts::without_notes(), Chosen::without_notes())
        };
        let left = debts.left();
        Ok(Self {
            transport,
            line: LineSession::new(policy),
            usual: policy,
            policy,
            screen: *screen,
            granted: access.granted.clone(),
            label: robot.label(),
            moving: None,
            host: Host::Unknown,
            borrowed: Vec::new(),
            started: Instant::now(),
            trace,
            waited: Duration::ZERO,
            is_gone: false,
            debts,
            told: Told::by(&left),
            left,
            chosen,
            again: None,
            is_fenced: false,
            hangs_on: None,
            owed: Vec::new(),
            letters: None,
            wear,
        })
    }

    /// The stream, for somebody else to use; `None` in a dry run.
    pub(super) fn into_stream(self) -> Option<Stream<Box<dyn Peer>>> {
        match self.transport {
            Transport::Stream(stream) => Some(*stream),
            Transport::Notes(_) => None,
        }
    }

    /// A link to a peer of a test's own.
    #[cfg(test)]
    pub(super) fn to(
        peer: Box<dyn Peer>,
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        pace: Pace,
    ) -> Result<Self, Failure> {
        let line = InProcessLine::new(peer, Some(pace), None);
        let transport = Transport::Stream(Box::new(Stream::InProcess(Box::new(line))));
        Self::new(robot, access, screen, transport, pace.time(1))
    }

    /// Lets through what this does, from now on.
    #[cfg(test)]
    pub(super) fn grant(&mut self, grant: Grant) {
        self.granted = grant;
    }

    /// Asks for data; a refusal is a failure.
    pub async fn read(&mut self, request: &Request) -> Result<Record, Failure> {
        match self.try_read(request).await? {
            Ok(record) => Ok(record),
            Err(Refusal(request)) => Err(refusal::explained(self, &request).await),
        }
    }

    /// Asks for data; a refusal is an answer.
    pub async fn try_read(&mut self, request: &Request) -> Result<Result<Record, Refusal>, Failure> {
        if let Transport::Notes(_) = self.transport {
            self.granted.check(request.risk(), &request.text())?;
            self.note(request, Reason::default());
            return Err(unknown());
        }
        match self.exchange(request).await? {
            Answer::Data(record) => {
                if request.command() == Command::Mtsk {
                    self.tell_foreign_task(record.number("task"));
                }
                Ok(Ok(record))
            }
            Answer::Refused => Ok(Err(Refusal(request.clone()))),
            Answer::Done => Err(self.malformed("@OK", "data is expected")),
        }
    }

    /// In a dry run, notes all the questions, whose answers are not known then.
    pub fn dry_run(&mut self, requests: &[Request]) -> Result<(), Failure> {
        if !self.is_dry() || requests.is_empty() {
            return Ok(());
        }
        for request in requests {
            self.note(request, Reason::default());
        }
        Err(unknown())
    }

    /// Reads the content of a parameter, a step or a palletizing record, of others the answer; a refusal is a failure.
    pub async fn read_content(&mut self, request: &Request) -> Result<Record, Failure> {
        match self.try_read_content(request).await? {
            Ok(content) => Ok(content),
            Err(Refusal(request)) => Err(refusal::explained(self, &request).await),
        }
    }

    /// Reads the content of a parameter, a step or a palletizing record, of others the answer; a refusal is an answer.
    pub async fn try_read_content(&mut self, request: &Request) -> Result<Result<Record, Refusal>, Failure> {
        let record = match self.try_read(request).await? {
            Ok(record) => record,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let content =
            request.answered(&record).map_err(|error| self.malformed(&record.written(), &error.to_string()))?;
        Ok(Ok(content.unwrap_or(record)))
    }

    /// Gives an order; a refusal is a failure. Takes the host before, where that is needed. A dry run notes it and goes
    /// on.
    pub async fn order(&mut self, request: &Request) -> Result<(), Failure> {
        match self.try_order(request).await? {
            Ok(()) => Ok(()),
            Err(Refusal(request)) => Err(refusal::explained(self, &request).await),
        }
    }

    /// Gives an order; a refusal is an answer.
    pub async fn try_order(&mut self, request: &Request) -> Result<Result<(), Refusal>, Failure> {
        if wants_host(request) {
            self.take_host().await?;
        }
        self.fence().await?;
        if let Transport::Notes(_) = self.transport {
            self.granted.check(request.risk(), &request.text())?;
            self.note(request, Reason::default());
            return Ok(Ok(()));
        }
        Ok(match self.exchange(request).await? {
            Answer::Refused => Err(Refusal(request.clone())),
            Answer::Done | Answer::Data(_) => Ok(()),
        })
    }

    /// Gives an order whose answer is data, such as TYPE; a refusal is a failure.
    pub async fn order_for(&mut self, request: &Request) -> Result<Record, Failure> {
        if wants_host(request) {
            self.take_host().await?;
        }
        self.fence().await?;
        self.read(request).await
    }

    /// All five pages of the status.
    pub async fn status(&mut self) -> Result<Status, Failure> {
        self.status_of(&[0, 1, 2, 3, 4]).await
    }

    /// Some pages of the status; the others are 0.
    pub async fn status_of(&mut self, pages: &[u8]) -> Result<Status, Failure> {
        self.dry_run(&pages.iter().copied().map(status_page).collect::<Vec<_>>())?;
        let mut status = Status::default();
        for page in pages {
            status = status.with(*page, self.status_page(*page).await?);
        }
        if pages.contains(&HOST_PAGE) {
            self.tell_foreign_host(status);
        }
        Ok(status)
    }

    async fn status_page(&mut self, page: u8) -> Result<u8, Failure> {
        // Not `read`: what explains a refusal asks for the status.
        let Ok(record) = self.try_read(&status_page(page)).await? else { return Err(refusal::mute()) };
        record.byte("st1").ok_or_else(|| self.malformed(&record.written(), "there is no status in it"))
    }

    /// Sends a block that is in no table, and returns what came back.
    pub async fn raw(&mut self, block: &str) -> Result<String, Failure> {
        self.granted.check(Risk::Motion, block)?;
        self.fence().await?;
        if let Transport::Notes(plan) = &mut self.transport {
            plan.note(json!({ "text": block }), Reason::default());
            return Err(unknown());
        }
        self.take_turn(Risk::Motion).await?;
        self.is_fenced = false;
        self.moving = Some(Moving::Program);
        self.debts.moving(self.moving);
        self.line.begin_raw(block);
        match self.drive(Risk::Motion).await? {
            Ended::Answered(answer) => Ok(answer),
            ended => Err(self.unanswered(ended, Risk::Motion, "`toyo status` tells how the controller stands")),
        }
    }

    /// One request, one answer. Only what changes nothing is sent again after silence.
    pub async fn exchange(&mut self, request: &Request) -> Result<Answer, Failure> {
        self.converse(request, request.risk() == Risk::Read).await
    }

    async fn converse(&mut self, request: &Request, is_repeatable: bool) -> Result<Answer, Failure> {
        let risk = request.risk();
        self.granted.check(risk, &request.text())?;
        request.check().map_err(|error| misuse(&error))?;
        self.revive(risk).await?;
        if !self.left.is_empty() && !matches!(request.command(), Command::Stop | Command::Jgst) {
            self.tell_what_is_left().await;
        }
        self.take_turn(risk).await?;
        self.is_fenced = false;
        if risk == Risk::Motion {
            self.moving = Some(if request.command() == Command::Jgst { Moving::Jog } else { Moving::Program });
            self.debts.moving(self.moving);
        }
        self.line.begin(request, is_repeatable);
        match self.drive(risk).await? {
            Ended::Answered(block) => {
                // An order's answer tells nothing of what was before it; that of a question came after all else.
                self.is_fenced = risk == Risk::Read;
                request.answer_kept(&block).map_err(|error| self.malformed(&block, &error.to_string()))
            }
            ended => {
                let failure = self.unanswered(ended, risk, refusal::telltale(request.command()));
                let message = format!("{} ({})", failure.message, request.text());
                Err(Failure { message, ..failure })
            }
        }
    }

    /// Moves characters and time until the exchange has ended. The future may be dropped: the next exchange lets what
    /// is still owed pass.
    async fn drive(&mut self, risk: Risk) -> Result<Ended, Failure> {
        let ended = self.drive_alone(risk).await;
        if let Transport::Stream(stream) = &mut self.transport {
            stream.give();
        }
        ended
    }

    /// Where a session shares the line out: waits until it is this link's, until the end of the next [`Link::drive`]. As
    /// long as this link moves the robot, no other does.
    async fn take_turn(&mut self, risk: Risk) -> Result<(), Failure> {
        let Transport::Stream(stream) = &mut self.transport else { return Ok(()) };
        let until = Instant::now() + self.policy.timeout.max(self.usual.timeout);
        let turn = async {
            if risk == Risk::Motion {
                stream.claim_motion().await?;
            }
            stream.take(until).await
        };
        turn.await.map_err(|hindrance| session_busy(&self.label, &hindrance))
    }

    async fn drive_alone(&mut self, risk: Risk) -> Result<Ended, Failure> {
        let began = self.started.elapsed();
        let mut now = began;
        let mut has_left = false;
        let mut buffer = [0; BUFFER];
        loop {
            let step = match self.line.poll(now) {
                Step::Send(bytes) => {
                    let sent = self.send(&bytes).await;
                    has_left = true;
                    sent.map(|()| 0)
                }
                Step::Wait(until) => self.receive(&mut buffer, self.started + until.min(now + LONG)).await,
                Step::Done(ended) => {
                    self.waited += now.saturating_sub(began);
                    return Ok(ended);
                }
                Step::Data(_) | Step::Feed => Ok(0),
            };
            let received = step.map_err(|error| self.broken(&error, has_left && risk > Risk::Read))?;
            now = self.started.elapsed();
            self.line.handle(now, &buffer[..received]);
        }
    }

    async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        let Transport::Stream(stream) = &mut self.transport else { return Ok(()) };
        self.trace.record(Direction::Sent, bytes);
        stream.send(bytes).await
    }

    /// Waits for characters and puts them into the buffer; 0 if none came until then.
    async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<usize> {
        let Transport::Stream(stream) = &mut self.transport else { return Ok(0) };
        let received = stream.receive(buffer, until).await?.unwrap_or(0);
        self.trace.record(Direction::Received, &buffer[..received]);
        Ok(received)
    }

    /// Notices a silence at once, asks nothing twice, and keeps text about the traffic until [`Link::stop`]: an axis will
    /// move until it is told to stop, and neither patience nor a terminal that is held must be in the way of that.
    pub fn watch_closely(&mut self) {
        self.set_policy(Policy { timeout: SILENCE, retries: 0, ..self.usual });
        self.trace.hold();
    }

    fn set_policy(&mut self, policy: Policy) {
        self.policy = policy;
        self.line.set_policy(policy);
    }

    /// The letters of the axes, if they were asked for.
    pub(super) fn known_letters(&self) -> Option<&Letters> {
        self.letters.as_ref()
    }

    /// Keeps the letters of the axes.
    pub(super) fn know_letters(&mut self, letters: Letters) {
        self.letters = Some(letters);
    }

    /// Nothing that this link set in motion moves any more.
    pub fn has_ended(&mut self) {
        self.moving = None;
        self.debts.moving(None);
    }

    /// Whether a session holds the line, and others may use it at the same time.
    fn is_shared(&self) -> bool {
        matches!(&self.transport, Transport::Stream(stream) if matches!(**stream, Stream::Session(_)))
    }

    /// Whether nothing is sent, only noted.
    pub fn is_dry(&self) -> bool {
        matches!(self.transport, Transport::Notes(_))
    }

    /// Notes in a dry run a request that the command sends for a reason.
    pub fn plan(&mut self, request: &Request, about: &str) {
        self.note(request, Reason::about(about));
    }

    /// Notes in a dry run a request that an answer before it decides about.
    pub fn plan_if(&mut self, request: &Request, on: &str) {
        self.note(request, Reason::default().depending_on(on));
    }

    /// Notes in a dry run a block of which an answer before it decides a part, that stands as `?`, or whether it is sent.
    pub fn plan_depending(&mut self, text: &str, reason: Reason<'_>) {
        if let Transport::Notes(plan) = &mut self.transport {
            plan.note(json!({ "text": text }), reason);
            let word = text.trim_start_matches('@').split(' ').next().unwrap_or_default();
            self.is_fenced = Row::named(word).is_some_and(|row| row.risk == Risk::Read);
            self.hangs_on = reason.depends_on.map(ToOwned::to_owned);
        }
    }

    /// Notes in a dry run an order that an answer before it decides about, behind what goes before every order.
    pub async fn plan_order(&mut self, text: &str, on: &str) -> Result<(), Failure> {
        self.take_host().await?;
        self.fence().await?;
        self.plan_depending(text, Reason::default().depending_on(on));
        Ok(())
    }

    /// Says in a dry run what follows that cannot be shown.
    pub fn then(&mut self, what: &str) {
        if let Transport::Notes(plan) = &mut self.transport {
            plan.then(what);
        }
    }

    fn note(&mut self, request: &Request, reason: Reason<'_>) {
        self.plan_depending(&request.text(), reason);
    }
}

fn status_page(page: u8) -> Request {
    Request::of(Command::Stas, [Value::Number(page.into())])
}

/// JOG: one word for all axes, or one for an axis (0 to 3) while the others stop.
pub fn jog(word: &'static str, axis: Option<usize>) -> Request {
    let of = |index| if axis.is_none_or(|axis| axis == index) { word } else { "SP" };
    Request::of(Command::Jgst, [0, 1, 2, 3].map(|index| Value::Word(of(index))))
}

//! The connection to a controller: the one driver that moves datagrams between sessions and a transport.

mod plan;

use std::io;
use std::time::Duration;

use tokio::time::Instant;

use super::connect::{self, Transport};
use super::fitted::Fitted;
pub use super::refusal::{Asked, Refusal};
use super::simulated::channel;
use super::trace::Trace;
use crate::command::frame::attach::session_busy;
use crate::command::frame::dry_run::{Plan, Reason, unknown};
use crate::command::{Access, Family};
use crate::controller::text::Encoding;
use crate::controller::yerc::Model;
use crate::controller::yerc::group::Group;
use crate::controller::yerc::query::{Coordinates, Hold, Query};
use crate::controller::yerc::request::Request;
use crate::controller::yerc::session::{
    Counters, Download, DownloadEnd, Ended, Exchange, Ids, Policy, Reply, Upload, UploadEnd,
};
use crate::controller::yerc::wire::{Division, RequestFrame};
use crate::controller::{Risk, Session, Step};
use crate::failure::{Failure, Kind, plain};
use crate::gate::Grant;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target;
use crate::transport::session::client::SessionBusy;
use crate::transport::tap::Direction;

/// The yerc family.
#[derive(Debug)]
pub struct Yerc;

/// A connection to one controller.
#[derive(Debug)]
pub struct Link {
    transport: Transport,
    screen: Screen,
    policy: Policy,
    ids: Ids,
    granted: Grant,
    /// Whether a request left that moves the robot.
    has_moved: bool,
    label: String,
    /// Model of the controller: number ranges and layouts follow from it.
    pub model: Model,
    /// Encoding of its texts.
    pub encoding: Encoding,
    /// Words of a cartesian move, 25 or 26.
    pub move_words: u8,
    started: Instant,
    buffer: Box<[u8; BUFFER]>,
    trace: Trace,
    totals: Totals,
    /// The last download, in case its final ACK got lost.
    finished: Option<Download>,
    /// What the next request is for, in a dry run.
    purpose: Option<&'static str>,
    /// Which axes groups have, as far as it was asked.
    pub(super) fitted: Vec<(Group, Coordinates, Fitted)>,
}

/// How long a stop is tried at least, the silence after which it is sent again (it doubles), and how often.
const STOP_WITHIN: Duration = Duration::from_secs(3);
const REPEAT_STOP: Duration = Duration::from_millis(100);
const STOPS: u32 = 8;

/// Room for more than a frame, so that an oversized datagram shows.
const BUFFER: usize = 2048;

/// What a link saw, for `-v`.
#[derive(Debug, Default)]
struct Totals {
    sent: u64,
    received: u64,
    waited: Duration,
    exchanges: u32,
}

impl Family for Yerc {
    const FAMILY: Option<target::Family> = Some(target::Family::Yerc);
    type Link = Link;

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link, Failure> {
        let (transport, model) = connect::open(robot, &access, screen).await?;
        let timeout = robot.timeout.value;
        let attempt = Policy::default().attempt.min(timeout);
        Ok(Link {
            transport,
            screen: *screen,
            policy: Policy { deadline: timeout, attempt, retries: robot.retries.value },
            ids: Ids::default(),
            granted: access.granted.clone(),
            has_moved: false,
            label: robot.label(),
            model,
            encoding: robot.encoding.value,
            move_words: robot.target.value.traits().move_words.unwrap_or(26),
            started: Instant::now(),
            buffer: Box::new([0; BUFFER]),
            trace: Trace::open(&access, screen)?,
            totals: Totals::default(),
            finished: None,
            purpose: None,
            fitted: Vec::new(),
        })
    }

    async fn halt(link: &mut Link) -> Result<String, Failure> {
        // What else moves there is not this command's to stop.
        if !link.has_moved {
            return Ok("nothing was sent that moves the robot".to_owned());
        }
        link.screen.note("stopping the robot: HOLD on");
        link.granted.raise(Risk::Write);
        // The one order that is repeated after silence, whatever the options say of timeout and retries: HOLD twice is
        // HOLD once, and a lost one lets the robot move on.
        let Policy { deadline, .. } = link.policy;
        link.policy = Policy { deadline: deadline.max(STOP_WITHIN), attempt: REPEAT_STOP, retries: STOPS };
        let request = Hold(true).request();
        let reply = link.converse(&request, true).await?;
        if !reply.status.is_ok() {
            return Err(Refusal { status: reply.status, to: Asked::from(&request) }.into());
        }
        Ok("the robot was stopped: HOLD is on; `yerc hold off` releases it".to_owned())
    }

    fn planned(link: &mut Link) -> Plan {
        match &mut link.transport {
            Transport::Notes(plan) => std::mem::take(plan),
            Transport::Udp(_) | Transport::Sim(_) | Transport::Session(_) => Plan::default(),
        }
    }

    async fn close(mut link: Link, screen: &Screen) -> Result<(), Failure> {
        link.linger().await?;
        let Totals { sent, received, waited, exchanges } = link.totals;
        screen.detail(1, &format!("{exchanges} exchanges in {waited:.1?}: {sent} frames sent, {received} received"));
        if let Transport::Session(attached) = link.transport {
            attached.leave().await;
        }
        link.trace.finish()
    }
}

/// What a session wants from the one who reads or writes the file.
enum Want<'a, S> {
    /// A piece that came.
    Take(&'a [u8]),
    /// The session wants to be fed.
    Feed(&'a mut S),
}

impl Link {
    /// Asks one question; a refusal is a failure.
    pub async fn ask<Q: Query>(&mut self, query: &Q) -> Result<Q::Answer, Failure> {
        self.try_ask(query).await?.map_err(|refusal| refusal.of(query.risk()))
    }

    /// Asks one question; a refusal is an answer.
    pub async fn try_ask<Q: Query>(&mut self, query: &Q) -> Result<Result<Q::Answer, Refusal>, Failure> {
        let request = query.request();
        if self.is_dry() && request.risk() > Risk::Read {
            self.authorize(&request)?;
            self.note(&request, Reason::default());
            // What is accepted bears no data.
            return query.decode(&[]).map(Ok).map_err(|_| unknown());
        }
        let answer = match self.exchange(&request).await? {
            Ok(data) => data,
            Err(refusal) => return Ok(Err(refusal)),
        };
        let decoded = query.decode(&answer).map_err(|error| {
            Failure::new(Kind::Malformed, format!("{}: unexpected answer: {error}", self.label))
                .hint("check the model (?model=fs100 or dx200); -vvv shows the bytes")
        })?;
        Ok(Ok(decoded))
    }

    /// Asks several questions, one after the other; the first refusal or failure ends it. A dry run notes them all.
    pub async fn ask_all<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Q::Answer>, Failure> {
        self.dry_run(queries)?;
        let mut answers = Vec::with_capacity(queries.len());
        for query in queries {
            answers.push(self.ask(query).await?);
        }
        Ok(answers)
    }

    /// Asks several questions of things that need not exist; a refusal is an answer. A dry run notes them all.
    pub async fn try_ask_all<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Result<Q::Answer, Refusal>>, Failure> {
        self.dry_run(queries)?;
        let mut answers = Vec::with_capacity(queries.len());
        for query in queries {
            answers.push(self.try_ask(query).await?);
        }
        Ok(answers)
    }

    /// Sends a request as it is and returns the data of the answer.
    pub async fn exchange(&mut self, request: &Request) -> Result<Result<Vec<u8>, Refusal>, Failure> {
        let reply = self.reply(request).await?;
        let Reply { status, data, .. } = reply;
        Ok(if status.is_ok() { Ok(data) } else { Err(Refusal { status, to: Asked::from(request) }) })
    }

    /// Sends a request as it is and returns the whole answer, good or bad. Only what changes nothing is repeated.
    pub async fn reply(&mut self, request: &Request) -> Result<Reply, Failure> {
        self.converse(request, request.risk() == Risk::Read).await
    }

    async fn converse(&mut self, request: &Request, is_repeatable: bool) -> Result<Reply, Failure> {
        self.admit(request).await?;
        let frame = request.frame(0);
        let frame = RequestFrame::parse(&frame).map_err(|error| Failure::local(error.to_string()))?;
        let mut session = Exchange::new(&frame, is_repeatable, self.policy, &self.ids);
        let before = self.totals.sent;
        let driven = self.drive(request.division(), &mut session, |_| Ok(())).await;
        let ended = driven.map_err(|failure| self.cut_short(failure, request, self.totals.sent > before))?;
        self.totals.exchanges += 1;
        self.heard(session.counters());
        match ended {
            Ended::Answered(reply) => Ok(reply),
            Ended::NoAnswer(counters) => Err(self.silence(counters)),
            Ended::OutcomeUnknown(counters) => Err(self.unknown(request, self.policy.deadline, counters)),
        }
    }

    /// Fetches a file or list. Every block goes to `take`, in order; at most `limit` bytes. `first_wait` is how long
    /// the first answer may take where that is long.
    pub async fn download(
        &mut self,
        request: &Request,
        limit: u64,
        first_wait: Option<Duration>,
        mut take: impl FnMut(&[u8]) -> Result<(), Failure>,
    ) -> Result<DownloadEnd, Failure> {
        if self.is_dry() {
            self.plan_download(request, Reason::default())?;
            return Err(unknown());
        }
        self.admit(request).await?;
        let frame = request.frame(0);
        let frame = RequestFrame::parse(&frame).map_err(|error| Failure::local(error.to_string()))?;
        let mut session = Download::new(&frame, limit, self.policy, &self.ids);
        if let Some(wait) = first_wait {
            session = session.with_first_wait(wait);
        }
        let end = self
            .drive(Division::File, &mut session, |want| match want {
                Want::Take(piece) => take(piece),
                Want::Feed(_) => Ok(()),
            })
            .await?;
        self.totals.exchanges += 1;
        self.heard(session.counters());
        self.finished = matches!(end, DownloadEnd::Complete { .. }).then_some(session);
        match end {
            // Only the batch backup changes something, and it is the one with a long first wait.
            DownloadEnd::NoAnswer { bytes: 0, counters } if request.risk() > Risk::Read => {
                Err(self.unknown(request, first_wait.unwrap_or(self.policy.deadline), counters))
            }
            DownloadEnd::NoAnswer { bytes: 0, counters } => Err(self.silence(counters)),
            DownloadEnd::NoAnswer { bytes, counters } if counters.is_garbage() => Err(Failure::new(
                Kind::Malformed,
                format!("{}: after {bytes} bytes came nothing of the protocol, but {counters}", self.label),
            )
            .hint("nothing was kept of it; repeat it, and record it with --trace if it comes again")),
            DownloadEnd::NoAnswer { bytes, .. } => {
                Err(Failure::new(Kind::NoAnswer, format!("{}: the transfer broke off after {bytes} bytes", self.label))
                    .hint("nothing was kept of it; repeat the command, with a longer --timeout if the line is bad"))
            }
            end => Ok(end),
        }
    }

    /// Sends a file. `give` returns the next piece, empty at the end.
    pub async fn upload(
        &mut self,
        request: &Request,
        mut give: impl FnMut() -> Result<Vec<u8>, Failure>,
    ) -> Result<UploadEnd, Failure> {
        if self.is_dry() {
            self.plan_upload(request, Reason::default(), give)?;
            return Err(unknown());
        }
        self.admit(request).await?;
        // A controller that checks no ids could take a late block of the last upload into this one; a new port ends that.
        self.transport.renew(channel(Division::File));
        self.finished = None;
        let frame = request.frame(0);
        let frame = RequestFrame::parse(&frame).map_err(|error| Failure::local(error.to_string()))?;
        let mut session = Upload::new(&frame, self.policy, &self.ids);
        let driven = self
            .drive(Division::File, &mut session, |want| {
                if let Want::Feed(session) = want {
                    let piece = give()?;
                    session.feed(&piece, piece.is_empty());
                }
                Ok(())
            })
            .await;
        let end = driven.map_err(|failure| Self::cut_off(failure, &session))?;
        self.totals.exchanges += 1;
        self.heard(session.counters());
        match end {
            UploadEnd::NoAnswer(counters) => Err(self.silence(counters)),
            end => Ok(end),
        }
    }

    /// A failure on this side in the middle of an upload; after the first block the controller may hold a part or all.
    fn cut_off(failure: Failure, upload: &Upload) -> Failure {
        let sent = upload.sent();
        if sent == 0 {
            return failure;
        }
        let message =
            format!("{}; {sent} bytes had been sent: the file may be there, whole or in part", failure.message);
        let kind = if failure.kind == Kind::NoAnswer { Kind::OutcomeUnknown } else { failure.kind };
        Failure { kind, message, ..failure }
            .hint("compare it with `yerc file diff` before anybody runs it, or send it again")
    }

    /// On a line that loses frames, waits a moment for the last block to come again, which means that its ACK got lost:
    /// without it the controller holds the transfer open.
    async fn linger(&mut self) -> Result<(), Failure> {
        let Some(mut last) = self.finished.take().filter(|last| last.counters() != Counters::default()) else {
            return Ok(());
        };
        self.take_turn(Division::File).await?;
        let channel = channel(Division::File);
        let until = Instant::now() + self.policy.attempt;
        while Instant::now() < until
            && let Some(len) = self.receive(channel, until).await?
        {
            if let Some(ack) = last.linger(&self.buffer[..len]) {
                self.send(channel, &ack).await?;
            }
        }
        Ok(())
    }

    /// A text as the controller stores it.
    pub fn encode(&self, what: &str, text: &str) -> Result<Vec<u8>, Failure> {
        self.encoding.encode(text).map_err(|error| {
            Failure::usage(format!("{what}: {error}")).hint("--encoding or the robot's entry sets the encoding")
        })
    }

    /// The last check before anything leaves; a dry run notes it instead, and has no answer.
    async fn admit(&mut self, request: &Request) -> Result<(), Failure> {
        self.authorize(request)?;
        if self.is_dry() {
            self.note(request, Reason::default());
            return Err(unknown());
        }
        if request.risk() == Risk::Motion {
            if let Transport::Session(attached) = &mut self.transport {
                attached.claim_motion().await.map_err(|busy| session_busy(&self.label, &busy))?;
            }
            self.has_moved = true;
        }
        Ok(())
    }

    fn authorize(&self, request: &Request) -> Result<(), Failure> {
        self.granted.check(request.risk(), &format!("request {:#04x}", request.command))
    }

    /// Moves datagrams and time until the session has ended. Who shares the link has it for so long.
    async fn drive<S: Session>(
        &mut self,
        division: Division,
        session: &mut S,
        serve: impl FnMut(Want<'_, S>) -> Result<(), Failure>,
    ) -> Result<S::Outcome, Failure> {
        self.take_turn(division).await?;
        let driven = self.drive_alone(division, session, serve).await;
        self.give_turn();
        driven
    }

    async fn take_turn(&mut self, division: Division) -> Result<(), Failure> {
        let Transport::Session(attached) = &mut self.transport else { return Ok(()) };
        let until = Instant::now() + self.policy.deadline;
        attached
            .take_for(connect::number(channel(division)), until)
            .await
            .map_err(|busy| session_busy(&self.label, &busy))
    }

    fn give_turn(&mut self) {
        if let Transport::Session(attached) = &mut self.transport {
            attached.over();
        }
    }

    async fn drive_alone<S: Session>(
        &mut self,
        division: Division,
        session: &mut S,
        mut serve: impl FnMut(Want<'_, S>) -> Result<(), Failure>,
    ) -> Result<S::Outcome, Failure> {
        let channel = channel(division);
        let began = self.started.elapsed();
        let mut now = began;
        loop {
            // The clock is read where time may have passed: after a wait, and after a visit to the disk.
            match session.poll(now) {
                Step::Send(bytes) => self.send(channel, &bytes).await?,
                Step::Data(piece) => {
                    serve(Want::Take(&piece))?;
                    now = self.started.elapsed();
                }
                Step::Feed => {
                    serve(Want::Feed(session))?;
                    now = self.started.elapsed();
                }
                Step::Wait(until) => {
                    let received = self.receive(channel, self.started + until).await?;
                    // A frame that arrived in the last moment counts.
                    now = self.started.elapsed();
                    let Some(len) = received else { continue };
                    let again = self.finished.as_mut().and_then(|last| last.linger(&self.buffer[..len]));
                    match again {
                        Some(ack) => self.send(channel, &ack).await?,
                        None => session.handle(now, &self.buffer[..len]),
                    }
                }
                Step::Done(outcome) => {
                    self.totals.waited += now.saturating_sub(began);
                    return Ok(outcome);
                }
            }
        }
    }

    async fn send(&mut self, channel: usize, bytes: &[u8]) -> Result<(), Failure> {
        self.totals.sent += 1;
        self.transport.send(channel, bytes).await.map_err(|error| self.broken(channel, &error))?;
        self.trace.record(Direction::Sent, self.transport.ends(channel), bytes);
        Ok(())
    }

    /// Waits for a datagram and puts it into the buffer; `None` if none came until then.
    async fn receive(&mut self, channel: usize, until: Instant) -> Result<Option<usize>, Failure> {
        let received = self.transport.receive(channel, &mut self.buffer[..], until).await;
        let Some(len) = received.map_err(|error| self.broken(channel, &error))? else { return Ok(None) };
        self.totals.received += 1;
        self.trace.record(Direction::Received, self.transport.ends(channel), &self.buffer[..len]);
        Ok(Some(len))
    }

    /// Says at `-v` what else was on the line.
    fn heard(&self, counters: Counters) {
        if counters != Counters::default() {
            self.screen.detail(1, &format!("{}: {counters}", self.label));
        }
    }

    /// Nobody answered a question that does no harm.
    fn silence(&self, counters: Counters) -> Failure {
        let waited = self.policy.deadline;
        if counters.is_garbage() {
            return Failure::new(
                Kind::Malformed,
                format!("{}: no answer of the protocol within {waited:?}, but {counters}", self.label),
            )
            .hint("is this the high-speed Ethernet server of a controller? -vvv shows the bytes");
        }
        Failure::new(Kind::NoAnswer, format!("{}: no answer within {waited:?}", self.label)).hint(
            "check address, cable and firewall; on the controller: the Ethernet server function, RS022, RS029 and \
             #82015 CMD REMOTE SEL; `armctl help yerc` lists the settings",
        )
    }

    /// A session that ends in the middle takes the answer with it.
    fn cut_short(&self, failure: Failure, request: &Request, has_left: bool) -> Failure {
        let is_gone = matches!(&self.transport, Transport::Session(attached) if attached.ended().is_some());
        if !is_gone || !has_left || request.risk() == Risk::Read {
            return failure;
        }
        let message = format!("{}; it was sent, and may or may not have been done", failure.message);
        Failure::new(Kind::OutcomeUnknown, message).hint(format!("ask before you repeat it: {}", telltale(request)))
    }

    /// Nobody confirmed something that may have been done.
    fn unknown(&self, request: &Request, waited: Duration, counters: Counters) -> Failure {
        let seen = if counters.heard_something() { format!(" ({counters})") } else { String::new() };
        Failure::new(
            Kind::OutcomeUnknown,
            format!("{}: sent once, no answer within {waited:?}{seen}: it may or may not have been done", self.label),
        )
        .hint(format!("ask before you repeat it: {}", telltale(request)))
    }

    /// The socket has bad news.
    fn broken(&self, channel: usize, error: &io::Error) -> Failure {
        use io::ErrorKind::{ConnectionRefused, HostUnreachable, NetworkUnreachable};

        let port = match &self.transport {
            Transport::Udp(udp) => udp.peer(channel).port().to_string(),
            Transport::Session(attached) => match attached.ended() {
                Some(why) => return session_busy(&self.label, &SessionBusy::Ended(why.to_owned())),
                None => "of the session".to_owned(),
            },
            Transport::Sim(_) | Transport::Notes(_) => return Failure::io(&self.label, error),
        };
        match error.kind() {
            ConnectionRefused => {
                Failure::new(Kind::NoAnswer, format!("{}: nothing listens on UDP port {port}", self.label)).hint(
                    "the host is there, the server is not: check the port, and the Ethernet server function of the \
                     controller",
                )
            }
            HostUnreachable | NetworkUnreachable => {
                Failure::new(Kind::NoAnswer, format!("{}: the host cannot be reached: {}", self.label, plain(error)))
                    .hint("check the address and this machine's own network settings")
            }
            _ => Failure::new(Kind::NoAnswer, format!("{}: UDP port {port}: {}", self.label, plain(error)))
                .hint("check this machine's network"),
        }
    }
}

/// What tells whether a request that changes something was carried out.
fn telltale(request: &Request) -> &'static str {
    match request.command {
        0 => "`yerc file list` tells what is there",
        0x78 | 0x300 => "`yerc io get` tells",
        0x79 | 0x301 => "`yerc register get` tells",
        0x7A..=0x81 | 0x8C | 0x302..=0x309 | 0x30C => "`yerc var get` tells",
        0x82 => "`yerc alarm list` and `yerc status` tell",
        0x83 | 0x84 => "`yerc status` tells",
        0x85 => "the pendant shows it; a message may safely be sent again",
        0x86 => "`yerc status` and `yerc job show` tell whether it runs",
        0x87 => "`yerc job show` tells",
        0x8A | 0x8B => "keep clear; `yerc status` and `yerc position` tell whether it moves, and where it is",
        _ => "`yerc status` tells how the controller stands",
    }
}

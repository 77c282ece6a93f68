//! The connection to a controller: the one driver that moves images between sessions and a transport.
//!
//! At most one remote command is under way, and beside it one procedure of signals: both are polled in every turn, as the
//! controller takes them at the same time. Futures of a link may be dropped at any await; what was under way stays in the
//! link, so that [`Family::halt`] can end it properly.

mod board;
mod driver;
mod jog;
mod output;
mod shared;
mod words;

use std::fmt;
use std::time::Duration;

use serde_json::json;
use tokio::time::Instant;

use super::connect::{self, Endpoint};
use super::fieldbus::Board;
use super::hold;
use super::io::named;
use super::overwrite::Replaced;
use super::refusal;
use super::trace::{Recorder, Trace};
use crate::command::frame::attach::{attach, is_held};
use crate::command::frame::dry_run::{Plan, Reason, unknown};
use crate::command::{Access, ConnectMode, Entry, Family};
use crate::controller::Risk;
use crate::controller::yrcx::alarm::{Alarm, STOP_INPUT};
use crate::controller::yrcx::answer::Answer;
use crate::controller::yrcx::image::{COMMAND_WORDS, Image, Output, Words};
use crate::controller::yrcx::order::{Draft, Order};
use crate::controller::yrcx::procedure::{Procedure, Step};
use crate::controller::yrcx::sequence::{self, Sequence};
use crate::controller::yrcx::session::{Ended, Exchange, Outcome, Policy};
use crate::controller::yrcx::signal::{input, resting};
use crate::controller::yrcx::table::{Command, Pace, Row};
use crate::controller::yrcx::value::{Key, Values};
use crate::failure::Failure;
use crate::gate::Grant;
use crate::output::Screen;
use crate::settings::Robot;
use crate::settings::target;
use crate::transport::image::{ImageLink, Traffic};

/// The yrcx family.
#[derive(Debug)]
pub struct Yrcx;

/// A connection to one controller.
#[derive(Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct Link {
    transport: Transport,
    /// Bytes of what is shown; 0 where nothing is.
    size: usize,
    /// What a controller raises when the link is lost.
    link_alarm: Alarm,
    is_simulated: bool,
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
    screen: Screen,
    granted: Grant,
    label: String,
    /// The robot that commands are for, 1 to 4; 0 for the first, or for all where a command can be.
    unit: u8,
    /// Whether something was started that goes on by itself: a program, or what signals set in motion.
    has_started: bool,
    /// General-purpose words that were shown before a remote command, to be put back after it.
    words: Words,
    /// Whether the link outlives the command, so that what it began may go on.
    is_held: bool,
    /// Whether a session holds it, and others may use it at the same time.
    is_shared: bool,
    /// Whether a remote command has ended, so that somebody else may give the next one.
    is_over: bool,
    /// What a watch told last.
    pub told: Option<Image>,
    started: Instant,
    trace: Trace,
    /// Of packets, where there is a network and `--trace` wants them.
    recorder: Option<Recorder>,
    totals: Totals,
}

/// How the images travel.
#[derive(Debug)]
enum Transport {
    Image(Box<ImageLink>),
    /// A dry run: what would be sent is noted.
    Notes(Plan),
    /// Not at all: only the device on the fieldbus is asked. With it goes what must live as long.
    Board(Box<dyn Board>, Option<Box<dyn fmt::Debug>>),
}

/// What a link saw, for `-v`.
#[derive(Debug, Default)]
struct Totals {
    commands: u32,
    waited: Duration,
    losses: u32,
}

/// What was carried out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Done {
    /// What the answer holds.
    pub values: Values,
    /// From the first time that the command was sent to its end.
    pub elapsed: Duration,
    /// What was overwritten, where something was.
    pub replaced: Option<Replaced>,
}

/// What came of an order.
#[derive(Debug, Clone, PartialEq)]
pub struct Given {
    /// What the controller says.
    pub answer: Answer,
    /// The same in words.
    pub words: Words,
    /// From the first time that the command was sent to its end.
    pub elapsed: Duration,
}

impl Given {
    /// What was carried out; a refusal is a failure.
    fn done(self, order: &Order) -> Result<Done, Failure> {
        match self.answer {
            Answer::Done(values) | Answer::Running(values) => {
                Ok(Done { values, elapsed: self.elapsed, replaced: None })
            }
            Answer::Refused { alarm, .. } => Err(refusal::refused_order(order, alarm)),
        }
    }
}

/// Least patience with what the manual gives no time for.
const QUICK: Duration = Duration::from_secs(10);
const POWER: Duration = Duration::from_secs(30);
/// How long the last change may take to leave before the connection is closed.
const LEAVE_WITHIN: Duration = Duration::from_secs(1);

impl Family for Yrcx {
    const FAMILY: Option<target::Family> = Some(target::Family::Yrcx);
    type Link = Link;

    async fn connect(robot: &Robot, access: Access, screen: &Screen) -> Result<Link, Failure> {
        let endpoint = connect::endpoint(robot)?;
        if access.dry_run {
            let mut link = Link::new(robot, &access, screen, Transport::Notes(Plan::default()), None)?;
            let opens_session = access.mode == ConnectMode::Control && robot.hold.value && !robot.read_only.value;
            link.is_held |= opens_session || is_held(robot);
            return Ok(link);
        }
        if access.mode == ConnectMode::Explicit {
            let ((board, kept), recorder) = endpoint.board(robot, &access, screen).await?;
            return Link::new(robot, &access, screen, Transport::Board(board, kept), recorder);
        }
        let (image, recorder) = match Box::pin(attach(robot, &access, screen)).await? {
            Some(attached) => (ImageLink::in_session(attached), None),
            None => Box::pin(endpoint.open(robot, &access, screen)).await?,
        };
        let mut link = Link::new(robot, &access, screen, Transport::Image(Box::new(image)), recorder)?;
        link.join(robot);
        match link.begin().await {
            Ok(()) => Ok(link),
            Err(failure) => {
                // That the controller shows nothing is worth more than how the end of that went.
                let _ = Self::close(link, &screen.silenced()).await;
                Err(failure)
            }
        }
    }

    async fn halt(link: &mut Link) -> Result<String, Failure> {
        link.granted.raise(Risk::Write);
        link.abandon_sequence();
        let now = link.started.elapsed();
        if let Some(exchange) = &mut link.exchange {
            exchange.interrupt(now);
            let order = exchange.order().clone();
            let row = order.row();
            if matches!(row.pace, Pace::Motion | Pace::Jog) {
                link.tell_of_stop();
            }
            let outcome = link.until_ended().await?;
            return match &outcome.ended {
                Ended::Answered(Answer::Refused { alarm, positions }) if *alarm == STOP_INPUT => {
                    Ok(format!("{}{}", jog::STOPPED, refusal::stopped(&order, positions)))
                }
                Ended::Answered(Answer::Refused { alarm, .. }) => {
                    Ok(format!("{} had ended already: alarm {alarm}, {}", row.id, alarm.text()))
                }
                Ended::Answered(_) => Ok(format!("{} had been carried out already", row.id)),
                Ended::NotSent(_) => Ok("nothing was sent that moves the robot".to_owned()),
                Ended::Stopped => Ok(format!("{} was ended", row.id)),
                Ended::NoAnswer(_) | Ended::OutcomeUnknown(_) => Err(link.unanswered(row, &outcome)),
            };
        }
        if !link.has_started {
            return Ok("nothing was sent that moves the robot".to_owned());
        }
        link.tell_of_stop();
        link.carry_out(Procedure::stop()).await?;
        let released = Procedure::set(input::STOP, true).ok_or_else(|| Failure::local("the stop input is no input"))?;
        link.carry_out(released).await?;
        link.has_started = false;
        Ok(jog::STOPPED.to_owned())
    }

    fn must_halt(link: &Link) -> bool {
        link.is_jogging()
    }

    fn planned(link: &mut Link) -> Plan {
        match &mut link.transport {
            Transport::Notes(plan) => std::mem::take(plan),
            Transport::Image(_) | Transport::Board(..) => Plan::default(),
        }
    }

    fn entry(robot: &Robot, mode: ConnectMode) -> Entry {
        let fieldbus = match connect::endpoint(robot) {
            Ok(Endpoint::Bus(bus, fieldbus)) if bus.is_owner && mode == ConnectMode::Control => fieldbus,
            _ => return Entry::Harmless,
        };
        if is_held(robot) {
            Entry::ThroughSession
        } else {
            Entry::Stops(format!(
                "take the command connection and drop it at the end, which stops the robot: motor power goes off, with \
                 alarm {} (`armctl session open` keeps a connection open)",
                fieldbus.link_alarm()
            ))
        }
    }

    async fn close(mut link: Link, screen: &Screen) -> Result<(), Failure> {
        let left = link.leave().await;
        link.tell_statistics(screen);
        let closed = match link.transport {
            Transport::Image(image) => image.close().await,
            Transport::Board(board, kept) => {
                board.close().await;
                // The other end must not go before it is told.
                drop(kept);
                Ok(())
            }
            Transport::Notes(_) => return Ok(()),
        };
        if let Err(error) = closed {
            screen.detail(1, &format!("{}: the connection was not closed properly: {error}", link.label));
        }
        if link.is_owner && !link.is_simulated && !link.is_shared {
            let alarm = link.link_alarm;
            let lasting = Alarm::new(alarm.group, alarm.category + 1);
            screen.note(&format!(
                "{}: the connection is closed, which a controller takes for a fault of the link: it stops, and raises \
                 alarm {alarm} or {lasting} (`armctl help safety`); `armctl session open -r NAME` keeps one open",
                link.label
            ));
        }
        let recorded = link.trace.finish().and(link.recorder.map_or(Ok(()), Recorder::finish));
        left.and(recorded)
    }
}

impl Link {
    /// A link to a peer in this process.
    #[cfg(test)]
    pub(super) async fn to_peer(
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        peer: Box<dyn crate::transport::image::ImagePeer>,
    ) -> Result<Self, Failure> {
        let transport = Transport::Image(Box::new(ImageLink::in_process(peer)));
        let mut link = Self::new(robot, access, screen, transport, None)?;
        link.begin().await?;
        Ok(link)
    }

    fn new(
        robot: &Robot,
        access: &Access,
        screen: &Screen,
        transport: Transport,
        recorder: Option<Recorder>,
    ) -> Result<Self, Failure> {
        let timeout = robot.timeout.value;
        let endpoint = connect::endpoint(robot)?;
        let is_owner = match endpoint {
            Endpoint::Bus(bus, _) => bus.is_owner && access.mode == ConnectMode::Control,
            Endpoint::Sim(_) => access.mode != ConnectMode::Explicit,
        };
        let is_simulated = robot.target.value.is_simulated();
        let is_network = !is_simulated
            && match &transport {
                Transport::Image(image) => image.shown().is_none(),
                Transport::Notes(_) | Transport::Board(..) => true,
            };
        let policy = Policy {
            ready: timeout,
            accept: timeout,
            release: timeout,
            quick: timeout.max(QUICK),
            power: timeout.max(POWER),
            ..Policy::default()
        };
        Ok(Self {
            trace: Trace::open(access, screen, is_network)?,
            recorder,
            size: match &transport {
                Transport::Image(image) => image.output_size(),
                Transport::Notes(_) | Transport::Board(..) => Image::BYTES,
            },
            transport,
            link_alarm: endpoint.fieldbus().link_alarm(),
            is_simulated,
            is_owner,
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
            retries: robot.retries.value,
            screen: *screen,
            granted: access.granted.clone(),
            label: robot.label(),
            unit: access.unit,
            has_started: false,
            words: Words::default(),
            is_held: is_simulated,
            is_shared: false,
            is_over: false,
            told: None,
            started: Instant::now(),
            totals: Totals::default(),
        })
    }

    /// Begins an order for the robot of `--unit`.
    pub fn draft(&self, command: Command) -> Result<Draft, Failure> {
        let row = command.row();
        match self.unit {
            0 => Ok(command.order()),
            unit if row.has_robot() => Ok(command.order().with(Key::Robot, i32::from(unit))),
            _ => self.no_unit(&format!("{} is for no single robot", row.id)).map(|()| command.order()),
        }
    }

    /// Carries out an order; a refusal is a failure. A dry run notes it, and ends with the first one that reads.
    pub async fn run(&mut self, order: &Order) -> Result<Done, Failure> {
        let given = self.try_run(order).await?;
        given.done(order)
    }

    /// In a dry run, notes all the questions, whose answers are not known then.
    pub fn dry_run(&mut self, orders: &[Order]) -> Result<(), Failure> {
        if !self.is_dry() || orders.is_empty() {
            return Ok(());
        }
        for order in orders {
            self.note(order, Reason::default());
        }
        Err(unknown())
    }

    /// Carries out an order; a refusal is an answer. Only what reads is repeated, as long as `--timeout` and `--retries`
    /// allow.
    pub async fn try_run(&mut self, order: &Order) -> Result<Given, Failure> {
        self.admit(order.row().id, order.risk())?;
        if self.is_dry() {
            self.note(order, Reason::default());
            if order.risk() == Risk::Read {
                return Err(unknown());
            }
            let answer = Answer::Done(Values::default());
            return Ok(Given { answer, words: Words::default(), elapsed: Duration::ZERO });
        }
        let until = Instant::now() + self.timeout;
        let mut repetitions = if order.risk() == Risk::Read { self.retries } else { 0 };
        loop {
            let outcome = self.converse(order).await?;
            match outcome.ended {
                Ended::NotSent(_) | Ended::NoAnswer(_) if repetitions > 0 && Instant::now() < until => repetitions -= 1,
                _ => return self.given(order.row(), outcome),
            }
        }
    }

    /// One command, one answer.
    async fn converse(&mut self, order: &Order) -> Result<Outcome, Failure> {
        if order.row().pace == Pace::Jog {
            return Ok(self.see_through(order, None).await?.outcome);
        }
        self.start(order).await?;
        let outcome = self.until_ended().await?;
        self.count(order, &outcome);
        Ok(outcome)
    }

    /// Takes note of how an order ended.
    fn count(&mut self, order: &Order, outcome: &Outcome) {
        self.totals.commands += 1;
        self.totals.waited += outcome.elapsed;
        if let Some(status) = outcome.leftover {
            self.screen.detail(1, &format!("the status was '{status}' before {}; it was reset", order.row().id));
        }
        if matches!(outcome.ended, Ended::Answered(_)) && !outcome.released {
            self.screen.note(&format!("warning: {} has ended, but the controller is not ready again", order.row().id));
        }
        // Motions have ended with their answer; a program has begun.
        self.has_started |= order.risk() == Risk::Motion && order.row().pace == Pace::Quick;
    }

    /// Carries out an order until it has ended, or the controller is seen to carry it out (`None`): it then goes on, and
    /// the link takes no other until it ends.
    pub async fn begin_run(&mut self, order: &Order) -> Result<Option<Done>, Failure> {
        if !self.is_held {
            return Err(Failure::usage(
                "without waiting, the connection would end now, and the controller stop the robot",
            )
            .hint("remove --no-wait, or keep a connection open with `armctl session open` first"));
        }
        if self.is_dry() {
            return self.run(order).await.map(Some);
        }
        self.admit(order.row().id, order.risk())?;
        self.start(order).await?;
        loop {
            if let Some(outcome) = self.ended.take() {
                return self.given(order.row(), outcome)?.done(order).map(Some);
            }
            if self.exchange.as_ref().is_some_and(Exchange::is_running) {
                return Ok(None);
            }
            self.turn().await?;
        }
    }

    /// What came of an exchange that has ended.
    fn given(&self, row: &Row, outcome: Outcome) -> Result<Given, Failure> {
        match outcome.ended {
            Ended::Answered(answer) => {
                Ok(Given { answer, words: outcome.words.unwrap_or_default(), elapsed: outcome.elapsed })
            }
            _ => Err(self.unanswered(row, &outcome)),
        }
    }

    fn unanswered(&self, row: &Row, outcome: &Outcome) -> Failure {
        let stop = self.is_up.then(|| input::STOP.is_on(&self.output.next));
        refusal::unanswered(&self.label, row, outcome, stop)
    }

    /// Carries out a procedure of signals, and says how long it took.
    pub async fn carry_out(&mut self, procedure: Procedure) -> Result<Duration, Failure> {
        self.no_unit("signals are those of the whole controller")?;
        if !procedure.only_awaits() {
            self.admit(procedure.name, procedure.risk)?;
        }
        if self.is_dry() {
            self.note_steps(&procedure);
            if procedure.risk == Risk::Read {
                return Err(unknown());
            }
            return Ok(Duration::ZERO);
        }
        self.catch_up().await?;
        self.claim_motion(procedure.risk).await?;
        let name = procedure.name;
        self.has_started |= procedure.risk == Risk::Motion;
        let began = Instant::now();
        self.start_sequence(Sequence::new(procedure, self.patience))?;
        match self.until_finished().await? {
            sequence::Outcome::Done => Ok(began.elapsed()),
            outcome => Err(refusal::unfinished(&self.label, name, outcome)),
        }
    }

    /// What the controller shows now.
    pub async fn look(&mut self) -> Result<Image, Failure> {
        if self.is_dry() {
            return Err(unknown());
        }
        self.catch_up().await?;
        let until = Instant::now() + self.timeout;
        loop {
            if let Some(image) = self.input {
                return Ok(image);
            }
            if Instant::now() >= until {
                return Err(self.silent());
            }
            self.turn_until(until).await?;
        }
    }

    /// Waits until what the controller shows matters, and returns it. A loss of the link is told once.
    pub async fn look_until(&mut self, mut matters: impl FnMut(&Image) -> bool) -> Result<Image, Failure> {
        loop {
            let was_up = self.is_up;
            if let Some(image) = self.input.filter(|image| matters(image)) {
                return Ok(image);
            }
            self.turn().await?;
            if was_up && !self.is_up {
                return Err(self.silent());
            }
        }
    }

    /// What the controller is shown; `None` where that is for somebody else to show.
    pub fn shown(&self) -> Option<&Image> {
        (self.is_owner || self.is_shared).then_some(&self.output.next)
    }

    /// Whether a session holds it, and others may use it at the same time.
    pub fn is_shared(&self) -> bool {
        self.is_shared
    }

    /// Whether the connection outlives the command.
    pub fn is_held(&self) -> bool {
        self.is_held
    }

    /// Whether commands can be given, or signals only be seen.
    pub fn commands(&self) -> bool {
        self.is_owner
    }

    /// What a controller raises when the link is lost.
    pub fn link_alarm(&self) -> Alarm {
        self.link_alarm
    }

    /// Whether the fieldbus carries the words of remote commands, or signals alone.
    pub fn has_commands(&self) -> bool {
        self.size == 0 || Image::has_commands(self.size)
    }

    /// Refuses `--unit` where it means nothing.
    pub fn no_unit(&self, why: &str) -> Result<(), Failure> {
        if self.unit == 0 {
            return Ok(());
        }
        Err(Failure::usage(format!("--unit does not go with this: {why}")).hint("leave --unit away"))
    }

    /// Names the robot that commands are for.
    #[cfg(test)]
    pub(super) fn set_unit(&mut self, unit: u8) {
        self.unit = unit;
    }

    /// What may be done from now on.
    #[cfg(test)]
    pub(super) fn set_grant(&mut self, granted: Grant) {
        self.granted = granted;
    }

    /// Whether nothing is sent, only noted.
    pub fn is_dry(&self) -> bool {
        matches!(self.transport, Transport::Notes(_))
    }

    /// The last check before something leaves.
    pub fn permit(&self, name: &str, risk: Risk) -> Result<(), Failure> {
        Ok(self.granted.check(risk, name)?)
    }

    fn admit(&self, name: &str, risk: Risk) -> Result<(), Failure> {
        self.permit(name, risk)?;
        if !self.is_owner && !self.is_dry() {
            return Err(Failure::usage(format!("{name} needs a connection that commands the controller")).hint(
                "leave role away from the URL; input_only and listen_only see the signals alone: `yrcx io get`",
            ));
        }
        Ok(())
    }

    /// Says so from a thread of its own: a terminal that is held must not hold the stop.
    fn tell_of_stop(&self) {
        let screen = self.screen;
        std::thread::spawn(move || screen.note("stopping the robot: stop input SI(06) off"));
    }

    /// Notes in a dry run an order that depends on answers.
    pub fn plan(&mut self, order: &Order, about: &str) {
        self.note(order, Reason::about(about));
    }

    /// Notes in a dry run an order whose words, or whose sending, an answer before it decides. `other` is the same order
    /// with other answers: where both differ nothing is known.
    pub fn plan_depending(&mut self, order: &Order, other: &Order, reason: Reason<'_>) {
        let word = |(one, other): (&u16, &u16)| if one == other { format!("0x{one:04X}") } else { "?".to_owned() };
        let words: Vec<String> = order.words().iter().zip(other.words()).map(word).collect();
        if let Transport::Notes(plan) = &mut self.transport {
            plan.note(json!({ "wi": words }), reason);
        }
    }

    /// Says in a dry run what follows that cannot be shown.
    pub fn then(&mut self, what: &str) {
        if let Transport::Notes(plan) = &mut self.transport {
            plan.then(what);
        }
    }

    fn note(&mut self, order: &Order, reason: Reason<'_>) {
        if let Transport::Notes(plan) = &mut self.transport {
            plan.note(json!({ "wi": hex(order.words()) }), reason);
        }
    }

    /// Notes what each edge of a procedure shows.
    fn note_steps(&mut self, procedure: &Procedure) {
        let Transport::Notes(plan) = &mut self.transport else { return };
        let image = &mut self.output.next;
        for step in &procedure.steps {
            let (signal, on) = match *step {
                Step::Set { signal, on } => (signal, on),
                Step::Rise(signal) => (signal, true),
                Step::Require { .. } | Step::Await { .. } => continue,
            };
            let is_there = signal.is_on(image) == on;
            signal.set(image, on);
            let [now, before] = if on { ["on", "off"] } else { ["off", "on"] };
            let about = format!("{} {now}", named(signal));
            let depends_on = format!("what is shown before it: it is sent if {} is {before}", signal.name());
            let reason = Reason::about(&about);
            let reason = if is_there { reason.depending_on(&depends_on) } else { reason };
            plan.note(json!({ "bits": hex(&image.0[COMMAND_WORDS..]) }), reason);
        }
    }

    fn silent(&self) -> Failure {
        hold::silent(&self.label)
    }

    fn tell_statistics(&self, screen: &Screen) {
        let Totals { commands, waited, losses } = self.totals;
        let Transport::Image(image) = &self.transport else { return };
        screen.detail(1, &format!("{commands} remote commands, {waited:.1?} from sending to their ends"));
        let Some(Traffic { sent, received, intervals, mut odd }) = image.traffic() else { return };
        let every = intervals.map(|(to, from)| format!(" every {to:?} and {from:?}")).unwrap_or_default();
        screen.detail(1, &format!("{sent} images sent, {received} received{every}"));
        odd.push((losses.into(), "losses of the link"));
        let odd: Vec<String> =
            odd.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
        if !odd.is_empty() {
            screen.detail(1, &format!("on the way: {}", odd.join(", ")));
        }
    }
}

/// Words as they are written.
pub fn hex(words: &[u16]) -> Vec<String> {
    words.iter().map(|word| format!("0x{word:04X}")).collect()
}

#[cfg(test)]
mod tests;

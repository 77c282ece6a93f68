//! Originator of a connection: opens the connection, exchanges images, detects a loss, and opens the connection again.
//! The originator has no sockets and no clock.
//!
//! Each opening starts a new generation. The caller must name the generation with every image. After a loss, the
//! originator sends the resting image in idle mode. It sends another image only when a caller that has seen the loss
//! sets one. Therefore an image from before the loss is never sent again.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use super::class1::{Consumer, DatagramResult, Producer};
use super::error::EipError;
use super::explicit::Answer;
use super::session::{Ask, Session, Step, Token};
use super::settings::{Role, Settings};
use super::wire::{Close, Command, Cyclic, Net, Open, Opened, RUN, RrData, Triad};
use super::{IO_PORT, Now};
use crate::BACKOFF;
use crate::image::image_after_loss;
use crate::refuse_if;

mod identifiers;
mod view;

pub use identifiers::Identifiers;
pub use view::{Details, Input, State, Statistics, View, Views};

const OPEN: Token = Token(0);
const CLOSE: Token = Token(1);
const FORWARD_OPEN: &str = "ForwardOpen";
const FORWARD_CLOSE: &str = "ForwardClose";
/// Transport class 1, cyclic.
const TRANSPORT: u8 = 1;
/// Extended status of a refused ForwardClose: the connection does not exist.
const NOT_FOUND: u16 = 0x0107;

/// An action that the driver must execute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Action {
    /// Open the TCP connection; then call [`Originator::connected`] or [`Originator::disconnected`].
    Connect,
    /// Send these bytes on the TCP connection.
    Send(Vec<u8>),
    /// Close the TCP connection.
    Disconnect,
    /// Send this datagram.
    Datagram(SocketAddrV4, Vec<u8>),
    /// Join this multicast group.
    Join(Ipv4Addr),
    /// Leave this multicast group.
    Leave(Ipv4Addr),
    /// Deliver the answer to a message of the caller.
    Answer(Token, Result<Vec<u8>, EipError>),
}

/// Image streams in both directions.
#[derive(Debug, Clone)]
struct Io {
    producer: Producer,
    consumer: Consumer,
    destination: SocketAddrV4,
    group: Option<Ipv4Addr>,
    /// UDP port from which the first image came. The standard leaves the choice of this port to the device.
    source_port: Option<u16>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    // The originator has not been polled yet.
    New,
    // ForwardOpen was sent; its answer is pending.
    Opening,
    Open,
    // One last image is sent in idle mode before the close. The number is the number of datagrams that were sent
    // before it.
    Parting(u64),
    // ForwardClose was sent. After its answer, the connection ends. If `again` is `true`, it opens again.
    Closing { is_reopening: bool },
    // The originator waits until the next attempt to open the connection.
    Waiting(Now),
    Ended,
}

/// A connection to a device.
#[derive(Debug)]
pub struct Originator {
    settings: Settings,
    identifiers: Arc<Identifiers>,
    target: SocketAddrV4,
    port: u16,
    session: Session,
    phase: Phase,
    triad: Triad,
    id: u32,
    io: Option<Io>,
    image: Vec<u8>,
    revision: u64,
    /// Whether the caller has closed the connection.
    is_over: bool,
    tries: usize,
    /// Sum of the counters of earlier generations.
    before: Statistics,
    view: View,
    has_changed: bool,
    actions: VecDeque<Action>,
}

impl Originator {
    /// Creates a connection to the device at this TCP address. `port` is the UDP port on which images arrive.
    pub fn new(
        target: SocketAddrV4,
        port: u16,
        settings: Settings,
        identifiers: Arc<Identifiers>,
    ) -> Result<Self, EipError> {
        settings.check()?;
        Ok(Self {
            session: Session::new(settings.timeout),
            image: settings.resting.clone(),
            triad: identifiers.triad(),
            id: identifiers.id(),
            settings,
            identifiers,
            target,
            port,
            phase: Phase::New,
            io: None,
            revision: 0,
            is_over: false,
            tries: 0,
            before: Statistics::default(),
            view: View::new(Details::default()),
            has_changed: true,
            actions: VecDeque::new(),
        })
    }

    /// TCP address of the device.
    pub const fn target(&self) -> SocketAddrV4 {
        self.target
    }

    /// Current state.
    pub fn view(&self) -> View {
        let mut view = self.view.clone();
        view.statistics = self.before;
        if let Some(io) = &self.io {
            view.statistics.add(&io.producer, &io.consumer);
        }
        view
    }

    /// Whether the view has changed after the last call.
    pub const fn take_changed(&mut self) -> bool {
        std::mem::replace(&mut self.has_changed, false)
    }

    /// Whether the connection has ended and no action is left.
    pub fn is_finished(&self) -> bool {
        self.phase == Phase::Ended && self.actions.is_empty()
    }

    /// Sends this image, starting with the next interval. Returns the number of the change. When `sent` of the view has
    /// reached this number, the image was sent.
    ///
    /// # Errors
    /// The connection is not open in this generation, or the image has another size.
    pub fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, EipError> {
        self.view.check(generation)?;
        if image.len() != self.image.len() {
            let (len, size) = (image.len(), self.image.len());
            return Err(EipError::Impossible(format!("the output image has {size} bytes, not {len}")));
        }
        self.image.copy_from_slice(image);
        self.revision += 1;
        Ok(self.revision)
    }

    /// Sets the run/idle bit. Returns the number of the change, like [`set_image`](Self::set_image).
    ///
    /// # Errors
    /// The connection is not open in this generation.
    pub fn set_run(&mut self, generation: u32, run: bool) -> Result<u64, EipError> {
        self.view.check(generation)?;
        self.view.details.run = run;
        self.revision += 1;
        Ok(self.revision)
    }

    /// Sends a message in the session of this connection. Tokens 0 and 1 are reserved.
    pub fn ask(&mut self, ask: Ask) {
        if self.phase == Phase::Ended {
            self.actions.push_back(Action::Answer(ask.token, Err(EipError::Ended)));
        } else {
            self.session.ask(ask);
        }
    }

    /// Closes the connection: sends one image in idle mode, then ForwardClose.
    pub fn close(&mut self) {
        if self.is_over {
            return;
        }
        self.is_over = true;
        match self.phase {
            Phase::Open => {
                self.view.details.run = false;
                self.phase = Phase::Parting(self.io.as_ref().map_or(0, |io| io.producer.sent));
                self.show(State::Closing);
            }
            Phase::New | Phase::Waiting(_) => self.finish(None),
            // The close follows after the pending answer.
            Phase::Opening | Phase::Closing { .. } => self.show(State::Closing),
            Phase::Parting(_) | Phase::Ended => {}
        }
    }

    /// Handles the opening of the TCP connection.
    pub fn connected(&mut self, now: Now) {
        self.session.connected(now);
    }

    /// Handles the failure or the end of the TCP connection. The image exchange continues without the TCP connection.
    pub fn disconnected(&mut self, why: &EipError) {
        self.session.lost(why);
    }

    /// Handles bytes from the TCP connection.
    pub fn received(&mut self, now: Now, bytes: &[u8]) {
        self.session.received(now, bytes);
    }

    /// Handles an action that failed on a local socket. The connection continues until it times out.
    pub fn failed(&mut self, last_error: EipError) {
        self.view.last_error = Some(last_error);
        self.has_changed = true;
    }

    /// Whether datagrams with this id from this address belong to the connection.
    pub fn expects(&self, from: Ipv4Addr, id: u32) -> bool {
        let hosts = |io: &Io| from == *self.target.ip() || from == *io.destination.ip();
        self.io.as_ref().is_some_and(|io| io.consumer.id() == id && hosts(io))
    }

    /// Handles a datagram of this connection. `from` is its source port. After the first image, datagrams from other
    /// ports are ignored, so that another program at the address of the device cannot forge an image.
    pub fn receive_datagram(&mut self, now: Now, from: u16, datagram: &Cyclic<'_>) {
        let Some(io) = &mut self.io else { return };
        if io.source_port.is_some_and(|port| port != from) {
            return;
        }
        match io.consumer.take(now, datagram) {
            DatagramResult::Image { image, .. } => {
                io.source_port = Some(from);
                self.tries = 0;
                let before = self.view.input.as_ref().filter(|input| *input.image == *image);
                self.view.input = Some(Input {
                    image: before.map_or_else(|| image.into(), |input| Arc::clone(&input.image)),
                    at: now,
                    generation: self.view.generation,
                });
                self.has_changed = true;
            }
            DatagramResult::Alive => self.tries = 0,
            DatagramResult::Stale | DatagramResult::WrongSize => {}
        }
    }

    /// Returns the next action at `now`. The caller repeats the call until it returns `None`.
    pub fn poll(&mut self, now: Now) -> Option<Action> {
        loop {
            if let Some(action) = self.actions.pop_front() {
                return Some(action);
            }
            match self.session.poll(now) {
                Some(Step::Connect) => return Some(Action::Connect),
                Some(Step::Send(bytes)) => return Some(Action::Send(bytes)),
                Some(Step::Disconnect) => return Some(Action::Disconnect),
                Some(Step::Answer { token: OPEN, sent, result }) => self.answered(now, sent, result),
                Some(Step::Answer { token: CLOSE, result, .. }) => self.closed(now, result),
                Some(Step::Answer { token, result, .. }) => return Some(Action::Answer(token, result)),
                None if self.advance(now) => {}
                None => return None,
            }
        }
    }

    /// Latest time of the next call of [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        let own = match self.phase {
            Phase::New => Some(Now::ZERO),
            Phase::Waiting(until) => Some(until),
            _ => None,
        };
        let io = self.io.as_ref().map(|io| io.producer.due().min(io.consumer.until()));
        [own, io, self.session.wake()].into_iter().flatten().min()
    }

    /// Executes the work that is due. Returns whether any work was due.
    fn advance(&mut self, now: Now) -> bool {
        match self.phase {
            Phase::New => self.open(),
            Phase::Waiting(until) if now >= until => self.open(),
            Phase::Parting(before) if self.io.as_ref().is_none_or(|io| io.producer.sent > before) => {
                self.request_close(false);
            }
            _ => return self.exchange(now),
        }
        true
    }

    /// Sends an image if one is due, and checks whether the device has timed out.
    fn exchange(&mut self, now: Now) -> bool {
        let Some(io) = &mut self.io else { return false };
        if now >= io.consumer.until() {
            let after = io.consumer.patience();
            self.handle_timeout(EipError::Silent(after));
            return true;
        }
        if now < io.producer.due() {
            return false;
        }
        let header =
            (self.settings.role == Role::ExclusiveOwner).then_some(if self.view.details.run { RUN } else { 0 });
        let datagram = io.producer.produce(now, header, &self.image);
        self.actions.push_back(Action::Datagram(io.destination, datagram));
        self.has_changed |= self.view.sent != self.revision;
        self.view.sent = self.revision;
        true
    }

    fn open(&mut self) {
        self.phase = Phase::Opening;
        self.triad = self.identifiers.triad();
        self.id = self.identifiers.id();
        let open = Open {
            o_t_id: 0,
            t_o_id: self.id,
            triad: self.triad,
            multiplier: self.settings.multiplier.code(),
            o_t: self.settings.o_t(),
            t_o: self.settings.t_o(),
            transport: TRANSPORT,
            path: self.settings.opening_path(),
        };
        // For multicast, the device selects the port of the group. For a point-to-point connection, the request
        // contains the UDP port of this program.
        let own = (open.t_o.net == Net::PointToPoint).then(|| SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, self.port));
        let data = RrData { t_o: own, ..RrData::new(&open.emit()) }.emit();
        self.session.ask(Ask { token: OPEN, what: FORWARD_OPEN, command: Command::SEND_RR_DATA, data });
    }

    /// Handles the outcome of ForwardOpen. `sent` says whether the request was sent.
    fn answered(&mut self, now: Now, sent: bool, result: Result<Vec<u8>, EipError>) {
        let last_error = match result.and_then(|data| self.opened(now, &data)) {
            Ok(()) if self.is_over => return self.request_close(false),
            Ok(()) => return,
            Err(last_error) => last_error,
        };
        // Without a refusal, the device may have opened the connection.
        let is_refusal = matches!(last_error, EipError::Refused { .. } | EipError::Encapsulation { .. });
        let is_reopening = self.view.generation > 0 && !self.is_over;
        self.view.last_error = Some(last_error);
        if sent && !is_refusal {
            self.request_close(is_reopening);
        } else if is_reopening {
            self.wait(now);
        } else {
            self.finish(None);
        }
    }

    fn opened(&mut self, now: Now, data: &[u8]) -> Result<(), EipError> {
        let malformed = |error| EipError::Malformed { what: FORWARD_OPEN, error };
        let senseless = |why| EipError::Senseless { what: FORWARD_OPEN, why };
        let answer = Answer::parse(FORWARD_OPEN, data)?;
        let addresses = RrData::parse_answer(data).map_err(malformed)?;
        let opened = Opened::parse(&answer.done(FORWARD_OPEN)?).map_err(malformed)?;
        refuse_if(opened.triad != self.triad, senseless("it belongs to another connection"))?;
        if opened.t_o_id != self.id && !self.settings.multicast {
            return Err(senseless("it changes the connection id that armctl chose"));
        }
        let interval = |us: u32| {
            let interval = Duration::from_micros(us.into());
            if interval < super::settings::MIN_INTERVAL {
                Err(senseless("its interval is too short"))
            } else {
                Ok(interval)
            }
        };
        let (to, from) = (interval(opened.o_t_api_us)?, interval(opened.t_o_api_us)?);
        let destination = match addresses.o_t {
            Some(address) if address.ip().is_unspecified() => SocketAddrV4::new(*self.target.ip(), address.port()),
            Some(address) => address,
            None => SocketAddrV4::new(*self.target.ip(), IO_PORT),
        };
        let group = addresses.t_o.map(|address| *address.ip()).filter(Ipv4Addr::is_multicast);
        refuse_if(self.settings.multicast && group.is_none(), senseless("it contains no multicast group"))?;
        self.actions.extend(group.map(Action::Join));
        let intervals = self.settings.multiplier.intervals();
        let size = usize::from(self.settings.input_size);
        self.io = Some(Io {
            source_port: None,
            // A device starts to send when it answers. The originator starts half an interval later, so that the next
            // image of the device already contains the reaction to the image of the originator.
            producer: Producer::new(opened.o_t_id, to, now.saturating_add(to / 2)),
            consumer: Consumer::new(opened.t_o_id, size, false, from, intervals, now),
            destination,
            group,
        });
        self.phase = Phase::Open;
        self.view.generation += 1;
        self.view.details.intervals = Some((to, from));
        self.view.last_error = None;
        self.show(State::Open);
        Ok(())
    }

    /// Handles a timeout of the device.
    fn handle_timeout(&mut self, last_error: EipError) {
        self.stop();
        self.view.last_error = Some(last_error);
        match self.phase {
            Phase::Open => {
                self.image = image_after_loss(&self.settings.resting, &self.image);
                self.view.details.run = false;
                self.show(State::Lost);
                // Perhaps only the path from the device to this program is broken. ForwardClose closes the old
                // connection in the device, so that the next opening succeeds.
                self.request_close(true);
            }
            Phase::Parting(_) => self.request_close(false),
            _ => {}
        }
    }

    fn request_close(&mut self, is_reopening: bool) {
        self.phase = Phase::Closing { is_reopening };
        let message = Close { triad: self.triad, path: self.settings.path() }.emit();
        let data = RrData::new(&message).emit();
        self.session.ask(Ask { token: CLOSE, what: FORWARD_CLOSE, command: Command::SEND_RR_DATA, data });
    }

    /// Handles the outcome of ForwardClose.
    fn closed(&mut self, now: Now, result: Result<Vec<u8>, EipError>) {
        self.stop();
        let Phase::Closing { is_reopening } = self.phase else { return };
        if is_reopening && !self.is_over {
            return self.wait(now);
        }
        let outcome = result.and_then(|data| Answer::parse(FORWARD_CLOSE, &data)).and_then(|answer| {
            if answer.status.extended.first() == Some(&NOT_FOUND) { Ok(Vec::new()) } else { answer.done(FORWARD_CLOSE) }
        });
        // An error of the close is reported only if there was no earlier error.
        self.finish(outcome.err());
    }

    fn wait(&mut self, now: Now) {
        let wait = BACKOFF[self.tries.min(BACKOFF.len() - 1)];
        self.tries += 1;
        self.phase = Phase::Waiting(now.saturating_add(wait));
        self.show(State::Lost);
    }

    fn finish(&mut self, last_error: Option<EipError>) {
        self.stop();
        self.session.end();
        self.phase = Phase::Ended;
        if self.view.last_error.is_none() {
            self.view.last_error = last_error;
        }
        self.show(State::Closed);
    }

    /// Stops the streams and saves their counters.
    fn stop(&mut self) {
        if let Some(io) = self.io.take() {
            self.before.add(&io.producer, &io.consumer);
            self.actions.extend(io.group.map(Action::Leave));
        }
    }

    fn show(&mut self, state: State) {
        self.view.state = state;
        self.has_changed = true;
    }
}

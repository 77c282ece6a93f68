//! PROFINET controller of one connection: finds the device, connects, exchanges images, detects a loss, and connects
//! again. The controller has no sockets and no clock.
//!
//! Each time that the data becomes usable, a new generation starts. The caller must name the generation with every
//! image. After a loss, the controller sends the resting image. It sends another image only when a caller that has seen
//! the loss sets one. Therefore an image from before the loss is never sent again.

use std::collections::VecDeque;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use self::alarms::{AlarmEvent, Alarms};
use self::client::Client;
use self::cyclic::{Consumer, FrameResult, Producer};
use self::identifiers::Identifiers;
use self::view::{Details, Device, Input, State, Statistics, Step, View};
use super::Now;
use super::error::{ProfinetError, Unusable};
use super::settings::Settings;
use super::wire::alarm::{self, Notification, Priority};
use super::wire::dcp::IpSuite;
use super::wire::frame::{Frame, TAG_HIGH, id};
use super::wire::rpc::{Datagram, Kind, PORT};
use super::wire::status::Status;
use super::wire::{Mac, Uuid};
use crate::image::image_after_loss;

mod alarms;
mod answer;
pub mod client;
mod cyclic;
pub mod identifiers;
mod open;
mod resolve;
pub mod view;

/// Pauses before attempts to reconnect. The last pause repeats.
const BACKOFF: [Duration; 4] =
    [Duration::from_secs(1), Duration::from_secs(2), Duration::from_secs(4), Duration::from_secs(8)];
/// Time after which a device has closed the connection of a controller process that was killed.
const OLD_CONNECTION: Duration = Duration::from_secs(2);
/// Maximum number of times that the controller waits for the end of such an old connection.
const OLD_TRIES: usize = 3;
/// Time limit for the device to become ready. The same limit applies to its first usable data.
const START: Duration = Duration::from_secs(20);
/// Reason codes of abort messages.
const WATCHDOG: u8 = 0x05;
const ALARM_LOST: u8 = 0x08;
const ABORTED: u8 = 0x0D;
/// Reason code with which a device confirms a release.
const RELEASED: u8 = 0x0F;
/// Maximum number of alarms in the queue.
const MAX_ALARMS: usize = 64;

/// An action that the driver must execute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Action {
    /// Send this Ethernet frame.
    Frame(Vec<u8>),
    /// Send these bytes from UDP port 34964.
    Datagram(SocketAddrV4, Vec<u8>),
}

/// Local addresses of the controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LocalAddress {
    /// MAC address.
    pub mac: Mac,
    /// IP address and network.
    pub ip: IpSuite,
}

#[derive(Debug)]
enum Phase {
    /// The controller has not been polled yet.
    New,
    Resolve(resolve::Search),
    Address(resolve::Address),
    /// A call of the opening is in progress, or the controller waits for a call of the device.
    Opening,
    /// The controller waits until this time for usable data.
    WaitingForData(Now),
    Data,
    /// Release was called. After its answer, the connection ends. If an error was the reason for the release, the
    /// connection may open again.
    Releasing(Option<ProfinetError>),
    /// The controller waits until the next attempt to connect.
    Waiting(Now),
    Ended,
}

/// Application relation (AR): one attempt to open the connection.
#[derive(Debug)]
struct Ar {
    uuid: Uuid,
    session_key: u16,
    reference: u16,
    input_id: u16,
    client: Client,
    step: Step,
    /// Time limit for ApplicationReady.
    ready_until: Now,
    is_ready: bool,
    /// Cyclic data and alarms; `None` before the answer to Connect.
    io: Option<Io>,
}

#[derive(Debug)]
struct Io {
    output_id: u16,
    producer: Producer,
    consumer: Consumer,
    alarms: Alarms,
}

/// A connection to a device.
#[derive(Debug)]
pub struct Controller {
    settings: Settings,
    identifiers: Arc<Identifiers>,
    local_address: LocalAddress,
    phase: Phase,
    ar: Option<Ar>,
    device: Option<Device>,
    image: Vec<u8>,
    revision: u64,
    /// Whether the caller has closed the connection.
    is_over: bool,
    /// Number of failed attempts after the data was last usable.
    tries: usize,
    before: Statistics,
    view: View,
    has_changed: bool,
    alarms: VecDeque<Notification>,
    actions: VecDeque<Action>,
}

impl Controller {
    /// Creates a connection.
    pub fn new(
        local_address: LocalAddress,
        settings: Settings,
        identifiers: Arc<Identifiers>,
    ) -> Result<Self, ProfinetError> {
        settings.check()?;
        Ok(Self {
            image: settings.resting.clone(),
            settings,
            identifiers,
            local_address,
            phase: Phase::New,
            ar: None,
            device: None,
            revision: 0,
            is_over: false,
            tries: 0,
            before: Statistics::default(),
            view: View::new(Details { step: Step::Resolve, device: None }),
            has_changed: true,
            alarms: VecDeque::new(),
            actions: VecDeque::new(),
        })
    }

    /// Current state.
    pub fn view(&self) -> View {
        let mut view = self.view.clone();
        view.details.device.clone_from(&self.device);
        view.statistics = self.statistics();
        view
    }

    /// Current counters.
    pub fn statistics(&self) -> Statistics {
        let mut all = self.before;
        if let Some(io) = self.ar.as_ref().and_then(|ar| ar.io.as_ref()) {
            all.sent += io.producer.sent;
            all.skipped += io.producer.skipped;
            all.received += io.consumer.received;
            all.stale += io.consumer.stale;
        }
        all
    }

    /// Settings of the connection.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Whether the view has changed after the last call.
    pub const fn take_changed(&mut self) -> bool {
        std::mem::replace(&mut self.has_changed, false)
    }

    /// Returns the next alarm in the queue. If too many alarms wait, the queue drops the oldest.
    pub fn take_alarm(&mut self) -> Option<Notification> {
        self.alarms.pop_front()
    }

    /// Whether the connection has ended and no action is left.
    pub fn is_finished(&self) -> bool {
        matches!(self.phase, Phase::Ended) && self.actions.is_empty()
    }

    /// Sends this image, starting with the next cycle. Returns the number of the change. When `sent` of the view has
    /// reached this number, the image was sent.
    ///
    /// # Errors
    /// The connection is not open in this generation, or the image has another size.
    pub fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, ProfinetError> {
        self.view.check(generation)?;
        if image.len() != self.image.len() {
            let (len, size) = (image.len(), self.image.len());
            return Err(ProfinetError::Impossible(format!("the output image has {size} bytes, not {len}")));
        }
        self.image.copy_from_slice(image);
        self.revision += 1;
        Ok(self.revision)
    }

    /// Releases the connection. Cyclic frames with the last image continue until the device answers the release.
    pub fn close(&mut self, now: Now) {
        if std::mem::replace(&mut self.is_over, true) {
            return;
        }
        match self.phase {
            Phase::New | Phase::Resolve(_) | Phase::Address(_) | Phase::Waiting(_) => self.finish(None),
            Phase::Opening | Phase::WaitingForData(_) | Phase::Data => self.release(now, None),
            Phase::Releasing(_) => self.show(State::Closing),
            Phase::Ended => {}
        }
    }

    /// Handles an action that failed on a local socket. The connection continues until it times out.
    pub fn failed(&mut self, last_error: ProfinetError) {
        self.view.last_error = Some(last_error);
        self.has_changed = true;
    }

    /// Time of the next [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        if !self.actions.is_empty() {
            return Some(Now::ZERO);
        }
        let phase = match &self.phase {
            Phase::New => return Some(Now::ZERO),
            Phase::Resolve(search) => Some(search.wake()),
            Phase::Address(address) => Some(address.wake()),
            Phase::WaitingForData(until) | Phase::Waiting(until) => Some(*until),
            Phase::Opening | Phase::Data | Phase::Releasing(_) => None,
            Phase::Ended => return None,
        };
        let ar = self.ar.as_ref().and_then(|ar| self.ar_wake(ar));
        phase.into_iter().chain(ar).min()
    }

    fn ar_wake(&self, ar: &Ar) -> Option<Now> {
        let ready = (ar.step == Step::Ready && matches!(self.phase, Phase::Opening)).then_some(ar.ready_until);
        let io = ar.io.as_ref().and_then(|io| {
            let watchdog = self.watchdog(io);
            [Some(io.producer.wake()), io.alarms.wake(), watchdog].into_iter().flatten().min()
        });
        [ready, io, ar.client.wake()].into_iter().flatten().min()
    }

    /// Time at which the watchdog expires; `None` while the watchdog is off. It is off at first, because a device need
    /// not send frames before it is ready.
    fn watchdog(&self, io: &Io) -> Option<Now> {
        let is_on = matches!(self.phase, Phase::Data | Phase::WaitingForData(_));
        io.consumer.last_frame_at.filter(|_| is_on).map(|last_frame_at| last_frame_at + self.settings.watchdog_time())
    }

    /// Returns the next action at `now`.
    pub fn poll(&mut self, now: Now) -> Option<Action> {
        if self.actions.is_empty() {
            self.tick(now);
        }
        self.actions.pop_front()
    }

    fn tick(&mut self, now: Now) {
        match &self.phase {
            Phase::New => self.resolve(now),
            Phase::Waiting(until) if *until <= now => self.resolve(now),
            Phase::Resolve(search) if search.wake() <= now => self.search_on(now),
            Phase::Address(address) if address.wake() <= now => self.address_on(now),
            Phase::WaitingForData(until) if *until <= now => {
                let missing = match self.view.last_error {
                    Some(ProfinetError::Unusable(why)) => why,
                    _ => Unusable::Missing,
                };
                self.abort(now, ABORTED, ProfinetError::NoData { after: START, missing });
            }
            _ => {}
        }
        self.produce(now);
        let io = self.ar.as_ref().and_then(|ar| ar.io.as_ref());
        if io.and_then(|io| self.watchdog(io)).is_some_and(|until| until <= now) {
            let after = self.settings.watchdog_time();
            self.abort(now, WATCHDOG, ProfinetError::Silent(after));
            return;
        }
        self.poll_alarms(now);
        let Some(ar) = &mut self.ar else { return };
        match ar.client.poll(now) {
            Some(client::Step::Send(bytes)) => self.send(bytes),
            Some(client::Step::Done(outcome)) => self.answered(now, outcome),
            None => {
                let is_late = matches!(self.phase, Phase::Opening) && ar.step == Step::Ready && ar.ready_until <= now;
                if is_late {
                    self.release(now, Some(ProfinetError::NeverReady(START)));
                }
            }
        }
    }

    fn produce(&mut self, now: Now) {
        let Some(io) = self.ar.as_mut().and_then(|ar| ar.io.as_mut()) else { return };
        let Some(payload) = io.producer.poll(now, &self.image) else { return };
        let frame_id = io.output_id;
        self.send_frame(Some(TAG_HIGH), frame_id, &payload);
        if self.view.sent != self.revision {
            self.view.sent = self.revision;
            self.has_changed = true;
        }
    }

    fn poll_alarms(&mut self, now: Now) {
        let Some(io) = self.ar.as_mut().and_then(|ar| ar.io.as_mut()) else { return };
        let mut out = Vec::new();
        let is_lost = io.alarms.poll(now, &mut out);
        self.send_alarms(out);
        if is_lost {
            self.abort(now, ALARM_LOST, ProfinetError::AlarmUnanswered);
        }
    }

    fn send_alarms(&mut self, out: Vec<(Priority, Vec<u8>)>) {
        for (priority, payload) in out {
            self.send_frame(Some(priority.tag()), priority.frame_id(), &payload);
        }
    }

    fn send_frame(&mut self, tag: Option<u16>, frame_id: u16, payload: &[u8]) {
        let Some(device) = &self.device else { return };
        let frame = Frame { destination: device.mac, source: self.local_address.mac, tag, id: frame_id, payload };
        self.actions.push_back(Action::Frame(frame.emit()));
    }

    fn send(&mut self, bytes: Vec<u8>) {
        let Some(device) = &self.device else { return };
        self.actions.push_back(Action::Datagram(SocketAddrV4::new(device.address, PORT), bytes));
    }

    /// Handles a received frame.
    pub fn frame(&mut self, now: Now, bytes: &[u8]) {
        let Ok(frame) = Frame::parse(bytes) else { return };
        match frame.id {
            id::DCP_IDENTIFIED | id::DCP_GET_SET => self.handle_dcp(now, &frame),
            _ if self.device.as_ref().is_none_or(|device| device.mac != frame.source) => {}
            frame_id => {
                if let Some(priority) = Priority::from_frame_id(frame_id) {
                    self.handle_alarm(now, priority, frame.payload);
                } else if self.ar.as_ref().is_some_and(|ar| ar.io.is_some() && ar.input_id == frame_id) {
                    self.handle_data(now, frame.payload);
                }
            }
        }
    }

    /// Whether a frame belongs to this connection.
    pub fn is_for_connection(&self, bytes: &[u8]) -> bool {
        let Ok(frame) = Frame::parse(bytes) else { return false };
        match &self.device {
            Some(device) => frame.source == device.mac,
            None => frame.destination == self.local_address.mac,
        }
    }

    fn handle_alarm(&mut self, now: Now, priority: Priority, payload: &[u8]) {
        let Some(io) = self.ar.as_mut().and_then(|ar| ar.io.as_mut()) else { return };
        let mut out = Vec::new();
        let last_frame_at = io.alarms.handle(now, priority, payload, &mut out);
        self.send_alarms(out);
        match last_frame_at {
            AlarmEvent::Nothing => {}
            AlarmEvent::Error(status) => self.handle_abort(now, Status(status)),
            AlarmEvent::Alarm(alarm) => {
                let slot = alarm.slot;
                let is_plug = alarm::wants_parameters(alarm.kind);
                if self.alarms.len() == MAX_ALARMS {
                    self.alarms.pop_front();
                }
                self.alarms.push_back(alarm);
                self.before.alarms += 1;
                self.has_changed = true;
                // After a module was plugged, the device needs its parameters again. The controller opens a new
                // connection, which sends them.
                if is_plug && !matches!(self.phase, Phase::Releasing(_)) {
                    self.release(now, Some(ProfinetError::Plugged(slot)));
                }
            }
        }
    }

    /// Handles an abort: the device has closed the connection.
    fn handle_abort(&mut self, now: Now, status: Status) {
        let is_answer = status == Status::abort(RELEASED);
        if let Phase::Releasing(last_error) = &self.phase {
            // Some devices send the abort before they answer the release. The release is then complete.
            let last_error = last_error.clone();
            let last_error = if is_answer { last_error } else { last_error.or(Some(ProfinetError::Aborted(status))) };
            self.released(now, last_error);
        } else {
            self.handle_loss(now, ProfinetError::Aborted(status));
        }
    }

    fn handle_data(&mut self, now: Now, payload: &[u8]) {
        let Some(io) = self.ar.as_mut().and_then(|ar| ar.io.as_mut()) else { return };
        let verdict = io.consumer.handle(now, payload);
        match (&self.phase, verdict) {
            (Phase::WaitingForData(_), FrameResult::Image(image)) => {
                self.phase = Phase::Data;
                self.tries = 0;
                self.view.generation = self.view.generation.wrapping_add(1);
                self.view.last_error = None;
                self.view.input = Some(Input { image: image.into(), at: now, generation: self.view.generation });
                self.show(State::Open);
            }
            (Phase::Data, FrameResult::Image(image)) => {
                let image = match self.view.input.take() {
                    Some(input) if *input.image == *image => input.image,
                    _ => {
                        self.has_changed = true;
                        image.into()
                    }
                };
                self.view.input = Some(Input { image, at: now, generation: self.view.generation });
            }
            (Phase::Data, FrameResult::Unusable(why)) => {
                // The resting image is used from now on. When the data becomes usable again, an image from before the
                // fault must not become active automatically.
                self.enter_resting_image();
                self.before.losses += 1;
                self.phase = Phase::WaitingForData(now + START);
                self.view.last_error = Some(ProfinetError::Unusable(why));
                self.show(State::Lost);
            }
            (Phase::WaitingForData(_), FrameResult::Unusable(why)) => {
                self.view.last_error = Some(ProfinetError::Unusable(why));
            }
            _ => {}
        }
    }

    /// Switches to the resting image, and drops the input image.
    fn enter_resting_image(&mut self) {
        self.image = image_after_loss(&self.settings.resting, &self.image);
        self.view.input = None;
    }

    /// Handles a datagram for UDP port 34964. Only datagrams from the device are accepted.
    pub fn datagram(&mut self, now: Now, from: SocketAddrV4, bytes: &[u8]) {
        let is_device = self.device.as_ref().is_some_and(|device| device.address == *from.ip());
        let Some(datagram) = Datagram::parse(bytes).ok().filter(|_| is_device) else { return };
        if datagram.header.kind == Kind::REQUEST {
            self.called(now, from, &datagram);
            return;
        }
        let step = self.ar.as_mut().and_then(|ar| ar.client.handle(now, &datagram));
        match step {
            Some(client::Step::Send(bytes)) => self.actions.push_back(Action::Datagram(from, bytes)),
            Some(client::Step::Done(outcome)) => self.answered(now, outcome),
            None => {}
        }
    }

    /// Closes the connection with an abort message. The device does not answer an abort message.
    fn abort(&mut self, now: Now, reason: u8, last_error: ProfinetError) {
        if let Some(io) = self.ar.as_ref().and_then(|ar| ar.io.as_ref()) {
            let error = io.alarms.error(Status::abort(reason).0);
            self.send_alarms(vec![error]);
        }
        self.handle_loss(now, last_error);
    }

    /// Handles the end of the connection. The controller connects again, except after a close or after a failed first
    /// opening.
    fn handle_loss(&mut self, now: Now, last_error: ProfinetError) {
        self.drop_ar();
        let is_old = matches!(&last_error, ProfinetError::Refused { status, .. } if status.is_owned());
        let wait = match self.view.generation {
            _ if self.is_over => return self.finish(Some(last_error)),
            // The device still has the connection of an earlier process that was killed. That connection ends after its
            // own timeout.
            0 if is_old && self.tries < OLD_TRIES => OLD_CONNECTION,
            0 => return self.finish(Some(last_error)),
            _ if is_old => OLD_CONNECTION,
            _ => *BACKOFF.get(self.tries).unwrap_or(&BACKOFF[BACKOFF.len() - 1]),
        };
        self.tries += 1;
        self.view.last_error = Some(last_error);
        self.phase = Phase::Waiting(now + wait);
        self.show(if self.view.generation == 0 { State::Opening } else { State::Lost });
    }

    /// Drops the application relation (AR), but keeps its counters.
    fn drop_ar(&mut self) {
        if self.view.state == State::Open {
            self.before.losses += 1;
        }
        self.before = self.statistics();
        self.ar = None;
        self.enter_resting_image();
    }

    fn finish(&mut self, last_error: Option<ProfinetError>) {
        if last_error.is_some() {
            self.view.last_error = last_error;
        }
        self.phase = Phase::Ended;
        self.show(State::Closed);
    }

    fn show(&mut self, state: State) {
        self.view.state = state;
        self.has_changed = true;
    }

    fn set_step(&mut self, step: Step) {
        self.view.details.step = step;
        self.has_changed = true;
        if let Some(ar) = &mut self.ar {
            ar.step = step;
        }
    }

    /// Name of the device in messages.
    fn station(&self) -> String {
        self.settings.station.to_string()
    }

    /// IP address of the device, if known.
    pub fn address(&self) -> Option<Ipv4Addr> {
        self.device.as_ref().map(|device| device.address)
    }

    /// MAC address of the device, if known.
    pub fn card(&self) -> Option<Mac> {
        self.device.as_ref().map(|device| device.mac)
    }
}

//! Connection in the simulated device: cyclic frames, alarms, timeouts.

use std::net::SocketAddrV4;
use std::time::Duration;

use super::super::Now;
use super::super::layout::{Direction, Submodule};
use super::super::wire::alarm::{Notification, Priority};
use super::super::wire::block::{BlockType, Control};
use super::super::wire::connect::Iocr;
use super::super::wire::cyclic::{Cyclic, GOOD, RUNNING};
use super::super::wire::frame::TAG_HIGH;
use super::super::wire::rpc::{self, Call, Datagram, Header, Kind, PORT, operation};
use super::super::wire::status::Status;
use super::super::wire::{ByteOrder, Mac, Uuid, block};
use super::alarms::{AlarmEvent, Alarms};
use super::{Action, Application, Device, Event, Fault};

/// Number of attempts of ApplicationReady. The constant below is the time limit of each attempt.
const READY_TRIES: u32 = 3;
const READY_TIMEOUT: Duration = Duration::from_secs(2);
/// Unit of the cycle counter: 31.25 us.
const UNIT: Duration = Duration::from_nanos(31_250);
/// Reason codes of aborts by the device.
const WATCHDOG: u8 = 5;
const ACTIVITY: u8 = 6;
const ALARM_LOST: u8 = 8;
const WRONG_FRAME: u8 = 0x0C;
const READY_UNANSWERED: u8 = 0x18;
const ABORTED: u8 = 0x0D;
/// Time from the start of a connection until a fault happens that occurs once per connection.
const FAULT_DELAY: Duration = Duration::from_secs(1);
/// Structure identifier of a channel diagnosis. The constant below is a diagnosis "line break" for the whole submodule.
const CHANNEL: u16 = 0x8000;
const LINE_BREAK: [u8; 6] = [0x80, 0, 0x28, 0, 0, 6];
/// Alarm specifier: sequence number 0, with a diagnosis of the submodule.
const APPEARS: u16 = 0xA800;

/// Stage of the connection.
#[derive(Debug)]
pub(super) enum ArState {
    /// The device waits for the next call of the controller until this time.
    Parameters(Now),
    /// ApplicationReady was called. `due` is the time of the next attempt, `tries` the number of attempts left, and
    /// `sequence` the sequence number of the call.
    Ready { due: Now, tries: u32, sequence: u32 },
    /// Data is exchanged in both directions.
    Running,
}

#[derive(Debug)]
pub(super) struct Ar {
    pub(super) uuid: Uuid,
    pub(super) session_key: u16,
    pub(super) mac: Mac,
    pub(super) peer: SocketAddrV4,
    pub(super) object: Uuid,
    pub(super) activity: Uuid,
    pub(super) input: Iocr,
    pub(super) output: Iocr,
    pub(super) alarms: Alarms,
    pub(super) ar_state: ArState,
    pub(super) activity_timeout: Duration,
    pub(super) due: Now,
    pub(super) counter: u16,
    /// Time of a fault that happens once per connection. `None` if there is no such fault, or if it has already
    /// happened.
    pub(super) last_error: Option<Now>,
    /// Cycle counter of the last frame from the controller, and its time.
    pub(super) heard: Option<(u16, Now)>,
}

impl Ar {
    pub(super) const fn is_running(&self) -> bool {
        matches!(self.ar_state, ArState::Running)
    }

    fn cycle(iocr: &Iocr) -> Duration {
        UNIT * u32::from(iocr.send_clock) * u32::from(iocr.ratio)
    }

    /// Time at which the watchdog expires; `None` while it is off. The first frame of the controller starts the
    /// watchdog.
    fn watchdog(&self) -> Option<Now> {
        let time = Self::cycle(&self.output) * u32::from(self.output.watchdog);
        self.heard.map(|(_, at)| at + time)
    }

    pub(super) fn wake(&self) -> Now {
        let ar_state = match self.ar_state {
            ArState::Parameters(until) => Some(until),
            ArState::Ready { due, .. } => Some(due),
            ArState::Running => None,
        };
        [ar_state, self.alarms.wake(), self.watchdog(), self.last_error].into_iter().flatten().fold(self.due, Now::min)
    }
}

impl<A: Application> Device<A> {
    pub(super) fn tick_ar(&mut self, now: Now) {
        let Some(ar) = &mut self.ar else { return };
        match &ar.ar_state {
            ArState::Parameters(until) if *until <= now => return self.abort(now, ACTIVITY),
            ArState::Ready { due, tries: 0, .. } if *due <= now => return self.abort(now, READY_UNANSWERED),
            ArState::Ready { due, .. } if *due <= now => self.call_ready(now),
            _ => {}
        }
        let Some(ar) = &mut self.ar else { return };
        if ar.watchdog().is_some_and(|until| until <= now) {
            return self.abort(now, WATCHDOG);
        }
        let Some(repeats) = ar.alarms.poll(now) else { return self.abort(now, ALARM_LOST) };
        let is_due = ar.due <= now;
        let is_trouble = ar.last_error.take_if(|at| *at <= now).is_some();
        for (priority, payload) in repeats {
            self.send_alarm(priority, &payload);
        }
        if is_due {
            self.send_data(now);
        }
        if is_trouble {
            self.inject_fault(now);
        }
    }

    /// Executes a fault that happens once per connection.
    fn inject_fault(&mut self, now: Now) {
        match self.fault {
            Some(Fault::Diagnosis) => {
                let first = self.setup.layout.0.iter().find(|submodule| submodule.slot > 0).copied();
                if let Some(Submodule { slot, subslot, module, ident: submodule, .. }) = first {
                    let (priority, detail) = (Priority::Low, Some((CHANNEL, LINE_BREAK.to_vec())));
                    let (api, specifier) = (0, APPEARS);
                    let alarm =
                        Notification { priority, kind: 1, api, slot, subslot, module, submodule, specifier, detail };
                    self.raise(now, &alarm);
                }
            }
            Some(Fault::Restart) => self.restart(now),
            Some(Fault::Abort) => self.abort(now, ABORTED),
            _ => {}
        }
    }

    fn send_data(&mut self, now: Now) {
        self.application.image_in(now, &mut self.image);
        let fault = self.fault;
        let Some(ar) = &mut self.ar else { return };
        let cycle = Ar::cycle(&ar.input);
        while ar.due <= now {
            ar.due += cycle;
            if fault != Some(Fault::Stale) {
                ar.counter = ar.counter.wrapping_add(ar.input.send_clock.wrapping_mul(ar.input.ratio));
            }
        }
        let mut data = vec![0; usize::from(ar.input.length)];
        // The provider status is good from the time when the device is ready.
        let is_good = ar.is_running() || matches!(ar.ar_state, ArState::Ready { .. });
        let good = |is_good: bool| if is_good { GOOD } else { 0 };
        let mut rest = &self.image[..];
        for place in &ar.input.objects {
            let submodule = self.setup.layout.find(place.slot, place.subslot);
            let length = submodule.map_or(0, |submodule| usize::from(submodule.length(Direction::Input)));
            let (part, behind) = rest.split_at(length.min(rest.len()));
            rest = behind;
            let at = usize::from(place.offset);
            data[at..at + part.len()].copy_from_slice(part);
            let is_wrong = fault == Some(Fault::WrongModule) && place.slot == 1;
            data[at + length] = good(is_good && fault != Some(Fault::BadProvider) && !is_wrong);
        }
        for place in &ar.input.consumers {
            data[usize::from(place.offset)] = good(is_good && fault != Some(Fault::BadConsumer));
        }
        let status = match fault {
            Some(Fault::Stop) => RUNNING & !0x10,
            Some(Fault::Invalid) => RUNNING & !0x04,
            _ => RUNNING,
        };
        let payload = Cyclic { data: &data, counter: ar.counter, status, transfer: 0 }.emit();
        let (mac, frame_id) = (ar.mac, ar.input.frame_id);
        if fault == Some(Fault::Stall) {
            return;
        }
        let frame = self.frame_to(mac, Some(TAG_HIGH), frame_id, &payload);
        for _ in 0..if fault == Some(Fault::Double) { 2 } else { 1 } {
            self.actions.push_back(Action::Frame(frame.clone()));
        }
    }

    pub(super) fn handle_data(&mut self, now: Now, frame_id: u16, payload: &[u8]) {
        let Some(ar) = &mut self.ar else { return };
        if frame_id != ar.output.frame_id {
            return;
        }
        let Ok(cyclic) = Cyclic::parse(payload, usize::from(ar.output.length)) else {
            return self.abort(now, WRONG_FRAME);
        };
        if ar.heard.is_some_and(|(last, _)| !cyclic.is_after(last)) {
            return;
        }
        ar.heard = Some((cyclic.counter, now));
        let is_good = |at: usize| cyclic.data.get(at).is_some_and(|status| status & GOOD != 0);
        let mut image = Vec::new();
        let mut is_valid = cyclic.is_usable();
        for place in &ar.output.objects {
            let submodule = self.setup.layout.find(place.slot, place.subslot);
            let length = submodule.map_or(0, |submodule| usize::from(submodule.length(Direction::Output)));
            let at = usize::from(place.offset);
            is_valid &= is_good(at + length);
            image.extend_from_slice(cyclic.data.get(at..at + length).unwrap_or_default());
        }
        // The simulated device also checks the consumer statuses, because some devices reject the data of a controller
        // if these are bad.
        is_valid &= ar.output.consumers.iter().all(|place| is_good(usize::from(place.offset)));
        self.application.image_out(now, is_valid.then_some(&image[..]));
    }

    pub(super) fn handle_alarm(&mut self, now: Now, priority: Priority, payload: &[u8]) {
        let Some(ar) = &mut self.ar else { return };
        match ar.alarms.handle(now, priority, payload) {
            AlarmEvent::Nothing => {}
            AlarmEvent::Noted(out, alarm) => {
                for payload in out {
                    self.send_alarm(priority, &payload);
                }
                self.application.event(now, &Event::AlarmNoted(alarm));
            }
            AlarmEvent::Again(payload) => self.send_alarm(priority, &payload),
            AlarmEvent::Ended(status) => self.drop_ar(now, Some(Status(status))),
            AlarmEvent::Wrong => self.abort(now, WRONG_FRAME),
        }
    }

    /// Calls ApplicationReady, or repeats the call with the same bytes.
    pub(super) fn call_ready(&mut self, now: Now) {
        let Some(ar) = &mut self.ar else { return };
        let ArState::Ready { due, tries, sequence } = &mut ar.ar_state else { return };
        *tries = tries.saturating_sub(1);
        *due = now + READY_TIMEOUT;
        let header = Header {
            kind: Kind::REQUEST,
            flags: rpc::flag::IDEMPOTENT,
            order: ByteOrder::Big,
            object: ar.object,
            interface: rpc::CONTROLLER,
            activity: ar.activity,
            boot: 0,
            sequence: *sequence,
            operation: operation::CONTROL,
            fragment: 0,
        };
        let mut blocks = Control::call(BlockType::APPLICATION_READY, ar.uuid, ar.session_key).emit();
        let to = SocketAddrV4::new(*ar.peer.ip(), PORT);
        blocks.extend(self.difference().iter().flat_map(super::super::wire::connect::Response::emit));
        let body = Call { room: 0x53C, blocks: &blocks }.emit(ByteOrder::Big);
        self.actions.push_back(Action::Datagram(to, Datagram { header, body: &body }.emit()));
    }

    /// Becomes ready, and calls ApplicationReady.
    pub(super) fn get_ready(&mut self, now: Now) {
        if self.fault == Some(Fault::NeverReady) {
            // Because of the fault, the device never calls ApplicationReady, and its activity timeout is off.
            if let Some(ar) = &mut self.ar {
                ar.ar_state = ArState::Parameters(Now::MAX);
            }
            return;
        }
        if let Some(ar) = &mut self.ar {
            ar.ar_state = ArState::Ready { due: now, tries: READY_TRIES, sequence: 0 };
        }
        self.call_ready(now);
    }

    /// Handles the answer to ApplicationReady.
    pub(super) fn ready_answered(&mut self, now: Now, datagram: &Datagram<'_>) {
        let Some(ar) = &mut self.ar else { return };
        let header = &datagram.header;
        let ArState::Ready { sequence, .. } = ar.ar_state else { return };
        if (header.activity, header.sequence) != (ar.activity, sequence) {
            return;
        }
        let Ok(reply) = rpc::Reply::parse(datagram.body, header.order) else { return };
        let Ok(blocks) = block::walk(reply.blocks) else { return };
        let control = blocks.first().map(Control::parse);
        let done = Control::call(BlockType::APPLICATION_READY, ar.uuid, ar.session_key).answer();
        if reply.status == 0 && control == Some(Ok(done)) {
            ar.ar_state = ArState::Running;
            ar.last_error = Some(now + FAULT_DELAY);
            self.application.event(now, &Event::Ready);
        }
    }
}

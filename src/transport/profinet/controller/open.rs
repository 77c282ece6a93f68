//! Opening of a connection: Connect, parameters, PrmEnd, ApplicationReady. This module also contains the release of a
//! connection.

use super::super::Now;
use super::super::error::ProfinetError;
use super::super::layout::Direction;
use super::super::settings::{SEND_CLOCK, Startup};
use super::super::wire::Uuid;
use super::super::wire::block::{BlockType, Control};
use super::super::wire::connect::{ADVANCED, ANY_FRAME_ID, AlarmCr, Ar as ArBlock, Iocr, LEGACY, Offset, Request};
use super::super::wire::frame::{ETHER_TYPE, TAG_HIGH, id};
use super::super::wire::record;
use super::super::wire::rpc::{self, operation};
use super::super::wire::{Mac, connect::ExpectedModule};
use super::client::Client;
use super::view::{State, Step};
use super::{Ar, Controller, Phase, START};

/// Time for which the device waits for the next step of the controller, in units of 100 ms.
const ACTIVITY_TIMEOUT: u16 = 200;
/// Number of attempts of every call except Connect.
pub(super) const TRIES: u32 = 3;

impl Controller {
    /// Calls Connect. The call is sent only once, because some devices start again if they receive a second copy.
    pub(super) fn connect(&mut self, now: Now, instance: u16) {
        let Some(device) = &self.device else { return };
        let (vendor, kind) = device.id;
        let client = Client::new(rpc::object(instance, kind, vendor), self.identifiers.uuid());
        let frame_id = self.identifiers.frame_id();
        let input_id = match self.settings.startup {
            Startup::Advanced => frame_id,
            Startup::Legacy => frame_id - id::RT_CLASS_1.start() + id::RT_CLASS_1_LEGACY.start(),
        };
        self.ar = Some(Ar {
            uuid: self.identifiers.uuid(),
            session_key: self.identifiers.session_key(),
            reference: self.identifiers.reference(),
            input_id,
            client,
            step: Step::Connect,
            ready_until: now,
            is_ready: false,
            io: None,
        });
        self.phase = Phase::Opening;
        self.set_step(Step::Connect);
        let blocks: Vec<u8> = self.requests().iter().flat_map(Request::emit).collect();
        self.call(now, operation::CONNECT, &blocks, 1);
    }

    fn requests(&self) -> Vec<Request> {
        let Some(ar) = &self.ar else { return Vec::new() };
        let (properties, class) = match self.settings.startup {
            Startup::Advanced => (ADVANCED, 2),
            Startup::Legacy => (LEGACY, 1),
        };
        let layout = &self.settings.layout;
        let iocr = |kind: u16, direction, frame_id| {
            let frame = layout.frame(direction);
            let objects: Vec<Offset> = frame.objects.iter().map(|(place, _)| *place).collect();
            Request::Iocr(Iocr {
                kind,
                reference: kind,
                ether_type: ETHER_TYPE,
                properties: class,
                length: frame.length,
                frame_id,
                send_clock: SEND_CLOCK,
                ratio: self.settings.ratio().unwrap_or(1),
                phase: 1,
                sequence: 0,
                offset: u32::MAX,
                watchdog: self.settings.watchdog_factor(),
                data_hold_factor: self.settings.watchdog_factor(),
                tag: TAG_HIGH,
                group: Mac::default(),
                objects,
                consumers: frame.consumers,
            })
        };
        let mut requests = vec![
            Request::Ar(ArBlock {
                kind: 1,
                uuid: ar.uuid,
                session_key: ar.session_key,
                mac: self.local_address.mac,
                object: rpc::object(1, 1, u16::MAX),
                properties,
                activity_timeout: ACTIVITY_TIMEOUT,
                port: ETHER_TYPE,
                name: self.settings.name.clone(),
            }),
            iocr(1, Direction::Input, ar.input_id),
            iocr(2, Direction::Output, ANY_FRAME_ID),
            Request::AlarmCr(AlarmCr::with_defaults(ar.reference)),
        ];
        let expected = layout.expected().into_iter();
        requests.extend(expected.map(|module: ExpectedModule| Request::Expected(vec![module])));
        requests
    }

    pub(super) fn call(&mut self, now: Now, operation: u16, blocks: &[u8], tries: u32) {
        let Some(ar) = &mut self.ar else { return };
        let bytes = ar.client.call(now, operation, blocks, tries);
        self.send(bytes);
    }

    /// Writes the parameter records, if there are any.
    pub(super) fn write_parameters(&mut self, now: Now) {
        if self.settings.parameters.is_empty() {
            return self.end_parameters(now);
        }
        self.set_step(Step::Parameters);
        let blocks = record::write(self.uuid(), 0, &self.settings.parameters);
        self.call(now, operation::WRITE, &blocks, TRIES);
    }

    /// Calls PrmEnd. After its answer, the device must call ApplicationReady.
    pub(super) fn end_parameters(&mut self, now: Now) {
        self.set_step(Step::PrmEnd);
        self.control(now, BlockType::PRM_END, operation::CONTROL);
    }

    fn control(&mut self, now: Now, kind: BlockType, operation: u16) {
        let Some(ar) = &self.ar else { return };
        let block = Control::call(kind, ar.uuid, ar.session_key);
        self.call(now, operation, &block.emit(), TRIES);
    }

    /// Continues after the answer to PrmEnd: waits for ApplicationReady, unless ApplicationReady has already arrived.
    pub(super) fn await_ready(&mut self, now: Now) {
        self.set_step(Step::Ready);
        if let Some(ar) = &mut self.ar {
            ar.ready_until = now + START;
            if ar.is_ready {
                self.await_data(now);
            }
        }
    }

    /// Continues after ApplicationReady: waits for the data of the device.
    pub(super) fn await_data(&mut self, now: Now) {
        self.set_step(Step::Data);
        self.phase = Phase::WaitingForData(now + START);
        // Frames that arrived before ApplicationReady do not count for the watchdog.
        if let Some(io) = self.ar.as_mut().and_then(|ar| ar.io.as_mut()) {
            io.consumer.last_frame_at = io.consumer.last_frame_at.map(|_| now);
        }
    }

    /// Releases the connection. `trouble` is the error that caused the release; `None` if the caller closes the
    /// connection. The image stays until the end: the resting image would switch an emergency-stop input on.
    pub(super) fn release(&mut self, now: Now, last_error: Option<ProfinetError>) {
        let tries = match last_error {
            // The device probably does not answer, so one attempt is enough.
            Some(ProfinetError::NoAnswer { .. }) => 1,
            _ => TRIES,
        };
        if self.view.state == State::Open {
            self.before.losses += u64::from(last_error.is_some());
        }
        if let Some(last_error) = &last_error {
            self.view.last_error = Some(last_error.clone());
        }
        let state = match (self.is_over, self.view.generation) {
            (true, _) => State::Closing,
            (false, 0) => State::Opening,
            (false, _) => State::Lost,
        };
        self.phase = Phase::Releasing(last_error);
        self.show(state);
        let Some(ar) = &self.ar else { return };
        let block = Control::call(BlockType::RELEASE, ar.uuid, ar.session_key);
        self.call(now, operation::RELEASE, &block.emit(), tries);
    }

    /// Handles the end of the release.
    pub(super) fn released(&mut self, now: Now, last_error: Option<ProfinetError>) {
        self.drop_ar();
        match last_error {
            _ if self.is_over => self.finish(last_error),
            Some(last_error) => self.handle_loss(now, last_error),
            None => self.finish(None),
        }
    }

    pub(super) fn uuid(&self) -> Uuid {
        self.ar.as_ref().map_or(Uuid::NIL, |ar| ar.uuid)
    }
}

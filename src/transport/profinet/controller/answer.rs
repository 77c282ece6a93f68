//! Handling of the answers to the calls of the controller, and of the calls of the device.

use std::net::SocketAddrV4;

use super::super::Now;
use super::super::error::{ModuleMismatch, ProfinetError};
use super::super::settings::Startup;
use super::super::wire::block::{self, BlockType, Control};
use super::super::wire::connect::{ModuleDiff, Response};
use super::super::wire::frame::id;
use super::super::wire::record;
use super::super::wire::rpc::{self, Call, Datagram, Reply, operation};
use super::super::wire::status::Status;
use super::alarms::Alarms;
use super::client::Outcome;
use super::cyclic::{Consumer, Producer};
use super::view::Step;
use super::{Action, Controller, Io, Phase};
use crate::refuse_if;

const CONNECT: &str = "Connect";
const WRITE: &str = "Write";
const PRM_END: &str = "PrmEnd";
const RELEASE: &str = "Release";

impl Controller {
    /// Handles the outcome of a call.
    pub(super) fn answered(&mut self, now: Now, outcome: Outcome) {
        if let Phase::Releasing(last_error) = &self.phase {
            let last_error = last_error.clone();
            let failed = match outcome.blocks(RELEASE) {
                // The device has already closed the connection, so nothing is left to release.
                Err(ProfinetError::Refused { status, .. }) if status.is_unknown_ar() => None,
                other => other.err(),
            };
            return self.released(now, last_error.or(failed));
        }
        let Some(step) = self.ar.as_ref().map(|ar| ar.step) else { return };
        let done = match step {
            Step::Connect => self.connected(now, outcome),
            Step::Parameters => self.written(now, outcome),
            Step::PrmEnd => self.parameters_ended(now, outcome),
            Step::Resolve | Step::Address | Step::Ready | Step::Data => Ok(()),
        };
        match done {
            Ok(()) => {}
            // If Connect fails, the device has no connection that must be released.
            Err(last_error @ (ProfinetError::Refused { .. } | ProfinetError::Rejected { .. }))
                if step == Step::Connect =>
            {
                self.handle_loss(now, last_error);
            }
            Err(last_error) => self.release(now, Some(last_error)),
        }
    }

    fn connected(&mut self, now: Now, outcome: Outcome) -> Result<(), ProfinetError> {
        let blocks = outcome.blocks(CONNECT)?;
        let responses =
            Response::parse_all(&blocks).map_err(|error| ProfinetError::Malformed { what: CONNECT, error })?;
        let senseless = |why| ProfinetError::Senseless { what: CONNECT, why };
        let mac = self.device.as_ref().map(|device| device.mac).unwrap_or_default();
        let Some(ar) = &mut self.ar else { return Ok(()) };
        let (mut has_ar, mut input, mut output, mut alarm) = (false, None, None, None);
        for response in &responses {
            match response {
                Response::Ar { uuid, session_key, mac: card } => {
                    if *uuid != ar.uuid || *session_key != ar.session_key {
                        return Err(senseless("it belongs to another connection"));
                    }
                    refuse_if(*card != mac, senseless("the answer is from another network card"))?;
                    has_ar = true;
                }
                Response::Iocr { kind: 1, frame_id, .. } => input = Some(*frame_id),
                Response::Iocr { kind: 2, frame_id, .. } => output = Some(*frame_id),
                Response::AlarmCr { reference, .. } => alarm = Some(*reference),
                Response::ModuleDiff(modules) => {
                    let mismatches = self.settings.layout.mismatches(modules);
                    refuse_if(!mismatches.is_empty(), ProfinetError::Modules(mismatches))?;
                }
                _ => {}
            }
        }
        refuse_if(!has_ar, senseless("it does not contain the connection"))?;
        let (Some(input), Some(output)) = (input, output) else {
            return Err(senseless("it does not contain the cyclic data of both directions"));
        };
        let range = match self.settings.startup {
            Startup::Advanced => id::RT_CLASS_1,
            Startup::Legacy => id::RT_CLASS_1_LEGACY,
        };
        if !range.contains(&input) || !range.contains(&output) {
            return Err(senseless("the FrameIDs do not match the requested class"));
        }
        let alarm = alarm.ok_or_else(|| senseless("it does not contain the alarm channel"))?;
        ar.input_id = input;
        ar.io = Some(Io {
            output_id: output,
            producer: Producer::new(&self.settings, now),
            consumer: Consumer::new(&self.settings),
            alarms: Alarms::new(ar.reference, alarm),
        });
        // The first cyclic frame is sent before the parameters, because some devices wait only a short time for it.
        self.produce(now);
        self.write_parameters(now);
        Ok(())
    }

    fn written(&mut self, now: Now, outcome: Outcome) -> Result<(), ProfinetError> {
        let blocks = outcome.blocks(WRITE)?;
        let statuses =
            record::parse_write_answer(&blocks).map_err(|error| ProfinetError::Malformed { what: WRITE, error })?;
        if let Some((_, status)) = statuses.iter().find(|(_, status)| *status != 0) {
            return Err(ProfinetError::Refused { what: WRITE, status: Status(*status) });
        }
        self.end_parameters(now);
        Ok(())
    }

    fn parameters_ended(&mut self, now: Now, outcome: Outcome) -> Result<(), ProfinetError> {
        let blocks = outcome.blocks(PRM_END)?;
        let malformed = |error| ProfinetError::Malformed { what: PRM_END, error };
        let blocks = block::walk(&blocks).map_err(malformed)?;
        let senseless = |why| ProfinetError::Senseless { what: PRM_END, why };
        let found = blocks.iter().find(|block| block.kind == BlockType::PRM_END.answer());
        let control = Control::parse(found.ok_or_else(|| senseless("the block is missing"))?).map_err(malformed)?;
        refuse_if(control.ar != self.uuid(), senseless("it belongs to another connection"))?;
        refuse_if(control.command != Control::DONE, senseless("the device did not confirm it"))?;
        self.await_ready(now);
        Ok(())
    }

    /// Handles a call of the device. The only valid call is ApplicationReady.
    pub(super) fn called(&mut self, now: Now, from: SocketAddrV4, datagram: &Datagram<'_>) {
        let header = &datagram.header;
        if header.interface != rpc::CONTROLLER || header.operation != operation::CONTROL {
            return;
        }
        let Ok(call) = Call::parse(datagram.body, header.order) else { return };
        let Ok(blocks) = block::walk(call.blocks) else { return };
        let Some(Ok(control)) = blocks.first().map(Control::parse) else { return };
        let Some(ar) = &mut self.ar else { return };
        // ApplicationReady is valid only after Connect.
        let is_ready = matches!(control.kind, BlockType::APPLICATION_READY | BlockType::PLUG_APPLICATION_READY);
        let fits = control.ar == ar.uuid && control.session_key == ar.session_key;
        if !is_ready || !fits || ar.io.is_none() {
            return;
        }
        let answer = control.answer().emit();
        let body = Reply { status: 0, room: call.room, blocks: &answer }.emit(header.order);
        let bytes = Datagram { header: header.answer(), body: &body }.emit();
        self.actions.push_back(Action::Datagram(from, bytes));
        if std::mem::replace(&mut ar.is_ready, true) || !matches!(self.phase, Phase::Opening) {
            return;
        }
        let modules = blocks.iter().filter_map(|block| match Response::parse(block) {
            Ok(Response::ModuleDiff(modules)) => Some(modules),
            _ => None,
        });
        let mismatches: Vec<ModuleMismatch> =
            modules.flat_map(|modules: Vec<ModuleDiff>| self.settings.layout.mismatches(&modules)).collect();
        if !mismatches.is_empty() {
            return self.release(now, Some(ProfinetError::Modules(mismatches)));
        }
        // If ApplicationReady arrives before the answer to PrmEnd, the controller waits for this answer first.
        if self.ar.as_ref().is_some_and(|ar| ar.step == Step::Ready) {
            self.await_data(now);
        }
    }
}

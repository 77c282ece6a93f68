//! RPC calls that the simulated device answers: Connect, parameters, control, release, records.

use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

use super::super::Now;
use super::super::wire::block::{self, BlockType, Control};
use super::super::wire::connect::{ANY_FRAME_ID, ModuleDiff, Request, Response, SubmoduleDiff};
use super::super::wire::frame::id;
use super::super::wire::record::{self, RealModule, Record, index};
use super::super::wire::rpc::{self, Call, Datagram, Header, Reply, operation};
use super::super::wire::status::Status;
use super::super::wire::{ByteOrder, Uuid};
use super::alarms::Alarms;
use super::ar::{Ar, ArState};
use super::{Action, Application, Device, Event, Fault, MAX_ANSWERS, checks};
use crate::refuse_if;

/// Alarm reference of the device.
const ALARM_REFERENCE: u16 = 0;
/// Ident number of the module that the device has with [`Fault::WrongModule`].
pub(super) const WRONG_MODULE: u32 = 0x40;
/// Address from which the device answers with [`Fault::Foreign`].
const FOREIGN_ADDRESS: Ipv4Addr = Ipv4Addr::new(192, 0, 2, 1);

const CONNECT: u8 = 0xDB;
const RELEASE: u8 = 0xDC;
const CONTROL: u8 = 0xDD;
const READ: u8 = 0xDE;
const WRITE: u8 = 0xDF;
const CMRPC: u8 = 0x40;

/// Blocks of an answer, or the error status.
type Answer = Result<Vec<u8>, Status>;

impl<A: Application> Device<A> {
    pub(super) fn called(&mut self, now: Now, from: SocketAddrV4, datagram: &Datagram<'_>) {
        let header = datagram.header;
        let (vendor, kind) = (self.setup.id.0, self.setup.id.1);
        let is_here = self.setup.ip.is_some()
            && header.interface == rpc::DEVICE
            && header.object == rpc::object(self.setup.instance, kind, vendor);
        if !is_here || self.fault == Some(Fault::Mute) {
            return;
        }
        let is_same = |other: &Header| (other.activity, other.sequence) == (header.activity, header.sequence);
        if let Some((_, _, bytes)) = self.answers.iter().find(|(other, peer, _)| is_same(other) && *peer == from) {
            let bytes = bytes.clone();
            // Like some devices, the simulated device aborts the connection after a duplicate Connect.
            if header.operation == operation::CONNECT {
                self.answers.clear();
                return self.abort(now, 0x0E);
            }
            self.actions.push_back(Action::Datagram(from, bytes));
            return;
        }
        let Ok(call) = Call::parse(datagram.body, header.order) else { return };
        let answer = match header.operation {
            operation::CONNECT => self.connect(now, from, call.blocks),
            operation::RELEASE => self.control(now, call.blocks, RELEASE),
            operation::CONTROL => self.control(now, call.blocks, CONTROL),
            operation::READ => self.read(call.blocks, true),
            operation::READ_IMPLICIT => self.read(call.blocks, false),
            operation::WRITE => self.write(now, call.blocks),
            _ => return,
        };
        if let Err(status) = &answer {
            self.application.event(now, &Event::Refused(*status));
        }
        let (status, blocks) = match &answer {
            Ok(blocks) => (0, &blocks[..]),
            Err(status) => (status.0, &[][..]),
        };
        // The device answers in its own byte order, which can differ from the byte order of the call.
        let mut body = Reply { status, room: call.room, blocks }.emit(ByteOrder::Big);
        if self.fault == Some(Fault::Garbage) {
            for byte in &mut body {
                *byte = !*byte;
            }
        }
        let header = Header { order: ByteOrder::Big, ..header.answer() };
        let bytes = Datagram { header, body: &body }.emit();
        if self.answers.len() == MAX_ANSWERS {
            self.answers.pop_front();
        }
        self.answers.push_back((header, from, bytes.clone()));
        self.actions.push_back(Action::Datagram(from, bytes));
        let is_prm_end = header.operation == operation::CONTROL && answer.is_ok();
        if is_prm_end && self.ar.as_ref().is_some_and(|ar| matches!(ar.ar_state, ArState::Parameters(_))) {
            self.get_ready(now);
        }
    }

    /// Address from which the device answers; `None` if it is the address of the device.
    pub fn answers_from(&self) -> Option<Ipv4Addr> {
        (self.fault == Some(Fault::Foreign)).then_some(FOREIGN_ADDRESS)
    }

    fn connect(&mut self, now: Now, from: SocketAddrV4, blocks: &[u8]) -> Answer {
        let status = |code1, code2| Status::new(CONNECT, 0x81, code1, code2);
        refuse_if(self.ar.is_some() || self.fault == Some(Fault::Owned), status(CMRPC, 4))?;
        let requests = Request::parse_all(blocks).map_err(|_| status(CMRPC, 0))?;
        let mut accepted = checks::connect(requests, &self.setup.layout, self.setup.shortest)?;
        if accepted.output.frame_id == ANY_FRAME_ID {
            let is_legacy = accepted.input.properties == 1;
            let range = if is_legacy { id::RT_CLASS_1_LEGACY } else { id::RT_CLASS_1 };
            let next = accepted.input.frame_id + 1;
            accepted.output.frame_id = if range.contains(&next) { next } else { *range.start() };
        }
        let ar = accepted.ar;
        let mut responses = vec![
            Response::Ar { uuid: ar.uuid, session_key: ar.session_key, mac: self.setup.mac },
            Response::Iocr { kind: 1, reference: accepted.input.reference, frame_id: accepted.input.frame_id },
            Response::Iocr { kind: 2, reference: accepted.output.reference, frame_id: accepted.output.frame_id },
            Response::AlarmCr { reference: ALARM_REFERENCE, max_len: 200 },
        ];
        responses.extend(self.difference());
        if ar.properties & 0x4000_0000 != 0 {
            responses.push(Response::Name(self.setup.name.clone()));
        }
        let timeout = Duration::from_millis(100) * u32::from(accepted.alarm.timeout);
        let activity_timeout = Duration::from_millis(100) * u32::from(ar.activity_timeout);
        self.ar = Some(Ar {
            uuid: ar.uuid,
            session_key: ar.session_key,
            mac: ar.mac,
            peer: from,
            object: ar.object,
            activity: Uuid::random(),
            input: accepted.input,
            output: accepted.output,
            alarms: Alarms::new(ALARM_REFERENCE, accepted.alarm.reference, timeout, accepted.alarm.retries),
            ar_state: ArState::Parameters(now + activity_timeout),
            activity_timeout,
            due: now,
            counter: 0,
            last_error: None,
            heard: None,
        });
        self.application.event(now, &Event::Connected(*from.ip()));
        Ok(responses.iter().flat_map(Response::emit).collect())
    }

    /// Returns the difference between the expected modules and the real modules.
    pub(super) fn difference(&self) -> Option<Response> {
        if self.fault != Some(Fault::WrongModule) {
            return None;
        }
        let submodules = vec![SubmoduleDiff { subslot: 1, ident: 1, state: 0x9000 }];
        Some(Response::ModuleDiff(vec![ModuleDiff { slot: 1, ident: WRONG_MODULE, state: 1, submodules }]))
    }

    fn control(&mut self, now: Now, blocks: &[u8], code: u8) -> Answer {
        let status = |code1, code2| Status::new(code, 0x81, code1, code2);
        let blocks = block::walk(blocks).map_err(|_| status(CMRPC, 0))?;
        let [block] = &blocks[..] else { return Err(status(CMRPC, 1)) };
        let control = Control::parse(block).map_err(|_| status(CMRPC, 0))?;
        let Some(ar) = self.ar.as_mut().filter(|ar| ar.uuid == control.ar) else { return Err(status(CMRPC, 5)) };
        refuse_if(control.session_key != ar.session_key, status(0x14, 5))?;
        refuse_if(control != Control::call(control.kind, ar.uuid, ar.session_key), status(0x14, 8))?;
        match (code, control.kind) {
            (RELEASE, BlockType::RELEASE) => self.drop_ar(now, None),
            (CONTROL, BlockType::PRM_END) if matches!(ar.ar_state, ArState::Parameters(_)) => {}
            (CONTROL, BlockType::PRM_END) => return Err(status(0x3D, 0)),
            _ => return Err(status(0x14, 0)),
        }
        Ok(control.answer().emit())
    }

    fn read(&mut self, blocks: &[u8], is_in_ar: bool) -> Answer {
        let status = |code1| Status::new(READ, 0x80, code1, 0);
        let (asked, _) = Record::parse(blocks, BlockType::READ).map_err(|_| Status::new(READ, 0x81, CMRPC, 0))?;
        let owner = self.ar.as_ref().map(|ar| ar.uuid);
        if is_in_ar && owner != Some(asked.ar) || !is_in_ar && asked.ar != Uuid::NIL {
            return Err(Status::new(READ, 0x81, CMRPC, 5));
        }
        let record = match asked.index {
            _ if self.setup.layout.find(asked.slot, asked.subslot).is_none() => return Err(status(0xB2)),
            index::IM0 if (asked.slot, asked.subslot) == (0, 1) => self.setup.im0.emit(),
            index::REAL_IDENTIFICATION => record::emit_identification(&self.real_modules()),
            _ => return Err(status(0xB0)),
        };
        let length = u32::try_from(record.len()).unwrap_or(u32::MAX);
        refuse_if(length > asked.length, status(0xB1))?;
        Ok(Record { length, ..asked }.emit(BlockType::READ.answer(), 0, &record))
    }

    fn real_modules(&self) -> Vec<RealModule> {
        let is_wrong = self.fault == Some(Fault::WrongModule);
        let module = |module: super::super::wire::connect::ExpectedModule| RealModule {
            slot: module.slot,
            ident: if is_wrong && module.slot == 1 { WRONG_MODULE } else { module.ident },
            submodules: module.submodules.iter().map(|submodule| (submodule.subslot, submodule.ident)).collect(),
        };
        self.setup.layout.expected().into_iter().map(module).collect()
    }

    fn write(&mut self, now: Now, blocks: &[u8]) -> Answer {
        let status = |code1, code2| Status::new(WRITE, 0x81, code1, code2);
        let (outer, parameters) = record::parse_write(blocks).map_err(|_| status(CMRPC, 0))?;
        let Some(ar) = self.ar.as_mut().filter(|ar| ar.uuid == outer.ar) else { return Err(status(CMRPC, 5)) };
        if let ArState::Parameters(until) = &mut ar.ar_state {
            *until = now + ar.activity_timeout;
        }
        refuse_if(parameters.is_empty(), Status::new(WRITE, 0x80, 0xB1, 0))?;
        let mut statuses = Vec::new();
        for (at, parameter) in (1u16..).zip(parameters) {
            let has = self.setup.layout.find(parameter.slot, parameter.subslot).is_some();
            let status = if has { 0 } else { Status::new(WRITE, 0x80, 0xB2, 0).0 };
            let record = Record {
                sequence: outer.sequence.wrapping_add(at),
                api: 0,
                slot: parameter.slot,
                subslot: parameter.subslot,
                index: parameter.index,
                length: 0,
                ..outer
            };
            statuses.push((record, status));
            if has {
                self.application.event(now, &Event::Written(parameter));
            }
        }
        Ok(record::write_answer(&outer, &statuses))
    }
}

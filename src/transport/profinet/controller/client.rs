//! RPC client for one device. It makes one call at a time, repeats calls where a repetition is harmless, and
//! reassembles answers.

use std::collections::BTreeMap;
use std::time::Duration;

use super::super::Now;
use super::super::error::ProfinetError;
use super::super::wire::rpc::{self, Call, Datagram, Header, Kind, Reply, flag};
use super::super::wire::status::Status;
use super::super::wire::{ByteOrder, Uuid, WireError};

/// Time limit for an answer.
pub const CALL_TIMEOUT: Duration = Duration::from_secs(2);
/// Maximum number of "working" messages that a device may send during a call.
const MAX_WORKING_MESSAGES: u32 = 5;

/// Outcome of a call.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Outcome {
    /// Status and blocks of the answer.
    Answer(u32, Vec<u8>),
    /// The RPC server rejected the call.
    Rejected(u32),
    /// The answer cannot be decoded.
    Malformed(WireError),
    /// There was no answer within this time.
    Silent(Duration),
}

impl Outcome {
    /// Returns the blocks of a positive answer.
    ///
    /// # Errors
    /// Any other outcome is returned as an error.
    pub fn blocks(self, what: &'static str) -> Result<Vec<u8>, ProfinetError> {
        match self {
            Self::Answer(0, blocks) => Ok(blocks),
            Self::Answer(status, _) => Err(ProfinetError::Refused { what, status: Status(status) }),
            Self::Rejected(status) => Err(ProfinetError::Rejected { what, status }),
            Self::Malformed(error) => Err(ProfinetError::Malformed { what, error }),
            Self::Silent(after) => Err(ProfinetError::NoAnswer { what, after }),
        }
    }
}

/// An action that the driver must execute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Step {
    /// Send these bytes to the device.
    Send(Vec<u8>),
    /// The call is complete.
    Done(Outcome),
}

/// An RPC client.
#[derive(Debug)]
pub struct Client {
    object: Uuid,
    activity: Uuid,
    sequence: u32,
    pending: Option<Pending>,
}

#[derive(Debug)]
struct Pending {
    bytes: Vec<u8>,
    deadline: Now,
    begin: Now,
    tries: u32,
    working: u32,
    fragments: BTreeMap<u16, Vec<u8>>,
    last: Option<u16>,
}

impl Client {
    /// Creates a client for the device with the object UUID `object`. `activity` is the activity UUID of the client.
    pub fn new(object: Uuid, activity: Uuid) -> Self {
        Self { object, activity, sequence: 0, pending: None }
    }

    /// Starts a call and drops an earlier call. The same bytes are sent at most `tries` times.
    pub fn call(&mut self, now: Now, operation: u16, blocks: &[u8], tries: u32) -> Vec<u8> {
        let body = Call { room: rpc::ANSWER_BUFFER_SIZE, blocks }.emit(ByteOrder::Big);
        let header = Header {
            kind: Kind::REQUEST,
            flags: flag::IDEMPOTENT,
            order: ByteOrder::Big,
            object: self.object,
            interface: rpc::DEVICE,
            activity: self.activity,
            boot: 0,
            sequence: self.sequence,
            operation,
            fragment: 0,
        };
        self.sequence = self.sequence.wrapping_add(1);
        let bytes = Datagram { header, body: &body }.emit();
        self.pending = Some(Pending {
            bytes: bytes.clone(),
            deadline: now + CALL_TIMEOUT,
            begin: now,
            tries: tries.saturating_sub(1),
            working: 0,
            fragments: BTreeMap::new(),
            last: None,
        });
        bytes
    }

    /// Whether a call waits for its answer.
    pub const fn is_busy(&self) -> bool {
        self.pending.is_some()
    }

    /// Time of the next [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        self.pending.as_ref().map(|pending| pending.deadline)
    }

    /// Returns the action that is due: a repetition, or the failure of the call.
    pub fn poll(&mut self, now: Now) -> Option<Step> {
        let pending = self.pending.as_mut().filter(|pending| pending.deadline <= now)?;
        if pending.tries == 0 {
            let waited = now.saturating_sub(pending.begin);
            self.pending = None;
            return Some(Step::Done(Outcome::Silent(waited)));
        }
        pending.tries -= 1;
        pending.deadline = now + CALL_TIMEOUT;
        Some(Step::Send(pending.bytes.clone()))
    }

    /// Handles a datagram of the device that is not a call. The client accepts only the answer to the pending call.
    pub fn handle(&mut self, now: Now, datagram: &Datagram<'_>) -> Option<Step> {
        let header = &datagram.header;
        let is_awaited = header.activity == self.activity && header.sequence == self.sequence.wrapping_sub(1);
        let pending = self.pending.as_mut().filter(|_| is_awaited)?;
        let step = match header.kind {
            Kind::RESPONSE if header.is_fragment() => pending.collect(now, datagram),
            Kind::RESPONSE => Some(self.answered(datagram.body, header.order)),
            Kind::FAULT | Kind::REJECT => {
                let bytes = datagram.body.first_chunk::<4>().copied().unwrap_or_default();
                let status =
                    if header.order == ByteOrder::Big { u32::from_be_bytes(bytes) } else { u32::from_le_bytes(bytes) };
                self.pending = None;
                Some(Step::Done(Outcome::Rejected(status)))
            }
            Kind::WORKING if pending.working < MAX_WORKING_MESSAGES => {
                pending.working += 1;
                pending.deadline = now + CALL_TIMEOUT;
                None
            }
            _ => None,
        };
        step.or_else(|| self.take_answer())
    }

    /// Returns the answer if all fragments have arrived.
    fn take_answer(&mut self) -> Option<Step> {
        let pending = self.pending.as_ref()?;
        let last = pending.last?;
        if pending.fragments.len() <= usize::from(last) {
            return None;
        }
        let (order, body) = pending.fragments.values().fold((ByteOrder::Big, Vec::new()), |(_, mut all), fragment| {
            all.extend_from_slice(fragment.get(1..).unwrap_or_default());
            (if fragment.first() == Some(&1) { ByteOrder::Little } else { ByteOrder::Big }, all)
        });
        Some(self.answered(&body, order))
    }

    fn answered(&mut self, body: &[u8], order: ByteOrder) -> Step {
        self.pending = None;
        Step::Done(match Reply::parse(body, order) {
            Ok(reply) => Outcome::Answer(reply.status, reply.blocks.to_vec()),
            Err(error) => Outcome::Malformed(error),
        })
    }
}

impl Pending {
    /// Stores a fragment. Acknowledges it if the device requires an acknowledgement.
    fn collect(&mut self, now: Now, datagram: &Datagram<'_>) -> Option<Step> {
        let header = &datagram.header;
        let there: usize = self.fragments.values().map(Vec::len).sum();
        if there + datagram.body.len() > rpc::MAX_ANSWER_LEN {
            return None;
        }
        // The first byte of the stored fragment is the byte order. It is the same in all fragments of an answer.
        let mut bytes = vec![u8::from(header.order == ByteOrder::Little)];
        bytes.extend_from_slice(datagram.body);
        self.fragments.insert(header.fragment, bytes);
        if header.flags & flag::LAST_FRAGMENT != 0 {
            self.last = Some(header.fragment);
        }
        self.deadline = now + CALL_TIMEOUT;
        let is_whole = self.last.is_some_and(|last| self.fragments.len() > usize::from(last));
        if header.flags & flag::NO_ACK != 0 || is_whole {
            return None;
        }
        let ack = Header { kind: Kind::FRAGMENT_ACK, flags: 0, ..*header };
        Some(Step::Send(Datagram { header: ack, body: &[] }.emit()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::rpc::operation;
    use super::*;

    fn client() -> Client {
        Client::new(rpc::object(1, 1, 1), Uuid([7; 16]))
    }

    fn answer(call: &[u8], flags: u8, fragment: u16, body: &[u8]) -> Vec<u8> {
        let header = Datagram::parse(call).unwrap().header.answer();
        Datagram { header: Header { flags, fragment, ..header }, body }.emit()
    }

    #[test]
    fn repeats_a_call_up_to_a_limit() {
        let mut client = client();
        let first = client.call(Now::ZERO, operation::READ, &[1; 8], 3);
        assert_eq!(client.poll(CALL_TIMEOUT / 2), None);
        assert_eq!(client.poll(CALL_TIMEOUT), Some(Step::Send(first.clone())));
        assert_eq!(client.poll(CALL_TIMEOUT * 2), Some(Step::Send(first)));
        assert_eq!(client.poll(CALL_TIMEOUT * 3), Some(Step::Done(Outcome::Silent(CALL_TIMEOUT * 3))));
        assert_eq!((client.poll(CALL_TIMEOUT * 9), client.wake()), (None, None));
    }

    #[test]
    fn ignores_answers_to_other_calls() {
        let mut client = client();
        let body = Reply { status: 0, room: 8, blocks: &[9] }.emit(ByteOrder::Big);
        let old = client.call(Now::ZERO, operation::READ, &[], 1);
        let new = client.call(Now::ZERO, operation::READ, &[], 1);
        let late = answer(&old, 0, 0, &body);
        assert_eq!(client.handle(Now::ZERO, &Datagram::parse(&late).unwrap()), None);
        let mut foreign = Datagram::parse(&new).unwrap().header.answer();
        foreign.activity = Uuid([8; 16]);
        assert_eq!(client.handle(Now::ZERO, &Datagram { header: foreign, body: &body }), None);
        let own = answer(&new, 0, 0, &body);
        let done = Some(Step::Done(Outcome::Answer(0, vec![9])));
        assert_eq!(client.handle(Now::ZERO, &Datagram::parse(&own).unwrap()), done);
        assert_eq!(client.handle(Now::ZERO, &Datagram::parse(&own).unwrap()), None, "once");
    }

    #[test]
    fn assembles_fragments_in_any_order() {
        let mut client = client();
        let call = client.call(Now::ZERO, operation::READ, &[], 1);
        let body = Reply { status: 0, room: 4096, blocks: &(0..=255).collect::<Vec<u8>>() }.emit(ByteOrder::Big);
        let parts: Vec<_> = body.chunks(100).collect();
        let send = |at: usize| {
            let last = if at == parts.len() - 1 { flag::LAST_FRAGMENT } else { 0 };
            answer(&call, flag::FRAGMENT | last, u16::try_from(at).unwrap(), parts[at])
        };
        for at in [2, 0] {
            let bytes = send(at);
            let Some(Step::Send(ack)) = client.handle(Now::ZERO, &Datagram::parse(&bytes).unwrap()) else {
                panic!("fragment {at} is not acknowledged")
            };
            let ack = Datagram::parse(&ack).unwrap();
            assert_eq!((ack.header.kind, usize::from(ack.header.fragment)), (Kind::FRAGMENT_ACK, at));
        }
        let bytes = send(1);
        let done = client.handle(Now::ZERO, &Datagram::parse(&bytes).unwrap());
        assert_eq!(done, Some(Step::Done(Outcome::Answer(0, (0..=255).collect()))));
    }

    #[test]
    fn limits_the_length_of_fragmented_answers() {
        let mut client = client();
        let call = client.call(Now::ZERO, operation::READ, &[], 1);
        for at in 0..2000 {
            let bytes = answer(&call, flag::FRAGMENT | flag::NO_ACK, at, &[0; 1000]);
            assert_eq!(client.handle(Now::ZERO, &Datagram::parse(&bytes).unwrap()), None);
        }
        let kept: usize = client.pending.unwrap().fragments.values().map(Vec::len).sum();
        assert!(kept <= rpc::MAX_ANSWER_LEN, "{kept}");
    }

    #[test]
    fn waits_a_limited_time_for_a_working_device() {
        let mut client = client();
        let call = client.call(Now::ZERO, operation::CONNECT, &[], 1);
        let header = Header { kind: Kind::WORKING, ..Datagram::parse(&call).unwrap().header };
        let mut now = Now::ZERO;
        while client.poll(now).is_none() {
            client.handle(now, &Datagram { header, body: &[] });
            now += CALL_TIMEOUT / 2;
            assert!(now < Duration::from_secs(60));
        }
    }

    #[test]
    fn reports_a_rejected_call() {
        let mut client = client();
        let call = client.call(Now::ZERO, operation::CONNECT, &[], 1);
        let header = Header { kind: Kind::REJECT, ..Datagram::parse(&call).unwrap().header };
        let step = client.handle(Now::ZERO, &Datagram { header, body: &[0x1C, 1, 0, 3] });
        assert_eq!(step, Some(Step::Done(Outcome::Rejected(0x1C01_0003))));
    }
}

//! Explicit messaging client: one request at a time, with fragmentation, acknowledgement and one retry.

use std::collections::VecDeque;
use std::time::Duration;

use crate::devicenet::Now;
use crate::devicenet::can::{Frame, MAX_DATA};
use crate::devicenet::wire::{Answer, Format, Fragment, Header, Id, Kind, Mac, Request};

/// Number of message bytes per fragment, after the header and the fragment byte.
const FRAGMENT_DATA: usize = MAX_DATA - 2;
/// Maximum length of a reassembled answer in bytes.
const MAX_ANSWER_LEN: usize = 512;
/// Status in an acknowledgement that accepts the fragment.
const FRAGMENT_ACCEPTED: u8 = 0;
/// Number of attempts per request or fragment.
const TRIES: u8 = 2;

/// Outcome of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Outcome {
    /// The slave answered.
    Answer(Answer),
    Silent,
    /// The answer was invalid.
    Senseless(&'static str),
}

#[derive(Debug)]
pub(super) struct RequestSender {
    own_mac: Mac,
    slave: Mac,
    answer_timeout: Duration,
    xid: bool,
    current: Option<Transaction>,
    /// Count of the last fragment of the previous answer. If the acknowledgement of this fragment was lost, the slave
    /// sends it again.
    acknowledged_count: Option<u8>,
    outbox: VecDeque<Frame>,
}

#[derive(Debug)]
struct Transaction {
    service: u8,
    /// Request without its header.
    body: Vec<u8>,
    destination: Id,
    /// Fragment that waits for its acknowledgement; `None` after the whole request was sent.
    sending: Option<usize>,
    tries: u8,
    deadline: Now,
    /// Received part of the answer, and the count of its last fragment.
    answer: Option<(Vec<u8>, u8)>,
}

impl RequestSender {
    pub(super) const fn new(own_mac: Mac, slave: Mac, answer_timeout: Duration) -> Self {
        Self {
            own_mac,
            slave,
            answer_timeout,
            xid: true,
            current: None,
            acknowledged_count: None,
            outbox: VecDeque::new(),
        }
    }

    pub(super) const fn is_busy(&self) -> bool {
        self.current.is_some()
    }

    /// Sends a request on the explicit connection if `is_connected`, otherwise as an unconnected request.
    pub(super) fn ask(&mut self, now: Now, request: &Request, is_connected: bool) {
        let Some(body) = request.emit(Format::Byte8Byte8) else { return };
        self.xid = !self.xid;
        self.acknowledged_count = None;
        let destination = if is_connected { Id::Request(self.slave) } else { Id::Unconnected(self.slave) };
        let deadline = now + self.answer_timeout;
        let service = request.service;
        self.current =
            Some(Transaction { service, body, destination, sending: None, tries: TRIES, deadline, answer: None });
        self.begin(now);
    }

    pub(super) fn cancel(&mut self) {
        self.current = None;
        self.outbox.clear();
    }

    /// Returns the next frame to send.
    pub(super) fn send(&mut self) -> Option<Frame> {
        self.outbox.pop_front()
    }

    /// Time of the next call of [`expire`](Self::expire).
    pub(super) fn wake(&self) -> Option<Now> {
        if self.outbox.is_empty() { self.current.as_ref().map(|current| current.deadline) } else { Some(Now::ZERO) }
    }

    /// Repeats a request that timed out. After the last attempt, returns the outcome.
    pub(super) fn expire(&mut self, now: Now) -> Option<Outcome> {
        let current = self.current.as_mut().filter(|current| now >= current.deadline)?;
        current.tries -= 1;
        if current.tries == 0 {
            self.current = None;
            return Some(Outcome::Silent);
        }
        current.deadline = now + self.answer_timeout;
        match current.sending {
            Some(index) => self.fragment(index),
            None => self.begin(now),
        }
        None
    }

    /// Handles a frame of an explicit answer of the slave.
    pub(super) fn take(&mut self, now: Now, bytes: &[u8]) -> Option<Outcome> {
        let (first, body) = bytes.split_first()?;
        let header = Header::parse(*first);
        // An answer with another transaction id is a late or duplicate answer to the previous request.
        if header.mac != self.own_mac || header.xid != self.xid {
            return None;
        }
        if !header.is_fragment {
            // Heartbeats and shutdowns are not answers.
            return self.answered(Answer::parse(body)?);
        }
        let (second, part) = body.split_first()?;
        let Fragment { kind, count } = Fragment::parse(*second);
        if kind == Kind::Acknowledge {
            return self.acknowledged(now, count, part.first().copied()?);
        }
        let Some(current) = &mut self.current else {
            if self.acknowledged_count == Some(count) && kind == Kind::Last {
                self.acknowledge(count);
            }
            return None;
        };
        current.deadline = now + self.answer_timeout;
        match &mut current.answer {
            // This fragment arrived again, because its acknowledgement was lost.
            Some((_, last)) if *last == count => {}
            Some((answer, last)) if kind != Kind::First && count == (*last + 1) % 64 => {
                answer.extend(part);
                *last = count;
            }
            None if kind == Kind::First && count == 0 => current.answer = Some((part.to_vec(), 0)),
            // A fragment before this one is missing. The slave will repeat the missing fragment or the whole answer.
            _ => return None,
        }
        self.acknowledge(count);
        let current = self.current.as_ref()?;
        let (answer, last) = current.answer.as_ref()?;
        if answer.len() > MAX_ANSWER_LEN {
            self.current = None;
            return Some(Outcome::Senseless("it is too long"));
        }
        if kind != Kind::Last || *last != count {
            return None;
        }
        self.acknowledged_count = Some(count);
        if let Some(answer) = Answer::parse(answer) {
            self.answered(answer)
        } else {
            self.current = None;
            Some(Outcome::Senseless("it cannot be decoded"))
        }
    }

    fn answered(&mut self, answer: Answer) -> Option<Outcome> {
        let current = self.current.as_ref()?;
        if let Answer::Done { service, .. } = answer
            && (service != current.service || current.sending.is_some())
        {
            return None;
        }
        self.current = None;
        Some(Outcome::Answer(answer))
    }

    fn acknowledged(&mut self, now: Now, count: u8, status: u8) -> Option<Outcome> {
        let current = self.current.as_mut()?;
        let index = current.sending.filter(|index| Fragment::of(*index, index + 2).count == count)?;
        if status != FRAGMENT_ACCEPTED {
            self.current = None;
            return Some(Outcome::Senseless("the request is too long for this device"));
        }
        (current.tries, current.deadline) = (TRIES, now + self.answer_timeout);
        let next = index + 1;
        if next * FRAGMENT_DATA < current.body.len() {
            current.sending = Some(next);
            self.fragment(next);
        } else {
            current.sending = None;
        }
        None
    }

    fn begin(&mut self, now: Now) {
        let header = Header { is_fragment: false, xid: self.xid, mac: self.own_mac };
        let Some(current) = &mut self.current else { return };
        (current.answer, current.deadline) = (None, now + self.answer_timeout);
        if current.body.len() < MAX_DATA {
            let bytes = [&[header.emit()], current.body.as_slice()].concat();
            self.outbox.extend(Frame::new(current.destination.emit(), &bytes));
        } else {
            current.sending = Some(0);
            self.fragment(0);
        }
    }

    fn fragment(&mut self, index: usize) {
        let Some(current) = &self.current else { return };
        let pieces = current.body.len().div_ceil(FRAGMENT_DATA);
        let part = current.body.chunks(FRAGMENT_DATA).nth(index).unwrap_or_default();
        let header = Header { is_fragment: true, xid: self.xid, mac: self.own_mac };
        let bytes = [&[header.emit(), Fragment::of(index, pieces).emit()], part].concat();
        self.outbox.extend(Frame::new(current.destination.emit(), &bytes));
    }

    fn acknowledge(&mut self, count: u8) {
        let header = Header { is_fragment: true, xid: self.xid, mac: self.own_mac };
        let fragment = Fragment { kind: Kind::Acknowledge, count };
        self.outbox
            .extend(Frame::new(Id::Request(self.slave).emit(), &[header.emit(), fragment.emit(), FRAGMENT_ACCEPTED]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devicenet::wire::{class, general, owner, service};

    const NOW: Now = Now::ZERO;
    const SECOND: Duration = Duration::from_secs(1);

    fn requester() -> RequestSender {
        RequestSender::new(Mac::new(1).unwrap(), Mac::new(5).unwrap(), SECOND)
    }

    fn sent(requester: &mut RequestSender) -> Vec<String> {
        std::iter::from_fn(|| requester.send()).map(|frame| frame.to_string()).collect()
    }

    /// A name of ten characters arrives in fragments, and each fragment is acknowledged.
    #[test]
    fn assembles_and_acknowledges_a_long_answer() {
        let mut requester = requester();
        requester.ask(NOW, &Request::get(class::IDENTITY, 1, 7), true);
        assert_eq!(sent(&mut requester), ["42C#010E010107"]);
        assert_eq!(requester.take(NOW, &[0x81, 0x00, 0x8E, 0x0A, 0x59, 0x52, 0x43, 0x58]), None);
        assert_eq!(sent(&mut requester), ["42C#81C000"]);
        let last = [0x81, 0x81, 0x20, 0x28, 0x73, 0x69, 0x6D, 0x29];
        let data = [&[10], b"YRCX (sim)".as_slice()].concat();
        let answer = Outcome::Answer(Answer::Done { service: service::GET, data });
        assert_eq!(requester.take(NOW, &last), Some(answer));
        assert_eq!(sent(&mut requester), ["42C#81C100"]);
        // The acknowledgement was lost, so the slave sends the fragment again. The master acknowledges it again.
        assert_eq!(requester.take(NOW, &last), None);
        assert_eq!(sent(&mut requester), ["42C#81C100"]);
    }

    #[test]
    fn ignores_a_repeated_fragment() {
        let mut requester = requester();
        requester.ask(NOW, &Request::get(class::IDENTITY, 1, 7), true);
        sent(&mut requester);
        let first = [0x81, 0x00, 0x8E, 7, 1, 2, 3, 4];
        assert_eq!(requester.take(NOW, &first), None);
        assert_eq!(requester.take(NOW, &first), None);
        assert_eq!(sent(&mut requester).len(), 2);
        // The master does not accept a fragment that arrives out of order.
        assert_eq!(requester.take(NOW, &[0x81, 0x82, 9]), None);
        assert!(sent(&mut requester).is_empty());
        let Some(Outcome::Answer(Answer::Done { data, .. })) = requester.take(NOW, &[0x81, 0x81, 5, 6, 7]) else {
            panic!("no answer")
        };
        assert_eq!(data, [7, 1, 2, 3, 4, 5, 6, 7]);
    }

    #[test]
    fn sends_a_long_request_in_fragments() {
        let mut requester = requester();
        requester.ask(NOW, &Request::set(class::CONNECTION, 2, 16, &[1, 2, 3, 4]), true);
        assert_eq!(sent(&mut requester), ["42C#8100100502100102"]);
        assert_eq!(requester.take(NOW, &[0x81, 0xC1, 0]), None, "not this one's");
        assert_eq!(requester.expire(SECOND), None);
        assert_eq!(sent(&mut requester), ["42C#8100100502100102"], "once more");
        assert_eq!(requester.take(SECOND, &[0x81, 0xC0, 0]), None);
        assert_eq!(sent(&mut requester), ["42C#81810304"]);
        assert_eq!(requester.take(SECOND, &[0x81, 0xC1, 0]), None);
        let done = Answer::Done { service: service::SET, data: Vec::new() };
        assert_eq!(requester.take(SECOND, &[0x01, 0x90]), Some(Outcome::Answer(done)));
    }

    #[test]
    fn ignores_other_messages() {
        let mut requester = requester();
        requester.ask(NOW, &Request::get(class::CONNECTION, 2, 7), true);
        for other in [
            &[0x41, 0x8E, 0x30, 0][..],
            &[0x02, 0x8E, 0x30, 0],
            &[0x01, 0xCB, 0],
            &[0x01, service::HEARTBEAT, 1, 0, 3, 0, 0, 0],
            &[0x01, service::SHUTDOWN, 1, 0, 0, 0],
            &[],
            &[0x01],
            &[0x81],
            &[0x81, 0xC0],
        ] {
            assert_eq!(requester.take(NOW, other), None, "{other:x?}");
        }
        assert!(matches!(requester.take(NOW, &[0x01, 0x8E, 0x30, 0]), Some(Outcome::Answer(_))));
        // The next request has the other transaction id, so a duplicate of this answer is ignored.
        requester.ask(NOW, &Request::get(class::CONNECTION, 2, 8), true);
        assert_eq!(requester.take(NOW, &[0x01, 0x8E, 0x30, 0]), None);
        let refused = Answer::Refused { general: general::NO_ATTRIBUTE, additional: owner::NONE };
        assert_eq!(requester.take(NOW, &[0x41, 0x94, 0x14, 0xFF]), Some(Outcome::Answer(refused)));
    }

    #[test]
    fn fails_after_two_unanswered_tries() {
        let mut requester = requester();
        requester.ask(NOW, &Request::allocate(3, Mac::new(1).unwrap()), false);
        assert_eq!(sent(&mut requester), ["42E#014B03010301"]);
        assert_eq!(requester.wake(), Some(SECOND));
        assert_eq!(requester.expire(SECOND / 2), None);
        assert_eq!(requester.expire(SECOND), None);
        assert_eq!(sent(&mut requester), ["42E#014B03010301"]);
        assert_eq!(requester.expire(SECOND * 2), Some(Outcome::Silent));
        assert!(!requester.is_busy());
    }
}

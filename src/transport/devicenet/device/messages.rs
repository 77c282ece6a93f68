//! Explicit messages of a slave: reassembly, acknowledgement, fragmentation.

use std::time::Duration;

use super::super::Now;
use super::super::can::Frame;
use super::super::wire::{Fragment, Header, Id, Kind, Mac};

const FRAGMENT_TIMEOUT: Duration = Duration::from_secs(1);
/// Maximum length of a reassembled request in bytes.
const MAX_REQUEST_LEN: usize = 64;

/// A complete request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct CompleteRequest {
    pub(super) header: Header,
    pub(super) body: Vec<u8>,
}

/// Fragmentation state of one slave.
#[derive(Debug)]
pub(super) struct Messages {
    mac: Mac,
    incoming: Option<IncomingMessage>,
    outgoing: Option<OutgoingMessage>,
}

#[derive(Debug)]
struct IncomingMessage {
    header: Header,
    body: Vec<u8>,
    count: u8,
}

#[derive(Debug)]
struct OutgoingMessage {
    header: Header,
    pieces: Vec<Vec<u8>>,
    at: usize,
    deadline: Now,
    is_repeated: bool,
    is_due: bool,
}

impl Messages {
    pub(super) const fn new(mac: Mac) -> Self {
        Self { mac, incoming: None, outgoing: None }
    }

    pub(super) fn reset(&mut self) {
        (self.incoming, self.outgoing) = (None, None);
    }

    pub(super) fn wake(&self) -> Option<Now> {
        self.outgoing.as_ref().map(|outgoing| if outgoing.is_due { Now::ZERO } else { outgoing.deadline })
    }

    /// Handles a frame. Returns the request if the frame completes one. Acknowledgements are added to `out`.
    pub(super) fn take(
        &mut self,
        now: Now,
        bytes: &[u8],
        out: &mut Vec<Frame>,
        acknowledges: bool,
    ) -> Option<CompleteRequest> {
        let (first, body) = bytes.split_first()?;
        let header = Header::parse(*first);
        if !header.is_fragment {
            self.incoming = None;
            return Some(CompleteRequest { header, body: body.to_vec() });
        }
        let (second, part) = body.split_first()?;
        let Fragment { kind, count } = Fragment::parse(*second);
        if kind == Kind::Acknowledge {
            if acknowledges {
                self.acknowledged(now, header, count, part);
            }
            return None;
        }
        // A fragment has six bytes of data. Only the last fragment can have fewer.
        if part.is_empty() || kind != Kind::Last && part.len() != 6 {
            self.incoming = None;
            return None;
        }
        let is_next = |incoming: &IncomingMessage| incoming.header == header && incoming.count == count;
        let is_again = |incoming: &IncomingMessage| incoming.header == header && (incoming.count + 63) % 64 == count;
        let mut status = 0;
        match &mut self.incoming {
            Some(incoming) if kind != Kind::First && is_next(incoming) => {
                incoming.body.extend(part);
                incoming.count = (count + 1) % 64;
                status = u8::from(incoming.body.len() > MAX_REQUEST_LEN);
            }
            Some(incoming) if is_again(incoming) => {}
            _ if kind == Kind::First && count == 0 => {
                self.incoming = Some(IncomingMessage { header, body: part.to_vec(), count: 1 });
            }
            _ => {
                self.incoming = None;
                return None;
            }
        }
        if acknowledges {
            let acknowledge = Fragment { kind: Kind::Acknowledge, count };
            out.extend(self.frame(header, &[acknowledge.emit(), status]));
        }
        if status != 0 {
            self.incoming = None;
        }
        let is_whole =
            kind == Kind::Last && self.incoming.as_ref().is_some_and(|incoming| (count + 1) % 64 == incoming.count);
        let incoming = self.incoming.take_if(|_| is_whole)?;
        Some(CompleteRequest { header: Header { is_fragment: false, ..header }, body: incoming.body })
    }

    /// Sends an answer.
    pub(super) fn give(&mut self, now: Now, header: Header, body: &[u8], out: &mut Vec<Frame>) {
        if body.len() < 8 {
            self.outgoing = None;
            out.extend(self.frame(Header { is_fragment: false, ..header }, body));
            return;
        }
        let pieces: Vec<&[u8]> = body.chunks(6).collect();
        let last = pieces.len() - 1;
        let piece = |(index, piece): (usize, &&[u8])| {
            let kind = match index {
                0 => Kind::First,
                _ if index == last => Kind::Last,
                _ => Kind::Middle,
            };
            let count = u8::try_from(index % 64).unwrap_or_default();
            [&[Fragment { kind, count }.emit()], *piece].concat()
        };
        let pieces = pieces.iter().enumerate().map(piece).collect();
        let header = Header { is_fragment: true, ..header };
        self.outgoing =
            Some(OutgoingMessage { header, pieces, at: 0, deadline: now, is_repeated: false, is_due: true });
    }

    /// Returns the next fragment to send.
    pub(super) fn poll(&mut self, now: Now) -> Option<Frame> {
        let outgoing = self.outgoing.as_mut()?;
        if outgoing.is_due {
            outgoing.is_due = false;
        } else if now < outgoing.deadline {
            return None;
        } else if outgoing.is_repeated {
            self.outgoing = None;
            return None;
        } else {
            outgoing.is_repeated = true;
        }
        outgoing.deadline = now + FRAGMENT_TIMEOUT;
        let (header, piece) = (outgoing.header, outgoing.pieces.get(outgoing.at)?.clone());
        self.frame(header, &piece)
    }

    fn acknowledged(&mut self, now: Now, header: Header, count: u8, status: &[u8]) {
        let Some(outgoing) = &mut self.outgoing else { return };
        if outgoing.is_due || header != outgoing.header || usize::from(count) != outgoing.at % 64 || status.len() != 1 {
            return;
        }
        outgoing.at += 1;
        if status != [0] || outgoing.at == outgoing.pieces.len() {
            self.outgoing = None;
            return;
        }
        (outgoing.is_due, outgoing.is_repeated, outgoing.deadline) = (true, false, now + FRAGMENT_TIMEOUT);
    }

    fn frame(&self, header: Header, rest: &[u8]) -> Option<Frame> {
        Frame::new(Id::Answer(self.mac).emit(), &[&[header.emit()], rest].concat())
    }
}

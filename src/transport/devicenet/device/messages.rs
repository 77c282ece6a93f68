//! Explicit messages of a slave: reassembly, acknowledgement, fragmentation.

use std::time::Duration;

use super::super::Now;
use super::super::can::Frame;
use super::super::wire::{Fragment, Header, Id, Kind, Mac};

const PATIENCE: Duration = Duration::from_secs(1);
/// Maximum length of a reassembled request in bytes.
const ROOM: usize = 64;

/// A complete request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Whole {
    pub(super) header: Header,
    pub(super) body: Vec<u8>,
}

/// Fragmentation state of one slave.
#[derive(Debug)]
pub(super) struct Messages {
    mac: Mac,
    arriving: Option<Arriving>,
    leaving: Option<Leaving>,
}

#[derive(Debug)]
struct Arriving {
    header: Header,
    body: Vec<u8>,
    count: u8,
}

#[derive(Debug)]
struct Leaving {
    header: Header,
    pieces: Vec<Vec<u8>>,
    at: usize,
    deadline: Now,
    is_repeated: bool,
    is_due: bool,
}

impl Messages {
    pub(super) const fn new(mac: Mac) -> Self {
        Self { mac, arriving: None, leaving: None }
    }

    pub(super) fn reset(&mut self) {
        (self.arriving, self.leaving) = (None, None);
    }

    pub(super) fn wake(&self) -> Option<Now> {
        self.leaving.as_ref().map(|leaving| if leaving.is_due { Now::ZERO } else { leaving.deadline })
    }

    /// Handles a frame. Returns the request if the frame completes one. Acknowledgements are added to `out`.
    pub(super) fn take(&mut self, now: Now, bytes: &[u8], out: &mut Vec<Frame>, acknowledges: bool) -> Option<Whole> {
        let (first, body) = bytes.split_first()?;
        let header = Header::parse(*first);
        if !header.is_fragment {
            self.arriving = None;
            return Some(Whole { header, body: body.to_vec() });
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
            self.arriving = None;
            return None;
        }
        let is_next = |arriving: &Arriving| arriving.header == header && arriving.count == count;
        let is_again = |arriving: &Arriving| arriving.header == header && (arriving.count + 63) % 64 == count;
        let mut status = 0;
        match &mut self.arriving {
            Some(arriving) if kind != Kind::First && is_next(arriving) => {
                arriving.body.extend(part);
                arriving.count = (count + 1) % 64;
                status = u8::from(arriving.body.len() > ROOM);
            }
            Some(arriving) if is_again(arriving) => {}
            _ if kind == Kind::First && count == 0 => {
                self.arriving = Some(Arriving { header, body: part.to_vec(), count: 1 });
            }
            _ => {
                self.arriving = None;
                return None;
            }
        }
        if acknowledges {
            let acknowledge = Fragment { kind: Kind::Acknowledge, count };
            out.extend(self.frame(header, &[acknowledge.emit(), status]));
        }
        if status != 0 {
            self.arriving = None;
        }
        let is_whole =
            kind == Kind::Last && self.arriving.as_ref().is_some_and(|arriving| (count + 1) % 64 == arriving.count);
        let arriving = self.arriving.take_if(|_| is_whole)?;
        Some(Whole { header: Header { is_fragment: false, ..header }, body: arriving.body })
    }

    /// Sends an answer.
    pub(super) fn give(&mut self, now: Now, header: Header, body: &[u8], out: &mut Vec<Frame>) {
        if body.len() < 8 {
            self.leaving = None;
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
        self.leaving = Some(Leaving { header, pieces, at: 0, deadline: now, is_repeated: false, is_due: true });
    }

    /// Returns the next fragment to send.
    pub(super) fn poll(&mut self, now: Now) -> Option<Frame> {
        let leaving = self.leaving.as_mut()?;
        if leaving.is_due {
            leaving.is_due = false;
        } else if now < leaving.deadline {
            return None;
        } else if leaving.is_repeated {
            self.leaving = None;
            return None;
        } else {
            leaving.is_repeated = true;
        }
        leaving.deadline = now + PATIENCE;
        let (header, piece) = (leaving.header, leaving.pieces.get(leaving.at)?.clone());
        self.frame(header, &piece)
    }

    fn acknowledged(&mut self, now: Now, header: Header, count: u8, status: &[u8]) {
        let Some(leaving) = &mut self.leaving else { return };
        if leaving.is_due || header != leaving.header || usize::from(count) != leaving.at % 64 || status.len() != 1 {
            return;
        }
        leaving.at += 1;
        if status != [0] || leaving.at == leaving.pieces.len() {
            self.leaving = None;
            return;
        }
        (leaving.is_due, leaving.is_repeated, leaving.deadline) = (true, false, now + PATIENCE);
    }

    fn frame(&self, header: Header, rest: &[u8]) -> Option<Frame> {
        Frame::new(Id::Answer(self.mac).emit(), &[&[header.emit()], rest].concat())
    }
}

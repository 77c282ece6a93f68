//! A minimal controller. It reads and writes bytes itself, so it is independent of the code under test.

use armctl_controller::Now;
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::wire::Status;

use super::link::{Class, Controller, TransferKind};

/// Data of the answer to every read.
const STATE: [u8; 8] = [0x42, 0, 0, 0, 0x40, 0, 0, 0];
/// Refusal of an unexpected block (DX chapter 4).
const WRONG_BLOCK: u32 = 0xE4A1;
/// Refusal of an ACK without a transfer (DX chapter 4).
const NO_SUCH_ACK: u32 = 0xE4A2;

const LAST: u32 = 0x8000_0000;
const BLOCK: usize = 479;

/// How the controller handles duplicate frames. The manuals do not specify this.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ControllerKind {
    /// Recognizes a duplicate by its id and block number, and sends the last answer again.
    Resends,
    /// Handles every ACK as a request for the next block, and every request as a new request. Never sends a frame
    /// again.
    NoResend,
}

/// Transfer state of the controller.
enum Transfer {
    None,
    /// The controller has sent block `block` of a file, for the service `service`.
    Out {
        id: u8,
        service: u8,
        block: u32,
    },
    /// The client has acknowledged every block.
    OutDone {
        id: u8,
    },
    /// The controller has received the blocks up to `taken`.
    In {
        id: u8,
        taken: u32,
        bytes: Vec<u8>,
    },
    /// The controller has received all blocks, up to block `last`.
    InDone {
        id: u8,
        last: u32,
    },
}

/// State of the controller.
pub(crate) struct Model {
    manners: ControllerKind,
    busy_per_10_000: u16,
    rng: fastrand::Rng,
    executed: u32,
    file: Vec<u8>,
    stored: Option<Vec<u8>>,
    transfer: Transfer,
}

/// Fields of a client frame.
struct Frame<'a> {
    division: u8,
    ack: bool,
    id: u8,
    block: u32,
    service: u8,
    data: &'a [u8],
}

impl<'a> Frame<'a> {
    fn read(bytes: &'a [u8]) -> Option<Self> {
        let (head, data) = bytes.split_at_checked(32)?;
        let size = usize::from(head[6]) | usize::from(head[7]) << 8;
        let whole = head.starts_with(b"YERC\x20\x00") && size == data.len() && size <= BLOCK;
        whole.then_some(Self {
            division: head[9],
            ack: head[10] == 1,
            id: head[11],
            block: u32::from(head[12])
                | u32::from(head[13]) << 8
                | u32::from(head[14]) << 16
                | u32::from(head[15]) << 24,
            service: head[29],
            data,
        })
    }

    fn answer(&self, block: u32, status: u8, added: u32, data: &[u8]) -> Vec<u8> {
        frame(self.division, self.id, block, self.service, [status, u8::from(added != 0)], added, data)
    }
}

fn frame(division: u8, id: u8, block: u32, service: u8, [status, words]: [u8; 2], added: u32, data: &[u8]) -> Vec<u8> {
    let mut bytes = b"YERC\x20\x00".to_vec();
    bytes.extend([data.len() & 0xFF, data.len() >> 8].map(|byte| u8::try_from(byte).expect("a byte")));
    bytes.extend([3, division, 1, id]);
    bytes.extend(block.to_le_bytes());
    bytes.extend(*b"99999999");
    bytes.extend([service + 0x80, status, words, 0]);
    bytes.extend(added.to_le_bytes());
    bytes.extend(data);
    bytes
}

impl Model {
    pub(crate) fn new(manners: ControllerKind, busy_per_10_000: u16, seed: u64) -> Self {
        Self {
            manners,
            busy_per_10_000,
            rng: fastrand::Rng::with_seed(seed ^ 0xB5),
            executed: 0,
            file: Vec::new(),
            stored: None,
            transfer: Transfer::None,
        }
    }

    /// Whether a transfer is open, so that the controller waits for the client.
    pub(crate) fn with_transfer(&self) -> bool {
        matches!(self.transfer, Transfer::Out { .. } | Transfer::In { .. })
    }

    /// Builds the block that waits for its ACK once more.
    pub(crate) fn resend(&self) -> Option<Vec<u8>> {
        match self.transfer {
            Transfer::Out { id, service, block } => Some(self.block(id, service, block)),
            _ => None,
        }
    }

    fn block(&self, id: u8, service: u8, number: u32) -> Vec<u8> {
        let data = self.file.chunks(BLOCK).nth(number as usize - 1).expect("only blocks there are get sent");
        frame(2, id, self.mark_last(number), service, [0, 0], 0, data)
    }

    /// Block number for a frame. The number of the last block has a mark.
    fn mark_last(&self, number: u32) -> u32 {
        let last = number as usize == self.file.len().div_ceil(BLOCK);
        if last { number | LAST } else { number }
    }

    fn request(&mut self, frame: &Frame<'_>) -> Option<Vec<u8>> {
        let resends = self.manners == ControllerKind::Resends;
        match (frame.division, frame.service) {
            (1, 0x01) if frame.data.is_empty() => Some(frame.answer(LAST, 0, 0, &STATE)),
            (1, _) => {
                self.executed += 1;
                Some(frame.answer(LAST, 0, 0, &[]))
            }
            (2, 0x15) => match self.transfer {
                Transfer::In { id, taken, .. } if resends && id == frame.id => {
                    (taken == 0).then(|| frame.answer(0, 0, 0, &[]))
                }
                Transfer::InDone { id, .. } if resends && id == frame.id => None,
                _ => {
                    self.transfer = Transfer::In { id: frame.id, taken: 0, bytes: Vec::new() };
                    Some(frame.answer(0, 0, 0, &[]))
                }
            },
            (2, service @ (0x16 | 0x32)) => match self.transfer {
                Transfer::Out { id, block, .. } if resends && id == frame.id => {
                    (block == 1).then(|| self.block(id, service, 1))
                }
                Transfer::OutDone { id } if resends && id == frame.id => None,
                _ if self.file.is_empty() => {
                    Some(frame.answer(LAST, 0, if service == 0x16 { 0xE29C } else { 0xE2A7 }, &[]))
                }
                _ => {
                    self.transfer = Transfer::Out { id: frame.id, service, block: 1 };
                    Some(self.block(frame.id, service, 1))
                }
            },
            (division, service) => panic!("no client should send service {service:#x} to division {division}"),
        }
    }

    /// Handles an ACK of the client.
    fn handle_ack(&mut self, frame: &Frame<'_>) -> Option<Vec<u8>> {
        let resends = self.manners == ControllerKind::Resends;
        match self.transfer {
            Transfer::Out { id, .. } if resends && id != frame.id => None,
            Transfer::Out { service, block, .. } if !resends || frame.block == self.mark_last(block) => {
                if self.mark_last(block) & LAST != 0 {
                    self.transfer = Transfer::OutDone { id: frame.id };
                    return None;
                }
                self.transfer = Transfer::Out { id: frame.id, service, block: block + 1 };
                Some(self.block(frame.id, service, block + 1))
            }
            Transfer::Out { service, block, .. } => {
                (frame.block + 1 == block).then(|| self.block(frame.id, service, block))
            }
            _ if resends => None,
            _ => Some(frame.answer(LAST, 0x1F, NO_SUCH_ACK, &[])),
        }
    }

    /// Handles a data block of the client.
    fn handle_load(&mut self, frame: &Frame<'_>) -> Option<Vec<u8>> {
        let resends = self.manners == ControllerKind::Resends;
        let number = frame.block & !LAST;
        let ack = frame.answer(frame.block, 0, 0, &[]);
        let refusal = frame.answer(frame.block, 0x1F, WRONG_BLOCK, &[]);
        match &mut self.transfer {
            Transfer::In { id, .. } | Transfer::InDone { id, .. } if resends && *id != frame.id => None,
            Transfer::In { id, taken, bytes } if number == *taken + 1 => {
                bytes.extend(frame.data);
                if frame.block & LAST == 0 {
                    *taken = number;
                } else {
                    self.stored = Some(std::mem::take(bytes));
                    self.transfer = Transfer::InDone { id: *id, last: frame.block };
                }
                Some(ack)
            }
            Transfer::In { taken, .. } if resends && number <= *taken => (number == *taken).then_some(ack),
            Transfer::InDone { last, .. } if resends => (*last == frame.block).then_some(ack),
            _ if resends => None,
            _ => {
                self.transfer = Transfer::None;
                Some(refusal)
            }
        }
    }
}

impl Controller for Model {
    fn receive(&mut self, _: Now, datagram: &[u8]) -> Vec<Vec<u8>> {
        let Some(frame) = Frame::read(datagram) else { return Vec::new() };
        let answer = match (frame.ack, frame.service) {
            (false, _) if self.rng.u16(0..10_000) < self.busy_per_10_000 => Some(frame.answer(LAST, 0x1F, 0xD8FA, &[])),
            (false, _) => self.request(&frame),
            (true, 0x15) => self.handle_load(&frame),
            (true, _) => self.handle_ack(&frame),
        };
        answer.into_iter().collect()
    }

    fn order(&mut self, class: Class) -> Request {
        let (command, service, data) = match class {
            Class::Read => (0x72, 0x01, Vec::new()),
            Class::Write => (0x7C, 0x10, vec![1, 2, 3, 4]),
            Class::Start => (0x86, 0x10, vec![1, 0, 0, 0]),
            Class::Move => (0x8A, 0x02, vec![0; 104]),
        };
        Request { command, instance: 1, attribute: 0, service, data }
    }

    fn has_answered(&self, data: &[u8]) -> bool {
        data == STATE
    }

    fn may_refuse(&self, status: Status) -> bool {
        [WRONG_BLOCK, NO_SUCH_ACK].contains(&status.added)
    }

    fn executed(&self) -> u32 {
        self.executed
    }

    fn offer(&mut self, _: TransferKind, content: &[u8]) -> (&'static [u8], Vec<u8>) {
        self.file = content.to_vec();
        self.transfer = Transfer::None;
        (b"TESTJOB.JBI", content.to_vec())
    }

    fn forget(&mut self) {
        self.stored = None;
    }

    fn stored(&self) -> Option<Vec<u8>> {
        self.stored.clone()
    }

    fn skips(&self) -> bool {
        self.manners == ControllerKind::NoResend
    }
}

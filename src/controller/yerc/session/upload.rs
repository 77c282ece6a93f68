//! Upload of a file (load 0x15; DX 3.2.4).

use super::super::wire::{LAST_BLOCK, MAX_DATA, RequestFrame, Status};
use super::{Counters, Due, Ids, Inbox, Policy, RepeatTiming, count, is_busy};
use crate::{Now, Session, Step};

/// Outcome of an upload. `sent` counts the bytes in the sent blocks, `taken` the bytes in the acknowledged blocks.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum UploadEnd {
    /// The controller acknowledged every block up to the last one.
    Complete {
        /// Total size.
        bytes: u64,
        /// Number of blocks.
        blocks: u32,
    },
    /// The controller acknowledged all blocks, but the ACK of the last block has no number: it is `0x80000000`. This is
    /// most likely the end of the upload. Only a check at the controller can confirm it.
    Unnumbered {
        /// Total size.
        bytes: u64,
        /// Number of blocks.
        blocks: u32,
    },
    /// The file is empty, and nothing was sent. A transfer ends with a data block that has the last-block bit, and the
    /// manuals have no such block without data. An upload of an empty file could leave an open transfer or a partial
    /// file on the controller.
    Empty,
    /// The file needs more blocks than there are block numbers.
    TooLong {
        /// Bytes sent before the numbers ran out.
        sent: u64,
    },
    /// The controller refused the transfer, at the start or later.
    Refused {
        /// The status of the refusal. It is a busy code if the controller was busy until the time limit.
        status: Status,
        /// Bytes in the sent blocks.
        sent: u64,
        /// Bytes in the acknowledged blocks.
        taken: u64,
        /// Whether an earlier attempt of the refused frame had no answer. The controller may have accepted that
        /// attempt. If the frame was the last block, the file may exist despite the refusal.
        repeated: bool,
    },
    /// The controller did not answer. It may have nothing, a part of the file, or, after the last block, the whole
    /// file. After the request (`sent` is 0), the controller may be waiting for data.
    OutcomeUnknown {
        /// Bytes in the sent blocks.
        sent: u64,
        /// Bytes in the acknowledged blocks.
        taken: u64,
        /// What was received instead of an acknowledgement.
        counters: Counters,
    },
}

/// The frame that waits for its acknowledgement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// No frame: the next block is being collected.
    Gather,
    /// The request.
    Request,
    /// A block. `last` marks the last block of the file.
    Block { last: bool },
}

/// A transfer to the controller. The session requests content with [`Step::Feed`] before it sends anything. Therefore
/// an empty or unreadable file has no effect on the controller.
#[derive(Debug, Clone)]
pub struct Upload {
    inbox: Inbox,
    pace: RepeatTiming,
    block_size: usize,
    /// Content that was not sent yet.
    buffer: Vec<u8>,
    source_ended: bool,
    stage: Stage,
    /// Block number in the answer that accepted the request.
    accepted: Option<u32>,
    last_sent: Vec<u8>,
    /// Number of the last sent block; 0 before the first block.
    block: u32,
    sent: u64,
    taken: u64,
    /// Whether an earlier attempt to send the last frame had no answer.
    repeated: bool,
    /// Busy refusal of the last frame. The frame is repeated later.
    busy: Option<Status>,
    ended: Option<UploadEnd>,
}

impl Upload {
    /// Creates a session that sends `request` (load). The id of the request is replaced by an id from `ids`.
    ///
    /// # Panics
    /// If the data of `request` is too long for a frame.
    pub fn new(request: &RequestFrame<'_>, policy: Policy, ids: &Ids) -> Self {
        Self {
            inbox: Inbox::new(request, ids),
            pace: RepeatTiming::new(policy),
            block_size: MAX_DATA,
            buffer: Vec::new(),
            source_ended: false,
            stage: Stage::Gather,
            accepted: None,
            last_sent: Vec::new(),
            block: 0,
            sent: 0,
            taken: 0,
            repeated: false,
            busy: None,
            ended: None,
        }
    }

    /// Sets the block size instead of 479 bytes. Other clients are known to use 400 bytes.
    ///
    /// # Panics
    /// If `size` is not 1 to 479.
    #[must_use]
    pub fn with_block_size(mut self, size: usize) -> Self {
        assert!((1..=MAX_DATA).contains(&size), "blocks have 1 to {MAX_DATA} bytes, not {size}");
        self.block_size = size;
        self
    }

    /// Answers [`Step::Feed`] with the next piece of the file, of any size. `last` marks the last piece of the file,
    /// which may be empty. Data after the last piece is ignored.
    pub fn feed(&mut self, data: &[u8], last: bool) {
        if self.source_ended {
            return;
        }
        self.buffer.extend_from_slice(data);
        self.source_ended = last;
    }

    /// Unexpected events so far.
    pub fn counters(&self) -> Counters {
        self.inbox.counters
    }

    /// Bytes in the blocks sent so far.
    pub fn sent(&self) -> u64 {
        self.sent
    }

    /// Bytes in the blocks acknowledged so far.
    pub fn taken(&self) -> u64 {
        self.taken
    }

    /// The next frame, or a request for more content.
    fn next_frame(&mut self, now: Now) -> Step<UploadEnd> {
        // A full block may be the last block. Only another byte after it shows that it is not.
        if !self.source_ended && self.buffer.len() <= self.block_size {
            return Step::Feed;
        }
        if self.accepted.is_none() {
            if self.buffer.is_empty() {
                return self.end(UploadEnd::Empty);
            }
            self.stage = Stage::Request;
            self.last_sent.clone_from(&self.inbox.request);
        } else if self.block == LAST_BLOCK - 1 {
            return self.end(UploadEnd::TooLong { sent: self.sent });
        } else {
            self.cut_block();
        }
        self.pace.restart(now);
        self.repeated = false;
        self.send(now)
    }

    fn cut_block(&mut self) {
        let size = self.buffer.len().min(self.block_size);
        let last = self.source_ended && size == self.buffer.len();
        self.block += 1;
        let block = if last { self.block | LAST_BLOCK } else { self.block };
        let data = &self.buffer[..size];
        self.last_sent = RequestFrame { ack: true, block, data, ..self.inbox.request() }.emit();
        self.buffer.drain(..size);
        self.sent = self.sent.saturating_add(size as u64);
        self.stage = Stage::Block { last };
    }

    fn send(&mut self, now: Now) -> Step<UploadEnd> {
        // A controller recognizes a repeated block by its number. The request has no number, so it is not repeated.
        self.pace.sent(now, self.stage != Stage::Request);
        Step::Send(self.last_sent.clone())
    }

    fn again(&mut self, now: Now) -> Step<UploadEnd> {
        if self.busy.take().is_none() {
            self.repeated = true;
            self.pace.repeat();
            count(&mut self.inbox.counters.repeats);
        } else if self.stage == Stage::Request {
            self.inbox.renew();
            self.last_sent.clone_from(&self.inbox.request);
        }
        self.send(now)
    }

    fn end(&mut self, end: UploadEnd) -> Step<UploadEnd> {
        self.ended = Some(end.clone());
        Step::Done(end)
    }

    fn refused(&self, status: Status) -> UploadEnd {
        UploadEnd::Refused { status, sent: self.sent, taken: self.taken, repeated: self.repeated }
    }

    fn expire(&self) -> UploadEnd {
        let counters = self.inbox.counters;
        match self.busy {
            Some(status) => self.refused(status),
            None => UploadEnd::OutcomeUnknown { sent: self.sent, taken: self.taken, counters },
        }
    }

    fn take_busy(&mut self, now: Now, status: Status) {
        if self.busy.is_some() || self.stage == Stage::Gather {
            return count(&mut self.inbox.counters.duplicated);
        }
        count(&mut self.inbox.counters.busy);
        if self.pace.pause(now) {
            self.busy = Some(status);
        } else {
            self.ended = Some(self.refused(status));
        }
    }

    fn take_ack(&mut self, block: u32) {
        // An acknowledgement of the last block also counts if its number has no last-block bit.
        let number = block & !LAST_BLOCK;
        // If the controller accepted the request with the same number, this ACK may be a late copy of that answer.
        let is_unnumbered = block == LAST_BLOCK && self.accepted != Some(LAST_BLOCK);
        if is_unnumbered && self.stage == (Stage::Block { last: true }) {
            self.taken = self.sent;
            self.ended = Some(UploadEnd::Unnumbered { bytes: self.sent, blocks: self.block });
            return;
        }
        if number > self.block {
            return count(&mut self.inbox.counters.foreign);
        }
        if number < self.block || self.stage == Stage::Gather {
            return count(&mut self.inbox.counters.duplicated);
        }
        self.busy = None;
        self.accepted = self.accepted.or(Some(block));
        self.taken = self.sent;
        self.ended = (self.stage == Stage::Block { last: true })
            .then_some(UploadEnd::Complete { bytes: self.sent, blocks: self.block });
        self.stage = Stage::Gather;
    }
}

impl Session for Upload {
    type Outcome = UploadEnd;

    fn poll(&mut self, now: Now) -> Step<UploadEnd> {
        if let Some(ended) = &self.ended {
            return Step::Done(ended.clone());
        }
        if self.stage == Stage::Gather {
            return self.next_frame(now);
        }
        match self.pace.due(now) {
            Due::Nothing { before } => Step::Wait(before),
            Due::Repeat => self.again(now),
            Due::Expired => {
                let end = self.expire();
                self.end(end)
            }
        }
    }

    fn handle(&mut self, now: Now, bytes: &[u8]) {
        let Some(answer) = self.inbox.current(bytes) else { return };
        if self.last_sent.is_empty() {
            return count(&mut self.inbox.counters.foreign);
        }
        if self.ended.is_some() {
            return count(&mut self.inbox.counters.duplicated);
        }
        let status = answer.status;
        if is_busy(status) {
            self.take_busy(now, status);
        } else if !status.is_ok() || status.added != 0 {
            // For a read, success with an added status means that data is missing. For a block, it means that the block
            // was not acknowledged.
            self.ended = Some(self.refused(status));
        } else {
            self.take_ack(answer.block);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::{AnswerFrame, Division};
    use super::super::testing::{FILE_REQUEST, under_id};
    use super::super::with_id;
    use super::*;
    use crate::testing::{done, hex, ms, sent};

    const LOAD: RequestFrame<'static> = RequestFrame { service: 0x15, ..FILE_REQUEST };

    fn start(content: &[u8]) -> Upload {
        let mut session = Upload::new(&LOAD, Policy::default(), &Ids::starting_at(5));
        assert_eq!(session.poll(ms(0)), Step::Feed);
        session.feed(content, true);
        session
    }

    fn ack(block: u32) -> Vec<u8> {
        answer(5, block, Status::OK)
    }

    fn answer(id: u8, block: u32, status: Status) -> Vec<u8> {
        AnswerFrame { division: Division::File, ack: true, id, block, service: 0x95, status, data: &[] }.emit()
    }

    #[test]
    fn load_as_in_section_3_2_4() {
        // In the example of the manual, every block increments the id (05, 06, 07). Here a transfer keeps its id.
        let content = [&[0x41; 479][..], b"   END\r\n"].concat();
        let mut session = start(&content);
        assert_eq!(
            sent(&mut session, ms(0)),
            hex("5945524320000b00030200050000000039393939393939390000000000150000544553544a4f422e4a4249")
        );
        session.handle(ms(10), &hex("5945524320000000030201050000000039393939393939399500000000000000"));
        let head = hex("594552432000df01030201060100000039393939393939390000000000150000");
        let block = sent(&mut session, ms(10));
        assert_eq!(block, with_id(&[head, vec![0x41; 479]].concat(), 5));
        session.handle(ms(20), &under_id(&hex("5945524320000000030201060100000039393939393939399500000000000000"), 5));
        let block = hex("5945524320000800030201070200008039393939393939390000000000150000202020454e440d0a");
        assert_eq!(sent(&mut session, ms(20)), with_id(&block, 5));
        session.handle(ms(30), &under_id(&hex("5945524320000000030201070200008039393939393939399500000000000000"), 5));
        assert_eq!(done(&mut session, ms(30)), UploadEnd::Complete { bytes: 487, blocks: 2 });
        assert_eq!(session.counters(), Counters::default());
    }

    /// Blocks of an upload without faults. The file is fed in pieces. The end of the file comes with the last piece, or
    /// separately (`end_apart`).
    fn blocks(length: usize, piece: usize, block_size: usize, end_apart: bool) -> Vec<(u32, usize)> {
        let content = vec![9; length];
        let mut session = Upload::new(&LOAD, Policy::default(), &Ids::starting_at(5)).with_block_size(block_size);
        let mut pieces = content.chunks(piece).peekable();
        let mut blocks = Vec::new();
        loop {
            match session.poll(ms(0)) {
                Step::Feed => match pieces.next() {
                    Some(data) => session.feed(data, pieces.peek().is_none() && !end_apart),
                    None => session.feed(&[], true),
                },
                Step::Send(frame) => {
                    let frame = RequestFrame::parse(&frame).unwrap();
                    if frame.ack {
                        blocks.push((frame.block, frame.data.len()));
                    }
                    session.handle(ms(0), &ack(frame.block));
                }
                Step::Done(UploadEnd::Complete { bytes, .. }) => {
                    assert_eq!(bytes, length as u64);
                    return blocks;
                }
                other => panic!("{other:?}"),
            }
        }
    }

    #[test]
    fn sends_full_blocks_and_marks_the_last_for_any_input_pieces() {
        for piece in [1, 100, 479, 480, 8192] {
            for end_apart in [true, false] {
                assert_eq!(blocks(478, piece, 479, end_apart), [(0x8000_0001, 478)]);
                assert_eq!(blocks(479, piece, 479, end_apart), [(0x8000_0001, 479)]);
                assert_eq!(blocks(480, piece, 479, end_apart), [(1, 479), (0x8000_0002, 1)]);
                assert_eq!(blocks(958, piece, 479, end_apart), [(1, 479), (0x8000_0002, 479)]);
                assert_eq!(blocks(900, piece, 400, end_apart), [(1, 400), (2, 400), (0x8000_0003, 100)]);
            }
        }
    }

    #[test]
    fn an_empty_file_is_refused_before_anything_is_sent() {
        let mut session = start(&[]);
        assert_eq!(done(&mut session, ms(0)), UploadEnd::Empty);
    }

    #[test]
    fn silence_repeats_the_block_and_other_acks_are_ignored() {
        let mut session = start(&[1; 1000]);
        sent(&mut session, ms(0));
        session.handle(ms(310), &ack(0));
        let first = sent(&mut session, ms(310));
        session.handle(ms(320), &ack(0));
        session.handle(ms(330), &ack(2));
        assert_eq!(session.poll(ms(330)), Step::Wait(ms(610)));
        assert_eq!(sent(&mut session, ms(610)), first);
        session.handle(ms(620), &ack(1));
        assert_eq!(sent(&mut session, ms(620))[12..16], [2, 0, 0, 0]);
        session.handle(ms(630), &ack(1));
        assert_eq!(session.poll(ms(630)), Step::Wait(ms(920)));
        let expected = Counters { repeats: 1, duplicated: 2, foreign: 1, ..Counters::default() };
        assert_eq!((session.counters(), session.taken()), (expected, 479));
    }

    #[test]
    fn request_is_sent_once_and_silence_is_an_unknown_outcome() {
        let mut session = start(&[1; 1000]);
        sent(&mut session, ms(0));
        assert_eq!(session.poll(ms(0)), Step::Wait(ms(3000)));
        let end = done(&mut session, ms(3000));
        assert!(matches!(end, UploadEnd::OutcomeUnknown { sent: 0, taken: 0, .. }), "{end:?}");

        let mut session = start(&[1; 479]);
        sent(&mut session, ms(0));
        session.handle(ms(10), &ack(0));
        sent(&mut session, ms(10));
        let end = done(&mut session, ms(5110));
        assert!(matches!(end, UploadEnd::OutcomeUnknown { sent: 479, taken: 0, .. }), "{end:?}");
    }

    #[test]
    fn refusal_reports_progress_and_pending_copies() {
        let status = Status::refused(0xE4A1);
        for repeated in [false, true] {
            let mut session = start(&[1; 958]);
            sent(&mut session, ms(0));
            session.handle(ms(10), &ack(0));
            sent(&mut session, ms(10));
            session.handle(ms(20), &ack(1));
            sent(&mut session, ms(20));
            if repeated {
                sent(&mut session, ms(320));
            }
            session.handle(ms(330), &answer(5, 0x8000_0002, status));
            assert_eq!(done(&mut session, ms(330)), UploadEnd::Refused { status, sent: 958, taken: 479, repeated });
        }
    }

    #[test]
    fn unnumbered_last_ack_is_a_separate_result() {
        let to_last_block = |first_ack| {
            let mut session = start(&[1; 958]);
            sent(&mut session, ms(0));
            session.handle(ms(10), &ack(first_ack));
            sent(&mut session, ms(10));
            session.handle(ms(20), &ack(LAST_BLOCK));
            assert!(matches!(session.poll(ms(20)), Step::Wait(_)), "only the last block may be meant");
            session.handle(ms(20), &ack(1));
            sent(&mut session, ms(20));
            session.handle(ms(30), &ack(LAST_BLOCK));
            session
        };
        assert_eq!(done(&mut to_last_block(0), ms(30)), UploadEnd::Unnumbered { bytes: 958, blocks: 2 });
        // If the request was accepted with this number, the ACK may be a late copy of that answer.
        assert!(matches!(to_last_block(LAST_BLOCK).poll(ms(30)), Step::Wait(_)));
    }

    #[test]
    fn a_refused_request_sends_nothing() {
        let status = Status::refused(0x2110);
        let mut session = start(&[1; 958]);
        sent(&mut session, ms(0));
        session.handle(ms(10), &answer(5, 0x8000_0000, status));
        let end = UploadEnd::Refused { status, sent: 0, taken: 0, repeated: false };
        assert_eq!(done(&mut session, ms(10)), end);
    }

    #[test]
    fn success_with_an_added_status_is_not_an_ack() {
        let status = Status { code: 0, added_size: 1, added: 0xE29C };
        let mut session = start(&[1; 9]);
        sent(&mut session, ms(0));
        session.handle(ms(10), &answer(5, 0, status));
        assert!(matches!(done(&mut session, ms(10)), UploadEnd::Refused { .. }));
    }

    #[test]
    fn repeats_only_the_request_after_busy() {
        let busy = Status::refused(0xFFF6);
        let mut session = start(&[1; 9]);
        sent(&mut session, ms(0));
        session.handle(ms(10), &answer(5, 0, busy));
        assert_eq!(session.poll(ms(10)), Step::Wait(ms(110)));
        assert_eq!(sent(&mut session, ms(110))[11], 6);
        session.handle(ms(120), &answer(6, 0, Status::OK));
        let block = sent(&mut session, ms(120));
        session.handle(ms(130), &answer(6, 0x8000_0001, busy));
        assert_eq!(session.poll(ms(130)), Step::Wait(ms(230)));
        assert_eq!(sent(&mut session, ms(230)), block);
        session.handle(ms(240), &answer(6, 0x8000_0001, Status::OK));
        assert_eq!(done(&mut session, ms(240)), UploadEnd::Complete { bytes: 9, blocks: 1 });
        assert_eq!(session.counters(), Counters { busy: 2, ..Counters::default() });
    }
}

//! Download of a file or a list (save 0x16, list 0x32; DX 3.2.3 and 3.2.5).

use std::time::Duration;

use thiserror::Error;

use super::super::wire::{AnswerFrame, LAST_BLOCK, RequestFrame, Status};
use super::{Counters, Due, Ids, Inbox, Policy, RepeatTiming, count, is_busy};
use crate::{Now, Session, Step};

/// Maximum number of times that the session repeats the final ACK.
const MAX_ACK_REPEATS: u32 = 8;

/// A protocol violation in a transfer. The session ends, because it would have to guess the content to continue.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum Violation {
    /// A block is missing.
    #[error("received block {found} instead of block {expected}")]
    Gap {
        /// Number of the next block.
        expected: u32,
        /// Received number without the last-block bit.
        found: u32,
    },
    /// An empty block that is not the last block. With such blocks, the transfer might never end.
    #[error("block {block} is empty but not the last")]
    EmptyBlock {
        /// Number of the block.
        block: u32,
    },
}

/// Outcome of a download. `bytes` counts the data that was returned as [`Step::Data`] before.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DownloadEnd {
    /// All blocks arrived, including the last one.
    Complete {
        /// Total size.
        bytes: u64,
        /// Number of blocks.
        blocks: u32,
    },
    /// The controller reported success without a block. This is the end of the batch backup (DX 3.4.6), or an empty
    /// list.
    Finished,
    /// The controller reported success with an added status and without data. The file is missing or empty (E29C), or
    /// the list is empty (E2A7).
    Nothing(Status),
    /// The controller refused the transfer, at the start or later.
    Refused {
        /// The status of the refusal. It is a busy code if the controller was busy until the time limit.
        status: Status,
        /// Bytes received before the refusal.
        bytes: u64,
    },
    /// The controller violated the protocol.
    Violated {
        /// The violation.
        violation: Violation,
        /// Bytes received before the violation.
        bytes: u64,
    },
    /// The next block would exceed the limit that the caller set.
    TooLarge {
        /// The limit.
        limit: u64,
        /// Bytes received before this block.
        bytes: u64,
    },
    /// The controller did not answer within the time limit.
    NoAnswer {
        /// Bytes received before. If no byte was received, the request itself may be lost.
        bytes: u64,
        /// What was received instead.
        counters: Counters,
    },
}

/// A transfer from the controller. It returns each block once and in order as [`Step::Data`], and buffers at most one
/// block.
#[derive(Debug, Clone)]
pub struct Download {
    inbox: Inbox,
    pace: RepeatTiming,
    first_wait: Option<Duration>,
    limit: u64,
    started: bool,
    /// The last frame sent: the request or an ACK.
    last_sent: Vec<u8>,
    /// Whether `last_sent` must still be sent.
    unsent: bool,
    /// A received block that was not returned yet.
    held: Option<Vec<u8>>,
    /// Number of the next block.
    expected: u32,
    /// Block number of the last ACK, with the last-block bit.
    acknowledged: u32,
    bytes: u64,
    /// The latest answer if it is a busy refusal; `None` after any other answer.
    busy: Option<Status>,
    /// Whether the controller refused the last frame as busy, so that the frame must be repeated later.
    pausing: bool,
    /// Number of repeated ACKs after the end.
    lingered: u32,
    ended: Option<DownloadEnd>,
}

impl Download {
    /// Creates a session that sends `request` (save or list). The id of the request is replaced by an id from `ids`. A
    /// file of more than `limit` bytes is refused.
    ///
    /// # Panics
    /// If the data of `request` is too long for a frame.
    pub fn new(request: &RequestFrame<'_>, limit: u64, policy: Policy, ids: &Ids) -> Self {
        Self {
            inbox: Inbox::new(request, ids),
            pace: RepeatTiming::new(policy),
            first_wait: None,
            limit,
            started: false,
            last_sent: Vec::new(),
            unsent: false,
            held: None,
            expected: 1,
            acknowledged: 0,
            bytes: 0,
            busy: None,
            pausing: false,
            lingered: 0,
            ended: None,
        }
    }

    /// Sets the time limit of the first answer, and disables repeats until then. The batch backup answers after about
    /// ten minutes, and a second request might start a second backup.
    #[must_use]
    pub fn with_first_wait(mut self, wait: Duration) -> Self {
        self.first_wait = Some(wait);
        self
    }

    /// Unexpected events so far.
    pub fn counters(&self) -> Counters {
        self.inbox.counters
    }

    /// Bytes received so far.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Returns the ACK that must be repeated after a complete download, because `bytes` is a repeat of the last block:
    /// the controller did not receive the ACK. Without the repeated ACK, the controller would keep the transfer open
    /// until its timer expires.
    ///
    /// The number of repeats is limited, because a server that repeats the block after each ACK would never end.
    pub fn linger(&mut self, bytes: &[u8]) -> Option<Vec<u8>> {
        let Some(DownloadEnd::Complete { .. }) = self.ended else { return None };
        let answer = self.inbox.current(bytes)?;
        count(&mut self.inbox.counters.duplicated);
        if !answer.status.is_ok() || answer.block != self.acknowledged || self.lingered == MAX_ACK_REPEATS {
            return None;
        }
        self.lingered += 1;
        Some(self.last_sent.clone())
    }

    fn transferring(&self) -> bool {
        self.expected > 1
    }

    fn send(&mut self, now: Now) -> Step<DownloadEnd> {
        match self.first_wait.filter(|_| !self.transferring()) {
            Some(wait) => self.pace.sent_for(now, wait),
            None => self.pace.sent(now, true),
        }
        Step::Send(self.last_sent.clone())
    }

    fn again(&mut self, now: Now) -> Step<DownloadEnd> {
        if !self.pausing {
            self.pace.repeat();
            count(&mut self.inbox.counters.repeats);
        } else if !self.transferring() {
            self.inbox.renew();
            self.last_sent.clone_from(&self.inbox.request);
        }
        self.pausing = false;
        self.send(now)
    }

    fn expire(&self) -> DownloadEnd {
        let bytes = self.bytes;
        match self.busy {
            Some(status) => DownloadEnd::Refused { status, bytes },
            None => DownloadEnd::NoAnswer { bytes, counters: self.inbox.counters },
        }
    }

    fn restart(&mut self, now: Now) {
        self.pace.restart(now);
        if let (Some(wait), false) = (self.first_wait, self.transferring()) {
            self.pace.patience = now.saturating_add(wait);
        }
        self.busy = None;
        self.pausing = false;
    }

    fn take_busy(&mut self, now: Now, status: Status) {
        if self.pausing {
            return count(&mut self.inbox.counters.duplicated);
        }
        count(&mut self.inbox.counters.busy);
        if self.pace.pause(now) {
            self.busy = Some(status);
            self.pausing = true;
        } else {
            self.ended = Some(DownloadEnd::Refused { status, bytes: self.bytes });
        }
    }

    /// Outcome of the transfer if a frame without a block ends it.
    fn end_without_block(&self, answer: &AnswerFrame<'_>) -> Option<DownloadEnd> {
        let (status, bytes) = (answer.status, self.bytes);
        if !status.is_ok() {
            return Some(DownloadEnd::Refused { status, bytes });
        }
        if !answer.data.is_empty() {
            return None;
        }
        match (self.transferring(), status.added) {
            (false, 0) if answer.block & !LAST_BLOCK == 0 => Some(DownloadEnd::Finished),
            (_, 0) => None,
            (false, _) => Some(DownloadEnd::Nothing(status)),
            (true, _) => Some(DownloadEnd::Refused { status, bytes }),
        }
    }

    fn take_block(&mut self, now: Now, answer: &AnswerFrame<'_>) {
        let last = answer.block & LAST_BLOCK != 0;
        let number = answer.block & !LAST_BLOCK;
        let (expected, bytes) = (self.expected, self.bytes);
        // Some controllers give the number 0 instead of 1 to the only block of a file.
        let lone = last && number == 0 && !self.transferring();
        if number < expected && self.transferring() {
            return count(&mut self.inbox.counters.duplicated);
        }
        let violation = if number != expected && !lone {
            Some(Violation::Gap { expected, found: number })
        } else if answer.data.is_empty() && !last {
            Some(Violation::EmptyBlock { block: number })
        } else {
            None
        };
        if let Some(violation) = violation {
            self.ended = Some(DownloadEnd::Violated { violation, bytes });
            return;
        }
        let total = bytes.saturating_add(answer.data.len() as u64);
        if total > self.limit {
            self.ended = Some(DownloadEnd::TooLarge { limit: self.limit, bytes });
            return;
        }
        self.bytes = total;
        self.expected = expected.saturating_add(1);
        self.acknowledged = answer.block;
        self.last_sent = RequestFrame { ack: true, block: answer.block, data: &[], ..self.inbox.request() }.emit();
        self.unsent = true;
        self.held = (!answer.data.is_empty()).then(|| answer.data.to_vec());
        self.restart(now);
        if last {
            self.ended = Some(DownloadEnd::Complete { bytes: total, blocks: expected });
        }
    }
}

impl Session for Download {
    type Outcome = DownloadEnd;

    fn poll(&mut self, now: Now) -> Step<DownloadEnd> {
        if !self.started {
            self.started = true;
            self.restart(now);
            self.last_sent.clone_from(&self.inbox.request);
            return self.send(now);
        }
        // The ACK is sent before the block is returned, so that the controller prepares its next block while the caller
        // writes this one.
        if self.unsent {
            self.unsent = false;
            return self.send(now);
        }
        if let Some(block) = self.held.take() {
            return Step::Data(block);
        }
        if let Some(ended) = &self.ended {
            return Step::Done(ended.clone());
        }
        match self.pace.due(now) {
            Due::Nothing { before } => Step::Wait(before),
            Due::Repeat => self.again(now),
            Due::Expired => {
                let ended = self.expire();
                self.ended = Some(ended.clone());
                Step::Done(ended)
            }
        }
    }

    fn handle(&mut self, now: Now, bytes: &[u8]) {
        let Some(answer) = self.inbox.current(bytes) else { return };
        if !self.started {
            return count(&mut self.inbox.counters.foreign);
        }
        // A frame that arrives before the last frame was sent cannot be the answer to that frame.
        if self.ended.is_some() || self.unsent || self.held.is_some() {
            return count(&mut self.inbox.counters.duplicated);
        }
        if is_busy(answer.status) {
            return self.take_busy(now, answer.status);
        }
        match self.end_without_block(&answer) {
            Some(ended) => self.ended = Some(ended),
            None => self.take_block(now, &answer),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::Division;
    use super::super::testing::{FILE_REQUEST, under_id};
    use super::*;
    use crate::testing::{done, hex, ms, sent};

    const SAVE: RequestFrame<'static> = RequestFrame { service: 0x16, ..FILE_REQUEST };
    const LIST: RequestFrame<'static> = RequestFrame { service: 0x32, data: b"*.JBI", ..SAVE };
    const LIMIT: u64 = 1 << 20;

    fn start(request: &RequestFrame<'_>, id: u8) -> Download {
        Download::new(request, LIMIT, Policy::default(), &Ids::starting_at(id))
    }

    fn block(id: u8, block: u32, data: &[u8]) -> Vec<u8> {
        answer(id, block, Status::OK, data)
    }

    fn answer(id: u8, block: u32, status: Status, data: &[u8]) -> Vec<u8> {
        AnswerFrame { division: Division::File, ack: true, id, block, service: 0x96, status, data }.emit()
    }

    /// Passes a block, and returns the ACK and the data.
    fn exchange(session: &mut Download, now: Now, frame: &[u8]) -> (Vec<u8>, Vec<u8>) {
        session.handle(now, frame);
        let ack = sent(session, now);
        match session.poll(now) {
            Step::Data(data) => (ack, data),
            other => panic!("expected data, not {other:?}"),
        }
    }

    /// A full block with the header of the first block in section 3.2.3 and other data. The manual has no example with
    /// 479 bytes.
    fn full_block(head: &str, fill: u8) -> Vec<u8> {
        [hex(head), vec![fill; 479]].concat()
    }

    #[test]
    fn save_as_in_section_3_2_3() {
        // In the example of the manual, every ACK increments the id (02, 03, 04). Here a transfer keeps its id, and the
        // controller copies the id.
        let mut session = start(&SAVE, 2);
        assert_eq!(
            sent(&mut session, ms(0)),
            hex("5945524320000b00030200020000000039393939393939390000000000160000544553544a4f422e4a4249")
        );
        let first = full_block("594552432000df01030201020100000039393939393939399600000000000000", 0x41);
        let (ack, data) = exchange(&mut session, ms(10), &first);
        assert_eq!(ack, under_id_of_client("5945524320000000030201030100000039393939393939390000000000160000", 2));
        assert_eq!(data, [0x41; 479]);
        let second = full_block("594552432000df01030201030200000039393939393939399600000000000000", 0x42);
        let (ack, data) = exchange(&mut session, ms(20), &under_id(&second, 2));
        assert_eq!(ack, under_id_of_client("5945524320000000030201030200000039393939393939390000000000160000", 2));
        assert_eq!(data, [0x42; 479]);
        let third = hex("5945524320000800030201040300008039393939393939399600000000000000202020454e440d0a");
        let (ack, data) = exchange(&mut session, ms(30), &under_id(&third, 2));
        assert_eq!(ack, under_id_of_client("5945524320000000030201040300008039393939393939390000000000160000", 2));
        assert_eq!(data, b"   END\r\n");
        assert_eq!(done(&mut session, ms(30)), DownloadEnd::Complete { bytes: 966, blocks: 3 });
        assert_eq!(session.counters(), Counters::default());
    }

    fn under_id_of_client(text: &str, id: u8) -> Vec<u8> {
        super::super::with_id(&hex(text), id)
    }

    #[test]
    fn list_of_one_block_as_in_section_3_4_4() {
        let mut session = start(&LIST, 8);
        assert_eq!(
            sent(&mut session, ms(0)),
            hex("59455243200005000302000800000000393939393939393900000000003200002a2e4a4249")
        );
        let names = hex("59455243200024000302010801000080393939393939393\
             9b200000000000000312e4a42490d0a32322e4a42490d0a3333332e4a42490d0a5445535430312e4a42490d0a");
        let (ack, data) = exchange(&mut session, ms(9), &names);
        assert_eq!(ack, hex("5945524320000000030201080100008039393939393939390000000000320000"));
        assert_eq!(data, b"1.JBI\r\n22.JBI\r\n333.JBI\r\nTEST01.JBI\r\n");
        assert_eq!(done(&mut session, ms(9)), DownloadEnd::Complete { bytes: 36, blocks: 1 });
    }

    #[test]
    fn empty_list_differs_from_a_missing_file() {
        let mut session = start(&LIST, 1);
        sent(&mut session, ms(0));
        session.handle(ms(9), &hex("594552432000000003020101000000803939393939393939b2000100a7e20000"));
        let status = Status { code: 0, added_size: 1, added: 0xE2A7 };
        assert_eq!(done(&mut session, ms(9)), DownloadEnd::Nothing(status));

        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        session.handle(ms(9), &block(1, LAST_BLOCK, &[]));
        assert_eq!(done(&mut session, ms(9)), DownloadEnd::Finished);
    }

    #[test]
    fn accepts_block_number_0_and_an_empty_last_block() {
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        let (ack, data) = exchange(&mut session, ms(9), &block(1, LAST_BLOCK, b"all"));
        assert_eq!((&ack[12..16], data.as_slice()), (&[0, 0, 0, 0x80][..], &b"all"[..]));
        assert_eq!(done(&mut session, ms(9)), DownloadEnd::Complete { bytes: 3, blocks: 1 });

        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        exchange(&mut session, ms(9), &block(1, 1, &[5; 479]));
        session.handle(ms(18), &block(1, LAST_BLOCK | 2, &[]));
        assert_eq!(sent(&mut session, ms(18))[12..16], [2, 0, 0, 0x80]);
        assert_eq!(done(&mut session, ms(18)), DownloadEnd::Complete { bytes: 479, blocks: 2 });
    }

    #[test]
    fn repeats_the_last_ack_after_silence_only() {
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        let first = block(1, 1, &[1; 479]);
        let (ack, _) = exchange(&mut session, ms(10), &first);
        for at in (20..310).step_by(10) {
            session.handle(ms(at), &first);
            assert_eq!(session.poll(ms(at)), Step::Wait(ms(310)));
        }
        assert_eq!(sent(&mut session, ms(310)), ack);
        assert_eq!(sent(&mut session, ms(910)), ack);
        let (_, data) = exchange(&mut session, ms(920), &block(1, LAST_BLOCK | 2, &[2; 9]));
        assert_eq!(data, [2; 9]);
        assert_eq!(done(&mut session, ms(920)), DownloadEnd::Complete { bytes: 488, blocks: 2 });
        assert_eq!(session.counters(), Counters { duplicated: 29, repeats: 2, ..Counters::default() });
    }

    #[test]
    fn acknowledges_only_the_last_block_again_after_the_end() {
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        assert_eq!(session.linger(&block(1, 1, &[1; 9])), None);
        let (first, last) = (block(1, 1, &[1; 479]), block(1, LAST_BLOCK | 2, &[2; 9]));
        exchange(&mut session, ms(10), &first);
        let (ack, _) = exchange(&mut session, ms(20), &last);
        done(&mut session, ms(20));
        assert_eq!(session.linger(&last), Some(ack.clone()));
        assert_eq!(session.linger(&last), Some(ack));
        assert_eq!(session.linger(&first), None);
        assert_eq!(session.linger(&block(2, LAST_BLOCK | 2, &[2; 9])), None);
        assert_eq!(session.linger(b"?"), None);
        let further = (0..100).filter_map(|_| session.linger(&last)).count();
        assert_eq!(further, 6, "no endless answers");
    }

    #[test]
    fn gap_or_endless_empty_blocks_end_with_an_error() {
        let cases = [
            (block(1, 3, &[1; 9]), Violation::Gap { expected: 2, found: 3 }),
            (block(1, LAST_BLOCK | 3, &[1; 9]), Violation::Gap { expected: 2, found: 3 }),
            (block(1, 2, &[]), Violation::EmptyBlock { block: 2 }),
        ];
        for (frame, violation) in cases {
            let mut session = start(&SAVE, 1);
            sent(&mut session, ms(0));
            exchange(&mut session, ms(10), &block(1, 1, &[1; 479]));
            session.handle(ms(20), &frame);
            assert_eq!(done(&mut session, ms(20)), DownloadEnd::Violated { violation, bytes: 479 });
        }
    }

    #[test]
    fn refusal_ends_the_download_at_any_block() {
        let status = Status::refused(0xE28B);
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        session.handle(ms(9), &answer(1, LAST_BLOCK, status, &[]));
        assert_eq!(done(&mut session, ms(9)), DownloadEnd::Refused { status, bytes: 0 });

        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        exchange(&mut session, ms(10), &block(1, 1, &[1; 479]));
        session.handle(ms(20), &answer(1, 2, status, &[]));
        assert_eq!(done(&mut session, ms(20)), DownloadEnd::Refused { status, bytes: 479 });
    }

    #[test]
    fn size_limit_is_inclusive() {
        for (limit, fits) in [(488, true), (487, false)] {
            let mut session = Download::new(&SAVE, limit, Policy::default(), &Ids::starting_at(1));
            sent(&mut session, ms(0));
            exchange(&mut session, ms(10), &block(1, 1, &[1; 479]));
            session.handle(ms(20), &block(1, LAST_BLOCK | 2, &[2; 9]));
            if fits {
                sent(&mut session, ms(20));
                assert_eq!(session.poll(ms(20)), Step::Data(vec![2; 9]));
            } else {
                assert_eq!(done(&mut session, ms(20)), DownloadEnd::TooLarge { limit, bytes: 479 });
            }
        }
    }

    #[test]
    fn timeout_starts_at_the_last_progress() {
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        exchange(&mut session, ms(2000), &block(1, 1, &[1; 479]));
        for at in [2300, 2900, 4100] {
            sent(&mut session, ms(at));
        }
        assert_eq!(session.poll(ms(7099)), Step::Wait(ms(7100)));
        let DownloadEnd::NoAnswer { bytes, counters } = done(&mut session, ms(7100)) else { panic!("answered") };
        assert_eq!((bytes, counters.repeats), (479, 3));
    }

    #[test]
    fn long_first_timeout_applies_to_the_first_block_only() {
        let mut session = start(&SAVE, 1).with_first_wait(Duration::from_secs(900));
        sent(&mut session, ms(0));
        assert_eq!(session.poll(ms(1)), Step::Wait(ms(900_000)));
        exchange(&mut session, ms(600_000), &block(1, 1, &[1; 479]));
        assert_eq!(session.poll(ms(600_000)), Step::Wait(ms(600_300)));
        assert!(matches!(done(&mut session, ms(605_100)), DownloadEnd::NoAnswer { bytes: 479, .. }));
    }

    #[test]
    fn repeats_a_busy_request_with_a_new_id() {
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        let busy = answer(1, LAST_BLOCK, Status::refused(0xD8FA), &[]);
        session.handle(ms(10), &busy);
        assert_eq!(session.poll(ms(10)), Step::Wait(ms(110)));
        assert_eq!(sent(&mut session, ms(110))[11], 2);
        session.handle(ms(111), &busy);
        exchange(&mut session, ms(120), &block(2, LAST_BLOCK | 1, &[1; 9]));
        assert_eq!(done(&mut session, ms(120)), DownloadEnd::Complete { bytes: 9, blocks: 1 });
        assert_eq!(session.counters(), Counters { busy: 1, late: 1, ..Counters::default() });
    }

    #[test]
    fn busy_during_the_download_repeats_the_ack() {
        let mut session = start(&SAVE, 1);
        sent(&mut session, ms(0));
        let (ack, _) = exchange(&mut session, ms(10), &block(1, 1, &[1; 479]));
        session.handle(ms(20), &answer(1, LAST_BLOCK, Status::refused(0xE444), &[]));
        assert_eq!(sent(&mut session, ms(120)), ack);
        let status = Status::refused(0xE444);
        assert_eq!(done(&mut session, ms(5110)), DownloadEnd::Refused { status, bytes: 479 });
    }
}

//! Abort of a transfer.
//!
//! The manuals have no request that aborts a transfer. A controller keeps a transfer open until its timer expires
//! (added status E28B, DX 5), and refuses other transfers as busy until then. But a controller also refuses a block or
//! an ACK with a wrong number (added status E4A1, E4A2), and a refusal ends the transfer. For this reason, the session
//! sends a wrong number on purpose, without data and without the last-block bit. The controller cannot mistake such a
//! frame for content or for the end of the file.

use std::time::Duration;

use super::super::table::service;
use super::super::wire::{ANSWER_BIT, AnswerFrame, LAST_BLOCK, RequestFrame};
use super::is_busy;
use crate::{Now, Session, Step};

/// A block number that no transfer reaches.
const NO_BLOCK: u32 = LAST_BLOCK - 1;
/// Interval between two attempts to abort.
const REPEAT_INTERVAL: Duration = Duration::from_millis(200);
/// Number of attempts to abort.
const TRIES: u32 = 3;

/// Session that aborts a transfer at the controller. Its outcome is `true` if the controller confirmed the abort.
#[derive(Debug, Clone)]
pub struct Abort {
    frame: Vec<u8>,
    is_open: bool,
    tries: u32,
    next: Now,
    ended: Option<bool>,
}

impl Abort {
    /// Creates the session that aborts the transfer whose last sent frame was `last`. Returns `None` if that frame
    /// neither opens nor continues a transfer.
    pub fn after(last: &[u8]) -> Option<Self> {
        let last = RequestFrame::parse(last).ok()?;
        let is_transfer = matches!(last.service, service::LOAD | service::SAVE | service::LIST);
        let is_end = last.ack && last.block & LAST_BLOCK != 0;
        (is_transfer && !is_end).then(|| Self {
            frame: RequestFrame { ack: true, block: NO_BLOCK, data: &[], ..last }.emit(),
            // The client sends a block or an ACK only after an answer of the controller, so the transfer is open there.
            is_open: last.ack,
            tries: 0,
            next: Now::ZERO,
            ended: None,
        })
    }

    /// Records that the controller answered, so that the transfer is open there.
    pub fn answered(&mut self) {
        self.is_open = true;
    }

    /// Whether the transfer is open at the controller, according to its answers.
    pub fn is_open(&self) -> bool {
        self.is_open
    }
}

impl Session for Abort {
    type Outcome = bool;

    fn poll(&mut self, now: Now) -> Step<bool> {
        if let Some(ended) = self.ended {
            return Step::Done(ended);
        }
        if self.tries > 0 && now < self.next {
            return Step::Wait(self.next);
        }
        if self.tries == TRIES {
            self.ended = Some(false);
            return Step::Done(false);
        }
        self.tries += 1;
        self.next = now.saturating_add(REPEAT_INTERVAL);
        Step::Send(self.frame.clone())
    }

    fn handle(&mut self, _: Now, bytes: &[u8]) {
        let (Ok(answer), Ok(sent)) = (AnswerFrame::parse(bytes), RequestFrame::parse(&self.frame)) else { return };
        let fits = (answer.division, answer.id, answer.service) == (sent.division, sent.id, sent.service | ANSWER_BIT);
        if self.tries > 0 && fits && !answer.status.is_ok() && !is_busy(answer.status) {
            self.ended = Some(true);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::{Division, Status};
    use super::super::testing::FILE_REQUEST;
    use super::*;
    use crate::testing::{done, ms, sent};

    const SAVE: RequestFrame<'static> = RequestFrame { service: service::SAVE, id: 7, ..FILE_REQUEST };

    fn answer(id: u8, status: Status) -> Vec<u8> {
        let (division, service) = (Division::File, service::SAVE | ANSWER_BIT);
        AnswerFrame { division, ack: true, id, block: 4, service, status, data: &[] }.emit()
    }

    #[test]
    fn only_answered_transfers_are_open() {
        let after = |frame: RequestFrame<'_>| Abort::after(&frame.emit()).map(|abandon| abandon.is_open());
        assert_eq!(after(SAVE), Some(false));
        assert_eq!(after(RequestFrame { ack: true, block: 3, data: &[], ..SAVE }), Some(true));
        assert_eq!(after(RequestFrame { ack: true, block: LAST_BLOCK | 3, data: &[], ..SAVE }), None);
        assert_eq!(after(RequestFrame { service: service::DELETE, ..SAVE }), None);
    }

    #[test]
    fn refusal_confirms_the_abort_and_silence_does_not() {
        let ack = RequestFrame { ack: true, block: 3, data: &[], ..SAVE }.emit();
        let mut session = Abort::after(&ack).unwrap();
        let frame = sent(&mut session, ms(0));
        let parsed = RequestFrame::parse(&frame).unwrap();
        assert_eq!((parsed.id, parsed.block, parsed.data, parsed.ack), (7, 0x7FFF_FFFF, &[][..], true));
        session.handle(ms(5), &answer(7, Status::OK));
        session.handle(ms(6), &answer(8, Status::refused(0xE4A2)));
        session.handle(ms(7), &answer(7, Status::refused(0xE444)));
        assert_eq!(session.poll(ms(7)), Step::Wait(ms(200)));
        assert_eq!(sent(&mut session, ms(200)), frame);
        session.handle(ms(210), &answer(7, Status::refused(0xE4A2)));
        assert!(done(&mut session, ms(210)));

        let mut session = Abort::after(&ack).unwrap();
        for at in [0, 200, 400] {
            sent(&mut session, ms(at));
        }
        assert!(!done(&mut session, ms(600)));
    }
}

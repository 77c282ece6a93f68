//! Exchange of one request and its answer (DX 3.2.1, 3.2.2, 3.2.6).

use std::time::Duration;

use super::super::wire::{AnswerFrame, RequestFrame, Status};
use super::{Counters, Due, Ids, Inbox, Policy, RepeatTiming, count, is_busy, is_damaged};
use crate::{Now, Session, Step};

/// Answer of a controller. A refusal is also an answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reply {
    /// Result code.
    pub status: Status,
    /// Data part, 0 to 479 bytes.
    pub data: Vec<u8>,
    /// Time from the first attempt to the answer.
    pub elapsed: Duration,
    /// Number of attempts.
    pub attempts: u32,
}

/// Outcome of an exchange.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Ended {
    /// The controller answered. The status of the reply shows whether the controller accepted the request.
    Answered(Reply),
    /// No answer to a request that can be repeated without harm.
    NoAnswer(Counters),
    /// No answer to a request that changes something. The controller may or may not have carried out the request.
    OutcomeUnknown(Counters),
}

/// A request and its answer.
#[derive(Debug, Clone)]
pub struct Exchange {
    inbox: Inbox,
    pace: RepeatTiming,
    repeatable: bool,
    started: Option<Now>,
    attempts: u32,
    /// The last refusal after which the request is repeated: the controller was busy, or the request arrived damaged.
    busy: Option<Reply>,
    /// Whether the last attempt was refused in this way. The session then waits before the next attempt.
    pausing: bool,
    ended: Option<Ended>,
}

impl Exchange {
    /// Creates a session that sends `request`. The id of the request is replaced by an id from `ids`. A `repeatable`
    /// request is repeated after a timeout.
    ///
    /// # Panics
    /// If the data of `request` is too long for a frame.
    pub fn new(request: &RequestFrame<'_>, repeatable: bool, policy: Policy, ids: &Ids) -> Self {
        Self {
            inbox: Inbox::new(request, ids),
            pace: RepeatTiming::new(policy),
            repeatable,
            started: None,
            attempts: 0,
            busy: None,
            pausing: false,
            ended: None,
        }
    }

    /// Unexpected events so far.
    pub fn counters(&self) -> Counters {
        self.inbox.counters
    }

    fn send(&mut self, now: Now) -> Step<Ended> {
        self.attempts = self.attempts.saturating_add(1);
        self.pace.sent(now, self.repeatable);
        Step::Send(self.inbox.request.clone())
    }

    fn again(&mut self, now: Now) -> Step<Ended> {
        if self.pausing {
            self.pausing = false;
            self.inbox.renew();
        } else {
            self.pace.repeat();
            count(&mut self.inbox.counters.repeats);
        }
        self.send(now)
    }

    fn expire(&mut self) -> Ended {
        let counters = self.inbox.counters;
        match self.busy.take() {
            Some(busy) if self.pausing || self.repeatable => Ended::Answered(busy),
            _ if self.repeatable => Ended::NoAnswer(counters),
            _ => Ended::OutcomeUnknown(counters),
        }
    }

    fn reply(&self, now: Now, answer: &AnswerFrame<'_>) -> Reply {
        Reply {
            status: answer.status,
            data: answer.data.to_vec(),
            elapsed: now.saturating_sub(self.started.unwrap_or(now)),
            attempts: self.attempts,
        }
    }
}

impl Session for Exchange {
    type Outcome = Ended;

    fn poll(&mut self, now: Now) -> Step<Ended> {
        if let Some(ended) = &self.ended {
            return Step::Done(ended.clone());
        }
        if self.started.is_none() {
            self.started = Some(now);
            self.pace.restart(now);
            return self.send(now);
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
        let Some(answer) = self.inbox.answer(bytes) else { return };
        if self.started.is_none() {
            return count(&mut self.inbox.counters.foreign);
        }
        if self.ended.is_some() {
            return count(&mut self.inbox.counters.duplicated);
        }
        let damaged = self.repeatable && is_damaged(answer.status);
        if !damaged && !is_busy(answer.status) {
            // An answer to an earlier id also counts. If the network duplicated the request, the controller refused one
            // copy and carried out the other copy.
            self.ended = Some(Ended::Answered(self.reply(now, &answer)));
        } else if answer.id != self.inbox.id {
            count(&mut self.inbox.counters.late);
        } else if self.pausing {
            count(&mut self.inbox.counters.duplicated);
        } else {
            let counters = &mut self.inbox.counters;
            count(if damaged { &mut counters.damaged } else { &mut counters.busy });
            let reply = self.reply(now, &answer);
            if self.pace.pause(now) {
                self.pausing = true;
                self.busy = Some(reply);
            } else {
                self.ended = Some(Ended::Answered(reply));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::wire::{Division, LAST_BLOCK};
    use super::super::testing::{FILE_REQUEST, under_id};
    use super::*;
    use crate::testing::{done, hex, ms, sent};

    const READ: RequestFrame<'static> = RequestFrame {
        division: Division::Robot,
        command: 0x72,
        instance: 1,
        service: 0x01,
        data: &[],
        ..FILE_REQUEST
    };
    const START: RequestFrame<'static> =
        RequestFrame { command: 0x86, attribute: 1, service: 0x10, data: &[1, 0, 0, 0], ..READ };

    fn answer(request: &RequestFrame<'_>, id: u8, status: Status, data: &[u8]) -> Vec<u8> {
        let service = request.service | 0x80;
        AnswerFrame { division: request.division, ack: true, id, block: LAST_BLOCK, service, status, data }.emit()
    }

    fn start(request: &RequestFrame<'_>, repeatable: bool) -> Exchange {
        Exchange::new(request, repeatable, Policy::default(), &Ids::default())
    }

    #[test]
    fn delete_as_in_section_3_2_6() {
        let request = RequestFrame { service: 0x09, ..FILE_REQUEST };
        let mut session = Exchange::new(&request, false, Policy::default(), &Ids::starting_at(0x0B));
        assert_eq!(
            sent(&mut session, ms(0)),
            hex("5945524320000b000302000b0000000039393939393939390000000000090000544553544a4f422e4a4249")
        );
        assert_eq!(session.poll(ms(0)), Step::Wait(ms(3000)));
        session.handle(ms(12), &hex("59455243200000000302010b0000008039393939393939398900000000000000"));
        let reply = Reply { status: Status::OK, data: vec![], elapsed: ms(12), attempts: 1 };
        assert_eq!(done(&mut session, ms(12)), Ended::Answered(reply));
        assert_eq!(session.counters(), Counters::default());
    }

    #[test]
    fn read_repeats_with_the_same_id_and_accepts_any_answer() {
        let mut session = start(&READ, true);
        let first = sent(&mut session, ms(0));
        assert_eq!(session.poll(ms(1)), Step::Wait(ms(300)));
        assert_eq!(sent(&mut session, ms(300)), first);
        let frame = answer(&READ, 0, Status::OK, &[7; 8]);
        session.handle(ms(310), &frame);
        session.handle(ms(311), &frame);
        let Ended::Answered(reply) = done(&mut session, ms(311)) else { panic!("not answered") };
        assert_eq!((reply.data, reply.elapsed, reply.attempts), (vec![7; 8], ms(310), 2));
        assert_eq!(session.counters(), Counters { repeats: 1, duplicated: 1, ..Counters::default() });
    }

    #[test]
    fn unanswered_read_ends_at_its_deadline() {
        let mut session = start(&READ, true);
        for at in [0, 300, 900, 2100] {
            sent(&mut session, ms(at));
        }
        assert_eq!(session.poll(ms(5099)), Step::Wait(ms(5100)));
        let counters = Counters { repeats: 3, ..Counters::default() };
        assert_eq!(done(&mut session, ms(5100)), Ended::NoAnswer(counters));
    }

    #[test]
    fn change_is_sent_once_and_a_lost_answer_is_an_unknown_outcome() {
        let mut session = start(&START, false);
        sent(&mut session, ms(0));
        for at in (0..3000).step_by(100) {
            assert_eq!(session.poll(ms(at)), Step::Wait(ms(3000)));
        }
        assert_eq!(done(&mut session, ms(3000)), Ended::OutcomeUnknown(Counters::default()));
        session.handle(ms(3001), &answer(&START, 0, Status::OK, &[]));
        assert_eq!(done(&mut session, ms(3001)), Ended::OutcomeUnknown(Counters::default()));
    }

    #[test]
    fn a_refusal_is_an_answer() {
        let mut session = start(&START, false);
        sent(&mut session, ms(0));
        session.handle(ms(9), &answer(&START, 0, Status::refused(0x2010), &[]));
        let Ended::Answered(reply) = done(&mut session, ms(9)) else { panic!("not answered") };
        assert_eq!(reply.status, Status::refused(0x2010));
    }

    #[test]
    fn repeats_after_busy_with_a_new_id() {
        let mut session = start(&START, false);
        let first = sent(&mut session, ms(0));
        let busy = answer(&START, 0, Status::refused(0xD8FA), &[]);
        session.handle(ms(10), &busy);
        session.handle(ms(11), &busy);
        assert_eq!(session.poll(ms(11)), Step::Wait(ms(110)));
        let second = sent(&mut session, ms(110));
        assert_eq!((first[11], second[11]), (0, 1));
        assert_eq!((&first[..11], &first[12..]), (&second[..11], &second[12..]));
        // The third copy of the earlier refusal must not cause a third request.
        session.handle(ms(111), &busy);
        assert_eq!(session.poll(ms(111)), Step::Wait(ms(3110)));
        session.handle(ms(120), &answer(&START, 1, Status::OK, &[]));
        let Ended::Answered(reply) = done(&mut session, ms(120)) else { panic!("not answered") };
        assert_eq!((reply.status, reply.attempts), (Status::OK, 2));
        assert_eq!(session.counters(), Counters { busy: 1, duplicated: 1, late: 1, ..Counters::default() });
    }

    #[test]
    fn repeats_a_damaged_read_but_not_a_damaged_change() {
        for added in [0xE4A5, 0xE4A6, 0xE4A7] {
            let status = Status::refused(added);
            let mut session = start(&READ, true);
            sent(&mut session, ms(0));
            session.handle(ms(5), &answer(&READ, 0, status, &[]));
            assert_eq!(session.poll(ms(5)), Step::Wait(ms(105)));
            assert_eq!(sent(&mut session, ms(105))[11], 1);
            session.handle(ms(110), &answer(&READ, 1, Status::OK, &[7]));
            let Ended::Answered(reply) = done(&mut session, ms(110)) else { panic!("not answered") };
            assert_eq!((reply.status, reply.data), (Status::OK, vec![7]));
            assert_eq!(session.counters(), Counters { damaged: 1, ..Counters::default() });

            let mut session = start(&START, false);
            sent(&mut session, ms(0));
            session.handle(ms(5), &answer(&START, 0, status, &[]));
            let Ended::Answered(reply) = done(&mut session, ms(5)) else { panic!("not answered") };
            assert_eq!(reply.status, status);
        }
    }

    #[test]
    fn error_quotes_a_controller_that_stays_busy() {
        for repeatable in [true, false] {
            let ids = Ids::default();
            let mut session = Exchange::new(&START, repeatable, Policy::default(), &ids);
            let (mut now, mut sends) = (ms(0), 0_u8);
            let outcome = loop {
                match session.poll(now) {
                    Step::Send(frame) => {
                        assert_eq!(frame[11], sends);
                        session.handle(now, &answer(&START, sends, Status::refused(0xE444), &[]));
                        sends += 1;
                    }
                    Step::Wait(until) => now = until,
                    Step::Done(outcome) => break outcome,
                    other => panic!("{other:?}"),
                }
            };
            // Pauses of 100, 200, 400 and 800 ms, and three pauses of 1 s. One more pause of 1 s would leave no time
            // for an answer.
            assert_eq!((sends, now), (8, ms(4500)));
            let Ended::Answered(reply) = outcome else { panic!("not answered") };
            assert_eq!((reply.status, reply.attempts), (Status::refused(0xE444), 8));
        }
    }

    #[test]
    fn change_lost_after_busy_has_an_unknown_outcome() {
        let mut session = start(&START, false);
        sent(&mut session, ms(0));
        session.handle(ms(10), &answer(&START, 0, Status::refused(0xFFF6), &[]));
        sent(&mut session, ms(110));
        assert_eq!(done(&mut session, ms(3110)), Ended::OutcomeUnknown(Counters { busy: 1, ..Counters::default() }));
    }

    #[test]
    fn answer_to_a_duplicated_request_ends_the_pause() {
        let mut session = start(&START, false);
        sent(&mut session, ms(0));
        session.handle(ms(10), &answer(&START, 0, Status::refused(0xD8F1), &[]));
        session.handle(ms(20), &answer(&START, 0, Status::OK, &[]));
        let Ended::Answered(reply) = done(&mut session, ms(20)) else { panic!("not answered") };
        assert_eq!((reply.status, reply.attempts), (Status::OK, 1));
    }

    #[test]
    fn counts_other_traffic_by_class() {
        let ids = Ids::starting_at(40);
        let mut session = Exchange::new(&READ, true, Policy::default(), &ids);
        sent(&mut session, ms(0));
        let good = answer(&READ, 40, Status::OK, &[1; 8]);
        let changed = |offset: usize, value: u8| {
            let mut frame = good.clone();
            frame[offset] = value;
            frame
        };
        let longer = [good.as_slice(), &[0]].concat();
        let bad = [
            good[..31].to_vec(),
            good[..39].to_vec(),
            longer,
            vec![0; 512],
            changed(0, b'X'),
            changed(4, 0x21),
            changed(9, 2),
            changed(10, 0),
            changed(24, 0x8E),
            under_id(&good, 41),
            under_id(&good, 39),
        ];
        for frame in &bad {
            session.handle(ms(5), frame);
        }
        assert_eq!(session.poll(ms(5)), Step::Wait(ms(300)));
        let expected = Counters { truncated: 2, oversized: 2, garbage: 2, foreign: 4, late: 1, ..Counters::default() };
        assert_eq!(session.counters(), expected);
        session.handle(ms(6), &good);
        assert!(matches!(done(&mut session, ms(6)), Ended::Answered(_)));
    }

    #[test]
    fn the_block_number_of_an_answer_is_not_enforced() {
        let mut session = start(&READ, true);
        sent(&mut session, ms(0));
        let mut frame = answer(&READ, 0, Status::OK, &[1; 8]);
        frame[15] = 0;
        session.handle(ms(6), &frame);
        assert!(matches!(done(&mut session, ms(6)), Ended::Answered(_)));
    }
}

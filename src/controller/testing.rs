//! Test helpers of all families: times, bytes, and steps of sessions in virtual time.

use std::fmt::Debug;
use std::time::Duration;

use crate::{Now, Session, Step};

pub(crate) const fn ms(millis: u64) -> Now {
    Duration::from_millis(millis)
}

#[track_caller]
pub(crate) fn hex(digits: &str) -> Vec<u8> {
    crate::text::unhex(digits).unwrap_or_else(|| panic!("no bytes: {digits}"))
}

/// The frame that a session sends now.
#[track_caller]
pub(crate) fn sent<S: Session<Outcome: Debug>>(session: &mut S, now: Now) -> Vec<u8> {
    match session.poll(now) {
        Step::Send(frame) => frame,
        other => panic!("expected a frame to send at {now:?}, not {other:?}"),
    }
}

/// The outcome of a session that has ended.
#[track_caller]
pub(crate) fn done<S: Session<Outcome: Debug>>(session: &mut S, now: Now) -> S::Outcome {
    match session.poll(now) {
        Step::Done(outcome) => outcome,
        other => panic!("expected the end at {now:?}, not {other:?}"),
    }
}

/// The deadline of a waiting session.
#[track_caller]
pub(crate) fn waits<S: Session<Outcome: Debug>>(session: &mut S, now: Now) -> Now {
    match session.poll(now) {
        Step::Wait(until) => until,
        other => panic!("expected a wait at {now:?}, not {other:?}"),
    }
}

//! Protocol sessions: a request with its answer, a download of a file or list, an upload of a file.
//!
//! Datagrams may be lost, duplicated, late or damaged. The manuals do not cover these cases, so these rules apply:
//!
//! - **Reads are repeated, changes are not.** A change is sent once. Without an answer, the outcome of the change is
//!   unknown and is reported as unknown. The exception is a busy refusal, which states that the controller did nothing.
//! - **A damaged read is repeated** like a lost one.
//! - **After a busy refusal, a request is repeated under a new id.** The controller may carry out the repeat. With the
//!   old id, the session could mistake a late copy of the old refusal for a refusal of the repeat.
//! - **A transfer keeps one id** and is stop-and-wait. A session repeats its last frame only after a timeout, and never
//!   after a duplicate. If both sides answered each copy with a copy, the traffic would multiply until the end of the
//!   file.
//! - **Blocks must arrive in order.** A gap ends a transfer.
//! - **An aborted transfer is ended at the controller too.** Otherwise the controller refuses other transfers until its
//!   timer expires.
//! - Frames that belong to no open request are counted by class ([`Counters`]) and ignored.
//!
//! The driver must check the sender of each datagram. It may pass only frames from the address and port of the
//! controller.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

use super::status;
use super::wire::{ANSWER_BIT, AnswerFrame, RequestFrame, Status, WireError};
use crate::Now;

mod abort;
mod download;
mod exchange;
mod upload;

pub use abort::Abort;
pub use download::{Download, DownloadEnd, Violation};
pub use exchange::{Ended, Exchange, Reply};
pub use upload::{Upload, UploadEnd};

/// Pause after the first busy refusal. The pause doubles with each further refusal, up to [`MAX_PAUSE`].
const FIRST_PAUSE: Duration = Duration::from_millis(100);
const MAX_PAUSE: Duration = Duration::from_secs(1);

/// If the id of a frame is at most this far behind the id of a session, the frame belongs to an earlier session and is
/// late.
const LATE_WINDOW: u8 = 32;

/// Whether the controller refused a request only because it was busy.
pub fn is_busy(result: Status) -> bool {
    !result.is_ok() && status::is_busy(result.added)
}

/// Whether the controller refused a damaged frame: wrong header size, identifier or stated size (DX 5).
pub fn is_damaged(result: Status) -> bool {
    !result.is_ok() && matches!(result.added, 0xE4A5..=0xE4A7)
}

/// Time limits and number of attempts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// Time limit of an attempt. Only the last attempt waits for all of this time.
    pub timeout: Duration,
    /// Time until the first repeat, if it is shorter than `timeout`.
    pub attempt: Duration,
    /// Whether the time until a repeat doubles with each repeat, up to `timeout`.
    pub duplicates: bool,
    /// Maximum number of repeats after a timeout.
    pub retries: u32,
}

impl Default for Policy {
    /// A controller answers within 20 ms. With these values, a frame is sent after 0, 0.3, 0.9 and 2.1 s, and the
    /// session ends after 5.1 s.
    fn default() -> Self {
        Self { timeout: Duration::from_secs(3), attempt: Duration::from_millis(300), duplicates: true, retries: 3 }
    }
}

impl Policy {
    /// Sets the time limit of an attempt and the number of repeats.
    #[must_use]
    pub const fn with(self, timeout: Duration, retries: u32) -> Self {
        Self { timeout, retries, ..self }
    }

    /// Total time for a repeatable frame. It is at most `timeout` times (`retries` + 1).
    pub fn patience(&self) -> Duration {
        // After 32 doublings, the time no longer grows.
        let growing = self.retries.min(u32::BITS);
        let grown = (0..growing).map(|tries| self.silence(tries)).fold(Duration::ZERO, Duration::saturating_add);
        let longest = self.silence(growing).saturating_mul(self.retries - growing);
        grown.saturating_add(longest).saturating_add(self.timeout)
    }

    /// Time until the next repeat, after `tries` repeats.
    fn silence(&self, tries: u32) -> Duration {
        let doubled = if self.duplicates { 1_u32.checked_shl(tries).unwrap_or(u32::MAX) } else { 1 };
        self.attempt.saturating_mul(doubled).min(self.timeout)
    }
}

/// Request ids of a client: 0 to 255, then 0 again. Clones share the sequence.
#[derive(Debug, Clone, Default)]
pub struct Ids(Arc<AtomicU8>);

impl Ids {
    /// Starts with `first`; [`Ids::default`] starts with 0.
    pub fn starting_at(first: u8) -> Self {
        Self(Arc::new(AtomicU8::new(first)))
    }

    /// Id of the next command.
    pub fn next_id(&self) -> u8 {
        // An atomic addition wraps around at 255, like the ids.
        self.0.fetch_add(1, Ordering::Relaxed)
    }
}

/// Counters of unexpected events.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Frames that answer an earlier request of this client.
    pub late: u32,
    /// Frames that answer no request of this client. They have another id, service or server, or are not answers.
    pub foreign: u32,
    /// Duplicates of accepted frames.
    pub duplicated: u32,
    /// Datagrams shorter than stated, or too short for a frame.
    pub truncated: u32,
    /// Datagrams longer than stated, or too long for a frame.
    pub oversized: u32,
    /// Other invalid datagrams.
    pub garbage: u32,
    /// Frames repeated after a timeout.
    pub repeats: u32,
    /// Busy refusals.
    pub busy: u32,
    /// Refusals of a damaged request.
    pub damaged: u32,
}

impl Counters {
    fn named(&self) -> [(u32, &'static str); 9] {
        [
            (self.late, "late"),
            (self.foreign, "foreign"),
            (self.duplicated, "duplicated"),
            (self.truncated, "truncated"),
            (self.oversized, "oversized"),
            (self.garbage, "garbage"),
            (self.repeats, "repeated"),
            (self.busy, "busy"),
            (self.damaged, "damaged in transit"),
        ]
    }

    /// Sum of all counters.
    pub fn total(&self) -> u64 {
        self.named().iter().map(|&(count, _)| u64::from(count)).sum()
    }

    /// Whether any datagrams arrived. They contained no valid answer, but they show that a peer exists.
    pub fn heard_something(&self) -> bool {
        self.named().iter().any(|&(count, name)| count > 0 && name != "repeated")
    }

    /// Whether datagrams arrived that are not answers in this protocol.
    pub fn is_garbage(&self) -> bool {
        [self.garbage, self.truncated, self.oversized, self.foreign].iter().any(|&count| count > 0)
    }
}

impl fmt::Display for Counters {
    /// Formats the counters that are not zero, for example "2 foreign, 1 truncated". If all are 0, the text is
    /// "nothing".
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for (count, name) in self.named().into_iter().filter(|&(count, _)| count > 0) {
            write!(f, "{separator}{count} {name}")?;
            separator = ", ";
        }
        if separator.is_empty() { f.write_str("nothing") } else { Ok(()) }
    }
}

/// Copies a frame and replaces its id.
fn with_id(frame: &[u8], id: u8) -> Vec<u8> {
    let frame = RequestFrame::parse(frame).expect("sessions build their frames with emit");
    RequestFrame { id, ..frame }.emit()
}

/// Adds one. The counter saturates, so that many datagrams cannot overflow it.
fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

/// Filter that selects the answers to a request from all received datagrams.
#[derive(Debug, Clone)]
struct Inbox {
    request: Vec<u8>,
    ids: Ids,
    id: u8,
    /// Earlier ids of this session, in the order of use.
    previous_ids: Vec<u8>,
    counters: Counters,
}

/// Number of earlier ids to remember.
const FORMER_IDS: usize = 8;

impl Inbox {
    /// Creates a filter for the answers to `request`. The id of the request is replaced by an id from `ids`.
    fn new(request: &RequestFrame<'_>, ids: &Ids) -> Self {
        let id = ids.next_id();
        let request = RequestFrame { id, ..*request }.emit();
        Self { request, ids: ids.clone(), id, previous_ids: Vec::new(), counters: Counters::default() }
    }

    fn request(&self) -> RequestFrame<'_> {
        RequestFrame::parse(&self.request).expect("the inbox built this frame with emit")
    }

    /// Assigns a new id. After this call, an answer to the old id is late.
    fn renew(&mut self) {
        if self.previous_ids.len() == FORMER_IDS {
            self.previous_ids.remove(0);
        }
        self.previous_ids.push(self.id);
        self.id = self.ids.next_id();
        self.request = with_id(&self.request, self.id);
    }

    /// Parses an answer to the current id or an earlier id. Any other datagram is counted.
    fn answer<'a>(&mut self, bytes: &'a [u8]) -> Option<AnswerFrame<'a>> {
        let counters = &mut self.counters;
        let answer = match AnswerFrame::parse(bytes) {
            Ok(answer) => answer,
            Err(error) => {
                count(match error {
                    WireError::Truncated(_) => &mut counters.truncated,
                    WireError::DataSize { stated, present } if stated > present => &mut counters.truncated,
                    WireError::Oversized(_) | WireError::DataSize { .. } => &mut counters.oversized,
                    _ => &mut counters.garbage,
                });
                return None;
            }
        };
        let request = RequestFrame::parse(&self.request).expect("the inbox built this frame with emit");
        let fits = answer.division == request.division && answer.ack && answer.service == request.service | ANSWER_BIT;
        let own = answer.id == self.id || self.previous_ids.contains(&answer.id);
        if fits && own {
            return Some(answer);
        }
        let behind = self.id.wrapping_sub(answer.id);
        let late = answer.ack && (1..=LATE_WINDOW).contains(&behind);
        count(if late { &mut counters.late } else { &mut counters.foreign });
        None
    }

    /// Parses an answer like [`Inbox::answer`], but accepts only the current id.
    fn current<'a>(&mut self, bytes: &'a [u8]) -> Option<AnswerFrame<'a>> {
        let answer = self.answer(bytes)?;
        if answer.id == self.id {
            return Some(answer);
        }
        count(&mut self.counters.late);
        None
    }
}

/// Timing of repeats.
#[derive(Debug, Clone)]
struct RepeatTiming {
    policy: Policy,
    /// Deadline of a frame, including all its repeats.
    patience: Now,
    /// End of the current wait.
    deadline: Now,
    repeat_at: Option<Now>,
    /// Number of repeats of the current frame after a timeout.
    repeats: u32,
    pause: Duration,
}

/// Timer state of a session that waits for an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Due {
    Nothing { before: Now },
    Repeat,
    Expired,
}

impl RepeatTiming {
    fn new(policy: Policy) -> Self {
        Self { policy, patience: Now::ZERO, deadline: Now::ZERO, repeat_at: None, repeats: 0, pause: FIRST_PAUSE }
    }

    /// Restarts the total time limit, for a new frame.
    fn restart(&mut self, now: Now) {
        self.patience = now.saturating_add(self.policy.patience());
        self.repeat_at = None;
        self.repeats = 0;
        self.pause = FIRST_PAUSE;
    }

    /// Records that a frame was sent. It is sent again after a timeout only if it is `repeatable`.
    fn sent(&mut self, now: Now, repeatable: bool) {
        let more = repeatable && self.repeats < self.policy.retries;
        self.repeat_at = more.then(|| now.saturating_add(self.policy.silence(self.repeats)));
        self.deadline = if repeatable { self.patience } else { now.saturating_add(self.policy.timeout) };
    }

    /// Records that a frame was sent. It is not repeated, and its answer may take as long as `wait`.
    fn sent_for(&mut self, now: Now, wait: Duration) {
        self.repeat_at = None;
        self.deadline = now.saturating_add(wait);
    }

    /// Records a repeat after a timeout.
    fn repeat(&mut self) {
        self.repeats = self.repeats.saturating_add(1);
    }

    /// Schedules a pause before a repeat. Returns `false` if the pause would leave no time for an answer.
    fn pause(&mut self, now: Now) -> bool {
        let resume = now.saturating_add(self.pause);
        if resume.saturating_add(self.policy.silence(0)) > self.patience {
            return false;
        }
        self.deadline = self.patience;
        self.pause = self.pause.saturating_mul(2).min(MAX_PAUSE);
        self.repeat_at = Some(resume);
        self.repeats = 0;
        true
    }

    fn due(&self, now: Now) -> Due {
        if now >= self.deadline {
            return Due::Expired;
        }
        match self.repeat_at {
            Some(at) if at <= now => Due::Repeat,
            Some(at) => Due::Nothing { before: at.min(self.deadline) },
            None => Due::Nothing { before: self.deadline },
        }
    }
}

#[cfg(test)]
mod testing {
    //! Shared test helpers of the sessions.

    use super::*;
    use crate::yerc::wire::Division;

    /// A request to the file server, without a service.
    pub(super) const FILE_REQUEST: RequestFrame<'static> = RequestFrame {
        division: Division::File,
        ack: false,
        id: 0,
        block: 0,
        command: 0,
        instance: 0,
        attribute: 0,
        service: 0,
        data: b"TESTJOB.JBI",
    };

    /// Copies an answer and replaces its id. The examples of the manual increment the id within a transfer.
    pub(super) fn under_id(frame: &[u8], id: u8) -> Vec<u8> {
        let frame = AnswerFrame::parse(frame).unwrap();
        AnswerFrame { id, ..frame }.emit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::ms;

    #[test]
    fn ids_start_at_0_and_wrap() {
        let ids = Ids::default();
        assert_eq!(ids.next_id(), 0);
        let others = ids.clone();
        for expected in 1..=255 {
            assert_eq!(others.next_id(), expected);
        }
        assert_eq!(ids.next_id(), 0);
    }

    #[test]
    fn counters_list_only_observed_classes() {
        assert_eq!(Counters::default().to_string(), "nothing");
        let counters = Counters { foreign: 2, truncated: 1, ..Counters::default() };
        assert_eq!(counters.to_string(), "2 foreign, 1 truncated");
        assert!(counters.heard_something());
        assert!(!Counters { repeats: 3, ..Counters::default() }.heard_something());
    }

    #[test]
    fn repeat_interval_doubles_until_the_deadline() {
        let mut pace = RepeatTiming::new(Policy::default());
        pace.restart(ms(0));
        let mut sends = Vec::new();
        let mut now = ms(0);
        pace.sent(now, true);
        for _ in 0..10 {
            match pace.due(now) {
                Due::Nothing { before } => now = before,
                Due::Repeat => {
                    pace.repeat();
                    pace.sent(now, true);
                    sends.push(now);
                }
                Due::Expired => break,
            }
        }
        assert_eq!(sends, [ms(300), ms(900), ms(2100)]);
        assert_eq!(now, ms(5100));
    }

    #[test]
    fn each_try_has_the_full_timeout() {
        let patience = |timeout, retries| Policy::default().with(ms(timeout), retries).patience();
        assert_eq!(patience(300, 4), ms(5 * 300));
        assert_eq!(patience(100, 9), ms(10 * 100));
        assert_eq!(patience(3000, 0), ms(3000));
        assert_eq!(patience(3000, 1), ms(300 + 3000));
        assert_eq!(patience(1000, 40), ms(300 + 600 + 39 * 1000));
        for (timeout, retries) in [(1, 0), (700, 3), (5000, 2), (60_000, 12), (250, 1_000_000)] {
            assert!(patience(timeout, retries) <= ms(timeout).saturating_mul(retries + 1));
        }
    }

    #[test]
    fn extreme_policies_neither_overflow_nor_hang() {
        let policy = Policy { timeout: Duration::MAX, attempt: Duration::MAX, duplicates: true, retries: u32::MAX };
        let mut pace = RepeatTiming::new(policy);
        pace.restart(Duration::MAX);
        pace.repeats = 40;
        pace.sent(Duration::MAX, true);
        assert_eq!(pace.due(Duration::MAX), Due::Expired);
        assert_eq!(pace.due(ms(0)), Due::Nothing { before: Duration::MAX });
    }

    #[test]
    fn only_four_added_codes_mean_busy() {
        for added in [0xD8F1, 0xD8FA, 0xE444, 0xFFF6] {
            assert!(is_busy(Status::refused(added)));
        }
        assert!(!is_busy(Status::refused(0x2100)));
        assert!(!is_busy(Status { code: 0, added_size: 1, added: 0xD8FA }));
    }
}

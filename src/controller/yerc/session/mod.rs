//! Conversations with a controller: one request and its answer, a file or list to the PC, a file to the controller.
//!
//! Datagrams get lost, doubled, late and damaged, and the manuals say nothing about any of it. The rules here:
//!
//! - **Reads repeat, changes do not.** A request that changes state leaves once; without an answer its outcome is
//!   unknown, and is said to be. The one exception is a busy refusal, which states that nothing was done.
//! - **A read that was damaged on its way goes out again** as one that was lost does.
//! - **A busy refusal is waited out under a new id.** A second copy of the old refusal can then never pass for a refusal
//!   of the request that followed it, which may well have been carried out.
//! - **A transfer keeps one id** and is stop-and-wait. Only silence makes a session send its last frame again, never a
//!   duplicate: two sides that answer every copy with a copy multiply the traffic until the end of the file.
//! - **Blocks come in order or not at all.** A gap ends a transfer; nothing is guessed.
//! - **A transfer that is broken off is ended at the controller too**, which else refuses others until its timer ends.
//! - Frames that do not belong here are counted by class ([`Counters`]) and ignored.
//!
//! Who sent a datagram is the driver's to check: only what comes from the controller's address and port belongs here.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};
use std::time::Duration;

use super::status;
use super::wire::{ANSWER_BIT, AnswerFrame, RequestFrame, Status, WireError};
use crate::Now;

mod abandon;
mod download;
mod exchange;
mod upload;

pub use abandon::Abandon;
pub use download::{Download, DownloadEnd, Violation};
pub use exchange::{Ended, Exchange, Reply};
pub use upload::{Upload, UploadEnd};

/// The pause after the first busy refusal; it doubles with each, up to [`LONGEST_PAUSE`].
const FIRST_PAUSE: Duration = Duration::from_millis(100);
const LONGEST_PAUSE: Duration = Duration::from_secs(1);

/// An id that is this many places behind that of a session belongs to one of its forerunners, and its frame came late.
const LATE_WINDOW: u8 = 32;

/// Whether a controller refused only because it was busy.
pub fn is_busy(result: Status) -> bool {
    !result.is_ok() && status::is_busy(result.added)
}

/// Whether a controller refused a frame that was damaged on its way: size of the header, identifier, stated size (DX 5).
pub fn is_damaged(result: Status) -> bool {
    !result.is_ok() && matches!(result.added, 0xE4A5..=0xE4A7)
}

/// How long to wait and how often to try.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Policy {
    /// The longest wait of one try for its answer. The last try has all of it.
    pub timeout: Duration,
    /// Silence before the first further try, if that is shorter.
    pub attempt: Duration,
    /// Whether that silence doubles with each further try, up to `timeout`.
    pub doubles: bool,
    /// Most further tries of the same frame after silence.
    pub retries: u32,
}

impl Default for Policy {
    /// A controller answers within 20 ms. With these, a frame goes out after 0, 0.3, 0.9 and 2.1 s and is given up
    /// after 5.1 s.
    fn default() -> Self {
        Self { timeout: Duration::from_secs(3), attempt: Duration::from_millis(300), doubles: true, retries: 3 }
    }
}

impl Policy {
    /// The same with another wait for a try, and another number of further tries.
    #[must_use]
    pub const fn with(self, timeout: Duration, retries: u32) -> Self {
        Self { timeout, retries, ..self }
    }

    /// How long a frame that may be repeated is tried in all: `timeout` times (`retries` + 1) at most.
    pub fn patience(&self) -> Duration {
        // After so many doublings the silence does not grow any more.
        let growing = self.retries.min(u32::BITS);
        let grown = (0..growing).map(|tries| self.silence(tries)).fold(Duration::ZERO, Duration::saturating_add);
        let longest = self.silence(growing).saturating_mul(self.retries - growing);
        grown.saturating_add(longest).saturating_add(self.timeout)
    }

    /// The silence after so many further tries, before the next one.
    fn silence(&self, tries: u32) -> Duration {
        let doubled = if self.doubles { 1_u32.checked_shl(tries).unwrap_or(u32::MAX) } else { 1 };
        self.attempt.saturating_mul(doubled).min(self.timeout)
    }
}

/// The request ids of a client: 0 to 255, then 0 again. Clones draw from the same sequence.
#[derive(Debug, Clone, Default)]
pub struct Ids(Arc<AtomicU8>);

impl Ids {
    /// Ids that begin with `first`; [`Ids::default`] begins with 0.
    pub fn starting_at(first: u8) -> Self {
        Self(Arc::new(AtomicU8::new(first)))
    }

    /// The id of the next command.
    pub fn next_id(&self) -> u8 {
        // Adding to an atomic wraps around, as the ids do.
        self.0.fetch_add(1, Ordering::Relaxed)
    }
}

/// What a session saw and did beside the plain course of things.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Counters {
    /// Frames that answer an earlier request of this client.
    pub late: u32,
    /// Frames that answer nothing this client asked: other id, other service, other server, not marked as an answer.
    pub foreign: u32,
    /// Second copies of what had been taken before.
    pub duplicated: u32,
    /// Datagrams shorter than they say, or than any frame.
    pub truncated: u32,
    /// Datagrams longer than they say, or than any frame.
    pub oversized: u32,
    /// Datagrams that are no frames for another reason.
    pub garbage: u32,
    /// Frames sent again after silence.
    pub repeats: u32,
    /// Busy refusals.
    pub busy: u32,
    /// Refusals of a request that was damaged on its way.
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
            (self.damaged, "damaged on the way"),
        ]
    }

    /// All of them together.
    pub fn total(&self) -> u64 {
        self.named().iter().map(|&(count, _)| u64::from(count)).sum()
    }

    /// Whether datagrams arrived that were no answer, which tells "something else is there" from "nothing is there".
    pub fn heard_something(&self) -> bool {
        self.named().iter().any(|&(count, name)| count > 0 && name != "repeated")
    }

    /// Whether something came that is no answer of the protocol to anything asked.
    pub fn is_garbage(&self) -> bool {
        [self.garbage, self.truncated, self.oversized, self.foreign].iter().any(|&count| count > 0)
    }
}

impl fmt::Display for Counters {
    /// The counts that are not 0, as in "2 foreign, 1 truncated"; "nothing" if all are.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut separator = "";
        for (count, name) in self.named().into_iter().filter(|&(count, _)| count > 0) {
            write!(f, "{separator}{count} {name}")?;
            separator = ", ";
        }
        if separator.is_empty() { f.write_str("nothing") } else { Ok(()) }
    }
}

/// A copy of a frame of this client under another id.
fn with_id(frame: &[u8], id: u8) -> Vec<u8> {
    let frame = RequestFrame::parse(frame).expect("sessions build their frames with emit");
    RequestFrame { id, ..frame }.emit()
}

/// Adds one; a flood must not overflow a counter.
fn count(counter: &mut u32) {
    *counter = counter.saturating_add(1);
}

/// Tells the answers to a request from everything else.
#[derive(Debug, Clone)]
struct Inbox {
    request: Vec<u8>,
    ids: Ids,
    id: u8,
    /// Ids this session used before its present one, youngest last.
    former: Vec<u8>,
    counters: Counters,
}

/// Ids a session remembers of those it used before.
const FORMER_IDS: usize = 8;

impl Inbox {
    /// For the answers to `request`, whose id is replaced by one drawn from `ids`.
    fn new(request: &RequestFrame<'_>, ids: &Ids) -> Self {
        let id = ids.next_id();
        let request = RequestFrame { id, ..*request }.emit();
        Self { request, ids: ids.clone(), id, former: Vec::new(), counters: Counters::default() }
    }

    fn request(&self) -> RequestFrame<'_> {
        RequestFrame::parse(&self.request).expect("the inbox built this frame with emit")
    }

    /// Goes on under a new id; answers to the old one are late from now on.
    fn renew(&mut self) {
        if self.former.len() == FORMER_IDS {
            self.former.remove(0);
        }
        self.former.push(self.id);
        self.id = self.ids.next_id();
        self.request = with_id(&self.request, self.id);
    }

    /// The answer in a datagram, if it is one to this session's present or former ids; counts anything else.
    fn answer<'a>(&mut self, bytes: &'a [u8]) -> Option<AnswerFrame<'a>> {
        let counters = &mut self.counters;
        let answer = match AnswerFrame::parse(bytes) {
            Ok(answer) => answer,
            Err(error) => {
                count(match error {
                    WireError::Truncated { .. } => &mut counters.truncated,
                    WireError::DataSize { stated, present } if stated > present => &mut counters.truncated,
                    WireError::Oversized { .. } | WireError::DataSize { .. } => &mut counters.oversized,
                    _ => &mut counters.garbage,
                });
                return None;
            }
        };
        let request = RequestFrame::parse(&self.request).expect("the inbox built this frame with emit");
        let fits = answer.division == request.division && answer.ack && answer.service == request.service | ANSWER_BIT;
        let own = answer.id == self.id || self.former.contains(&answer.id);
        if fits && own {
            return Some(answer);
        }
        let behind = self.id.wrapping_sub(answer.id);
        let late = answer.ack && (1..=LATE_WINDOW).contains(&behind);
        count(if late { &mut counters.late } else { &mut counters.foreign });
        None
    }

    /// As [`Inbox::answer`], for the present id alone.
    fn current<'a>(&mut self, bytes: &'a [u8]) -> Option<AnswerFrame<'a>> {
        let answer = self.answer(bytes)?;
        if answer.id == self.id {
            return Some(answer);
        }
        count(&mut self.counters.late);
        None
    }
}

/// When a frame goes out again and when patience ends.
#[derive(Debug, Clone)]
struct Pace {
    policy: Policy,
    /// When patience ends with the frame and all its copies.
    patience: Now,
    /// When the present wait ends.
    deadline: Now,
    repeat_at: Option<Now>,
    /// Repeats of the present frame after silence.
    repeats: u32,
    pause: Duration,
}

/// What time it is for a session that waits for an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Due {
    Nothing { before: Now },
    Repeat,
    Expired,
}

impl Pace {
    fn new(policy: Policy) -> Self {
        Self { policy, patience: Now::ZERO, deadline: Now::ZERO, repeat_at: None, repeats: 0, pause: FIRST_PAUSE }
    }

    /// Patience starts anew.
    fn restart(&mut self, now: Now) {
        self.patience = now.saturating_add(self.policy.patience());
        self.repeat_at = None;
        self.repeats = 0;
        self.pause = FIRST_PAUSE;
    }

    /// A frame left, to be repeated after silence if `repeatable`; else it has one try.
    fn sent(&mut self, now: Now, repeatable: bool) {
        let more = repeatable && self.repeats < self.policy.retries;
        self.repeat_at = more.then(|| now.saturating_add(self.policy.silence(self.repeats)));
        self.deadline = if repeatable { self.patience } else { now.saturating_add(self.policy.timeout) };
    }

    /// A frame left that is not repeated, and whose answer takes as long as `wait`.
    fn sent_for(&mut self, now: Now, wait: Duration) {
        self.repeat_at = None;
        self.deadline = now.saturating_add(wait);
    }

    /// The last frame is about to leave again because of silence.
    fn repeat(&mut self) {
        self.repeats = self.repeats.saturating_add(1);
    }

    /// Makes room for a pause before the frame goes out again; `false` if patience ends before an answer could come.
    fn pause(&mut self, now: Now) -> bool {
        let resume = now.saturating_add(self.pause);
        if resume.saturating_add(self.policy.silence(0)) > self.patience {
            return false;
        }
        self.deadline = self.patience;
        self.pause = self.pause.saturating_mul(2).min(LONGEST_PAUSE);
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
    //! What the tests of the sessions share.

    use super::*;
    use crate::yerc::wire::Division;

    /// A request to the file server, of no service yet.
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

    /// An answer with changed id, for the places where the manual's example raises it within a transfer.
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
    fn counters_name_only_what_was_seen() {
        assert_eq!(Counters::default().to_string(), "nothing");
        let counters = Counters { foreign: 2, truncated: 1, ..Counters::default() };
        assert_eq!(counters.to_string(), "2 foreign, 1 truncated");
        assert!(counters.heard_something());
        assert!(!Counters { repeats: 3, ..Counters::default() }.heard_something());
    }

    #[test]
    fn silence_doubles_and_ends_with_the_deadline() {
        let mut pace = Pace::new(Policy::default());
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
    fn the_timeout_is_that_of_a_try_and_the_last_try_has_all_of_it() {
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
        let policy = Policy { timeout: Duration::MAX, attempt: Duration::MAX, doubles: true, retries: u32::MAX };
        let mut pace = Pace::new(policy);
        pace.restart(Duration::MAX);
        pace.repeats = 40;
        pace.sent(Duration::MAX, true);
        assert_eq!(pace.due(Duration::MAX), Due::Expired);
        assert_eq!(pace.due(ms(0)), Due::Nothing { before: Duration::MAX });
    }

    #[test]
    fn only_the_four_codes_beside_a_refusal_are_busy() {
        for added in [0xD8F1, 0xD8FA, 0xE444, 0xFFF6] {
            assert!(is_busy(Status::refused(added)));
        }
        assert!(!is_busy(Status::refused(0x2100)));
        assert!(!is_busy(Status { code: 0, added_size: 1, added: 0xD8FA }));
    }
}

//! Recordings: what a controller answered to reads over a time, and the replay of these answers by a simulator.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::Now;

/// Answers by request. Each family writes both as text: `recording` of the family, or the blocks of toyo.
pub type Answers = BTreeMap<String, String>;

/// Answers that a client received since they were last taken. The clones of a log share their content.
#[derive(Debug, Clone, Default)]
pub struct AnswerLog(Arc<Mutex<Answers>>);

impl AnswerLog {
    /// Adds the answer to a request, or replaces it.
    pub fn insert(&self, request: String, answer: String) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).insert(request, answer);
    }

    /// Removes and returns the answers.
    pub fn take(&self) -> Answers {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// What one poll of a controller found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Sample {
    /// Time after the start of the recording.
    pub at: Duration,
    /// Answers that differ from the earlier samples; `None` if the controller did not answer.
    pub answers: Option<Answers>,
}

/// Samples in the order of their times.
#[derive(Debug, Clone, Default)]
pub struct Recording {
    samples: Arc<[Sample]>,
    /// Whether the replay starts again at the end. Otherwise, the last sample stays.
    is_loop: bool,
}

impl Recording {
    /// Recording with these samples, whose times must not decrease.
    pub fn new(samples: Vec<Sample>, is_loop: bool) -> Self {
        Self { samples: samples.into(), is_loop }
    }
}

/// Start state of a simulator that can replay a recording. Every family implements this trait.
pub trait Replayable: Sized {
    /// The simulator gives the recorded answers, and its state follows them. It does not answer while the recorded
    /// controller did not answer.
    #[must_use]
    fn with_recording(self, recording: Recording) -> Self;
}

/// Shortest time of a pass of a loop.
const MIN_PASS: Duration = Duration::from_secs(1);

/// A running replay. Without a recording, nothing happens.
#[derive(Debug, Clone, Default)]
pub(crate) struct Replay {
    recording: Recording,
    /// Index of the next sample.
    next: usize,
    /// Start of the present pass.
    began: Now,
    /// The last recorded answer to each request.
    answers: Answers,
    is_silent: bool,
}

impl Replay {
    pub(crate) fn new(recording: Recording) -> Self {
        Self { recording, ..Self::default() }
    }

    /// Time of the next sample.
    pub(crate) fn due(&self) -> Option<Now> {
        let samples = &self.recording.samples;
        match samples.get(self.next) {
            // Before the first sample, nothing is known. So the first sample begins with the pass.
            Some(_) if self.next == 0 => Some(self.began),
            Some(sample) => Some(self.began.saturating_add(sample.at)),
            None if self.recording.is_loop && !samples.is_empty() => Some(self.end_of_pass()),
            None => None,
        }
    }

    /// Takes the next sample that is due at `now`. Returns its answers, which are empty if the controller was silent.
    pub(crate) fn take(&mut self, now: Now) -> Option<Answers> {
        self.due().filter(|due| *due <= now)?;
        if self.next == self.recording.samples.len() {
            (self.began, self.next) = (self.end_of_pass(), 0);
            self.answers.clear();
            return self.take(now).or_else(|| Some(Answers::new()));
        }
        let changed = self.recording.samples[self.next].answers.clone();
        self.next += 1;
        self.is_silent = changed.is_none();
        let changed = changed.unwrap_or_default();
        self.answers.extend(changed.clone());
        Some(changed)
    }

    /// Recorded answer to a request; `None` if the poller did not send this request so far.
    pub(crate) fn answer(&self, request: &str) -> Option<&str> {
        self.answers.get(request).map(String::as_str)
    }

    /// Removes recorded answers that are no longer valid.
    pub(crate) fn forget(&mut self, is_invalid: impl Fn(&str) -> bool) {
        self.answers.retain(|request, _| !is_invalid(request));
    }

    /// Whether the controller did not answer at this time.
    pub(crate) fn is_silent(&self) -> bool {
        self.is_silent
    }

    /// The last sample is shown as long as the one before.
    fn end_of_pass(&self) -> Now {
        let at = |back: usize| {
            let index = self.recording.samples.len().checked_sub(back);
            index.map_or(Duration::ZERO, |index| self.recording.samples[index].at)
        };
        let pass = at(1).saturating_add(at(1).saturating_sub(at(2)));
        self.began.saturating_add(pass.max(MIN_PASS))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn sample(seconds: u32, answers: Option<&[(&str, &str)]>) -> Sample {
        let owned = |(request, answer): &(&str, &str)| ((*request).to_owned(), (*answer).to_owned());
        Sample { at: SECOND * seconds, answers: answers.map(|answers| answers.iter().map(owned).collect()) }
    }

    fn samples() -> Vec<Sample> {
        vec![
            sample(0, Some(&[("a", "1"), ("b", "1")])),
            sample(2, Some(&[("a", "2")])),
            sample(3, None),
            sample(4, Some(&[])),
        ]
    }

    /// Answers to `a` and `b` at a time, and whether the controller is silent.
    fn at(replay: &mut Replay, now: Now) -> (Option<String>, Option<String>, bool) {
        while replay.take(now).is_some() {}
        let answer = |request| replay.answer(request).map(ToOwned::to_owned);
        (answer("a"), answer("b"), replay.is_silent())
    }

    #[test]
    fn gives_the_last_answer_and_holds_the_last_sample() {
        let mut replay = Replay::new(Recording::new(samples(), false));
        let answers = |a: &str, b: &str, is_silent| (Some(a.to_owned()), Some(b.to_owned()), is_silent);
        for (ms, expected) in [
            (0, answers("1", "1", false)),
            (1999, answers("1", "1", false)),
            (2000, answers("2", "1", false)),
            (3000, answers("2", "1", true)),
            (4000, answers("2", "1", false)),
            (90_000, answers("2", "1", false)),
        ] {
            assert_eq!(at(&mut replay, Now::from_millis(ms)), expected, "{ms}");
        }
        assert_eq!(replay.due(), None);
        replay.forget(|request| request == "b");
        assert_eq!((replay.answer("a"), replay.answer("b")), (Some("2"), None));
    }

    #[test]
    fn loop_starts_again_without_the_answers_of_the_last_pass() {
        let first = sample(0, Some(&[("a", "1")]));
        let samples = vec![first, sample(1, Some(&[("a", "2"), ("b", "2")]))];
        let mut replay = Replay::new(Recording::new(samples, true));
        assert_eq!(at(&mut replay, SECOND).1.as_deref(), Some("2"));
        assert_eq!(replay.due(), Some(2 * SECOND));
        assert_eq!(at(&mut replay, 2 * SECOND), (Some("1".to_owned()), None, false));
        assert_eq!(at(&mut replay, 5 * SECOND).0.as_deref(), Some("2"), "third pass");
        let mut empty = Replay::new(Recording::new(Vec::new(), true));
        assert_eq!((empty.due(), empty.take(SECOND)), (None, None));
        let mut single = Replay::new(Recording::new(vec![sample(0, None)], true));
        assert!(at(&mut single, SECOND).2 && single.due() == Some(2 * SECOND));
    }
}

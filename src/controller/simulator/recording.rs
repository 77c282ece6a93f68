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
    /// Time after which the replay starts again. Without it, the last sample stays.
    pass: Option<Duration>,
}

impl Recording {
    /// Recording with these samples, whose times must not decrease. After `pass`, which must not be 0, the replay starts
    /// again. Without it, the last sample stays.
    pub fn new(samples: Vec<Sample>, pass: Option<Duration>) -> Self {
        Self { samples: samples.into(), pass }
    }
}

/// Start state of a simulator that can replay a recording. Every family implements this trait.
pub trait Replayable: Sized {
    /// The simulator gives the recorded answers, and its state follows them. It does not answer while the recorded
    /// controller did not answer.
    #[must_use]
    fn with_recording(self, recording: Recording) -> Self;
}

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
    /// Whether the controller did not answer at this time.
    pub(crate) is_silent: bool,
}

impl Replay {
    pub(crate) fn new(recording: Recording) -> Self {
        Self { recording, ..Self::default() }
    }

    /// Time of the next sample.
    pub(crate) fn due(&self) -> Option<Now> {
        let Recording { samples, pass } = &self.recording;
        let after = match self.next_sample() {
            // Before the first sample, nothing is known. So the first sample begins with the pass.
            Some(_) if self.next == 0 => Some(Duration::ZERO),
            Some(sample) => Some(sample.at),
            None => pass.filter(|_| !samples.is_empty()),
        };
        after.map(|after| self.began.saturating_add(after))
    }

    /// Takes the next sample that is due at `now`. Returns its answers, which are empty if the controller was silent.
    pub(crate) fn take(&mut self, now: Now) -> Option<Answers> {
        self.due().filter(|due| *due <= now)?;
        if self.next_sample().is_none() {
            (self.began, self.next) = (self.due()?, 0);
            self.answers.clear();
        }
        let changed = self.next_sample()?.answers.clone();
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

    /// Next sample of the present pass.
    fn next_sample(&self) -> Option<&Sample> {
        let Recording { samples, pass } = &self.recording;
        samples.get(self.next).filter(|sample| self.next == 0 || pass.is_none_or(|pass| sample.at < pass))
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
        (answer("a"), answer("b"), replay.is_silent)
    }

    #[test]
    fn gives_the_last_answer_and_holds_the_last_sample() {
        let mut replay = Replay::new(Recording::new(samples(), None));
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
        let mut replay = Replay::new(Recording::new(samples.clone(), Some(2 * SECOND)));
        assert_eq!(at(&mut replay, SECOND).1.as_deref(), Some("2"));
        assert_eq!(replay.due(), Some(2 * SECOND));
        assert_eq!(at(&mut replay, 2 * SECOND), (Some("1".to_owned()), None, false));
        assert_eq!(at(&mut replay, 5 * SECOND).0.as_deref(), Some("2"), "third pass");
        let mut short = Replay::new(Recording::new(samples, Some(SECOND / 2)));
        assert_eq!(at(&mut short, 9 * SECOND).0.as_deref(), Some("1"), "the second sample is after the pass");
        assert_eq!(short.due(), Some(19 * SECOND / 2));
        let mut empty = Replay::new(Recording::new(Vec::new(), Some(SECOND)));
        assert_eq!((empty.due(), empty.take(SECOND)), (None, None));
        let mut single = Replay::new(Recording::new(vec![sample(0, None)], Some(SECOND)));
        assert!(at(&mut single, SECOND).2 && single.due() == Some(2 * SECOND));
    }
}

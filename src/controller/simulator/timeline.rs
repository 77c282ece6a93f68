//! Console lines with execution times.

use std::collections::VecDeque;
use std::time::Duration;

use crate::Now;

/// Pending lines, sorted by time.
#[derive(Debug, Clone, Default)]
pub(crate) struct Timeline(VecDeque<(Now, String)>);

impl Timeline {
    /// Time of the next line.
    pub(crate) fn due(&self) -> Option<Now> {
        self.0.front().map(|(at, _)| *at)
    }

    /// Takes the next line that is due at `now`.
    pub(crate) fn take(&mut self, now: Now) -> Option<String> {
        self.due().filter(|at| *at <= now)?;
        self.0.pop_front().map(|(_, line)| line)
    }
}

/// From lines with their times in milliseconds after the start, in any order.
impl FromIterator<(u64, String)> for Timeline {
    fn from_iter<I: IntoIterator<Item = (u64, String)>>(lines: I) -> Self {
        let mut lines: Vec<_> = lines.into_iter().map(|(ms, line)| (Duration::from_millis(ms), line)).collect();
        lines.sort_by_key(|(at, _)| *at);
        Self(lines.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn timeline_delivers_each_line_once_at_its_time() {
        let lines = [(20, "b"), (10, "a"), (20, "c")].map(|(ms, line)| (ms, line.to_owned()));
        let mut timeline = Timeline::from_iter(lines);
        let at = Duration::from_millis;
        assert_eq!((timeline.due(), timeline.take(at(9))), (Some(at(10)), None));
        let taken: Vec<String> = std::iter::from_fn(|| timeline.take(at(20))).collect();
        assert_eq!((taken, timeline.due()), (vec!["a".to_owned(), "b".to_owned(), "c".to_owned()], None));
    }
}

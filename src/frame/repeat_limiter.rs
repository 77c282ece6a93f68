//! Limiter of repeated log lines. Lines that a robot or a broker repeats are counted, and printed from time to time
//! with their count.

use std::collections::HashMap;
use std::time::{Duration, Instant};

use crate::output::log::Level;
use crate::settings::duration;

/// Period for which repeated lines are counted.
const WINDOW: Duration = Duration::from_secs(600);
/// Number of lines of one kind that are printed within the window. Further lines are only counted.
const BURST: u32 = 5;
/// Maximum number of distinct kinds of lines per peer. All other lines count as one kind, because a peer may choose the
/// text of its errors.
const MAX_KINDS: usize = 16;

/// A line for the log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Line {
    /// Priority of the line.
    pub level: Level,
    /// Text of the line.
    pub text: String,
    /// Names and values for the journal.
    pub fields: Vec<(String, String)>,
}

impl Line {
    /// Creates a line with these fields.
    pub fn new(level: Level, text: &str, fields: &[(&str, &str)]) -> Self {
        let fields = fields.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned()));
        Self { level, text: text.to_owned(), fields: fields.collect() }
    }

    /// Robot or broker that the line is about.
    fn peer(&self) -> Option<&(String, String)> {
        self.fields.iter().find(|(name, _)| name == "robot" || name == "broker")
    }
}

/// Count of the lines of one kind.
#[derive(Debug)]
struct LineCount {
    since: Instant,
    printed: u32,
    /// Last suppressed line, its time, and the number of suppressed lines of this kind.
    suppressed: Option<(Line, Instant, u64)>,
}

/// Limiter for log lines. It returns the lines that are to be printed.
#[derive(Debug, Default)]
pub struct RepeatLimiter {
    /// Counts by peer, and then by text. In the text, every number is replaced by `#`.
    counts: HashMap<(String, String), HashMap<String, LineCount>>,
}

impl RepeatLimiter {
    /// Returns the lines to print now: summaries that are due, and this line unless it is suppressed.
    pub fn lines(&mut self, line: Line, now: Instant) -> Vec<Line> {
        let mut lines = self.due(now, false);
        if self.is_printed(&line, now) {
            lines.push(line);
        }
        lines
    }

    /// Whether this line is printed now. Lines about this computer are always printed.
    fn is_printed(&mut self, line: &Line, now: Instant) -> bool {
        let Some(peer) = line.peer() else { return true };
        let kinds = self.counts.entry(peer.clone()).or_default();
        let mut kind = shape(&line.text);
        if !kinds.contains_key(&kind) && kinds.len() >= MAX_KINDS {
            kind.clear();
        }
        let seen = kinds.entry(kind).or_insert(LineCount { since: now, printed: 0, suppressed: None });
        if seen.printed < BURST {
            seen.printed += 1;
            return true;
        }
        let count = seen.suppressed.as_ref().map_or(0, |(_, _, count)| *count);
        seen.suppressed = Some((line.clone(), now, count.saturating_add(1)));
        false
    }

    /// Returns the summaries that are due, in the order of their last lines. Because of this order, the last line about
    /// a peer is its current state. At the end of the service, all summaries are due.
    pub fn due(&mut self, now: Instant, is_end: bool) -> Vec<Line> {
        let mut due = Vec::new();
        for kinds in self.counts.values_mut() {
            kinds.retain(|_, seen| {
                let age = now.saturating_duration_since(seen.since);
                if age < WINDOW && !is_end {
                    return true;
                }
                let Some((mut line, at, count)) = seen.suppressed.take() else { return false };
                let times = if count == 1 { "once more".to_owned() } else { format!("{count} more times") };
                let age = duration::display(Duration::from_secs(age.as_secs()));
                line.text = format!("{} ({times} in {age})", line.text);
                due.push((at, line));
                // The line still repeats. From now on there is one summary per window.
                (seen.since, seen.printed) = (now, BURST);
                true
            });
        }
        self.counts.retain(|_, kinds| !kinds.is_empty());
        due.sort_by_key(|(at, _)| *at);
        due.into_iter().map(|(_, line)| line).collect()
    }
}

/// Text in which each number is replaced by `#`. Durations and counts differ between lines of the same kind.
fn shape(text: &str) -> String {
    /// Maximum number of characters by which kinds of lines are distinguished.
    const SHAPE_LENGTH: usize = 200;

    let mut shape = String::new();
    for letter in text.chars().take(SHAPE_LENGTH) {
        match letter {
            '0'..='9' if shape.ends_with('#') => {}
            '0'..='9' => shape.push('#'),
            letter => shape.push(letter),
        }
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(text: &str) -> Line {
        Line::new(Level::Warning, text, &[("broker", "mqtt://b:1883")])
    }

    #[test]
    fn prints_the_last_repeated_line_with_its_count() {
        let (mut repeats, start) = (RepeatLimiter::default(), Instant::now());
        let printed = (0..1000).filter(|number| repeats.is_printed(&line(&format!("again in {number}.1s")), start));
        assert_eq!(printed.count(), 5);
        assert!(repeats.is_printed(&line("connected"), start), "other lines are not held");
        assert!(repeats.due(start + WINDOW / 2, false).is_empty());
        let due = repeats.due(start + WINDOW, false);
        let texts: Vec<&str> = due.iter().map(|line| &line.text[..]).collect();
        assert_eq!(texts, ["again in 999.1s (995 more times in 10m)"]);
        // While the line repeats, it is kept for the next summary. After a window without the line, its count is
        // removed.
        assert!(!repeats.is_printed(&line("again in 7.0s"), start + WINDOW));
        assert_eq!(repeats.due(start + WINDOW * 2, false)[0].text, "again in 7.0s (once more in 10m)");
        assert!(repeats.due(start + WINDOW * 3, false).is_empty());
        assert!(repeats.is_printed(&line("again in 8.0s"), start + WINDOW * 3));
    }

    #[test]
    fn prints_suppressed_lines_in_order_at_the_end() {
        let (mut repeats, start) = (RepeatLimiter::default(), Instant::now());
        for number in 0..20 {
            for (offset, text) in [(0, "lost"), (1, "back")] {
                repeats.is_printed(&line(text), start + Duration::from_secs(number * 2 + offset));
            }
        }
        let due = repeats.due(start + Duration::from_secs(60), true);
        let texts: Vec<&str> = due.iter().map(|line| &line.text[..]).collect();
        assert_eq!(texts, ["lost (15 more times in 1m)", "back (15 more times in 59s)"]);
    }

    #[test]
    fn bounds_the_lines_of_each_peer() {
        let (mut repeats, now) = (RepeatLimiter::default(), Instant::now());
        let word = |number: usize| "abcdefghij".chars().cycle().skip(number % 10).take(number).collect::<String>();
        let printed = (0..500).filter(|number| repeats.is_printed(&line(&word(*number)), now)).count();
        assert!(printed <= (MAX_KINDS + 1) * usize::try_from(BURST).unwrap(), "{printed}");
        assert!(repeats.counts.values().all(|kinds| kinds.len() <= MAX_KINDS + 1));
        let other = Line::new(Level::Warning, "no answer", &[("robot", "cell3")]);
        assert!(repeats.is_printed(&other, now));
        let own = Line::new(Level::Warning, "robots.toml:1: error", &[("kind", "usage")]);
        assert!((0..100).all(|_| repeats.is_printed(&own, now)), "what a person changes here is always said");
    }
}

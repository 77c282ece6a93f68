//! Start states of simulators, as TOML: what all families have in common.

use std::time::Duration;

use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::Spanned;

/// A line for the console of the simulator, at a time from its start.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Event {
    pub(super) at_ms: u64,
    #[serde(rename = "do")]
    pub(super) line: String,
}

/// Reads entries. The error says what is wrong, and in which line.
pub(super) fn parse<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        format!("line {}: {}", line(text, start), error.message())
    })
}

/// Says what is wrong with an entry, and where.
#[derive(Debug)]
pub(super) struct At<'a> {
    /// The whole text.
    pub(super) text: &'a str,
}

impl At<'_> {
    pub(super) fn wrong<T>(&self, entry: &Spanned<T>, what: impl std::fmt::Display) -> String {
        format!("line {}: {what}", line(self.text, entry.span().start))
    }

    /// Events in the order of their times, each with what `read` makes of its line. The lines are read in the order of the
    /// text, so that a mistake shows now and not in the middle of a run.
    pub(super) fn events<T>(
        &self,
        entries: &[Spanned<Event>],
        mut read: impl FnMut(&str) -> Result<T, String>,
    ) -> Result<Vec<(Duration, String, T)>, String> {
        let mut events = Vec::new();
        for entry in entries {
            let Event { at_ms, line } = entry.get_ref();
            let content = read(line).map_err(|what| self.wrong(entry, what))?;
            events.push((Duration::from_millis(*at_ms), line.clone(), content));
        }
        events.sort_by_key(|(at, ..)| *at);
        Ok(events)
    }

    /// A value by its key, if that is a number from 1 to `most`.
    pub(super) fn key<T>(&self, key: &str, most: usize, entry: &Spanned<T>) -> Result<usize, String> {
        let number = key.parse().ok().filter(|number| (1..=most).contains(number));
        number.ok_or_else(|| self.wrong(entry, format!("'{key}' is not a number from 1 to {most}")))
    }
}

/// The line, from 1, in which a byte stands.
fn line(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|&byte| byte == b'\n').count()
}

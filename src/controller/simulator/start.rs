//! Start states in TOML, with errors that give the line.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::ops::RangeInclusive;

use jiff::civil::DateTime;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::Spanned;

use super::timeline::Timeline;

/// Entries by number or name.
pub(crate) type Table<T> = BTreeMap<String, Spanned<T>>;

/// A console line at a time after the start.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Event {
    at_ms: u64,
    #[serde(rename = "do")]
    line: String,
}

/// Parses entries. An error gives the problem and the line.
pub(crate) fn parse<T: DeserializeOwned>(text: &str) -> Result<T, String> {
    toml::from_str(text).map_err(|error| {
        let start = error.span().map_or(0, |span| span.start);
        format!("line {}: {}", line_number(text, start), error.message())
    })
}

/// An entry with a default value, which has no position in the text.
pub(crate) fn default_entry<T>(value: T) -> Spanned<T> {
    Spanned::new(0..0, value)
}

pub(crate) fn default_text(text: &str) -> Spanned<String> {
    default_entry(text.to_owned())
}

/// The TOML text, for the line numbers of errors.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Source<'a> {
    pub(crate) text: &'a str,
}

impl Source<'_> {
    /// Error about an entry, with its line.
    pub(crate) fn error<T>(&self, entry: &Spanned<T>, what: impl Display) -> String {
        format!("line {}: {what}", line_number(self.text, entry.span().start))
    }

    /// Converts an entry with `read`.
    pub(crate) fn read<'e, T, R>(
        &self,
        entry: &'e Spanned<T>,
        read: impl FnOnce(&'e T) -> Result<R, String>,
    ) -> Result<R, String> {
        read(entry.get_ref()).map_err(|what| self.error(entry, what))
    }

    /// Calls `take` for each entry of a list.
    pub(crate) fn each<'e, T: 'e>(
        &self,
        entries: impl IntoIterator<Item = &'e Spanned<T>>,
        mut take: impl FnMut(&'e T) -> Result<(), String>,
    ) -> Result<(), String> {
        entries.into_iter().try_for_each(|entry| self.read(entry, &mut take))
    }

    /// Calls `take` for each entry of a table.
    pub(crate) fn each_of<'e, T>(
        &self,
        entries: &'e Table<T>,
        mut take: impl FnMut(&'e str, &'e T) -> Result<(), String>,
    ) -> Result<(), String> {
        entries.iter().try_for_each(|(key, entry)| self.read(entry, |value| take(key, value)))
    }

    /// Reads a share from 0 to 1.
    pub(crate) fn share(&self, name: &str, entry: &Spanned<f64>) -> Result<f64, String> {
        self.read(entry, |share| {
            let share = Some(*share).filter(|share| (0.0..=1.0).contains(share));
            share.ok_or_else(|| format!("{name} must be from 0 to 1"))
        })
    }

    /// Reads a date and time in a `strptime` format.
    pub(crate) fn time(&self, entry: &Spanned<String>, form: &str, example: &str) -> Result<DateTime, String> {
        let wrong = |_| format!("write a time, for example \"{example}\"");
        self.read(entry, |text| DateTime::strptime(form, text).map_err(wrong))
    }

    /// Sorts events by time. Calls `check` in text order at the start, so that a mistake is not found only during a
    /// run.
    pub(crate) fn timeline<R>(
        &self,
        entries: &[Spanned<Event>],
        mut check: impl FnMut(&str) -> Result<R, String>,
    ) -> Result<Timeline, String> {
        self.each(entries, |event| check(&event.line).map(drop))?;
        Ok(entries.iter().map(Spanned::get_ref).map(|event| (event.at_ms, event.line.clone())).collect())
    }
}

/// Parses a numeric key. `things` names the counted objects for the error message.
pub(crate) fn numbered(things: &str, key: &str, range: RangeInclusive<usize>) -> Result<usize, String> {
    let number = key.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| format!("{things} must be from {} to {}", range.start(), range.end()))
}

/// Line number, from 1, of a byte offset.
fn line_number(text: &str, byte: usize) -> usize {
    1 + text.bytes().take(byte).filter(|&byte| byte == b'\n').count()
}

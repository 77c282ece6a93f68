//! Console commands that all simulators share, and their output.

use std::ops::RangeInclusive;
use std::str::FromStr;

/// Parses `on` or `off`.
pub(crate) fn on_off(word: &str) -> Result<bool, String> {
    match word {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(expected(word, "on or off")),
    }
}

/// Parses an integer within a range.
pub(crate) fn number<T: FromStr + PartialOrd + std::fmt::Display>(
    word: &str,
    range: RangeInclusive<T>,
) -> Result<T, String> {
    let number = word.parse().ok().filter(|number| range.contains(number));
    number.ok_or_else(|| expected(word, &format!("a number from {} to {}", range.start(), range.end())))
}

/// Error for a wrong word.
pub(crate) fn expected(word: &str, what: &str) -> String {
    format!("'{word}' is not {what}")
}

pub(crate) fn unknown(line: &str) -> String {
    format!("unknown command: '{}'", line.trim())
}

/// Help line: input, and its effect.
pub fn help_line(typed: &str, does: &str) -> String {
    format!("{typed:<32}  {does}")
}

/// Help text: the lines of a family, and then the lines that all families share.
pub(crate) fn help(lines: &[(&str, &str)]) -> String {
    let common = [
        ("robot", "show the state of the controller; also `state`"),
        ("help", "show this list"),
        ("quit", "end the simulator"),
    ];
    let lines = lines.iter().chain(&common).map(|(typed, does)| help_line(typed, does));
    lines.collect::<Vec<_>>().join("\n")
}

/// Two-column table.
pub(crate) fn table(rows: &[(String, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or_default();
    let lines = rows.iter().map(|(name, what)| format!("{name:<width$}  {what}").trim_end().to_owned());
    lines.collect::<Vec<_>>().join("\n")
}

/// Comma-separated list of `always`, and of the texts in `now` whose condition is true.
pub(crate) fn summary<'a>(always: &[&'a str], now: impl IntoIterator<Item = (bool, &'a str)>) -> String {
    let now = now.into_iter().filter_map(|(holds, text)| holds.then_some(text));
    always.iter().copied().chain(now).collect::<Vec<_>>().join(", ")
}

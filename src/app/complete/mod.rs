//! Completion of a command line, with live values.
//!
//! ```text
//! complete(words: &[OsString], index: usize, is_among: bool) -> Vec<Candidate { value, help, is_begun }>
//! ```
//!
//! `words[0]` is the program (`armctl`, or `yerc` if it was started with that name). `words[index]` is the word at the
//! cursor, as typed so far; it may be empty. The shell scripts (`shell.rs`) and the line editor of `armctl repl` call
//! the same function. This function prints nothing and never fails. If no candidates are known, the result is empty.
//!
//! Arguments declare the [`ValueKind`] of their values: `#[arg(add = ValueKind::Robot)]`. Values of common kinds are in
//! `values.rs`. Values of a family are in `command/FAMILY/complete.rs`. `live.rs` reads values from a robot if only the
//! robot has them. `engine.rs` contains the unstable library for words and flags.
//!
//! [`ValueKind`]: armctl_frame::ValueKind

mod engine;
mod live;
mod shell;
mod values;

use std::ffi::OsString;
use std::time::Duration;

pub use shell::answer;

use super::with_family;
use armctl_frame::Candidate;

/// Returns candidates for `words[index]`, the best first. `is_among` is `true` if this process also runs other lines,
/// as at the prompt; its simulators then stay alive between lines.
pub fn complete(words: &[OsString], index: usize, is_among: bool) -> Vec<Candidate> {
    complete_within(words, index, is_among, live::ASK_TIMEOUT, false)
}

/// Same as [`complete`], with a time limit. With `connects`, values are read from a robot even without a session.
pub fn complete_within(
    words: &[OsString],
    index: usize,
    is_among: bool,
    time_limit: Duration,
    connects: bool,
) -> Vec<Candidate> {
    let before: Vec<OsString> = words.iter().take(index).cloned().collect();
    let current = words.get(index).cloned().unwrap_or_default();
    if before.is_empty() {
        return Vec::new();
    }
    let before = with_family(before);
    engine::complete(before, &current, (is_among, connects), time_limit).unwrap_or_default()
}

#[cfg(test)]
mod tests;

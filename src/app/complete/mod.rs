//! Completion of a command line, with live values.
//!
//! ```text
//! complete(words: &[OsString], index: usize, is_among: bool) -> Vec<Candidate { value, help, is_begun }>
//! ```
//!
//! `words[0]` is the program (`armctl`, or `yerc` if it was started with that name). `words[index]` is the word at the
//! cursor, as typed so far; it can be empty. The shell scripts (`shell.rs`) and the line editor of `armctl repl` call
//! the same function. It prints nothing and never fails: without knowledge there are no candidates.
//!
//! Arguments declare the [`ValueKind`] of their values: `#[arg(add = ValueKind::Robot)]`. Values of common kinds are in
//! `values.rs`, those of a family in `command/FAMILY/complete.rs`. `live.rs` asks a robot for values that only it has.
//! `engine.rs` contains the unstable library for words and flags.
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

/// Candidates for `words[index]`, best first. `is_among`: other lines run in this process, as at the prompt, where
/// simulators live on.
pub fn complete(words: &[OsString], index: usize, is_among: bool) -> Vec<Candidate> {
    complete_within(words, index, is_among, live::ASK_TIMEOUT, false)
}

/// The same with a time limit. With `connects`, a robot is asked even without a session.
pub fn complete_within(
    words: &[OsString],
    index: usize,
    is_among: bool,
    patience: Duration,
    connects: bool,
) -> Vec<Candidate> {
    let before: Vec<OsString> = words.iter().take(index).cloned().collect();
    let current = words.get(index).cloned().unwrap_or_default();
    if before.is_empty() {
        return Vec::new();
    }
    let before = with_family(before);
    engine::complete(before, &current, (is_among, connects), patience).unwrap_or_default()
}

#[cfg(test)]
mod tests;

//! Completion: what could stand at the cursor of a command line, with live values.
//!
//! ```text
//! complete(words: &[OsString], index: usize, is_among: bool) -> Vec<Candidate { value, help, is_begun }>
//! ```
//!
//! `words[0]` is the program (`armctl`, or `yerc` where it was started under that name), `words[index]` the word at the
//! cursor as far as it was typed, maybe empty. The shells' scripts (`shell.rs`) and the line editor of `armctl repl` call
//! the same function. It prints nothing and fails at nothing: where nothing is known there are no candidates.
//!
//! Arguments only name the [`ValueKind`] of their values: `#[arg(add = ValueKind::Robot)]`. Which values a common kind has is
//! in `values.rs`; a family keeps its own in `command/FAMILY/complete.rs`. How a robot is asked for those that only it knows is
//! in `live.rs`. The library that knows words and flags is unstable and stays in `engine.rs`.
//!
//! [`ValueKind`]: crate::command::ValueKind

mod engine;
mod live;
mod shell;
mod values;

use std::ffi::OsString;
use std::time::Duration;

pub use shell::answer;

use super::with_family;
use crate::command::Candidate;

/// What could stand at `words[index]`, best first; `is_among` other lines of this process, as at the prompt, where
/// simulators live on from one line to the next.
pub fn complete(words: &[OsString], index: usize, is_among: bool) -> Vec<Candidate> {
    complete_within(words, index, is_among, live::PATIENCE, false)
}

/// The same within a time; where it `connects`, a robot is asked although no session holds its link.
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

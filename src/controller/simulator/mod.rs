//! Common parts of the simulators: start states, console, timed events, delayed answers, run options, replay.
//!
//! A family adds the keys of its start state, its console commands, and the controller itself.

pub(crate) mod answers;
pub mod console;
pub mod recording;
pub mod run_options;
pub(crate) mod start;
pub(crate) mod timeline;

/// Refuses with `error` if `is_refused`.
pub(crate) fn refuse_if<E>(is_refused: bool, error: E) -> Result<(), E> {
    if is_refused { Err(error) } else { Ok(()) }
}

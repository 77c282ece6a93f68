//! What the simulators of all families share: start states, the console, events at their time, answers on their way.
//!
//! A family adds what is its own: the keys of its start state, the lines of its console, and the controller itself.

pub(crate) mod answers;
pub mod console;
pub(crate) mod start;
pub(crate) mod timeline;

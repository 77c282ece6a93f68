//! Clients of robot controllers. A client connects to one controller, sends requests, transfers files and returns
//! typed errors.
//!
//! A client drives the sessions of its family (protocol only, without sockets or clock) over a transport (bytes
//! only). It has no settings, prompts or output texts. A [`Watcher`] observes the frames and events.
//!
//! Three rules hold in every client:
//!
//! - **Authorization.** Every request is checked against a [`Grant`] first. The default grant allows only reads. A
//!   stop is always allowed.
//! - **A refusal is an answer.** A refusal by the controller is data with a code. `try_ask` returns it; `ask` turns
//!   it into an error.
//! - **A change is sent once.** If its answer is lost, the error says that the outcome is unknown.
//!
//! A client in a dry run records in a [`Plan`] what it would send. It has no answers.

use std::time::Duration;

mod grant;
mod plan;
pub mod toyo;
mod watcher;
pub mod yerc;
pub mod yrcx;

/// Repeat interval of an unconfirmed stop.
const STOP_EVERY: Duration = Duration::from_millis(200);
/// Attempts to send an unconfirmed stop.
const STOP_TRIES: u32 = 15;
/// Time limit for the confirmation of a stop.
const STOP_WITHIN: Duration = STOP_EVERY.saturating_mul(STOP_TRIES);

pub use grant::{Grant, NotAuthorized};
pub use plan::{Plan, Reason};
pub use watcher::{Ends, Watcher};

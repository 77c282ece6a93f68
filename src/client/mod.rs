//! Clients of robot controllers. A client connects to one controller, sends requests, transfers files and returns typed
//! errors.
//!
//! A client runs the protocol sessions of its family (they have no sockets and no clock) over a transport (which
//! carries bytes only). A client has no settings, prompts or output texts. A [`Watcher`] observes the frames and
//! events.
//!
//! Three rules apply to every client:
//!
//! - **Authorization.** The client checks every request against a [`Grant`] before it sends the request. The default
//!   grant allows only reads. A stop is always allowed.
//! - **A refusal is an answer.** A refusal by the controller is data with a code. `try_ask` returns the refusal as a
//!   value; `ask` returns it as an error.
//! - **A change is sent once.** If the answer to a change is lost, the error reports that the outcome is unknown.
//!
//! A client in a dry run records in a [`Plan`] the frames that it would send. It receives no answers.

use std::time::Duration;

mod grant;
mod plan;
pub mod toyo;
mod watcher;
pub mod yerc;
pub mod yrcx;

/// Repeat interval of an unconfirmed stop.
const STOP_INTERVAL: Duration = Duration::from_millis(200);
/// Attempts to send an unconfirmed stop.
const STOP_TRIES: u32 = 15;
/// Time limit for the confirmation of a stop.
const STOP_TIMEOUT: Duration = STOP_INTERVAL.saturating_mul(STOP_TRIES);

pub use grant::{Grant, NotAuthorized};
pub use plan::{Plan, Reason};
pub use watcher::{AddressPair, Watcher};

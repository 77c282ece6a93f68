//! Clients of robot controllers: each connects to one, asks, orders and transfers, and says as a typed error what went
//! wrong.
//!
//! A client is the one driver between the sessions of its family, which know the protocol and neither sockets nor clock,
//! and a transport, which moves bytes and knows no meaning. It knows nothing of a command line: no settings, no questions,
//! no prose. What happens on the line, others are told by a [`Watcher`].
//!
//! Three rules hold in all of them:
//!
//! - **Nothing leaves that was not granted.** Every request is held against a [`Grant`] first; without one a client reads.
//!   A stop is always allowed.
//! - **"No" is an answer.** What a controller refuses is data with a code. `try_ask` returns it; `ask` makes an error of it
//!   for who has no use for a refusal.
//! - **What changes something leaves once.** When its answer is lost, the error says that the outcome is unknown.
//!
//! A client can be one of a dry run: it notes in a [`Plan`] what it would send, and has no answers.

use std::time::Duration;

mod grant;
mod plan;
pub mod toyo;
mod watcher;
pub mod yerc;
pub mod yrcx;

/// The silence after which a stop is sent again.
const STOP_EVERY: Duration = Duration::from_millis(200);
/// How often a stop is sent that nobody confirms.
const STOP_TRIES: u32 = 15;
/// How long a stop is tried that nobody confirms.
const STOP_WITHIN: Duration = STOP_EVERY.saturating_mul(STOP_TRIES);

pub use grant::{Grant, NotAuthorized};
pub use plan::{Plan, Reason};
pub use watcher::{Ends, Watcher};

#![doc = include_str!("README.md")]
#![cfg_attr(not(test), deny(clippy::expect_used, clippy::indexing_slicing, clippy::panic, clippy::unreachable))]
#![cfg_attr(
    not(all(feature = "toyo", feature = "yerc", feature = "yrcx")),
    allow(dead_code, reason = "no family uses all of what they share")
)]

use std::time::Duration;

mod blocking;
mod grant;
mod plan;
#[cfg(feature = "toyo")]
pub mod toyo;
pub mod units;
mod watcher;
#[cfg(feature = "yerc")]
pub mod yerc;
#[cfg(feature = "yrcx")]
pub mod yrcx;

/// The crates with the protocols and the transports, whole. They can change in each version.
pub mod unstable {
    pub use armctl_controller as controller;
    pub use armctl_transport as transport;
}

/// Longest time limit: a later deadline may not exist in the clock of the computer.
const LONGEST_TIMEOUT: Duration = Duration::from_secs(365 * 24 * 3600);
/// Repeat interval of an unconfirmed stop.
const STOP_INTERVAL: Duration = Duration::from_millis(200);
/// Attempts to send an unconfirmed stop.
const STOP_TRIES: u32 = 15;
/// Time limit for the confirmation of a stop.
const STOP_TIMEOUT: Duration = STOP_INTERVAL.saturating_mul(STOP_TRIES);

#[doc(inline)]
pub use armctl_controller::Risk;
#[doc(inline)]
pub use armctl_transport::session::client::SessionBusy;
#[doc(inline)]
pub use armctl_transport::tap::Direction;
pub use blocking::Blocking;
pub use grant::{Grant, NotAuthorized};
pub use plan::{Plan, Reason};
pub use watcher::{AddressPair, Watcher};

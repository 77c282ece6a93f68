//! PROFIBUS DP master of one slave, as the only master on an RS-485 line, and a simulated slave.
//!
//! This module knows image bytes, but no robots.

use std::time::Duration;

pub mod driver;
pub mod error;
pub mod gsd;
mod hearing;
pub mod link;
pub mod listener;
pub mod master;
pub mod port;
mod quiet;
pub mod rates;
pub mod request;
pub mod settings;
pub mod slave;
pub mod survey;
#[cfg(test)]
mod tests;
pub mod wire;

/// A moment, as time since an origin that the driver chooses. It never runs backwards.
pub type Now = Duration;

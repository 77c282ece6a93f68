//! A link that outlives commands: one process, the host, holds it, and others reach the device through that process
//! over a socket on this machine.
//!
//! What is said on the socket is in `wire`: frames of this program's own, no protocol of a controller. The host passes on
//! what clients send, and decides only who is next:
//!
//! - the line belongs to one client at a time, for one exchange: it takes it, talks, and gives it back, so that a stop
//!   gets through between two questions of somebody else;
//! - of an image, the exclusive part (such as a remote command) is changed by the holder of the line alone; the rest is
//!   switched bit by bit by whoever wants to, so that a stop needs no turn;
//! - one client at a time moves the robot.
//!
//! A client that dies gives back what it holds. What it was moving is stopped, unless it said that it leaves its motion: then
//! what it left on the image stays there.

pub mod client;
pub mod host;
pub mod place;
#[cfg(unix)]
mod socket;
#[cfg(not(unix))]
#[path = "no_socket.rs"]
mod socket;
pub mod wire;

pub use socket::{Detached, detach, leave_terminal, terminate};

/// This process, as sessions know it.
pub fn process() -> u32 {
    std::process::id()
}

//! Sessions: a link that outlives commands. One process, the host, holds it. Other processes reach the device through a
//! local socket of the host.
//!
//! `wire` defines the frames on the socket; they are our own, not those of a controller. The host passes on what
//! clients send, and only decides whose turn it is:
//!
//! - The line belongs to one client at a time, for one exchange: take it, transact, release it. So a stop can pass
//!   between two requests of another client.
//! - Only the owner of the line can change the exclusive part of an image, such as a remote command. Any client can
//!   switch the other bits, so a stop needs no turn.
//! - One client at a time moves the robot.
//!
//! If a client dies, all it has is released. Its motion is stopped, unless the client has declared that it leaves the
//! motion running. In that case its changes of the image stay.

pub mod client;
pub mod host;
pub mod location;
#[cfg(unix)]
mod socket;
#[cfg(not(unix))]
#[path = "no_socket.rs"]
mod socket;
pub mod wire;

pub use socket::{Detached, detach, leave_terminal, terminate};

/// Id of this process.
pub fn process() -> u32 {
    std::process::id()
}

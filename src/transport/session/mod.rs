//! Sessions: a link that stays open between commands. One process, the host, owns the link. Other processes reach the
//! device through a local socket of the host. On Windows, a named pipe takes the place of the socket.
//!
//! The lines of a prompt or command file are clients in the process of their host. They need no socket: see `direct`.
//!
//! `wire` defines the frames on the socket. They are armctl's own frames, not frames of a controller. The host passes
//! on the bytes and images of the clients. It only decides which client may send:
//!
//! - The line is the right to transact with the device. It belongs to one client at a time, for one exchange: the
//!   client
//!   acquires the line, transacts, and releases the line. A stop of another client can therefore be sent between two
//!   requests of one client.
//! - Only the owner of the line can change the exclusive part of an image, for example a remote command. Any client can
//!   switch the other bits, so a stop need not wait for the line.
//! - One client at a time may move the robot.
//!
//! If a client is killed or crashes, the host releases everything that the client owned, and stops the motion of the
//! client. If the client declared that its motion continues after its end, the motion is not stopped, and its changes
//! of the image stay.

pub mod client;
#[cfg(any(windows, test))]
mod command_line;
pub mod direct;
pub mod host;
pub mod location;
#[cfg(unix)]
mod socket;
#[cfg(windows)]
#[path = "pipe.rs"]
mod socket;
pub mod wire;

pub use socket::{Detached, detach, leave_terminal, start_file, terminate};

/// Milliseconds that have passed after a time.
fn milliseconds(since: tokio::time::Instant) -> u64 {
    u64::try_from(since.elapsed().as_millis()).unwrap_or(u64::MAX)
}

/// Process id of this process.
pub fn process() -> u32 {
    std::process::id()
}

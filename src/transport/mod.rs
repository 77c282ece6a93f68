//! Transports: they carry bytes or images without interpreting them.
//!
//! Transports and controllers do not depend on each other. Applications use `armctl-client`: this crate can change in each
//! version.

#[cfg(feature = "fieldbus")]
mod bytes;
#[cfg(feature = "fieldbus")]
pub mod capture;
#[cfg(feature = "fieldbus")]
pub mod devicenet;
#[cfg(feature = "fieldbus")]
pub mod eip;
pub mod fault;
#[cfg(feature = "plant")]
pub mod http;
pub mod image;
#[cfg(all(unix, feature = "plant"))]
pub mod journal;
pub mod line;
#[cfg(feature = "fieldbus")]
pub mod local_error;
#[cfg(feature = "plant")]
pub mod mqtt;
mod port;
pub mod port_list;
#[cfg(feature = "fieldbus")]
pub mod profibus;
#[cfg(feature = "fieldbus")]
pub mod profinet;
mod pty;
pub mod serial;
pub mod server;
pub mod session;
pub mod sim;
pub mod stream;
pub mod stream_server;
#[cfg(feature = "plant")]
pub mod supervisor;
pub mod tap;
pub mod tcp;
#[cfg(test)]
mod testing;
pub mod udp;

use std::fmt::Display;
use std::io;
use std::time::Duration;

pub use armctl_files::{plain, this_program};

/// Pauses before attempts to open a connection again after a loss. The last pause repeats.
const BACKOFF: [Duration; 5] = [
    Duration::from_millis(250),
    Duration::from_millis(500),
    Duration::from_secs(1),
    Duration::from_secs(2),
    Duration::from_secs(5),
];

/// Returns the error of a byte stream whose other end was closed or unplugged.
fn closed_error(why: impl Display) -> io::Error {
    io::Error::new(io::ErrorKind::NotConnected, why.to_string())
}

/// Refuses with `error` if `is_refused`.
fn refuse_if<E>(is_refused: bool, error: E) -> Result<(), E> {
    if is_refused { Err(error) } else { Ok(()) }
}

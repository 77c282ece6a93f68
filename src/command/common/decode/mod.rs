//! `armctl decode FAMILY …`: what goes over the line, in words.

pub mod capture;
pub mod toyo;
pub mod yerc;
pub mod yrcx;

use clap::Subcommand;

use self::toyo::Toyo;
use self::yerc::Yerc;
use self::yrcx::Yrcx;
use crate::command::frame::run::{Run, RunError};
use crate::failure::Failure;
use crate::files;

/// Families whose traffic is known.
#[derive(Debug, Subcommand)]
pub enum Decode {
    /// Frames of the high-speed Ethernet server, as from a packet capture
    Yerc(Yerc),
    /// Words of remote commands and their answers
    Yrcx(Yrcx),
    /// Lines of the host communication, of either side
    Toyo(Toyo),
}

impl Decode {
    /// Does it.
    pub fn run(self, run: &Run) -> Result<(), RunError> {
        match self {
            Self::Yerc(yerc) => yerc.run(run),
            Self::Yrcx(yrcx) => yrcx.run(run),
            Self::Toyo(toyo) => toyo.run(run),
        }
    }
}

/// Room for thousands of frames.
const MOST: u64 = 16 << 20;

/// What stands on stdin; bytes that are no text are replaced, and then told as such.
fn stdin() -> Result<String, Failure> {
    let bytes = files::stdin(MOST).map_err(|error| Failure::io("stdin", &error))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

//! `armctl decode FAMILY …`: what goes over the line, in words.

pub mod capture;

use clap::Subcommand;

use crate::command::run::{Run, Stopped};
use crate::command::toyo::decode::Toyo;
use crate::command::yerc::decode::Yerc;
use crate::command::yrcx::decode::Yrcx;
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
    pub(super) fn run(self, run: &Run) -> Result<(), Stopped> {
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
pub fn stdin() -> Result<String, Failure> {
    let bytes = files::stdin(MOST).map_err(|error| Failure::io("stdin", &error))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

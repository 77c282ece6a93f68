//! Commands `toyo io`: ports of eight bits on the controller (station 0) and on its slave stations (1 to 4).
//!
//! A signal is one bit of a port: `IN1.3`, `OUT1.3`, `INT1.3` (a bit of an internal port). `IN0` and `OUT0` are the
//! system ports SY01.
//!
//! The manual does not define the order of the bits. armctl prints bit 8 first and bit 1 last, because the comments of
//! sample 3-1 call `.......1` output bit 1 (ambiguity C9).

mod get;
mod list;
pub mod port;
mod read;
mod set;

use crate::prelude::basics::*;

commands! {
    /// Commands for signals.
    pub enum Io {
        /// Read signals, for example IN1.3, OUT1.1..OUT1.8 or INT2
        Get(get::Get),
        /// Set outputs, for example OUT1.3=on, or OUT1=.......1 for all bits of a port
        Set(set::Set),
        /// List the signals that are on or have a name
        List(list::List),
        /// Print each change of signals
        Watch(Watch<get::Watched>),
        /// Switch one of the direct outputs F1 to F4
        Direct(set::Direct),
    }
}

/// Argument that selects the station of the ports.
#[derive(Debug, Clone, Copy, Args)]
struct Station {
    /// I/O station: 0 is the controller itself, 1 to 4 are its slave stations
    #[arg(long, value_name = "N", default_value = "0", value_parser = clap::value_parser!(u8).range(0..=4))]
    station: u8,
}

/// Help about questions that the manual leaves open (ambiguities C8 and C9).
const BITS: &str = "IN1.3 is bit 3 of input port 1, OUT1.3 of output port 1, INT1.3 of internal port 1. IN1 is the \
                    whole port. IN0 and OUT0 are the system ports. Bit 1 is the rightmost bit of a port, as in the \
                    example of section 3-1 of the manual.";

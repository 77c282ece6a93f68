//! What can go wrong between a master and a slave: what was sent, what was said to it.

use std::time::Duration;

use thiserror::Error;

use super::wire::{Diagnosis, Status};
use crate::image::view::BusError;

/// Why something did not come about.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ProfibusError {
    /// Settings that no link can have; nothing was sent.
    #[error("{0}")]
    Settings(
        /// Why they cannot be.
        String,
    ),
    /// The adapter does not open, or does not do what it should.
    #[error("{port}: {text}")]
    Port {
        /// Its name.
        port: String,
        /// What is wrong.
        text: String,
    },
    /// The adapter was there, and is gone.
    #[error("the adapter is gone: {text}")]
    Gone {
        /// The system's reason.
        text: String,
    },
    /// Another master is on the line. Nothing was sent since it was heard.
    #[error("another master, station {master}, is on the bus ({heard})")]
    OtherMaster {
        /// Its address.
        master: u8,
        /// What was heard of it.
        heard: &'static str,
    },
    /// Something is on the line that cannot be read. Nothing was sent.
    #[error("there is traffic on the bus that cannot be read at this bit rate ({bytes} bytes)")]
    Unreadable {
        /// How much was heard.
        bytes: usize,
    },
    /// The station did not answer.
    #[error("station {station} did not answer {asked} ({attempts} attempts, {} ms each{heard})", slot.as_millis())]
    NoAnswer {
        /// Who was asked.
        station: u8,
        /// What.
        asked: &'static str,
        /// How often.
        attempts: u8,
        /// How long was waited each time.
        slot: Duration,
        /// What came instead.
        heard: Heard,
    },
    /// The station is a master.
    #[error("station {station} is a master, not a slave")]
    IsMaster {
        /// Its address.
        station: u8,
    },
    /// The station said no.
    #[error("station {station} refused {asked}: {}", status.text())]
    Refused {
        /// Who was asked.
        station: u8,
        /// What.
        asked: &'static str,
        /// What it said.
        status: Status,
    },
    /// An answer that makes no sense.
    #[error("the answer of station {station} to {asked} cannot be read: {why}")]
    Malformed {
        /// Who was asked.
        station: u8,
        /// What.
        asked: &'static str,
        /// What is wrong with it.
        why: String,
    },
    /// The slave is of another kind than the settings say.
    #[error("station {station} has ident number {found:#06x}, not {expected:#06x}")]
    Ident {
        /// Its address.
        station: u8,
        /// What it says.
        found: u16,
        /// What the settings say.
        expected: u16,
    },
    /// The configuration adds up to other images.
    #[error(
        "the configuration {} has {input} bytes from station {station} and {output} to it, not {expected_input} and {expected_output}",
        hex(configuration)
    )]
    Size {
        /// The slave.
        station: u8,
        /// Its identifier bytes.
        configuration: Vec<u8>,
        /// Bytes from the slave.
        input: usize,
        /// Bytes to the slave.
        output: usize,
        /// Bytes that should come.
        expected_input: usize,
        /// Bytes that should go.
        expected_output: usize,
    },
    /// An exchange had another length.
    #[error("station {station} sent {found} bytes of data, not {expected}")]
    Length {
        /// The slave.
        station: u8,
        /// Bytes that came.
        found: usize,
        /// Bytes that should come.
        expected: usize,
    },
    /// The slave wants other parameters.
    #[error("station {station} does not take the user parameters {}", hex(sent))]
    ParameterFault {
        /// Its address.
        station: u8,
        /// What it was sent.
        sent: Vec<u8>,
    },
    /// The slave wants another configuration.
    #[error("station {station} does not take the configuration {}; {}", hex(sent), wants(wanted.as_deref()))]
    ConfigurationFault {
        /// Its address.
        station: u8,
        /// What it was sent.
        sent: Vec<u8>,
        /// What it says that it wants.
        wanted: Option<Vec<u8>>,
    },
    /// The slave belongs to another master.
    #[error("station {station} belongs to master {}", master.map_or_else(|| "?".to_owned(), |master| master.to_string()))]
    Locked {
        /// Its address.
        station: u8,
        /// Its master, as far as it says.
        master: Option<u8>,
    },
    /// The slave does not get ready.
    #[error("station {station} is not ready for data after {} ms: {diagnosis}", after.as_millis())]
    NotReady {
        /// Its address.
        station: u8,
        /// How long was waited.
        after: Duration,
        /// What it says of itself.
        diagnosis: Box<Diagnosis>,
    },
    /// The slave has left the exchange of data.
    #[error("station {station} has left data exchange: {why}")]
    Left {
        /// Its address.
        station: u8,
        /// What it said.
        why: String,
    },
    /// No exchange of the station with a master was heard. Nothing was sent.
    #[error("no exchange of station {station} with a master was heard within {} ms ({telegrams} telegrams, {noise} bytes of noise)", after.as_millis())]
    NotHeard {
        /// Its address.
        station: u8,
        /// How long was listened.
        after: Duration,
        /// Telegrams of others.
        telegrams: u64,
        /// Bytes that were no telegram.
        noise: u64,
    },
    /// The image or the wish is for a connection that has ended meanwhile.
    #[error("the connection was lost meanwhile")]
    Outdated,
    /// The connection was closed here.
    #[error("the connection is closed")]
    Ended,
}

impl BusError for ProfibusError {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

/// What came while an answer was waited for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Heard {
    /// Bytes that were no telegram, or one that was damaged.
    pub noise: bool,
    /// The adapter hands back what is sent.
    pub echo: bool,
}

impl std::fmt::Display for Heard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match (self.noise, self.echo) {
            (false, false) => "; nothing was heard",
            (true, false) => "; damaged bytes were heard",
            (false, true) => "; only the echo of the adapter was heard",
            (true, true) => "; the echo of the adapter and damaged bytes were heard",
        })
    }
}

/// Bytes as they are written in URLs.
pub fn hex(bytes: &[u8]) -> String {
    if bytes.is_empty() { "of no bytes".to_owned() } else { bytes.iter().map(|byte| format!("{byte:02X}")).collect() }
}

fn wants(wanted: Option<&[u8]>) -> String {
    wanted.map_or_else(|| "it does not say which it wants".to_owned(), |wanted| format!("it wants {}", hex(wanted)))
}

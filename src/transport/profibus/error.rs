//! Errors of PROFIBUS links: the request, and the answer or its absence.

use std::time::Duration;

use thiserror::Error;

use super::wire::{Diagnosis, Status};
use crate::image::view::BusError;

/// An error that prevented or ended a link.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ProfibusError {
    /// Invalid settings; nothing was sent.
    #[error("{0}")]
    Settings(String),
    /// The adapter cannot be opened, or refuses a setting.
    #[error("{port}: {text}")]
    Port {
        /// Name of the port.
        port: String,
        /// Reason, as text.
        text: String,
    },
    /// The adapter was disconnected.
    #[error("the adapter was disconnected: {0}")]
    Gone(String),
    /// Another master is on the bus. This master has sent nothing after it received traffic of the other master.
    #[error("another master is on the bus: station {master} ({heard})")]
    OtherMaster {
        /// Address of the other master.
        master: u8,
        /// The received traffic that shows the other master.
        heard: &'static str,
    },
    /// The traffic on the bus is unreadable. Nothing was sent.
    #[error("cannot decode the traffic on the bus at this bit rate ({0} bytes)")]
    Unreadable(usize),
    /// The station did not answer.
    #[error("no answer from station {station} to {request_name} ({attempts} attempts, {} ms each{heard})", slot.as_millis())]
    NoAnswer {
        /// Address of the station.
        station: u8,
        /// Name of the request.
        request_name: &'static str,
        /// Number of attempts.
        attempts: u8,
        /// Time limit per attempt.
        slot: Duration,
        /// What was received instead.
        heard: UnexpectedBytes,
    },
    /// The station is a master.
    #[error("station {0} is a master, not a slave")]
    IsMaster(u8),
    /// The station refused.
    #[error("station {station} refused {request_name}: {}", status.text())]
    Refused {
        /// Address of the station.
        station: u8,
        /// Name of the request.
        request_name: &'static str,
        /// Status of the answer.
        status: Status,
    },
    /// The answer cannot be decoded.
    #[error("cannot decode the answer of station {station} to {request_name}: {why}")]
    Malformed {
        /// Address of the station.
        station: u8,
        /// Name of the request.
        request_name: &'static str,
        /// What is wrong with the answer.
        why: String,
    },
    /// The ident number of the slave is not the ident number in the settings.
    #[error("station {station} has ident number {found:#06x}, not {expected:#06x}")]
    Ident {
        /// Address of the station.
        station: u8,
        /// Ident number of the slave.
        found: u16,
        /// Ident number in the settings.
        expected: u16,
    },
    /// The image sizes of the configuration differ from the expected sizes.
    #[error(
        "the configuration {} has {input} input bytes from station {station} and {output} output bytes, not \
         {expected_input} and {expected_output}",
        hex(configuration)
    )]
    Size {
        /// Address of the station.
        station: u8,
        /// Identifier bytes of the configuration.
        configuration: Vec<u8>,
        /// Number of bytes from the slave.
        input: usize,
        /// Number of bytes to the slave.
        output: usize,
        /// Expected number of bytes from the slave.
        expected_input: usize,
        /// Expected number of bytes to the slave.
        expected_output: usize,
    },
    /// The data of an exchange had a wrong length.
    #[error("station {station} sent {found} bytes of data, not {expected}")]
    Length {
        /// Address of the station.
        station: u8,
        /// Bytes received.
        found: usize,
        /// Bytes expected.
        expected: usize,
    },
    /// The slave reports a parameter fault.
    #[error("station {station} refuses the user parameters {}", hex(sent))]
    ParameterFault {
        /// Address of the station.
        station: u8,
        /// User parameters sent.
        sent: Vec<u8>,
    },
    /// The slave reports a configuration fault.
    #[error("station {station} refuses the configuration {}; {}", hex(sent), wants(reported_configuration.as_deref()))]
    ConfigurationFault {
        /// Address of the station.
        station: u8,
        /// Configuration sent.
        sent: Vec<u8>,
        /// Configuration that the slave reports (Get_Cfg).
        reported_configuration: Option<Vec<u8>>,
    },
    /// Another master has locked the slave.
    #[error("master {} owns station {station}", master.map_or_else(|| "?".to_owned(), |master| master.to_string()))]
    Locked {
        /// Address of the station.
        station: u8,
        /// Address of the other master, if the slave reports it.
        master: Option<u8>,
    },
    /// The slave does not become ready.
    #[error("station {station} is not ready for data after {} ms: {diagnosis}", after.as_millis())]
    NotReady {
        /// Address of the station.
        station: u8,
        /// Total waiting time.
        after: Duration,
        /// Last diagnosis of the slave.
        diagnosis: Box<Diagnosis>,
    },
    /// The slave has left data exchange, so it no longer uses the images.
    #[error("station {station} has left data exchange: {why}")]
    Left {
        /// Address of the station.
        station: u8,
        /// Reason, as text.
        why: String,
    },
    /// No data exchange between the station and a master was received. This master has sent nothing.
    #[error("no data exchange between station {station} and a master within {} ms ({telegrams} telegrams, {noise} \
             bytes of noise)", after.as_millis())]
    NotHeard {
        /// Address of the station.
        station: u8,
        /// Time spent listening.
        after: Duration,
        /// Number of telegrams of other stations.
        telegrams: u64,
        /// Number of bytes that are not part of a telegram.
        noise: u64,
    },
    /// The link was lost, and the caller has not noticed the loss yet: the image that it wants to send belongs to an
    /// older generation.
    #[error("the connection was lost")]
    Outdated,
    /// The link was closed by this program.
    #[error("the connection is closed")]
    Ended,
}

impl BusError for ProfibusError {
    const OUTDATED: Self = Self::Outdated;
    const ENDED: Self = Self::Ended;
}

/// What was received instead of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct UnexpectedBytes {
    /// Whether noise or a damaged telegram was received.
    pub noise: bool,
    /// Whether the adapter echoed the bytes that were sent.
    pub echo: bool,
}

impl std::fmt::Display for UnexpectedBytes {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match (self.noise, self.echo) {
            (false, false) => "; no bytes received",
            (true, false) => "; only damaged bytes received",
            (false, true) => "; only the echo of the adapter received",
            (true, true) => "; the echo of the adapter and damaged bytes received",
        })
    }
}

/// Formats bytes in hexadecimal, as in the options of a URL.
pub fn hex(bytes: &[u8]) -> String {
    if bytes.is_empty() { "(empty)".to_owned() } else { bytes.iter().map(|byte| format!("{byte:02X}")).collect() }
}

fn wants(reported_configuration: Option<&[u8]>) -> String {
    reported_configuration.map_or_else(
        || "it does not report the configuration that it needs".to_owned(),
        |reported_configuration| format!("it needs {}", hex(reported_configuration)),
    )
}

//! Survey of the stations on a line: type, diagnosis, configuration. The survey locks no slave and changes nothing,
//! even in a slave that has a master. But it sends telegrams, so use it only on a line without a master.

use super::Now;
use super::error::ProfibusError;
use super::line_check::LineCheck;
use super::request::{Answer, Outcome, Requester};
use super::settings::Timing;
use super::wire::{Control, Diagnosis, MAX_STATION, Service, Station, Status, sap};

/// Result for one station.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StationResult {
    /// Address of the station.
    pub station: u8,
    /// Station type.
    pub kind: Station,
    /// Diagnosis of a slave.
    pub diagnosis: Result<Diagnosis, NoValueReason>,
    /// Configuration that the slave reports (identifier bytes).
    pub configuration: Result<Vec<u8>, NoValueReason>,
    /// Input image, if the slave is in data exchange.
    pub inputs: Result<Vec<u8>, NoValueReason>,
    /// Output image, if the slave is in data exchange.
    pub outputs: Result<Vec<u8>, NoValueReason>,
}

/// Reason for a missing value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum NoValueReason {
    /// The value was not requested.
    NotAsked,
    /// The station did not answer.
    NoAnswer,
    /// The station refused.
    Refused(Status),
    /// The answer cannot be decoded.
    Malformed(String),
}

/// Requests to a station, in the order in which they are sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StationRequest {
    Kind,
    Diagnosis,
    Configuration,
    Inputs,
    Outputs,
}

impl StationRequest {
    const fn sap(self) -> Option<u8> {
        match self {
            Self::Kind => None,
            Self::Diagnosis => Some(sap::SLAVE_DIAG),
            Self::Configuration => Some(sap::GET_CFG),
            Self::Inputs => Some(sap::READ_INPUTS),
            Self::Outputs => Some(sap::READ_OUTPUTS),
        }
    }

    const fn next(self) -> Option<Self> {
        match self {
            Self::Kind => Some(Self::Diagnosis),
            Self::Diagnosis => Some(Self::Configuration),
            Self::Configuration => Some(Self::Inputs),
            Self::Inputs => Some(Self::Outputs),
            Self::Outputs => None,
        }
    }
}

/// A survey.
#[derive(Debug)]
pub struct Survey {
    requester: Requester,
    quiet: Option<LineCheck>,
    /// Stations that are still to be checked, in reverse order.
    stations: Vec<u8>,
    question: StationRequest,
    found: Vec<StationResult>,
    error: Option<ProfibusError>,
    timing: Timing,
}

impl Survey {
    /// Creates a survey of these stations. The survey listens before it sends.
    pub fn new(now: Now, stations: impl IntoIterator<Item = u8>, requester: Requester, timing: Timing) -> Self {
        let mut stations: Vec<u8> = stations.into_iter().filter(|station| *station <= MAX_STATION).collect();
        stations.reverse();
        let quiet = Some(LineCheck::until(now + timing.listen));
        Self { requester, quiet, stations, question: StationRequest::Kind, found: Vec::new(), error: None, timing }
    }

    /// Result of the survey: the stations found, or the reason for a failure. `None` until the survey is complete.
    pub fn result(&self) -> Option<Result<&[StationResult], ProfibusError>> {
        if let Some(error) = &self.error {
            return Some(Err(error.clone()));
        }
        (self.quiet.is_none() && self.stations.is_empty()).then_some(Ok(&self.found))
    }

    /// Time limit for the answer of a station.
    pub const fn patience(&self) -> std::time::Duration {
        self.timing.slot
    }

    /// Time at which [`Survey::poll`] must be called again.
    pub fn due(&self) -> Now {
        self.quiet.as_ref().map_or_else(|| self.requester.due(), |quiet| quiet.due().unwrap_or_default())
    }

    /// Returns the bytes to send at `now`.
    pub fn poll(&mut self, now: Now) -> Option<Vec<u8>> {
        if let Some(quiet) = &mut self.quiet {
            if let Err(error) = quiet.poll(now)? {
                self.error = Some(error);
            }
            self.quiet = None;
        }
        if self.error.is_some() {
            return None;
        }
        match self.requester.poll(now) {
            Some(Ok(bytes)) => return Some(bytes),
            Some(Err(outcome)) => self.outcome(outcome),
            None => {}
        }
        if self.requester.is_busy() || now < self.requester.due() {
            return None;
        }
        let station = *self.stations.last()?;
        let sap = self.question.sap();
        let service = if sap.is_none() { Service::FdlStatus } else { Service::SendRequestHigh };
        let frame = self.requester.request(service, station, sap, Vec::new());
        Some(self.requester.ask(now, frame))
    }

    /// Handles received bytes.
    pub fn handle(&mut self, now: Now, bytes: &[u8]) {
        if let Some(quiet) = &mut self.quiet {
            if let Err(error) = quiet.handle(bytes) {
                self.error = Some(error);
            }
            return;
        }
        let mut bytes = bytes;
        while let Some(outcome) = self.requester.handle(now, std::mem::take(&mut bytes)) {
            self.outcome(outcome);
        }
    }

    fn outcome(&mut self, outcome: Outcome) {
        let Some(&station) = self.stations.last() else { return };
        let said = match outcome {
            Outcome::Foreign(master, heard) => {
                self.error = Some(ProfibusError::OtherMaster { master, heard });
                return;
            }
            Outcome::NoAnswer { .. } => Err(NoValueReason::NoAnswer),
            Outcome::Answer(Answer::Short) => Err(NoValueReason::Malformed("only an acknowledgement".to_owned())),
            Outcome::Answer(Answer::Frame(frame)) => {
                let Control::Answer(kind, status) = frame.control else { return };
                if self.question == StationRequest::Kind {
                    let unasked = NoValueReason::NotAsked;
                    self.found.push(StationResult {
                        station,
                        kind,
                        diagnosis: Err(unasked.clone()),
                        configuration: Err(unasked.clone()),
                        inputs: Err(unasked.clone()),
                        outputs: Err(unasked),
                    });
                    return if kind == Station::Slave { self.go_on() } else { self.next_station() };
                }
                match status {
                    Status::Data | Status::DataHigh => Ok(frame.data),
                    status => Err(NoValueReason::Refused(status)),
                }
            }
        };
        if self.question == StationRequest::Kind {
            return self.next_station();
        }
        let Some(found) = self.found.last_mut() else { return };
        match self.question {
            StationRequest::Kind => {}
            StationRequest::Diagnosis => {
                let read = |data: Vec<u8>| {
                    Diagnosis::parse(&data).map_err(|error| NoValueReason::Malformed(error.to_string()))
                };
                found.diagnosis = said.and_then(read);
            }
            StationRequest::Configuration => found.configuration = said,
            StationRequest::Inputs => found.inputs = said,
            StationRequest::Outputs => found.outputs = said,
        }
        self.go_on();
    }

    fn go_on(&mut self) {
        match self.question.next() {
            Some(question) => self.question = question,
            None => self.next_station(),
        }
    }

    fn next_station(&mut self) {
        self.question = StationRequest::Kind;
        self.stations.pop();
    }
}

//! Codec for the function code of a telegram (part 4, section 4.7.3).

use super::WireError;

/// Bit that is set in a request.
const REQUEST: u8 = 0x40;
const FCB: u8 = 0x20;
const FCV: u8 = 0x10;

/// Decoded function code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Control {
    /// A request.
    Request(Service, FrameCount),
    /// An answer.
    Answer(Station, Status),
}

/// Service of a request.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Service {
    /// Send data with acknowledge (SDA), low priority.
    SendAcknowledgedLow,
    /// Send data without acknowledge (SDN), low priority.
    SendLow,
    /// Send data with acknowledge (SDA), high priority.
    SendAcknowledgedHigh,
    /// Send data without acknowledge (SDN), high priority.
    SendHigh,
    /// FDL status: type of the station.
    FdlStatus,
    /// Send and request data (SRD), low priority.
    SendRequestLow,
    /// Send and request data (SRD), high priority.
    SendRequestHigh,
    /// Identity of the station.
    Ident,
    /// Services of a service access point.
    LsapStatus,
}

const SERVICES: [(u8, Service); 9] = [
    (0x3, Service::SendAcknowledgedLow),
    (0x4, Service::SendLow),
    (0x5, Service::SendAcknowledgedHigh),
    (0x6, Service::SendHigh),
    (0x9, Service::FdlStatus),
    (0xC, Service::SendRequestLow),
    (0xD, Service::SendRequestHigh),
    (0xE, Service::Ident),
    (0xF, Service::LsapStatus),
];

impl Service {
    /// Whether the service has an answer.
    pub const fn is_answered(self) -> bool {
        !matches!(self, Self::SendLow | Self::SendHigh)
    }

    /// Whether the service uses the frame count bit, which distinguishes a repeated request from a new one.
    pub const fn is_counted(self) -> bool {
        matches!(
            self,
            Self::SendAcknowledgedLow | Self::SendAcknowledgedHigh | Self::SendRequestLow | Self::SendRequestHigh
        )
    }
}

/// Frame count bits (FCB and FCV). They distinguish a repeated request from a new one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameCount {
    /// The frame count is not used.
    None,
    /// First request to a station after a reset of the frame count.
    First,
    /// Later request to a station. The bit changes with every new request.
    Counters(bool),
}

impl FrameCount {
    /// Frame count of the next request.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::None | Self::First => Self::Counters(false),
            Self::Counters(bit) => Self::Counters(!bit),
        }
    }

    /// Value of FCB; `false` if the frame count is not used.
    pub const fn bit(self) -> bool {
        match self {
            Self::None => false,
            Self::First => true,
            Self::Counters(bit) => bit,
        }
    }
}

/// Station type in an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Station {
    /// A slave.
    Slave,
    /// A master that is not ready for the token ring.
    MasterNotReady,
    /// A master that waits for the token.
    MasterReady,
    /// A master in the token ring.
    MasterInRing,
}

const STATIONS: [Station; 4] = [Station::Slave, Station::MasterNotReady, Station::MasterReady, Station::MasterInRing];

/// Status of an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Status {
    /// The request was successful.
    Ok,
    /// The application of the station reports an error.
    UserError,
    /// The station has no free resource for the request.
    NoResource,
    /// The service access point is not active.
    NoService,
    /// The answer contains data of low priority.
    Data,
    /// The station has no data for the answer.
    NoData,
    /// The answer contains data, and the diagnosis is new.
    DataHigh,
    /// The answer contains data, but the station did not accept the data of the request.
    DataNoResource,
    /// The answer contains data, and the diagnosis is new, but the station did not accept the data of the request.
    DataHighNoResource,
}

const STATUSES: [(u8, Status, &str); 9] = [
    (0x0, Status::Ok, "OK"),
    (0x1, Status::UserError, "UE, user error"),
    (0x2, Status::NoResource, "RR, no resource"),
    (0x3, Status::NoService, "RS, service not active"),
    (0x8, Status::Data, "DL, data"),
    (0x9, Status::NoData, "NR, no data"),
    (0xA, Status::DataHigh, "DH, data and new diagnosis"),
    (0xC, Status::DataNoResource, "RDL, data, but no resource"),
    (0xD, Status::DataHighNoResource, "RDH, data and new diagnosis, but no resource"),
];

impl Status {
    /// Short name of the status and its meaning.
    pub fn text(self) -> &'static str {
        STATUSES.iter().find(|row| row.1 == self).map_or("", |row| row.2)
    }
}

impl Control {
    /// Creates the function code of a request.
    pub const fn request(service: Service, count: FrameCount) -> Self {
        Self::Request(service, count)
    }

    /// Decodes the byte.
    pub fn parse(byte: u8, offset: usize) -> Result<Self, WireError> {
        let wrong = WireError::value("function code", offset, byte);
        if byte & 0x80 != 0 {
            return Err(wrong);
        }
        if byte & REQUEST == 0 {
            let status = STATUSES.iter().find(|row| row.0 == byte & 0x0F).ok_or(wrong)?.1;
            return Ok(Self::Answer(STATIONS[usize::from(byte >> 4 & 3)], status));
        }
        let service = SERVICES.iter().find(|row| row.0 == byte & 0x0F).ok_or(wrong)?.1;
        let count = match (byte & FCV != 0, byte & FCB != 0) {
            (false, false) => FrameCount::None,
            (false, true) => FrameCount::First,
            (true, bit) => FrameCount::Counters(bit),
        };
        Ok(Self::Request(service, count))
    }

    /// Encodes the byte.
    pub fn byte(self) -> u8 {
        match self {
            Self::Request(service, count) => {
                let code = SERVICES.iter().find(|row| row.1 == service).map_or(0, |row| row.0);
                let counters = match count {
                    FrameCount::None => 0,
                    FrameCount::First => FCB,
                    FrameCount::Counters(false) => FCV,
                    FrameCount::Counters(true) => FCV | FCB,
                };
                REQUEST | counters | code
            }
            Self::Answer(station, status) => {
                let kind = STATIONS.iter().position(|other| *other == station).unwrap_or_default();
                let code = STATUSES.iter().find(|row| row.1 == status).map_or(0, |row| row.0);
                u8::try_from(kind << 4).unwrap_or_default() | code
            }
        }
    }
}

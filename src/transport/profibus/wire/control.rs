//! The function code of a telegram (part 4, section 4.7.3).

use super::WireError;

/// Set in the codes of requests.
const REQUEST: u8 = 0x40;
const FCB: u8 = 0x20;
const FCV: u8 = 0x10;

/// What a telegram is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Control {
    /// Somebody asks or tells.
    Request(Service, FrameCount),
    /// Somebody answers.
    Answer(Station, Status),
}

/// What a request asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Service {
    /// Data with an acknowledgement (SDA), low priority.
    SendAcknowledgedLow,
    /// Data that nobody answers (SDN), low priority.
    SendLow,
    /// Data with an acknowledgement (SDA), high priority.
    SendAcknowledgedHigh,
    /// Data that nobody answers (SDN), high priority.
    SendHigh,
    /// What kind of station there is.
    FdlStatus,
    /// Data, and data back (SRD), low priority.
    SendRequestLow,
    /// Data, and data back (SRD), high priority.
    SendRequestHigh,
    /// Who the station is.
    Ident,
    /// Which services are behind a service access point.
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
    /// Whether somebody answers it.
    pub const fn is_answered(self) -> bool {
        !matches!(self, Self::SendLow | Self::SendHigh)
    }

    /// Whether its requests are counted, so that a repeated one is known.
    pub const fn is_counted(self) -> bool {
        matches!(
            self,
            Self::SendAcknowledgedLow | Self::SendAcknowledgedHigh | Self::SendRequestLow | Self::SendRequestHigh
        )
    }
}

/// The bits that tell a new request from a repeated one (FCB and FCV).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum FrameCount {
    /// Not counted.
    None,
    /// The first request of a count.
    First,
    /// A counted request; the bit changes with each new one.
    Counted(bool),
}

impl FrameCount {
    /// What the request after this one has.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::None | Self::First => Self::Counted(false),
            Self::Counted(bit) => Self::Counted(!bit),
        }
    }

    /// The value of the bit; of what is not counted as it is sent.
    pub const fn bit(self) -> bool {
        match self {
            Self::None => false,
            Self::First => true,
            Self::Counted(bit) => bit,
        }
    }
}

/// What kind of station answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Station {
    /// A slave.
    Slave,
    /// A master that is not ready for the ring.
    MasterNotReady,
    /// A master that waits for the token.
    MasterReady,
    /// A master in the ring.
    MasterInRing,
}

const STATIONS: [Station; 4] = [Station::Slave, Station::MasterNotReady, Station::MasterReady, Station::MasterInRing];

/// What an answer says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Status {
    /// Done.
    Ok,
    /// An error of the application.
    UserError,
    /// No room.
    NoResource,
    /// The service access point is not active.
    NoService,
    /// Data, low priority.
    Data,
    /// Nothing to send back.
    NoData,
    /// Data, and something new in the diagnosis.
    DataHigh,
    /// Data, but what came was not taken.
    DataNoResource,
    /// Data with something new in the diagnosis, but what came was not taken.
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
    /// Its short name and meaning.
    pub fn text(self) -> &'static str {
        STATUSES.iter().find(|row| row.1 == self).map_or("", |row| row.2)
    }
}

impl Control {
    /// A counted or uncounted request.
    pub const fn request(service: Service, count: FrameCount) -> Self {
        Self::Request(service, count)
    }

    /// From its byte.
    ///
    /// # Errors
    /// When no telegram has that.
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
            (true, bit) => FrameCount::Counted(bit),
        };
        Ok(Self::Request(service, count))
    }

    /// Its byte.
    pub fn byte(self) -> u8 {
        match self {
            Self::Request(service, count) => {
                let code = SERVICES.iter().find(|row| row.1 == service).map_or(0, |row| row.0);
                let counted = match count {
                    FrameCount::None => 0,
                    FrameCount::First => FCB,
                    FrameCount::Counted(false) => FCV,
                    FrameCount::Counted(true) => FCV | FCB,
                };
                REQUEST | counted | code
            }
            Self::Answer(station, status) => {
                let kind = STATIONS.iter().position(|other| *other == station).unwrap_or_default();
                let code = STATUSES.iter().find(|row| row.1 == status).map_or(0, |row| row.0);
                u8::try_from(kind << 4).unwrap_or_default() | code
            }
        }
    }
}

//! Codec for the blocks of Connect and its answer.

use super::block::{self, Block, BlockType};
use super::frame::{ETHER_TYPE, TAG_HIGH, TAG_LOW};
use super::{Mac, Reader, Uuid, WireError, Writer, count16, text};

mod modules;

pub use self::modules::{DataDescription, ExpectedModule, ExpectedSubmodule, ModuleDiff, SubmoduleDiff};
use self::modules::{read_diff, read_expected, write_diff, write_expected};

/// ARProperties for advanced startup. The connection is active, and the controller is the parameter server.
pub const ADVANCED: u32 = 0x4000_0011;
/// ARProperties for legacy startup. The connection is active, and the controller is the parameter server.
pub const LEGACY: u32 = 0x0000_0011;
/// Frame id in a request that means: the device selects the frame id.
pub const ANY_FRAME_ID: u16 = 0xFFFF;

/// ARBlockReq: the connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ar {
    /// AR type: 1 for a controller with cyclic data.
    pub kind: u16,
    /// UUID of the connection.
    pub uuid: Uuid,
    /// Session key, different for each connection.
    pub session_key: u16,
    /// MAC address of the controller.
    pub mac: Mac,
    /// Object UUID of the controller.
    pub object: Uuid,
    /// ARProperties; see [`ADVANCED`].
    pub properties: u32,
    /// Time for which the device waits for the next step of the controller, in units of 100 ms.
    pub activity_timeout: u16,
    /// EtherType of alarm frames.
    pub port: u16,
    /// Station name of the controller.
    pub name: String,
}

/// IOCRBlockReq: cyclic data of one direction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Iocr {
    /// IOCR type: 1 from the device, 2 to the device.
    pub kind: u16,
    /// IOCR reference, unique in the connection.
    pub reference: u16,
    /// EtherType of the frames.
    pub ether_type: u16,
    /// RT class 1 or 2.
    pub properties: u32,
    /// Length of data, statuses and padding in bytes.
    pub length: u16,
    /// Frame id.
    pub frame_id: u16,
    /// Send clock in units of 31.25 us.
    pub send_clock: u16,
    /// Reduction ratio: number of send clocks in the cycle time.
    pub ratio: u16,
    /// Phase in the cycle.
    pub phase: u16,
    /// Order of the frame within the phase.
    pub sequence: u16,
    /// Send offset within the phase. All ones means as soon as possible.
    pub offset: u32,
    /// Watchdog time in cycles.
    pub watchdog: u16,
    /// Data hold time in cycles.
    pub data_hold_factor: u16,
    /// VLAN tag.
    pub tag: u16,
    /// Multicast address of the frames.
    pub group: Mac,
    /// Positions of the data objects.
    pub objects: Vec<Offset>,
    /// Positions of the consumer statuses.
    pub consumers: Vec<Offset>,
}

/// Position in cyclic data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Offset {
    /// Slot of the submodule.
    pub slot: u16,
    /// Subslot of the submodule.
    pub subslot: u16,
    /// Offset in bytes.
    pub offset: u16,
}

/// AlarmCRBlockReq: the alarm channels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AlarmCr {
    /// Alarm CR type, always 1.
    pub kind: u16,
    /// EtherType of alarm frames.
    pub ether_type: u16,
    /// Properties, always 0.
    pub properties: u32,
    /// Time limit for an acknowledgement, in units of 100 ms.
    pub timeout: u16,
    /// Number of repetitions.
    pub retries: u16,
    /// Alarm reference of the sender.
    pub reference: u16,
    /// Maximum length of an alarm in bytes.
    pub max_len: u16,
    /// VLAN tags of the high and low channel.
    pub tags: (u16, u16),
}

/// A block of Connect.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Request {
    /// The connection (AR).
    Ar(Ar),
    /// Cyclic data of one direction (IOCR).
    Iocr(Iocr),
    /// The alarm channels (alarm CR).
    AlarmCr(AlarmCr),
    /// Expected modules.
    Expected(Vec<ExpectedModule>),
    /// A block of another type.
    Other(BlockType),
}

impl Request {
    /// Decodes the blocks of a Connect in order.
    pub fn parse_all(bytes: &[u8]) -> Result<Vec<Self>, WireError> {
        block::walk(bytes)?.iter().map(Self::parse).collect()
    }

    fn parse(block: &Block<'_>) -> Result<Self, WireError> {
        let mut reader = Reader::big(block.body);
        Ok(match block.kind {
            BlockType::AR => Self::Ar(Ar::read(&mut reader)?),
            BlockType::IOCR => Self::Iocr(Iocr::read(&mut reader)?),
            BlockType::ALARM_CR => Self::AlarmCr(AlarmCr::read(&mut reader)?),
            BlockType::EXPECTED => Self::Expected(read_expected(&mut reader)?),
            other => Self::Other(other),
        })
    }

    /// Encodes the block.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        let kind = match self {
            Self::Ar(ar) => {
                ar.write(&mut out);
                BlockType::AR
            }
            Self::Iocr(iocr) => {
                iocr.write(&mut out);
                BlockType::IOCR
            }
            Self::AlarmCr(alarm) => {
                alarm.write(&mut out);
                BlockType::ALARM_CR
            }
            Self::Expected(modules) => {
                write_expected(modules, &mut out);
                BlockType::EXPECTED
            }
            Self::Other(kind) => *kind,
        };
        block::emit(kind, &out.bytes)
    }
}

impl Ar {
    fn read(reader: &mut Reader<'_>) -> Result<Self, WireError> {
        let kind = reader.u16("ARType")?;
        let uuid = reader.uuid("ARUUID")?;
        let session_key = reader.u16("SessionKey")?;
        let mac = reader.mac("CMInitiatorMacAdd")?;
        let object = reader.uuid("CMInitiatorObjectUUID")?;
        let properties = reader.u32("ARProperties")?;
        let activity_timeout = reader.u16("CMInitiatorActivityTimeoutFactor")?;
        let port = reader.u16("InitiatorUDPRTPort")?;
        let length = reader.u16("StationNameLength")?;
        let name = text(reader.take(usize::from(length), "CMInitiatorStationName")?);
        Ok(Self { kind, uuid, session_key, mac, object, properties, activity_timeout, port, name })
    }

    fn write(&self, out: &mut Writer) {
        out.u16(self.kind);
        out.uuid(self.uuid);
        out.u16(self.session_key);
        out.put(&self.mac.0);
        out.uuid(self.object);
        out.u32(self.properties);
        out.u16(self.activity_timeout);
        out.u16(self.port);
        out.u16(count16(self.name.len()));
        out.put(self.name.as_bytes());
    }
}

impl Iocr {
    fn read(reader: &mut Reader<'_>) -> Result<Self, WireError> {
        let kind = reader.u16("IOCRType")?;
        let reference = reader.u16("IOCRReference")?;
        let ether_type = reader.u16("LT")?;
        let properties = reader.u32("IOCRProperties")?;
        let length = reader.u16("DataLength")?;
        let frame_id = reader.u16("FrameID")?;
        let send_clock = reader.u16("SendClockFactor")?;
        let ratio = reader.u16("ReductionRatio")?;
        let phase = reader.u16("Phase")?;
        let sequence = reader.u16("Sequence")?;
        let offset = reader.u32("FrameSendOffset")?;
        let watchdog = reader.u16("WatchdogFactor")?;
        let data_hold_factor = reader.u16("DataHoldFactor")?;
        let tag = reader.u16("IOCRTagHeader")?;
        let group = reader.mac("IOCRMulticastMACAdd")?;
        let (mut objects, mut consumers) = (Vec::new(), Vec::new());
        for _ in 0..reader.u16("NumberOfAPIs")? {
            reader.u32("API")?;
            objects.extend(read_offsets(reader, "NumberOfIODataObjects")?);
            consumers.extend(read_offsets(reader, "NumberOfIOCS")?);
        }
        Ok(Self {
            kind,
            reference,
            ether_type,
            properties,
            length,
            frame_id,
            send_clock,
            ratio,
            phase,
            sequence,
            offset,
            watchdog,
            data_hold_factor,
            tag,
            group,
            objects,
            consumers,
        })
    }

    fn write(&self, out: &mut Writer) {
        out.u16(self.kind);
        out.u16(self.reference);
        out.u16(self.ether_type);
        out.u32(self.properties);
        for number in [self.length, self.frame_id, self.send_clock, self.ratio, self.phase, self.sequence] {
            out.u16(number);
        }
        out.u32(self.offset);
        out.u16(self.watchdog);
        out.u16(self.data_hold_factor);
        out.u16(self.tag);
        out.put(&self.group.0);
        out.u16(1);
        out.u32(0);
        for offsets in [&self.objects, &self.consumers] {
            out.u16(count16(offsets.len()));
            for place in offsets {
                out.u16(place.slot);
                out.u16(place.subslot);
                out.u16(place.offset);
            }
        }
    }
}

fn read_offsets(reader: &mut Reader<'_>, field: &'static str) -> Result<Vec<Offset>, WireError> {
    let count = reader.u16(field)?;
    (0..count)
        .map(|_| {
            let slot = reader.u16("SlotNumber")?;
            let subslot = reader.u16("SubslotNumber")?;
            Ok(Offset { slot, subslot, offset: reader.u16("FrameOffset")? })
        })
        .collect()
}

impl AlarmCr {
    /// Returns the block with the usual values: 100 ms, three repetitions, 200 bytes.
    pub const fn with_defaults(reference: u16) -> Self {
        Self {
            kind: 1,
            ether_type: ETHER_TYPE,
            properties: 0,
            timeout: 1,
            retries: 3,
            reference,
            max_len: 200,
            tags: (TAG_HIGH, TAG_LOW),
        }
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, WireError> {
        Ok(Self {
            kind: reader.u16("AlarmCRType")?,
            ether_type: reader.u16("LT")?,
            properties: reader.u32("AlarmCRProperties")?,
            timeout: reader.u16("RTATimeoutFactor")?,
            retries: reader.u16("RTARetries")?,
            reference: reader.u16("LocalAlarmReference")?,
            max_len: reader.u16("MaxAlarmDataLength")?,
            tags: (reader.u16("AlarmCRTagHeaderHigh")?, reader.u16("AlarmCRTagHeaderLow")?),
        })
    }

    fn write(&self, out: &mut Writer) {
        out.u16(self.kind);
        out.u16(self.ether_type);
        out.u32(self.properties);
        for number in [self.timeout, self.retries, self.reference, self.max_len, self.tags.0, self.tags.1] {
            out.u16(number);
        }
    }
}

/// A block of the answer to Connect. ApplicationReady can also contain a ModuleDiffBlock.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Response {
    /// The connection (AR).
    Ar {
        /// UUID of the connection.
        uuid: Uuid,
        /// Session key.
        session_key: u16,
        /// MAC address of the device.
        mac: Mac,
    },
    /// Cyclic data of one direction (IOCR).
    Iocr {
        /// IOCR type: 1 from the device, 2 to the device.
        kind: u16,
        /// IOCR reference.
        reference: u16,
        /// Frame id.
        frame_id: u16,
    },
    /// The alarm channels (alarm CR).
    AlarmCr {
        /// Alarm reference of the device.
        reference: u16,
        /// Maximum length of an alarm in bytes.
        max_len: u16,
    },
    /// Differences from the expected modules.
    ModuleDiff(Vec<ModuleDiff>),
    /// Station name of the device.
    Name(String),
    /// A block of another type.
    Other(BlockType),
}

impl Response {
    /// Decodes the blocks of an answer in order.
    pub fn parse_all(bytes: &[u8]) -> Result<Vec<Self>, WireError> {
        block::walk(bytes)?.iter().map(Self::parse).collect()
    }

    /// Decodes one block.
    pub fn parse(block: &Block<'_>) -> Result<Self, WireError> {
        let mut reader = Reader::big(block.body);
        let reader = &mut reader;
        Ok(match BlockType(block.kind.0) {
            BlockType(0x8101) => {
                reader.u16("ARType")?;
                let uuid = reader.uuid("ARUUID")?;
                let session_key = reader.u16("SessionKey")?;
                Self::Ar { uuid, session_key, mac: reader.mac("CMResponderMacAdd")? }
            }
            BlockType(0x8102) => Self::Iocr {
                kind: reader.u16("IOCRType")?,
                reference: reader.u16("IOCRReference")?,
                frame_id: reader.u16("FrameID")?,
            },
            BlockType(0x8103) => {
                reader.u16("AlarmCRType")?;
                Self::AlarmCr {
                    reference: reader.u16("LocalAlarmReference")?,
                    max_len: reader.u16("MaxAlarmDataLength")?,
                }
            }
            BlockType::MODULE_DIFF => Self::ModuleDiff(read_diff(reader)?),
            BlockType::AR_SERVER => {
                let length = reader.u16("StationNameLength")?;
                Self::Name(text(reader.take(usize::from(length), "CMResponderStationName")?))
            }
            other => Self::Other(other),
        })
    }

    /// Encodes the block.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        let kind = match self {
            Self::Ar { uuid, session_key, mac } => {
                out.u16(1);
                out.uuid(*uuid);
                out.u16(*session_key);
                out.put(&mac.0);
                out.u16(ETHER_TYPE);
                BlockType::AR.answer()
            }
            Self::Iocr { kind, reference, frame_id } => {
                out.u16(*kind);
                out.u16(*reference);
                out.u16(*frame_id);
                BlockType::IOCR.answer()
            }
            Self::AlarmCr { reference, max_len } => {
                out.u16(1);
                out.u16(*reference);
                out.u16(*max_len);
                BlockType::ALARM_CR.answer()
            }
            Self::ModuleDiff(modules) => {
                write_diff(modules, &mut out);
                BlockType::MODULE_DIFF
            }
            Self::Name(name) => {
                out.u16(count16(name.len()));
                out.put(name.as_bytes());
                // In an answer, a block is padded so that its length, with the header of six bytes, is a multiple of
                // four bytes.
                out.zeros((4 - (6 + out.bytes.len()) % 4) % 4);
                BlockType::AR_SERVER
            }
            Self::Other(kind) => *kind,
        };
        block::emit(kind, &out.bytes)
    }
}

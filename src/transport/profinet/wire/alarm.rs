//! Codec for alarms and their transport protocol (RTA).

use super::block::{self, Block, BlockType};
use super::frame::{TAG_HIGH, TAG_LOW, id};
use super::{Reader, WireError, Writer, count16};

/// Flag in a frame that requires an acknowledgement.
const WANTS_ACK: u8 = 0x10;
/// Window size: only one frame may be unacknowledged.
const WINDOW: u8 = 1;
/// Sequence number of the first frame.
pub const FIRST: u16 = 0xFFFF;
/// Acknowledged sequence number before the first frame.
pub const NONE: u16 = 0xFFFE;

/// Alarm channel of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Priority {
    /// Process alarms.
    High,
    /// All other alarms.
    Low,
}

impl Priority {
    /// Both alarm channels.
    pub const ALL: [Self; 2] = [Self::High, Self::Low];

    /// Frame id of the channel.
    pub const fn frame_id(self) -> u16 {
        match self {
            Self::High => id::ALARM_HIGH,
            Self::Low => id::ALARM_LOW,
        }
    }

    /// VLAN tag of the channel.
    pub const fn tag(self) -> u16 {
        match self {
            Self::High => TAG_HIGH,
            Self::Low => TAG_LOW,
        }
    }

    /// Channel of a frame id.
    pub const fn from_frame_id(id: u16) -> Option<Self> {
        match id {
            id::ALARM_HIGH => Some(Self::High),
            id::ALARM_LOW => Some(Self::Low),
            _ => None,
        }
    }
}

/// Type of an RTA frame.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Pdu {
    /// An alarm or its acknowledgement.
    Data(Vec<u8>),
    /// Negative transport acknowledgement.
    Nack,
    /// Positive transport acknowledgement.
    Ack,
    /// Error: closes the connection with this status.
    Error(u32),
}

/// An RTA frame without its frame id.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rta {
    /// Alarm reference of the receiver.
    pub destination: u16,
    /// Alarm reference of the sender.
    pub source: u16,
    /// Sequence number of the frame.
    pub sequence: u16,
    /// Sequence number of the last frame that the sender has received.
    pub acknowledged: u16,
    /// Type and content.
    pub pdu: Pdu,
}

impl Rta {
    /// Decodes the payload of a frame.
    ///
    /// # Errors
    /// The payload is not an RTA frame of version 1, or is too short.
    pub fn parse(payload: &[u8]) -> Result<Self, WireError> {
        let mut reader = Reader::big(payload);
        let destination = reader.u16("AlarmDstEndpoint")?;
        let source = reader.u16("AlarmSrcEndpoint")?;
        let kind = reader.u8("PDUType")?;
        reader.u8("AddFlags")?;
        let sequence = reader.u16("SendSeqNum")?;
        let acknowledged = reader.u16("AckSeqNum")?;
        let length = reader.u16("VarPartLen")?;
        let mut data = Reader { at: 0, ..Reader::big(reader.take(usize::from(length), "RTA-SDU")?) };
        let pdu = match kind {
            0x11 => Pdu::Data(data.rest().to_vec()),
            0x12 => Pdu::Nack,
            0x13 => Pdu::Ack,
            // More bytes may follow after the status, because devices of Siemens append some.
            0x14 => Pdu::Error(data.u32("PNIOStatus")?),
            other => return Err(WireError { offset: 4, ..reader.wrong("PDUType", 1, other) }),
        };
        Ok(Self { destination, source, sequence, acknowledged, pdu })
    }

    /// Encodes the frame.
    pub fn emit(&self) -> Vec<u8> {
        let (kind, flags, data) = match &self.pdu {
            Pdu::Data(data) => (0x11, WANTS_ACK | WINDOW, data.clone()),
            Pdu::Nack => (0x12, WINDOW, Vec::new()),
            Pdu::Ack => (0x13, WINDOW, Vec::new()),
            Pdu::Error(status) => (0x14, WINDOW, status.to_be_bytes().to_vec()),
        };
        let mut out = Writer::default();
        out.u16(self.destination);
        out.u16(self.source);
        out.put(&[kind, flags]);
        out.u16(self.sequence);
        out.u16(self.acknowledged);
        out.u16(count16(data.len()));
        out.put(&data);
        out.bytes
    }
}

/// Returns the next sequence number. 0 follows after 0xFFFF and also after 0x7FFF.
pub const fn next_sequence(sequence: u16) -> u16 {
    sequence.wrapping_add(1) & 0x7FFF
}

/// An alarm notification.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notification {
    /// Channel of the alarm.
    pub priority: Priority,
    /// Alarm type; see [`describe`].
    pub kind: u16,
    /// API (profile), always 0.
    pub api: u32,
    /// Slot.
    pub slot: u16,
    /// Subslot.
    pub subslot: u16,
    /// Ident number of the module.
    pub module: u32,
    /// Ident number of the submodule.
    pub submodule: u32,
    /// Sequence number and diagnosis flags.
    pub specifier: u16,
    /// Additional data: structure identifier and bytes.
    pub detail: Option<(u16, Vec<u8>)>,
}

impl Notification {
    /// Decodes a DATA frame.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let block = first_block(data)?;
        let priority = match block.kind {
            BlockType::ALARM_HIGH => Priority::High,
            BlockType::ALARM_LOW => Priority::Low,
            other => return Err(Reader::big(data).wrong("BlockType", 0, other.0)),
        };
        let mut reader = Reader::big(block.body);
        let kind = reader.u16("AlarmType")?;
        let api = reader.u32("API")?;
        let slot = reader.u16("SlotNumber")?;
        let subslot = reader.u16("SubslotNumber")?;
        let module = reader.u32("ModuleIdentNumber")?;
        let submodule = reader.u32("SubmoduleIdentNumber")?;
        let specifier = reader.u16("AlarmSpecifier")?;
        let detail = reader.u16("UserStructureIdentifier").ok().map(|layout| (layout, reader.rest().to_vec()));
        Ok(Self { priority, kind, api, slot, subslot, module, submodule, specifier, detail })
    }

    /// Encodes the notification.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u16(self.kind);
        out.u32(self.api);
        out.u16(self.slot);
        out.u16(self.subslot);
        out.u32(self.module);
        out.u32(self.submodule);
        out.u16(self.specifier);
        if let Some((layout, bytes)) = &self.detail {
            out.u16(*layout);
            out.put(bytes);
        }
        block::emit(block_type(self.priority), &out.bytes)
    }

    /// Returns the acknowledgement of this alarm.
    pub const fn acknowledge(&self) -> Acknowledgement {
        let Self { priority, kind, api, slot, subslot, specifier, .. } = *self;
        Acknowledgement { priority, kind, api, slot, subslot, specifier, status: 0 }
    }

    /// Text of the alarm.
    pub fn describe(&self) -> String {
        let mut text = format!("{} at slot {}, subslot {:#x}", describe(self.kind), self.slot, self.subslot);
        if let Some((0x8000 | 0x8002, detail)) = &self.detail
            && let Some(error) = detail.get(4..6)
        {
            text += &format!(", channel error {:#06x}", u16::from_be_bytes([error[0], error[1]]));
        }
        text
    }
}

/// Acknowledgement of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Acknowledgement {
    /// Channel of the alarm.
    pub priority: Priority,
    /// Type of the alarm.
    pub kind: u16,
    /// API of the alarm.
    pub api: u32,
    /// Slot of the alarm.
    pub slot: u16,
    /// Subslot of the alarm.
    pub subslot: u16,
    /// Specifier of the alarm.
    pub specifier: u16,
    /// Status, always 0.
    pub status: u32,
}

impl Acknowledgement {
    /// Decodes a DATA frame.
    pub fn parse(data: &[u8]) -> Result<Self, WireError> {
        let block = first_block(data)?;
        let fits = |priority: &Priority| block_type(*priority).answer() == block.kind;
        let priority = Priority::ALL.into_iter().find(fits);
        let priority = priority.ok_or(Reader::big(data).wrong("BlockType", 0, block.kind.0))?;
        let mut reader = Reader::big(block.body);
        Ok(Self {
            priority,
            kind: reader.u16("AlarmType")?,
            api: reader.u32("API")?,
            slot: reader.u16("SlotNumber")?,
            subslot: reader.u16("SubslotNumber")?,
            specifier: reader.u16("AlarmSpecifier")?,
            status: reader.u32("PNIOStatus")?,
        })
    }

    /// Encodes the acknowledgement.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u16(self.kind);
        out.u32(self.api);
        out.u16(self.slot);
        out.u16(self.subslot);
        out.u16(self.specifier);
        out.u32(self.status);
        block::emit(block_type(self.priority).answer(), &out.bytes)
    }
}

fn first_block(data: &[u8]) -> Result<Block<'_>, WireError> {
    block::walk(data)?.into_iter().next().ok_or(Reader::big(data).missing("block"))
}

const fn block_type(priority: Priority) -> BlockType {
    match priority {
        Priority::High => BlockType::ALARM_HIGH,
        Priority::Low => BlockType::ALARM_LOW,
    }
}

/// Text of an alarm type.
pub fn describe(kind: u16) -> &'static str {
    match kind {
        0x01 => "diagnosis",
        0x02 => "process alarm",
        0x03 => "module pulled",
        0x04 => "module plugged",
        0x05 => "status",
        0x06 => "update",
        0x07 => "redundancy",
        0x08 => "controlled by a supervisor",
        0x09 => "released by a supervisor",
        0x0A => "wrong module plugged",
        0x0B => "return of a submodule",
        0x0C => "diagnosis disappeared",
        0x0D => "multicast communication mismatch",
        0x0E => "port data change",
        0x0F => "sync data change",
        0x10 => "isochronous mode problem",
        0x11 => "network component problem",
        0x12 => "time data change",
        0x1E => "upload and retrieval",
        0x1F => "module pulled with its submodules",
        _ => "alarm",
    }
}

/// Whether the device needs its parameters again after this alarm.
pub const fn wants_parameters(kind: u16) -> bool {
    matches!(kind, 0x04 | 0x0A | 0x0B)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    /// The bytes of a diagnosis and its answer are from the notes on alarms.
    #[test]
    fn an_alarm_and_its_answers_are_as_seen() {
        let bytes = hex(concat!(
            "0001 0000 11 11 FFFF FFFE 0022 0002 001E 0100 0001 00000000 0001 0001 00000101 00000001 A800",
            "8000 0000 28000006",
        ));
        let rta = Rta::parse(&bytes).unwrap();
        assert_eq!(rta.emit(), bytes);
        assert_eq!((rta.destination, rta.source, rta.sequence, rta.acknowledged), (1, 0, FIRST, NONE));
        let Pdu::Data(data) = &rta.pdu else { panic!("{rta:?}") };
        let alarm = Notification::parse(data).unwrap();
        assert_eq!(alarm.emit(), *data);
        assert_eq!((alarm.kind, alarm.slot, alarm.module, alarm.specifier), (1, 1, 0x101, 0xA800));
        assert_eq!(alarm.describe(), "diagnosis at slot 1, subslot 0x1, channel error 0x0006");
        let ack = Rta { destination: 0, source: 1, sequence: NONE, acknowledged: FIRST, pdu: Pdu::Ack };
        assert_eq!(ack.emit(), hex("0000 0001 13 01 FFFE FFFF 0000"));
        let noted = Rta { sequence: FIRST, pdu: Pdu::Data(alarm.acknowledge().emit()), ..ack };
        let printed = hex("0000 0001 11 11 FFFF FFFF 0016 8002 0012 0100 0001 00000000 0001 0001 A800 00000000");
        assert_eq!(noted.emit(), printed);
        assert_eq!(Rta::parse(&printed), Ok(noted));
        assert_eq!(Acknowledgement::parse(&alarm.acknowledge().emit()), Ok(alarm.acknowledge()));
    }

    #[test]
    fn parses_errors_with_siemens_extensions() {
        let rta = Rta::parse(&hex("0000 0000 14 01 0005 0005 0004 CF81FD0B 002A010E")).unwrap();
        assert_eq!(rta.pdu, Pdu::Error(0xCF81_FD0B));
        assert_eq!(Rta::parse(&hex("0000 0000 15 01 0005 0005 0000")).unwrap_err().offset, 4);
    }

    #[test]
    fn sequence_numbers_skip_the_start_value() {
        assert_eq!((next_sequence(FIRST), next_sequence(0), next_sequence(0x7FFF)), (0, 1, 0));
    }
}

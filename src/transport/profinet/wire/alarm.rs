//! Alarms, and the protocol RTA that carries them between two cards.

use super::block::{self, Block, BlockType};
use super::frame::{TAG_HIGH, TAG_LOW, id};
use super::{Reader, WireError, Writer, count16};

/// Flag of a frame that wants an acknowledgement.
const WANTS_ACK: u8 = 0x10;
/// One frame on its way at a time.
const WINDOW: u8 = 1;
/// What a sequence number is before the first frame.
pub const FIRST: u16 = 0xFFFF;
/// Likewise the number of what was last received.
pub const NONE: u16 = 0xFFFE;

/// Which of the two channels of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Priority {
    /// Process alarms.
    High,
    /// All others.
    Low,
}

impl Priority {
    /// Both.
    pub const ALL: [Self; 2] = [Self::High, Self::Low];

    /// The id of its frames.
    pub const fn frame_id(self) -> u16 {
        match self {
            Self::High => id::ALARM_HIGH,
            Self::Low => id::ALARM_LOW,
        }
    }

    /// The tag of its frames.
    pub const fn tag(self) -> u16 {
        match self {
            Self::High => TAG_HIGH,
            Self::Low => TAG_LOW,
        }
    }

    /// By the id of a frame.
    pub const fn from_frame_id(id: u16) -> Option<Self> {
        match id {
            id::ALARM_HIGH => Some(Self::High),
            id::ALARM_LOW => Some(Self::Low),
            _ => None,
        }
    }
}

/// What a frame of RTA does.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Pdu {
    /// Carries an alarm, or that it was noted.
    Data(Vec<u8>),
    /// Something was not taken.
    Nack,
    /// Something arrived.
    Ack,
    /// Ends the connection, with the reason.
    Error(u32),
}

/// A frame of RTA, behind its id.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rta {
    /// The number that the receiver gave for the connection.
    pub destination: u16,
    /// The sender's.
    pub source: u16,
    /// Counts what is sent.
    pub sequence: u16,
    /// What was last received.
    pub acknowledged: u16,
    /// What it does.
    pub pdu: Pdu,
}

impl Rta {
    /// Reads what a frame carries behind its id.
    ///
    /// # Errors
    /// When it is no RTA of version 1, or cut short.
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
            // Siemens appends more.
            0x14 => Pdu::Error(data.u32("PNIOStatus")?),
            other => return Err(WireError { offset: 4, ..reader.wrong("PDUType", 1, other) }),
        };
        Ok(Self { destination, source, sequence, acknowledged, pdu })
    }

    /// The bytes.
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

/// The number after this one: 0xFFFF is followed by 0, and so is 0x7FFF.
pub const fn next_sequence(sequence: u16) -> u16 {
    sequence.wrapping_add(1) & 0x7FFF
}

/// What happened, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Notification {
    /// Over which channel it came.
    pub priority: Priority,
    /// What happened; see [`describe`].
    pub kind: u16,
    /// The profile; 0.
    pub api: u32,
    /// The slot.
    pub slot: u16,
    /// The subslot.
    pub subslot: u16,
    /// The module there.
    pub module: u32,
    /// The submodule there.
    pub submodule: u32,
    /// Its number, and which diagnoses there are.
    pub specifier: u16,
    /// What is said of it: the layout, and the bytes.
    pub detail: Option<(u16, Vec<u8>)>,
}

impl Notification {
    /// Reads what a DATA frame carries.
    ///
    /// # Errors
    /// When it is another block, or cut short.
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

    /// The bytes.
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

    /// That it was noted.
    pub const fn acknowledge(&self) -> Acknowledgement {
        let Self { priority, kind, api, slot, subslot, specifier, .. } = *self;
        Acknowledgement { priority, kind, api, slot, subslot, specifier, status: 0 }
    }

    /// What happened, in words.
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

/// That an alarm was noted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Acknowledgement {
    /// As in the alarm.
    pub priority: Priority,
    /// As in the alarm.
    pub kind: u16,
    /// As in the alarm.
    pub api: u32,
    /// As in the alarm.
    pub slot: u16,
    /// As in the alarm.
    pub subslot: u16,
    /// As in the alarm.
    pub specifier: u16,
    /// 0.
    pub status: u32,
}

impl Acknowledgement {
    /// Reads what a DATA frame carries.
    ///
    /// # Errors
    /// When it is another block, or cut short.
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

    /// The bytes.
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

/// A type of alarm in words.
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

/// Whether a device waits for new parameters after this alarm.
pub const fn wants_parameters(kind: u16) -> bool {
    matches!(kind, 0x04 | 0x0A | 0x0B)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    /// notes, alarms: a diagnosis and what was answered to it.
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
    fn errors_are_read_with_what_siemens_appends() {
        let rta = Rta::parse(&hex("0000 0000 14 01 0005 0005 0004 CF81FD0B 002A010E")).unwrap();
        assert_eq!(rta.pdu, Pdu::Error(0xCF81_FD0B));
        assert_eq!(Rta::parse(&hex("0000 0000 15 01 0005 0005 0000")).unwrap_err().offset, 4);
    }

    #[test]
    fn numbers_go_on_after_the_first_and_the_last() {
        assert_eq!((next_sequence(FIRST), next_sequence(0), next_sequence(0x7FFF)), (0, 1, 0));
    }
}

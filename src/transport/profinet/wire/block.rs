//! Codec for blocks. Calls and answers consist of blocks.

use super::{Reader, Uuid, WireError, Writer, count16};

/// Block type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BlockType(pub u16);

impl BlockType {
    /// High-priority alarm.
    pub const ALARM_HIGH: Self = Self(0x0001);
    /// Low-priority alarm.
    pub const ALARM_LOW: Self = Self(0x0002);
    /// Write a record.
    pub const WRITE: Self = Self(0x0008);
    /// Read a record.
    pub const READ: Self = Self(0x0009);
    /// Modules that are really plugged into the device.
    pub const REAL_IDENTIFICATION: Self = Self(0x0013);
    /// I&M0: identification of the device.
    pub const IM0: Self = Self(0x0020);
    /// Connection (AR).
    pub const AR: Self = Self(0x0101);
    /// Cyclic data of one direction (IOCR).
    pub const IOCR: Self = Self(0x0102);
    /// Alarms of a connection (alarm CR).
    pub const ALARM_CR: Self = Self(0x0103);
    /// Expected modules.
    pub const EXPECTED: Self = Self(0x0104);
    /// End of parameters.
    pub const PRM_END: Self = Self(0x0110);
    /// End of parameters after a module was plugged.
    pub const PLUG_PRM_END: Self = Self(0x0111);
    /// The device is ready for data.
    pub const APPLICATION_READY: Self = Self(0x0112);
    /// The device is ready after a module was plugged.
    pub const PLUG_APPLICATION_READY: Self = Self(0x0113);
    /// Release the connection.
    pub const RELEASE: Self = Self(0x0114);
    /// Differences from the expected modules.
    pub const MODULE_DIFF: Self = Self(0x8104);
    /// Station name of the device.
    pub const AR_SERVER: Self = Self(0x8106);

    /// Returns the block type of the answer to this block.
    #[must_use]
    pub const fn answer(self) -> Self {
        Self(self.0 | 0x8000)
    }
}

/// A block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block<'a> {
    /// Block type.
    pub kind: BlockType,
    /// Version, 1.0 or 1.1.
    pub version: (u8, u8),
    /// Content after the header.
    pub body: &'a [u8],
}

/// Splits a call or answer into blocks.
pub fn walk(bytes: &[u8]) -> Result<Vec<Block<'_>>, WireError> {
    let mut reader = Reader::big(bytes);
    let mut blocks = Vec::new();
    while reader.left() > 0 {
        blocks.push(read(&mut reader)?);
        // In answers, blocks may be padded to a multiple of four bytes. Padding can be recognized, because no block
        // type starts with a zero byte.
        let padding = reader.left().min(reader.at.next_multiple_of(4) - reader.at);
        if reader.bytes.iter().skip(reader.at).take(padding).all(|byte| *byte == 0) {
            reader.at += padding;
        }
    }
    Ok(blocks)
}

fn read<'a>(reader: &mut Reader<'a>) -> Result<Block<'a>, WireError> {
    let kind = BlockType(reader.u16("BlockType")?);
    let length = reader.u16("BlockLength")?;
    let Some(body) = usize::from(length).checked_sub(2) else {
        return Err(reader.wrong("BlockLength", 2, length));
    };
    let version = (reader.u8("BlockVersionHigh")?, reader.u8("BlockVersionLow")?);
    Ok(Block { kind, version, body: reader.take(body, "block")? })
}

/// Encodes a block of version 1.0.
pub fn emit(kind: BlockType, body: &[u8]) -> Vec<u8> {
    emit_version(kind, (1, 0), body)
}

/// Encodes a block of another version.
pub fn emit_version(kind: BlockType, version: (u8, u8), body: &[u8]) -> Vec<u8> {
    let mut out = Writer::default();
    out.u16(kind.0);
    out.u16(count16(body.len() + 2));
    out.put(&[version.0, version.1]);
    out.put(body);
    out.bytes
}

/// Content of PrmEnd, ApplicationReady, Release, and their answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Control {
    /// Block type.
    pub kind: BlockType,
    /// UUID of the connection.
    pub ar: Uuid,
    /// Session key of the connection.
    pub session_key: u16,
    /// Number of the command. In an answer, 8 means done.
    pub command: u16,
    /// Properties of the command.
    pub properties: u16,
}

impl Control {
    /// Command number in a positive answer: done.
    pub const DONE: u16 = 8;

    /// Creates a call. Its command follows from the block type.
    pub const fn call(kind: BlockType, ar: Uuid, session_key: u16) -> Self {
        let command = match kind {
            BlockType::APPLICATION_READY | BlockType::PLUG_APPLICATION_READY => 2,
            BlockType::RELEASE => 4,
            _ => 1,
        };
        Self { kind, ar, session_key, command, properties: 0 }
    }

    /// Returns the positive answer to this call.
    #[must_use]
    pub const fn answer(&self) -> Self {
        Self { kind: self.kind.answer(), command: Self::DONE, properties: 0, ..*self }
    }

    /// Decodes a block.
    pub fn parse(block: &Block<'_>) -> Result<Self, WireError> {
        let mut reader = Reader::big(block.body);
        reader.u16("reserved")?;
        let ar = reader.uuid("ARUUID")?;
        let session_key = reader.u16("SessionKey")?;
        reader.u16("reserved")?;
        let command = reader.u16("ControlCommand")?;
        let properties = reader.u16("ControlBlockProperties")?;
        Ok(Self { kind: block.kind, ar, session_key, command, properties })
    }

    /// Encodes the block.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.u16(0);
        out.uuid(self.ar);
        out.u16(self.session_key);
        out.u16(0);
        out.u16(self.command);
        out.u16(self.properties);
        emit(self.kind, &out.bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::hex;

    fn uuid() -> Uuid {
        Uuid(hex("11111111222233334444555555555555").try_into().unwrap())
    }

    /// The bytes of PrmEnd, ApplicationReady and Release are from the worked example in the notes.
    #[test]
    fn controls_are_as_printed() {
        let ar = "11111111222233334444555555555555";
        let cases = [
            (BlockType::PRM_END, format!("0110 001C 0100 0000 {ar} 0001 0000 0001 0000"), "8110"),
            (BlockType::APPLICATION_READY, format!("0112 001C 0100 0000 {ar} 0001 0000 0002 0000"), "8112"),
            (BlockType::RELEASE, format!("0114 001C 0100 0000 {ar} 0001 0000 0004 0000"), "8114"),
        ];
        for (kind, text, answer) in cases {
            let control = Control::call(kind, uuid(), 1);
            assert_eq!(control.emit(), hex(&text));
            let bytes = hex(&text);
            let blocks = walk(&bytes).unwrap();
            assert_eq!(Control::parse(&blocks[0]), Ok(control));
            let answered = hex(&format!("{answer} 001C 0100 0000 {ar} 0001 0000 0008 0000"));
            assert_eq!(control.answer().emit(), answered);
        }
    }

    #[test]
    fn iterates_blocks_with_and_without_padding() {
        let bytes = hex("8106 0005 0100 616263 000000 0110 0005 0100 616263 0112 0002 0100 00");
        let kinds: Vec<_> = walk(&bytes).unwrap().iter().map(|block| (block.kind.0, block.body.len())).collect();
        assert_eq!(kinds, [(0x8106, 3), (0x0110, 3), (0x0112, 0)]);
        for text in ["8106", "8106 0005", "8106 0001 0100", "8106 0005 0100 61"] {
            assert!(walk(&hex(text)).is_err(), "{text}");
        }
        assert_eq!(walk(&[]), Ok(Vec::new()));
    }
}

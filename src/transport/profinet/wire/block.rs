//! Blocks: what calls and answers are made of.

use super::{Reader, Uuid, WireError, Writer, count16};

/// What a block is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BlockType(
    /// The number.
    pub u16,
);

impl BlockType {
    /// An alarm of high priority.
    pub const ALARM_HIGH: Self = Self(0x0001);
    /// An alarm of low priority.
    pub const ALARM_LOW: Self = Self(0x0002);
    /// Writes a record.
    pub const WRITE: Self = Self(0x0008);
    /// Reads one.
    pub const READ: Self = Self(0x0009);
    /// Which modules there are.
    pub const REAL_IDENTIFICATION: Self = Self(0x0013);
    /// I&M0.
    pub const IM0: Self = Self(0x0020);
    /// A connection.
    pub const AR: Self = Self(0x0101);
    /// Its cyclic data in one direction.
    pub const IOCR: Self = Self(0x0102);
    /// Its alarms.
    pub const ALARM_CR: Self = Self(0x0103);
    /// Modules that are expected.
    pub const EXPECTED: Self = Self(0x0104);
    /// All parameters were written.
    pub const PRM_END: Self = Self(0x0110);
    /// Likewise after a module was plugged.
    pub const PLUG_PRM_END: Self = Self(0x0111);
    /// The device is ready for data.
    pub const APPLICATION_READY: Self = Self(0x0112);
    /// Likewise after a module was plugged.
    pub const PLUG_APPLICATION_READY: Self = Self(0x0113);
    /// Ends the connection.
    pub const RELEASE: Self = Self(0x0114);
    /// What differs from the modules that are expected.
    pub const MODULE_DIFF: Self = Self(0x8104);
    /// The name of the device.
    pub const AR_SERVER: Self = Self(0x8106);

    /// The type of the answer to it.
    #[must_use]
    pub const fn answer(self) -> Self {
        Self(self.0 | 0x8000)
    }
}

/// A block.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Block<'a> {
    /// What it is.
    pub kind: BlockType,
    /// Its version, 1.0 or 1.1.
    pub version: (u8, u8),
    /// What is behind the header.
    pub body: &'a [u8],
}

/// Cuts what a call or an answer carries into blocks.
///
/// # Errors
/// When a block is longer than what is left.
pub fn walk(bytes: &[u8]) -> Result<Vec<Block<'_>>, WireError> {
    let mut reader = Reader::big(bytes);
    let mut blocks = Vec::new();
    while reader.left() > 0 {
        blocks.push(read(&mut reader)?);
        // Answers may be padded to four bytes; what follows another block never has a type that begins with a zero.
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

/// The bytes of a block, version 1.0.
pub fn emit(kind: BlockType, body: &[u8]) -> Vec<u8> {
    emit_version(kind, (1, 0), body)
}

/// The bytes of a block of another version.
pub fn emit_version(kind: BlockType, version: (u8, u8), body: &[u8]) -> Vec<u8> {
    let mut out = Writer::default();
    out.u16(kind.0);
    out.u16(count16(body.len() + 2));
    out.put(&[version.0, version.1]);
    out.put(body);
    out.bytes
}

/// PrmEnd, ApplicationReady, Release, and their answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Control {
    /// Which one.
    pub kind: BlockType,
    /// The connection.
    pub ar: Uuid,
    /// Its key.
    pub session_key: u16,
    /// What is to be done, or 8: done.
    pub command: u16,
    /// Of the command.
    pub properties: u16,
}

impl Control {
    /// The command of answers.
    pub const DONE: u16 = 8;

    /// A call; the command is that of its type.
    pub const fn call(kind: BlockType, ar: Uuid, session_key: u16) -> Self {
        let command = match kind {
            BlockType::APPLICATION_READY | BlockType::PLUG_APPLICATION_READY => 2,
            BlockType::RELEASE => 4,
            _ => 1,
        };
        Self { kind, ar, session_key, command, properties: 0 }
    }

    /// The answer that it is done.
    #[must_use]
    pub const fn answer(&self) -> Self {
        Self { kind: self.kind.answer(), command: Self::DONE, properties: 0, ..*self }
    }

    /// Reads a block that is one.
    ///
    /// # Errors
    /// When it is cut short.
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

    /// The bytes.
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

    /// notes, worked example: PrmEnd, ApplicationReady, Release.
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
    fn blocks_are_walked_by_their_lengths_with_and_without_padding() {
        let bytes = hex("8106 0005 0100 616263 000000 0110 0005 0100 616263 0112 0002 0100 00");
        let kinds: Vec<_> = walk(&bytes).unwrap().iter().map(|block| (block.kind.0, block.body.len())).collect();
        assert_eq!(kinds, [(0x8106, 3), (0x0110, 3), (0x0112, 0)]);
        for text in ["8106", "8106 0005", "8106 0001 0100", "8106 0005 0100 61"] {
            assert!(walk(&hex(text)).is_err(), "{text}");
        }
        assert_eq!(walk(&[]), Ok(Vec::new()));
    }
}

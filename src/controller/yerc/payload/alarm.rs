//! Alarms (FS and DX 3.3.1, 3.3.2; with sub-code strings 3.3.37, 3.3.38).

use std::fmt;

use super::{PayloadError, Reader, Text, push_u32s};
use crate::controller::yerc::table::ALARM_KINDS;

/// How the sub-code of an alarm is to be read; numbers without a meaning are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct AlarmKind(pub u32);

impl AlarmKind {
    /// What kind of sub-code it is, where the manuals say so.
    pub fn meaning(self) -> Option<&'static str> {
        ALARM_KINDS.iter().find(|(number, _)| *number == self.0).map(|(_, meaning)| *meaning)
    }
}

/// The three texts that 0x30A and 0x30B add.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct AlarmTexts {
    /// Where it comes from, e.g. `[SV#1]`.
    pub source: Text<16>,
    /// The sub-code as the pendant shows it.
    pub sub_code: Text<96>,
    /// One `0` or `1` for each character of the text: 1 is shown reversed.
    pub reversed: Text<96>,
}

/// One alarm; all zero in an empty slot.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Alarm {
    /// 1 to 9999; 0 for no alarm.
    pub code: u32,
    /// The sub-code, to be read by `kind`.
    pub data: u32,
    /// How to read `data`.
    pub kind: AlarmKind,
    /// `YYYY/MM/DD HH:MM`.
    pub time: Text<16>,
    /// In the pendant's language.
    pub name: Text<32>,
    /// Present in answers to 0x30A and 0x30B.
    pub texts: Option<AlarmTexts>,
}

impl Alarm {
    /// Bytes of an answer to 0x70 and 0x71.
    pub const SIZE: usize = 60;
    /// Bytes of an answer to 0x30A and 0x30B.
    pub const SIZE_WITH_TEXTS: usize = 268;

    /// Reads the 60-byte form.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        Self::read(&mut Reader::new("alarm", data))
    }

    /// Reads the 268-byte form.
    pub fn parse_with_texts(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("alarm with sub-code strings", data);
        let alarm = Self::read(&mut reader)?;
        let texts = AlarmTexts { source: reader.text()?, sub_code: reader.text()?, reversed: reader.text()? };
        Ok(Self { texts: Some(texts), ..alarm })
    }

    fn read(reader: &mut Reader<'_>) -> Result<Self, PayloadError> {
        Ok(Self {
            code: reader.u32()?,
            data: reader.u32()?,
            kind: AlarmKind(reader.u32()?),
            time: reader.text()?,
            name: reader.text()?,
            texts: None,
        })
    }

    /// 60 bytes, or 268 with texts.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = Vec::with_capacity(Self::SIZE_WITH_TEXTS);
        push_u32s(&mut out, [self.code, self.data, self.kind.0]);
        out.extend_from_slice(&self.time.emit());
        out.extend_from_slice(&self.name.emit());
        if let Some(AlarmTexts { source, sub_code, reversed }) = &self.texts {
            out.extend_from_slice(&source.emit());
            out.extend_from_slice(&sub_code.emit());
            out.extend_from_slice(&reversed.emit());
        }
        out
    }

    /// Whether the slot is empty.
    pub fn is_none(&self) -> bool {
        self.code == 0
    }

    /// The sub-code as a pendant shows it, e.g. `[3]`.
    ///
    /// Plain numbers and bit patterns are rendered. For axes and groups the manuals print examples but not which bit is
    /// which, so those show the raw word; the texts of 0x30A name them.
    pub fn sub_code(&self) -> SubCode {
        SubCode { kind: self.kind, data: self.data }
    }
}

/// Displays a sub-code by its kind; nothing when there is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SubCode {
    kind: AlarmKind,
    data: u32,
}

impl fmt::Display for SubCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [b0, b1, ..] = self.data.to_le_bytes();
        match self.kind.0 {
            0 if self.data == 0 => Ok(()),
            1 | 6 => write!(f, "[{}]", u16::from_le_bytes([b0, b1])),
            9 => write!(f, "[{}]", i16::from_le_bytes([b0, b1])),
            2 => write!(f, "[{:04b}_{:04b}]", b0 >> 4, b0 & 15),
            10 => write!(f, "[{:04b}_{:04b}_{:04b}_{:04b}]", b1 >> 4, b1 & 15, b0 >> 4, b0 & 15),
            _ => write!(f, "[{:#x}]", self.data),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sub_codes_read_as_on_the_pendant() {
        let show = |kind, data| SubCode { kind: AlarmKind(kind), data }.to_string();
        assert_eq!(show(0, 0), "");
        assert_eq!(show(1, 3), "[3]");
        assert_eq!(show(9, 0xFFFF), "[-1]");
        assert_eq!(show(2, 1), "[0000_0001]");
        assert_eq!(show(10, 0x8001), "[1000_0000_0000_0001]");
        assert_eq!(show(8, 5), "[0x5]");
        assert_eq!(show(13, 0), "[0x0]");
    }
}

//! Alarms (FS and DX 3.3.1, 3.3.2; with sub-code strings 3.3.37, 3.3.38).

use super::reader::{PayloadError, Reader, push_u32s};
use super::text::Text;
use crate::yerc::Model;
use crate::yerc::subcode::{self, AlarmKind, SubCode};

/// The three additional texts in answers to 0x30A (alarm) and 0x30B (alarm history).
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct AlarmTexts {
    /// Source of the alarm, for example `[SV#1]`.
    pub source: Text<16>,
    /// Sub-code as displayed on the pendant.
    pub sub_code: Text<96>,
    /// One `0` or `1` for each character of the sub-code text. The pendant displays a character with a 1 in reverse
    /// video.
    pub reversed: Text<96>,
}

/// An alarm. In an empty slot, all values are zero.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Alarm {
    /// Alarm code, 1 to 9999; 0 for no alarm.
    pub code: u32,
    /// Sub-code. Its format depends on `kind`.
    pub data: u32,
    /// Format of `data`.
    pub kind: AlarmKind,
    /// Time of the alarm, as `YYYY/MM/DD HH:MM`.
    pub time: Text<16>,
    /// Alarm name in the language of the pendant.
    pub name: Text<32>,
    /// Additional texts. Only answers to 0x30A and 0x30B have them.
    pub texts: Option<AlarmTexts>,
}

impl Alarm {
    /// Size in bytes of an alarm in answers to 0x70 (alarm) and 0x71 (alarm history).
    pub const SIZE: usize = 60;
    /// Size in bytes of an alarm with texts, in answers to 0x30A and 0x30B.
    pub const SIZE_WITH_TEXTS: usize = 268;

    /// Parses an alarm of 60 bytes, without texts.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        Self::read(&mut Reader::new("alarm", data))
    }

    /// Parses an alarm of 268 bytes, with texts.
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

    /// Encodes the alarm: 60 bytes, or 268 bytes with the additional texts.
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

    /// Whether the slot is empty, so that there is no alarm.
    pub fn is_none(&self) -> bool {
        self.code == 0
    }

    /// Readable sub-code, rendered by armctl. The texts of 0x30A and 0x30B are better if the controller has them.
    pub fn sub_code(&self, model: Model) -> SubCode {
        subcode::render(self.kind, self.data, model)
    }
}

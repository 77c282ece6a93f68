//! Job, management time, system information (FS and DX 3.3.4, 3.3.25, 3.3.26).

use super::reader::{PayloadError, Reader, push_u32s};
use super::text::Text;

/// Current job of a task.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct JobInfo {
    /// Job name without `.JBI`.
    pub name: Text<32>,
    /// Line number, 0 to 9999.
    pub line: u32,
    /// Step number, 1 to 9998; 0 if no job is executed.
    pub step: u32,
    /// Speed override, in units of 0.01 %.
    pub speed_override: u32,
}

impl JobInfo {
    /// Size of an answer in bytes.
    pub const SIZE: usize = 44;

    /// Parses the data, which must have at least 44 bytes.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("job information", data);
        Ok(Self { name: reader.text()?, line: reader.u32()?, step: reader.u32()?, speed_override: reader.u32()? })
    }

    /// Encodes the data in 44 bytes.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = self.name.emit().to_vec();
        push_u32s(&mut out, [self.line, self.step, self.speed_override]);
        out
    }
}

/// An operating-time counter.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct ManagementTime {
    /// Start of counting, `YYYY/MM/DD HH:MM`.
    pub start: Text<16>,
    /// Elapsed time, for example `000123:45'06`, or without padding `18:19'02`.
    pub elapsed: Text<12>,
}

impl ManagementTime {
    /// Size of an answer in bytes.
    pub const SIZE: usize = 28;

    /// Parses the data, which must have at least 28 bytes.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("management time", data);
        Ok(Self { start: reader.text()?, elapsed: reader.text()? })
    }

    /// Encodes the data in 28 bytes.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = self.start.emit().to_vec();
        out.extend_from_slice(&self.elapsed.emit());
        out
    }

    /// Elapsed time in seconds; `None` for an unknown format.
    pub fn seconds(&self) -> Option<u64> {
        elapsed_seconds(self.elapsed.as_bytes())
    }
}

/// Parses `H:MM'SS` with any number of hour digits and with surrounding blanks. The seconds may be missing, or a colon
/// may stand before them instead of the `'`.
pub fn elapsed_seconds(text: &[u8]) -> Option<u64> {
    let text = std::str::from_utf8(text).ok()?.trim();
    let mut parts = text.split([':', '\'']).map(|part| {
        let part = part.trim();
        part.bytes().all(|byte| byte.is_ascii_digit()).then(|| part.parse::<u64>().ok())?
    });
    let hours = parts.next()??;
    let minutes = parts.next()?.filter(|&minutes| minutes < 60)?;
    let seconds = match parts.next() {
        Some(seconds) => seconds.filter(|&seconds| seconds < 60)?,
        None => 0,
    };
    if parts.next().is_some() {
        return None;
    }
    hours.checked_mul(3600)?.checked_add(minutes * 60 + seconds)
}

/// Software and parameter versions, and the name of a robot or application.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct SystemInfo {
    /// System software version. It is the same for every instance.
    pub version: Text<24>,
    /// Robot model, or application name.
    pub name: Text<16>,
    /// Parameter version, for robots only.
    pub parameters: Text<8>,
}

impl SystemInfo {
    /// Size of an answer in bytes.
    pub const SIZE: usize = 48;

    /// Parses the data, which must have at least 48 bytes.
    pub fn parse(data: &[u8]) -> Result<Self, PayloadError> {
        let mut reader = Reader::new("system information", data);
        Ok(Self { version: reader.text()?, name: reader.text()?, parameters: reader.text()? })
    }

    /// Encodes the data in 48 bytes.
    pub fn emit(&self) -> Vec<u8> {
        let mut out = self.version.emit().to_vec();
        out.extend_from_slice(&self.name.emit());
        out.extend_from_slice(&self.parameters.emit());
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_every_known_form_of_elapsed_time() {
        assert_eq!(elapsed_seconds(b"000123:45'06"), Some(123 * 3600 + 45 * 60 + 6));
        assert_eq!(elapsed_seconds(b"18:19'02"), Some(18 * 3600 + 19 * 60 + 2));
        assert_eq!(elapsed_seconds(b" 1:00"), Some(3600));
        for junk in [&b""[..], b":", b"1", b"1:60'00", b"1:00'60", b"1:00'00'00", b"-1:00'00", b"\xff:1'2", b"::"] {
            assert_eq!(elapsed_seconds(junk), None, "{:?}", junk.escape_ascii().to_string());
        }
    }
}

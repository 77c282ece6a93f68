//! Reader for dumps of a PROFIBUS line: consecutive telegrams, as raw bytes or in hexadecimal.

use std::io::{BufRead, Read as _};
use std::time::Duration;

use super::{Carrier, Damage, Message, Summary};
use crate::profibus::wire::{CHECKSUM, Parsed, START, Telegram};
use crate::tap::LINKTYPE_PROFIBUS_DL;

/// Maximum length of a line of a hexadecimal dump.
const MAX_LINE_LEN: usize = 16 << 20;
/// A length greater than that of any telegram. If this many bytes do not contain a complete telegram, more bytes do not
/// help.
const MAX_TELEGRAM_LEN: usize = 512;
/// Maximum number of noise bytes that are kept in memory.
const MAX_NOISE: usize = 1 << 16;

/// Encoding of a dump.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Hexadecimal digits, with or without separators.
    Hexadecimal,
    /// Raw bytes.
    Bytes,
}

impl Form {
    /// Detects the encoding from the beginning of a file; `None` if it is not a dump.
    pub fn of(beginning: &[u8]) -> Option<Self> {
        let is_digits = |byte: &u8| byte.is_ascii_hexdigit() || is_between(char::from(*byte)) || b"xX".contains(byte);
        if beginning.iter().all(is_digits) && beginning.iter().any(u8::is_ascii_hexdigit) {
            return Some(Self::Hexadecimal);
        }
        // Only whole frames identify a dump. Tokens and acknowledgements of one byte also occur in other files by
        // chance.
        let begins = |at| matches!(Telegram::parse(&beginning[at..]), Ok(Parsed::Whole(Telegram::Frame(_), _)));
        (0..beginning.len().min(MAX_TELEGRAM_LEN)).any(begins).then_some(Self::Bytes)
    }
}

/// Reads a dump. The messages are numbered from 1: telegrams, damaged telegrams and the bytes between them. A dump
/// contains no times.
pub fn read(mut file: impl BufRead, form: Form, mut each: impl FnMut(&Message<'_>)) -> Summary {
    let mut pieces = PieceReader::default();
    let mut offset = 0;
    loop {
        let next = match form {
            Form::Bytes => file.fill_buf().map(<[u8]>::to_vec).map_err(|_| UNREADABLE),
            Form::Hexadecimal => line(&mut file),
        };
        let bytes = match (next, form) {
            (Ok(taken), Form::Hexadecimal) => parse_hex(&String::from_utf8_lossy(&taken))
                .map(|bytes| (taken.len(), bytes))
                .map_err(|_| "a line is not hexadecimal"),
            (taken, _) => taken.map(|bytes| (bytes.len(), bytes)),
        };
        match bytes {
            Ok((0, _)) => break,
            Ok((len, bytes)) => {
                if form == Form::Bytes {
                    file.consume(len);
                }
                pieces.bytes.extend(bytes);
                offset += len;
            }
            Err(problem) => {
                pieces.summary.damage = Some(Damage { offset, problem });
                break;
            }
        }
        pieces.take(false, &mut each);
    }
    pieces.take(true, &mut each);
    pieces.summary
}

const UNREADABLE: &str = "cannot read more of the file";

/// Reads the next line. The line is empty at the end of the file.
fn line(file: &mut impl BufRead) -> Result<Vec<u8>, &'static str> {
    let mut line = Vec::new();
    let snap_len = u64::try_from(MAX_LINE_LEN).unwrap_or(u64::MAX);
    match file.by_ref().take(snap_len).read_until(b'\n', &mut line) {
        Ok(len) if len == MAX_LINE_LEN => Err("a line is too long"),
        Ok(_) => Ok(line),
        Err(_) => Err(UNREADABLE),
    }
}

/// Bytes that were read but not delivered yet.
#[derive(Debug, Default)]
struct PieceReader {
    bytes: Vec<u8>,
    /// Number of bytes that were already delivered.
    start: usize,
    /// Number of noise bytes after the delivered bytes. No telegram begins at any of these bytes.
    noise: usize,
    summary: Summary,
}

impl PieceReader {
    /// Delivers the complete telegrams. At the end of the file, also delivers the remaining bytes.
    fn take(&mut self, is_end: bool, each: &mut impl FnMut(&Message<'_>)) {
        loop {
            let rest = &self.bytes[self.start + self.noise..];
            if rest.is_empty() {
                break;
            }
            let len = match Telegram::parse(rest) {
                Ok(Parsed::Whole(_, len)) => len,
                Ok(Parsed::Part(_)) if !is_end && rest.len() < MAX_TELEGRAM_LEN => break,
                Ok(Parsed::Part(_)) => rest.len(),
                // The whole damaged telegram is skipped. Its content could be mistaken for acknowledgements and tokens,
                // which have no checksum.
                Err(error) if error.field == CHECKSUM => error.offset + 2,
                Err(_) => {
                    self.noise += 1;
                    continue;
                }
            };
            self.deliver(self.noise, each);
            self.deliver(len, each);
            self.noise = 0;
        }
        if is_end || self.noise >= MAX_NOISE {
            self.deliver(self.noise, each);
            self.noise = 0;
        }
        self.bytes.drain(..self.start);
        self.start = 0;
    }

    /// Delivers the next `len` bytes as one message.
    fn deliver(&mut self, len: usize, each: &mut impl FnMut(&Message<'_>)) {
        if len == 0 {
            return;
        }
        self.summary.packets += 1;
        let carrier = Carrier::Frame { link_type: LINKTYPE_PROFIBUS_DL };
        let (number, time, bytes) = (self.summary.packets, Duration::ZERO, &self.bytes[self.start..self.start + len]);
        each(&Message { number, time, carrier, bytes, is_cut: false });
        self.start += len;
    }
}

/// Whether a telegram, even a damaged one, begins anywhere in these bytes.
pub fn holds_telegram(bytes: &[u8]) -> bool {
    (0..bytes.len()).any(|at| !matches!(Telegram::parse(&bytes[at..]), Err(error) if error.field == START))
}

/// Whether the character is a separator between hexadecimal bytes.
fn is_between(c: char) -> bool {
    c.is_whitespace() || matches!(c, ':' | ',' | '-' | '_')
}

/// Parses hexadecimal digits in the formats of common tools. They can have no separators, `0x` prefixes, or colons,
/// commas or dashes.
pub fn parse_hex(text: &str) -> Result<Vec<u8>, String> {
    /// Maximum number of digits that an error message quotes.
    const MAX_QUOTED_DIGITS: usize = 24;

    let mut bytes = Vec::with_capacity(text.len() / 2);
    for token in text.split(is_between) {
        let digits = token.strip_prefix("0x").or_else(|| token.strip_prefix("0X")).unwrap_or(token);
        if let Some(wrong) = digits.chars().find(|c| !c.is_ascii_hexdigit()) {
            return Err(format!("'{}' is not a valid hexadecimal digit", wrong.escape_debug()));
        }
        if digits.len() > 1 && digits.len() % 2 == 1 {
            let rest = if digits.len() > MAX_QUOTED_DIGITS { "…" } else { "" };
            return Err(format!(
                "'{}{rest}' has an odd number of digits",
                &digits[..digits.len().min(MAX_QUOTED_DIGITS)]
            ));
        }
        // Only digits are left, so every pair is a byte.
        let pairs = digits.as_bytes().chunks(2).filter_map(|pair| std::str::from_utf8(pair).ok());
        bytes.extend(pairs.filter_map(|pair| u8::from_str_radix(pair, 16).ok()));
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    const DUMP: &str = "10 05 02 49 50 16\n0x10,0x02,0x05,0x00,0x07,0x16\nDC0202 E5\n";

    fn pieces(file: &[u8]) -> (Vec<Vec<u8>>, Summary) {
        let form = Form::of(file).unwrap();
        let mut all = Vec::new();
        // The reader returns only a few bytes per read, as a pipe can do.
        let file = std::io::BufReader::with_capacity(5, file);
        let summary = read(file, form, |message| all.push(message.bytes.to_vec()));
        (all, summary)
    }

    #[test]
    fn telegrams_are_found_in_either_form() {
        let expected =
            ["100502495016", "100205000716", "DC0202", "E5"].map(|telegram| parse_hex(telegram).unwrap()).to_vec();
        let (all, summary) = pieces(DUMP.as_bytes());
        assert_eq!((&all, summary.packets, summary.damage), (&expected, 4, None));
        let (all, summary) = pieces(&expected.concat());
        assert_eq!((&all, summary.packets, summary.damage), (&expected, 4, None));
    }

    #[test]
    fn finds_telegrams_after_damage() {
        // The bytes are a telegram with a wrong checksum and an acknowledgement inside, noise, a telegram, and an
        // incomplete telegram.
        let (all, _) = pieces(b"68 05 05 68 85 82 E5 3C 3E 00 16 FF 16 10 05 02 49 50 16 68 05 05 68 85");
        let lengths: Vec<_> = all.iter().map(Vec::len).collect();
        assert_eq!(lengths, [11, 2, 6, 5]);
    }

    #[test]
    fn invalid_line_ends_the_dump() {
        let (all, summary) = pieces(b"E5\n1 0 5\n123\n");
        assert_eq!(all.len(), 2, "{all:?}");
        let damage = summary.damage.unwrap();
        assert_eq!((damage.offset, damage.problem), (9, "a line is not hexadecimal"));
    }

    #[test]
    fn rejects_other_files() {
        for other in [&b""[..], b"\n \n", b"YERC", b"\x10\x05\x02\x49\x51\x16", b"\xD4\xC3\xB2\xA1"] {
            assert_eq!(Form::of(other), None, "{other:?}");
        }
    }
}

//! Text encodings of controllers. A robot has one encoding, which depends on the language of its pendant.
//!
//! Decoding never fails: an invalid byte becomes `\xNN`. Encoding never guesses: a character that is missing in the
//! encoding is an error, and the error names the character. ASCII is the same in every encoding here, including 0x5C
//! (backslash) and 0x7E (tilde). [`Encoding::name`] is for names of files and jobs: if the decoded text does not encode
//! to the same bytes, the name also contains the bytes.

use std::fmt::{self, Write as _};
use std::str::FromStr;

use encoding_rs as rs;
use thiserror::Error;

/// A character encoding. The default, `Shift_JIS`, suits Japanese controllers and leaves ASCII unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Encoding {
    /// Japanese, with the extensions of Windows code page 932.
    #[default]
    ShiftJis,
    /// Japanese, Unix.
    EucJp,
    /// Chinese, simplified.
    Gbk,
    /// Chinese, traditional.
    Big5,
    /// Korean.
    EucKr,
    /// Western Europe, ISO 8859-1: each byte is a code point.
    Latin1,
    /// Western Europe, Windows.
    Windows1252,
    /// Central Europe, Windows.
    Windows1250,
    /// Cyrillic, Windows.
    Windows1251,
    /// Unicode.
    Utf8,
}

/// Encodings with their names and aliases. Comparison ignores case, `-`, `_` and blanks.
const NAMES: [(Encoding, &str, &[&str]); 10] = [
    (Encoding::ShiftJis, "shift_jis", &["sjis", "cp932", "ms932", "windows-31j", "ms_kanji"]),
    (Encoding::EucJp, "euc-jp", &["ujis"]),
    (Encoding::Gbk, "gbk", &["gb2312", "cp936", "chinese"]),
    (Encoding::Big5, "big5", &["cp950", "big5-hkscs"]),
    (Encoding::EucKr, "euc-kr", &["cp949", "uhc", "ks_c_5601-1987", "korean"]),
    (Encoding::Latin1, "latin-1", &["iso-8859-1", "l1"]),
    (Encoding::Windows1252, "windows-1252", &["cp1252"]),
    (Encoding::Windows1250, "windows-1250", &["cp1250"]),
    (Encoding::Windows1251, "windows-1251", &["cp1251"]),
    (Encoding::Utf8, "utf-8", &["unicode"]),
];

/// An unknown encoding name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("unknown text encoding '{name}'; known: {}", Encoding::names().collect::<Vec<_>>().join(", "))]
pub struct UnknownEncoding {
    /// The unknown name.
    pub name: String,
}

/// A text that cannot be encoded.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum EncodeError {
    /// A character that is missing in the encoding.
    #[error("'{}' (U+{:04X}), character {position} of the text, does not exist in {encoding}", .character.escape_debug(), u32::from(*.character))]
    Character {
        /// The character.
        character: char,
        /// Position in characters, from 1.
        position: usize,
        /// The encoding that does not have the character.
        encoding: Encoding,
    },
    /// A NUL, which would end the text on the controller.
    #[error("character {0} of the text is a NUL, which would end the text")]
    Nul(usize),
    /// The text is longer than its field.
    #[error("the text has {len} bytes in {encoding}, but at most {max} are possible")]
    TooLong {
        /// Length in bytes.
        len: usize,
        /// Size of the field in bytes.
        max: usize,
        /// The encoding in which the length was measured.
        encoding: Encoding,
    },
}

/// A name on a controller: its text, and also its bytes if the text does not encode to these bytes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Name {
    /// Text of the name. It may contain control characters; the output escapes them.
    pub text: String,
    /// The bytes in hexadecimal. `None` if [`text`](Self::text) encodes to exactly these bytes.
    pub hex: Option<String>,
}

impl Encoding {
    /// Names for help texts and errors.
    pub fn names() -> impl Iterator<Item = &'static str> {
        NAMES.into_iter().map(|(_, name, _)| name)
    }

    /// Name in settings, inventories and JSON.
    pub fn label(self) -> &'static str {
        NAMES.into_iter().find(|(encoding, ..)| *encoding == self).map_or("", |(_, name, _)| name)
    }

    /// Decodes bytes. An invalid byte becomes `\xNN`. NULs are kept; see [`until_nul`].
    pub fn decode(self, bytes: &[u8]) -> String {
        let Some(table) = self.table() else {
            return bytes.iter().copied().map(char::from).collect();
        };
        let mut decoder = table.new_decoder_without_bom_handling();
        let mut text = String::new();
        let mut read = 0;
        loop {
            let rest = bytes.get(read..).unwrap_or_default();
            // Reserves the worst-case capacity, so that one call decodes all bytes up to the next invalid byte.
            text.reserve(decoder.max_utf8_buffer_length_without_replacement(rest.len()).unwrap_or(0));
            let (result, used) = decoder.decode_to_string_without_replacement(rest, &mut text, true);
            read += used;
            match result {
                rs::DecoderResult::InputEmpty => return text,
                rs::DecoderResult::OutputFull => {}
                rs::DecoderResult::Malformed(bad, after) => {
                    let end = read.saturating_sub(after.into());
                    let start = end.saturating_sub(bad.into());
                    for byte in bytes.get(start..end).unwrap_or_default() {
                        push_escaped(&mut text, *byte);
                    }
                }
            }
        }
    }

    /// Encodes text, without a terminating NUL.
    pub fn encode(self, text: &str) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::with_capacity(text.len());
        for (index, character) in text.chars().enumerate() {
            let missing = EncodeError::Character { character, position: index + 1, encoding: self };
            self.push(character, &mut bytes).ok_or(missing)?;
        }
        Ok(bytes)
    }

    /// Encodes text for a NUL-terminated field of `max` bytes.
    pub fn encode_within(self, text: &str, max: usize) -> Result<Vec<u8>, EncodeError> {
        if let Some(index) = text.chars().position(|c| c == '\0') {
            return Err(EncodeError::Nul(index + 1));
        }
        let bytes = self.encode(text)?;
        if bytes.len() > max {
            return Err(EncodeError::TooLong { len: bytes.len(), max, encoding: self });
        }
        Ok(bytes)
    }

    /// Whether a text fits a field of `max` bytes.
    pub fn fits(self, text: &str, max: usize) -> bool {
        self.encode_within(text, max).is_ok()
    }

    /// Decodes a name.
    pub fn name(self, bytes: &[u8]) -> Name {
        let text = self.decode(bytes);
        let exact = self.encode(&text).is_ok_and(|back| back == bytes);
        let hex = (!exact).then(|| hex(bytes));
        Name { text, hex }
    }

    /// Encodes a name as displayed. The escapes `\x80` to `\xff` become single bytes; [`decode`](Self::decode) writes
    /// such escapes.
    pub fn encode_name(self, shown: &str) -> Result<Vec<u8>, EncodeError> {
        let mut bytes = Vec::with_capacity(shown.len());
        let mut rest = shown;
        let mut position = 1;
        while let Some(character) = rest.chars().next() {
            let (len, count) = if let Some(byte) = escaped(rest) {
                bytes.push(byte);
                (ESCAPE_LEN, ESCAPE_LEN)
            } else {
                let missing = EncodeError::Character { character, position, encoding: self };
                self.push(character, &mut bytes).ok_or(missing)?;
                (character.len_utf8(), 1)
            };
            rest = rest.get(len..).unwrap_or_default();
            position += count;
        }
        Ok(bytes)
    }

    /// Appends the bytes of a character if they decode to the same character. Some conversion tables encode a similar
    /// character instead (a backslash for the yen sign), which would damage names.
    fn push(self, character: char, bytes: &mut Vec<u8>) -> Option<()> {
        if character.is_ascii() {
            bytes.push(u8::try_from(character).ok()?);
            return Some(());
        }
        let Some(table) = self.table() else {
            bytes.push(u8::try_from(character).ok()?);
            return Some(());
        };
        let mut buffer = [0; 4];
        let one: &str = character.encode_utf8(&mut buffer);
        let (encoded, _, lost) = table.encode(one);
        if lost || table.decode_without_bom_handling_and_without_replacement(&encoded)? != one {
            return None;
        }
        bytes.extend_from_slice(&encoded);
        Some(())
    }

    /// The conversion table. `None` for ISO 8859-1: the table that web standards call "latin1" is Windows-1252.
    fn table(self) -> Option<&'static rs::Encoding> {
        match self {
            Self::ShiftJis => Some(rs::SHIFT_JIS),
            Self::EucJp => Some(rs::EUC_JP),
            Self::Gbk => Some(rs::GBK),
            Self::Big5 => Some(rs::BIG5),
            Self::EucKr => Some(rs::EUC_KR),
            Self::Latin1 => None,
            Self::Windows1252 => Some(rs::WINDOWS_1252),
            Self::Windows1250 => Some(rs::WINDOWS_1250),
            Self::Windows1251 => Some(rs::WINDOWS_1251),
            Self::Utf8 => Some(rs::UTF_8),
        }
    }
}

impl FromStr for Encoding {
    type Err = UnknownEncoding;

    fn from_str(text: &str) -> Result<Self, UnknownEncoding> {
        let wanted = plain(text);
        NAMES
            .into_iter()
            .find(|(_, name, others)| plain(name) == wanted || others.iter().any(|other| plain(other) == wanted))
            .map(|(encoding, ..)| encoding)
            .ok_or_else(|| UnknownEncoding { name: text.to_owned() })
    }
}

impl fmt::Display for Encoding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.label())
    }
}

/// The bytes before the first NUL, or all bytes. A text that fills its field has no NUL.
pub fn until_nul(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    bytes.get(..end).unwrap_or(bytes)
}

/// Length of an escape such as `\x80`.
const ESCAPE_LEN: usize = 4;

fn push_escaped(text: &mut String, byte: u8) {
    write!(text, "\\x{byte:02x}").expect("writing to a String does not fail");
}

/// The byte of an escape at the start of `text`. ASCII is never escaped.
fn escaped(text: &str) -> Option<u8> {
    let digits = text.strip_prefix("\\x")?.get(..2)?;
    let lower_hex = digits.bytes().all(|b| matches!(b, b'0'..=b'9' | b'a'..=b'f'));
    let byte = u8::from_str_radix(digits, 16).ok()?;
    (lower_hex && byte >= 0x80).then_some(byte)
}

/// Lower-case hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    const DIGITS: [char; 16] = ['0', '1', '2', '3', '4', '5', '6', '7', '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'];

    let mut text = String::with_capacity(bytes.len() * 2);
    for byte in bytes {
        text.push(DIGITS[usize::from(byte >> 4)]);
        text.push(DIGITS[usize::from(byte & 0xF)]);
    }
    text
}

/// Parses pairs of hexadecimal digits, in any case.
pub fn unhex(digits: &str) -> Option<Vec<u8>> {
    let (pairs, []) = digits.as_bytes().as_chunks::<2>() else { return None };
    let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
    pairs.iter().map(|[high, low]| Some(digit(*high)? << 4 | digit(*low)?)).collect()
}

/// Normalized name for comparison.
fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn every() -> impl Iterator<Item = Encoding> {
        NAMES.into_iter().map(|(encoding, ..)| encoding)
    }

    #[test]
    fn converts_a_japanese_job_label() {
        let field = [0x82, 0xC4, 0x82, 0xB7, 0x82, 0xC6, 0, 0, 0, 0];
        assert_eq!(Encoding::default().decode(until_nul(&field)), "てすと");
        assert_eq!(Encoding::ShiftJis.encode("てすと").unwrap(), field[..6]);
    }

    #[test]
    fn half_width_katakana_and_full_width_letters_round_trip() {
        for (text, bytes) in [
            ("ｱｲｳﾞ", &[0xB1, 0xB2, 0xB3, 0xDE][..]),
            ("ＡＢ１", &[0x82, 0x60, 0x82, 0x61, 0x82, 0x50]),
            ("溶接", &[0x97, 0x6E, 0x90, 0xDA]),
            ("ソ表", &[0x83, 0x5C, 0x95, 0x5C]),
            ("①髙", &[0x87, 0x40, 0xFB, 0xFC]),
        ] {
            assert_eq!(Encoding::ShiftJis.encode(text).unwrap(), bytes, "{text}");
            assert_eq!(Encoding::ShiftJis.decode(bytes), text);
        }
    }

    #[test]
    fn ascii_is_equal_in_every_encoding() {
        let ascii: Vec<u8> = (0..0x80).collect();
        for encoding in every() {
            let text = encoding.decode(&ascii);
            assert!(text.bytes().eq(ascii.iter().copied()), "{encoding}");
            assert_eq!(encoding.encode(&text).unwrap(), ascii, "{encoding}");
        }
    }

    #[test]
    fn converts_other_languages() {
        for (encoding, text, bytes) in [
            (Encoding::Latin1, "Schweißen", &b"Schwei\xDFen"[..]),
            (Encoding::Windows1252, "5€", b"5\x80"),
            (Encoding::Windows1250, "Řez", b"\xD8ez"),
            (Encoding::Windows1251, "Дом", b"\xC4\xEE\xEC"),
            (Encoding::Gbk, "焊接", b"\xBA\xB8\xBD\xD3"),
            (Encoding::Big5, "焊接", b"\xB2\x6B\xB1\xB5"),
            (Encoding::EucKr, "용접", b"\xBF\xEB\xC1\xA2"),
            (Encoding::EucJp, "てすと", b"\xA4\xC6\xA4\xB9\xA4\xC8"),
            (Encoding::Utf8, "てす", b"\xE3\x81\xA6\xE3\x81\x99"),
        ] {
            assert_eq!(encoding.encode(text).unwrap(), bytes, "{encoding}");
            assert_eq!(encoding.decode(bytes), text, "{encoding}");
        }
    }

    #[test]
    fn shows_invalid_bytes_as_escapes() {
        assert_eq!(Encoding::Utf8.decode(b"A\xFF\xFEB\xE3\x81"), "A\\xff\\xfeB\\xe3\\x81");
        assert_eq!(Encoding::ShiftJis.decode(b"A\x81 B\x85\x41\x82"), "A\\x81 B\\x85A\\x82");
        assert_eq!(Encoding::Utf8.decode(b"\xEF\xBB\xBFA"), "\u{FEFF}A");
    }

    #[test]
    fn error_names_the_missing_character() {
        let error = Encoding::ShiftJis.encode("AB한").unwrap_err();
        assert_eq!(error.to_string(), "'한' (U+D55C), character 3 of the text, does not exist in shift_jis");
        let error = Encoding::Latin1.encode("\u{202e}").unwrap_err();
        assert!(error.to_string().starts_with("'\\u{202e}' (U+202E), character 1 "), "{error}");
    }

    #[test]
    fn never_replaces_a_character_by_a_similar_one() {
        for character in ["¥", "‾", "−"] {
            assert!(Encoding::ShiftJis.encode(character).is_err(), "{character}");
        }
    }

    #[test]
    fn fields_count_bytes_not_characters() {
        assert!(Encoding::ShiftJis.fits("てすと", 6));
        assert!(!Encoding::ShiftJis.fits("てすと", 5));
        assert!(!Encoding::Utf8.fits("てすと", 6));
        let error = Encoding::Utf8.encode_within("てすと", 8).unwrap_err();
        assert_eq!(error.to_string(), "the text has 9 bytes in utf-8, but at most 8 are possible");
        assert_eq!(Encoding::Utf8.encode_within("A\0", 8), Err(EncodeError::Nul(2)));
    }

    #[test]
    fn parses_names_of_encodings() {
        for (name, encoding) in [
            ("Shift_JIS", Encoding::ShiftJis),
            ("shift-jis", Encoding::ShiftJis),
            ("UTF8", Encoding::Utf8),
            ("latin1", Encoding::Latin1),
            ("ISO-8859-1", Encoding::Latin1),
            ("CP932", Encoding::ShiftJis),
            ("euckr", Encoding::EucKr),
        ] {
            assert_eq!(name.parse(), Ok(encoding), "{name}");
        }
        for encoding in every() {
            assert_eq!(encoding.to_string().parse(), Ok(encoding));
        }
        let error = "klingon".parse::<Encoding>().unwrap_err().to_string();
        assert!(error.contains("'klingon'") && error.contains("shift_jis") && error.contains("utf-8"), "{error}");
        assert!("".parse::<Encoding>().is_err());
    }

    #[test]
    fn name_round_trips_if_its_text_does_not() {
        assert_eq!(Encoding::ShiftJis.name(b"\x82\xC4.JBI"), Name { text: "て.JBI".into(), hex: None });
        let odd = Encoding::ShiftJis.name(b"\x85\x41.JBI");
        assert_eq!((odd.text.as_str(), odd.hex.as_deref()), ("\\x85A.JBI", Some("85412e4a4249")));
        // The Windows table has this character twice. Encoding produces only one of the two codes.
        let twin = Encoding::ShiftJis.name(b"\x87\x90");
        assert_eq!((twin.text.as_str(), twin.hex.as_deref()), ("≒", Some("8790")));
    }

    #[test]
    fn parses_a_displayed_name() {
        assert_eq!(Encoding::ShiftJis.encode_name("\\x85A.JBI").unwrap(), b"\x85A.JBI");
        assert_eq!(Encoding::ShiftJis.encode_name("て\\x41\\xFF").unwrap(), b"\x82\xC4\\x41\\xFF");
        let error = Encoding::ShiftJis.encode_name("\\xff한").unwrap_err();
        assert!(matches!(error, EncodeError::Character { position: 5, .. }), "{error:?}");
    }

    proptest! {
        #[test]
        fn any_bytes_round_trip_or_have_hex(bytes in proptest::collection::vec(any::<u8>(), 0..64), which in 0..NAMES.len()) {
            let encoding = NAMES[which].0;
            let name = encoding.name(&bytes);
            prop_assert_eq!(&name.text, &encoding.decode(&bytes));
            match name.hex {
                None => prop_assert_eq!(encoding.encode(&name.text).unwrap(), bytes),
                Some(text) => prop_assert_eq!(text, hex(&bytes)),
            }
        }

        #[test]
        fn any_text_round_trips_or_is_rejected(text in "\\PC{0,24}", which in 0..NAMES.len()) {
            let encoding = NAMES[which].0;
            if let Ok(bytes) = encoding.encode(&text) {
                prop_assert_eq!(encoding.decode(&bytes), text);
            }
        }

        #[test]
        fn utf8_shows_every_byte(bytes in proptest::collection::vec(any::<u8>(), 0..64)) {
            // The test uses no backslashes: a literal escape in the name would become a byte.
            prop_assume!(!bytes.contains(&b'\\'));
            prop_assert_eq!(Encoding::Utf8.encode_name(&Encoding::Utf8.decode(&bytes)).unwrap(), bytes);
        }
    }
}

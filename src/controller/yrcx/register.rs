//! General-purpose words SIW(2) to SIW(15) and SOW(2) to SOW(15), and their double words (chapter 1, sections 1 and 2).
//! A running remote command and its answer use the same words.

use std::fmt;

use super::image::{COMMAND_WORDS, Words};
use super::signal::Side;
use crate::user_input::integer;

/// A general-purpose word or double word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Register {
    side: Side,
    /// Number of the word, or of the low word of a double word.
    word: usize,
    is_double: bool,
}

/// First general-purpose word. The words before it belong to remote commands.
const FIRST: usize = 2;
const PREFIXES: [(&str, Side, bool); 4] = [
    ("SIW", Side::Input, false),
    ("SOW", Side::Output, false),
    ("SID", Side::Input, true),
    ("SOD", Side::Output, true),
];

impl Register {
    /// Parses a word or double word, for example `SIW2`, `sow(15)` or `SID4`. Returns `None` for other text.
    ///
    /// # Errors
    /// If the word does not exist, or is not a general-purpose word.
    pub fn parse(text: &str) -> Option<Result<Self, String>> {
        let (prefix, rest) = text.split_at_checked(3)?;
        let (name, side, is_double) = PREFIXES.into_iter().find(|(name, ..)| name.eq_ignore_ascii_case(prefix))?;
        let number = rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(rest);
        let number = Some(number).filter(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
        Some(match number.and_then(|number| number.parse().ok()) {
            Some(word) if !is_double && (FIRST..COMMAND_WORDS).contains(&word) => Ok(Self { side, word, is_double }),
            Some(word) if is_double && (FIRST..COMMAND_WORDS).step_by(2).any(|even| even == word) => {
                Ok(Self { side, word, is_double })
            }
            Some(0 | 1) => {
                Err(format!("{name}(0) and {name}(1) belong to remote commands; the words 2 to 15 are general-purpose"))
            }
            _ if is_double => Err(format!("'{text}' is not a valid double word; use {name}2, {name}4, … {name}14")),
            _ => Err(format!("'{text}' is not a valid word; use {name}2 to {name}15")),
        })
    }

    /// Direction.
    pub const fn side(self) -> Side {
        self.side
    }

    /// Reads the value.
    pub fn read(self, words: &Words) -> u32 {
        let low = u32::from(words[self.word]);
        if self.is_double { low | u32::from(words[self.word + 1]) << 16 } else { low }
    }

    /// Writes the value. A single word uses only the low half of the value.
    pub fn write(self, words: &mut Words, value: u32) {
        let [low, high] = [value & 0xFFFF, value >> 16].map(|half| u16::try_from(half).unwrap_or_default());
        words[self.word] = low;
        if self.is_double {
            words[self.word + 1] = high;
        }
    }

    /// Parses a value: decimal, which may be negative, or hexadecimal as in `0x1F`.
    ///
    /// # Errors
    /// If the number is invalid, or does not fit.
    pub fn value(self, text: &str) -> Result<u32, String> {
        let bits = if self.is_double { 32 } else { 16 };
        let (least, most) = (-(1_i64 << (bits - 1)), (1_i64 << bits) - 1);
        let number = integer(text).ok_or_else(|| format!("'{text}' is not a whole number such as 5 or 0x1F"))?;
        if !(least..=most).contains(&number) {
            return Err(format!("{number} is out of range for {self}; allowed: {least} to {most}"));
        }
        // A negative number is converted to two's complement.
        Ok(u32::try_from(number.rem_euclid(most + 1)).unwrap_or_default())
    }

    /// Formats a value, for example `0x0005` (word) or `0x00000005` (double word).
    pub fn hex(self, value: u32) -> String {
        if self.is_double { format!("0x{value:08X}") } else { format!("0x{value:04X}") }
    }
}

impl fmt::Display for Register {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}({})", self.side.name(), if self.is_double { 'D' } else { 'W' }, self.word)
    }
}

/// The general-purpose words of an output image. All of them are 0 while a remote command uses the words.
pub fn general(words: &Words) -> Words {
    let mut general = *words;
    match words[0] {
        0 => general[..FIRST].fill(0),
        _ => general = [0; COMMAND_WORDS],
    }
    general
}

#[cfg(test)]
mod tests {
    use super::*;

    fn register(text: &str) -> Register {
        Register::parse(text).unwrap().unwrap()
    }

    #[test]
    fn words_have_numbers_and_double_words_even_ones() {
        for (text, shown) in [("SIW2", "SIW(2)"), ("sow(15)", "SOW(15)"), ("SID14", "SID(14)"), ("sod(4)", "SOD(4)")] {
            assert_eq!(register(text).to_string(), shown);
        }
        for (text, part) in [
            ("SIW0", "remote commands"),
            ("SOW1", "remote commands"),
            ("SIW16", "SIW2 to SIW15"),
            ("SID3", "SID2, SID4"),
            ("SID16", "SID14"),
            ("SIW", "SIW2"),
            ("SIW+2", "SIW2"),
        ] {
            assert!(Register::parse(text).unwrap().unwrap_err().contains(part), "{text}");
        }
        assert_eq!([Register::parse("SI20"), Register::parse("20"), Register::parse("é")], [None, None, None]);
    }

    #[test]
    fn the_low_word_of_a_double_word_comes_first() {
        // Example of chapter 2, 1.1: 0x01234567 from word 4 on is 0x4567, 0x0123.
        let mut words = [0; COMMAND_WORDS];
        register("SID4").write(&mut words, 0x0123_4567);
        assert_eq!(words[4..6], [0x4567, 0x0123]);
        assert_eq!((register("SOD4").read(&words), register("SOW5").read(&words)), (0x0123_4567, 0x0123));
        register("SIW4").write(&mut words, 7);
        assert_eq!(words[4..6], [7, 0x0123]);
    }

    #[test]
    fn values_fit_their_word() {
        let (word, double) = (register("SIW2"), register("SID2"));
        assert_eq!([word.value("5"), word.value("0xFFFF"), word.value("-1")], [Ok(5), Ok(0xFFFF), Ok(0xFFFF)]);
        assert_eq!((double.value("-1"), double.value("4294967295")), (Ok(u32::MAX), Ok(u32::MAX)));
        for wrong in ["65536", "-32769", "0x10000", "1.5", "", "0x", "0x-1", "five"] {
            assert!(word.value(wrong).is_err(), "{wrong}");
        }
        assert_eq!((word.hex(5), double.hex(5)), ("0x0005".to_owned(), "0x00000005".to_owned()));
    }

    #[test]
    fn command_uses_the_words_exclusively() {
        let mut words = [7; COMMAND_WORDS];
        assert_eq!(general(&words), [0; COMMAND_WORDS]);
        words[0] = 0;
        assert_eq!(general(&words)[..3], [0, 0, 7]);
    }
}

//! Escaping of untrusted text for terminals.
//!
//! Names and messages of a controller can contain any character. If they are printed unchanged, some characters move
//! the cursor, set the window title, reverse the direction of a line or hide text. For people, [`line()`] and
//! [`lines()`] convert these characters to visible escapes. In JSON, [`Safe`] writes them as `\uXXXX`, and a JSON
//! parser returns the same value.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::io;
use std::ops::RangeInclusive;

use serde::Serialize;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter, Serializer};

/// Escapes one line of text. Characters that a terminal does not simply draw are replaced by `\n`, `\x1b`, `\u{202e}`.
/// Backslashes are not escaped, because people read the result, and no program parses it.
pub fn line(text: &str) -> Cow<'_, str> {
    escape_hidden(text, is_hidden)
}

/// Escapes several lines of text like [`line()`], but keeps line feeds.
pub fn lines(text: &str) -> Cow<'_, str> {
    escape_hidden(text, |character| character != '\n' && is_hidden(character))
}

/// Returns a value as compact JSON that is safe for a terminal.
pub fn json_line<T: Serialize + ?Sized>(value: &T) -> serde_json::Result<String> {
    json(value, CompactFormatter)
}

/// Returns a value as indented JSON that is safe for a terminal.
pub fn json_pretty<T: Serialize + ?Sized>(value: &T) -> serde_json::Result<String> {
    json(value, PrettyFormatter::new())
}

/// Writes a value as JSON. The text is not built in memory first.
pub fn json_to<T: Serialize + ?Sized>(writer: impl io::Write, value: &T, pretty: bool) -> serde_json::Result<()> {
    if pretty {
        value.serialize(&mut Serializer::with_formatter(writer, Safe(PrettyFormatter::new())))
    } else {
        value.serialize(&mut Serializer::with_formatter(writer, Safe(CompactFormatter)))
    }
}

/// Functions of a formatter that only call the inner formatter.
macro_rules! pass_on {
    ($($function:ident($($first:ident)?),)*) => {
        $(fn $function<W: ?Sized + io::Write>(&mut self, writer: &mut W $(, $first: bool)?) -> io::Result<()> {
            self.0.$function(writer $(, $first)?)
        })*
    };
}

/// JSON formatter that writes hidden characters in strings as `\uXXXX`. For everything else, it uses the inner
/// formatter.
#[derive(Debug, Clone, Default)]
pub struct Safe<F>(pub F);

impl<F: Formatter> Formatter for Safe<F> {
    /// The fragment already contains the JSON escapes. This function adds the escapes for terminals.
    fn write_string_fragment<W: ?Sized + io::Write>(&mut self, writer: &mut W, fragment: &str) -> io::Result<()> {
        if is_printable_ascii(fragment) {
            return self.0.write_string_fragment(writer, fragment);
        }
        let mut rest = fragment;
        while let Some((at, character)) = rest.char_indices().find(|(_, character)| is_hidden(*character)) {
            let (plain, tail) = rest.split_at(at);
            self.0.write_string_fragment(writer, plain)?;
            for unit in character.encode_utf16(&mut [0; 2]) {
                write!(writer, "\\u{unit:04x}")?;
            }
            rest = tail.get(character.len_utf8()..).unwrap_or_default();
        }
        self.0.write_string_fragment(writer, rest)
    }

    pass_on! {
        begin_array(), end_array(), begin_array_value(first), end_array_value(),
        begin_object(), end_object(), begin_object_key(first), end_object_key(), begin_object_value(), end_object_value(),
    }
}

/// Characters outside ASCII that are invisible, affect the text around them, or break lines, in ascending order. These
/// are the format characters of Unicode (Cf), the line and paragraph separators, and the default-ignorable characters.
const HIDDEN: &[RangeInclusive<char>] = &[
    '\u{00AD}'..='\u{00AD}',   // soft hyphen
    '\u{034F}'..='\u{034F}',   // grapheme joiner
    '\u{0600}'..='\u{0605}',   // Arabic number signs
    '\u{061C}'..='\u{061C}',   // Arabic letter mark
    '\u{06DD}'..='\u{06DD}',   // Arabic end of ayah
    '\u{070F}'..='\u{070F}',   // Syriac abbreviation mark
    '\u{0890}'..='\u{0891}',   // Arabic currency marks
    '\u{08E2}'..='\u{08E2}',   // Arabic disputed end of ayah
    '\u{115F}'..='\u{1160}',   // Hangul fillers
    '\u{17B4}'..='\u{17B5}',   // Khmer inherent vowels
    '\u{180B}'..='\u{180F}',   // Mongolian selectors and vowel separator
    '\u{200B}'..='\u{200F}',   // zero-width characters, direction marks
    '\u{2028}'..='\u{202E}',   // line and paragraph separator, direction embedding and override
    '\u{2060}'..='\u{206F}',   // joiner, invisible operators, direction isolates
    '\u{3164}'..='\u{3164}',   // Hangul filler
    '\u{FE00}'..='\u{FE0F}',   // variation selectors
    '\u{FEFF}'..='\u{FEFF}',   // byte order mark
    '\u{FFA0}'..='\u{FFA0}',   // half-width Hangul filler
    '\u{FFF0}'..='\u{FFFB}',   // interlinear annotation
    '\u{110BD}'..='\u{110BD}', // Kaithi number sign
    '\u{110CD}'..='\u{110CD}', // Kaithi number sign above
    '\u{13430}'..='\u{1343F}', // hieroglyph joiners
    '\u{1BCA0}'..='\u{1BCA3}', // shorthand controls
    '\u{1D173}'..='\u{1D17A}', // musical controls
    '\u{E0000}'..='\u{E0FFF}', // tags and more variation selectors
];

/// Whether a terminal does not simply draw the character.
fn is_hidden(character: char) -> bool {
    if character.is_ascii() {
        return character.is_ascii_control();
    }
    character.is_control()
        || HIDDEN
            .binary_search_by(|range| {
                if *range.end() < character {
                    std::cmp::Ordering::Less
                } else if *range.start() > character {
                    std::cmp::Ordering::Greater
                } else {
                    std::cmp::Ordering::Equal
                }
            })
            .is_ok()
}

/// Whether the text consists only of printable ASCII. The fold looks at all bytes, so that the compiler can compare
/// several at once.
pub fn is_printable_ascii(text: &str) -> bool {
    text.bytes().fold(true, |all, byte| all & (0x20..0x7F).contains(&byte))
}

fn escape_hidden(text: &str, hidden: impl Fn(char) -> bool) -> Cow<'_, str> {
    if is_printable_ascii(text) {
        return Cow::Borrowed(text);
    }
    let Some(first) = text.find(&hidden) else {
        return Cow::Borrowed(text);
    };
    let (clean, rest) = text.split_at(first);
    let mut out = String::with_capacity(text.len() + 16);
    out.push_str(clean);
    for character in rest.chars() {
        if hidden(character) {
            push_escape(&mut out, character);
        } else {
            out.push(character);
        }
    }
    Cow::Owned(out)
}

fn push_escape(out: &mut String, character: char) {
    let code = u32::from(character);
    let written = match character {
        '\n' => out.write_str("\\n"),
        '\r' => out.write_str("\\r"),
        '\t' => out.write_str("\\t"),
        '\0'..='\u{FF}' => write!(out, "\\x{code:02x}"),
        _ => write!(out, "\\u{{{code:x}}}"),
    };
    written.expect("writing to a String does not fail");
}

fn json<T: Serialize + ?Sized>(value: &T, formatter: impl Formatter) -> serde_json::Result<String> {
    let mut bytes = Vec::with_capacity(128);
    value.serialize(&mut Serializer::with_formatter(&mut bytes, Safe(formatter)))?;
    Ok(String::from_utf8(bytes).expect("serde_json writes UTF-8"))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use proptest::prelude::*;
    use serde_json::{Value, json};

    use super::*;

    #[test]
    fn plain_text_is_borrowed() {
        for text in ["", "TESTJOB.JBI", "てすと ｱｲｳ 용접 é \\x1b"] {
            assert!(matches!(line(text), Cow::Borrowed(same) if same == text));
        }
    }

    #[test]
    fn shows_control_characters() {
        for (text, shown) in [
            ("\x1b]0;title\x07", "\\x1b]0;title\\x07"),
            ("a\0b\x7f", "a\\x00b\\x7f"),
            ("\u{9b}31m", "\\x9b31m"),
            ("job\u{202e}IBJ", "job\\u{202e}IBJ"),
            ("a\u{200b}b\u{feff}", "a\\u{200b}b\\u{feff}"),
            ("a\u{2028}b\u{2066}", "a\\u{2028}b\\u{2066}"),
            ("soft\u{ad}", "soft\\xad"),
            ("tag\u{e0041}", "tag\\u{e0041}"),
            ("a\tb\r\nc", "a\\tb\\r\\nc"),
        ] {
            assert_eq!(line(text), shown);
        }
    }

    #[test]
    fn keeps_line_feeds_of_several_lines() {
        assert_eq!(lines("a\r\nb\x1b\u{85}c\n"), "a\\r\nb\\x1b\\x85c\n");
        assert!(matches!(lines("a\nb\n"), Cow::Borrowed("a\nb\n")));
    }

    #[test]
    fn hidden_ranges_are_ascending() {
        assert!(HIDDEN.is_sorted_by(|a, b| a.start() <= a.end() && a.end() < b.start()));
    }

    #[test]
    fn json_escapes_hidden_characters() {
        let value = json!({"name\u{9b}": "\x1b\x7f\u{85}\u{202e}\u{2028}\u{e0041}\"\\é溶"});
        let text = json_line(&value).unwrap();
        assert_eq!(text, r#"{"name\u009b":"\u001b\u007f\u0085\u202e\u2028\udb40\udc41\"\\é溶"}"#);
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), value);
    }

    #[test]
    fn layouts_match_serde_json() {
        let value = json!({"a": [1, 2.5, [], {}], "b": {"c": null, "d": [true, "x"]}, "e": "y"});
        assert_eq!(json_line(&value).unwrap(), serde_json::to_string(&value).unwrap());
        assert_eq!(json_pretty(&value).unwrap(), serde_json::to_string_pretty(&value).unwrap());
    }

    /// Generates text with many special characters.
    fn hostile_text() -> impl Strategy<Value = String> {
        let character = prop_oneof![
            any::<char>(),
            prop::char::range('\0', '\u{FF}'),
            prop::char::range('\u{2000}', '\u{206F}'),
            prop::sample::select(HIDDEN.iter().map(|range| *range.end()).collect::<Vec<_>>()),
        ];
        prop::collection::vec(character, 0..40).prop_map(String::from_iter)
    }

    proptest! {
        #[test]
        fn escapes_every_hidden_character(text in hostile_text()) {
            let escaped = line(&text);
            prop_assert!(!escaped.chars().any(|c| c.is_control() || is_hidden(c)), "{:?}", escaped);
            let shown = lines(&text);
            prop_assert!(!shown.chars().any(|c| c != '\n' && (c.is_control() || is_hidden(c))), "{:?}", shown);
            prop_assert_eq!(shown.matches('\n').count(), text.matches('\n').count());
            let once = line(&text);
            prop_assert_eq!(line(&once), once.as_ref());
        }

        #[test]
        fn escaped_json_has_the_same_value(map in prop::collection::btree_map(hostile_text(), hostile_text(), 0..6)) {
            for text in [json_line(&map).unwrap(), json_pretty(&map).unwrap()] {
                prop_assert!(!text.chars().any(|c| c != '\n' && (c.is_control() || is_hidden(c))), "{:?}", text);
                let parsed: BTreeMap<String, String> = serde_json::from_str(&text).unwrap();
                prop_assert_eq!(&parsed, &map);
            }
            prop_assert!(!json_line(&map).unwrap().contains('\n'));
        }
    }
}

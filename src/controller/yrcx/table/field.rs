//! Fields of command and answer words: position, format, condition.

use crate::units::{self, Unit, UnitError};
use crate::user_input;
use crate::yrcx::value::{Key, Value};

/// A field of a command or an answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Field {
    /// Name for programs.
    pub key: Key,
    /// Readable name.
    pub name: &'static str,
    /// Number of the first word, 0 to 15.
    pub word: usize,
    /// Format.
    pub form: Form,
    /// Allowed raw values, as ranges; empty if all values are allowed.
    pub spans: &'static [(i32, i32)],
    /// Condition on another field. If the condition is not met, this field is not in use and its words are 0.
    pub when: Option<When>,
    /// Whether the field is optional. A missing field is sent as 0.
    pub need: Presence,
}

/// Whether a field is optional.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// The field must have a value.
    Required,
    /// The field may be missing. It is then sent as 0.
    Optional,
    /// The field must have a value if the command names this axis. A missing target would be a move to 0.
    OfAxis(u8),
}

/// Format of a field.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Unsigned bits of one word.
    Bits {
        /// Lowest bit.
        low: u8,
        /// Number of bits.
        width: u8,
        /// Meaning of the bits.
        show: Show,
    },
    /// Signed 16 bits.
    Short(Unit),
    /// Signed 32 bits in two words, low word first (chapter 2, 1.1).
    Long(Unit),
    /// IEEE 754 single precision in two words, low word first.
    Real,
    /// 16 characters in eight words, first character in the low byte.
    Text(Charset),
}

/// Meaning of bits.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Show {
    /// A number in this unit.
    Number(Unit),
    /// A constant number.
    Fixed(u16),
    /// A choice. Each of the valid numbers has a name.
    Choice(&'static [(u16, &'static str)]),
    /// A set of axes or elements. Bit 0 is the first one.
    Set {
        /// Minimum size.
        least: u32,
        /// Maximum size.
        most: u32,
    },
    /// Two decimal digits of four bits each.
    Digits,
    /// A version: the high byte is the number before the point, the low byte the number after it.
    Version,
    /// A revision.
    Revision,
    /// A version with one digit before the point and three digits after it.
    FpgaVersion,
    /// A static variable. The numbers 0 to 31 are SGI0 to SGI31, and 256 to 287 are SGR0 to SGR31 (4.4.1).
    Variable,
    /// A program line. The lines of the COMMON program begin at 10000 (4.6.4).
    Line,
}

/// Character set and padding of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Charset {
    /// Characters 0x20 to 0x7E, padded with NUL as in the examples of the manual (4.3.2).
    Comment,
    /// A to Z, 0 to 9 and underscore, padded with spaces as in the text of section 4.6.1.
    Program,
}

/// Condition on another field, which is in the same words. For an answer, it may also be in the words of the command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct When {
    /// Key of the other field.
    pub key: Key,
    /// Minimum value of the other field.
    pub least: i32,
    /// Maximum value of the other field.
    pub most: i32,
    /// Whether a value for this field also sets the other field.
    pub sets: bool,
}

/// An integer without unit.
pub const PLAIN: Unit = Unit { symbol: "", decimals: 0 };
/// Percent, integer.
pub const PERCENT: Unit = Unit { symbol: "%", decimals: 0 };
/// Percent, resolution 0.01.
pub const FINE_PERCENT: Unit = Unit { symbol: "%", decimals: 2 };
/// Millimetres, resolution 0.001.
pub const MM: Unit = units::MILLIMETRE;
/// Encoder pulses.
pub const PULSE: Unit = units::PULSE;
/// Millimetres per second, integer.
pub const MM_S: Unit = Unit { symbol: "mm/s", decimals: 0 };
/// Milliseconds.
pub const MS: Unit = Unit { symbol: "ms", decimals: 0 };

/// Length of a text in characters.
const TEXT_CHARS: usize = 16;

/// Prefixes of static variables, with the number of the first variable of each kind.
const VARIABLES: [(&str, i32); 2] = [("SGI", 0), ("SGR", 0x100)];

impl Field {
    const fn new(key: Key, name: &'static str, word: usize, form: Form) -> Self {
        Self { key, name, word, form, spans: &[], when: None, need: Presence::Required }
    }

    /// A field of some bits of one word.
    pub const fn bits(key: Key, name: &'static str, word: usize, low: u8, width: u8, show: Show) -> Self {
        Self::new(key, name, word, Form::Bits { low, width, show })
    }

    /// A field of one whole word.
    pub const fn word(key: Key, name: &'static str, word: usize, show: Show) -> Self {
        Self::bits(key, name, word, 0, 16, show)
    }

    /// A field of one whole word that contains an unsigned number.
    pub const fn number(key: Key, name: &'static str, word: usize) -> Self {
        Self::word(key, name, word, Show::Number(PLAIN))
    }

    /// A field of signed 16 bits.
    pub const fn short(key: Key, name: &'static str, word: usize, unit: Unit) -> Self {
        Self::new(key, name, word, Form::Short(unit))
    }

    /// A field of signed 32 bits.
    pub const fn long(key: Key, name: &'static str, word: usize, unit: Unit) -> Self {
        Self::new(key, name, word, Form::Long(unit))
    }

    /// A field with a single-precision number.
    pub const fn real(key: Key, name: &'static str, word: usize) -> Self {
        Self::new(key, name, word, Form::Real)
    }

    /// A field with a text.
    pub const fn text(key: Key, name: &'static str, word: usize, charset: Charset) -> Self {
        Self::new(key, name, word, Form::Text(charset))
    }

    /// Restricts the values.
    #[must_use]
    pub const fn within(mut self, spans: &'static [(i32, i32)]) -> Self {
        self.spans = spans;
        self
    }

    /// Makes the field depend on `key`: the field is in use only if `key` has this value. If this field gets a value,
    /// `key` is set too.
    #[must_use]
    pub const fn sets(mut self, key: Key, value: i32) -> Self {
        self.when = Some(When { key, least: value, most: value, sets: true });
        self
    }

    /// Makes the field depend on `key`: the field is in use only if `key` is in this range.
    #[must_use]
    pub const fn when(mut self, key: Key, least: i32, most: i32) -> Self {
        self.when = Some(When { key, least, most, sets: false });
        self
    }

    /// Makes the field optional.
    #[must_use]
    pub const fn optional(mut self) -> Self {
        self.need = Presence::Optional;
        self
    }

    /// Makes the field optional if the axis does not move.
    #[must_use]
    pub const fn of_axis(mut self, axis: u8) -> Self {
        self.need = Presence::OfAxis(axis);
        self
    }

    /// Number of words.
    pub const fn size(&self) -> usize {
        match self.form {
            Form::Bits { .. } | Form::Short(_) => 1,
            Form::Long(_) | Form::Real => 2,
            Form::Text(_) => TEXT_CHARS / 2,
        }
    }

    /// Bit mask of the field in each of its words.
    pub const fn mask(&self) -> u16 {
        match self.form {
            Form::Bits { low, width, .. } => (u16::MAX >> (16 - width)) << low,
            _ => u16::MAX,
        }
    }

    /// Symbol of the unit; empty without a unit.
    pub const fn symbol(&self) -> &'static str {
        match self.form {
            Form::Bits { show: Show::Number(unit), .. } | Form::Short(unit) | Form::Long(unit) => unit.symbol,
            _ => "",
        }
    }

    /// Reads the value from words with any content.
    pub fn read(&self, words: &[u16; 16]) -> Value {
        let word = |at: usize| words.get(self.word + at).copied().unwrap_or_default();
        let long = || u32::from(word(1)) << 16 | u32::from(word(0));
        match self.form {
            Form::Bits { low, show, .. } => {
                let raw = i32::from((word(0) & self.mask()) >> low);
                Value::Int(match (raw >> 4, raw & 0xF) {
                    _ if show != Show::Digits => raw,
                    (tens @ 0..=9, units @ 0..=9) => tens * 10 + units,
                    // Digits that are not decimal give a number above 99, which is never valid.
                    _ => 100 + raw,
                })
            }
            Form::Short(_) => Value::Int(word(0).cast_signed().into()),
            Form::Long(_) => Value::Int(long().cast_signed()),
            Form::Real => Value::Real(f32::from_bits(long())),
            Form::Text(_) => {
                let bytes: Vec<u8> = (0..self.size()).flat_map(|at| word(at).to_le_bytes()).collect();
                let length = bytes.iter().rposition(|byte| !matches!(byte, 0 | b' ')).map_or(0, |last| last + 1);
                let printable = |byte: &u8| {
                    if matches!(byte, b' '..=b'~') { char::from(*byte) } else { char::REPLACEMENT_CHARACTER }
                };
                Value::Text(bytes[..length].iter().map(printable).collect())
            }
        }
    }

    /// Writes a value. An error contains the reason why the value does not fit. Only [`Self::accept`] checks the range
    /// and the other conditions.
    pub fn write(&self, words: &mut [u16; 16], value: &Value) -> Result<(), String> {
        let mut put = |at: usize, bits: u16| {
            if let Some(word) = words.get_mut(self.word + at) {
                *word = *word & !self.mask() | bits;
            }
        };
        let low_word_first =
            |bits: u32| [bits & 0xFFFF, bits >> 16].map(|half| u16::try_from(half).unwrap_or_default());
        match (self.form, value) {
            (Form::Bits { low, show, .. }, Value::Int(number)) => {
                let raw = match number {
                    0..=99 if show == Show::Digits => ((number / 10) << 4) | (number % 10),
                    _ if show == Show::Digits => return Err(format!("{number} has more than two digits")),
                    _ => *number,
                };
                let raw = u16::try_from(raw).ok().filter(|raw| *raw <= self.mask() >> low);
                put(0, raw.ok_or_else(|| format!("{number} does not fit in the field"))? << low);
            }
            (Form::Short(_), Value::Int(number)) => {
                put(
                    0,
                    i16::try_from(*number).map_err(|_| format!("{number} does not fit in the field"))?.cast_unsigned(),
                );
            }
            (Form::Long(_), Value::Int(number)) => {
                for (at, bits) in low_word_first(number.cast_unsigned()).into_iter().enumerate() {
                    put(at, bits);
                }
            }
            (Form::Real, Value::Real(number)) => {
                for (at, bits) in low_word_first(number.to_bits()).into_iter().enumerate() {
                    put(at, bits);
                }
            }
            (Form::Text(charset), Value::Text(text)) => {
                let mut bytes = [charset.fill(); TEXT_CHARS];
                let place = bytes.get_mut(..text.len()).ok_or("more than 16 characters")?;
                place.copy_from_slice(text.as_bytes());
                for (at, pair) in bytes.chunks_exact(2).enumerate() {
                    put(at, u16::from_le_bytes([pair[0], pair[1]]));
                }
            }
            _ => return Err("this field needs another value type".to_owned()),
        }
        Ok(())
    }

    /// Checks that a value can be sent.
    pub fn accept(&self, value: &Value) -> Result<(), String> {
        match (value, self.form) {
            (Value::Int(number), form) => {
                if !self.spans.is_empty() && !self.spans.iter().any(|(least, most)| (least..=most).contains(&number)) {
                    return Err(format!("{} is out of range; {}", self.show(value), self.allowed()));
                }
                match form {
                    Form::Bits { show: Show::Choice(choices), .. }
                        if !choices.iter().any(|(code, _)| i32::from(*code) == *number) =>
                    {
                        Err(format!("{number} is not defined; {}", self.allowed()))
                    }
                    Form::Bits { width, show: Show::Set { least, most }, .. } => match number.count_ones() {
                        _ if number >> width != 0 => Err(format!("{}: must be from 1 to {width}", self.show(value))),
                        count if count < least || count > most => Err(format!("{count} selected; {}", self.allowed())),
                        _ => Ok(()),
                    },
                    Form::Bits { show: Show::Fixed(fixed), .. } if i32::from(fixed) != *number => {
                        Err(format!("the value must be {fixed}, not {number}"))
                    }
                    _ => Ok(()),
                }
            }
            (Value::Real(number), _) if !number.is_finite() => Err(format!("{number} is not a valid number")),
            (Value::Text(text), Form::Text(charset)) => charset.accept(text),
            _ => Ok(()),
        }
    }

    /// Description of the valid values.
    pub fn allowed(&self) -> String {
        let spans = match self.form {
            Form::Bits { show: Show::Choice(choices), .. } => {
                let names = choices.iter().map(|(code, name)| format!("{code} = {name}"));
                return format!("use {}", names.collect::<Vec<_>>().join(", "));
            }
            Form::Bits { show: Show::Set { least, most }, .. } if least == most => {
                return format!("select exactly {least}");
            }
            Form::Bits { show: Show::Set { least, most }, .. } => return format!("select {least} to {most}"),
            Form::Bits { show: Show::Fixed(fixed), .. } => return format!("it must be {fixed}"),
            Form::Text(charset) => return charset.allowed().to_owned(),
            Form::Real => return "allowed: a single-precision number".to_owned(),
            _ if !self.spans.is_empty() => self.spans,
            Form::Bits { low, .. } => &[(0, i32::from(self.mask() >> low))][..],
            Form::Short(_) => &[(-32_768, 32_767)],
            Form::Long(_) => &[(i32::MIN, i32::MAX)],
        };
        let shown = |number: i32| self.show(&Value::Int(number));
        let span = |(least, most): &(i32, i32)| {
            if least == most { shown(*least) } else { format!("{} to {}", shown(*least), shown(*most)) }
        };
        let spans = spans.iter().map(span).collect::<Vec<_>>().join(", ");
        format!("allowed: {spans} {}", self.symbol()).trim_end().to_owned()
    }

    /// Formats a value without its unit.
    pub fn show(&self, value: &Value) -> String {
        let number = match value {
            Value::Int(number) => *number,
            Value::Real(number) => return number.to_string(),
            Value::Text(text) => return text.clone(),
        };
        match self.form {
            Form::Bits { show, .. } => show.words(number),
            Form::Short(unit) | Form::Long(unit) => unit.show(number).to_string(),
            Form::Real | Form::Text(_) => number.to_string(),
        }
    }

    /// Parses user input: a number in the unit of the field, with or without its symbol, the name of a choice, or a list of axes such as `1,3`. A
    /// variable is typed as in `SGI5`, a point as in `P19`. The complete command is validated later.
    pub fn parse(&self, text: &str) -> Result<Value, String> {
        // In robot programs, point 19 is written P19. The same form is accepted here.
        let is_point = matches!(self.key, Key::Point | Key::Point2 | Key::FirstPoint);
        let number = text.strip_prefix(['P', 'p']).filter(|number| number.bytes().all(|byte| byte.is_ascii_digit()));
        let text = number.filter(|_| is_point).unwrap_or(text);
        let without_symbol = match self.symbol() {
            "" => text,
            symbol => text.strip_suffix(symbol).map_or(text, |number| number.trim_end_matches(' ')),
        };
        let whole = |text: &str| PLAIN.parse(text).map(Value::Int).map_err(|error| plain(&error));
        let number = |unit: Unit| match unit.symbol {
            "" => whole(text),
            _ => unit.parse(without_symbol).map(Value::Int).map_err(|error| error.to_string()),
        };
        match self.form {
            Form::Bits { show, .. } => match show {
                Show::Choice(choices) => match choices.iter().find(|(_, name)| name.eq_ignore_ascii_case(text)) {
                    Some((code, _)) => Ok(Value::Int(i32::from(*code))),
                    None => whole(text).map_err(|_| format!("'{text}' is unknown; {}", self.allowed())),
                },
                Show::Set { .. } => set_of(text),
                Show::Version | Show::FpgaVersion => version(text),
                Show::Revision => whole(text.strip_prefix('R').unwrap_or(text)),
                Show::Line => match text.strip_suffix(" of COMMON").map(whole) {
                    Some(Ok(Value::Int(line))) => Ok(Value::Int(line.saturating_add(COMMON_LINES))),
                    Some(other) => other,
                    None => whole(text),
                },
                Show::Number(unit) => number(unit),
                Show::Variable => VARIABLES
                    .iter()
                    .find_map(|(prefix, first)| {
                        let index = text.strip_prefix(prefix)?.parse::<u8>().ok().filter(|index| *index < 32)?;
                        Some(Value::Int(first + i32::from(index)))
                    })
                    .map_or_else(
                        || whole(text).map_err(|_| format!("'{text}' is not a valid variable; {}", self.allowed())),
                        Ok,
                    ),
                Show::Fixed(_) | Show::Digits => whole(text),
            },
            Form::Short(unit) | Form::Long(unit) => number(unit),
            Form::Real => text.parse().map(Value::Real).map_err(|_| format!("'{text}' is not a number")),
            Form::Text(_) => Ok(Value::Text(text.to_owned())),
        }
    }
}

impl Show {
    fn words(self, number: i32) -> String {
        match self {
            Self::Number(unit) => unit.show(number).to_string(),
            Self::Choice(choices) => choices
                .iter()
                .find(|(code, _)| i32::from(*code) == number)
                .map_or_else(|| format!("undocumented ({number})"), |(_, name)| (*name).to_owned()),
            Self::Set { .. } => match (0..16).filter(|bit| number >> bit & 1 == 1).map(|bit| (bit + 1).to_string()) {
                bits if number == 0 => bits.chain([NOTHING.to_owned()]).collect(),
                bits => bits.collect::<Vec<_>>().join(","),
            },
            // The example in 4.7.1 does not show whether the digits are binary or decimal. Hexadecimal output is right
            // for decimal digits. It is also right for binary digits below 10.
            Self::Version => format!("V{:x}.{:02x}", number >> 8, number & 0xFF),
            Self::Revision => format!("R{number:04}"),
            Self::FpgaVersion => format!("V{:x}.{:03x}", number >> 12, number & 0xFFF),
            Self::Variable => {
                let [(integer, _), (real, first)] = VARIABLES;
                match number {
                    0..=31 => format!("{integer}{number}"),
                    0x100..=0x11F => format!("{real}{}", number - first),
                    _ => format!("undocumented ({number})"),
                }
            }
            Self::Line if number > COMMON_LINES => format!("{} of COMMON", number - COMMON_LINES),
            Self::Fixed(_) | Self::Digits | Self::Line => number.to_string(),
        }
    }
}

/// Text of an empty set of axes or elements.
const NOTHING: &str = "none";

/// Number that is added to the lines of the COMMON program (4.6.4).
pub const COMMON_LINES: i32 = 10_000;

impl Charset {
    const fn fill(self) -> u8 {
        match self {
            Self::Comment => 0,
            Self::Program => b' ',
        }
    }

    const fn allowed(self) -> &'static str {
        match self {
            Self::Comment => "allowed: up to 16 ASCII characters",
            Self::Program => "allowed: 1 to 16 characters from A-Z, 0-9 and _",
        }
    }

    fn accept(self, text: &str) -> Result<(), String> {
        let fits = match self {
            Self::Comment => text.bytes().all(|byte| matches!(byte, b' '..=b'~')),
            Self::Program => {
                !text.is_empty() && text.bytes().all(|byte| matches!(byte, b'A'..=b'Z' | b'0'..=b'9' | b'_'))
            }
        };
        if fits && text.len() <= TEXT_CHARS {
            Ok(())
        } else {
            Err(format!("'{}' is not valid; {}", text.chars().take(40).collect::<String>(), self.allowed()))
        }
    }
}

/// Message for an invalid integer.
fn plain(error: &UnitError) -> String {
    match error {
        UnitError::Malformed { text, .. } | UnitError::TooFine { text, .. } => {
            format!("'{text}' is not a whole number")
        }
        UnitError::Range { text, lowest, highest, .. } => {
            format!("{text} is out of range; the range is {lowest} to {highest}")
        }
    }
}

/// Parses a version, for example `V1.08`.
fn version(text: &str) -> Result<Value, String> {
    let digits = text.strip_prefix('V').unwrap_or(text).replacen('.', "", 1);
    let number =
        u16::from_str_radix(&digits, 16).map_err(|_| format!("'{text}' is not a valid version, such as V1.08"))?;
    Ok(Value::from(number))
}

/// Parses a set, for example `1,3` or `1-3`.
fn set_of(text: &str) -> Result<Value, String> {
    let mut set = 0;
    if text == NOTHING {
        return Ok(Value::Int(set));
    }
    for item in text.split(',') {
        let wrong = || format!("'{text}' is not a valid list, such as 1,3");
        let number = |text: &str| match text.trim().parse::<u8>() {
            Ok(number @ 1..=16) => Ok(number),
            _ => Err(wrong()),
        };
        set = user_input::range(item, number)?.fold(set, |set, number| set | 1 << (number - 1));
    }
    Ok(Value::Int(set))
}

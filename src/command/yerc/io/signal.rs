//! Signals by logical number, as manuals and pendants write them: #20013 is bit 3 of group 2001 (FS and DX 3.3.9).

use std::fmt;
use std::str::FromStr;

use crate::controller::yerc::Model;
use crate::controller::yerc::table::{Row, Span};
use crate::failure::Failure;

/// One signal. Eight share a group; their last digit is 0 to 7.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Signal {
    /// The instance that holds it.
    pub group: u16,
    /// 0 to 7.
    pub bit: u8,
}

impl Signal {
    /// The eight signals of a group.
    pub fn of_group(group: u16) -> impl Iterator<Item = Self> {
        (0..8).map(move |bit| Self { group, bit })
    }

    /// `20013`.
    pub fn number(self) -> u32 {
        u32::from(self.group) * 10 + u32::from(self.bit)
    }

    /// Its state in the byte of its group.
    pub const fn is_on(self, byte: u8) -> bool {
        byte >> self.bit & 1 == 1
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:05}", self.number())
    }
}

impl FromStr for Signal {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let digits = text.strip_prefix('#').unwrap_or(text);
        let wrong = || format!("'{text}' is no signal number; an example is 20010 or #20010");
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(wrong());
        }
        let number: u32 = digits.parse().map_err(|_| wrong())?;
        let group = u16::try_from(number / 10).map_err(|_| wrong())?;
        match u8::try_from(number % 10) {
            Ok(bit) if bit < 8 => Ok(Self { group, bit }),
            _ => Err(format!(
                "there is no signal #{number:05}: eight share a group, so the last digit is 0 to 7 ({} to {} here)",
                Self { group, bit: 0 },
                Self { group, bit: 7 }
            )),
        }
    }
}

/// A signal or a range of them, as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signals(pub Vec<Signal>);

impl Signals {
    /// `20010`, `#20010`, `20010..20027`; both ends belong to the range.
    pub fn parse(text: &str) -> Result<Self, String> {
        let (first, last) = text.split_once("..").unwrap_or((text, text));
        let (first, last): (Signal, Signal) = (first.parse()?, last.parse()?);
        if last < first {
            return Err(format!("'{text}' is no range; the lower end comes first"));
        }
        let within = |signal: &Signal| (first..=last).contains(signal);
        Ok(Self((first.group..=last.group).flat_map(Signal::of_group).filter(within).collect()))
    }
}

/// The class of a group: what it is, and whether it can be written.
pub fn class(model: Model, group: u16) -> Result<&'static Span, Failure> {
    let classes = classes(model);
    classes.iter().find(|span| span.contains(group)).ok_or_else(|| {
        let first = Signal { group, bit: 0 };
        Failure::usage(format!("group {group} ({first}) does not exist on a {model}"))
            .hint(format!("there are {}", listed(classes.iter())))
    })
}

/// The class of a group that can be written.
pub fn writable(model: Model, group: u16) -> Result<&'static Span, Failure> {
    let span = class(model, group)?;
    if span.writable {
        return Ok(span);
    }
    let first = Signal { group, bit: 0 };
    let writable = listed(classes(model).iter().filter(|span| span.writable));
    Err(Failure::usage(format!("group {group} ({first}) is {}, which can only be read on a {model}", span.meaning))
        .hint(format!("a PC writes {writable}; let the ladder program pass them on")))
}

fn classes(model: Model) -> &'static [Span] {
    Row::of(0x78).map_or(&[], |row| row.instances.of(model))
}

fn listed<'a>(spans: impl Iterator<Item = &'a Span>) -> String {
    let range = |span: &Span| {
        format!(
            "{} to {} ({})",
            Signal { group: span.first, bit: 0 },
            Signal { group: span.last, bit: 7 },
            span.meaning
        )
    };
    spans.map(range).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_the_manuals_write_them() {
        assert_eq!("#20013".parse(), Ok(Signal { group: 2001, bit: 3 }));
        assert_eq!("10".parse(), Ok(Signal { group: 1, bit: 0 }));
        assert_eq!(Signal { group: 1, bit: 0 }.to_string(), "#00010");
        for wrong in ["", "#", "-1", "+10", "1x", "999999999", "4294967296"] {
            assert!(wrong.parse::<Signal>().is_err(), "{wrong}");
        }
        assert_eq!(
            "9".parse::<Signal>().unwrap_err(),
            "there is no signal #00009: eight share a group, so the last digit is 0 to 7 (#00000 to #00007 here)"
        );
    }

    #[test]
    fn ranges_leave_out_what_does_not_exist() {
        let Signals(signals) = Signals::parse("20016..#20021").unwrap();
        assert_eq!(
            signals.iter().map(ToString::to_string).collect::<Vec<_>>(),
            ["#20016", "#20017", "#20020", "#20021"]
        );
        assert!(Signals::parse("20017..20010").is_err());
        assert!(Signals::parse("20010..20018").is_err());
    }

    #[test]
    fn what_cannot_be_written_is_said_with_what_can() {
        let failure = writable(Model::Dx200, 1001).unwrap_err();
        assert_eq!(failure.message, "group 1001 (#10010) is robot user output, which can only be read on a dx200");
        assert!(failure.hint.unwrap().contains("#27010 to #29567 (network input)"));
        assert!(writable(Model::Fs100, 2501).is_ok());
        assert!(writable(Model::Fs100, 2701).unwrap_err().message.ends_with("does not exist on a fs100"));
    }
}

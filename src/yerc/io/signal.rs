//! Signal and group arguments.

use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::yerc::signal::{Signal, SignalError, io_class};
use armctl_controller::yerc::table::{Row, Span};
use armctl_controller::yerc::variables::{IoStep, plan_io_reads};

/// Placeholder for a name that is not resolved yet: a signal that exists on every model.
const ANY: &str = "10010";

/// Parses a single signal: `20010`, `#20010`, or its name.
pub fn parse_single(text: &str) -> Result<Signal, String> {
    names::parse_or_name(&[Kind::Signal], ANY, text, |text| {
        text.parse().map_err(|error: SignalError| error.to_string())
    })
}

/// A signal or a range of signals, as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signals(pub Vec<Signal>);

impl Signals {
    /// Parses `20010`, `#20010`, a range such as `20010..20027` (both ends included), or a name.
    pub fn parse(text: &str) -> Result<Self, String> {
        names::parse_or_name(&[Kind::Signal], ANY, text, Self::addresses)
    }

    fn addresses(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.parse::<Signal>().map(Signal::number).map_err(|error| error.to_string());
        Ok(Self(user_input::range(text, number)?.filter_map(|number| Signal::new(number).ok()).collect()))
    }
}

/// Number of a signal in a group, such as `#20010`. `bit` is 0 to 7.
pub fn name(group: u16, bit: u8) -> String {
    format!("#{:05}", u32::from(group) * 10 + u32::from(bit))
}

/// Class of a group: its meaning, and whether signals of the group can be written.
pub fn class(model: Model, group: u16) -> Result<&'static Span> {
    io_class(model, group).ok_or_else(|| {
        Failure::usage(format!("group {group} ({}) does not exist on a {model}", name(group, 0)))
            .hint(format!("there are {}", listed(model, |_| true)))
    })
}

/// Meanings of groups, and the requests that read the groups. If `to_write` is set, all groups must be writable.
pub fn is_readable(model: Model, groups: &[u16], to_write: bool) -> Result<(Vec<&'static str>, Vec<IoStep>)> {
    let class = if to_write { writable } else { class };
    let meanings = groups.iter().map(|group| Ok(class(model, *group)?.meaning)).collect::<Result<_>>()?;
    Ok((meanings, plan_io_reads(model, groups).map_err(usage)?))
}

/// Class of a group, which must be writable.
pub fn writable(model: Model, group: u16) -> Result<&'static Span> {
    let span = class(model, group)?;
    if span.writable {
        return Ok(span);
    }
    let (first, meaning) = (name(group, 0), span.meaning);
    Err(Failure::usage(format!("group {group} ({first}) is {meaning}, which a PC cannot write on a {model}")).hint(
        format!(
            "use signals that a PC can write ({}), and transfer them with the ladder program",
            listed(model, |span| span.writable)
        ),
    ))
}

/// All groups of a model.
pub fn groups(model: Model) -> impl Iterator<Item = (u16, &'static Span)> {
    let spans = Row::from_number(0x78).map_or(&[][..], |row| row.instances.for_model(model));
    spans.iter().flat_map(|span| (span.first..=span.last).map(move |group| (group, span)))
}

fn listed(model: Model, wanted: impl Fn(&Span) -> bool) -> String {
    let spans = Row::from_number(0x78).map_or(&[][..], |row| row.instances.for_model(model));
    let range = |span: &Span| format!("{} to {} ({})", name(span.first, 0), name(span.last, 7), span.meaning);
    spans.iter().filter(|span| wanted(span)).map(range).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_omit_missing_addresses() {
        let Signals(signals) = Signals::parse("20016..#20021").unwrap();
        let names: Vec<String> = signals.iter().map(ToString::to_string).collect();
        assert_eq!(names, ["#20016", "#20017", "#20020", "#20021"]);
        assert!(Signals::parse("20017..20010").is_err());
        assert!(Signals::parse("20010..20018").is_err());
    }

    #[test]
    fn rejects_read_only_signals_with_the_writable_ones() {
        let failure = writable(Model::Dx200, 1001).unwrap_err();
        assert_eq!(failure.message, "group 1001 (#10010) is robot user output, which a PC cannot write on a dx200");
        assert!(failure.hint.unwrap().contains("#27010 to #29567 (network input)"));
        assert!(writable(Model::Fs100, 2501).is_ok());
        assert!(writable(Model::Fs100, 2701).unwrap_err().message.ends_with("does not exist on a fs100"));
    }
}

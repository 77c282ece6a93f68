//! `yrcx io`: signals. SO are outputs and SI inputs of the controller; numbers are octal, as in the manual.

mod get;
mod list;
mod map;
mod set;
mod watch;

use crate::number_arguments::Series;
use crate::prelude::*;
use armctl_controller::names::{Kind, Names};
use armctl_controller::yrcx::register::Register;
use armctl_frame::Offline;
use armctl_frame::robot::io::{IoItem, IoKind, IoRow};

commands! {
    /// Commands for signals.
    pub enum Io {
        /// Read signals
        Get(get::Get),
        /// Switch inputs of the controller, for example servo-on=on, 20=off or SIW2=5
        Set(set::Set),
        /// List the signals that are on or have a name
        List(list::List),
        /// Pulse an input of the controller
        Pulse(set::Pulse),
        /// Show signal changes until Ctrl-C
        Watch(Watch<watch::Outputs>),
        /// Show the fieldbus addresses of words and signals, for the PLC engineer
        Map(Offline<map::Map>),
    }
}

/// A signal or a word that the user named.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum SignalOrWord {
    Signal(Signal),
    Word(Register),
}

impl SignalOrWord {
    fn side(self) -> Side {
        match self {
            Self::Signal(signal) => signal.side(),
            Self::Word(register) => register.side(),
        }
    }
}

impl fmt::Display for SignalOrWord {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Signal(signal) => signal.fmt(f),
            Self::Word(register) => register.fmt(f),
        }
    }
}

/// Parses a signal, a word, a range of them, or a name that the user assigned.
fn readables(text: &str) -> Result<Series<SignalOrWord>, String> {
    names::parse_or_name(&[Kind::Signal], "SO(20)", text, Series::reader(readable))
}

fn readable(text: &str) -> Result<SignalOrWord, String> {
    match Register::parse(text) {
        Some(register) => register.map(SignalOrWord::Word),
        None => signal(text).map(SignalOrWord::Signal),
    }
}

/// Parses a signal. `servo-on`, `20` and `SO(20)` are outputs of the controller. `SI20` is an input. A name that only
/// inputs have, for example `stop`, is an input too.
fn signal(text: &str) -> Result<Signal, String> {
    let is_input = text.get(..2).is_some_and(|prefix| prefix.eq_ignore_ascii_case("SI"));
    let side = if is_input { Side::Input } else { Side::Output };
    Signal::parse(side, text).or_else(|error| input(text).map_err(|_| error.to_string()))
}

/// Parses an input of the controller. Also returns the name, if the user typed a name that the user assigned.
fn named_input(text: &str) -> Result<(Signal, Option<String>), String> {
    let signal = names::parse_or_name(&[Kind::Signal], ANY_INPUT, text, input)?;
    Ok((signal, input(text).is_err().then(|| text.to_owned())))
}

/// Input that stands for a name as long as the name is not resolved.
const ANY_INPUT: &str = "SI(20)";

/// Text of a signal: name and number.
fn called(signal: Signal, name: Option<&String>) -> String {
    name.map_or_else(|| signal.named(), |name| format!("{name} ({signal})"))
}

/// Parses an input of the controller.
fn input(text: &str) -> Result<Signal, String> {
    Signal::parse(Side::Input, text).map_err(|error| error.to_string())
}

/// Signal in reports.
fn item(signal: Signal, names: &Names) -> IoItem {
    let dedicated = signal.dedicated();
    let address = signal.to_string();
    // If an input and an output have the same name, the name means the output. The input is then reported by its
    // address.
    let is_one = |name: &&str| self::signal(name).is_ok_and(|typed| typed == signal);
    let name = dedicated.map(|dedicated| dedicated.name).filter(is_one);
    IoItem {
        name: name.map_or_else(|| address.clone(), ToOwned::to_owned),
        label: names::label(names, Kind::Signal, &address),
        kind: if signal.side() == Side::Input { IoKind::Input } else { IoKind::Output },
        address,
        meaning: dedicated.map(|dedicated| dedicated.text.to_owned()),
    }
}

/// Row of a signal that was read.
fn row(signal: Signal, image: &Image, names: &Names) -> IoRow {
    IoRow::state(item(signal, names), Ok(signal.is_on(image)))
}

/// Describes a general-purpose word for reports; `image` contains the word.
fn word_item(register: Register, image: Option<&Image>, names: &Names) -> IoItem {
    let name = register.to_string();
    let is_in_command = image.is_some_and(|image| image.command()[0] != 0);
    IoItem {
        label: names::label(names, Kind::Signal, &name),
        kind: IoKind::Word,
        address: name.clone(),
        name,
        meaning: is_in_command.then(|| "part of a remote command".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_mean_outputs_by_default() {
        let read = |text| readable(text).unwrap().to_string();
        assert_eq!((read("servo-on"), read("20"), read("so157")), ("SO(02)".into(), "SO(20)".into(), "SO(157)".into()));
        assert_eq!((read("SI20"), read("si(06)")), ("SI(20)".into(), "SI(06)".into()));
        assert_eq!(input("servo-on").unwrap().to_string(), "SI(01)");
        assert!(readable("SO(05)").unwrap_err().contains("reserved"));
        assert!(input("SO20").is_err());
    }
}

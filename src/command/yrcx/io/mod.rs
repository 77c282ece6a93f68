//! `yrcx io`: signals. SO is what the controller shows, SI what it is shown; numbers are octal, as in the manual.

mod get;
mod map;
mod set;
mod watch;

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::frame::names;
use crate::command::frame::watch::Watch;
use crate::command::yrcx::numbers::Series;
use crate::command::{Offline, commands};
use crate::controller::names::{Kind, Names};
use crate::controller::yrcx::image::Image;
use crate::controller::yrcx::register::Register;
use crate::controller::yrcx::signal::{Side, Signal};
use crate::output::view::{Cell, Table};

commands! {
    /// What can be done with signals.
    pub enum Io {
        /// Read signals
        Get(get::Get),
        /// Switch inputs of the controller: servo-on=on, 20=off, SIW2=5
        Set(set::Set),
        /// Pulse an input of the controller
        Pulse(set::Pulse),
        /// Show signal changes until Ctrl-C
        Watch(Watch<watch::Outputs>),
        /// The addresses of words and signals on a fieldbus, for the PLC engineer
        Map(Offline<map::Map>),
    }
}

/// A signal or a word as typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Readable {
    Signal(Signal),
    Word(Register),
}

impl Readable {
    fn side(self) -> Side {
        match self {
            Self::Signal(signal) => signal.side(),
            Self::Word(register) => register.side(),
        }
    }
}

impl std::fmt::Display for Readable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Signal(signal) => signal.fmt(f),
            Self::Word(register) => register.fmt(f),
        }
    }
}

/// Signals and words as typed, a range of them, or the name of one.
fn readables(text: &str) -> Result<Series<Readable>, String> {
    names::read(&[Kind::Signal], "SO(20)", text, Series::reader(readable))
}

fn readable(text: &str) -> Result<Readable, String> {
    match Register::parse(text) {
        Some(register) => register.map(Readable::Word),
        None => signal(text).map(Readable::Signal),
    }
}

/// A signal as typed: `servo-on`, `20` and `SO(20)` are outputs of the controller, `SI20` is an input, and so is what only
/// an input is called, such as `stop`.
fn signal(text: &str) -> Result<Signal, String> {
    let is_input = text.get(..2).is_some_and(|prefix| prefix.eq_ignore_ascii_case("SI"));
    let side = if is_input { Side::Input } else { Side::Output };
    Signal::parse(side, text).or_else(|error| input(text).map_err(|_| error.to_string()))
}

/// An input of the controller as typed, or by its name; with the name, if it was that.
fn named_input(text: &str) -> Result<(Signal, Option<String>), String> {
    let signal = names::read(&[Kind::Signal], ANY_INPUT, text, input)?;
    Ok((signal, input(text).is_err().then(|| text.to_owned())))
}

/// Stands for a name that is not known yet.
const ANY_INPUT: &str = "SI(20)";

/// A signal in words: its name, and which it is.
fn called(signal: Signal, name: Option<&String>) -> String {
    name.map_or_else(|| signal.named(), |name| format!("{name} ({signal})"))
}

/// An input of the controller as typed.
fn input(text: &str) -> Result<Signal, String> {
    Signal::parse(Side::Input, text).map_err(|error| error.to_string())
}

/// A signal and its state.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
struct State {
    /// `SO(02)`.
    signal: String,
    /// Its name; null for general-purpose signals.
    name: Option<&'static str>,
    /// What people call it; null where they gave it no name.
    label: Option<String>,
    on: bool,
    /// What it says or does; null for general-purpose signals.
    meaning: Option<&'static str>,
}

impl State {
    fn of(signal: Signal, image: &Image, names: &Names) -> Self {
        let dedicated = signal.dedicated();
        let address = signal.to_string();
        Self {
            label: names::label(names, Kind::Signal, &address),
            signal: address,
            name: dedicated.map(|dedicated| dedicated.name),
            on: signal.is_on(image),
            meaning: dedicated.map(|dedicated| dedicated.text),
        }
    }
}

/// A general-purpose word and what it holds.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
struct WordState {
    /// `SOW(2)`, `SID(4)`.
    word: String,
    /// What people call it; null where they gave it no name.
    label: Option<String>,
    /// Without a sign.
    value: u32,
    /// The same, as in `0x0005`.
    hex: String,
    /// A remote command or its answer has the words now: this is a part of it.
    in_command: bool,
}

impl WordState {
    fn of(register: Register, image: &Image, names: &Names) -> Self {
        let words = image.command();
        let value = register.read(&words);
        let word = register.to_string();
        let label = names::label(names, Kind::Signal, &word);
        Self { word, label, value, hex: register.hex(value), in_command: words[0] != 0 }
    }
}

fn word_table(words: &[WordState]) -> Table {
    let mut table = Table::new(&["word", "label", "value", "hex", "of a remote command"], "no words");
    for WordState { word, label, value, hex, in_command } in words {
        let in_command = if *in_command { "yes" } else { "no" };
        let label = Cell::maybe(label.as_deref());
        table.row([word.as_str().into(), label, (*value).into(), hex.as_str().into(), in_command.into()]);
    }
    table.without_blank("label")
}

fn table(states: &[State], empty: &'static str) -> Table {
    let mut table = Table::new(&["signal", "name", "label", "state", "meaning"], empty);
    for State { signal, name, label, on, meaning } in states {
        let label = Cell::maybe(label.as_deref());
        table.row([signal.as_str().into(), Cell::maybe(*name), label, Cell::switch(*on), Cell::maybe(*meaning)]);
    }
    table.without_blank("label")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_outputs_unless_said_otherwise() {
        let read = |text| readable(text).unwrap().to_string();
        assert_eq!((read("servo-on"), read("20"), read("so157")), ("SO(02)".into(), "SO(20)".into(), "SO(157)".into()));
        assert_eq!((read("SI20"), read("si(06)")), ("SI(20)".into(), "SI(06)".into()));
        assert_eq!(input("servo-on").unwrap().to_string(), "SI(01)");
        assert!(readable("SO(05)").unwrap_err().contains("reserved"));
        assert!(input("SO20").is_err());
    }
}

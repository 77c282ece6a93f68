//! `yerc io`: signals by logical number.

mod get;
mod set;
mod signal;
#[cfg(test)]
mod tests;

use schemars::JsonSchema;
use serde::Serialize;

use crate::command::commands;
use crate::command::frame::items::{ItemError, ItemOutcome};
use crate::command::frame::names;
use crate::command::frame::watch::Watch;
use crate::controller::names::{Kind, Names};
use crate::controller::yerc::Model;
use crate::controller::yerc::signal::Signal;
use crate::failure::Failure;
use crate::output::view::{Cell, Section, Table};

commands! {
    /// What can be done with signals.
    pub enum Io {
        /// Read signals: 20010, #20010..#20017, or --group 2001
        Get(get::Get),
        /// Switch network inputs: 27010=on, or --group 2701=0xA5
        Set(set::Set),
        /// Print each change of signals
        Watch(Watch<get::Get>),
    }
}

/// A signal and its state.
#[derive(Debug, PartialEq, Serialize, JsonSchema)]
struct SignalState {
    signal: u32,
    /// `#20010`.
    name: String,
    /// What people call it; null where it has no name.
    label: Option<String>,
    /// `external input`.
    class: &'static str,
    /// The group of eight that holds it.
    group: u16,
    bit: u8,
    #[serde(flatten)]
    outcome: ItemOutcome<On>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
struct On {
    on: bool,
}

impl SignalState {
    fn new(model: Model, signal: Signal, names: &Names, on: Result<bool, Failure>) -> Result<Self, Failure> {
        let class = signal::class(model, signal.group())?.meaning;
        let (number, group, bit, name) = (signal.number(), signal.group(), signal.bit(), signal.to_string());
        let outcome = ItemOutcome::new(name.as_str(), on.map(|on| On { on }));
        let label = names::label(names, Kind::Signal, &name);
        Ok(Self { signal: number, name, label, class, group, bit, outcome })
    }
}

/// A group of eight signals.
#[derive(Debug, PartialEq, Serialize, JsonSchema)]
struct GroupState {
    group: u16,
    /// The first of its signals.
    first: String,
    /// The last of its signals.
    last: String,
    /// `external input`.
    class: &'static str,
    #[serde(flatten)]
    outcome: ItemOutcome<GroupValue>,
}

#[derive(Debug, PartialEq, Eq, Serialize, JsonSchema)]
struct GroupValue {
    /// The first signal is the least significant bit.
    value: u8,
    /// `0xa5`.
    value_hex: String,
}

impl GroupState {
    fn new(model: Model, group: u16, value: Result<u8, Failure>) -> Result<Self, Failure> {
        let value = value.map(|value| GroupValue { value, value_hex: format!("{value:#04x}") });
        Ok(Self {
            group,
            first: signal::name(group, 0),
            last: signal::name(group, 7),
            class: signal::class(model, group)?.meaning,
            outcome: ItemOutcome::new(format!("group {group}"), value),
        })
    }
}

fn signal_table<'a>(signals: impl Iterator<Item = &'a SignalState>) -> Option<Section> {
    let mut table = Table::new(&["signal", "label", "class", "state"], "no signals");
    for state in signals {
        let on = match (state.outcome.data(), state.outcome.error()) {
            (Some(On { on }), _) => Cell::switch(*on),
            (None, error) => error.map_or_else(|| "-".into(), ItemError::cell),
        };
        table.row([state.name.as_str().into(), Cell::maybe(state.label.as_deref()), state.class.into(), on]);
    }
    (!table.rows.is_empty()).then_some(Section::Table(table.without_blank("label")))
}

fn group_table<'a>(groups: impl Iterator<Item = &'a GroupState>) -> Option<Section> {
    let mut table = Table::new(&["group", "signals", "class", "value", "7 to 0"], "no groups");
    for state in groups {
        let [value, bits] = match (state.outcome.data(), state.outcome.error()) {
            (Some(group), _) => [Cell::from(group.value_hex.as_str()), format!("{:08b}", group.value).into()],
            (None, error) => ["-".into(), error.map_or_else(|| "-".into(), ItemError::cell)],
        };
        table.row([
            state.group.into(),
            format!("{} to {}", state.first, state.last).into(),
            state.class.into(),
            value,
            bits,
        ]);
    }
    (!table.rows.is_empty()).then_some(Section::Table(table))
}

//! `yerc io`: signals by logical number.

mod get;
mod set;
mod signal;
#[cfg(test)]
mod tests;

use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use crate::command::commands;
use crate::controller::yerc::Model;
use crate::controller::yerc::signal::Signal;
use crate::failure::Failure;
use crate::output::view::{Cell, Section, Table};

commands! {
    /// What can be done with signals.
    pub enum Io of Family {
        /// Read signals: 20010, #20010..#20017, or --group 2001
        Get(get::Get),
        /// Switch network inputs: 27010=on, or --group 2701=0xA5
        Set(set::Set),
    }
}

/// A signal and its state.
#[derive(Debug, PartialEq, Eq, Serialize, JsonSchema)]
struct SignalState {
    signal: u32,
    /// `#20010`.
    name: String,
    /// `external input`.
    class: &'static str,
    on: bool,
    /// The group of eight that holds it.
    group: u16,
    bit: u8,
}

impl SignalState {
    fn new(model: Model, signal: Signal, on: bool) -> Result<Self, Failure> {
        let class = signal::class(model, signal.group())?.meaning;
        let (number, group, bit) = (signal.number(), signal.group(), signal.bit());
        Ok(Self { signal: number, name: signal.to_string(), class, on, group, bit })
    }
}

/// A group of eight signals.
#[derive(Debug, PartialEq, Eq, Serialize, JsonSchema)]
struct GroupState {
    group: u16,
    /// The first of its signals.
    first: String,
    /// The last of its signals.
    last: String,
    /// `external input`.
    class: &'static str,
    /// The first signal is the least significant bit.
    value: u8,
    /// `0xa5`.
    value_hex: String,
}

impl GroupState {
    fn new(model: Model, group: u16, value: u8) -> Result<Self, Failure> {
        Ok(Self {
            group,
            first: signal::name(group, 0),
            last: signal::name(group, 7),
            class: signal::class(model, group)?.meaning,
            value,
            value_hex: format!("{value:#04x}"),
        })
    }
}

fn signal_table(signals: &[SignalState]) -> Option<Section> {
    let mut table = Table::new(&["signal", "class", "state"], "no signals");
    for state in signals {
        table.row([state.name.as_str().into(), state.class.into(), Cell::switch(state.on)]);
    }
    (!signals.is_empty()).then_some(Section::Table(table))
}

fn group_table(groups: &[GroupState]) -> Option<Section> {
    let mut table = Table::new(&["group", "signals", "class", "value", "7 to 0"], "no groups");
    for state in groups {
        table.row([
            state.group.into(),
            format!("{} to {}", state.first, state.last).into(),
            state.class.into(),
            state.value_hex.as_str().into(),
            format!("{:08b}", state.value).into(),
        ]);
    }
    (!groups.is_empty()).then_some(Section::Table(table))
}

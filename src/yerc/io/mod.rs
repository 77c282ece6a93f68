//! `yerc io`: signals by logical number.

mod get;
mod list;
mod set;
mod signal;
#[cfg(test)]
mod tests;

use crate::prelude::*;
use armctl_controller::names::{Kind, Names};
use armctl_controller::yerc::signal::Signal;
use armctl_frame::names;
use armctl_frame::robot::io::{IoItem, IoKind};

commands! {
    /// Commands for signals.
    pub enum Io {
        /// Read signals, for example 20010, #20010..#20017, or --group 2001
        Get(get::Get),
        /// Switch network inputs, for example 27010=on, or --group 2701=0xA5
        Set(set::Set),
        /// List the signals that are on or have a name
        List(list::List),
        /// Print each change of signals
        Watch(Watch<get::Get>),
    }
}

/// Report item of a signal.
fn item(model: Model, signal: Signal, names: &Names) -> Result<IoItem, Failure> {
    let class = signal::class(model, signal.group())?.meaning;
    let name = signal.to_string();
    let label = names::label(names, Kind::Signal, &name);
    Ok(IoItem { address: name.clone(), name, label, kind: kind(class), meaning: Some(class.to_owned()) })
}

/// Report item of a group of eight signals. The first signal is the lowest bit.
fn group_item(model: Model, group: u16) -> Result<IoItem, Failure> {
    let class = signal::class(model, group)?.meaning;
    let (first, last) = (signal::name(group, 0), signal::name(group, 7));
    let address = format!("{first}..{last}");
    Ok(IoItem { name: group.to_string(), label: None, kind: IoKind::Group, address, meaning: Some(class.to_owned()) })
}

/// Which side sets the signals of a class.
fn kind(class: &str) -> IoKind {
    if class.ends_with("input") {
        IoKind::Input
    } else if class.ends_with("output") {
        IoKind::Output
    } else {
        IoKind::Internal
    }
}

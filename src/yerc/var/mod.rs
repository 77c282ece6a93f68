//! `yerc var`: one or several variables.

mod cells;
#[cfg(test)]
mod command_tests;
mod position;
mod position_word;
mod raw;
mod set;
mod table;
mod value;

pub use self::position::{PositionData, as_position, stored_position};
pub use self::position_word::different_words;
pub use self::raw::confirm_raw;
use self::table::Variables;
pub use self::table::is_undefined;
use crate::prelude::*;
use armctl_controller::names::{Kind, Names};
use armctl_controller::yerc::variables::Reference;
use armctl_frame::store::{Copy, Dump, Get, List, Restore};

commands! {
    /// Commands for variables.
    pub enum Var {
        /// Read variables, for example B0 I1..I20 D5 R3 S2 P10 BP1 EX1
        Get(Get<Variables>),
        /// Write variables, for example B0=255 R3=1.5 S7=HELLO P1=base:x=…
        Set(set::Set),
        /// List the variables that are not empty
        List(List<Variables>),
        /// Print each change of variables
        Watch(Watch<Get<Variables>>),
        /// Copy a variable to other variables of the same kind, for example `P5 P6..P8`
        Copy(Copy<Variables>),
        /// Save variables to a CSV file
        Dump(Dump<Variables>),
        /// Write variables from a CSV file
        Restore(Restore<Variables>),
    }
}

/// Name of a variable in a confirmation: `P5`, or `P5 (HOME)` if the user has named it.
pub fn variable_name(names: &Names, variable: Reference) -> String {
    let address = variable.to_string();
    match names.label(Kind::Variable, &address) {
        Some(label) => format!("{address} ({label})"),
        None => address,
    }
}

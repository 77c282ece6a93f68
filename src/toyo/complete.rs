//! Completion candidates for arguments.

use armctl_controller::names::Kind;
use armctl_controller::toyo::table::instructions::INSTRUCTIONS;
use armctl_controller::toyo::table::palletizing::RECORDS;
use armctl_controller::toyo::table::parameters::PARAMETERS;
use armctl_frame::settings::target::Family;
use armctl_frame::value_kind::Named;
use armctl_frame::{Candidate, ValueKind};

/// A bit of an output port by its name, with the state to set.
pub const OUTPUT_STATE: ValueKind = named(&[Kind::Output], &["=on", "=off"]);
/// A signal by its name.
pub const SIGNAL: ValueKind = named(&[Kind::Input, Kind::Output], &[""]);
/// A counter by its name.
pub const COUNTER: ValueKind = named(&[Kind::Counter], &[""]);

/// A timer by its name.
pub const TIMER: ValueKind = named(&[Kind::Timer], &[""]);
/// A point by its name.
pub const POINT: ValueKind = named(&[Kind::Point], &[""]);

const fn named(kinds: &'static [Kind], endings: &'static [&'static str]) -> ValueKind {
    ValueKind::Named(Family::Toyo, Named { kinds, endings, listed: Vec::new })
}

/// A parameter, by name or id.
pub const PARAMETER: ValueKind =
    ValueKind::Listed(|| PARAMETERS.iter().map(|row| Candidate::new(row.name, row.about)).collect());
/// The instruction of a step of a program.
pub const INSTRUCTION: ValueKind =
    ValueKind::Listed(|| INSTRUCTIONS.iter().map(|row| Candidate::new(row.word, row.about)).collect());
/// A record of a palletizing program.
pub const RECORD: ValueKind =
    ValueKind::Listed(|| RECORDS.iter().map(|row| Candidate::new(row.name, row.about)).collect());

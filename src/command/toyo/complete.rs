//! Candidates for arguments.

use crate::command::{Candidate, ValueKind};
use crate::controller::toyo::table::instructions::INSTRUCTIONS;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::controller::toyo::table::parameters::PARAMETERS;

/// A parameter, by name or id.
pub const PARAMETER: ValueKind =
    ValueKind::Listed(|| PARAMETERS.iter().map(|row| Candidate::new(row.name, row.about)).collect());
/// The instruction of a step of a program.
pub const INSTRUCTION: ValueKind =
    ValueKind::Listed(|| INSTRUCTIONS.iter().map(|row| Candidate::new(row.word, row.about)).collect());
/// A record of a palletizing program.
pub const RECORD: ValueKind =
    ValueKind::Listed(|| RECORDS.iter().map(|row| Candidate::new(row.name, row.about)).collect());

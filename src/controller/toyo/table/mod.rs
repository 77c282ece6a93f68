//! Protocol tables: commands, parameters, instructions, palletizing records.
//!
//! These tables are the single source for encoder, decoder, simulator, `raw`, `decode`, `explain`, help and completion.

pub mod commands;
mod fields;
pub mod instructions;
pub mod palletizing;
pub mod parameters;

pub use commands::{Command, Row};
pub use instructions::{Instruction, Op};
pub use palletizing::Pallet;
pub use parameters::{Group, Parameter};

/// Names of the controllers that have a row of a table, as in the manual.
pub type Models = &'static [&'static str];

/// All controllers support the row.
pub const ALL_MODELS: Models = &[];
/// The newer two-axis synchronous series.
pub const KCA20: Models = &["KCA-20-M00", "KCA-20-M01"];
/// The series with torque limits.
pub const KCA25: Models = &["KCA-25-M10", "KCA-25-M40", "KCA-25-M80"];
/// Both series. The EEPROM of these controllers does not wear out (TO 2-1, note 2).
pub const KCA: Models = &["KCA-20-M00", "KCA-20-M01", "KCA-25-M10", "KCA-25-M40", "KCA-25-M80"];
/// A row that needs a minimum version, not a model (ambiguity R24).
pub const FROM_3_36: Models = &["version 3.36 or later"];

/// Whether a controller has a feature that only some models or versions have. `version` is in hundredths: 336 for 3.36.
pub fn supports(only_on: Models, model: &str, version: i32) -> bool {
    only_on.is_empty() || only_on.contains(&model) || (only_on == FROM_3_36 && version >= 336)
}

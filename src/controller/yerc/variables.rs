//! Variables: kinds, values, references such as `B0..B99`, and plans of requests for many variables.

mod plan;
pub(super) mod reference;
pub(super) mod value;

pub use plan::{
    IoStep, PlannedRead, ReadStep, RegisterStep, WriteIoStep, WriteRegisterStep, WriteStep, plan_io_reads,
    plan_io_writes, plan_reads, plan_register_reads, plan_register_writes, plan_writes,
};
pub use reference::{Reference, ReferenceError, VariableKind, parse_numbers, parse_references};
pub use value::{Value, ValueError};

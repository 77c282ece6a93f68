//! Programs of a robot or of a folder, whatever the family.

pub mod source;

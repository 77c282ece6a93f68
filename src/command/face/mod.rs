//! What the rest of the house may ask of a family.

pub mod layers;
pub mod sample;

//! Commands for robots of any family.

pub mod backup;
pub mod poll;
#[cfg(feature = "plant")]
pub mod publish;
pub mod robots;
pub mod session;
pub mod setup;
pub mod status;
pub mod teach;
pub mod tools;
pub mod top;

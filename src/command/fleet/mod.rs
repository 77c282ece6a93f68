//! Commands for robots of any family.

pub mod backup;
pub mod poll;
pub mod robots;
pub mod session;
pub mod setup;
pub mod status;
pub mod teach;
pub mod tools;
pub mod top;

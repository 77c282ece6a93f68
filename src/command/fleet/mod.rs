//! Commands for robots of any family.

#[cfg(feature = "plant")]
pub mod also;
pub mod backup;
pub mod common;
#[cfg(feature = "plant")]
pub mod metrics;
pub mod names;
pub mod poll;
#[cfg(feature = "plant")]
pub mod publish;
pub mod report;
#[cfg(feature = "plant")]
pub mod report_values;
pub mod robots;
#[cfg(feature = "plant")]
pub mod serve;
#[cfg(feature = "plant")]
pub mod service;
pub mod session;
pub mod setup;
pub mod status;
pub mod teach;
pub mod tools;
pub mod top;
pub mod wait;

//! Toyo controllers over RS-232C host communication.
//!
//! Sections are those of the manual, as "TO 2-4"; where it errs, the reading chosen is told as an ambiguity.

pub mod bulk;
pub mod describe;
pub mod errors;
pub mod field;
pub mod layout;
pub mod names;
pub mod passing;
pub mod program;
pub mod request;
pub mod session;
pub mod simulator;
pub mod status;
pub mod table;

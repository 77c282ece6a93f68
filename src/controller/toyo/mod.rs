//! Toyo controllers: host communication over RS-232C.
//!
//! References such as "TO 2-4" are sections of the manual. "Ambiguity" refers to a note about an unclear or wrong place
//! in the manual.

pub mod describe;
pub mod errors;
pub mod field;
pub mod layout;
pub mod names;
pub mod program;
pub mod read_only_filter;
pub mod request;
pub mod session;
pub mod simulator;
pub mod status;
pub mod table;

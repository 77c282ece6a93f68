//! Names that almost every command of this family uses.

pub mod basics;

pub use self::basics::*;
pub(crate) use crate::complete;
pub(crate) use crate::control_commands::usage;
pub(crate) use crate::item_requests::read_failure;
pub(crate) use crate::link::{Link, Yerc};

//! Names that almost every command of this family uses.

pub mod basics;

pub use self::basics::*;
pub(crate) use crate::complete;
pub(crate) use crate::link::{Link, Yrcx};
pub(crate) use crate::refusal::BuildOrder as _;

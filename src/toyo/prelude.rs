//! Names that almost every command of this family uses.

pub mod basics;

pub use self::basics::*;
pub(crate) use crate::link::{Link, Toyo, wrong};
pub(crate) use crate::program::steps;
pub(crate) use crate::{complete, task_selection};

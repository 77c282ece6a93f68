//! `yrcx backup` and `yrcx restore`: what remote commands read and write, in a folder of text files with a list of itself.
//!
//! Programs and all else are out of reach of remote commands.

mod content;
mod parts;
mod restore;
mod rows;
mod save;
mod sheet;
#[cfg(test)]
mod tests;

pub use parts::{COMMENTS, HANDS, PALLETS, POINTS, Records, SHIFTS, VARIABLES};
pub use restore::restore;
pub use save::{Backup, back_up, points};
pub use sheet::{Dump, Restore};

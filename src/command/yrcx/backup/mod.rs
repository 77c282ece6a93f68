//! `yrcx backup` and `yrcx restore`: a folder of text files with a manifest, read and written with remote commands.
//!
//! Remote commands cannot reach programs and other data.

mod content;
mod parts;
mod restore;
mod save;
#[cfg(test)]
mod tests;

pub use restore::restore;
pub use save::{Backup, back_up, points};

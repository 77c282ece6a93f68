//! `toyo backup` and `toyo restore`: all data that a controller stores, in a folder of text files with a manifest.

mod content;
mod manifest;
mod parts;
mod restore;
mod save;
#[cfg(test)]
mod tests;
pub mod twin;

pub use manifest::Controller;
pub use restore::{Restore, restore};
pub use save::{Backup, back_up};

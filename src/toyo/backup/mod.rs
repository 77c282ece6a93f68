//! `toyo backup` and `toyo restore`: all that is stored in a controller, in a folder of text files with a list of itself.

mod content;
mod manifest;
mod parts;
mod restore;
mod save;
#[cfg(test)]
mod tests;

pub use restore::{Restore, restore};
pub use save::{Backup, back_up};

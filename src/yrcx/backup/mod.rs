//! Commands `yrcx backup` and `yrcx restore`. A backup is a folder of text files with a manifest. Remote commands read
//! and write the data.
//!
//! Remote commands have no access to programs and some other data, so a backup does not contain them.

mod content;
mod parts;
mod restore;
mod save;
#[cfg(test)]
mod tests;
pub mod twin;

pub use content::Controller;
pub use restore::restore;
pub use save::{Backup, back_up, points};

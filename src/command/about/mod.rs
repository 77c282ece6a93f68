//! Commands about this program.

pub mod completions;
pub mod help;
pub mod man;
pub mod page;
pub mod schema;

//! Commands about this program.

pub mod completions;
pub mod help;
pub mod man;
pub mod schema;

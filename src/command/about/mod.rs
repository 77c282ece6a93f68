//! Commands about this program.

pub mod completions;
pub mod environment;
pub mod help;
pub mod man;
pub mod page;
pub mod schema;
pub mod wireshark;

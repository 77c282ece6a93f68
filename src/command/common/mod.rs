//! Commands that are about no single controller.

pub mod decode;
pub mod explain;
pub mod sim;

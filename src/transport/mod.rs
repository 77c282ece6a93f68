//! Moves bytes or images, and knows no meaning.
//!
//! Nothing in here knows a controller's protocol, and no controller knows what is in here.

pub mod fault;
pub mod server;
pub mod sim;
pub mod tap;
pub mod udp;

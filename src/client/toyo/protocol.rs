//! Requests, answers and values of the protocol, so that an application needs no other crate.

pub use armctl_controller::toyo::field::{Field, Mask, Value};
pub use armctl_controller::toyo::layout::{Layout, LayoutError, LayoutProblem, Record};
pub use armctl_controller::toyo::request::{Answer, BlockError, Request};
pub use armctl_controller::toyo::session::Counters;
pub use armctl_controller::toyo::simulator::Start;
pub use armctl_controller::toyo::status::Status;
pub use armctl_controller::toyo::table::{Command, Parameter};
pub use armctl_transport::serial::{DataBits, Line as SerialLine, OpenError, Parity, StopBits};
pub use armctl_transport::tcp::ConnectError;

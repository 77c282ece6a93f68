//! Commands, answers, signals and values of the protocol, so that an application needs no other crate.

pub use armctl_controller::yrcx::alarm::Alarm;
pub use armctl_controller::yrcx::answer::{Answer, Status};
pub use armctl_controller::yrcx::codec::WordError;
pub use armctl_controller::yrcx::image::{Image, Words};
pub use armctl_controller::yrcx::order::{Draft, Order};
pub use armctl_controller::yrcx::procedure::Procedure;
pub use armctl_controller::yrcx::register::Register;
pub use armctl_controller::yrcx::sequence;
pub use armctl_controller::yrcx::session::{NotSentReason, Silence};
pub use armctl_controller::yrcx::signal::{Side, Signal, SignalError, input, output};
pub use armctl_controller::yrcx::simulator::Start;
pub use armctl_controller::yrcx::table::Command;
pub use armctl_controller::yrcx::value::{Key, Value, Values};
pub use armctl_transport::image::{ImageLink, LinkError, Traffic};

//! Names that most modules of this family use, also those below the link.

pub use armctl_client::toyo::Letters;
pub use armctl_controller::toyo::field::Value;
pub use armctl_controller::toyo::layout::Record;
pub use armctl_controller::toyo::request::Request;
pub use armctl_controller::toyo::status::Status;
pub use armctl_controller::toyo::table::{self, Parameter};
pub use armctl_frame::prelude::*;

//! Names that almost every command of this family uses.

pub use armctl_controller::yrcx::image::Image;
pub use armctl_controller::yrcx::order::{Draft, Order};
pub use armctl_controller::yrcx::signal::{Side, Signal, output};
pub use armctl_controller::yrcx::table;
pub use armctl_controller::yrcx::value::{Key, Values};
pub use armctl_frame::prelude::*;

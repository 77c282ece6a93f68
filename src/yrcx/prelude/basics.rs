//! Names that most modules of this family use, also those below the link.

pub use crate::link_error::not_open;
pub use armctl_controller::yrcx::alarm::Alarm;
pub use armctl_controller::yrcx::image::Image;
pub use armctl_controller::yrcx::order::{Draft, Order};
pub use armctl_controller::yrcx::signal::{Side, Signal, output};
pub use armctl_controller::yrcx::table;
pub use armctl_controller::yrcx::value::{Key, Values};
pub use armctl_frame::face::layers::Layers;
pub use armctl_frame::prelude::*;

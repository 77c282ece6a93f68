//! Names that most modules of this family use, also those below the link.

pub use armctl_controller::text::Encoding;
pub use armctl_controller::yerc::Model;
pub use armctl_controller::yerc::files::{FileName, FileType};
pub use armctl_controller::yerc::group::Group;
pub use armctl_controller::yerc::payload::{Position, PositionKind};
pub use armctl_controller::yerc::request::Request;
pub use armctl_frame::prelude::*;

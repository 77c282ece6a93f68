//! Names that most modules above the settings and the output use.

pub use clap::Args;
pub use schemars::JsonSchema;
pub use serde::Serialize;

pub use crate::failure::{Failure, Kind};
pub use crate::gate::{Change, Confirmation};
pub use crate::output::Screen;
pub use crate::output::view::{Cell, Section, Table, Tone, View};
pub use crate::settings::Robot;
pub use armctl_controller::Risk;

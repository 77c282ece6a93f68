//! Typed payloads of the data part, in both directions.
//!
//! Parsing keeps unknown content (reserved bits, new enumeration values) and accepts additional bytes. Encoding uses
//! the sizes of the manuals.

mod alarm;
mod axes;
mod info;
mod moves;
mod position;
mod position_text;
mod reader;
mod status;
mod text;

pub use super::subcode::AlarmKind;
pub use alarm::{Alarm, AlarmTexts};
pub use axes::{Axes, AxisNames, MAX_AXES};
pub use info::{JobInfo, ManagementTime, SystemInfo, elapsed_seconds};
pub use moves::{CartesianMove, MoveLayout, PulseMove, Speed, SpeedClass};
pub use position::{BasePosition, ExtendedForm, ExternalPosition, Form, Pose, Position, PositionKind};
pub use position_text::{NamedAxis, PositionTextError};
pub use reader::PayloadError;
pub use status::{ControllerStatus, CycleMode, StatusBit};
pub use text::{Text, TextError};

pub(super) use reader::Reader;

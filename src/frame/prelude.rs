//! Names that almost every command uses: its arguments and its report, its context, its failure, its view and its risk.
//! The families and the commands import all of them at once. The modules of this crate name what they use.

pub use clap::Args;
pub use schemars::JsonSchema;
pub use serde::Serialize;

pub use crate::commands;
pub use crate::dry_run::{Known as _, Reason};
pub use crate::failure::{Failure, Kind};
pub use crate::gate::{Change, Confirmation};
pub use crate::output::Screen;
pub use crate::output::view::{Cell, Section, Table, Tone, View};
pub use crate::run::{Run, RunError};
pub use crate::settings::Robot;
pub use crate::settings_report::{Done, NewValue, Old};
pub use crate::store::{Answers, Differing, Field, Ids, Single, Store, TableWords, Writable, ids, table_commands};
pub use crate::watch::{Watch, Watchable, Watched};
pub use crate::{Access, Command, ConnectMode, Context, Report, ValueKind};
pub use armctl_controller::Risk;

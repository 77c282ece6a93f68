//! Names that almost every command uses: its arguments and its report, its context, its failure, its view and its risk.
//! The families and the commands import all of them at once. Modules of this crate use only [`basics`].

pub mod basics;

pub use self::basics::*;
pub use crate::confirmation::Confirmer;
pub use crate::dry_run::{Known as _, Reason, unknown};
pub use crate::run::{Run, RunError};
pub use crate::settings_report::{NewValue, Old, SetReport};
pub use crate::store::{Answers, Field, Ids, RowDifference, Single, Store, TableWords, Writable, ids, table_commands};
pub use crate::watch::{Watch, Watchable, Watched};
pub use crate::{Access, Command, ConnectMode, Context, ValueKind, commands, names};

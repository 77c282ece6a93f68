//! Execution of all commands.
//!
//! A command is a struct of its arguments that implements [`Command`]. A group of subcommands is a clap enum. Both are
//! [`CommandSet`]s. A command becomes part of the command line, help, man page, completion and schema by a line in the
//! `commands!` list of its family.

pub mod attach;
pub mod authority;
pub mod background;
pub mod batch;
pub mod command;
pub mod command_set;
pub mod condition;
pub mod connection;
pub mod cycle;
pub mod dry_run;
pub mod editor_session;
pub mod interrupt;
pub mod items;
pub mod kind;
pub mod local_names;
pub mod names;
pub mod plot;
pub mod prompt;
pub mod repeat_limiter;
pub mod repl;
pub mod report;
pub mod run;
pub mod script_line;
pub mod session_manager;
pub mod setting;
pub mod settings_report;
pub mod share;
pub mod sheet;
pub mod store;
pub mod teach;
#[cfg(test)]
pub(crate) mod testing;
pub mod text_files;
pub mod trace;
pub mod wait_arguments;
pub mod watch;

pub use command::{AnyCommand, AnyContext, Command, Context};
pub(crate) use command_set::commands;
pub use command_set::{CommandSet, Offline, OfflineCommand, Subcommands};
pub use connection::{Access, AnyFamilyArguments, ConnectMode, Connection, Driver, Entry, Family, FamilyArguments};
pub use kind::{Candidate, ValueKind};
pub use report::{AnyReport, Outcome, Report, SchemaEntry, schema_of};

//! Everything that a command runs on, for all families.
//!
//! | module | contents |
//! |---|---|
//! | [`run`], [`command`], [`report`], [`connection`] | the run loop, and the traits of a command and of its family |
//! | [`gate`], [`confirmation`], [`dry_run`] | whether a command may run; its confirmation; its frames in a dry run |
//! | [`settings`] | robots, target URLs, the inventory |
//! | [`output`] | the only writer to stdout and stderr |
//! | [`failure`] | how a command can fail, with the exit code |
//! | [`store`] | get, list, watch, set, copy, dump and restore for tables of a controller |
//! | [`backup`], [`decode`], [`serve`] | what backups, decoders and simulators of all families have in common |
//! | [`mod@path`] | the motion of a program as a picture |
//! | [`robot`] | reports that all families share: state, alarms, position, signals, motion, files |
//! | [`face`] | what the rest of the program can ask of a family |
//!
//! A command is a struct of its arguments that implements [`Command`]. A group of subcommands is a clap enum. Both are
//! [`CommandSet`]s. A command becomes part of the command line, help, man page, completion and schema by a line in the
//! `commands!` list of its family.

pub mod background;
pub mod backup;
pub mod batch;
pub mod command;
pub mod command_set;
pub mod condition;
pub mod confirmation;
pub mod connection;
pub mod decode;
pub mod dry_run;
pub mod editor_session;
pub mod face;
pub mod failure;
pub mod flags;
pub mod gate;
pub mod guardian;
pub mod interrupt;
pub mod items;
pub mod local_names;
pub mod names;
pub mod output;
pub mod path;
pub mod plot;
pub mod prelude;
pub mod programs;
pub mod prompt;
pub mod repeat_limiter;
pub mod repeated_runs;
pub mod repl;
pub mod report;
pub mod robot;
pub mod run;
pub mod script_line;
pub mod serve;
pub mod session_client;
pub mod session_manager;
pub mod setting;
pub mod settings;
pub mod settings_report;
pub mod shared_session;
pub mod store;
pub mod table_file;
pub mod teach;
#[cfg(any(test, feature = "testing"))]
#[expect(clippy::missing_panics_doc, reason = "helpers of tests fail by panicking")]
pub mod testing;
pub mod text_files;
pub mod trace;
pub mod value_kind;
pub mod wait_arguments;
pub mod watch;
pub mod wireshark;

pub use command::{AnyCommand, AnyContext, Command, Context};
pub use command_set::{CommandSet, Offline, OfflineCommand, Subcommands};
pub use connection::{
    Access, AnyFamilyArguments, ConnectMode, Connection, ConnectionEffect, Driver, Family, FamilyArguments,
};
pub use report::{AnyReport, Outcome, Report, SchemaEntry, schema_of};
pub use value_kind::{Candidate, ValueKind};

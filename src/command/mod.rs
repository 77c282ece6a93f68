//! Commands of the program. Bytes and sockets are in the links of the families, not here.
//!
//! | folder | contents |
//! |---|---|
//! | [`frame`] | execution of every command: traits, command loop, dry run, confirmations, Ctrl-C, output |
//! | [`face`] | interface of a family for the rest of the program |
//! | [`backup`], [`decode`], [`serve`] | common parts of backups, decoding and simulators |
//! | [`yerc`], [`yrcx`], [`toyo`] | the commands of a family, its link, and its [`face`] |
//! | [`families`] | the list of families |
//! | [`fleet`] | commands for robots of any family: status, top, backup, robots, session |
//! | [`about`] | commands about this program: help, man pages, schemas, completions |

pub mod about;
pub mod backup;
pub mod common;
pub mod decode;
pub mod example_lines;
pub mod face;
pub mod families;
pub mod fleet;
pub mod frame;
pub mod missing_verbs;
pub mod robot;
pub mod serve;
pub mod toyo;
pub mod yerc;
pub mod yrcx;

pub(crate) use frame::commands;
pub use frame::{
    Access, AnyCommand, AnyContext, AnyFamilyArguments, AnyReport, Candidate, Command, CommandSet, ConnectMode,
    Connection, Context, Driver, Entry, Family, FamilyArguments, Offline, OfflineCommand, Outcome, Report, SchemaEntry,
    Subcommands, ValueKind,
};

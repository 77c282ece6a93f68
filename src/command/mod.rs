//! What the operator types. No bytes and no sockets in here: those are behind each family's link.
//!
//! | folder | holds |
//! |---|---|
//! | [`frame`] | what runs every command: the traits, the one loop, dry run, questions, Ctrl-C, printing |
//! | [`face`] | what the rest of the house may ask of a family |
//! | [`backup`], [`decode`], [`serve`] | what backups, decoding and simulators have in common in every family |
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

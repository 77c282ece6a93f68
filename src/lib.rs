//! armctl controls industrial robot controllers from a terminal, from a script, or from a Rust program.
//!
//! The crates of the workspace, in the order in which a command line passes them:
//!
//! | crate or module | contents |
//! |---|---|
//! | [`app`] | from the words of a command line to an exit code; the prompt, command files, completion |
//! | [`cli`] | the command line: global flags and the first word |
//! | [`command`] | commands that are not of one family: status, top, backup, robots, session, help |
//! | [`yerc`], [`yrcx`], [`toyo`] | the commands of a family: arguments, report, run; its link and its face |
//! | [`frame`] | what every command runs on: run loop, stores, backups, and the four modules below |
//! | [`settings`] | robots, and every setting with its origin; target URLs; the inventory |
//! | [`gate`] | decides whether a command may run |
//! | [`output`] | the only writer to stdout and stderr; makes text harmless for terminals |
//! | [`failure`] | how a command can fail; the only place with exit codes |
//! | [`client`] | one driver per family with typed errors; no texts for people, no clap |
//! | [`controller`] | tables, codecs, sessions and simulators of each controller; no sockets, no clock, no clap |
//! | [`transport`] | moves bytes or images without their meaning |
//! | [`files`] | reads local files: regular files, up to a limit |
//!
//! A crate uses only the crates below it. `controller` and `transport` do not use each other, and no family uses
//! another family. A test checks the dependencies.
//!
//! # As a library
//!
//! A program that communicates with a controller itself needs only [`client`]. `examples/` has one example for each
//! family. This is `examples/yerc.rs`:
//!
//! ```rust,ignore
#![doc = include_str!("../examples/yerc.rs")]
//! ```
//!
//! This is `examples/yrcx.rs`:
//!
//! ```rust,ignore
#![doc = include_str!("../examples/yrcx.rs")]
//! ```
//!
//! This is `examples/toyo.rs`:
//!
//! ```rust,ignore
#![doc = include_str!("../examples/toyo.rs")]
//! ```

pub mod app;
pub mod cli;
pub mod command;

pub use armctl_client as client;
pub use armctl_controller as controller;
pub use armctl_files as files;
pub use armctl_frame as frame;
pub use armctl_frame::{failure, gate, output, settings};
pub use armctl_toyo as toyo;
pub use armctl_transport as transport;
pub use armctl_yerc as yerc;
pub use armctl_yrcx as yrcx;

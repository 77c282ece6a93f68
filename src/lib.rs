//! armctl controls industrial robot controllers from a terminal, from a script, or from a Rust program.
//!
//! Modules of the crate, in the order in which a command line passes through them:
//!
//! | module | content |
//! |---|---|
//! | [`app`] | the program: from the words of a command line to an exit code; prompt, command files, completion |
//! | [`cli`] | the command line: global flags and the first word |
//! | [`settings`] | the selected robots; every setting with its origin; target URLs; the inventory |
//! | [`gate`] | authorization of a command before anything is sent to a robot |
//! | [`command`] | the commands: arguments, report, execution; no bytes, no sockets |
//! | [`client`] | clients of controllers: one driver per family, with typed errors; no texts for people, no clap |
//! | [`controller`] | protocol of each controller: tables, codecs, sessions, simulators; no sockets, no clock, no clap |
//! | [`transport`] | transmission of bytes or images, without interpreting them |
//! | [`output`] | the only module that writes to stdout and stderr; text made safe for terminals |
//! | [`failure`] | failures of commands, and the only place with exit codes |
//! | [`files`] | reading of local files: only regular files, up to a size limit |
//!
//! Dependencies have one direction. `command` depends on `client`, `controller`, `transport` and `output`. `client`
//! depends on `controller` and `transport`. `controller` and `transport` do not depend on each other. A test checks
//! these rules.
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
pub mod failure;
pub mod gate;
pub mod guardian;
pub mod output;
pub mod settings;

pub use armctl_client as client;
pub use armctl_controller as controller;
pub use armctl_files as files;
pub use armctl_transport as transport;

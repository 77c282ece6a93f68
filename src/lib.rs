//! armctl talks to industrial robot controllers.
//!
//! A map of the crate, in the order a command line travels:
//!
//! | module | holds |
//! |---|---|
//! | [`app`] | from the words of a command line to an exit code; the prompt, command files, completion |
//! | [`cli`] | the command line: global flags and the first word |
//! | [`settings`] | which robots, and every setting with where it came from; target URLs; the inventory |
//! | [`gate`] | what stands between a typed command and a machine |
//! | [`command`] | what the operator types: arguments, report, run; no bytes, no sockets |
//! | [`client`] | asks controllers and orders them: one driver a family, with typed errors; no words for people, no clap |
//! | [`controller`] | what each controller understands: tables, codecs, sessions, simulators; no sockets, no clock, no clap |
//! | [`transport`] | moves bytes or images, knows no meaning |
//! | [`output`] | the only writer to stdout and stderr; text made harmless for terminals |
//! | [`failure`] | how a command can fail, and the only place with exit numbers |
//! | [`files`] | the one way to read local files: regular ones, up to a limit |
//!
//! Dependencies run one way: command to client, controller, transport and output; client to controller and transport;
//! controller and transport never see each other. A test holds that.
//!
//! # As a library
//!
//! [`client`] is all that a program needs that talks to a controller itself. `examples/` has one for each family.
//! This is `examples/yerc.rs`:
//!
//! ```rust,ignore
#![doc = include_str!("../examples/yerc.rs")]
//! ```
//!
//! and this is `examples/yrcx.rs`:
//!
//! ```rust,ignore
#![doc = include_str!("../examples/yrcx.rs")]
//! ```
//!
//! and this is `examples/toyo.rs`:
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

//! armctl talks to industrial robot controllers.
//!
//! A map of the crate, in the order a command line travels:
//!
//! | module | holds |
//! |---|---|
//! | [`controller`] | what each controller understands: tables, codecs, sessions, simulators; no sockets, no clock, no clap |
//! | [`transport`] | moves bytes and knows no meaning |

pub mod controller;
pub mod transport;

//! `yrcx`: commands for OMRON / Yamaha YRCX controllers over a fieldbus. `buses.rs` lists the fieldbuses.
//!
//! A command that sends one remote command is a row of `single::one_row!`. The row has the row of the command table,
//! the fields, and the text or the report. `orders.rs` has the commands that change something. `info/robot.rs` has the
//! commands that read. A command that sends several remote commands implements `Command` itself, for example
//! `status.rs`. The link has one driver for remote commands and signals; see `link.rs`.
//!
//! To add a command:
//!
//! 1. Add its file. The file has the arguments, the report, and a row of `one_row!`; for numbered data, a table of
//!    `stores`. Arguments go to the codec as typed text: `draft.with(Key::SpeedPercent, text)` reads the text in the unit
//!    of the field and checks its range. Arguments that several commands use are in `arguments.rs`, positions in
//!    `position.rs`.
//! 2. Add a line to the list below, or to the list of its group.
//! 3. Add rows to the tables of `coverage.rs`: the words that a command line sends, the example in the manual that it
//!    becomes, its question, and the mistakes that it rejects.

mod alarm;
mod arguments;
pub mod backup;
mod before;
pub mod buses;
mod check;
mod clock;
pub mod commands;
mod complete;
mod connect;
#[cfg(test)]
mod coverage;
mod data;
pub mod decode;
pub mod devicenet;
pub mod discover;
mod done;
pub mod eip;
mod explain;
pub mod face;
mod failure;
mod field_row;
pub mod fieldbus;
#[cfg(test)]
mod gate;
mod hold;
mod info;
mod io;
pub mod link;
mod link_error;
mod messages;
mod motion;
mod numbers;
mod orders;
mod overview;
mod overwrite;
mod panel;
mod param;
mod point_calc;
mod port;
mod position;
mod prelude;
mod procedures;
pub mod profibus;
pub mod profinet;
mod program;
mod raw;
mod refusal;
mod robot_settings;
mod serve;
mod several;
pub mod simulated;
mod single;
mod status;
mod stores;
mod teach;
#[cfg(test)]
mod testing;
pub mod top;
pub mod trace;
mod typed_arguments;
mod unit;
mod var;

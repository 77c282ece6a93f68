//! `yrcx`: OMRON / Yamaha YRCX over a fieldbus, see `buses.rs`.
//!
//! A command with one remote command is a row of `single::one_row!`: row of the command table, fields, text or
//! report. `orders.rs` has the commands that change something, `info/robot.rs` those that read. A command with
//! several remote commands implements `Command` itself, like `status.rs`. The link has one driver for remote commands
//! and signals; see `link.rs`.
//!
//! To add a command:
//!
//! 1. Its file: arguments (passed to the codec as typed text: `draft.with(Key::SpeedPercent, text)` reads them in the
//!    unit of the field and checks their range), the report, and a row of `one_row!`, or a table of `stores` for
//!    numbered data. Shared arguments are in `arguments.rs`, positions in `position.rs`.
//! 2. A line in the list below, or in the list of its group.
//! 3. Tests: `testing::words` returns the words of a command line, `testing::example` those of an example in the
//!    manual. `coverage.rs` has a line for each row of the table.

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
mod procedures;
pub mod profibus;
#[cfg_attr(not(target_os = "linux"), path = "profinet/elsewhere.rs")]
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

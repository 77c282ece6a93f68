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
mod board_report;
pub mod buses;
mod check;
mod clock;
mod command_result;
pub mod commands;
mod complete;
mod confirmed_write;
mod connect;
mod control_commands;
#[cfg(test)]
mod coverage;
mod data;
pub mod decode;
pub mod devicenet;
pub mod discover;
pub mod eip;
mod explain;
pub mod face;
mod failure;
mod field_row;
pub mod fieldbus;
#[cfg(test)]
mod gate;
mod info;
mod io;
pub mod link;
mod link_error;
mod motion;
mod number_arguments;
mod numbered_tables;
mod old_values;
mod overview;
mod param;
mod point_calc;
mod port;
mod position;
mod prelude;
mod procedure_commands;
pub mod profibus;
pub mod profinet;
mod program;
mod raw;
mod read_requests;
mod refusal;
mod robot_settings;
mod serve;
mod session_link;
pub mod simulated;
mod single_command;
mod status;
mod teach;
mod teach_panel;
#[cfg(test)]
mod testing;
pub mod top;
pub mod trace;
mod typed_arguments;
mod unit_argument;
mod var;
mod wireshark;

//! The safety gate, tested with the built binary: risks, questions, read-only robots, several robots, dry runs.

#![cfg(unix)]

mod floods;
mod frame;
mod recorder;
mod safety_page;
mod toyo;
pub mod workspace;
mod yerc;
mod yrcx;

//! What the gate lets through, through the built binary: risks, questions, read-only robots, fleets, dry runs.

#![cfg(unix)]

#[path = "../support/simulator.rs"]
mod simulator;
#[path = "../support/terminal.rs"]
mod terminal;

mod desk;
mod frame;
mod safety_page;
mod toyo;
mod yerc;
mod yrcx;

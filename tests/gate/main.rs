//! What the gate lets through, through the built binary: risks, questions, read-only robots, fleets, dry runs.

#![cfg(unix)]

#[path = "../support/simulator.rs"]
mod simulator;

mod desk;
mod frame;
mod toyo;

//! What the gate lets through, through the built binary: risks, questions, read-only robots, fleets, dry runs.

#![cfg(unix)]

mod desk;
mod floods;
mod frame;
mod recorder;
mod safety_page;
mod toyo;
mod yerc;
mod yrcx;

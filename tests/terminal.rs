//! Uses the built binary like people and scripts do: transcripts, exit codes, questions, prompts, bad input, documents.
#![cfg(unix)]

mod support {
    #[cfg(target_os = "linux")]
    #[path = "../profinet/namespaces.rs"]
    pub mod namespaces;
    pub mod schemas;
    pub mod simulator;
    pub mod terminal;
}

mod bad_input;
mod bounds;
#[cfg(target_os = "linux")]
mod campaign;
mod cli;
mod eip_bad_input;
mod environment;
mod examples;
mod gate;
#[cfg(feature = "plant")]
mod monitoring;
#[cfg(feature = "plant")]
mod mqtt;
mod paths;
mod pictures;
mod readme;
mod repl;
mod safety;
mod session;
mod setup;
mod teach;
mod top;
mod toyo_programs;
mod toyo_safety;
mod toyo_sim;
mod twin;
mod watching;
mod wireshark;
mod yerc_items;
mod yrcx_link;

//! PROFINET: the same test, with the two ends in two network namespaces.

use std::process::Command;

use super::in_parts;
use super::yrcx::{Controller, hold_all};
use crate::support::namespaces::{SKIPPED, run};

/// Environment variable with the command prefix that runs a program in the second network namespace.
const DEVICE_ADDRESS: &str = "THERE";
/// Environment variable with the number of the part of the lines, and the number of parts.
const PART: &str = "PART";

#[test]
fn profinet_commands_send_only_authorized_frames() {
    let program = std::env::current_exe().expect("this test has a file");
    let program = program.to_str().expect("its path is UTF-8");
    let inside =
        "exec \"$PROGRAM\" --exact gate::recorder::network::runs_between_two_network_cards --ignored --nocapture 2>&1";
    in_parts(3, |(part, parts)| match run(inside, &[("PROGRAM", program), (PART, &format!("{part} {parts}"))]) {
        None => println!("{SKIPPED}"),
        Some(text) => assert!(text.contains("test result: ok. 1 passed"), "{text}"),
    });
}

#[test]
#[ignore = "the test above runs it in its namespaces"]
fn runs_between_two_network_cards() {
    let device = std::env::var(DEVICE_ADDRESS).expect("the other namespace");
    let mut words = device.split(' ');
    let mut armctl = Command::new(words.next().expect("a program"));
    armctl.args(words).arg(env!("CARGO_BIN_EXE_armctl"));
    let controller = Controller::start(armctl, "profinet", &["--interface", "pd0"]).url_of_bus("@IFACE", "@pc0");
    let part = std::env::var(PART).expect("the part of the lines");
    let (part, parts) = part.split_once(' ').expect("two numbers");
    let number = |text: &str| text.parse().expect("a number");
    hold_all(controller, (number(part), number(parts)));
}

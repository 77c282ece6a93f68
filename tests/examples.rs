//! Runs the programs in `examples/` until they end, and checks their output.

use std::path::Path;
use std::process::Command;

/// Output of an example. `cargo test` builds the examples into a folder next to the binary.
#[track_caller]
fn run(example: &str) -> String {
    let built = Path::new(env!("CARGO_BIN_EXE_armctl")).with_file_name("examples").join(example);
    let output = Command::new(&built).output();
    let output = output.unwrap_or_else(|error| panic!("{}: {error}; cargo build --examples", built.display()));
    let said = String::from_utf8(output.stdout).expect("UTF-8");
    assert!(output.status.success(), "{example}: {said}{}", String::from_utf8_lossy(&output.stderr));
    said
}

#[test]
fn toyo_reads_and_moves() {
    let point = "T1 PT=001 X=+0000.00 Y=+0000.00 Z=+0000.00 R=+0000.00";
    let said = format!("servo on: true, host on: false\npoint 1: {point}\naxis 1 is at 0.010 mm\n");
    assert_eq!(run("toyo"), said);
}

#[test]
fn yerc_reads_fetches_and_moves() {
    assert_eq!(run("yerc"), "servo on: true, alarm: false\nTESTJOB.JBI: 487 bytes\nS is at 5000 pulses\n");
}

#[test]
fn yrcx_reads_and_moves() {
    assert_eq!(run("yrcx"), "servo on: true, alarm: false\npoint 1: X 100.000 mm\nmoved to X 100.000 mm\n");
}

#[test]
fn cell_runs_robots_of_all_families() {
    let said = "picker: SO(20) is on\nslider: at 0.010 mm\nwelder: D000 is 1\npicker: at X 100.000 mm\n";
    assert_eq!(run("cell"), said);
}

//! Start state and console.

use std::time::Duration;

use super::super::{EXAMPLE, Start};
use super::{Bench, ran};
use crate::toyo::request::instruction;

#[test]
fn the_example_is_a_valid_start_state() {
    let mut bench = Bench::new(EXAMPLE);
    assert_eq!((bench.page(1), bench.counter(1), bench.port(2)), (0x13, 7, 0x80));
    bench.answers("@RPAR T2 V05", "@RPAR T2 V05=0200.0");
    bench.answers("@RSTX 0003", "@RSTX 0003 OUT STN=0 PN01=.......1");
    assert_eq!(bench.sim.wear().total(), 0);
    bench.pass(2000);
    assert!(bench.ask("@MINP SNO=0 GN=1").contains("PN01=00000101"));
}

#[test]
fn a_wrong_value_of_each_key_has_a_clear_error() {
    for (toml, what) in [
        ("modell = 1", "line 1: unknown field"),
        ("axes = 5", "line 1: axes must be from 1 to 4"),
        ("\nmodel = \"X\"", "line 2: model must be one of"),
        ("version = \"x\"", "line 1: write a version"),
        ("busy = 2.0", "line 1: busy"),
        ("instruction_us = 0", "line 1: instruction_us must be"),
        ("steps.1 = [\n\"NOP\",\n\"JUMP\"]", "line 3: unknown instruction 'JUMP'"),
        ("steps.1 = [\n\"SPD V=11\"]", "line 2: speed: 11 is out of range"),
        ("steps.5 = [\"NOP\"]", "line 1: '5' is not a number from 1 to 4"),
        ("points.1.1000 = [0.0, 0.0, 0.0, 0.0]", "line 1: '1000' is not a number from 1 to 999"),
        ("points.1.1 = [9000.0, 0.0, 0.0, 0.0]", "line 1: x: 9000.00 is out of range"),
        ("speeds = { 1 = 0.0 }", "line 1: speed: 0.0 is out of range"),
        ("counters = { 1 = 10000 }", "line 1: counters"),
        ("inputs = { \"0/24\" = \"00000000\" }", "line 1: no input port 0/24"),
        ("inputs = { \"1\" = \"00000000\" }", "line 1: '1' is not a valid port"),
        ("outputs = { \"0/01\" = \"2\" }", "line 1: a port must have eight"),
        ("write = [\"SPST 0001\"]", "line 1: only WPAR"),
        ("error = \"00\"", "line 1: an error must have a code"),
        ("history = [{ }]", "line 1: an entry must have a code"),
        ("robot_types = []", "line 1: robot_types"),
        ("position = [9000.0, 0.0, 0.0, 0.0]", "line 1: coordinates"),
        ("[[event]]\nat_ms = 1\ndo = \"dance\"", "line 1: unknown command: 'dance'"),
        ("[[event]]\nat_ms = 1\ndo = \"input 0/24/1 on\"", "line 1: no input port 0/24"),
    ] {
        let error = Start::parse(toml).map(|_| ()).unwrap_err();
        assert!(error.starts_with(what), "{toml}: {error}");
    }
}

#[test]
fn programs_and_writes_can_be_added() {
    let steps = |count: usize| vec![instruction("CNT+ CN01=0001").unwrap(); count];
    let start = Start::default().with_program(2, steps(10)).unwrap().with_program(1, steps(2)).unwrap();
    let start = start.with_written(1, ["WPAR M09 J"]).unwrap().with_seed(1).with_busy(0.0);
    let sim = super::Simulator::new(start.clone());
    assert!(sim.step(2, 10).is_some() && sim.step(2, 11).is_none() && sim.step(1, 1990).is_some());
    assert!(start.clone().with_program(3, steps(5001)).unwrap_err().contains("5000 steps"));
    assert!(start.with_written(1, ["WPAR M09 X"]).is_err());
    let full = Start::default().with_program(1, steps(5000)).unwrap();
    assert!(super::Simulator::new(full).step(1, 5000).is_some());
}

#[test]
fn events_happen_at_their_times() {
    let mut bench = Bench::new(
        "[[event]]\nat_ms = 2000\ndo = \"input 0/01/1 off\"\n[[event]]\nat_ms = 1000\ndo = \"input 0/01/1 on\"",
    );
    assert_eq!(bench.sim.wake(), Some(Duration::from_secs(1)));
    bench.pass(1500);
    assert!(bench.ask("@MINP SNO=0 GN=1").contains("PN01=00000001"));
    bench.pass(1000);
    assert!(bench.ask("@MINP SNO=0 GN=1").contains("PN01=00000000"));
    assert_eq!(bench.sim.wake(), None);
    // The trace reports a scheduled line that is no longer possible.
    let mut bench = Bench::new("[[event]]\nat_ms = 1000\ndo = \"servo on\"\n[[event]]\nat_ms = 500\ndo = \"estop\"");
    bench.pass(2000);
    assert_eq!(bench.console("why"), "servo on: an error is active: cancel it first");
}

#[test]
fn the_console_shows_the_state() {
    let mut bench = ran(&["OUT STN=0 PN01=.......1", "END"]);
    assert_eq!(
        bench.console("state"),
        "now            sequential, automatic mode, host on, servo on\n\
         position       X 0.00  Y 0.00  Z 0.00  R 0.00 mm\n\
         task 1         is idle, step 0001 OUT STN=0 PN01=.......1\n\
         output 0/01    00000001\n\
         EEPROM writes  0"
    );
    assert!(bench.console("help").lines().count() > 10);
    bench.ng("@JGST X=+L Y=SP Z=SP R=SP", "not reset");
    assert_eq!(
        bench.console("why"),
        "@JGST X=+L Y=SP Z=SP R=SP: the JOG action of this axis was not reset: send RS first"
    );
    for (line, what) in [
        ("dance", "unknown command: 'dance'"),
        ("input 0/24/1 on", "no input port 0/24"),
        ("input 0/01/9 on", "'9' is not a number from 1 to 8"),
        ("input 0/01/1 up", "'up' is not on or off"),
        ("error XX", "the code of an error must be from 01 to FF"),
        ("obstacle Q 1", "'Q' is not X, Y, Z or R"),
        ("obstacle X nan", "'nan' is not a coordinate in mm, or off"),
        ("start 1", "the host is ON: only the host starts programs"),
    ] {
        assert_eq!(bench.sim.console(bench.now, line).unwrap_err(), what);
    }
    for line in ["battery low", "slave off", "estop", "estop off", "clear", "servo on", "reset", "home", "stop"] {
        bench.console(line);
    }
}

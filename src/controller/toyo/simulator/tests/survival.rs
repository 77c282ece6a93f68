//! Random programs: every program must run or end with an error.

use std::time::Duration;

use super::{Bench, Start};
use crate::toyo::field::{Field, Form, Mask, Value};
use crate::toyo::layout::Record;
use crate::toyo::simulator::Simulator;
use crate::toyo::table::instructions::INSTRUCTIONS;

/// A random value in range. Small numbers are frequent, so that the steps often use the same counters, tags and ports.
fn value(field: &Field, random: &mut fastrand::Rng) -> Value {
    match field.form {
        Form::Number(number) => {
            let most = if random.bool() { number.most } else { number.most.min(number.least.max(0) + 6) };
            Value::Number(random.i32(number.least..=most))
        }
        Form::Word(words) => Value::Word(words[random.usize(..words.len())].text),
        _ => {
            let care = random.u8(..);
            Value::Mask(Mask { care, bits: care & random.u8(..) })
        }
    }
}

fn program(random: &mut fastrand::Rng) -> Vec<Record> {
    let step = |random: &mut fastrand::Rng| {
        let row = &INSTRUCTIONS[random.usize(..INSTRUCTIONS.len())];
        row.layout.record(row.layout.fields.iter().map(|field| value(field, random)).collect()).unwrap()
    };
    (0..random.usize(1..30)).map(|_| step(random)).collect()
}

/// Runs random programs with random console lines and host blocks in between.
#[test]
fn any_program_runs_or_ends_with_an_error() {
    let lines = [
        "input 0/01 10101010",
        "input 0/02/1 on",
        "obstacle X 3",
        "obstacle X off",
        "error 13",
        "clear",
        "servo on",
        "estop",
        "estop off",
        "power cycle",
        "home",
        "reset",
    ];
    let blocks = [
        "@SPST 0000",
        "@SPST 0001",
        "@STOP",
        "@HOME",
        "@CERR",
        "@REST",
        "@SVON",
        "@HSON",
        "@MSTP",
        "@MAUT",
        "@RSTX 0000",
        "@RPLD",
        "@RESD",
        "@MPST",
        "@MRSS TASK=01 X=+0001.00 Y=+0000.00 Z=+0000.00 R=+0000.00 V=00",
        "@JGST X=RS Y=RS Z=RS R=RS",
        "@JGST X=+H Y=SP Z=SP R=SP",
    ];
    let mut random = fastrand::Rng::with_seed(11);
    let mut ended = 0;
    for _ in 0..150 {
        let mut start = Start::parse("host = true\norigin = true").unwrap();
        for task in 1..=4 {
            start = start.with_program(task, program(&mut random)).unwrap();
        }
        let mut bench = Bench { sim: Simulator::new(start), now: Duration::ZERO };
        bench.ok("@SPST 0001");
        for _ in 0..20 {
            bench.pass(random.u64(..500));
            match random.u8(..3) {
                0 => drop(bench.sim.console(bench.now, lines[random.usize(..lines.len())])),
                1 => drop(bench.ask(blocks[random.usize(..blocks.len())])),
                _ => {}
            }
            let position = bench.sim.state().position;
            assert!(position.iter().all(|place| place.abs() < 8001.0), "{position:?}");
        }
        bench.pass(60_000);
        ended += u32::from(!bench.sim.state().executing);
    }
    assert!(ended > 30, "{ended}");
}

/// The result does not depend on the step size of time.
#[test]
fn the_length_of_time_slices_does_not_matter() {
    let mut random = fastrand::Rng::with_seed(5);
    for _ in 0..40 {
        let mut start = Start::parse("host = true\norigin = true").unwrap();
        start = start.with_program(1, program(&mut random)).unwrap().with_program(2, program(&mut random)).unwrap();
        let run = |step: u64| {
            let mut sim = Simulator::new(start.clone());
            sim.receive(Duration::ZERO, b"@SPST 0001\r");
            (0..=6000).step_by(usize::try_from(step).unwrap()).for_each(|ms| sim.advance(Duration::from_millis(ms)));
            let state = sim.state();
            (state.tasks, state.error, state.position.map(|place| (place * 100.0).round()), sim.output(0, 1))
        };
        assert_eq!(run(6000), run(3));
    }
}

//! Completion candidates for arguments.

use std::ops::RangeInclusive;

use crate::prelude::basics::*;
use armctl_controller::names::Kind;
use armctl_controller::yrcx::table::parameter::PARAMETERS;
use armctl_frame::Candidate;
use armctl_frame::value_kind::{Ask, Named, rows, text};

/// Name of an input signal.
pub const INPUT: ValueKind = named(&[Kind::Signal], &[""], || signals(Side::Input, ""));
/// Name of an input signal with the state to set.
pub const INPUT_STATE: ValueKind =
    named(&[Kind::Signal], &["=on", "=off"], || [signals(Side::Input, "=on"), signals(Side::Input, "=off")].concat());
/// Name of an output signal.
pub const OUTPUT: ValueKind = named(&[Kind::Signal], &[""], || signals(Side::Output, ""));
/// An input or output port.
pub const PORT: ValueKind = named(&[Kind::Port, Kind::Signal], &[""], || inputs().chain(outputs(0)).collect());
/// Output port.
pub const OUTPUT_PORT: ValueKind = named(&[Kind::Port, Kind::Signal], &[""], || outputs(2).collect());
/// A parameter.
pub const PARAMETER: ValueKind =
    ValueKind::Listed(|| PARAMETERS.iter().map(|row| Candidate::new(row.name, row.meaning)).collect());
/// A static variable: `SGI0` to `SGR31`, or the name of a variable.
pub const VARIABLE: ValueKind = named(&[Kind::Variable], &[""], || {
    let whole = numbered("SGI", 0..=31, "whole number");
    whole.chain(numbered("SGR", 0..=31, "real number")).collect()
});
/// Task with a program.
pub const TASK: ValueKind = ValueKind::FromRobot(Family::Yrcx, |robot| {
    async {
        for (task, state) in tasks(robot).await {
            robot.add_candidate(Candidate::new(task, state));
        }
    }
    .boxed_local()
});
/// Number of a program that is in a task.
pub const PROGRAM: ValueKind = ValueKind::FromRobot(Family::Yrcx, |robot| {
    programs(robot, |number, name, about| Candidate::new(number, format!("{name}: {about}"))).boxed_local()
});
/// Name of a program that is in a task.
pub const PROGRAM_NAME: ValueKind = ValueKind::FromRobot(Family::Yrcx, |robot| {
    programs(robot, |number, name, about| Candidate::new(name, format!("program {number}: {about}"))).boxed_local()
});

const fn named(kinds: &'static [Kind], endings: &'static [&'static str], listed: fn() -> Vec<Candidate>) -> ValueKind {
    ValueKind::Named(Family::Yrcx, Named { kinds, endings, listed })
}

fn signals(side: Side, ending: &str) -> Vec<Candidate> {
    let dedicated = Signal::of_side(side);
    dedicated
        .map(|row| Candidate::new(format!("{}{ending}", row.name), format!("{}: {}", row.text, row.effect)))
        .collect()
}

fn inputs() -> impl Iterator<Item = Candidate> {
    ports("DI", 0..=27, "parallel inputs").chain(ports("SI", 0..=27, "serial inputs"))
}

fn outputs(first: u16) -> impl Iterator<Item = Candidate> {
    ports("DO", first..=27, "parallel outputs")
        .chain(ports("MO", first..=27, "internal outputs"))
        .chain(ports("SO", first..=27, "serial outputs"))
        .chain(ports("LO", 0..=1, "arm lock outputs"))
        .chain(ports("TO", 0..=0, "timer outputs"))
}

/// Ports of eight signals, numbered in octal.
fn ports(letters: &'static str, numbers: RangeInclusive<u16>, about: &'static str) -> impl Iterator<Item = Candidate> {
    numbered(letters, numbers.filter(|number| number % 10 < 8), about)
}

fn numbered(
    letters: &'static str,
    numbers: impl Iterator<Item = u16>,
    about: &'static str,
) -> impl Iterator<Item = Candidate> {
    numbers.map(move |number| Candidate::new(format!("{letters}{number}"), about))
}

/// Adds a candidate for each program. `candidate` makes it from the number, the name, and the task with its state.
async fn programs(robot: &dyn Ask, candidate: fn(&str, &str, &str) -> Candidate) {
    for (task, state) in tasks(robot).await {
        if let Some(shown) = robot.data(&["yrcx", "program", "show", "--task", &task]).await {
            let (number, name) = (text(&shown, "number"), text(&shown, "program"));
            robot.add_candidate(candidate(&number, &name, &format!("task {task}, {state}")));
        }
    }
}

/// Returns number and state of each task that has a program.
async fn tasks(robot: &dyn Ask) -> Vec<(String, String)> {
    let data = robot.data(&["yrcx", "info", "tasks", "1..8"]).await;
    let tasks = rows(data.as_ref(), "items").map(|task| (text(task, "name"), text(task, "value")));
    tasks.filter(|(_, state)| !state.is_empty()).collect()
}

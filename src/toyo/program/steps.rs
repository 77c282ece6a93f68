//! Steps of a task: how many there are, how they are read, and how a write is prepared.

use std::ops::RangeInclusive;

use crate::eeprom::Cell;
use crate::item_reads::{Answers, read_until};
use crate::link::{Refusal, misuse};
use crate::prelude::*;
use armctl_controller::toyo::request::Answer;
use armctl_controller::toyo::status::RunMode;
use armctl_controller::toyo::table::{Command, Op};

const READING: &str = "reading steps";

/// Reads the number of steps of each task (TO 2-4, parameter E22).
pub async fn rooms(link: &mut Link) -> Result<[u16; 4]> {
    let record = link.ask(&rooms_request()).await?;
    let room = |task| record.number(task).and_then(|steps| u16::try_from(steps).ok()).unwrap_or_default();
    Ok(["task1", "task2", "task3", "task4"].map(room))
}

/// Returns the request that reads the number of steps of the tasks.
pub fn rooms_request() -> Request {
    let parameter = Parameter::named("E22").expect("the table has E22");
    Request::read_parameter(parameter, None).expect("E22 has no rows")
}

/// Number of steps of a task. Fails if a command needs a step beyond it, up to `last`.
pub async fn room(link: &mut Link, task: u8, last: u16) -> Result<u16> {
    let room = rooms(link).await?.get(usize::from(task) - 1).copied().unwrap_or_default();
    if last <= room {
        return Ok(room);
    }
    let has = if room == 0 { "no steps".to_owned() } else { format!("{room} steps") };
    Err(Failure::usage(format!("task {task} has {has}, but the command needs step {last}"))
        .hint("check the machine parameter E22 (task-steps), which sets the number of steps of each task"))
}

/// Returns the request that reads a step.
pub fn read_request(step: u16) -> Request {
    Request::read_step(step.into()).expect("steps are at most 5000")
}

/// Reads a step with its number. Step 0 is the current step. A refusal is a valid result.
pub async fn numbered(link: &mut Link, step: u16) -> Result<Result<Record, Refusal>> {
    let request = read_request(step);
    Ok(match link.raw(&request).await? {
        Answer::Data(record) => Ok(record),
        Answer::Done | Answer::Refused => Err(Refusal(request)),
    })
}

/// Reads steps up to the first step for which `is_last` is true. Each step has its own result.
pub async fn read_each(
    link: &mut Link,
    screen: &Screen,
    steps: RangeInclusive<u16>,
    is_last: impl Fn(&Record) -> bool,
) -> Result<Answers> {
    let requests: Vec<Request> = steps.map(read_request).collect();
    read_until(link, screen, READING, &requests, is_last).await
}

/// Reads all steps of a range before they are overwritten. A missing answer is a failure.
pub async fn read_all(link: &mut Link, screen: &Screen, steps: RangeInclusive<u16>) -> Result<Vec<Record>> {
    let mut read = Vec::with_capacity(steps.len());
    let mut progress = screen.items_progress(READING, steps.len() as u64);
    for step in steps {
        read.push(link.ask(&read_request(step)).await?);
        progress.advance(1);
    }
    Ok(read)
}

/// EEPROM cell of a step.
pub fn cell(step: u16, instruction: &Record) -> Result<Cell> {
    let write = Request::write_step(step.into(), instruction).map_err(|error| misuse(&error.into()))?;
    Ok(Cell { read: read_request(step), write, wanted: instruction.clone() })
}

/// Change to confirm: the steps that will be replaced, with old and new text.
pub fn overwriting(task: u8, replaced: &[[String; 3]]) -> Change {
    let change = match replaced.len() {
        0 => return Change::none(),
        1 => Change::new(format!("overwrite a step of task {task}")),
        many => Change::new(format!("overwrite {many} steps of task {task}")),
    };
    replaced.iter().fold(change, |change, [what, old, new]| change.replaces(what, old, new))
}

/// NOP, the instruction without effect.
pub fn nop() -> Record {
    Op::Nop.row().layout.record(Vec::new()).expect("NOP has no values")
}

/// Prepares for writes of steps: checks that nothing runs, and selects program mode temporarily.
pub async fn open(link: &mut Link) -> Result<()> {
    let status = link.status_of(&[0, 2]).await?;
    let busy = |what: &str, hint: &str| {
        Err(Failure::new(Kind::Rejected, format!("{what}, so armctl cannot write steps")).hint(hint))
    };
    if status.executing() || status.homing() {
        return busy(
            "the controller executes a program or a command",
            "wait until the program or command has ended, or use `toyo stop`",
        );
    }
    if status.paused() {
        return busy(
            "a program is paused",
            "continue the program with `toyo run sequential`, or reset it with `toyo reset`",
        );
    }
    let back = match status.run_mode() {
        Some(RunMode::Automatic) => Command::Maut,
        Some(RunMode::Step) => Command::Mstp,
        Some(RunMode::Program) | None => return Ok(()),
    };
    link.borrow(&Request::bare(Command::Mpro), Request::bare(back)).await
}

/// In a dry run, records the requests of [`open`].
pub async fn plan_open(link: &mut Link) -> Result<()> {
    let page = |page| Request::of(Command::Stas, [Value::Number(page)]);
    link.plan(&page(0), "whether a program runs");
    link.plan(&page(2), "the current mode");
    link.plan_to_borrow(&Request::bare(Command::Mpro), "@M?", "whether the mode differs").await
}

//! Commands that change the memory: parameters, steps, palletizing and easy programs.

use super::memory::{Easy, NoRoom, TASKS};
use super::reply::{Fields, Reply};
use super::world::World;
use crate::toyo::layout::Record;
use crate::toyo::request::Request;
use crate::toyo::table::{Command, Group, Instruction, Pallet};

pub(super) fn execute(world: &mut World, request: &Request) -> Result<Reply, String> {
    let fields = Fields(request.record());
    let task = world.current;
    let no_room = |NoRoom| "no such memory address".to_owned();
    match request.command() {
        Command::Wpar => write_parameter(world, request)?,
        Command::Wstx => write_step(world, fields.index("step"), content(request)?)?,
        Command::Wplt => {
            let record = Pallet::numbered(fields.number("record")).ok_or("no such record")?;
            world.memory.set_pallet(fields.index("program"), record, content(request)?.values()).map_err(no_room)?;
        }
        Command::Wesy => {
            let easy = Easy { start: fields.number("start"), times: fields.number("loop"), end: fields.number("end") };
            world.memory.set_easy(fields.index("program"), easy).map_err(no_room)?;
        }
        Command::Wovr => world.memory.set_percent(fields.number("override")),
        Command::Mint => clear(world, fields.word("what")).map_err(no_room)?,
        Command::Istx => world.memory.insert_step(task, fields.index("step")).map_err(no_room)?,
        Command::Dstx => {
            let step = fields.index("step");
            world.memory.delete_steps(task, step, step).map_err(no_room)?;
        }
        Command::Dstl => {
            world.memory.delete_steps(task, fields.index("first"), fields.index("last")).map_err(no_room)?;
        }
        Command::Cpss => {
            let from = (fields.index("from_task") - 1, fields.index("first"), fields.index("last"));
            let to = (fields.index("to_task") - 1, fields.index("top"));
            world.memory.copy_steps(from, to).map_err(no_room)?;
        }
        Command::Cppl => world.memory.copy_pallet(fields.index("from"), fields.index("to")).map_err(no_room)?,
        Command::Cesy => {
            let easy = world.memory.content.easy(fields.index("from"));
            world.memory.set_easy(fields.index("to"), easy).map_err(no_room)?;
        }
        Command::Sstg => world.search_tag(fields.index("tag"))?,
        other => return Err(format!("{other:?} does not change stored data")),
    }
    world.apply_memory_changes();
    Ok(Reply::Done)
}

/// The parameter, instruction or record of a request.
fn content(request: &Request) -> Result<Record, String> {
    let content = request.content().map_err(|error| error.to_string())?;
    content.ok_or_else(|| "the request has no data to store".to_owned())
}

fn write_parameter(world: &mut World, request: &Request) -> Result<(), String> {
    let parameter = request.parameter().ok_or("no such parameter")?;
    if !world.supports(parameter.only_on) {
        return Err(format!("a {} does not have {}", world.model, parameter.id));
    }
    let record = content(request)?;
    let written = world.memory.set_parameter(parameter, record, world.current);
    written.map_err(|NoRoom| "all tasks together can have at most 5000 steps".to_owned())?;
    world.switches.machine_changed |= parameter.group() == Group::Machine;
    Ok(())
}

pub(super) fn write_step(world: &mut World, step: usize, record: Record) -> Result<(), String> {
    let name = record.layout().text.split(' ').next().unwrap_or_default();
    if !Instruction::named(name).is_some_and(|row| world.supports(row.only_on)) {
        return Err(format!("a {} does not have {name}", world.model));
    }
    let task = world.current;
    let size = world.memory.size(task);
    world.memory.set_step(task, step, record).map_err(|NoRoom| format!("task {} has {size} steps (E22)", task + 1))
}

/// Executes MINT (memory clear). Only data of the current task is cleared, unless `what` selects everything.
fn clear(world: &mut World, what: &str) -> Result<(), NoRoom> {
    let task = world.current;
    let memory = &mut world.memory;
    match what {
        "0" => {
            for task in 0..TASKS {
                memory.clear_steps(task)?;
                memory.clear_points(task);
            }
            memory.clear_pallets()?;
            memory.clear_easy()?;
            world.switches.machine_changed |= memory.clear_parameters()?;
        }
        "1" => memory.clear_steps(task)?,
        "2" => memory.clear_pallets()?,
        "3" => {
            memory.clear_steps(task)?;
            memory.clear_pallets()?;
        }
        "4" => {
            memory.clear_easy()?;
            memory.clear_points(task);
        }
        _ => memory.clear_points(task),
    }
    world.reset_program();
    Ok(())
}

//! Host commands: permissions and replies.

use super::operate::Refusal;
use super::reply::{Fields, Reply};
use super::world::{Mode, World};
use crate::refuse_if;
use crate::toyo::field::{Mask, Value};
use crate::toyo::request::{BlockError, Request};
use crate::toyo::table::Command;

/// Executes a block and returns the answer, without line end.
pub(super) fn answer(world: &mut World, block: &str) -> String {
    let reply = parse(block).and_then(|request| {
        let reply = execute(world, &request)?;
        Ok(match reply {
            Reply::Done => "@OK".to_owned(),
            Reply::Data(form, values) => {
                let record = request.row().answers[form].record(values).map_err(|error| error.to_string())?;
                format!("@{}", record.written())
            }
        })
    });
    world.settle();
    reply.unwrap_or_else(|why| {
        world.refusal = Some((block.to_owned(), why));
        "@NG".to_owned()
    })
}

/// Parses a block. This parser is stricter than the codec: every character must be exact.
fn parse(block: &str) -> Result<Request, String> {
    let text = |error: BlockError| error.to_string();
    let request = Request::parse(block).map_err(text)?;
    request.check().map_err(text)?;
    let received = block.trim_end_matches(' ').replacen("@HTSK", "@CTSK", 1);
    let content = request.content().map_err(text)?.map(|content| content.written());
    if request.text() != received || content.is_some_and(|content| !received.ends_with(&content)) {
        return Err(format!("wrong format: the correct format is {}", request.text()));
    }
    Ok(request)
}

fn execute(world: &mut World, request: &Request) -> Result<Reply, String> {
    let row = request.row();
    refuse_if(row.needs_host && !world.switches.host, "the host is off".to_owned())?;
    if !world.supports(row.only_on) {
        return Err(format!("a {} does not have this command", world.model));
    }
    let refused = |refusal: Refusal| refusal.to_owned();
    if row.writes_eeprom {
        world.idle().map_err(refused)?;
    }
    let fields = Fields(request.record());
    let done = |()| Reply::Done;
    match row.command {
        Command::Hson => world.host(true).map(done).map_err(refused),
        Command::Hsof => world.host(false).map(done).map_err(refused),
        Command::Mpro => world.select_run_mode(Mode::Program).map(done).map_err(refused),
        Command::Mstp => world.select_run_mode(Mode::Step).map(done).map_err(refused),
        Command::Maut => world.select_run_mode(Mode::Automatic).map(done).map_err(refused),
        Command::Mseq => world.select_program_kind(false).map(done).map_err(refused),
        Command::Mple => world.select_program_kind(true).map(done).map_err(refused),
        Command::Home => world.home().map(done).map_err(refused),
        Command::Spst => world.start_sequential(fields.index("step")).map(done).map_err(refused),
        Command::Ppst => world.start_palletizing().map(done).map_err(refused),
        Command::Sesy => world.start_easy().map(done).map_err(refused),
        Command::Extp => world.start_point(fields.number("point")).map(done).map_err(refused),
        Command::Stop => {
            world.stop();
            Ok(Reply::Done)
        }
        Command::Jgst => world.jog(["x", "y", "z", "r"].map(|axis| fields.word(axis))).map(done).map_err(refused),
        Command::Dout => direct(world, request).map(done).map_err(refused),
        Command::Rest => world.reset().map(done).map_err(refused),
        Command::Cerr => world.cancel_error().map(done).map_err(refused),
        Command::Svon => world.servo(true).map(done).map_err(refused),
        Command::Svof => world.servo(false).map(done).map_err(refused),
        Command::Sorg => world.search_origin(fields.index("axis") - 1).map(done).map_err(refused),
        Command::Spln => {
            world.idle().map_err(refused)?;
            world.pallet = fields.index("program");
            Ok(Reply::Done)
        }
        Command::Sesn => {
            world.idle().map_err(refused)?;
            world.easy = fields.index("program");
            Ok(Reply::Done)
        }
        Command::Ctsk => {
            world.current = fields.index("task") - 1;
            Ok(Reply::Done)
        }
        Command::Wmca => {
            world.idle().map_err(refused)?;
            let begun = world.card.write(world.now);
            if begun { Ok(Reply::Done) } else { Err("no memory card is inserted".to_owned()) }
        }
        Command::Rmca => {
            world.idle().map_err(refused)?;
            let begun = world.card.read(world.now);
            if begun { Ok(Reply::Done) } else { Err("no memory card with data is inserted".to_owned()) }
        }
        Command::Mrss => {
            let place = ["x", "y", "z", "r"].map(|axis| f64::from(fields.number(axis)) / 100.0);
            world.store_coordinates(fields.index("task") - 1, place, fields.number("speed")).map(done).map_err(refused)
        }
        Command::Mcst => {
            world.counters[fields.index("counter")] = u16::try_from(fields.number("count")).unwrap_or_default();
            Ok(Reply::Done)
        }
        Command::Type => {
            world.idle().map_err(refused)?;
            Ok(robot_type(world, fields.index("axis") - 1, fields.number("robot_type")))
        }
        command if row.writes_eeprom || command == Command::Sstg => super::edit::execute(world, request),
        _ => super::monitor::answer(world, request),
    }
}

/// Sets the robot type if the new type is known. The answer contains the type that is set afterwards.
fn robot_type(world: &mut World, axis: usize, robot_type: i32) -> Reply {
    if world.robot_types.contains(&robot_type) {
        world.memory.set_robot_type(axis, robot_type);
        world.switches.machine_changed = true;
        world.apply_memory_changes();
    }
    let number = i32::try_from(axis + 1).unwrap_or_default();
    Reply::Data(0, vec![Value::Number(number), Value::Number(world.memory.content.robot_types[axis])])
}

/// Sets the bits of a port, or the bit that parameter M12 assigns.
fn direct(world: &mut World, request: &Request) -> Result<(), Refusal> {
    refuse_if(
        world.switches.machine_changed,
        "a machine parameter (parameter 2) was changed: switch the power off and on first",
    )?;
    let fields = Fields(request.record());
    let (port, mask) = if let Some(mask) = request.record().mask("data") {
        (fields.port(), mask)
    } else {
        let bit = world.settings.direct[fields.index("direct") - 1].ok_or("it has no assigned bit (M12)")?;
        (bit.port, Mask { care: bit.mask(), bits: bit.mask() })
    };
    if world.ports.set_output(port, mask) { Ok(()) } else { Err("no such port") }
}

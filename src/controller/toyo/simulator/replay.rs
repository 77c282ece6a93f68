//! Replay of a recording: the state of the machine follows the recorded answers.

use super::memory::index;
use super::world::{Mode, World};
use crate::simulator::recording::Answers;
use crate::toyo::layout::Record;
use crate::toyo::request::{Answer, Request};
use crate::toyo::status::{RunMode, Status};
use crate::toyo::table::Command;

/// Applies the answers of a sample. The replay gives these answers to the same requests. The checks of changes use the
/// state of the machine.
pub(super) fn follow(world: &mut World, changed: &Answers) {
    for (request, answer) in changed {
        let Ok(request) = Request::parse(request) else { continue };
        let Ok(Answer::Data(record)) = request.answer_kept(answer) else { continue };
        match request.command() {
            Command::Stas => follow_status(world, &record),
            Command::Mpst => {
                let axes = ["x", "y", "z", "r"].map(|axis| record.number(axis).map(f64::from));
                world.arm.set_position(axes.map(|hundredths| hundredths.unwrap_or_default() / 100.0));
            }
            Command::Mcnt => {
                let count = record.number("count").and_then(|count| u16::try_from(count).ok());
                let counter = record.number("counter").and_then(|number| world.counters.get_mut(index(number)));
                if let (Some(count), Some(counter)) = (count, counter) {
                    *counter = count;
                }
            }
            _ => {}
        }
    }
    world.settle();
}

fn follow_status(world: &mut World, record: &Record) {
    let page = record.number("page").and_then(|page| u8::try_from(page).ok());
    let (Some(page), Some(byte)) = (page, record.byte("st1")) else { return };
    let status = Status::default().with(page, byte);
    let switches = &mut world.switches;
    match page {
        0 => {
            world.arm.known.fill(status.homed());
            switches.machine_changed = status.needs_power_cycle();
        }
        1 if world.errors.current != Some(byte).filter(|code| *code != 0) => {
            world.errors.cancel();
            if byte != 0 {
                world.errors.raise(byte, world.powered());
            }
        }
        2 => {
            (switches.host, switches.pendant) = (status.host_on(), status.pendant_on());
            switches.mode = match status.run_mode() {
                Some(RunMode::Step) => Mode::Step,
                Some(RunMode::Program) => Mode::Program,
                Some(RunMode::Automatic) | None => Mode::Automatic,
            };
        }
        3 => {
            switches.servo.fill(status.servo_on());
            switches.slaves_ready = !status.slave_not_ready();
        }
        _ => {}
    }
}

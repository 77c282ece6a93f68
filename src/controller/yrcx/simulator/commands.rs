//! Dispatch of remote commands by their table row.

use super::alarms::{AlarmSource, Fault, NOT_ENABLED, UNKNOWN_COMMAND};
use super::request::Request;
use super::world::{Action, World};
use super::{data_commands, motion_commands, operation_commands, read_commands};
use crate::Now;
use crate::yrcx::table::DurationClass;
use crate::yrcx::value::{Key, Values};

/// Progress of a command.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum CommandProgress {
    /// The command has ended, with these values in its answer.
    Done(Values),
    /// The command waits until the motion of these robots ends.
    Motion(Vec<usize>),
    /// The command waits until this time. Then this action switches the power.
    Power(Now, Action),
    /// The command runs until the master removes it.
    Continuous,
}

/// Commands that the controller accepts while the programming box has control (chapter 2, 3).
const UNDER_THE_BOX: [u16; 27] = [
    0x101, 0x105, 0x109, 0x10D, 0x111, 0x214, 0x224, 0x304, 0x501, 0x502, 0x503, 0x505, 0x506, 0x507, 0x508, 0x509,
    0x50A, 0x50B, 0x50C, 0x50F, 0x510, 0x511, 0x512, 0x513, 0x514, 0x515, 0x516,
];

/// Starts or refuses a command.
pub(super) fn begin(world: &mut World, request: &Request) -> Result<CommandProgress, Fault> {
    enabled(world, request)?;
    match (request.row.pace, request.row.category()) {
        (DurationClass::Motion | DurationClass::Jog, _) => motion_commands::begin(world, request),
        (DurationClass::Power, _) => operation_commands::power(world, request),
        (DurationClass::Quick, 1) => operation_commands::change(world, request).map(done),
        (DurationClass::Quick, 5) => operation_commands::program(world, request).map(CommandProgress::Done),
        (DurationClass::Quick, 2..=4) => data_commands::carry_out(world, request).map(CommandProgress::Done),
        (DurationClass::Quick, 7) => operation_commands::utility(world, request).map(done),
        (DurationClass::Quick, _) if request.int(Key::Continuous) == 1 => {
            read_commands::answer(world, request).map(|_| CommandProgress::Continuous)
        }
        (DurationClass::Quick, _) => read_commands::answer(world, request).map(CommandProgress::Done),
    }
}

/// Fault for a command that has a table row, but no implementation in the simulator.
pub(super) fn not_here(request: &Request) -> Fault {
    Fault::new(UNKNOWN_COMMAND, AlarmSource::Slot, format!("the simulator does not support {}", request.row.id))
}

fn done((): ()) -> CommandProgress {
    CommandProgress::Done(Values::default())
}

/// Checks that the controller accepts commands at all (chapter 2, 3).
fn enabled(world: &World, request: &Request) -> Result<(), Fault> {
    if !world.switches.inputs {
        let why = "a safety setting disables the dedicated inputs";
        return Err(Fault::new(NOT_ENABLED, AlarmSource::Slot, why));
    }
    if world.switches.boxed && !UNDER_THE_BOX.contains(&request.row.code) {
        return Err(Fault::new(NOT_ENABLED, AlarmSource::Slot, "the programming box has control"));
    }
    Ok(())
}

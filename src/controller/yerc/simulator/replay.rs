//! Replay of a recording: the state of the machine follows the recorded answers.

use super::robot::{Store, command};
use super::world::{Mode, World};
use crate::simulator::recording::{Answers, Replay};
use crate::yerc::payload::{Alarm, ControllerStatus, CycleMode, StatusBit};
use crate::yerc::query::{Query as _, ReadStatus};
use crate::yerc::recording::{parse_answer, parse_request, request_text};
use crate::yerc::request::Request;
use crate::yerc::table::Row;

/// Applies the answers of a sample. The replay gives these answers to the same requests. Other requests, and the checks
/// of changes, use the state of the machine.
pub(super) fn follow(world: &mut World, replay: &mut Replay, changed: &Answers) {
    for (request, answer) in changed {
        if let Some(request) = parse_request(request)
            && let Some(data) = accepted(answer)
        {
            write_elements(world, &request, &data);
        }
    }
    let status = replay.answer(&request_text(&ReadStatus.request())).and_then(accepted);
    let Some(status) = status.and_then(|data| ControllerStatus::parse(&data).ok()) else { return };
    follow_status(world, status);
    if status.alarm() {
        let alarm = first_alarm(replay);
        if world.alarms.active().next() != Some(&alarm) {
            world.alarms.clear();
            world.alarms.raise(alarm);
        }
    } else {
        world.alarms.clear();
        // The poller reads alarms only while there is one. Without an alarm, the earlier answers are old.
        let is_alarm = |number| [command::ALARM, command::ALARM_TEXTS].contains(&number);
        replay.forget(|request| parse_request(request).is_some_and(|request| is_alarm(request.command)));
    }
}

/// Data of an answer, unless the controller refused.
fn accepted(answer: &str) -> Option<Vec<u8>> {
    parse_answer(answer).filter(|(status, _)| status.is_ok()).map(|(_, data)| data)
}

fn follow_status(world: &mut World, status: ControllerStatus) {
    let has = |bit| status.has(bit);
    let mode = if has(StatusBit::Teach) { Mode::Teach } else { Mode::Play };
    world.set_mode(mode, has(StatusBit::CommandRemote));
    let switches = &mut world.switches;
    switches.servo = has(StatusBit::ServoOn);
    switches.guard = has(StatusBit::Guarded);
    switches.error = has(StatusBit::Error);
    switches.hold.pendant = has(StatusBit::HoldPendant);
    switches.hold.external = has(StatusBit::HoldExternal);
    switches.hold.command = has(StatusBit::HoldCommand);
    switches.cycle = status.cycle().unwrap_or(CycleMode::Once);
}

/// Latest recorded alarm. Its code is 0 if the recording does not contain it.
fn first_alarm(replay: &Replay) -> Alarm {
    let recorded = |number: u16| {
        let request = Request { command: number, ..ReadStatus.request() };
        replay.answer(&request_text(&request)).and_then(accepted)
    };
    let with_texts = recorded(command::ALARM_TEXTS).and_then(|data| Alarm::parse_with_texts(&data).ok());
    let plain = || recorded(command::ALARM).and_then(|data| Alarm::parse(&data).ok());
    with_texts.or_else(plain).unwrap_or_else(|| super::alarms::alarm(0, 0, 0, "", None))
}

/// Writes variables, I/O and registers into the memory, so that a read in another form gives the recorded values.
fn write_elements(world: &mut World, request: &Request, data: &[u8]) {
    let Some((row, store)) = Row::from_number(request.command).zip(Store::from_number(request.command)) else { return };
    let span = row.instances.find(world.model, request.instance);
    let (Some(span), size) = (span, row.size()) else { return };
    // The answer to a plural request begins with the number of elements.
    let elements = if row.plural.is_some() { data.get(4..).unwrap_or_default() } else { data };
    for (instance, element) in (request.instance..=span.last).zip(elements.chunks_exact(size)) {
        world.write_element(store, instance, element);
    }
}

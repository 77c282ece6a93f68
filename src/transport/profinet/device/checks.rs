//! Checks of a Connect, field by field, with the error status of each field.

use super::super::layout::{Direction, Layout};
use super::super::wire::connect::{ANY_FRAME_ID, AlarmCr, Ar, ExpectedModule, Iocr, Offset, Request};
use super::super::wire::frame::{ETHER_TYPE, TAG_HIGH, TAG_LOW, id};
use super::super::wire::status::Status;
use super::super::wire::{Uuid, dcp};

/// An accepted Connect.
#[derive(Debug)]
pub(super) struct AcceptedConnect {
    pub(super) ar: Ar,
    pub(super) input: Iocr,
    pub(super) output: Iocr,
    pub(super) alarm: AlarmCr,
}

const AR: u8 = 1;
const IOCR: u8 = 2;
const EXPECTED: u8 = 3;
const ALARM: u8 = 4;
const CMRPC: u8 = 0x40;
const UNKNOWN_BLOCKS: u8 = 1;
const IOCR_MISSING: u8 = 2;
const ALARMS_MISSING: u8 = 3;
/// Maximum of the watchdog time and of the data hold time, in units of 31.25 us.
const MAX_WATCHDOG: u64 = 61_440;

fn reject(block: u8, field: u8) -> Result<(), Status> {
    Err(Status::new(0xDB, 0x81, block, field))
}

fn check(is_good: bool, block: u8, field: u8) -> Result<(), Status> {
    if is_good { Ok(()) } else { reject(block, field) }
}

pub(super) fn connect(requests: Vec<Request>, layout: &Layout, shortest: u16) -> Result<AcceptedConnect, Status> {
    let mut ar = None;
    let mut iocrs = Vec::new();
    let mut alarms = Vec::new();
    let mut modules = Vec::new();
    for (at, request) in requests.into_iter().enumerate() {
        match request {
            Request::Ar(block) if at == 0 => ar = Some(block),
            // The order of the blocks must be AR, IOCRs, alarm CR, expected modules.
            Request::Iocr(block) if modules.is_empty() && alarms.is_empty() && ar.is_some() => iocrs.push(block),
            Request::AlarmCr(block) if iocrs.len() == 2 => alarms.push(block),
            Request::Expected(block) if iocrs.len() == 2 => modules.extend(block),
            _ => return Err(Status::new(0xDB, 0x81, CMRPC, UNKNOWN_BLOCKS)),
        }
    }
    let missing = |field| Status::new(0xDB, 0x81, CMRPC, field);
    let ar = ar.ok_or(missing(UNKNOWN_BLOCKS))?;
    let [input, output] = <[Iocr; 2]>::try_from(iocrs).map_err(|_| missing(IOCR_MISSING))?;
    let [alarm] = <[AlarmCr; 1]>::try_from(alarms).map_err(|_| missing(ALARMS_MISSING))?;
    connection(&ar)?;
    let is_legacy = ar.properties & 0x4000_0000 == 0;
    data(&input, 1, is_legacy, shortest, layout)?;
    data(&output, 2, is_legacy, shortest, layout)?;
    check(input.reference != output.reference, IOCR, 5)?;
    check(input.frame_id != output.frame_id, IOCR, 9)?;
    alarm_cr(&alarm)?;
    expected(&modules, layout)?;
    Ok(AcceptedConnect { ar, input, output, alarm })
}

fn connection(ar: &Ar) -> Result<(), Status> {
    check(ar.kind == 1, AR, 4)?;
    check(ar.uuid != Uuid::NIL, AR, 5)?;
    check(!ar.mac.is_group() && ar.mac.0 != [0; 6], AR, 7)?;
    check(ar.object.0.starts_with(&[0xDE, 0xA0, 0, 0, 0x6C, 0x97, 0x11, 0xD1, 0x82, 0x71]), AR, 8)?;
    // The properties must say that the connection is active and that the controller is the parameter server. Only the
    // startup mode may vary.
    check(ar.properties & 0x3FFF_FFFF == 0x11, AR, 9)?;
    check((1..=1000).contains(&ar.activity_timeout), AR, 0x0A)?;
    check(ar.port == ETHER_TYPE, AR, 0x0B)?;
    check(!ar.name.is_empty(), AR, 0x0C)?;
    check(dcp::check_name(&ar.name).is_ok(), AR, 0x0D)
}

fn data(iocr: &Iocr, kind: u16, is_legacy: bool, shortest: u16, layout: &Layout) -> Result<(), Status> {
    check(iocr.kind == kind, IOCR, 4)?;
    check(iocr.ether_type == ETHER_TYPE, IOCR, 6)?;
    // The legacy RT class is valid only with legacy startup. The other RT class is valid with both startup modes.
    let range = match iocr.properties {
        1 if is_legacy => id::RT_CLASS_1_LEGACY,
        2 => id::RT_CLASS_1,
        _ => return reject(IOCR, 7),
    };
    check((40..=1440).contains(&iocr.length), IOCR, 8)?;
    let is_any = kind == 2 && iocr.frame_id == ANY_FRAME_ID;
    check(is_any || range.contains(&iocr.frame_id), IOCR, 9)?;
    check(iocr.send_clock == 32, IOCR, 0x0A)?;
    let cycle = u32::from(iocr.send_clock) * u32::from(iocr.ratio);
    let is_fast_enough = cycle >= u32::from(shortest);
    check(iocr.ratio.is_power_of_two() && iocr.ratio <= 512 && is_fast_enough, IOCR, 0x0B)?;
    check((1..=iocr.ratio).contains(&iocr.phase), IOCR, 0x0C)?;
    check(iocr.offset == u32::MAX, IOCR, 0x0E)?;
    let bounded = |factor: u16| factor >= 3 && u64::from(factor) * u64::from(cycle) <= MAX_WATCHDOG;
    check(bounded(iocr.watchdog), IOCR, 0x0F)?;
    check(bounded(iocr.data_hold_factor), IOCR, 0x10)?;
    check(iocr.tag == TAG_HIGH, IOCR, 0x11)?;
    check(iocr.group.0 == [0; 6], IOCR, 0x12)?;
    places(iocr, layout)
}

/// Checks that every submodule occurs exactly once, in the correct direction, and that the positions do not overlap.
fn places(iocr: &Iocr, layout: &Layout) -> Result<(), Status> {
    let direction = if iocr.kind == 1 { Direction::Input } else { Direction::Output };
    let mut used = vec![false; usize::from(iocr.length)];
    let mut take = |place: &Offset, length: u16, field: u8| {
        let from = usize::from(place.offset);
        let bytes = used.get_mut(from..from + usize::from(length));
        let free = bytes.filter(|bytes| bytes.iter().all(|used| !used));
        match free {
            Some(bytes) => {
                bytes.fill(true);
                Ok(())
            }
            None => reject(IOCR, field),
        }
    };
    let known = |place: &Offset| layout.find(place.slot, place.subslot);
    for place in &iocr.objects {
        let Some(submodule) = known(place).filter(|submodule| submodule.has_data(direction)) else {
            return reject(IOCR, 0x16);
        };
        take(place, submodule.length(direction) + 1, 0x18)?;
    }
    for place in &iocr.consumers {
        if known(place).is_none_or(|submodule| !submodule.has_data(direction.opposite())) {
            return reject(IOCR, 0x1A);
        }
        take(place, 1, 0x1C)?;
    }
    let count = |direction| layout.0.iter().filter(|submodule| submodule.has_data(direction)).count();
    check(iocr.objects.len() == count(direction), IOCR, 0x15)?;
    check(iocr.consumers.len() == count(direction.opposite()), IOCR, 0x19)
}

fn alarm_cr(alarm: &AlarmCr) -> Result<(), Status> {
    check(alarm.kind == 1, ALARM, 4)?;
    check(alarm.ether_type == ETHER_TYPE, ALARM, 5)?;
    check(alarm.properties == 0, ALARM, 6)?;
    check((1..=100).contains(&alarm.timeout), ALARM, 7)?;
    check((3..=15).contains(&alarm.retries), ALARM, 8)?;
    check((200..=1432).contains(&alarm.max_len), ALARM, 0x0A)?;
    check(alarm.tags.0 == TAG_HIGH, ALARM, 0x0B)?;
    check(alarm.tags.1 == TAG_LOW, ALARM, 0x0C)
}

/// Checks that the expected modules and their data match the layout.
fn expected(modules: &[ExpectedModule], layout: &Layout) -> Result<(), Status> {
    let own = layout.expected();
    for module in modules {
        check(module.api == 0, EXPECTED, 5)?;
        let found = own.iter().find(|own| own.slot == module.slot);
        let Some(found) = found.filter(|own| own.ident == module.ident) else { return reject(EXPECTED, 4) };
        for submodule in &module.submodules {
            let own = found.submodules.iter().find(|own| own.subslot == submodule.subslot);
            let Some(own) = own.filter(|own| own.ident == submodule.ident) else { return reject(EXPECTED, 6) };
            check(own == submodule, EXPECTED, 7)?;
        }
        check(module.submodules.len() == found.submodules.len(), EXPECTED, 9)?;
    }
    check(modules.len() == own.len(), EXPECTED, 4)
}

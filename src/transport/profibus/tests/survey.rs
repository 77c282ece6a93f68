//! Tests of the survey and of other traffic on the line.

use super::super::request::Requester;
use super::super::survey::{NoValueReason, StationResult, Survey};
use super::super::wire::{Station, Status};
use super::*;

/// Surveys a line with one slave.
fn survey(world: &mut World, stations: std::ops::RangeInclusive<u8>) -> Result<Vec<StationResult>, ProfibusError> {
    let settings = Settings::new(5, RATES[5], resting());
    let timing = settings.timing().unwrap();
    let requester = Requester::new(settings.master, settings.rate, timing.slot, 1);
    let mut survey = Survey::new(world.now, stations, requester, timing);
    loop {
        if let Some(result) = survey.result() {
            return result.map(<[StationResult]>::to_vec);
        }
        while let Some(bytes) = survey.poll(world.now) {
            world.wire.send(world.now, &bytes);
            world.sent.push((world.now, bytes));
        }
        let due = std::iter::once(survey.due()).chain(world.wire.due(&world.slave)).min().unwrap();
        world.now = due.max(world.now + Duration::from_nanos(1));
        world.wire.run(world.now, &mut world.slave);
        let mut buffer = [0; 64];
        let len = world.wire.take(world.now, &mut buffer);
        survey.handle(world.now, &buffer[..len]);
    }
}

#[test]
fn survey_finds_a_slave_without_changing_it() {
    let mut world = World::new("500k", "");
    let found = survey(&mut world, 0..=125).unwrap();
    let [slave] = &found[..] else { panic!("{found:?}") };
    assert_eq!((slave.station, slave.kind), (5, Station::Slave));
    let diagnosis = slave.diagnosis.as_ref().unwrap().to_string();
    assert_eq!(diagnosis, "not ready for data, needs parameters, no master, ident 0x1234");
    assert_eq!(slave.configuration.as_deref().unwrap(), [0xC0, 0xD7, 0xD7]);
    assert_eq!(slave.inputs, Err(NoValueReason::Refused(Status::NoService)));
    assert_eq!((world.slave.owner, world.slave.peer.history.len()), (None, 0));
    // The survey makes two attempts for each free address, and no more.
    assert_eq!(world.sent.len(), 125 * 2 + 5);
}

#[test]
fn survey_reads_an_owned_slave() {
    let mut world = World::new("500k", "");
    world.open();
    world.run(50 * MS, |_| false);
    let found = survey(&mut world, 5..=5).unwrap();
    assert_eq!(found[0].inputs.as_deref().unwrap(), resting());
    assert_eq!(found[0].outputs.as_deref().unwrap(), resting());
    assert_eq!(world.slave.owner, Some(2));
}

#[test]
fn survey_asks_no_station_next_to_another_master() {
    let mut world = World::new("500k", "");
    world.slave.set_fault(Some(SlaveFault::Token));
    // The token of another master arrives with the first answers.
    let error = survey(&mut world, 0..=125).unwrap_err();
    assert!(matches!(error, ProfibusError::OtherMaster { master: 9, .. }), "{error}");
    let asked = world.sent.len();
    assert!(asked < 20, "{asked}");
}

#[test]
fn survey_does_not_query_masters() {
    let mut world = World::new("500k", "");
    world.slave.set_fault(Some(SlaveFault::Master));
    let found = survey(&mut world, 4..=6).unwrap();
    assert_eq!((found[0].kind, &found[0].diagnosis), (Station::MasterInRing, &Err(NoValueReason::NotAsked)));
}

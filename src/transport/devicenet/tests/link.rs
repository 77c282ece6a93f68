//! Tests of opening, running and closing a connection without losses, and of the errors of a failed opening.

use std::time::Duration;

use super::world::{LINK, MS, Mirror, SECOND, World, images, mac, resting, setup};
use crate::devicenet::can::{Bitrate, BusState, Health, PortError};
use crate::devicenet::device::{Device, DeviceFault};
use crate::devicenet::error::Error;
use crate::devicenet::scanner::State;
use crate::devicenet::settings::{Purpose, Settings};
use crate::devicenet::wire::{Answer, Request, class};
use crate::image::image_after_loss;

fn frames(world: &World) -> Vec<String> {
    world.trace.iter().map(|(_, frame)| frame.to_string()).collect()
}

/// Master 1 and slave 5 after power-on: every frame up to the first images. The first request of our master has xid 0
/// and the next request has xid 1. Recorded masters always use xid 0.
#[test]
fn connection_starts_with_the_known_frames() {
    let mut world = World::new(vec![Device::new(setup(5, 48), Mirror::default())], 1);
    world.scanner.open(LINK, images(5)).unwrap();
    world.until(SECOND * 4, |world| world.view().sent > 0);
    let expected = [
        "40F#00FFFF07000000",
        "42F#007C02EEFFC000",
        "40F#00FFFF07000000",
        "42F#007C02EEFFC000",
        "42E#014B03010301",
        "42B#01CB00",
        "42C#410E050207",
        "42B#418E3000",
        "42C#010E050208",
        "42B#018E3000",
        "42C#411005020964",
        "42D#0041000000000000",
    ];
    let got = frames(&world);
    assert_eq!(got[..10], expected[..10]);
    assert_eq!(got[10], "42C#4110050209".to_owned() + "6400");
    assert_eq!(got[11], "42B#41906400");
    assert_eq!(got[12], expected[11]);
    assert_eq!(
        got[13..19].iter().map(|frame| &frame[..6]).collect::<Vec<_>>(),
        ["42D#41", "42D#42", "42D#43", "42D#44", "42D#45", "42D#86"]
    );
    assert_eq!(got[19], "3C5#0041000000000000");
    let view = world.view();
    assert_eq!((view.details.size, view.details.rate, view.generation), (Some(48), Some(MS * 100), 1));
    // The first image that the controller receives is the resting image.
    assert_eq!(world.mirror().history[0].1, resting(48));
    let checked = world.trace.iter().position(|(_, frame)| frame.id() == 0x42E).unwrap();
    assert!(world.trace[checked].0 >= SECOND * 2, "two seconds of checking the MAC");
}

#[test]
fn finds_the_profile_and_exchanges_images() {
    for size in [48u16, 4] {
        let mut world = World::linked(size, 1);
        let image: Vec<u8> = (0..size).map(|byte| u8::try_from(byte + 1).unwrap()).collect();
        let change = world.scanner.set_image(LINK, 1, &image).unwrap();
        world.until(MS * 100, |world| world.view().sent >= change);
        assert_eq!(world.mirror().image, image, "what is told to have been taken was");
        world.until(MS * 100, |world| world.view().input.is_some_and(|input| *input.image == *image));
        assert!(matches!(world.scanner.set_image(LINK, 1, &[0; 5]), Err(Error::Settings(_))));
        assert_eq!(world.scanner.set_image(LINK, 0, &image), Err(Error::Outdated));
    }
}

#[test]
fn keeps_the_explicit_connection_alive_during_polls() {
    let mut world = World::linked(48, 1);
    world.run(SECOND * 60);
    let view = world.view();
    assert_eq!((view.state, view.generation, view.statistics.missed), (State::Open, 1, 0));
    // 60 s of polls every 20 ms, without drift.
    assert_eq!(view.statistics.sent / 10, 300);
    let reply = world.ask(Request::get(class::IDENTITY, 1, 7));
    let Ok(Answer::Done { data, .. }) = reply.result else { panic!("{reply:?}") };
    assert_eq!(data[1..], *b"YRCX (sim)");
    assert!(world.mirror().losses.is_empty());
}

#[test]
fn closing_releases_both_connections() {
    let mut world = World::linked(48, 1);
    let now = world.now;
    world.scanner.close(now, LINK);
    world.until(SECOND * 3, |world| world.view().state == State::Closed);
    assert_eq!(world.devices[0].master(), None);
    assert_eq!(world.mirror().losses.len(), 1);
    assert_eq!(world.view().last_error, None);
    let last: Vec<String> = frames(&world).into_iter().rev().take(2).collect();
    assert!(last[0].ends_with("CC") && last[1].ends_with("4C030103"), "{last:?}");
}

/// Opens a link that fails, and returns the error.
fn refused(device: Device<Mirror>) -> Error {
    let mut world = World::new(vec![device], 1);
    world.scanner.open(LINK, images(5)).unwrap();
    world.until(SECOND * 20, |world| world.view().state == State::Closed);
    assert!(world.trace.iter().all(|(_, frame)| frame.id() != 0x42D), "nothing was polled");
    world.view().last_error.unwrap()
}

#[test]
fn reports_why_a_connection_fails() {
    let with = |fault| {
        let mut device = Device::on_line(setup(5, 48), Mirror::default());
        device.set_fault(Some(fault));
        device
    };
    assert_eq!(refused(with(DeviceFault::ForeignOwner)), Error::Owned(mac(5)));
    assert!(matches!(refused(with(DeviceFault::OtherSize)), Error::Size { produced_size: 50, consumed_size: 50, .. }));
    assert!(matches!(refused(with(DeviceFault::DuplicateMac)), Error::Duplicate { vendor: 636, .. }));
    let silent = Error::Silent {
        mac: mac(5),
        what: "the allocation of its connections",
        is_bus_alive: false,
        state: BusState::Active,
    };
    assert_eq!(refused(with(DeviceFault::Mute)), silent);
    // Another node is present, but the slave is not.
    let other = refused(Device::on_line(setup(6, 48), Mirror::default()));
    assert!(matches!(other, Error::Silent { .. }), "{other}");
}

#[test]
fn does_not_take_the_slave_of_another_master() {
    let mut world = World::linked(48, 1);
    let device = world.devices.remove(0);
    // The slave is still allocated to the first master, and this master has another MAC.
    let mut other = World::new(vec![device], 2);
    other.now = world.now;
    other.scanner = crate::devicenet::scanner::Scanner::new(crate::devicenet::scanner::Identity {
        mac: mac(2),
        vendor: 0xFFFF,
        serial: 8,
    });
    other.scanner.open(LINK, images(5)).unwrap();
    // The first master is silent, so its poll connection times out. Its explicit connection stays open for 10 s.
    other.until(SECOND * 5, |world| world.view().state == State::Closed);
    assert_eq!(other.view().last_error, Some(Error::Owned(mac(5))));
}

/// A process with the same MAC was killed. The master releases the connections of that process, and then allocates them
/// again.
#[test]
fn takes_over_connections_of_its_own_mac() {
    let mut world = World::linked(48, 1);
    let device = world.devices.remove(0);
    let mut again = World::new(vec![device], 2);
    again.now = world.now;
    again.scanner.open(LINK, images(5)).unwrap();
    again.until(SECOND * 8, |world| world.view().state == State::Open);
    let frames = frames(&again);
    assert!(frames.iter().any(|frame| frame.ends_with("940B02")), "{frames:?}");
    assert!(frames.iter().any(|frame| frame.ends_with("4C030103")), "{frames:?}");
}

#[test]
fn reopened_link_starts_with_the_resting_image() {
    let mut world = World::linked(48, 1);
    let change = world.scanner.set_image(LINK, 1, &[9; 48]).unwrap();
    world.until(MS * 100, |world| world.view().sent >= change);
    world.is_cut = true;
    let cut = world.now;
    let lost = world.until(SECOND, |world| world.view().state == State::Lost);
    let took = lost.saturating_sub(cut);
    assert!((MS * 380..MS * 430).contains(&took), "four times the packet rate: {took:?}");
    assert!(matches!(world.view().last_error, Some(Error::Lost { after, .. }) if after == MS * 400));
    assert_eq!(world.scanner.set_image(LINK, 1, &[9; 48]), Err(Error::Outdated));
    world.run(SECOND);
    assert_eq!(world.mirror().losses.len(), 1, "the slave has noticed, too");
    world.is_cut = false;
    world.mirror().history.clear();
    world.mirror().image.clear();
    world.until(SECOND * 15, |world| world.view().state == State::Open);
    assert_eq!(world.view().generation, 2);
    world.run(MS * 100);
    assert_eq!(world.mirror().history.len(), 1);
    let image = &world.mirror().history[0].1;
    assert_eq!(*image, image_after_loss(&resting(48), &[9; 48]), "nothing of the time before goes on");
    assert_ne!(*image, resting(48), "an input that rests on and was off stays off");
    assert_eq!(world.scanner.set_image(LINK, 1, &[9; 48]), Err(Error::Outdated));
    assert!(world.scanner.set_image(LINK, 2, &[9; 48]).is_ok());
}

#[test]
fn finds_a_restarted_slave() {
    let mut world = World::linked(4, 1);
    world.devices[0].set_fault(Some(DeviceFault::Mute));
    world.until(SECOND, |world| world.view().state == State::Lost);
    world.run(SECOND * 20);
    let now = world.now;
    // The slave restarts. It first checks its MAC.
    let mut fresh = Device::new(setup(5, 4), Mirror::default());
    while fresh.wake().is_some_and(|wake| wake < now) && !fresh.is_on_line() {
        let _ = fresh.poll(now);
    }
    world.devices[0] = fresh;
    world.until(SECOND * 15, |world| world.view().state == State::Open);
    assert_eq!(world.view().generation, 2);
}

#[test]
fn bus_off_and_an_unplugged_adapter_are_losses() {
    let mut world = World::linked(48, 1);
    let now = world.now;
    world.scanner.handle_health(now, Health { state: BusState::Off, ..Health::default() });
    assert_eq!((world.view().state, world.view().last_error), (State::Lost, Some(Error::BusOff)));
    world.run(SECOND * 3);
    assert_eq!(world.view().state, State::Lost, "nothing is sent meanwhile");
    let now = world.now;
    world.scanner.handle_health(now, Health::default());
    world.until(SECOND * 15, |world| world.view().state == State::Open);

    let losses = PortError::Gone { path: "/dev/ttyACM0".to_owned(), why: "unplugged".to_owned() };
    let now = world.now;
    world.scanner.fail(now, &Error::Port(losses.clone()));
    assert_eq!((world.view().state, world.view().last_error), (State::Lost, Some(Error::Port(losses))));
    world.run(SECOND * 3);
    assert_eq!(world.view().state, State::Lost);
    world.trace.clear();
    world.scanner.restart();
    world.until(SECOND * 20, |world| world.view().state == State::Open);
    assert_eq!(frames(&world)[0], "40F#00FFFF07000000", "a new adapter: the MAC is checked first");
    assert_eq!(world.view().generation, 3);
}

#[test]
fn answers_duplicate_checks_of_its_own_mac() {
    let mut world = World::linked(48, 1);
    world.devices.push(Device::new(setup(1, 4), Mirror::default()));
    world.bus = crate::devicenet::can::bus::Bus::new(Bitrate::K500, 3);
    world.run(SECOND * 3);
    assert!(!world.devices[1].is_on_line());
    assert_eq!(world.view().state, State::Open);
    assert!(frames(&world).contains(&"40F#80FFFF07000000".to_owned()));
}

/// A search that starts after the failure must not wait forever.
#[test]
fn search_with_a_duplicate_mac_ends() {
    let mut world = World::new(vec![Device::on_line(setup(1, 48), Mirror::default())], 1);
    world.until(SECOND * 3, |world| world.scanner.failure().is_some());
    let now = world.now;
    world.scanner.find(now);
    assert!(matches!(world.scanner.failure(), Some(Error::Duplicate { .. })) && world.scanner.is_idle());
}

#[test]
fn search_on_a_bus_that_is_off_ends() {
    let mut world = World::new(vec![Device::on_line(setup(5, 48), Mirror::default())], 1);
    world.run(SECOND * 3);
    let now = world.now;
    world.scanner.find(now);
    let off = Health { state: BusState::Off, ..Health::default() };
    world.scanner.handle_health(now, off);
    assert_eq!(world.scanner.found(), Some(Vec::new()));
    world.scanner.find(now);
    assert_eq!(world.scanner.found(), Some(Vec::new()), "nor does another one begin");
    assert!(matches!(world.scanner.open(LINK, images(5)), Err(Error::BusOff)) && world.scanner.is_idle());
}

#[test]
fn explicit_messages_start_no_polls() {
    for with_poll in [false, true] {
        let mut world = World::new(vec![Device::on_line(setup(5, 48), Mirror::default())], 1);
        let settings = Settings { purpose: Purpose::Messages { with_poll }, ..images(5) };
        world.scanner.open(LINK, settings).unwrap();
        world.until(SECOND * 5, |world| world.view().state == State::Open);
        let sizes = world.ask(Request::get(class::CONNECTION, 2, 7)).result;
        match sizes {
            Ok(Answer::Done { data, .. }) => assert!(with_poll && data == [48, 0]),
            Ok(Answer::Refused { general: 0x16, .. }) => assert!(!with_poll),
            other => panic!("{other:?}"),
        }
        let now = world.now;
        world.scanner.close(now, LINK);
        world.until(SECOND, |world| world.view().state == State::Closed);
        assert_eq!(world.mirror().losses.len(), 0, "nothing that the controller would miss");
        assert!(frames(&world).iter().all(|frame| !frame.starts_with("42D")));
    }
}

#[test]
fn search_finds_all_nodes_and_owns_none() {
    let device = |number| Device::on_line(setup(number, 48), Mirror::default());
    let mut world = World::new(vec![device(5), device(63), Device::new(setup(9, 4), Mirror::default())], 1);
    world.until(SECOND * 3, |world| world.scanner.is_on_line());
    let now = world.now;
    world.scanner.find(now);
    let mut found = None;
    world.until(SECOND * 10, |world| {
        found = found.take().or_else(|| world.scanner.found());
        found.is_some()
    });
    let found: Vec<u8> = found.unwrap().iter().map(|found| found.mac.number()).collect();
    assert_eq!(found, [5, 9, 63]);
    assert!(world.devices.iter().all(|device| device.is_on_line() && device.master().is_none()));
}

#[test]
fn rejects_invalid_settings_before_sending() {
    let mut world = World::new(Vec::new(), 1);
    let Purpose::Images(usual) = images(5).purpose else { panic!() };
    for (settings, part) in [
        (images(1), "the MAC of this master"),
        (
            Settings {
                purpose: Purpose::Images(crate::devicenet::settings::Images { cycle: Duration::ZERO, ..usual.clone() }),
                ..images(5)
            },
            "cycle",
        ),
        (
            Settings {
                purpose: Purpose::Images(crate::devicenet::settings::Images { rate: MS, ..usual }),
                ..images(5)
            },
            "rate",
        ),
    ] {
        let error = world.scanner.open(LINK, settings).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
    world.scanner.open(LINK, images(5)).unwrap();
    assert!(world.scanner.open(2, images(5)).unwrap_err().to_string().contains("already"));
}

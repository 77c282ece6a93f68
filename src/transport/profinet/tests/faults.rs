//! Tests of losses and alarms, and tests on networks that lose, delay, double and reorder traffic.

use super::super::controller::view::State;
use super::super::device::{Event, Fault};
use super::super::error::{ProfinetError, Unusable};
use super::super::settings::Settings;
use super::super::wire::alarm::{Notification, Priority};
use super::super::wire::rpc::operation;
use super::super::wire::status::Status;
use super::world::{MS, World, native_order, resting, settings, setup};
use crate::image::image_after_loss;

fn image(mark: u8) -> Vec<u8> {
    (0..48).map(|at| mark.wrapping_add(at)).collect()
}

/// Image after a loss that followed `image(5)`: one of the two inputs that rest on was off.
fn after_five() -> Vec<u8> {
    let mut image = resting();
    image[32] = 0x01;
    assert_eq!(image, image_after_loss(&resting(), &self::image(5)));
    image
}

fn alarm(priority: Priority, kind: u16) -> Notification {
    Notification {
        priority,
        kind,
        api: 0,
        slot: 1,
        subslot: 1,
        module: 0x101,
        submodule: 1,
        specifier: 0xA800,
        detail: Some((0x8000, vec![0x80, 0, 0x28, 0, 0, 6])),
    }
}

fn noted(world: &World) -> usize {
    world.device.application.events.iter().filter(|event| matches!(event, Event::AlarmNoted(_))).count()
}

#[test]
fn acknowledges_and_reports_alarms_of_both_priorities_once() {
    let mut world = World::open(setup(), settings(), "");
    for round in 0..3 {
        for priority in Priority::ALL {
            world.device.raise(world.now, &alarm(priority, 1 + round));
        }
        world.device.raise(world.now, &alarm(Priority::Low, 0x0C));
    }
    world.run(500 * MS);
    let told: Vec<_> = std::iter::from_fn(|| world.controller.take_alarm()).map(|alarm| alarm.kind).collect();
    assert_eq!(told.len(), 9, "{told:?}");
    assert_eq!((noted(&world), world.view().generation, world.view().state), (9, 1, State::Open));
}

#[test]
fn alarm_numbers_wrap() {
    let mut world = World::open(setup(), settings(), "");
    for _ in 0..0x8010 {
        world.device.raise(world.now, &alarm(Priority::Low, 1));
        for _ in 0..4 {
            world.settle();
            world.run(std::time::Duration::from_micros(1));
        }
        world.frames.clear();
    }
    assert_eq!((noted(&world), world.view().generation), (0x8010, 1));
    assert!(std::iter::from_fn(|| world.controller.take_alarm()).count() <= 64, "what nobody takes is bounded");
}

#[test]
fn a_plugged_module_brings_a_new_connection() {
    let mut world = World::open(setup(), settings(), "");
    world.device.raise(world.now, &alarm(Priority::Low, 4));
    world.until(1000 * MS, |world| world.view().state == State::Lost);
    assert_eq!(world.view().last_error, Some(ProfinetError::Plugged(1)));
    world.until(10 * MS, |world| noted(world) == 1);
    world.until_open();
    assert_eq!(world.view().generation, 2);
}

#[test]
fn reports_a_silent_device_as_lost() {
    let mut world = World::open(setup(), settings(), "");
    world.controller.set_image(1, &image(5)).unwrap();
    world.run(100 * MS);
    world.device.set_fault(Some(Fault::Stall));
    let from = world.now;
    world.until(1000 * MS, |world| world.view().state == State::Lost);
    assert_eq!(world.view().last_error, Some(ProfinetError::Silent(320 * MS)));
    assert!(world.now.saturating_sub(from) <= 321 * MS);
    world.run(10 * MS);
    let ended = world.device.application.events.last().cloned();
    assert_eq!(ended, Some(Event::Ended(Some(Status::abort(5)))), "the device was told");
    assert!(matches!(world.controller.set_image(1, &image(6)), Err(ProfinetError::Outdated)));
    world.device.set_fault(None);
    world.until_open();
    assert_eq!(world.view().generation, 2);
    assert!(matches!(world.controller.set_image(1, &image(6)), Err(ProfinetError::Outdated)));
    let history = &world.device.application.history;
    assert_eq!(history.last(), Some(&Some(after_five())));
    assert_eq!(history.iter().filter(|shown| **shown == Some(image(5))).count(), 1, "it is not shown again");
}

#[test]
fn bad_data_is_a_loss_and_the_link_restarts_at_rest() {
    for (fault, why) in [
        (Fault::Stop, Unusable::Status(0x25, 0)),
        (Fault::BadProvider, Unusable::Provider(1, 1)),
        (Fault::BadConsumer, Unusable::Consumer(2, 1)),
        (Fault::Invalid, Unusable::Status(0x31, 0)),
    ] {
        let mut world = World::open(setup(), settings(), "");
        world.controller.set_image(1, &image(5)).unwrap();
        world.run(100 * MS);
        world.device.set_fault(Some(fault));
        world.until(100 * MS, |world| world.view().state == State::Lost);
        assert_eq!((world.view().last_error, world.view().input), (Some(ProfinetError::Unusable(why)), None));
        world.run(100 * MS);
        assert_eq!(world.device.application.image, Some(after_five()), "{fault:?}");
        world.device.set_fault(None);
        world.until_open();
        assert_eq!((world.view().generation, world.calls(operation::CONNECT).len()), (2, 1), "{fault:?}");
    }
}

#[test]
fn ignores_old_and_repeated_frames() {
    let mut world = World::open(setup(), settings(), "");
    world.device.set_fault(Some(Fault::Double));
    world.run(1000 * MS);
    let view = world.view();
    assert!(view.statistics.stale >= 60 && view.generation == 1, "{view:?}");
    world.device.set_fault(Some(Fault::Stale));
    world.until(1000 * MS, |world| world.view().state == State::Lost);
    assert!(matches!(world.view().last_error, Some(ProfinetError::Silent(_))), "a count that stands still is silence");
}

#[test]
fn a_device_that_restarts_is_connected_again() {
    let mut world = World::open(setup(), settings(), "");
    world.controller.set_image(1, &image(5)).unwrap();
    world.run(100 * MS);
    world.device.restart(world.now);
    world.until(1000 * MS, |world| world.view().state == State::Lost);
    world.until_open();
    let view = world.view();
    assert_eq!((view.generation, view.statistics.losses), (2, 1));
    assert_eq!(world.device.application.image, Some(after_five()));
}

#[test]
fn unplugged_cable_ends_both_sides() {
    let mut world = World::open(setup(), settings(), "");
    world.cable = false;
    world.run(400 * MS);
    assert_eq!(world.view().state, State::Lost);
    assert_eq!(world.device.application.events.last(), Some(&Event::Ended(Some(Status::abort(5)))));
    // This time is much longer than many attempts to connect. The controller must not give up.
    world.run(120_000 * MS);
    assert_eq!(world.view().state, State::Lost);
    world.cable = true;
    world.until_open();
}

#[test]
fn retry_pauses_grow_up_to_a_limit() {
    let mut world = World::open(setup(), settings(), "");
    world.device.set_fault(Some(Fault::Owned));
    world.device.abort(world.now, 5);
    let from = world.now;
    world.run(60_000 * MS);
    let tries = world.calls(operation::CONNECT).len() - 1;
    assert!((15..40).contains(&tries), "{tries} in a minute after {from:?}");
}

/// The network is unreliable, with many seeds. Either the connection opens, or there is a reason. Every input image is
/// from the device and from this generation. The device receives only images that were sent.
#[test]
fn bad_network_yields_images_or_an_error() {
    let mut opened = 0;
    for spec in ["drop=5%", "drop=20%,dup=10%", "dup=50%", "delay=0..40ms", "delay=0..200ms,reorder=20%,dup=20%"] {
        for seed in 0..40 {
            let settings = Settings { watchdog: 1920 * MS, ..settings() };
            let mut world = World::new(setup(), settings, &format!("{spec},seed={seed}"));
            let end = world.now + 60_000 * MS;
            while world.now < end && !matches!(world.view().state, State::Open | State::Closed) {
                world.run(10 * MS);
            }
            let view = world.view();
            if view.state == State::Closed {
                assert!(view.last_error.is_some(), "{spec}, seed {seed}");
                continue;
            }
            assert_eq!(view.state, State::Open, "{spec}, seed {seed}: {view:?}");
            opened += 1;
            let wanted = image(u8::try_from(seed).unwrap());
            if world.controller.set_image(view.generation, &wanted).is_err() {
                continue;
            }
            world.run(5000 * MS);
            let view = world.view();
            if view.generation == 1 && view.state == State::Open {
                let shown = view.input.map(|input| input.image);
                assert_eq!(shown.as_deref(), Some(&native_order(&wanted)[..]), "{spec}, seed {seed}");
            }
            let known = [Some(wanted.clone()), Some(resting()), None];
            let history = &world.device.application.history;
            assert!(history.iter().all(|shown| known.contains(shown)), "{spec}, seed {seed}");
            assert!(history.iter().filter(|shown| **shown == known[0]).count() <= 1, "{spec}, seed {seed}: twice");
            let known = [native_order(&wanted), native_order(&resting()), vec![0; 48]];
            assert!(world.shown.iter().all(|shown| known.iter().any(|known| **known == **shown)), "{spec}, {seed}");
            let connects = world.calls(operation::CONNECT);
            let distinct: std::collections::BTreeSet<_> = connects.iter().collect();
            assert_eq!(distinct.len(), connects.len(), "{spec}, seed {seed}: Connect left twice");
        }
    }
    assert!(opened > 120, "{opened} of 200 came about");
}

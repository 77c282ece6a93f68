//! Tests of opening, data exchange and closing.

use super::super::controller::view::State;
use super::super::device::{Device, Event, Fault};
use super::super::error::{ModuleMismatch, ProfinetError, Unusable};
use super::super::layout::Direction;
use super::super::settings::{Settings, Startup, Station};
use super::super::wire::Mac;
use super::super::wire::connect::Request;
use super::super::wire::cyclic::{Cyclic, RUNNING};
use super::super::wire::dcp::Setting;
use super::super::wire::frame::{Frame, TAG_HIGH};
use super::super::wire::record::Parameter;
use super::super::wire::rpc::{Call, Datagram, operation};
use super::super::wire::status::Status;
use super::world::{
    ADDRESS, DEVICE_ADDRESS, MS, Mirror, OUR_ADDRESS, World, native_order, resting, settings, setup, suite,
};

fn image(mark: u8) -> Vec<u8> {
    (0..48).map(|at| mark.wrapping_add(at)).collect()
}

/// Returns the payloads of the cyclic frames of the controller, with their times.
fn outputs(world: &World) -> Vec<(std::time::Duration, Vec<u8>)> {
    let is_data = |bytes: &[u8]| {
        let frame = Frame::parse(bytes).unwrap();
        frame.tag == Some(TAG_HIGH) && frame.id < 0xC000
    };
    let payload = |bytes: &[u8]| Frame::parse(bytes).unwrap().payload.to_vec();
    world.frames.iter().filter(|(_, bytes)| is_data(bytes)).map(|(at, bytes)| (*at, payload(bytes))).collect()
}

#[test]
fn exchanges_images_in_both_directions() {
    let mut world = World::open(setup(), settings(), "");
    let generation = world.view().generation;
    let change = world.controller.set_image(generation, &image(3)).unwrap();
    assert!(world.view().sent < change);
    world.until(100 * MS, |world| world.view().input.is_some_and(|input| *input.image == *native_order(&image(3))));
    assert_eq!((world.view().sent, generation), (change, 1));
    let device = world.view().details.device.unwrap();
    assert_eq!((device.mac, device.address, device.id), (DEVICE_ADDRESS, ADDRESS, (0xFFFF, 1)));
}

#[test]
fn first_frame_is_the_resting_image() {
    let world = World::open(setup(), settings(), "");
    let sent = outputs(&world);
    let first = Cyclic::parse(&sent[0].1, 53).unwrap();
    assert_eq!((&first.data[..48], first.status), (&resting()[..], RUNNING));
    assert!(first.data[48..].iter().all(|status| *status == 0x80));
    assert_eq!(world.device.application.history, [Some(resting())], "the device never saw anything else");
}

#[test]
fn frames_keep_their_interval_and_counters_wrap() {
    let mut world = World::open(setup(), settings(), "delay=0..3ms,seed=4");
    world.run(60_000 * MS);
    let sent = outputs(&world);
    let (first, counter) = (sent[0].0, Cyclic::parse(&sent[0].1, 53).unwrap().counter);
    for (index, (at, payload)) in (0u32..).zip(&sent) {
        assert_eq!(*at, first + 16 * MS * index);
        let step = u16::try_from((index * 512) & 0xFFFF).unwrap();
        assert_eq!(Cyclic::parse(payload, 53).unwrap().counter, counter.wrapping_add(step));
    }
    assert!(sent.len() > 3700, "the counter goes round every 2 s");
    let view = world.view();
    assert_eq!((view.generation, view.statistics.losses, view.statistics.stale), (1, 0, 0));
}

#[test]
fn makes_no_unnecessary_calls() {
    let world = World::open(setup(), settings(), "");
    for (operation, count) in [(operation::CONNECT, 1), (operation::WRITE, 0), (operation::CONTROL, 1)] {
        assert_eq!(world.calls(operation).len(), count, "operation {operation}");
    }
}

#[test]
fn sends_connect_once_and_releases_it() {
    let mut world = World::new(setup(), settings(), "");
    world.device.set_fault(Some(Fault::Mute));
    let view = world.run_to_deadline();
    assert!(matches!(view.last_error, Some(ProfinetError::NoAnswer { what: "Connect", .. })), "{view:?}");
    assert_eq!((world.calls(operation::CONNECT).len(), world.calls(operation::RELEASE).len()), (1, 1));
}

#[test]
fn every_connection_has_unique_identifiers() {
    let mut world = World::open(setup(), settings(), "");
    for reason in [0x1A, 0x05, 0x20] {
        world.device.abort(world.now, reason);
        world.until(1000 * MS, |world| world.view().state != State::Open);
        assert_eq!(world.view().last_error, Some(ProfinetError::Aborted(Status::abort(reason))));
        world.until_open();
    }
    let connects = world.calls(operation::CONNECT);
    let mut seen: Vec<_> = connects
        .iter()
        .map(|bytes| {
            let datagram = Datagram::parse(bytes).unwrap();
            let call = Call::parse(datagram.body, datagram.header.order).unwrap();
            let requests = Request::parse_all(call.blocks).unwrap();
            let Request::Ar(ar) = &requests[0] else { panic!("{requests:?}") };
            (ar.session_key, ar.uuid.0, datagram.header.activity.0)
        })
        .collect();
    assert_eq!(seen.len(), 4);
    for pair in seen.windows(2) {
        assert_eq!(pair[1].0, pair[0].0.wrapping_add(1), "the key counts");
    }
    let all = seen.len();
    seen.sort_unstable_by_key(|(_, uuid, activity)| (*uuid, *activity));
    seen.dedup_by(|one, two| one.1 == two.1 || one.2 == two.2);
    assert_eq!(seen.len(), all);
    assert_eq!(world.view().generation, 4);
}

#[test]
fn parameters_are_written_before_the_start() {
    let parameter = |index| Parameter { slot: 1, subslot: 1, index, data: vec![1, 2, 3] };
    for parameters in [vec![parameter(1)], vec![parameter(1), parameter(2)]] {
        let world = World::open(setup(), Settings { parameters: parameters.clone(), ..settings() }, "");
        let written: Vec<_> = world
            .device
            .application
            .events
            .iter()
            .filter_map(|event| match event {
                Event::Written(parameter) => Some(parameter.clone()),
                _ => None,
            })
            .collect();
        assert_eq!(written, parameters);
        assert_eq!(world.calls(operation::WRITE).len(), 1);
    }
    let wrong = Parameter { slot: 9, ..parameter(1) };
    let view = World::new(setup(), Settings { parameters: vec![wrong], ..settings() }, "").run_to_deadline();
    assert_eq!(view.last_error, Some(ProfinetError::Refused { what: "Write", status: Status(0xDF80_B200) }));
}

#[test]
fn legacy_startup_uses_its_class_and_frame_ids() {
    let world = World::open(setup(), Settings { startup: Startup::Legacy, ..settings() }, "");
    let data: Vec<_> = world
        .frames
        .iter()
        .map(|(_, bytes)| Frame::parse(bytes).unwrap())
        .filter(|frame| frame.tag == Some(TAG_HIGH))
        .collect();
    assert!(data.iter().all(|frame| (0xC000..=0xF7FF).contains(&frame.id)) && data.len() > 1);
}

#[test]
fn finds_a_station_by_its_mac() {
    let by_card = Settings { station: Station::Mac(DEVICE_ADDRESS), ..settings() };
    World::open(setup(), by_card.clone(), "");
    let other = Settings { station: Station::Mac(Mac([2, 0, 0, 0, 0, 9])), ..by_card };
    let view = World::new(setup(), other, "").run_to_deadline();
    assert!(matches!(view.last_error, Some(ProfinetError::NotFound { .. })), "{view:?}");
}

#[test]
fn reports_duplicate_and_missing_names() {
    let mut world = World::new(setup(), settings(), "");
    let mac = Mac([2, 0, 0, 0, 0, 3]);
    world.twin = Some(Device::new(super::super::device::Setup { mac, ..setup() }, Mirror::default()));
    let view = world.run_to_deadline();
    let Some(ProfinetError::Duplicate { cards, .. }) = view.last_error else { panic!("{view:?}") };
    let mut cards = [cards.0, cards.1];
    cards.sort();
    assert_eq!(cards, [DEVICE_ADDRESS, mac]);
    assert!(world.calls.is_empty(), "nobody was called");
    let nobody = super::super::device::Setup { name: "other".to_owned(), ..setup() };
    let mut world = World::new(nobody, settings(), "");
    let view = world.run_to_deadline();
    assert!(matches!(view.last_error, Some(ProfinetError::NotFound { .. })), "{view:?}");
    assert_eq!(world.frames.len(), 3, "it was looked for three times");
}

#[test]
fn sets_an_address_only_if_requested() {
    let bare = super::super::device::Setup { ip: None, ..setup() };
    let mut world = World::new(bare.clone(), settings(), "");
    assert!(matches!(world.run_to_deadline().last_error, Some(ProfinetError::NoAddress(_))));
    assert!(world.device.application.events.is_empty());

    let given = Settings { ip: Some(suite([192, 168, 78, 2])), ..settings() };
    let world = World::open(bare.clone(), given.clone(), "");
    let events = &world.device.application.events;
    assert_eq!(events[0], Event::Addressed(suite([192, 168, 78, 2]), false), "until it is switched off");

    let world = World::open(setup(), given.clone(), "");
    assert!(matches!(world.device.application.events[0], Event::Connected(_)), "it has it already");

    let mut world = World::new(bare.clone(), given.clone(), "");
    world.device.set_fault(Some(Fault::KeepsAddress));
    assert_eq!(world.run_to_deadline().last_error, Some(ProfinetError::Dcp { what: "DCP Set IP", error: 5 }));

    let elsewhere = Settings { ip: Some(suite([10, 0, 0, 2])), ..settings() };
    let mut world = World::new(bare, elsewhere, "");
    assert!(matches!(world.run_to_deadline().last_error, Some(ProfinetError::OtherNetwork { .. })));
    assert!(world.device.application.events.is_empty());

    let far = super::super::device::Setup { ip: Some(suite([10, 0, 0, 2])), ..setup() };
    let view = World::new(far, settings(), "").run_to_deadline();
    let Some(ProfinetError::OtherNetwork { device, local_address, .. }) = view.last_error else { panic!("{view:?}") };
    assert_eq!((device.octets(), local_address), ([10, 0, 0, 2], OUR_ADDRESS.ip.address));
}

#[test]
fn sends_frames_until_the_release_is_complete() {
    let mut world = World::open(setup(), settings(), "delay=5ms");
    let generation = world.view().generation;
    world.controller.set_image(generation, &image(9)).unwrap();
    world.run(100 * MS);
    world.controller.close(world.now);
    let before = outputs(&world).len();
    let view = world.run_to_deadline();
    assert_eq!(view.last_error, None);
    let history = &world.device.application.history;
    assert_eq!(history[..], [Some(resting()), Some(image(9)), None], "no input goes on while the connection closes");
    assert!(matches!(world.device.application.events.last(), Some(Event::Ended(None))));
    assert_eq!(world.calls(operation::RELEASE).len(), 1);
    world.run(1000 * MS);
    let after = outputs(&world);
    assert!(after.len() <= before + 2, "silence after the answer");
    assert!(matches!(world.controller.set_image(generation, &image(1)), Err(ProfinetError::Ended)));
}

#[test]
fn reports_an_unanswered_release() {
    let mut world = World::open(setup(), settings(), "");
    world.device.set_fault(Some(Fault::Mute));
    world.controller.close(world.now);
    let view = world.run_to_deadline();
    assert!(matches!(view.last_error, Some(ProfinetError::NoAnswer { what: "Release", .. })), "{view:?}");
    assert_eq!(world.calls(operation::RELEASE).len(), 3);
}

#[test]
fn every_device_fault_has_an_error() {
    type Check = fn(&ProfinetError) -> bool;
    let cases: [(Fault, Check); 10] = [
        (Fault::NeverReady, |why| matches!(why, ProfinetError::NeverReady(_))),
        (Fault::WrongModule, |why| {
            let mismatch = ModuleMismatch { slot: 1, subslot: None, found: Some(0x40), expected: Some(0x101) };
            *why == ProfinetError::Modules(vec![mismatch])
        }),
        (Fault::Stall, |why| matches!(why, ProfinetError::NoData { missing: Unusable::Missing, .. })),
        (Fault::BadProvider, |why| matches!(why, ProfinetError::NoData { missing: Unusable::Provider(1, 1), .. })),
        (Fault::BadConsumer, |why| matches!(why, ProfinetError::NoData { missing: Unusable::Consumer(2, 1), .. })),
        (Fault::Stop, |why| matches!(why, ProfinetError::NoData { missing: Unusable::Status(0x25, 0), .. })),
        (Fault::Invalid, |why| matches!(why, ProfinetError::NoData { missing: Unusable::Status(0x31, 0), .. })),
        (Fault::Garbage, |why| {
            matches!(why, ProfinetError::Refused { what: "Connect", .. } | ProfinetError::Malformed { .. })
        }),
        (Fault::Foreign, |why| matches!(why, ProfinetError::NoAnswer { what: "Connect", .. })),
        (Fault::Owned, |why| matches!(why, ProfinetError::Refused { what: "Connect", status } if status.is_owned())),
    ];
    for (fault, check) in cases {
        let mut world = World::new(setup(), settings(), "");
        world.device.set_fault(Some(fault));
        let view = world.run_to_deadline();
        assert!(view.last_error.as_ref().is_some_and(check), "{fault:?}: {:?}", view.last_error);
        assert_eq!((view.generation, view.input), (0, None), "{fault:?} never is an image");
        assert!(world.shown.is_empty(), "{fault:?}");
    }
    let mismatch = ModuleMismatch { slot: 1, subslot: None, found: Some(0x40), expected: Some(0x99) };
    assert_eq!(mismatch.to_string(), "slot 1 has module 0x40, but the layout has 0x99");
}

#[test]
fn waits_for_the_connection_of_a_dead_process_to_expire() {
    let mut world = World::new(setup(), settings(), "");
    world.device.set_fault(Some(Fault::Owned));
    world.run(3000 * MS);
    world.device.set_fault(None);
    world.until_open();
}

#[test]
fn supports_other_layouts() {
    for text in ["0:1,1:2:i48o48", "0:1,0.0x8000:1/0x8000,1:2:i32,2:3:i16,3:4:o32,4:5:o16", "1:7:i1,2:8:o48"] {
        let layout: super::super::layout::Layout = text.parse().unwrap();
        let setup = super::super::device::Setup { layout: layout.clone(), ..setup() };
        let mut world = World::new(setup, Settings { layout: layout.clone(), ..settings() }, "");
        let size = layout.size(Direction::Input);
        world.until(30_000 * MS, |world| {
            world.view().input.is_some_and(|input| *input.image == native_order(&resting())[..size])
        });
    }
}

#[test]
fn swaps_bytes_only_on_the_wire() {
    let mut world = World::open(setup(), Settings { swapped: 32, ..settings() }, "");
    world.controller.set_image(1, &image(1)).unwrap();
    world.until(100 * MS, |world| world.view().input.is_some_and(|input| *input.image == *native_order(&image(1))));
    let there = world.device.application.image.clone().unwrap();
    assert_eq!((&there[..4], &there[30..]), (&[2, 1, 4, 3][..], &[&[32, 31][..], &image(1)[32..]].concat()[..]));
}

#[test]
fn a_name_is_not_set_while_a_controller_is_connected() {
    let mut world = World::open(setup(), settings(), "");
    let dcp = super::super::wire::dcp::Dcp::change(7, vec![super::super::wire::dcp::Block::set_name("other", true)]);
    let payload = dcp.emit();
    let frame =
        Frame { destination: DEVICE_ADDRESS, source: OUR_ADDRESS.mac, tag: None, id: 0xFEFD, payload: &payload };
    world.device.frame(world.now, &frame.emit());
    let answers: Vec<_> = std::iter::from_fn(|| world.device.poll(world.now)).collect();
    let outcome = answers.iter().find_map(|action| match action {
        super::super::controller::Action::Frame(bytes) => {
            let frame = Frame::parse(bytes).unwrap();
            (frame.id == 0xFEFD).then(|| super::super::wire::dcp::Dcp::parse(frame.payload).unwrap().outcomes())
        }
        super::super::controller::Action::Datagram(..) => None,
    });
    assert_eq!(outcome, Some(vec![(Setting::NAME, 6)]));
}

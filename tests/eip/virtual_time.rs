//! The originator and the adapter with each other, in virtual time.

use std::time::Duration;

use armctl_transport::eip::adapter::{Adapter, AdapterFault, Assembly, Event, Output, Purpose, Setup};
use armctl_transport::eip::error::EipError;
use armctl_transport::eip::explicit::{Answer, Message};
use armctl_transport::eip::originator::State;
use armctl_transport::eip::settings::{Multiplier, Role, Settings};
use armctl_transport::eip::wire::{Command, Cyclic, Frame, Identity, Key, Open, Request, RrData, Status};

use armctl_transport::image::image_after_loss;

use super::world::{ADAPTER_ADDRESS, MS, Mirror, ORIGINATOR_ADDRESS, World, identity, resting, settings, setup};

/// An image that can be recognized by its mark.
fn image(mark: u8) -> Vec<u8> {
    (0..48).map(|at| mark.wrapping_add(at)).collect()
}

fn native_order(image: &[u8]) -> Vec<u8> {
    image.iter().map(|byte| !byte).collect()
}

fn refusal(world: &World) -> Status {
    match world.view().last_error {
        Some(EipError::Refused { status, .. }) => status,
        other => panic!("it was not refused: {other:?}"),
    }
}

#[test]
fn exchanges_images_in_both_directions() {
    let mut world = World::open(setup(), settings(), "");
    assert_eq!(world.adapter.application.image, resting());
    assert!(!world.adapter.application.run, "it begins idle");
    let generation = world.view().generation;
    let change = world.originator.set_image(generation, &image(3)).unwrap();
    let run = world.originator.set_run(generation, true).unwrap();
    assert!(change < run && world.view().sent < change);
    world.run_until(100 * MS, |world| world.view().input.is_some_and(|input| *input.image == *native_order(&image(3))));
    assert_eq!(world.view().sent, run);
    assert!(world.adapter.application.run);
}

#[test]
fn sends_images_at_their_interval() {
    let mut world = World::open(setup(), settings(), "delay=0..3ms,seed=4");
    world.run(10_000 * MS);
    let first = world.images_out[0].0;
    for (sent, index) in world.images_out.iter().zip(0u32..) {
        assert_eq!(sent.0, first + 20 * MS * index);
    }
    let statistics = world.view().statistics;
    assert_eq!((statistics.lost, statistics.stale, statistics.skipped), (0, 0, 0));
    assert!(statistics.received >= 500, "{statistics:?}");
}

#[test]
fn increments_both_counters_per_image() {
    let mut world = World::open(setup(), settings(), "");
    world.run(2_000_000 * MS);
    for (sent, index) in world.images_out.iter().zip(1u32..) {
        let datagram = Cyclic::parse(&sent.1).unwrap();
        let count = u16::try_from(index & 0xFFFF).unwrap();
        assert_eq!((datagram.sequence, datagram.count), (index, count));
    }
    assert!(world.images_out.len() > 65_536);
    assert_eq!((world.view().generation, world.view().statistics.lost), (1, 0));
}

#[test]
fn uses_the_interval_of_the_answer() {
    let setup = Setup { tick: 8 * MS, ..setup() };
    let mut world = World::open(setup, settings(), "");
    assert_eq!(world.view().details.intervals, Some((24 * MS, 24 * MS)));
    world.run(1000 * MS);
    let times: Vec<_> = world.images_out.windows(2).map(|pair| pair[1].0.saturating_sub(pair[0].0)).collect();
    assert!(times.iter().all(|time| *time == 24 * MS));
}

#[test]
fn survives_a_bad_network() {
    for seed in 0..20 {
        let faults = format!("drop=20%,dup=10%,reorder=10%,delay=0..15ms,corrupt=5%,seed={seed}");
        let mut world =
            World::open(setup(), Settings { multiplier: Multiplier::of(64).unwrap(), ..settings() }, &faults);
        let generation = world.view().generation;
        for mark in 1..100 {
            world.originator.set_image(generation, &image(mark)).unwrap();
            world.run_until(5000 * MS, |world| {
                world.view().input.is_some_and(|input| *input.image == *native_order(&image(mark)))
            });
        }
        // An old image never replaces a newer image, although the network changes the order of packets.
        let history = &world.adapter.application.history;
        let marks: Vec<u8> = history.iter().map(|(image, _)| image[0]).filter(|mark| (1..100).contains(mark)).collect();
        assert!(marks.is_sorted(), "seed {seed}: {marks:?}");
        let view = world.view();
        assert!(view.statistics.lost > 0 && view.statistics.stale > 0, "{:?}", view.statistics);
        assert_eq!((view.generation, view.state), (1, State::Open), "seed {seed}");
    }
}

#[test]
fn close_sends_idle_and_is_confirmed() {
    let mut world = World::open(setup(), settings(), "");
    let generation = world.view().generation;
    world.originator.set_run(generation, true).unwrap();
    world.run(100 * MS);
    world.originator.close();
    assert_eq!(world.originator.set_image(generation, &image(1)), Err(EipError::Ended));
    world.run_until(1000 * MS, |world| world.originator.is_finished());
    assert_eq!((world.view().state, world.view().last_error), (State::Closed, None));
    assert!(!world.adapter.application.run, "the last image was idle");
    world.run(100 * MS);
    let events = &world.adapter.application.events;
    assert!(matches!(events[..], [Event::Opened(_), Event::Closed(_)]), "{events:?}");
    let last = &world.frames.last().unwrap().1;
    assert_eq!(last[0], 0x66, "the session is taken leave of");
}

#[test]
fn reopened_device_starts_with_resting_image() {
    let mut world = World::open(setup(), settings(), "");
    world.originator.set_image(1, &image(7)).unwrap();
    world.originator.set_run(1, true).unwrap();
    world.run(200 * MS);
    world.cable = false;
    world.run_until(400 * MS, |world| world.view().state == State::Lost);
    assert_eq!(world.view().last_error, Some(EipError::Silent(320 * MS)));
    assert_eq!(world.originator.set_image(1, &image(8)), Err(EipError::Outdated));
    let before = world.adapter.application.history.len();
    world.run(30_000 * MS);
    assert!(matches!(world.adapter.application.events.last(), Some(Event::TimedOut(_))));
    world.cable = true;
    world.run_until(20_000 * MS, |world| world.view().generation == 2);
    world.run(1000 * MS);
    assert_eq!(world.view().state, State::Open);
    let shown = &world.adapter.application.history[before..];
    assert_eq!(shown, [(image_after_loss(&resting(), &image(7)), false)], "nothing of before goes on again");
    assert_eq!(world.originator.set_image(1, &image(8)), Err(EipError::Outdated));
    assert!(world.originator.set_image(2, &image(8)).is_ok());
}

#[test]
fn every_opening_has_a_unique_number() {
    let mut world = World::open(setup(), settings(), "");
    for generation in 2..6 {
        world.adapter.set_fault(Some(AdapterFault::Stall));
        world.run_until(400 * MS, |world| world.view().state == State::Lost);
        world.adapter.set_fault(None);
        world.run_until(20_000 * MS, |world| world.view().generation == generation);
        // When an image was received, the wait before the next try is short again.
        world.run(100 * MS);
    }
    let opens: Vec<Open> =
        world.frames.iter().filter_map(|(out, frame)| if *out { opened(frame) } else { None }).collect();
    let mut serials: Vec<u16> = opens.iter().map(|open| open.triad.serial).collect();
    assert!(opens.iter().all(|open| open.triad.originator == opens[0].triad.originator));
    serials.dedup();
    assert_eq!(serials.len(), 5, "{serials:?}");
    let mut ids: Vec<u32> = opens.iter().map(|open| open.t_o_id).collect();
    ids.dedup();
    assert_eq!(ids.len(), 5);
}

fn opened(frame: &[u8]) -> Option<Open> {
    let frame = Frame::parse(frame).ok()?;
    let data = RrData::parse(frame.data).ok()?;
    let request = Request::parse(data.message).ok()?;
    if request.service == 0x54 { Open::parse(request.data, false).ok() } else { None }
}

#[test]
fn images_continue_without_tcp() {
    let mut world = World::open(setup(), settings(), "");
    world.tcp = false;
    world.originator.disconnected(&EipError::Hangup("the test"));
    world.run(60_000 * MS);
    assert_eq!((world.view().state, world.view().generation), (State::Open, 1));
    world.tcp = true;
    world.ask(9, Message::get(1, 1, 1).emit().unwrap());
    world.run_until(100 * MS, |world| !world.answers.is_empty());
    let answer = Answer::parse("the test", world.answers[0].1.as_ref().unwrap()).unwrap();
    assert_eq!(answer, Answer { status: Status::OK, data: vec![0x7C, 0x02] });
}

#[test]
fn scanner_waits_ten_seconds_for_the_first_image() {
    let mut world = World::new(setup(), settings(), "");
    world.adapter.set_fault(Some(AdapterFault::Stall));
    world.run_until(100 * MS, |world| world.view().state == State::Open);
    world.run(9_900 * MS);
    assert_eq!((world.view().state, world.view().input), (State::Open, None));
    world.run_until(200 * MS, |world| world.view().state == State::Lost);
    assert_eq!(world.view().last_error, Some(EipError::Silent(10_000 * MS)));
}

#[test]
fn adapter_waits_ten_seconds_for_the_first_image_only() {
    let mut world = World::new(setup(), settings(), "");
    world.run_until(100 * MS, |world| world.adapter.peers().next().is_some());
    world.cable = false;
    world.run(9_990 * MS);
    assert_eq!(world.adapter.peers().count(), 1);
    world.run(20 * MS);
    assert_eq!(world.adapter.peers().count(), 0);

    let mut world = World::open(setup(), settings(), "");
    world.run(100 * MS);
    world.cable = false;
    world.run(290 * MS);
    assert_eq!(world.adapter.peers().count(), 1);
    world.run(40 * MS);
    assert_eq!(world.adapter.peers().count(), 0);
}

#[test]
fn detects_adapter_faults() {
    // Each fault, and whether the connection is lost.
    let cases = [
        (AdapterFault::HalfRate, false),
        (AdapterFault::Double, false),
        (AdapterFault::Stall, true),
        (AdapterFault::Stale, true),
        (AdapterFault::WrongSequence, true),
        (AdapterFault::WrongId, true),
        (AdapterFault::WrongSize, true),
        (AdapterFault::Reset, false),
        (AdapterFault::Mute, false),
        (AdapterFault::Garbage, false),
    ];
    for (fault, loses) in cases {
        let mut world = World::open(setup(), settings(), "");
        world.run(100 * MS);
        world.adapter.set_fault(Some(fault));
        world.run(1000 * MS);
        let statistics = world.view().statistics;
        assert_eq!(world.view().generation > 1 || world.view().state == State::Lost, loses, "{fault:?} {statistics:?}");
        match fault {
            AdapterFault::HalfRate => assert!(statistics.lost > 20 && statistics.late > 20),
            AdapterFault::Double | AdapterFault::Stale => assert!(statistics.stale >= 15),
            AdapterFault::WrongSize => assert!(statistics.size_error >= 15),
            _ => {}
        }
    }
}

#[test]
fn silent_adapter_ends_the_opening() {
    type IsIt = fn(&EipError) -> bool;
    let cases: [(AdapterFault, IsIt); 3] = [
        (AdapterFault::Mute, |last_error| matches!(last_error, EipError::NoAnswer { what: "RegisterSession", .. })),
        (AdapterFault::Reset, |last_error| matches!(last_error, EipError::Hangup("ForwardOpen"))),
        (AdapterFault::Garbage, |last_error| matches!(last_error, EipError::Malformed { what: "ForwardOpen", .. })),
    ];
    for (fault, is_it) in cases {
        let mut world = World::new(setup(), settings(), "");
        world.adapter.set_fault(Some(fault));
        world.run_until(20_000 * MS, |world| world.originator.is_finished());
        let view = world.view();
        assert_eq!((view.state, view.generation), (State::Closed, 0));
        assert!(is_it(view.last_error.as_ref().unwrap()), "{fault:?}: {:?}", view.last_error);
    }
}

#[test]
fn reports_an_absent_device_at_once() {
    let mut world = World::new(setup(), settings(), "");
    world.tcp = false;
    world.run_until(100 * MS, |world| world.originator.is_finished());
    assert!(matches!(world.view().last_error, Some(EipError::Unreachable { .. })));
    let mut world = World::new(setup(), settings(), "");
    world.cable = false;
    world.run_until(3000 * MS, |world| world.originator.is_finished());
    let after = Duration::from_secs(3);
    assert_eq!(world.view().last_error, Some(EipError::NoAnswer { what: "the TCP connection", after }));
}

/// If the answer to ForwardOpen is lost, the device may have opened the connection. The originator therefore closes it.
#[test]
fn closes_an_opening_of_unknown_outcome() {
    let mut world = World::new(setup(), settings(), "");
    world.run_until(100 * MS, |world| world.adapter.peers().next().is_some());
    world.cable = false;
    world.run(2900 * MS);
    world.cable = true;
    world.run_until(10_000 * MS, |world| world.originator.is_finished());
    assert!(matches!(world.view().last_error, Some(EipError::NoAnswer { what: "ForwardOpen", .. })));
    let events = &world.adapter.application.events;
    assert!(matches!(events[..], [Event::Opened(_), Event::Closed(_)]), "{events:?}");
}

#[test]
fn refusals_have_a_reason() {
    let key = |key: Key| Settings { key: Some(key), ..settings() };
    let own = Key { vendor: 636, device_type: 43, product: 5, major: 1, minor: 2, compatible: false };
    let short = Settings { output_size: 40, resting: vec![0; 40], ..settings() };
    let cases: [(Settings, u16, &[u16]); 15] = [
        (short, 0x0109, &[54]),
        (Settings { input_size: 50, ..settings() }, 0x0109, &[50]),
        (Settings { input_size: 1000, ..settings() }, 0x0109, &[50]),
        (Settings { rpi: MS, ..settings() }, 0x0111, &[]),
        (Settings { rpi: 4000 * MS, ..settings() }, 0x0111, &[]),
        (Settings { output: 100, input: 150, ..settings() }, 0x0117, &[]),
        (Settings { output: 151, ..settings() }, 0x0117, &[]),
        (Settings { configuration: Some(2), ..settings() }, 0x0118, &[]),
        (Settings { configuration_data: vec![1, 2], ..settings() }, 0x0126, &[0]),
        (key(Key { vendor: 1, ..own }), 0x0114, &[]),
        (key(Key { product: 6, ..own }), 0x0114, &[]),
        (key(Key { device_type: 12, ..own }), 0x0115, &[]),
        (key(Key { major: 2, ..own }), 0x0116, &[]),
        (key(Key { minor: 1, ..own }), 0x0116, &[]),
        (Settings { output: 237, output_size: 0, resting: vec![], role: Role::ListenOnly, ..settings() }, 0x0119, &[]),
    ];
    for (settings, code, more) in cases {
        let text = format!("{settings:?}");
        let mut world = World::new(setup(), settings, "");
        world.run_until(1000 * MS, |world| world.originator.is_finished());
        assert_eq!(refusal(&world), Status::connection(code, more), "{text}");
        assert_eq!(world.adapter.peers().count(), 0);
    }
}

#[test]
fn accepts_matching_settings() {
    let own = Key { vendor: 636, device_type: 43, product: 5, major: 1, minor: 2, compatible: false };
    let cases = [
        Settings { key: Some(own), ..settings() },
        Settings { key: Some(Key { minor: 1, compatible: true, ..own }), ..settings() },
        Settings { key: Some(Key::default()), ..settings() },
        Settings { configuration: None, ..settings() },
        Settings { output: 238, output_size: 0, resting: vec![], role: Role::InputOnly, ..settings() },
    ];
    for settings in cases {
        let mut world = World::open(setup(), settings, "");
        world.run(1000 * MS);
        assert_eq!((world.view().state, world.view().generation), (State::Open, 1));
    }
}

#[test]
fn large_images_use_the_large_opening() {
    let mut setup = setup();
    setup.assemblies = vec![
        Assembly { instance: 100, purpose: Purpose::Input, size: 1400 },
        Assembly { instance: 150, purpose: Purpose::Output, size: 600 },
        Assembly { instance: 0x1234, purpose: Purpose::Configuration, size: 4 },
    ];
    let settings = Settings {
        output_size: 600,
        input_size: 1400,
        resting: vec![1; 600],
        configuration: Some(0x1234),
        configuration_data: vec![1, 2, 3, 4],
        ..settings()
    };
    let world = World::open(setup, settings, "");
    assert_eq!(world.view().input.unwrap().image.len(), 1400);
}

#[test]
fn joins_and_leaves_a_multicast_group() {
    let mut world = World::open(setup(), Settings { multicast: true, ..settings() }, "");
    assert_eq!(world.joined, [setup().group]);
    world.run(1000 * MS);
    assert_eq!(world.view().generation, 1);
    world.originator.close();
    world.run_until(1000 * MS, |world| world.originator.is_finished());
    assert!(world.joined.is_empty());
}

/// Opens a connection for a second originator, whose request is built here. Returns the status of the answer.
fn second(world: &mut World, settings: &Settings, serial: u16) -> Status {
    let open = Open {
        o_t_id: 0,
        t_o_id: 0x9999,
        triad: armctl_transport::eip::wire::Triad { serial, vendor: 2, originator: 3 },
        multiplier: 7,
        o_t: settings.o_t(),
        t_o: settings.t_o(),
        transport: 1,
        path: settings.path(),
    };
    world.answers.clear();
    world.ask(50, RrData::new(&open.emit()).emit());
    world.run_until(100 * MS, |world| !world.answers.is_empty());
    Answer::parse("the test", world.answers[0].1.as_ref().unwrap()).unwrap().status
}

#[test]
fn accepts_one_owner_and_many_listeners() {
    let multicast = Settings { multicast: true, ..settings() };
    let mut world = World::open(setup(), multicast.clone(), "");
    let listener = |role, output| Settings { role, output, output_size: 0, resting: vec![], ..multicast.clone() };
    assert_eq!(second(&mut world, &multicast, 1), Status::connection(0x0106, &[]));
    assert_eq!(second(&mut world, &listener(Role::ListenOnly, 237), 2), Status::OK);
    assert_eq!(second(&mut world, &listener(Role::ListenOnly, 237), 2), Status::connection(0x0100, &[]));
    assert_eq!(world.adapter.peers().count(), 2);
    // The adapter sends each image to the group only once.
    let before = world.view().statistics.received;
    world.run(1000 * MS);
    assert!((50..=51).contains(&(world.view().statistics.received - before)));
    // When the last connection that is not listen-only is closed, the adapter also closes the listen-only connections.
    world.originator.close();
    world.run_until(1000 * MS, |world| world.originator.is_finished());
    assert_eq!(world.adapter.peers().count(), 0);
    let events = &world.adapter.application.events;
    assert!(matches!(events[2..], [Event::Closed(_), Event::Closed(_)]), "{events:?}");
}

#[test]
fn limits_the_number_of_connections() {
    let setup = Setup { most_connections: 3, ..setup() };
    let mut world = World::open(setup, settings(), "");
    let inputs = Settings { role: Role::InputOnly, output: 238, output_size: 0, resting: vec![], ..settings() };
    assert_eq!(second(&mut world, &inputs, 1), Status::OK);
    assert_eq!(second(&mut world, &inputs, 2), Status::OK);
    assert_eq!(second(&mut world, &inputs, 3), Status::connection(0x0113, &[]));
}

#[test]
fn objects_answer() {
    let mut world = World::open(setup(), settings(), "");
    let size = 48u16.to_le_bytes().to_vec();
    let cases = [
        (Message::get(4, 100, 4), Ok(size)),
        (Message::get(4, 150, 3), Ok(resting())),
        (Message::get(4, 100, 3), Ok(native_order(&resting()))),
        (Message::get(4, 0, 2), Ok(vec![150, 0])),
        (Message::get(4, 0, 3), Ok(vec![3, 0])),
        (Message::get(1, 1, 7), Ok(b"\x03RCX".to_vec())),
        (Message::get(1, 1, 5), Ok(vec![0x71, 0])),
        (Message::get(4, 101, 3), Err(0x05)),
        (Message::get(0x99, 1, 1), Err(0x05)),
        (Message::get(4, 100, 9), Err(0x14)),
        (Message::set(4, 150, 3, &[0; 48]), Err(0x0C)),
        (Message::set(4, 100, 3, &[0; 48]), Err(0x0E)),
        (Message::get_all(4, 100), Err(0x08)),
        (Message { service: 0x4B, ..Message::get_all(1, 1) }, Err(0x08)),
    ];
    for (message, expected) in cases {
        world.answers.clear();
        world.ask(50, message.emit().unwrap());
        world.run_until(100 * MS, |world| !world.answers.is_empty());
        let answer = Answer::parse("the test", world.answers[0].1.as_ref().unwrap()).unwrap();
        let expected = match expected {
            Ok(data) => Answer { status: Status::OK, data },
            Err(general) => Answer { status: Status::general(general), data: Vec::new() },
        };
        assert_eq!(answer, expected, "{message:?}");
    }
    world.answers.clear();
    world.ask(50, Message::get_all(1, 1).emit().unwrap());
    world.run_until(100 * MS, |world| !world.answers.is_empty());
    let answer = Answer::parse("the test", world.answers[0].1.as_ref().unwrap()).unwrap();
    let found = Identity::parse_attributes(&answer.data, identity().address).unwrap();
    assert_eq!(found, Identity { status: 0x71, state: None, ..identity() });
}

#[test]
fn message_writes_an_image_without_an_owner() {
    let mut adapter = Adapter::new(setup(), Mirror::default());
    adapter.connected(1, ORIGINATOR_ADDRESS);
    let mut ask = |frame: Frame<'_>| {
        adapter.received(Duration::ZERO, 1, &frame.emit());
        match adapter.poll(Duration::ZERO) {
            Some(Output::Send(1, bytes)) => bytes,
            other => panic!("{other:?}"),
        }
    };
    let session = Frame::parse(&ask(Frame::register([0; 8]))).unwrap().session;
    let mut set = |image: &[u8]| {
        let data = Message::set(4, 150, 3, image).emit().unwrap();
        let answer = ask(Frame { session, data: &data, ..Frame::new(Command::SEND_RR_DATA) });
        Answer::parse("the test", Frame::parse(&answer).unwrap().data).unwrap().status
    };
    assert_eq!(set(&[7; 47]), Status::general(0x13));
    assert_eq!(set(&[7; 49]), Status::general(0x15));
    assert_eq!(set(&[7; 48]), Status::OK);
    assert_eq!(adapter.application.history.len(), 1);
}

#[test]
fn ignores_images_of_other_senders() {
    let mut world = World::open(setup(), settings(), "");
    world.run(100 * MS);
    let mut forged = world.images_out.last().unwrap().1.clone();
    forged[10] = 0xF0;
    let before = world.adapter.application.history.clone();
    let stranger = std::net::SocketAddrV4::new([10, 0, 0, 9].into(), 2222);
    world.adapter.receive_datagram(world.now, stranger, &forged);
    assert_eq!(world.adapter.application.history, before);
    assert!(!world.originator.expects(ORIGINATOR_ADDRESS, 0x1000));
}

#[test]
fn ignores_images_of_another_port_of_the_device() {
    let mut world = World::open(setup(), settings(), "");
    world.run(100 * MS);
    let before = world.originator.view().input.unwrap();
    // The connection id is not secret: a program on the same computer can read it.
    let id = (0..u32::MAX).find(|id| world.originator.expects(ADAPTER_ADDRESS, *id)).unwrap();
    let forged = Cyclic { id, sequence: 1_000_000, count: 0, body: &[0xAA; 48] };
    world.originator.receive_datagram(world.now, 40_000, &forged);
    assert_eq!(world.originator.view().input.unwrap().image, before.image);
}

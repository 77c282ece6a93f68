//! No bytes cause a panic, and messages can be written and read again without a change.

use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use armctl_transport::eip::adapter::Adapter;
use armctl_transport::eip::originator::{Identifiers, Originator};
use armctl_transport::eip::wire::{
    Close, Closed, Command, Cyclic, Flow, Frame, Frames, Identity, Item, Key, Net, Open, Opened, Path, Refused, Reply,
    Request, RrData, Segment, Services, Status, Triad,
};
use proptest::collection::vec;
use proptest::prelude::*;

use super::world::{MS, Mirror, ORIGINATOR_ADDRESS, World, settings, setup};

fn segment() -> impl Strategy<Value = Segment> {
    prop_oneof![
        any::<u32>().prop_map(Segment::Class),
        (0u32..300).prop_map(Segment::Instance),
        any::<u32>().prop_map(Segment::Attribute),
        (0u32..70_000).prop_map(Segment::Point),
        vec(any::<u8>(), 0..40).prop_map(|mut data| {
            data.truncate(data.len() & !1);
            Segment::Data(data)
        }),
        (1u16..40, vec(any::<u8>(), 1..9)).prop_map(|(port, link)| Segment::Port { port, link }),
        (any::<[u16; 3]>(), 0u8..128, any::<u8>(), any::<bool>()).prop_map(|(ids, major, minor, compatible)| {
            let [vendor, device_type, product] = ids;
            Segment::Key(Key { vendor, device_type, product, major, minor, compatible })
        }),
    ]
}

fn path() -> impl Strategy<Value = Path> {
    vec(segment(), 0..8).prop_map(Path)
}

fn triad() -> impl Strategy<Value = Triad> {
    any::<(u16, u16, u32)>().prop_map(|(serial, vendor, originator)| Triad { serial, vendor, originator })
}

fn flow() -> impl Strategy<Value = Flow> {
    let net = prop_oneof![Just(Net::Null), Just(Net::Multicast), Just(Net::PointToPoint), Just(Net::Reserved)];
    (any::<u32>(), net, any::<u16>(), any::<bool>(), 0u8..4, any::<bool>()).prop_map(
        |(rpi_us, net, size, variable, priority, redundant)| Flow { rpi_us, net, size, variable, priority, redundant },
    )
}

fn open() -> impl Strategy<Value = Open> {
    (any::<[u32; 2]>(), triad(), any::<u8>(), flow(), flow(), any::<u8>(), path()).prop_map(
        |([o_t_id, t_o_id], triad, multiplier, o_t, t_o, transport, path)| Open {
            o_t_id,
            t_o_id,
            triad,
            multiplier,
            o_t,
            t_o,
            transport,
            path,
        },
    )
}

fn address() -> impl Strategy<Value = SocketAddrV4> {
    any::<([u8; 4], u16)>().prop_map(|(ip, port)| SocketAddrV4::new(ip.into(), port))
}

proptest! {
    #[test]
    fn parses_or_refuses_random_bytes(bytes in vec(any::<u8>(), 0..200)) {
        let _ = Frame::parse(&bytes);
        let _ = Item::parse_all(&bytes);
        let _ = RrData::parse(&bytes);
        let _ = Path::parse(&bytes);
        let _ = Request::parse(&bytes);
        let _ = Reply::parse(&bytes);
        let _ = Open::parse(&bytes, false);
        let _ = Open::parse(&bytes, true);
        let _ = Opened::parse(&bytes);
        let _ = Refused::parse(&bytes);
        let _ = Close::parse(&bytes);
        let _ = Closed::parse(&bytes);
        let _ = Cyclic::parse(&bytes);
        let _ = Identity::parse(&bytes);
        let _ = Identity::parse_attributes(&bytes, SocketAddrV4::new(Ipv4Addr::LOCALHOST, 1));
        let _ = Services::parse(&bytes);
        let mut frames = Frames::default();
        frames.push(&bytes);
        while frames.pop().is_some() {}
    }

    #[test]
    fn round_trips_openings(open in open()) {
        let bytes = open.emit();
        let request = Request::parse(&bytes).unwrap();
        prop_assert_eq!(Open::parse(request.data, open.is_large()), Ok(open));
    }

    #[test]
    fn round_trips_other_messages(
        triad in triad(),
        path in path(),
        words in vec(any::<u16>(), 0..5),
        numbers in any::<[u32; 4]>(),
        data in vec(any::<u8>(), 0..60),
        addresses in any::<bool>().prop_flat_map(|some| (proptest::option::of(address()), proptest::option::of(address()), Just(some))),
    ) {
        let close = Close { triad, path: path.clone() };
        let bytes = close.emit();
        prop_assert_eq!(Close::parse(Request::parse(&bytes).unwrap().data), Ok(close));
        let application = data[..data.len() & !1].to_vec();
        let [o_t_id, t_o_id, o_t_api_us, t_o_api_us] = numbers;
        let opened = Opened { o_t_id, t_o_id, triad, o_t_api_us, t_o_api_us, application };
        prop_assert_eq!(Opened::parse(&opened.emit()), Ok(opened));
        let request = Request { service: 0x0E, path, data: &data };
        let bytes = request.emit();
        prop_assert_eq!(Request::parse(&bytes), Ok(request));
        let reply = Reply { service: 0x0E, status: Status { general: 1, extended: words }, data: &data };
        let bytes = reply.emit();
        prop_assert_eq!(Reply::parse(&bytes), Ok(reply));
        let rr = RrData { timeout: 7, message: &data, o_t: addresses.0, t_o: addresses.1 };
        let bytes = rr.emit();
        prop_assert_eq!(RrData::parse(&bytes), Ok(rr));
        let frame = Frame { command: Command(0x6F), session: numbers[0], status: numbers[1], context: *b"abcdefgh", data: &data };
        let bytes = frame.emit();
        prop_assert_eq!(Frame::parse(&bytes), Ok(frame));
        let cyclic = Cyclic { id: numbers[0], sequence: numbers[1], count: 9, body: &data };
        let bytes = cyclic.emit(None);
        prop_assert_eq!(Cyclic::parse(&bytes), Ok(cyclic));
    }

    /// Both ends refuse or ignore damaged messages.
    #[test]
    fn survives_damaged_exchanges(at in 0usize..200, with in any::<u8>(), cut in 0usize..200) {
        let world = World::open(setup(), settings(), "");
        let now = world.now;
        let damaged = |bytes: &[u8]| {
            let mut bytes = bytes.to_vec();
            if let Some(byte) = bytes.get_mut(at) {
                *byte = with;
            }
            bytes.truncate(cut.max(24));
            bytes
        };
        let mut adapter = Adapter::new(setup(), Mirror::default());
        adapter.connected(1, ORIGINATOR_ADDRESS);
        let target = SocketAddrV4::new(Ipv4Addr::LOCALHOST, 1);
        let numbers = Arc::new(Identifiers::new(0x0506_0708, 0x0101, 0x1000));
        let mut originator = Originator::new(target, 2222, settings(), numbers).unwrap();
        while originator.poll(now).is_some() {}
        originator.connected(now);
        for (out, frame) in &world.frames {
            if *out {
                adapter.received(now, 1, &damaged(frame));
            } else {
                originator.received(now, &damaged(frame));
            }
            while adapter.poll(now).is_some() {}
            while originator.poll(now).is_some() {}
        }
        for (_, image) in &world.images_out {
            adapter.receive_datagram(now, SocketAddrV4::new(ORIGINATOR_ADDRESS, 2222), &damaged(image));
            adapter.discovered(SocketAddrV4::new(ORIGINATOR_ADDRESS, 2222), &damaged(image));
            if let Ok(datagram) = Cyclic::parse(&damaged(image)) {
                originator.receive_datagram(now + MS, 2222, &datagram);
            }
        }
        let later = now + Duration::from_secs(60);
        while adapter.poll(later).is_some() {}
    }
}

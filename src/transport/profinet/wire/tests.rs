//! Tests with a complete connection byte by byte, with frames of a real controller, and with random bytes.

use proptest::prelude::*;

use super::alarm::{Acknowledgement, Notification, Pdu, Rta};
use super::block::{self, BlockType, Control};
use super::connect::{
    ADVANCED, AlarmCr, Ar, DataDescription, ExpectedModule, ExpectedSubmodule, Iocr, ModuleDiff, Offset, Request,
    Response, SubmoduleDiff,
};
use super::cyclic::Cyclic;
use super::dcp::Dcp;
use super::frame::{ETHER_TYPE, Frame, TAG_HIGH, id};
use super::record::{self, Im0, Parameter, RealModule, Record, index};
use super::rpc::{self, Call, Datagram, Kind, Reply, operation};
use super::{ByteOrder, Mac, Uuid};
use crate::testing::hex;

/// Length of the Ethernet, IPv4 and UDP headers.
const UDP_PAYLOAD: usize = 42;

fn uuid() -> Uuid {
    Uuid(hex("11111111222233334444555555555555").try_into().unwrap())
}

fn iocr(kind: u16, frame_id: u16, objects: &[(u16, u16, u16)], consumers: &[(u16, u16, u16)]) -> Request {
    let places = |list: &[(u16, u16, u16)]| {
        list.iter().map(|(slot, subslot, offset)| Offset { slot: *slot, subslot: *subslot, offset: *offset }).collect()
    };
    Request::Iocr(Iocr {
        kind,
        reference: kind,
        ether_type: ETHER_TYPE,
        properties: 2,
        length: 0x35,
        frame_id,
        send_clock: 32,
        ratio: 16,
        phase: 1,
        sequence: 0,
        offset: u32::MAX,
        watchdog: 6,
        data_hold_factor: 6,
        tag: TAG_HIGH,
        group: Mac::default(),
        objects: places(objects),
        consumers: places(consumers),
    })
}

fn submodule(subslot: u16, ident: u32, properties: u16, direction: u16, length: u16) -> ExpectedSubmodule {
    let data = vec![DataDescription { direction, length, consumer: 1, provider: 1 }];
    ExpectedSubmodule { subslot, ident, properties, data }
}

fn module(slot: u16, ident: u32, submodules: Vec<ExpectedSubmodule>) -> Request {
    Request::Expected(vec![ExpectedModule { api: 0, slot, ident, submodules }])
}

/// The blocks of Connect are from the worked example in the notes.
fn example() -> (Vec<Request>, Vec<u8>) {
    let requests = vec![
        Request::Ar(Ar {
            kind: 1,
            uuid: uuid(),
            session_key: 1,
            mac: Mac([2, 0, 0, 0, 0, 1]),
            object: rpc::object(1, 1, 0xFFFF),
            properties: ADVANCED,
            activity_timeout: 600,
            port: ETHER_TYPE,
            name: "armctl".to_owned(),
        }),
        iocr(1, 0x8001, &[(0, 1, 0), (0, 0x8000, 1), (0, 0x8001, 2), (1, 1, 3)], &[(2, 1, 0x34)]),
        iocr(2, 0xFFFF, &[(2, 1, 0)], &[(0, 1, 0x31), (0, 0x8000, 0x32), (0, 0x8001, 0x33), (1, 1, 0x34)]),
        Request::AlarmCr(AlarmCr::with_defaults(1)),
        module(
            0,
            1,
            vec![submodule(1, 1, 0, 1, 0), submodule(0x8000, 0x8000, 0, 1, 0), submodule(0x8001, 0x8001, 0, 1, 0)],
        ),
        module(1, 0x101, vec![submodule(1, 1, 1, 1, 48)]),
        module(2, 0x102, vec![submodule(1, 1, 2, 2, 48)]),
    ];
    let bytes = hex(concat!(
        "0101 003C 0100 0001 11111111222233334444555555555555 0001 020000000001",
        "DEA000006C9711D18271 0001 0001 FFFF 40000011 0258 8892 0006 61726D63746C",
        "0102 0050 0100 0001 0001 8892 00000002 0035 8001 0020 0010 0001 0000 FFFFFFFF 0006 0006 C000 000000000000",
        "0001 00000000 0004 0000 0001 0000  0000 8000 0001  0000 8001 0002  0001 0001 0003",
        "0001 0002 0001 0034",
        "0102 0050 0100 0002 0002 8892 00000002 0035 FFFF 0020 0010 0001 0000 FFFFFFFF 0006 0006 C000 000000000000",
        "0001 00000000 0001 0002 0001 0000",
        "0004 0000 0001 0031  0000 8000 0032  0000 8001 0033  0001 0001 0034",
        "0103 0016 0100 0001 8892 00000000 0001 0003 0001 00C8 C000 A000",
        "0104 003C 0100 0001 00000000 0000 00000001 0000 0003  0001 00000001 0000 0001 0000 01 01",
        "8000 00008000 0000 0001 0000 01 01  8001 00008001 0000 0001 0000 01 01",
        "0104 0020 0100 0001 00000000 0001 00000101 0000 0001  0001 00000001 0001 0001 0030 01 01",
        "0104 0020 0100 0001 00000000 0002 00000102 0000 0001  0001 00000001 0002 0002 0030 01 01",
    ));
    (requests, bytes)
}

#[test]
fn connect_is_as_in_the_example() {
    let (requests, bytes) = example();
    assert_eq!(bytes.len(), 394);
    assert_eq!(requests.iter().flat_map(Request::emit).collect::<Vec<_>>(), bytes);
    assert_eq!(Request::parse_all(&bytes), Ok(requests));
}

#[test]
fn the_answer_to_connect_is_as_in_the_example() {
    let bytes = hex(concat!(
        "8101 001E 0100 0001 11111111222233334444555555555555 0001 020000000002 8892",
        "8102 0008 0100 0001 0001 8001 8102 0008 0100 0002 0002 8002",
        "8103 0008 0100 0001 0000 00C8 8106 000C 0100 0008 797263782D73696D",
    ));
    assert_eq!(bytes.len(), 0x56);
    let responses = [
        Response::Ar { uuid: uuid(), session_key: 1, mac: Mac([2, 0, 0, 0, 0, 2]) },
        Response::Iocr { kind: 1, reference: 1, frame_id: 0x8001 },
        Response::Iocr { kind: 2, reference: 2, frame_id: 0x8002 },
        Response::AlarmCr { reference: 0, max_len: 200 },
        Response::Name("yrcx-sim".to_owned()),
    ];
    assert_eq!(Response::parse_all(&bytes).unwrap(), responses);
    assert_eq!(responses.iter().flat_map(Response::emit).collect::<Vec<_>>(), bytes);
}

/// The frames are from the worked example, and from the section on cyclic frames in the notes.
#[test]
fn cyclic_frames_are_as_in_the_example() {
    let image = [7; 48];
    let data = [&image[..], &hex("80 80 80 80 80")].concat();
    let payload = Cyclic { data: &data, counter: 0xBC00, status: 0x35, transfer: 0 }.emit();
    let frame = Frame {
        destination: Mac([2, 0, 0, 0, 0, 2]),
        source: Mac([2, 0, 0, 0, 0, 1]),
        tag: Some(TAG_HIGH),
        id: 0x8002,
        payload: &payload,
    };
    let printed =
        [hex("020000000002 020000000001 8100 C000 8892 8002"), image.to_vec(), hex("80 80 80 80 80 BC00 35 00")]
            .concat();
    assert_eq!(frame.emit(), printed);
    assert_eq!(printed.len(), 77);
}

#[test]
fn records_are_as_in_the_example() {
    let read = Record { sequence: 1, ar: uuid(), api: 0, slot: 0, subslot: 1, index: index::IM0, length: 0x400 };
    let printed = hex(concat!(
        "0009 003C 0100 0001 11111111222233334444555555555555 00000000 0000 0001 0000 AFF0 00000400",
        "000000000000000000000000000000000000000000000000",
    ));
    assert_eq!(read.emit(BlockType::READ, 0, &[]), printed);
    assert_eq!(Record::parse(&printed, BlockType::READ), Ok((read, &[][..])));
    let im0 = Im0 {
        vendor: 0xFFFF,
        order_id: "RCX340".to_owned(),
        serial: "1".to_owned(),
        hardware: 1,
        software: ('V', 1, 2, 3),
        revision: 0,
    };
    let record = im0.emit();
    assert_eq!(record.len(), 60);
    assert_eq!(Im0::parse(&record), Ok(im0));
    let answer = Record { length: 60, ..read }.emit(BlockType::READ.answer(), 0, &record);
    assert_eq!(Record::parse_answer(&answer), Ok((Record { length: 60, ..read }, &record[..])));
}

#[test]
fn modules_round_trip() {
    let modules = vec![
        RealModule { slot: 0, ident: 1, submodules: vec![(1, 1), (0x8000, 0x8000)] },
        RealModule { slot: 1, ident: 0x101, submodules: vec![(1, 1)] },
    ];
    let record = record::emit_identification(&modules);
    assert_eq!(record[..12], hex("0013 002C 0101 0001 00000000")[..]);
    assert_eq!(record::parse_identification(&record), Ok(modules));
    let old = hex("0013 0012 0100 0001 0003 00000040 0001 0001 00000002");
    let read = vec![RealModule { slot: 3, ident: 0x40, submodules: vec![(1, 2)] }];
    assert_eq!(record::parse_identification(&old), Ok(read));
}

#[test]
fn module_differences_round_trip() {
    let bytes = hex("8104 001C 0100 0001 00000000 0001 0001 00000040 0001 0001 0001 00000001 9000");
    let submodules = vec![SubmoduleDiff { subslot: 1, ident: 1, state: 0x9000 }];
    let diff = Response::ModuleDiff(vec![ModuleDiff { slot: 1, ident: 0x40, state: 1, submodules }]);
    assert_eq!(diff.emit(), bytes);
    assert_eq!(Response::parse_all(&bytes).unwrap(), [diff]);
    for (state, usable) in
        [(0x8000, true), (0x8800, true), (0x9000, false), (0x9800, false), (0, false), (1, false), (2, true)]
    {
        assert_eq!(SubmoduleDiff { subslot: 1, ident: 1, state }.is_usable(), usable, "{state:#x}");
    }
}

#[test]
fn single_and_multiple_writes_round_trip() {
    let parameter = |index, data: &[u8]| Parameter { slot: 1, subslot: 1, index, data: data.to_vec() };
    for parameters in [vec![parameter(1, &[1])], vec![parameter(1, &[1]), parameter(2, &[1, 2, 3, 4, 5])]] {
        let bytes = record::write(uuid(), 3, &parameters);
        let (outer, read) = record::parse_write(&bytes).unwrap();
        assert_eq!((outer.sequence, read), (3, parameters.clone()));
        let statuses: Vec<_> =
            parameters.iter().map(|parameter| (Record { index: parameter.index, ..outer }, 0xDF80_B800)).collect();
        let answer = record::parse_write_answer(&record::write_answer(&outer, &statuses)).unwrap();
        assert_eq!(answer.last().map(|(_, status)| *status), Some(0xDF80_B800));
        assert_eq!(answer.len(), if parameters.len() == 1 { 1 } else { 3 });
    }
}

/// Reads a recorded frame.
fn recorded(name: &str) -> Vec<u8> {
    let all = include_str!("pnio-frames.txt");
    let (_, rest) = all.split_once(&format!("= {name}\n")).expect(name);
    hex(rest.split('=').next().unwrap_or_default())
}

#[test]
fn a_real_controllers_connect_is_read_and_written_back() {
    let frame = recorded("connect_req");
    let datagram = Datagram::parse(&frame[UDP_PAYLOAD..]).unwrap();
    assert_eq!((datagram.header.order, datagram.header.kind), (ByteOrder::Little, Kind::REQUEST));
    assert_eq!(datagram.header.interface, rpc::DEVICE);
    assert_eq!(datagram.header.object, rpc::object(1, 2, 0x493));
    assert_eq!(datagram.emit(), frame[UDP_PAYLOAD..], "byte for byte, in its order");
    let call = Call::parse(datagram.body, ByteOrder::Little).unwrap();
    let requests = Request::parse_all(call.blocks).unwrap();
    let counts = requests.iter().fold([0; 5], |mut counts, request| {
        counts[match request {
            Request::Ar(_) => 0,
            Request::Iocr(_) => 1,
            Request::AlarmCr(_) => 2,
            Request::Expected(_) => 3,
            Request::Other(_) => 4,
        }] += 1;
        counts
    });
    assert_eq!((counts[0], counts[1], counts[2], counts[4]), (1, 2, 1, 0));
    assert!(counts[3] >= 4, "one block for each slot");
    assert_eq!(requests.iter().flat_map(Request::emit).collect::<Vec<_>>(), call.blocks);
    let Request::Ar(ar) = &requests[0] else { panic!("{requests:?}") };
    assert_eq!((ar.activity_timeout, ar.properties), (200, ADVANCED));
}

#[test]
fn recorded_answers_are_read_and_written_back() {
    for name in ["connect_res", "prmend_res", "appready_res", "write_res", "im0_read_res", "im0_read_res_if"] {
        let frame = recorded(name);
        let bytes = &frame[UDP_PAYLOAD..];
        let datagram = Datagram::parse(bytes).unwrap();
        assert_eq!(datagram.header.kind, Kind::RESPONSE, "{name}");
        assert_eq!(datagram.emit(), bytes, "{name}");
        let reply = Reply::parse(datagram.body, datagram.header.order).unwrap();
        assert_eq!(reply.status, 0, "{name}");
        match name {
            "connect_res" => {
                let responses = Response::parse_all(reply.blocks).unwrap();
                assert_eq!(responses.iter().flat_map(Response::emit).collect::<Vec<_>>(), reply.blocks);
                assert!(responses.contains(&Response::Iocr { kind: 2, reference: 2, frame_id: 0x8001 }));
                assert!(responses.contains(&Response::Name("rt-labs-dev".to_owned())));
            }
            "write_res" => {
                let all = record::parse_write_answer(reply.blocks).unwrap();
                assert!(all.len() > 2 && all.iter().all(|(_, status)| *status == 0), "{all:?}");
            }
            "im0_read_res" | "im0_read_res_if" => {
                let (_, record) = Record::parse_answer(reply.blocks).unwrap();
                let im0 = Im0::parse(record).unwrap();
                assert_eq!((im0.vendor, im0.order_id.as_str()), (0x493, "12345 Abcdefghijk"));
            }
            _ => {
                let blocks = block::walk(reply.blocks).unwrap();
                let control = Control::parse(&blocks[0]).unwrap();
                assert_eq!(control.command, Control::DONE);
                assert_eq!(control.emit(), reply.blocks);
            }
        }
    }
}

#[test]
fn recorded_calls_are_read_and_written_back() {
    for name in ["prmend_req", "appready_req", "write_req", "im0_read_req", "im0_read_req_if"] {
        let frame = recorded(name);
        let bytes = &frame[UDP_PAYLOAD..];
        let datagram = Datagram::parse(bytes).unwrap();
        assert_eq!(datagram.emit(), bytes, "{name}");
        let call = Call::parse(datagram.body, datagram.header.order).unwrap();
        match datagram.header.operation {
            operation::CONTROL => {
                let blocks = block::walk(call.blocks).unwrap();
                let control = Control::parse(&blocks[0]).unwrap();
                assert_eq!(control, Control::call(control.kind, control.ar, control.session_key));
            }
            operation::WRITE => {
                let (outer, parameters) = record::parse_write(call.blocks).unwrap();
                assert_eq!((outer.index, parameters.len()), (index::MULTIPLE_WRITE, 4));
                assert_eq!((parameters[1].slot, parameters[1].index, parameters[1].data.len()), (3, 0x7B, 4));
                // The length in the outer block is correct, so the call that is encoded again must equal the recorded
                // call.
                assert_eq!(record::write(outer.ar, outer.sequence, &parameters), call.blocks);
            }
            _ => {
                let (record, _) = Record::parse(call.blocks, BlockType::READ).unwrap();
                assert_eq!(record.index, index::IM0);
            }
        }
    }
}

#[test]
fn recorded_alarms_are_read_and_written_back() {
    for (name, is_alarm) in [
        ("alarm_diag_notif", true),
        ("alarm_process_notif", true),
        ("alarm_diag_std_remove", true),
        ("alarm_diag_usi_disappears", true),
        ("alarm_diag_ack_cpu", false),
        ("alarm_ack_high_cpu", false),
    ] {
        let bytes = recorded(name);
        let frame = Frame::parse(&bytes).unwrap();
        let rta = Rta::parse(frame.payload).unwrap();
        // The recording contains the frames of a device as they are before the network card pads them.
        assert_eq!(Frame { payload: &rta.emit(), ..frame }.emit()[..bytes.len()], bytes, "{name}");
        let Pdu::Data(data) = &rta.pdu else { panic!("{name}: {rta:?}") };
        if is_alarm {
            assert_eq!(Notification::parse(data).unwrap().emit(), *data, "{name}");
        } else {
            assert_eq!(Acknowledgement::parse(data).unwrap().emit(), *data, "{name}");
        }
    }
    for name in ["alarm_ack_rta_low_cpu", "alarm_ack_rta_high_cpu", "alarm_ack_rta_low_dev"] {
        let bytes = recorded(name);
        assert_eq!(Rta::parse(Frame::parse(&bytes).unwrap().payload).unwrap().pdu, Pdu::Ack, "{name}");
    }
    for (name, reason) in [("alarm_err_rta_cpu", 0x0B), ("alarm_err_rta_cpu_removed", 0x11)] {
        let bytes = recorded(name);
        let pdu = Rta::parse(Frame::parse(&bytes).unwrap().payload).unwrap().pdu;
        assert_eq!(pdu, Pdu::Error(super::status::Status::abort(reason).0), "{name}");
    }
}

#[test]
fn recorded_cyclic_frames_and_stations_are_read() {
    for (name, frame_id, length) in
        [("rtc_cpu_8001", 0x8001, 40), ("rtc_dev_8000", 0x8000, 40), ("echo_cpu_8001", 0x8001, 40)]
    {
        let bytes = recorded(name);
        let frame = Frame::parse(&bytes).unwrap();
        assert_eq!((frame.id, frame.tag), (frame_id, Some(TAG_HIGH)), "{name}");
        let cyclic = Cyclic::parse(frame.payload, length).unwrap();
        assert!(cyclic.is_usable(), "{name}: {cyclic:?}");
        assert_eq!(Frame { payload: &cyclic.emit(), ..frame }.emit(), bytes, "{name}");
    }
    let bytes = recorded("ident_ok_pnet");
    let frame = Frame::parse(&bytes).unwrap();
    assert_eq!(frame.id, id::DCP_IDENTIFIED);
    let station = Dcp::parse(frame.payload).unwrap().station().unwrap();
    assert_eq!(station.id, Some((0x493, 2)));
    assert!(!station.name.is_empty());
    for name in ["dcp_set_req", "dcp_set_res"] {
        let bytes = recorded(name);
        let frame = Frame::parse(&bytes).unwrap();
        let payload = Dcp::parse(frame.payload).unwrap().emit();
        let written = Frame { payload: &payload, ..frame }.emit();
        assert_eq!(written[..bytes.len()], bytes, "{name}");
    }
}

/// Runs all decoders on these bytes.
fn read_as_everything(bytes: &[u8]) {
    if let Ok(frame) = Frame::parse(bytes) {
        frame.emit();
    }
    if let Ok(dcp) = Dcp::parse(bytes) {
        let _ = dcp.station();
        dcp.outcomes();
        dcp.emit();
    }
    if let Ok(datagram) = Datagram::parse(bytes) {
        datagram.emit();
    }
    for order in [ByteOrder::Big, ByteOrder::Little] {
        let _ = Call::parse(bytes, order);
        let _ = Reply::parse(bytes, order);
    }
    for block in block::walk(bytes).unwrap_or_default() {
        let _ = Control::parse(&block);
    }
    let _ = Request::parse_all(bytes).map(|all| all.iter().flat_map(Request::emit).count());
    let _ = Response::parse_all(bytes).map(|all| all.iter().flat_map(Response::emit).count());
    let _ = record::parse_write(bytes);
    let _ = record::parse_write_answer(bytes);
    let _ = Record::parse_answer(bytes);
    let _ = Im0::parse(bytes);
    let _ = record::parse_identification(bytes);
    if let Ok(rta) = Rta::parse(bytes) {
        rta.emit();
    }
    let _ = Notification::parse(bytes).map(|alarm| alarm.describe());
    let _ = Acknowledgement::parse(bytes);
    let _ = Cyclic::parse(bytes, 40);
}

proptest! {
    #[test]
    fn any_bytes_are_read_without_a_panic(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        read_as_everything(&bytes);
    }

    /// Real frames, with one changed byte or cut. The decoders read more of such a frame than of random bytes.
    #[test]
    fn damaged_messages_are_read_without_a_panic(at in 0usize..700, value in any::<u8>(), cut in 0usize..700, which in 0usize..5) {
        let name = ["connect_req", "connect_res", "write_req", "alarm_diag_notif", "im0_read_res"][which];
        let frame = recorded(name);
        for skip in [0, 18, UDP_PAYLOAD, UDP_PAYLOAD + 80, UDP_PAYLOAD + 100] {
            let mut bytes = frame.get(skip..).unwrap_or_default().to_vec();
            if let Some(byte) = bytes.get_mut(at) {
                *byte = value;
            }
            read_as_everything(&bytes);
            bytes.truncate(cut);
            read_as_everything(&bytes);
        }
    }
}

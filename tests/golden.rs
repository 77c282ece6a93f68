//! Golden frames of the YERC family, from the FS100 and DX200 manuals (`data/yerc-frames.json` cites the section of
//! each).
//!
//! Client frames are built from typed values and compared byte by byte with the golden frames. Controller frames are
//! parsed into typed values, compared with the expected values, and written again. If a test fails, the code is wrong:
//! do not change the bytes.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]
#![expect(clippy::needless_pass_by_value, reason = "queries are built where they are sent")]

use std::collections::{BTreeMap, BTreeSet};

use armctl_controller::units;
use armctl_controller::yerc::Model::{self, Dx200, Fs100};
use armctl_controller::yerc::describe::{Sender, describe, summary};
use armctl_controller::yerc::files::{self, FileName, FileType};
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::{
    Alarm, AlarmKind, AlarmTexts, Axes, AxisNames, BasePosition, CartesianMove, ControllerStatus, CycleMode,
    ExtendedForm, ExternalPosition, Form, ManagementTime, MoveLayout, Pose, Position, PositionKind, PulseMove, Speed,
    SpeedClass, StatusBit, SystemInfo, Text,
};
use armctl_controller::yerc::query::{
    CancelError, Coordinates, Hold, MoveCartesian, MoveKind, MovePulse, Query, QueryError, ReadAlarm, ReadAxes,
    ReadField, ReadIo, ReadIoGroups, ReadManagementTime, ReadPosition, ReadPositionError, ReadStatus, ReadSystemInfo,
    ReadTorque, ReadVariable, ReadVariables, ResetAlarm, Say, SelectJob, Selection, Servo, SetCycle, SystemPart,
    TimeCounter, WriteField, WriteIo, WriteIoGroups, WriteRegister, WriteRegisters, WriteVariable, WriteVariables,
};
use armctl_controller::yerc::request::{Request, RequestError};
use armctl_controller::yerc::table::service;
use armctl_controller::yerc::variables::{Value, VariableKind};
use armctl_controller::yerc::wire::{AnswerFrame, LAST_BLOCK, RequestFrame, Status, WireError};
use serde_json::Value as Json;

const COUNT: usize = 109;

#[test]
fn every_vector_has_a_typed_case() {
    let vectors = vectors();
    assert_eq!(vectors.len(), COUNT);
    let cases: Vec<&str> = client_frames()
        .into_iter()
        .map(|case| case.0)
        .chain(controller_frames().into_iter().map(|case| case.0))
        .chain(invalid_frames().into_iter().map(|case| case.0))
        .collect();
    let distinct: BTreeSet<&str> = cases.iter().copied().collect();
    assert_eq!(distinct.len(), cases.len(), "a vector has two cases");
    assert_eq!(distinct, vectors.keys().map(String::as_str).collect());
}

#[test]
fn builds_client_frames_from_typed_values() {
    let vectors = vectors();
    for (id, frame) in client_frames() {
        let bytes = vectors[id].bytes();
        assert_eq!(hex(&frame), hex(&bytes), "{id}");
        let parsed = RequestFrame::parse(&bytes).unwrap();
        assert_eq!(parsed.emit(), bytes, "{id}");
        check_header(id, &vectors[id], parsed.data.len(), parsed.ack, parsed.id, parsed.block);
        let fields = &vectors[id].0["fields"];
        assert_eq!(number(&fields["command"]), u64::from(parsed.command), "{id}");
        assert_eq!(number(&fields["instance"]), u64::from(parsed.instance), "{id}");
        assert_eq!(number(&fields["attribute"]), u64::from(parsed.attribute), "{id}");
        assert_eq!(number(&fields["service"]), u64::from(parsed.service), "{id}");
        if !parsed.ack {
            assert_eq!(request_of(&parsed).check(vectors[id].model()), Ok(()), "{id}");
        }
        explain(id, &bytes, Sender::Client);
    }
}

#[test]
fn parses_controller_frames_into_typed_values() {
    let vectors = vectors();
    for (id, expected) in controller_frames() {
        let bytes = vectors[id].bytes();
        let parsed = AnswerFrame::parse(&bytes).unwrap_or_else(|error| panic!("{id}: {error}"));
        check_header(id, &vectors[id], parsed.data.len(), parsed.ack, parsed.id, parsed.block);
        let fields = &vectors[id].0["fields"];
        assert_eq!(number(&fields["service"]), u64::from(parsed.service), "{id}");
        assert_eq!(number(&fields["status"]), u64::from(parsed.status.code), "{id}");
        assert_eq!(number(&fields["added_status_size"]), u64::from(parsed.status.added_size), "{id}");
        assert_eq!(number(&fields["added_status"]), u64::from(parsed.status.added), "{id}");
        assert_eq!((parsed.block, parsed.status), (expected.block, expected.status), "{id}");
        let data = (expected.read)(parsed.data);
        assert_eq!(hex(&AnswerFrame { data: &data, ..parsed }.emit()), hex(&bytes), "{id}");
        explain(id, &bytes, Sender::Controller);
    }
}

#[test]
fn refuses_invalid_frames() {
    let vectors = vectors();
    for (id, refusal) in invalid_frames() {
        let bytes = vectors[id].bytes();
        let sender = if id == "M02p" { Sender::Controller } else { Sender::Client };
        match refusal {
            Refusal::Parse(error) if sender == Sender::Controller => {
                assert_eq!(AnswerFrame::parse(&bytes), Err(error), "{id}");
            }
            Refusal::Parse(error) => assert_eq!(RequestFrame::parse(&bytes), Err(error), "{id}"),
            Refusal::Check(matches) => {
                let frame = RequestFrame::parse(&bytes).unwrap();
                for model in Model::ALL {
                    let error = request_of(&frame).check(model).unwrap_err();
                    assert!(matches(&error), "{id}: {error}");
                }
            }
        }
        assert!(!summary(&bytes, sender, None).is_empty());
        let explained = describe(&bytes, sender, None);
        if matches!(refusal, Refusal::Parse(_)) {
            assert!(explained.problem.is_some(), "{id}");
        }
    }
}

/// Text of both job files in the M vectors. It is padded to complete blocks.
fn job_text(lines: usize, size: usize) -> Vec<u8> {
    let mut text = b"/JOB\r\n//NAME TESTJOB\r\n//INST\r\n///ATTR SC,RW\r\n///GROUP1 RB1\r\nNOP\r\n".to_vec();
    for line in 0..lines {
        text.extend_from_slice(format!("'LINE {line:04}\r\n").as_bytes());
    }
    text.resize(size, b' ');
    text
}

const JOB_END: &[u8] = b"   END\r\n";

fn name(text: &str) -> FileName {
    FileName::new(text).unwrap()
}

fn send(id: u8, query: impl Query) -> Vec<u8> {
    query.request().frame(id)
}

fn write(number: u16, value: Value) -> WriteVariable {
    WriteVariable::new(number, value).unwrap()
}

fn field(command: u16, instance: u16, attribute: u8) -> ReadField {
    let model = if command == 0x73 { Fs100 } else { Dx200 };
    ReadField::new(model, command, instance, attribute).unwrap()
}

fn position(kind: PositionKind, user: u32, axes: [i32; 8]) -> Position {
    Position { kind, form: Form(0), tool: 0, user, extended: ExtendedForm(0), axes: Axes::full(axes) }
}

/// Id of each client frame, and the frame built from typed values.
fn client_frames() -> Vec<(&'static str, Vec<u8>)> {
    // Only the outline in 3.2.2 shows this form of a register write; 3.3.10 differs, and no query builds this form.
    let outline = Request { command: 0x79, instance: 10, attribute: 0, service: 2, data: vec![0x34, 0x12] };
    let mut frames = vec![
        ("M01", send(0, ReadStatus)),
        ("M03", outline.frame(1)),
        ("M03t", send(1, WriteRegister::new(Dx200, 10, 0x1234).unwrap())),
        ("M05", name("TESTJOB.JBI").save().frame(2)),
        ("M07", files::ack_frame(3, service::SAVE, 1)),
        ("M09", files::ack_frame(3, service::SAVE, 2)),
        ("M11", files::ack_frame(4, service::SAVE, LAST_BLOCK + 3)),
        ("M12", name("TESTJOB.JBI").load().frame(5)),
        ("M14", files::data_frame(6, 1, &job_text(34, 479))),
        ("M16", files::data_frame(7, LAST_BLOCK + 2, JOB_END)),
        ("M18", files::list(FileType::Jbi).frame(8)),
        ("M20", files::ack_frame(8, service::LIST, 1)),
        ("M22", files::ack_frame(9, service::LIST, 2)),
        ("M24", files::ack_frame(7, service::LIST, LAST_BLOCK + 3)),
        ("M24c", files::ack_frame(10, service::LIST, LAST_BLOCK + 3)),
        ("M26", name("TESTJOB.JBI").delete().frame(11)),
    ];
    frames.extend(read_frames());
    frames.extend(write_frames());
    frames.extend(order_frames());
    frames.extend([("R83", files::list(FileType::Dat).frame(2)), ("R85", files::batch_backup().frame(4))]);
    frames
}

fn read_frames() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("R01", send(1, ReadAlarm::new(1, false).unwrap())),
        ("R03", send(3, field(0x70, 4, 5))),
        ("R05", send(5, field(0x71, 3100, 4))),
        ("R07", send(7, field(0x72, 1, 2))),
        ("R09", send(9, field(0x73, 6, 2))),
        ("R11", send(11, ReadAxes::new(Fs100, Group::R1, Coordinates::Pulse).unwrap())),
        ("R13", send(13, ReadPosition::new(Fs100, Group::R1, Coordinates::Base).unwrap())),
        ("R15", send(15, ReadPositionError::new(Fs100, Group::R1).unwrap())),
        ("R17", send(17, ReadIo::new(Fs100, 1001).unwrap())),
        ("R53", send(53, ReadManagementTime::new(Fs100, TimeCounter::Application(1)).unwrap())),
        ("R55", send(55, ReadSystemInfo::new(Fs100, SystemPart::Group(Group::R1)).unwrap())),
        ("R57", send(57, ReadIoGroups::new(Dx200, 1, 474).unwrap())),
        ("R63", send(63, ReadVariables::new(VariableKind::B, 10, 2).unwrap())),
        ("R71", send(71, ReadVariables::new(VariableKind::Ex, 0, 13).unwrap())),
        ("R73", send(73, field(0x30B, 1, 7))),
        ("R81", send(0, ReadStatus)),
    ]
}

fn write_frames() -> Vec<(&'static str, Vec<u8>)> {
    let pulses = position(PositionKind::Pulse, 0, [1000, -2000, 3000, -4000, 5000, -6000, 0, 0]);
    let in_user = position(PositionKind::User, 2, [1, 2, 3, 4, 5, 6, 0, 0]);
    let external = ExternalPosition { kind: PositionKind::Pulse, axes: Axes::full([100, 200, 0, 0, 0, 0, 0, 0]) };
    let duplicates = (0..118).map(|n| Value::Double(n * 1000)).collect();
    let short = |n| Value::Short(Text::new(format!("STR{n:02}").as_bytes()).unwrap());
    let long = |n| Value::Long(Text::new(format!("LONG STRING {n:02}").as_bytes()).unwrap());
    let fan = |n| Value::Position(position(PositionKind::Pulse, 0, [n, -n, 2 * n, -2 * n, 3 * n, -3 * n, 0, 0]));
    vec![
        ("R19", send(19, WriteIo::new(Dx200, 2956, 0xA5).unwrap())),
        ("R21", send(21, WriteRegister::new(Fs100, 559, 65535).unwrap())),
        ("R23", send(23, write(99, Value::Byte(255)))),
        ("R25", send(25, write(5, Value::Integer(-2)))),
        ("R27", send(27, write(3, Value::Real(1.5)))),
        ("R29", send(29, write(7, Value::Short(Text::new(b"HELLO").unwrap())))),
        ("R31", send(31, write(1, Value::Position(pulses)))),
        ("R33", send(33, write(3, Value::Position(in_user)))),
        ("R35", send(35, WriteField::new(VariableKind::Bp, 5, 2, (-1_i32).to_le_bytes()).unwrap())),
        ("R37", send(37, write(10, Value::External(external)))),
        ("R59", send(59, WriteIoGroups::new(Fs100, 2501, vec![0x01, 0x80]).unwrap())),
        ("R61", send(61, WriteRegisters::new(Fs100, 100, vec![100, 200, 300]).unwrap())),
        ("R65", send(65, WriteVariables::new(0, duplicates).unwrap())),
        ("R67", send(67, WriteVariables::new(0, (0..29).map(short).collect()).unwrap())),
        ("R69", send(69, WriteVariables::new(0, (0..9).map(fan).collect()).unwrap())),
        ("R79", send(79, WriteVariables::new(0, (0..14).map(long).collect()).unwrap())),
    ]
}

fn straight_move() -> CartesianMove {
    let target = Pose {
        x: "185.000".parse().unwrap(),
        z: "125.000".parse().unwrap(),
        tx: "180.0000".parse().unwrap(),
        ..Pose::default()
    };
    let speed = Speed::Linear("70.0".parse().unwrap());
    let robot = CartesianMove::of_robot(1, PositionKind::Base, target, speed);
    CartesianMove { layout: MoveLayout::Words26, tool: 1, ..robot }
}

#[test]
fn reserved_bits_of_a_move_are_refused() {
    let form = CartesianMove { form: Form(1 << 31), ..straight_move() };
    let extended = CartesianMove { extended: ExtendedForm(1 << 31), ..straight_move() };
    for target in [form, extended] {
        let refused = MoveCartesian::new(Dx200, MoveKind::Straight, target);
        assert!(matches!(refused, Err(QueryError::Reserved { bits: 0x8000_0000, .. })), "{refused:?}");
    }
}

fn order_frames() -> Vec<(&'static str, Vec<u8>)> {
    // Full-width characters in the language of the pendant. They mean "robot stopped".
    let message = b"\x83\x8d\x83\x7b\x83\x62\x83\x67\x92\xe2\x8e\x7e";
    let straight = straight_move();
    let link = PulseMove {
        robot: 1,
        station: 0,
        class: SpeedClass::Percent,
        speed: units::PERCENT.parse("10.00").unwrap().unsigned_abs(),
        axes: [0, 0, 0, 0, -90_000, 0, 0, 0],
        tool: 0,
        base: [0; 3],
        station_axes: [0; 6],
    };
    vec![
        ("R39", send(39, CancelError)),
        ("R41", send(41, Hold(false))),
        ("R43", send(43, Servo(false))),
        ("R45", send(45, SetCycle(CycleMode::Step))),
        ("R47", send(47, SetCycle(CycleMode::Continuous))),
        ("R49", send(49, Say::new(message).unwrap())),
        ("R51", send(51, SelectJob::new(Fs100, b"TESTJOB", Selection::Execute { line: 10 }).unwrap())),
        ("R75", send(75, MoveCartesian::new(Dx200, MoveKind::Straight, straight).unwrap())),
        ("R77", send(77, MovePulse::new(Dx200, MoveKind::Link, link).unwrap())),
    ]
}

type Read = Box<dyn Fn(&[u8]) -> Vec<u8>>;

/// Expected content of a controller frame.
struct Expected {
    block: u32,
    status: Status,
    /// Parses the data, asserts its value, and writes the data again.
    read: Read,
}

fn answer(read: impl Fn(&[u8]) -> Vec<u8> + 'static) -> Expected {
    Expected { block: LAST_BLOCK, status: Status::OK, read: Box::new(read) }
}

/// Answer to a successful write. It has no data.
fn acknowledgement(query: impl Query<Answer = ()> + 'static) -> Expected {
    answer(move |data| {
        query.decode(data).unwrap();
        Vec::new()
    })
}

fn without_data(block: u32, status: Status) -> Expected {
    let read = Box::new(|data: &[u8]| {
        assert!(data.is_empty());
        Vec::new()
    });
    Expected { block, status, read }
}

fn file_data(block: u32, content: Vec<u8>) -> Expected {
    let read = Box::new(move |data: &[u8]| {
        assert_eq!(data.escape_ascii().to_string(), content.escape_ascii().to_string());
        content.clone()
    });
    Expected { block, status: Status::OK, read }
}

/// Job names of the list in the M vectors: 69 jobs.
fn list_text() -> Vec<u8> {
    (0..69).flat_map(|n| format!("JOB{n:05}.JBI\r\n").into_bytes()).collect()
}

fn controller_frames() -> Vec<(&'static str, Expected)> {
    let refused = |code, added_size, added| without_data(LAST_BLOCK, Status { code, added_size, added });
    let (save, names) = (job_text(74, 958), list_text());
    let mut frames = vec![
        ("M02", answer(read_status)),
        ("M04", acknowledgement(WriteRegister::new(Dx200, 10, 0x1234).unwrap())),
        ("M04t", acknowledgement(WriteRegister::new(Dx200, 10, 0x1234).unwrap())),
        ("M06", file_data(1, save[..479].to_vec())),
        ("M08", file_data(2, save[479..].to_vec())),
        ("M10", file_data(LAST_BLOCK + 3, JOB_END.to_vec())),
        ("M10s", file_data(LAST_BLOCK + 3, JOB_END.to_vec())),
        ("M13", without_data(0, Status::OK)),
        ("M15", without_data(1, Status::OK)),
        ("M17", without_data(LAST_BLOCK + 2, Status::OK)),
        ("M19", file_data(1, names[..479].to_vec())),
        ("M21", file_data(2, names[479..958].to_vec())),
        ("M21s", file_data(2, names[479..958].to_vec())),
        ("M23", file_data(LAST_BLOCK + 3, names[958..].to_vec())),
        (
            "M25",
            Expected {
                block: LAST_BLOCK + 1,
                ..answer(|data| {
                    let names = files::split_list(data).unwrap();
                    assert_eq!(names, [&b"1.JBI"[..], b"22.JBI", b"333.JBI", b"TEST01.JBI"]);
                    names.into_iter().flat_map(|name| [name, b"\r\n"].concat()).collect()
                })
            },
        ),
        ("M27", without_data(LAST_BLOCK, Status::OK)),
        ("A13", acknowledgement(WriteIo::new(Dx200, 2956, 0xA5).unwrap())),
        ("A23", acknowledgement(ResetAlarm)),
        ("A29", acknowledgement(WriteIoGroups::new(Fs100, 2501, vec![1, 2]).unwrap())),
        ("A35", refused(0x08, 0, 0)),
        ("A37", refused(0x28, 0, 0)),
        ("A39", refused(0x1F, 2, 0x1010)),
        ("A41", without_data(LAST_BLOCK, Status::refused(0x2100))),
        ("A43", refused(0, 1, 0xE2A7)),
        ("A45", without_data(LAST_BLOCK, Status::OK)),
        ("A47", without_data(LAST_BLOCK, Status::refused(0x4030))),
    ];
    frames.extend(alarm_answers());
    frames.extend(read_answers());
    frames
}

fn read_status(data: &[u8]) -> Vec<u8> {
    let status = ReadStatus.decode(data).unwrap();
    let set: Vec<StatusBit> = StatusBit::all().filter(|&bit| status.has(bit)).collect();
    assert_eq!(set, [StatusBit::OneCycle, StatusBit::Play, StatusBit::CommandRemote, StatusBit::ServoOn]);
    assert_eq!(status.cycle(), Some(CycleMode::Once));
    set.into_iter().fold(ControllerStatus::default(), |status, bit| status.with(bit, true)).emit()
}

fn collision() -> Alarm {
    Alarm {
        code: 4315,
        data: 3,
        kind: AlarmKind(1),
        time: Text::new(b"2011/10/10 15:49").unwrap(),
        name: Text::new(b"COLLISION DETECT").unwrap(),
        texts: None,
    }
}

fn alarm_answers() -> Vec<(&'static str, Expected)> {
    let with_texts = Alarm {
        texts: Some(AlarmTexts {
            source: Text::new(b"[SV#1]").unwrap(),
            sub_code: Text::new(b"[R1: SLURBT, 1]").unwrap(),
            reversed: Text::new(b"0000010000").unwrap(),
        }),
        ..collision()
    };
    vec![
        (
            "A01",
            answer(|data| {
                assert_eq!(ReadAlarm::new(1, false).unwrap().decode(data), Ok(collision()));
                assert_eq!(collision().sub_code(Dx200).to_string(), "[3]");
                collision().emit()
            }),
        ),
        (
            "A03",
            answer(|data| {
                let alarm = ReadAlarm::new(4, false).unwrap().decode(data).unwrap();
                assert!(alarm.is_none());
                Alarm::default().emit()
            }),
        ),
        (
            "A33",
            answer(move |data| {
                assert_eq!(ReadAlarm::new(1, true).unwrap().decode(data).as_ref(), Ok(&with_texts));
                with_texts.emit()
            }),
        ),
    ]
}

fn read_answers() -> Vec<(&'static str, Expected)> {
    let variable = |kind, number, expected: Value| {
        answer(move |data| {
            assert_eq!(ReadVariable::new(kind, number).decode(data).as_ref(), Ok(&expected));
            expected.emit()
        })
    };
    let base = BasePosition { kind: PositionKind::Base, axes: Axes::full([1500, -2500, 3500, 0, 0, 0, 0, 0]) };
    vec![
        (
            "A05",
            answer(|data| {
                let word = field(0x72, 1, 1).decode(data).unwrap();
                let status = ControllerStatus { words: [u32::from_le_bytes(word.try_into().unwrap()), 0] };
                assert!(status.running() && status.has(StatusBit::Teach) && status.words[0].count_ones() == 2);
                status.words[0].to_le_bytes().to_vec()
            }),
        ),
        (
            "A07",
            answer(|data| {
                let mut names = AxisNames::default();
                for (name, text) in names.names.iter_mut().zip(["S", "L", "U", "R", "B", "T"]) {
                    *name = Text::new(text.as_bytes()).unwrap();
                }
                let query = ReadAxes::new(Dx200, Group::R1, Coordinates::Pulse).unwrap();
                assert_eq!(query.decode(data).as_ref(), Ok(&names));
                names.emit()
            }),
        ),
        (
            "A09",
            answer(|data| {
                let axes = Axes::new(&[1, 2, 3, 4, 5, 6]).unwrap();
                let expected = Position { axes, ..position(PositionKind::Pulse, 0, [0; 8]) };
                let query = ReadPosition::new(Dx200, Group::R1, Coordinates::Pulse).unwrap();
                assert_eq!(query.decode(data), Ok(expected));
                expected.emit_fitted()
            }),
        ),
        (
            "A11",
            answer(|data| {
                let torque = ReadTorque::new(Dx200, Group::R1).unwrap().decode(data).unwrap();
                assert_eq!(torque.as_slice(), [120, -35, 80, 2, -7, 0]);
                torque.emit()
            }),
        ),
        ("A15", variable(VariableKind::B, 0, Value::Byte(7))),
        ("A17", variable(VariableKind::D, 0, Value::Double(-123_456_789))),
        ("A19", variable(VariableKind::S16, 7, Value::Short(Text::new(b"HELLO").unwrap()))),
        ("A21", variable(VariableKind::Bp, 0, Value::Base(base))),
        (
            "A25",
            answer(|data| {
                let query = ReadManagementTime::new(Dx200, TimeCounter::Application(1)).unwrap();
                let time = query.decode(data).unwrap();
                assert_eq!(time.start.as_bytes(), b"2011/10/10 15:49");
                assert_eq!(time.seconds(), Some(123 * 3600 + 45 * 60 + 6));
                ManagementTime { start: time.start, elapsed: Text::new(b"000123:45'06").unwrap() }.emit()
            }),
        ),
        (
            "A27",
            answer(|data| {
                let expected = SystemInfo {
                    version: Text::new(b"DS2.07.00A(JP/US)-00").unwrap(),
                    name: Text::new(b"ES0165D-A0*").unwrap(),
                    parameters: Text::new(b"12.34").unwrap(),
                };
                let query = ReadSystemInfo::new(Dx200, SystemPart::Group(Group::R1)).unwrap();
                assert_eq!(query.decode(data).as_ref(), Ok(&expected));
                expected.emit()
            }),
        ),
        (
            "A31",
            answer(|data| {
                let query = ReadVariables::new(VariableKind::B, 10, 2).unwrap();
                let values = [Value::Byte(0x10), Value::Byte(0x20)];
                assert_eq!(query.decode(data).as_deref(), Ok(&values[..]));
                WriteVariables::new(10, values.to_vec()).unwrap().request().data
            }),
        ),
    ]
}

enum Refusal {
    Parse(WireError),
    Check(fn(&RequestError) -> bool),
}

fn invalid_frames() -> Vec<(&'static str, Refusal)> {
    vec![
        ("M02p", Refusal::Parse(WireError::DataSize { stated: 0, present: 8 })),
        ("N01", Refusal::Parse(WireError::Identifier(*b"YERX"))),
        ("N03", Refusal::Parse(WireError::DataSize { stated: 4, present: 0 })),
        ("N05", Refusal::Parse(WireError::Division(3))),
        ("N07", Refusal::Parse(WireError::Truncated(31))),
        ("N09", Refusal::Check(|error| matches!(error, RequestError::Command { command: 0x8D }))),
        ("N11", Refusal::Check(|error| matches!(error, RequestError::Attribute { found: 3, .. }))),
        ("N13", Refusal::Check(|error| matches!(error, RequestError::Count { found: 476, max: 474, .. }))),
        ("N15", Refusal::Check(|error| matches!(error, RequestError::ReadOnly { found: 1001, .. }))),
        ("N17", Refusal::Check(|error| matches!(error, RequestError::FileName(files::FileNameError::Nul { .. })))),
    ]
}

/// A golden frame from the file.
struct Vector(Json);

impl Vector {
    fn bytes(&self) -> Vec<u8> {
        from_hex(self.0["hex"].as_str().unwrap())
    }

    fn model(&self) -> Model {
        self.0["controller"].as_str().map_or(Fs100, |name| name.parse().unwrap())
    }
}

fn vectors() -> BTreeMap<String, Vector> {
    let json: Json = serde_json::from_str(include_str!("data/yerc-frames.json")).unwrap();
    let list = match json {
        Json::Array(list) => list,
        Json::Object(object) => object
            .into_iter()
            .find_map(|(_, value)| value.as_array().cloned().filter(|list| list.len() == COUNT))
            .unwrap(),
        _ => panic!("no list of vectors"),
    };
    list.into_iter().map(|vector| (vector["id"].as_str().unwrap().to_owned(), Vector(vector))).collect()
}

fn check_header(name: &str, vector: &Vector, size: usize, ack: bool, id: u8, block: u32) {
    let fields = &vector.0["fields"];
    assert_eq!(vector.0["length"].as_u64(), u64::try_from(32 + size).ok(), "{name}");
    assert_eq!(number(&fields["data_size"]), u64::try_from(size).unwrap(), "{name}");
    assert_eq!(number(&fields["ack"]), u64::from(ack), "{name}");
    assert_eq!(number(&fields["request_id"]), u64::from(id), "{name}");
    assert_eq!(number(&fields["block"]), u64::from(block), "{name}");
    let division = if vector.0["port"] == 10041 { 2 } else { 1 };
    assert_eq!(number(&fields["division"]), division, "{name}");
}

/// Checks that the explanation covers every byte once and reports no problem.
fn explain(id: &str, frame: &[u8], sender: Sender) {
    assert_eq!(Sender::guess(frame), sender, "{id}");
    let description = describe(frame, sender, None);
    assert_eq!(description.problem, None, "{id}");
    let end = description.fields.iter().fold(0, |at, field| {
        assert_eq!(field.offset, at, "{id} {}", field.name);
        at + field.size
    });
    assert_eq!(end, frame.len(), "{id}");
    let raw: String = description.fields.into_iter().map(|field| field.raw).collect();
    assert_eq!(raw, hex(frame), "{id}");
    assert!(!summary(frame, sender, None).contains("no valid frame"), "{id}");
}

fn request_of(frame: &RequestFrame<'_>) -> Request {
    Request {
        command: frame.command,
        instance: frame.instance,
        attribute: frame.attribute,
        service: frame.service,
        data: frame.data.to_vec(),
    }
}

/// Number from a JSON number, or from a text in hexadecimal.
fn number(value: &Json) -> u64 {
    value.as_u64().unwrap_or_else(|| {
        let text = value.as_str().unwrap_or_else(|| panic!("no number: {value}"));
        u64::from_str_radix(text.trim_start_matches("0x"), 16).unwrap()
    })
}

fn hex(bytes: &[u8]) -> String {
    bytes
        .iter()
        .flat_map(|byte| [byte >> 4, byte & 15])
        .map(|digit| char::from(b"0123456789abcdef"[usize::from(digit)]))
        .collect()
}

fn from_hex(text: &str) -> Vec<u8> {
    (0..text.len()).step_by(2).map(|i| u8::from_str_radix(&text[i..i + 2], 16).unwrap()).collect()
}

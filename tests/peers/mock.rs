//! `moto-hses-mock` in the place of the controller.

use std::sync::Arc;
use std::time::Duration;

use armctl_controller::yerc::Model::Dx200;
use armctl_controller::yerc::files::{self, FileName, FileType};
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::{Axes, CycleMode, ExtendedForm, Form, Position, PositionKind, StatusBit, Text};
use armctl_controller::yerc::query::{
    AlarmClass, CancelError, Coordinates, Hlock, Hold, Query, ReadAlarm, ReadAlarmHistory, ReadField, ReadIo,
    ReadIoGroups, ReadJob, ReadManagementTime, ReadPosition, ReadPositionError, ReadRegister, ReadRegisters,
    ReadStatus, ReadTorque, ReadVariable, ReadVariables, ResetAlarm, Say, SelectJob, Selection, Servo, SetCycle,
    StartJob, TimeCounter, WriteIo, WriteIoGroups, WriteRegister, WriteRegisters, WriteVariable, WriteVariables,
};
use armctl_controller::yerc::session::{DownloadEnd, UploadEnd};
use armctl_controller::yerc::variables::{Value, VariableKind};
use armctl_yerc::link::Link;
use moto_hses_mock::server::MockServerBuilder;
use moto_hses_mock::{MockServer, VariableType};
use moto_hses_proto as proto;
use tokio::net::UdpSocket;

/// Number of attempts to find a free port for the file server of the mock, which does not report its port.
const PORT_ATTEMPTS: usize = 20;

/// A mock, and the client of this project, which is connected to it.
struct Peer {
    mock: Arc<MockServer>,
    link: Link,
}

impl Peer {
    async fn start() -> Self {
        Self::start_with(|builder| builder, None).await
    }

    async fn start_with(configure: impl Fn(MockServerBuilder) -> MockServerBuilder, timeout: Option<Duration>) -> Self {
        for _ in 0..PORT_ATTEMPTS {
            let file = UdpSocket::bind("127.0.0.1:0").await.unwrap().local_addr().unwrap();
            let builder = MockServerBuilder::new().host("127.0.0.1").robot_port(0).file_port(file.port());
            // Another process may have taken the port since the check.
            let Ok(mock) = configure(builder).build().await else { continue };
            let robot = mock.local_addr().unwrap();
            let mock = Arc::new(mock);
            let serving = Arc::clone(&mock);
            tokio::spawn(async move { serving.run().await.unwrap() });
            let url = format!("udp://{robot}?file_port={}&model=dx200", file.port());
            return Self { mock, link: super::connect_with(&url, timeout).await };
        }
        panic!("no free port after {PORT_ATTEMPTS} attempts");
    }

    async fn ask<Q: Query>(&mut self, query: Q) -> Q::Answer {
        self.link.ask(&query).await.unwrap()
    }

    async fn status(&mut self) -> Vec<StatusBit> {
        let status = self.ask(ReadStatus).await;
        StatusBit::all().filter(|bit| status.has(*bit)).collect()
    }

    /// Writes values one by one and together, and reads them back in both ways.
    async fn variables(&mut self, kind: VariableKind, values: Vec<Value>) {
        let count = u16::try_from(values.len()).unwrap();
        for (number, value) in (10..).zip(&values) {
            self.ask(WriteVariable::new(number, value.clone()).unwrap()).await;
            assert_eq!(self.ask(ReadVariable::new(kind, number)).await, *value);
        }
        assert_eq!(self.ask(ReadVariables::new(kind, 10, count).unwrap()).await, values);
        self.ask(WriteVariables::new(40, values.clone()).unwrap()).await;
        assert_eq!(self.ask(ReadVariables::new(kind, 40, count).unwrap()).await, values);
        for (number, value) in (40..).zip(&values) {
            assert_eq!(self.ask(ReadVariable::new(kind, number)).await, *value);
        }
    }

    async fn stored_value(&self, kind: VariableType, number: u16) -> Vec<u8> {
        self.mock.state().read().await.get_variable(kind, number).unwrap().clone()
    }
}

// Every successful answer of the mock has the size "two words of added status", which no controller sends (31). The
// client must count such an answer as success; otherwise all tests below would fail.

#[tokio::test]
async fn status_bits_agree() {
    use StatusBit as Bit;

    let data1 = |bit| proto::StatusData1 {
        step: bit == Bit::Step,
        one_cycle: bit == Bit::OneCycle,
        continuous: bit == Bit::Continuous,
        running: bit == Bit::Running,
        speed_limited: bit == Bit::Guarded,
        teach: bit == Bit::Teach,
        play: bit == Bit::Play,
        remote: bit == Bit::CommandRemote,
    };
    let data2 = |bit| proto::StatusData2 {
        teach_pendant_hold: bit == Bit::HoldPendant,
        external_hold: bit == Bit::HoldExternal,
        command_hold: bit == Bit::HoldCommand,
        alarm: bit == Bit::Alarm,
        error: bit == Bit::Error,
        servo_on: bit == Bit::ServoOn,
    };
    let mut peer = Peer::start().await;
    for bit in StatusBit::all() {
        peer.mock.set_status(proto::Status::new(data1(bit), data2(bit))).await;
        assert_eq!(peer.status().await, [bit]);
    }
}

#[tokio::test]
async fn alarms_and_resets_agree() {
    let mut peer = Peer::start().await;
    let expected = [
        (1, 1001, 1, 1, "2024/01/01 12:00", "Servo Error"),
        (2, 2001, 0, 0, "2024/01/01 12:01", "Emergency Stop"),
        (3, 3001, 2, 2, "2024/01/01 12:02", "Safety Error"),
        (4, 4001, 3, 3, "2024/01/01 12:03", "Communication Error"),
    ];
    for (slot, code, data, kind, time, name) in expected {
        let alarm = peer.ask(ReadAlarm::new(slot, false).unwrap()).await;
        assert_eq!((alarm.code, alarm.data, alarm.kind.0), (code, data, kind));
        assert_eq!((alarm.time.as_bytes(), alarm.name.as_bytes()), (time.as_bytes(), name.as_bytes()));
        let field = |attribute| ReadField::new(Dx200, 0x70, slot.into(), attribute).unwrap();
        assert_eq!(peer.ask(field(1)).await, u32::to_le_bytes(code));
        assert_eq!(peer.ask(field(4)).await, Text::<16>::new(time.as_bytes()).unwrap().emit());
        assert_eq!(peer.ask(field(5)).await, Text::<32>::new(name.as_bytes()).unwrap().emit());
    }
    for (class, number, code) in [(AlarmClass::Major, 3, 3001), (AlarmClass::Monitor, 2, 1001)] {
        let history = peer.ask(ReadAlarmHistory::new(class, number, false).unwrap()).await;
        assert_eq!(history.code, code);
    }
    peer.mock.add_test_alarm(proto::payload::alarm::test_alarms::servo_error()).await;
    assert!(peer.status().await.contains(&StatusBit::Alarm));
    peer.ask(ResetAlarm).await;
    peer.ask(CancelError).await;
    assert!(!peer.status().await.contains(&StatusBit::Alarm));
    assert!(peer.mock.state().read().await.alarms.is_empty());
}

#[tokio::test]
async fn positions_agree_in_pulses_and_in_base_coordinates() {
    let mut peer = Peer::start().await;
    let joints = vec![1000, -2000, i32::MAX, i32::MIN, 5, -6];
    peer.mock.set_position(proto::Position::Pulse(proto::PulsePosition::new(joints.clone()))).await;
    let position = peer.ask(ReadPosition::new(Dx200, Group::R1, Coordinates::Pulse).unwrap()).await;
    assert_eq!((position.kind, position.axes.as_slice()), (PositionKind::Pulse, joints.as_slice()));

    let cartesian = proto::CartesianPosition::new(
        123.5,
        -0.25,
        1200.0,
        179.5,
        -90.0,
        0.125,
        7,
        3,
        proto::payload::position::Configuration::from_raw(0b1010_0101),
        proto::payload::position::ExtendedConfiguration::from_raw(0b1_0010),
    );
    peer.mock.set_position(proto::Position::Cartesian(cartesian)).await;
    let position = peer.ask(ReadPosition::new(Dx200, Group::R1, Coordinates::Base).unwrap()).await;
    let expected = Position {
        kind: PositionKind::Base,
        form: Form(0b1010_0101),
        tool: 7,
        user: 3,
        extended: ExtendedForm(0b1_0010),
        axes: Axes::new(&[123_500, -250, 1_200_000, 1_795_000, -900_000, 1_250]).unwrap(),
    };
    assert_eq!(position, expected);
}

#[tokio::test]
async fn torque_error_and_times_agree() {
    let mut peer = Peer::start().await;
    let torque = peer.ask(ReadTorque::new(Dx200, Group::R1).unwrap()).await;
    assert_eq!(torque.as_slice(), [0, 100, 200, 300, 400, 500, 600]);
    let error = peer.ask(ReadPositionError::new(Dx200, Group::R1).unwrap()).await;
    assert_eq!(error.as_slice(), [0, 10, 20, 30, 40, 50, 60]);
    let time = peer.ask(ReadManagementTime::new(Dx200, TimeCounter::ControlPower).unwrap()).await;
    // The data of the mock is four bytes longer than 3.3.25 specifies. The client ignores these bytes.
    assert_eq!((time.start.as_bytes(), time.elapsed.as_bytes()), (&b"1234567890"[..], &b"987654321"[..]));
    // Two answers are not compared. The mock sends axis names of eight bytes instead of four (3.3.5). It sends system
    // information in three fields of 16 bytes instead of 24, 16 and 8 bytes (3.3.26).
}

#[tokio::test]
async fn single_and_multiple_numbers_agree() {
    let mut peer = Peer::start().await;
    peer.variables(VariableKind::B, [0, 1, 0x7F, 0x80, 0xFE, 0xFF].map(Value::Byte).to_vec()).await;
    peer.variables(VariableKind::I, [0, -1, i16::MIN, i16::MAX, 0x1234].map(Value::Integer).to_vec()).await;
    peer.variables(VariableKind::D, [0, -1, i32::MIN, i32::MAX, 0x1234_5678].map(Value::Double).to_vec()).await;
    peer.variables(VariableKind::R, [0.0, -1.5, f32::MAX, f32::MIN_POSITIVE, 1e-3].map(Value::Real).to_vec()).await;
    assert_eq!(peer.stored_value(VariableType::Byte, 13).await, [0x80]);
    assert_eq!(peer.stored_value(VariableType::Integer, 42).await, i16::MIN.to_le_bytes());
    assert_eq!(peer.stored_value(VariableType::Double, 14).await, 0x1234_5678_i32.to_le_bytes());
    assert_eq!(peer.stored_value(VariableType::Real, 41).await, (-1.5_f32).to_le_bytes());
}

#[tokio::test]
async fn strings_agree_in_any_encoding() {
    let mut peer = Peer::start().await;
    let texts = [&b""[..], b"HELLO", b"\x83e\x83X\x83g", b"SIXTEEN BYTES OK"];
    let values = texts.map(|text| Value::Short(Text::new(text).unwrap())).to_vec();
    peer.variables(VariableKind::S16, values).await;
    assert_eq!(peer.stored_value(VariableType::String, 12).await, b"\x83e\x83X\x83g");
    assert_eq!(peer.stored_value(VariableType::String, 43).await, b"SIXTEEN BYTES OK");
}

/// The mock stores one position type for all variables. It drops form, tool and user frame of a pulse position, and the
/// axes after the sixth axis of a cartesian position. It reads BP and EX variables with the layout of P variables, so
/// they are not compared.
#[tokio::test]
async fn position_variables_agree() {
    let mut peer = Peer::start().await;
    let pulse = Position {
        kind: PositionKind::Pulse,
        form: Form(0),
        tool: 0,
        user: 0,
        extended: ExtendedForm(0),
        axes: Axes::full([1, -2, 3, -4, 5, -6, 7, -8]),
    };
    let base = Position {
        kind: PositionKind::Base,
        form: Form(5),
        tool: 2,
        user: 1,
        extended: ExtendedForm(3),
        axes: Axes::full([1_500, -250_000, 0, 900_000, -450_000, 10_000, 0, 0]),
    };
    for (written, axes) in [(pulse, 8), (base, 6)] {
        peer.ask(WriteVariable::new(3, Value::Position(written)).unwrap()).await;
        let read = peer.ask(ReadVariable::new(VariableKind::P, 3)).await;
        let axes = Axes::new(&written.axes.as_slice()[..axes]).unwrap();
        assert_eq!(read, Value::Position(Position { axes, ..written }));
    }
}

#[tokio::test]
async fn signals_and_registers_agree() {
    let mut peer = Peer::start().await;
    peer.mock.set_io_state(1, 0b1010_0001).await;
    assert_eq!(peer.ask(ReadIo::new(Dx200, 1).unwrap()).await, 0b1010_0001);
    peer.ask(WriteIo::new(Dx200, 2701, 0x5A).unwrap()).await;
    assert_eq!(peer.ask(ReadIo::new(Dx200, 2701).unwrap()).await, 0x5A);
    peer.ask(WriteIoGroups::new(Dx200, 2710, vec![1, 2, 0xFF, 0x80]).unwrap()).await;
    assert_eq!(peer.ask(ReadIoGroups::new(Dx200, 2709, 6).unwrap()).await, [0, 1, 2, 0xFF, 0x80, 0]);
    assert_eq!(peer.mock.state().read().await.get_io_state(2712), 0xFF);

    assert_eq!(peer.ask(ReadRegisters::new(Dx200, 0, 5).unwrap()).await, [0, 100, 200, 300, 400]);
    peer.ask(WriteRegister::new(Dx200, 5, 0xFEDC).unwrap()).await;
    assert_eq!(peer.ask(ReadRegister::new(Dx200, 5).unwrap()).await, 0xFEDC);
    let max_values: Vec<u16> = (0..237).map(|number| number * 277).collect();
    peer.ask(WriteRegisters::new(Dx200, 100, max_values.clone()).unwrap()).await;
    assert_eq!(peer.ask(ReadRegisters::new(Dx200, 100, 237).unwrap()).await, max_values);
    assert_eq!(peer.mock.state().read().await.get_register(5), i16::from_le_bytes([0xDC, 0xFE]));
}

#[tokio::test]
async fn jobs_agree() {
    let job = proto::ExecutingJobInfo::new("WELD-1".to_owned(), 1234, 56, 75);
    let mut peer = Peer::start_with(|builder| builder.with_executing_job(job.clone()), None).await;
    let shown = peer.ask(ReadJob::new(Dx200, 0).unwrap()).await;
    // The frame has 7500 for 75 % (39).
    assert_eq!((shown.name.as_bytes(), shown.line, shown.step, shown.speed_override), (&b"WELD-1"[..], 1234, 56, 7500));
    let line = peer.ask(ReadField::new(Dx200, 0x73, 1, 2).unwrap()).await;
    assert_eq!(line, 1234_u32.to_le_bytes());

    for (selection, line, kind) in [
        (Selection::Execute { line: 42 }, 42, 1),
        (Selection::Master { task: 0 }, 0, 10),
        (Selection::Master { task: 5 }, 0, 15),
    ] {
        peer.ask(SelectJob::new(Dx200, b"PICK AND PLACE", selection).unwrap()).await;
        let selected = peer.mock.get_selected_job().await.unwrap();
        assert_eq!(
            (selected.job_name.as_str(), selected.line_number, selected.select_type),
            ("PICK AND PLACE", line, kind)
        );
    }
    assert!(!peer.mock.get_running().await);
    peer.ask(StartJob).await;
    assert!(peer.mock.get_running().await);
    assert!(peer.status().await.contains(&StatusBit::Running));
}

#[tokio::test]
async fn switches_agree() {
    let mut peer = Peer::start().await;
    for on in [false, true, false] {
        peer.ask(Servo(on)).await;
        peer.ask(Hold(on)).await;
        peer.ask(Hlock(on)).await;
        let status = peer.status().await;
        assert_eq!(status.contains(&StatusBit::ServoOn), on);
        assert_eq!(status.contains(&StatusBit::HoldCommand), on);
        assert_eq!(peer.mock.state().read().await.is_hlock_enabled(), on);
    }
    for (mode, expected) in [
        (CycleMode::Step, proto::CycleMode::Step),
        (CycleMode::Once, proto::CycleMode::OneCycle),
        (CycleMode::Continuous, proto::CycleMode::Continuous),
    ] {
        peer.ask(SetCycle(mode)).await;
        assert_eq!(peer.mock.get_cycle_mode().await, expected);
    }
    peer.ask(Say::new(b"PART MISSING").unwrap()).await;
    // Moves are not compared: the mock reads their first words (robot, station, class) as a position.
}

/// The mock answers a list or file of any size in one frame with the block number 0x80000000. This number is possible
/// for a single block (49). The mock answers the ACK of this frame again, like a request.
#[tokio::test]
async fn lists_fetches_and_deletes_files() {
    let content = b"/JOB\r\n//NAME A\r\nNOP\r\n'\x00\xFF\x83e\r\nEND\r\n".to_vec();
    let mut peer = Peer::start().await;
    {
        let mut state = peer.mock.state().write().await;
        state.files.clear();
        state.set_file("A.JBI".to_owned(), content.clone());
        state.set_file("FULL.JBI".to_owned(), vec![b'x'; 479]);
        state.set_file("V.DAT".to_owned(), b"//VAR\r\n".to_vec());
    }
    let (list, _) = fetch(&mut peer.link, &files::list(FileType::Jbi)).await;
    let mut names = files::split_list(&list).unwrap();
    names.sort_unstable();
    assert_eq!(names, [&b"A.JBI"[..], b"FULL.JBI"]);
    for (name, expected) in [("A.JBI", &content[..]), ("FULL.JBI", &[b'x'; 479]), ("V.DAT", b"//VAR\r\n")] {
        let (got, end) = fetch(&mut peer.link, &FileName::new(name).unwrap().save()).await;
        assert_eq!(got, expected);
        assert_eq!(end, DownloadEnd::Complete { bytes: expected.len() as u64, blocks: 1 });
    }
    let deleted = peer.link.raw(&FileName::new("A.JBI").unwrap().delete()).await.unwrap();
    assert!(deleted.status.is_ok());
    assert!(peer.mock.state().read().await.get_file("A.JBI").is_none());
    assert_eq!(peer.mock.state().read().await.files.len(), 2);
}

async fn fetch(link: &mut Link, request: &armctl_controller::yerc::request::Request) -> (Vec<u8>, DownloadEnd) {
    let mut fetched = Vec::new();
    let end = link
        .download(request, 1 << 20, None, |piece| {
            fetched.extend_from_slice(piece);
            Ok(())
        })
        .await
        .unwrap();
    (fetched, end)
}

/// The mock expects an upload in one frame with name, NUL and content. It accepts another upload, but does not store
/// it. The client must not report such an upload as done.
#[tokio::test]
async fn does_not_report_a_lost_upload_as_done() {
    let mut peer = Peer::start_with(|builder| builder, Some(Duration::from_millis(100))).await;
    let mut pieces = vec![Vec::new(), vec![b'x'; 600]];
    let request = FileName::new("NEW.JBI").unwrap().load();
    let end = peer.link.upload(&request, || Ok(pieces.pop().unwrap_or_default())).await;
    // On a busy machine, the mock may answer only after the client has stopped waiting.
    assert!(matches!(end, Ok(UploadEnd::OutcomeUnknown { sent: 479, taken: 0, .. }) | Err(_)), "{end:?}");
    assert!(peer.mock.state().read().await.get_file("NEW.JBI").is_none());
}

//! `moto-hses-client` and the client of this project with the same simulator. Each client reads what the other client
//! wrote.

use std::net::{Ipv4Addr, SocketAddr};
use std::time::Duration;

use armctl_controller::yerc::Model::{self, Dx200, Fs100};
use armctl_controller::yerc::files::FileName;
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::{ControllerStatus, Position, StatusBit, Text};
use armctl_controller::yerc::query::{
    Coordinates, Query, ReadIo, ReadIoGroups, ReadJob, ReadPosition, ReadRegister, ReadRegisters, ReadStatus,
    ReadVariable, ReadVariables, WriteIo, WriteRegister, WriteVariable,
};
use armctl_controller::yerc::session::DownloadEnd;
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_controller::yerc::variables::{Value, VariableKind};
use armctl_transport::server::Server;
use armctl_yerc::link::Link;
use armctl_yerc::simulator_start::Simulated;
use encoding_rs::SHIFT_JIS;
use moto_hses_client::{ClientConfig, HsesClient, TextEncoding};
use moto_hses_proto::commands::JobSelectType;
use moto_hses_proto::{AlarmAttribute, CycleMode, Position as TheirPosition, Status};

/// Long timeout. It expires only if a test fails.
const TIMEOUT: Duration = Duration::from_secs(20);

/// A simulator with two ports, and three clients: a `moto-hses-client` on each port, and the client of this project.
struct Peer {
    robot: HsesClient,
    files: HsesClient,
    link: Link,
}

impl Peer {
    async fn start(model: Model, state: &str) -> Self {
        let state = format!("model = '{model}'\n{state}");
        let start = Start::parse(&state, |path| Err(format!("{path} is not here"))).unwrap();
        let loopback = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let mut server = Server::bind([loopback; 2], None).await.unwrap();
        let (robot, file) = (server.local(0).unwrap(), server.local(1).unwrap());
        tokio::spawn(async move {
            let mut service = Simulated(Simulator::new(start));
            loop {
                server.turn(&mut service).await.unwrap();
            }
        });
        Self {
            robot: other_client(robot).await,
            files: other_client(file).await,
            link: super::connect(model, robot, file).await,
        }
    }

    async fn ask<Q: Query>(&mut self, query: Q) -> Q::Answer {
        self.link.ask(&query).await.unwrap()
    }

    async fn variable(&mut self, kind: VariableKind, number: u16) -> Value {
        self.ask(ReadVariable::new(kind, number)).await
    }

    async fn variables(&mut self, kind: VariableKind, first: u16, count: u16) -> Vec<Value> {
        self.ask(ReadVariables::new(kind, first, count).unwrap()).await
    }

    async fn set(&mut self, number: u16, value: Value) {
        self.ask(WriteVariable::new(number, value).unwrap()).await;
    }

    /// Status that the other client reads, completely and in halves. It must equal the status that our client reads.
    async fn status(&mut self) -> ControllerStatus {
        let status = self.robot.read_status().await.unwrap();
        assert_eq!(self.robot.read_status_data1().await.unwrap(), status.data1);
        assert_eq!(self.robot.read_status_data2().await.unwrap(), status.data2);
        let own_status = self.ask(ReadStatus).await;
        for (bit, theirs) in status_bits(&status) {
            assert_eq!(own_status.has(bit), theirs, "{bit:?}");
        }
        own_status
    }
}

async fn other_client(at: SocketAddr) -> HsesClient {
    let config = ClientConfig {
        host: at.ip().to_string(),
        port: at.port(),
        timeout: TIMEOUT,
        retry_count: 0,
        text_encoding: TextEncoding::ShiftJis,
        ..ClientConfig::default()
    };
    HsesClient::new_with_config(config).await.unwrap()
}

fn status_bits(status: &Status) -> [(StatusBit, bool); 14] {
    let (one, two) = (&status.data1, &status.data2);
    [
        (StatusBit::Step, one.step),
        (StatusBit::OneCycle, one.one_cycle),
        (StatusBit::Continuous, one.continuous),
        (StatusBit::Running, one.running),
        (StatusBit::Guarded, one.speed_limited),
        (StatusBit::Teach, one.teach),
        (StatusBit::Play, one.play),
        (StatusBit::CommandRemote, one.remote),
        (StatusBit::HoldPendant, two.teach_pendant_hold),
        (StatusBit::HoldExternal, two.external_hold),
        (StatusBit::HoldCommand, two.command_hold),
        (StatusBit::Alarm, two.alarm),
        (StatusBit::Error, two.error),
        (StatusBit::ServoOn, two.servo_on),
    ]
}

/// A string variable in the 16-byte form. The other client supports only this form.
fn short(text: &[u8]) -> Value {
    Value::Short(Text::new(text).unwrap())
}

#[tokio::test]
async fn status_and_switches_agree() {
    for model in [Dx200, Fs100] {
        let mut peer = Peer::start(model, "servo = false").await;
        assert!(!peer.status().await.servo_on());
        peer.robot.set_servo(true).await.unwrap();
        assert!(peer.status().await.servo_on());
        peer.robot.set_hold(true).await.unwrap();
        assert!(peer.status().await.has(StatusBit::HoldCommand));
        peer.robot.set_hold(false).await.unwrap();
        assert!(!peer.status().await.held());
        peer.robot.set_hlock(true).await.unwrap();
        peer.robot.set_hlock(false).await.unwrap();
        for (mode, bit) in [
            (CycleMode::Step, StatusBit::Step),
            (CycleMode::OneCycle, StatusBit::OneCycle),
            (CycleMode::Continuous, StatusBit::Continuous),
        ] {
            peer.robot.set_cycle_mode(mode).await.unwrap();
            assert!(peer.status().await.has(bit));
        }
        peer.robot.set_servo(false).await.unwrap();
        assert!(!peer.status().await.servo_on());
    }
}

#[tokio::test]
async fn alarms_and_resets_agree() {
    let state = "alarm = [{ code = 4315, data = 3, type = 1, time = '2026/03/14 08:01', name = 'ワークなし' }]
        history = [{ code = 9001, data = 5, type = 1, time = '2026/02/28 17:30', name = 'PART MISSING', class = 'user' }]";
    let mut peer = Peer::start(Dx200, state).await;
    assert!(peer.status().await.alarm());
    let alarm = peer.robot.read_alarm_data(1, AlarmAttribute::All).await.unwrap();
    assert_eq!((alarm.code, alarm.data, alarm.alarm_type), (4315, 3, 1));
    assert_eq!((alarm.time.as_str(), alarm.name.as_str()), ("2026/03/14 08:01", "ワークなし"));
    let field = async |attribute| peer.robot.read_alarm_data(1, attribute).await.unwrap();
    assert_eq!(field(AlarmAttribute::Code).await.code, 4315);
    assert_eq!(field(AlarmAttribute::Data).await.data, 3);
    assert_eq!(field(AlarmAttribute::Type).await.alarm_type, 1);
    assert_eq!(field(AlarmAttribute::Time).await.time, "2026/03/14 08:01");
    assert_eq!(field(AlarmAttribute::Name).await.name, "ワークなし");
    assert_eq!(peer.robot.read_alarm_data(2, AlarmAttribute::All).await.unwrap().code, 0);

    let history = peer.robot.read_alarm_history(3001, AlarmAttribute::All).await.unwrap();
    assert_eq!(
        (history.code, history.data, history.time.as_str(), history.name.as_str()),
        (9001, 5, "2026/02/28 17:30", "PART MISSING")
    );
    peer.robot.reset_alarm().await.unwrap();
    peer.robot.cancel_error().await.unwrap();
    assert!(!peer.status().await.alarm());
    assert_eq!(peer.robot.read_alarm_data(1, AlarmAttribute::Code).await.unwrap().code, 0);
}

#[tokio::test]
async fn positions_agree_in_pulses_and_in_base_coordinates() {
    for model in [Dx200, Fs100] {
        let mut peer = Peer::start(model, "positions = { R1 = [1000, -2000, 3000, -4000, 5000, -6000] }").await;
        let pulses = vec![1000, -2000, 3000, -4000, 5000, -6000];
        let TheirPosition::Pulse(pulse) = peer.robot.read_position(1).await.unwrap() else { panic!("no pulses") };
        assert_eq!(pulse.joints[..6], pulses);
        let ours = peer.ask(ReadPosition::new(model, Group::R1, Coordinates::Pulse).unwrap()).await;
        assert_eq!(ours.axes.as_slice()[..6], pulses);

        let TheirPosition::Cartesian(theirs) = peer.robot.read_position(101).await.unwrap() else { panic!("no base") };
        let Position { form, tool, user, extended, axes, .. } =
            peer.ask(ReadPosition::new(model, Group::R1, Coordinates::Base).unwrap()).await;
        assert_eq!(u32::from(theirs.configuration.to_raw()), form.0);
        assert_eq!(u32::from(theirs.extended_configuration.to_raw()), extended.0);
        assert_eq!((u32::from(theirs.tool_no), u32::from(theirs.user_coord_no)), (tool, user));
        let millimetres = [theirs.x, theirs.y, theirs.z].map(|value| f64::from(value) * 1e3);
        let degrees = [theirs.rx, theirs.ry, theirs.rz].map(|value| f64::from(value) * 1e4);
        for (theirs, ours) in millimetres.into_iter().chain(degrees).zip(axes.as_slice()) {
            // The other client uses single precision, which has seven digits.
            assert!((theirs - f64::from(*ours)).abs() < 0.5, "{theirs} is not {ours}");
        }
        assert!(axes.as_slice()[0] != 0);
    }
}

#[tokio::test]
async fn single_and_multiple_numbers_agree() {
    use VariableKind::{B, D, I, R};

    for model in [Dx200, Fs100] {
        let mut peer = Peer::start(model, "").await;
        for (number, value) in (20..).zip([0, 1, 0x7F, 0x80, 0xFE, 0xFF]) {
            peer.robot.write_u8(number, value).await.unwrap();
            assert_eq!(peer.variable(B, number).await, Value::Byte(value));
            peer.set(number + 20, Value::Byte(value)).await;
            assert_eq!(peer.robot.read_u8(number + 20).await.unwrap(), value);
        }
        for (number, value) in (20..).zip([0, -1, i16::MIN, i16::MAX, 0x1234]) {
            peer.robot.write_i16(number, value).await.unwrap();
            assert_eq!(peer.variable(I, number).await, Value::Integer(value));
            peer.set(number + 20, Value::Integer(value)).await;
            assert_eq!(peer.robot.read_i16(number + 20).await.unwrap(), value);
        }
        for (number, value) in (20..).zip([0, -1, i32::MIN, i32::MAX, 0x1234_5678]) {
            peer.robot.write_i32(number, value).await.unwrap();
            assert_eq!(peer.variable(D, number).await, Value::Double(value));
            peer.set(number + 20, Value::Double(value)).await;
            assert_eq!(peer.robot.read_i32(number + 20).await.unwrap(), value);
        }
        for (number, value) in (20..).zip([0.0_f32, -1.5, f32::MAX, f32::MIN_POSITIVE, 1e-3]) {
            peer.robot.write_f32(number, value).await.unwrap();
            assert_eq!(peer.variable(R, number).await, Value::Real(value));
            peer.set(number + 20, Value::Real(value)).await;
            assert_eq!(peer.robot.read_f32(number + 20).await.unwrap().to_bits(), value.to_bits());
        }

        let bytes: Vec<u8> = (0..100).map(|value| value * 2 + 55).collect();
        peer.robot.write_multiple_u8(0, bytes.clone()).await.unwrap();
        assert_eq!(peer.robot.read_multiple_u8(0, 100).await.unwrap(), bytes);
        assert_eq!(peer.variables(B, 0, 100).await, bytes.into_iter().map(Value::Byte).collect::<Vec<_>>());
        let integers: Vec<i16> = (-50..50).map(|value| value * 655).collect();
        peer.robot.write_multiple_i16(0, integers.clone()).await.unwrap();
        assert_eq!(peer.robot.read_multiple_i16(0, 100).await.unwrap(), integers);
        assert_eq!(peer.variables(I, 0, 100).await, integers.into_iter().map(Value::Integer).collect::<Vec<_>>());
        let duplicates: Vec<i32> = (-50..50).map(|value| value * 42_000_000).collect();
        peer.robot.write_multiple_i32(0, duplicates.clone()).await.unwrap();
        assert_eq!(peer.robot.read_multiple_i32(0, 100).await.unwrap(), duplicates);
        assert_eq!(peer.variables(D, 0, 100).await, duplicates.into_iter().map(Value::Double).collect::<Vec<_>>());
        let reals: Vec<f32> = (0_i16..100).map(|value| f32::from(value) * 0.1 - 3.0).collect();
        peer.robot.write_multiple_f32(0, reals.clone()).await.unwrap();
        assert_eq!(peer.robot.read_multiple_f32(0, 100).await.unwrap(), reals);
        assert_eq!(peer.variables(R, 0, 100).await, reals.into_iter().map(Value::Real).collect::<Vec<_>>());
    }
}

#[tokio::test]
async fn strings_agree_in_shift_jis() {
    let texts = [
        ("", &b""[..]),
        ("HELLO", b"HELLO"),
        ("テスト", b"\x83e\x83X\x83g"),
        ("SIXTEEN BYTES OK", b"SIXTEEN BYTES OK"),
    ];
    for model in [Dx200, Fs100] {
        let mut peer = Peer::start(model, "").await;
        for (number, (text, bytes)) in (20..).zip(texts) {
            peer.robot.write_string(number, text.to_owned()).await.unwrap();
            assert_eq!(peer.variable(VariableKind::S16, number).await, short(bytes));
            peer.set(number + 20, short(bytes)).await;
            assert_eq!(peer.robot.read_string(number + 20).await.unwrap(), text);
        }
        let all: Vec<String> = texts.iter().map(|(text, _)| (*text).to_owned()).collect();
        peer.robot.write_multiple_strings(60, all.clone()).await.unwrap();
        assert_eq!(peer.robot.read_multiple_strings(60, 4).await.unwrap(), all);
        assert_eq!(peer.variables(VariableKind::S16, 60, 4).await, texts.map(|(_, bytes)| short(bytes)));
        assert_eq!(peer.robot.read_multiple_strings(7, 2).await.unwrap(), ["HELLO", "こんにちは"]);
    }
}

#[tokio::test]
async fn signals_and_registers_agree() {
    let mut peer = Peer::start(Dx200, "io = { 10010 = true }\nregisters = { 10 = 4660 }").await;
    assert_eq!(peer.robot.read_io(1).await.unwrap(), 1);
    assert_eq!(peer.robot.read_io(1001).await.unwrap(), 1);
    // The other client writes one element as four bytes. The controller uses the first of them (28).
    peer.robot.write_io(2701, 0x5A).await.unwrap();
    assert_eq!(peer.ask(ReadIo::new(Dx200, 2701).unwrap()).await, 0x5A);
    peer.ask(WriteIo::new(Dx200, 2702, 0xA5).unwrap()).await;
    assert_eq!(peer.robot.read_io(2702).await.unwrap(), 0xA5);
    peer.robot.write_multiple_io(2710, vec![1, 2, 0xFF, 0x80]).await.unwrap();
    assert_eq!(peer.robot.read_multiple_io(2709, 6).await.unwrap(), [0, 1, 2, 0xFF, 0x80, 0]);
    assert_eq!(peer.ask(ReadIoGroups::new(Dx200, 2710, 4).unwrap()).await, [1, 2, 0xFF, 0x80]);

    assert_eq!(peer.robot.read_register(10).await.unwrap(), 4660);
    peer.robot.write_register(5, i16::MIN).await.unwrap();
    assert_eq!(peer.ask(ReadRegister::new(Dx200, 5).unwrap()).await, 0x8000);
    peer.ask(WriteRegister::new(Dx200, 6, 0xFFFF).unwrap()).await;
    assert_eq!(peer.robot.read_register(6).await.unwrap(), -1);
    let max_values: Vec<i16> = (0..237).map(|number| number * 138 - 16_000).collect();
    peer.robot.write_multiple_registers(100, max_values.clone()).await.unwrap();
    assert_eq!(peer.robot.read_multiple_registers(100, 237).await.unwrap(), max_values);
    let ours = peer.ask(ReadRegisters::new(Dx200, 100, 237).unwrap()).await;
    assert_eq!(ours, max_values.iter().map(|value| u16::from_le_bytes(value.to_le_bytes())).collect::<Vec<_>>());
}

#[tokio::test]
async fn selects_shows_and_starts_jobs() {
    for model in [Dx200, Fs100] {
        let mut peer = Peer::start(model, "").await;
        for (name, line) in [("TESTJOB", 4), ("テスト", 1), ("WAITIN", 0)] {
            peer.robot.select_job(JobSelectType::InExecution, name, line).await.unwrap();
            let theirs = peer.robot.read_executing_job_info_complete(1).await.unwrap();
            let ours = peer.ask(ReadJob::new(model, 0).unwrap()).await;
            assert_eq!((theirs.job_name.as_str(), theirs.line_number), (name, line));
            assert_eq!((theirs.line_number, theirs.step_number), (ours.line, ours.step));
            assert_eq!(theirs.speed_override_value * 100, ours.speed_override);
            let field = async |attribute| peer.robot.read_executing_job_info(1, attribute).await.unwrap();
            assert_eq!(field(1).await.job_name, name);
            assert_eq!(field(2).await.line_number, theirs.line_number);
            assert_eq!(field(3).await.step_number, theirs.step_number);
            assert_eq!(field(4).await.speed_override_value, theirs.speed_override_value);
        }
        peer.robot.select_job(JobSelectType::MasterTask0, "MAIN", 0).await.unwrap();
        assert!(!peer.status().await.running());
        // This job waits for an input, so it continues to run.
        peer.robot.start_job().await.unwrap();
        assert!(peer.status().await.running());
        peer.robot.set_hold(true).await.unwrap();
        assert!(!peer.status().await.running());
    }
}

#[tokio::test]
async fn lists_fetches_and_deletes_files() {
    for model in [Dx200, Fs100] {
        let text = "0,1,2,3,4,5,6,7,8,9\\n".repeat(70);
        let mut peer = Peer::start(model, &format!("file = [{{ name = 'LONG.DAT', text = \"{text}\" }}]")).await;
        let jobs = peer.files.read_file_list("*.JBI").await.unwrap();
        assert_eq!(jobs, ["COUNT.JBI", "HOME.JBI", "JOB.JBI", "MAIN.JBI", "TESTJOB.JBI", "WAITIN.JBI", "テスト.JBI"]);
        let mut most = 0;
        for name in jobs.iter().map(String::as_str).chain(["LONG.DAT", "ALL.PRM"]) {
            let theirs = peer.files.receive_file(name).await.unwrap();
            let name = FileName::new(SHIFT_JIS.encode(name).0).unwrap();
            let mut ours = Vec::new();
            let take = |piece: &[u8]| {
                ours.extend_from_slice(piece);
                Ok(())
            };
            let end = peer.link.download(&name.save(), 1 << 20, None, take).await.unwrap();
            assert_eq!(SHIFT_JIS.encode(&theirs).0, ours);
            let (bytes, blocks) = (ours.len() as u64, u32::try_from(ours.len().div_ceil(479)).unwrap());
            assert_eq!(end, DownloadEnd::Complete { bytes, blocks });
            most = most.max(blocks);
        }
        assert_eq!(most, 4, "70 lines of 21 bytes");
        peer.files.delete_file("HOME.JBI").await.unwrap();
        let jobs = peer.files.read_file_list("*.JBI").await.unwrap();
        assert_eq!(jobs, ["COUNT.JBI", "JOB.JBI", "MAIN.JBI", "TESTJOB.JBI", "WAITIN.JBI", "テスト.JBI"]);
        // The other client sends name, NUL and content in one frame. No controller accepts this: a NUL in the name is
        // refused with E49D (56).
        let refused = peer.files.send_file("NEW.JBI", b"/JOB\r\n").await.unwrap_err();
        assert!(refused.to_string().contains("E49D"), "{refused}");
    }
}

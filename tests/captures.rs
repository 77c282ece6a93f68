//! Replay of requests and answers that were captured from a controller.
//!
//! The file is not part of the project; the variable `ARMCTL_YERC_CAPTURES` has its path. The controller is a YRC1000.
//! Its requests for these commands are the same as the requests for a DX200, and armctl recognizes the model by the
//! software version.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]
#![expect(clippy::needless_pass_by_value, reason = "queries are built where they are sent")]

use std::net::{SocketAddr, UdpSocket};
use std::time::Duration;

use armctl_client::yerc::{Client, Endpoint, Options};
use armctl_controller::yerc::Model::{self, Yrc1000};
use armctl_controller::yerc::describe::{Sender, describe};
use armctl_controller::yerc::group::Group;
use armctl_controller::yerc::payload::PositionKind;
use armctl_controller::yerc::query::{
    AlarmClass, Coordinates, Query, ReadAlarm, ReadAlarmHistory, ReadAxes, ReadJob, ReadManagementTime, ReadPosition,
    ReadStatus, ReadSystemInfo, ReadTorque, SystemPart, TimeCounter,
};
use armctl_controller::yerc::request::Request;
use armctl_controller::yerc::simulator::{Simulator, Start};
use armctl_controller::yerc::variables::VariableKind;
use armctl_controller::yerc::wire::{AnswerFrame, Division, RequestFrame, Status};

const SKIPPED: &str = "skipped: ARMCTL_YERC_CAPTURES does not name the file of captured pairs";

/// Pairs of a captured request and its answer.
fn pairs() -> Option<Vec<(Vec<u8>, Vec<u8>)>> {
    let path = std::env::var_os("ARMCTL_YERC_CAPTURES")?;
    let json: serde_json::Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    let pairs = json["pairs"].as_array().unwrap();
    assert_eq!(pairs.len(), 15);
    let bytes = |pair: &serde_json::Value, key: &str| from_hex(pair[key].as_str().unwrap());
    Some(pairs.iter().map(|pair| (bytes(pair, "tx"), bytes(pair, "rx"))).collect())
}

/// The simulator has other values, but its frames must have the same form: same header, same status, and same data
/// length. For axes, the data length depends on the number of fitted axes.
#[test]
fn simulator_answers_match_captured_answers() {
    let Some(pairs) = pairs() else { return println!("{SKIPPED}") };
    // This controller omits the words of axes that are not fitted. Other controllers send these words.
    let start = Start::parse("model = 'yrc1000'\ntrim_axes = true", |_| Err("there are no files".to_owned())).unwrap();
    let mut simulator = Simulator::new(start);
    for (sent, received) in pairs {
        simulator.receive(Duration::ZERO, Division::Robot, 0, &sent);
        let answer = simulator.transmit(Duration::ZERO).unwrap().bytes;
        assert_eq!(simulator.transmit(Duration::ZERO), None);
        let request = RequestFrame::parse(&sent).unwrap();
        let what = format!("{:#x} {}", request.command, request.instance);
        assert_eq!(answer.len(), received.len(), "{what}");
        assert_eq!(answer[..32], received[..32], "{what}");
    }
}

/// Answers on the loopback interface with the captured answers. Each answer gets the id of its request.
fn replayer(pairs: Vec<(Vec<u8>, Vec<u8>)>) -> SocketAddr {
    const ID: usize = 11;
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap();
    std::thread::spawn(move || {
        let mut buffer = [0; 2048];
        while let Ok((len, from)) = socket.recv_from(&mut buffer) {
            let request = &buffer[..len];
            let is_it =
                |sent: &[u8]| [&sent[..ID], &sent[ID + 1..]].concat() == [&request[..ID], &request[ID + 1..]].concat();
            let Some((_, answer)) = pairs.iter().find(|(sent, _)| is_it(sent)) else { continue };
            let mut answer = answer.clone();
            answer[ID] = request[ID];
            socket.send_to(&answer, from).unwrap();
        }
    });
    address
}

/// If the settings have no model, the client asks the controller once, when a request depends on the model.
#[tokio::test]
async fn recognizes_the_captured_controller_by_its_software() {
    let Some(pairs) = pairs() else { return println!("{SKIPPED}") };
    let port = replayer(pairs).port();
    let endpoint = Endpoint::Udp { host: "127.0.0.1".to_owned(), ports: [port, port] };
    let mut client = Client::connect(endpoint, Options::auto()).await.unwrap();
    let position = |model| ReadPosition::new(model, Group::R1, Coordinates::Pulse);
    let model = client.model_for(position).await.unwrap();
    assert_eq!(client.ask(&position(model).unwrap()).await.unwrap().axes.as_slice().len(), 6);
    assert_eq!(client.known_model(), None, "where it stands is asked in the same bytes of every model");
    let strings = |model: Model| Ok::<_, ()>(VariableKind::S32.string_form(model, false));
    assert_eq!(client.model_for(strings).await.unwrap(), Yrc1000);
    assert_eq!(client.identity().unwrap().software.as_bytes(), b"YAS2.02.11A(JP/EN)-97");
    let job = client.model_for(|model| ReadJob::new(model, 0)).await.unwrap();
    assert!(!client.ask(&ReadJob::new(job, 0).unwrap()).await.unwrap().name.is_empty());
    assert_eq!(client.close().await.unwrap().exchanges, 3);
}

#[test]
fn replays_captured_pairs() {
    let Some(pairs) = pairs() else { return println!("{SKIPPED}") };
    for (sent, received) in pairs {
        let frame = RequestFrame::parse(&sent).unwrap();
        let answer = AnswerFrame::parse(&received).unwrap();
        assert_eq!(answer.emit(), received);
        assert_eq!((answer.id, answer.service), (frame.id, frame.service + 0x80));
        let request = Request {
            command: frame.command,
            instance: frame.instance,
            attribute: frame.attribute,
            service: frame.service,
            data: frame.data.to_vec(),
        };
        replay(&request, &sent, frame.id, &answer);
        for (frame, sender) in [(&sent, Sender::Client), (&received, Sender::Controller)] {
            assert_eq!(Sender::guess(frame), sender);
            let description = describe(frame, sender, Some(&request));
            assert_eq!(description.problem, None);
            assert_eq!(description.fields.iter().map(|field| field.size).sum::<usize>(), frame.len());
        }
    }
}

fn replay(request: &Request, sent: &[u8], id: u8, answer: &AnswerFrame<'_>) {
    // Only running-time counters have instances above 255. The code below distinguishes these instances.
    let instance = u8::try_from(request.instance).unwrap_or(u8::MAX);
    match (request.command, instance) {
        (0x70, slot) => {
            let alarm = decode_data(ReadAlarm::new(slot, false).unwrap(), sent, id, answer);
            assert!(alarm.is_none());
        }
        (0x71, number) => {
            let query = ReadAlarmHistory::new(AlarmClass::Major, number, false).unwrap();
            let alarm = decode_data(query, sent, id, answer);
            assert!(!alarm.is_none() && alarm.kind.meaning().is_some());
            assert_eq!(alarm.emit(), answer.data);
        }
        (0x72, 1) => {
            let status = decode_data(ReadStatus, sent, id, answer);
            assert!(status.cycle().is_some());
            assert_eq!(status.emit(), answer.data);
        }
        (0x73, 1) => {
            let job = decode_data(ReadJob::new(Yrc1000, 0).unwrap(), sent, id, answer);
            assert!(!job.name.is_empty());
            assert_eq!(job.emit(), answer.data);
        }
        (0x73, instance) => {
            assert_eq!(ReadJob::new(Yrc1000, instance - 1).unwrap().request().frame(id), sent);
            assert_eq!(answer.status, Status::refused(0xA001));
        }
        (0x74, 1) => {
            let query = ReadAxes::new(Yrc1000, Group::R1, Coordinates::Pulse).unwrap();
            let names = decode_data(query, sent, id, answer);
            assert_eq!(names.emit(), answer.data);
        }
        (0x75, 1) => {
            let query = ReadPosition::new(Yrc1000, Group::R1, Coordinates::Pulse).unwrap();
            let position = decode_data(query, sent, id, answer);
            assert_eq!((position.kind, position.axes.as_slice().len()), (PositionKind::Pulse, 6));
            assert_eq!(position.emit_fitted(), answer.data);
        }
        (0x77, 1) => {
            let torque = decode_data(ReadTorque::new(Yrc1000, Group::R1).unwrap(), sent, id, answer);
            assert_eq!((torque.as_slice().len(), torque.emit().as_slice()), (6, answer.data));
        }
        (0x88, _) => replay_time(request.instance, sent, id, answer),
        (0x89, 11) => {
            let query = ReadSystemInfo::new(Yrc1000, SystemPart::Group(Group::R1)).unwrap();
            assert_eq!(decode_data(query, sent, id, answer).emit(), answer.data);
        }
        (0x89, instance) => {
            let query = ReadSystemInfo::new(Yrc1000, SystemPart::Application(instance - 100)).unwrap();
            assert_eq!(decode_data(query, sent, id, answer).emit(), answer.data);
        }
        other => panic!("no replay for {other:x?}"),
    }
}

fn replay_time(instance: u16, sent: &[u8], id: u8, answer: &AnswerFrame<'_>) {
    let counter = match instance {
        1 => TimeCounter::ControlPower,
        10 => TimeCounter::Servo(None),
        110 => TimeCounter::Playback(None),
        210 => TimeCounter::Motion(None),
        _ => TimeCounter::Application(1),
    };
    let time = decode_data(ReadManagementTime::new(Yrc1000, counter).unwrap(), sent, id, answer);
    assert!(time.seconds().is_some());
    assert_eq!(time.emit(), answer.data);
}

fn decode_data<Q: Query>(query: Q, sent: &[u8], id: u8, answer: &AnswerFrame<'_>) -> Q::Answer {
    assert_eq!(query.request().frame(id), sent);
    assert!(answer.status.is_ok());
    query.decode(answer.data).unwrap()
}

fn from_hex(text: &str) -> Vec<u8> {
    (0..text.len()).step_by(2).map(|i| u8::from_str_radix(&text[i..i + 2], 16).unwrap()).collect()
}

//! Other programs: the session socket, HTTP clients, MQTT brokers.

use std::time::Duration;

use armctl_transport::http::{Answer, Status, respond};
use armctl_transport::mqtt::{Hello, Message, Session, Version};
use armctl_transport::session::wire::{Change, Control, Frame, Peer, shorten};
use tokio::time::Instant;

use super::{pause, pieces, seen};
use crate::seeds;

pub fn session_socket(data: &[u8]) {
    let mut rest = data;
    while let Ok(Some((frame, length))) = Frame::parse(rest) {
        let mut again = Vec::new();
        frame.emit(&mut again);
        let (found, _) = Frame::parse(&again).expect("an encoded frame").expect("a whole frame");
        assert_eq!(found, frame);
        if let Frame::Show(change) = &frame {
            change.apply(&mut [0; 48]);
        }
        seen(shorten(&format!("{frame:?}")));
        assert!(length > 0, "a frame has bytes");
        rest = &rest[length..];
    }
}

pub fn session_frames() -> Vec<Vec<u8>> {
    let peer = Peer { pid: 7, command: "armctl yrcx status".to_owned(), for_ms: 3 };
    let frames = [
        Frame::Control(Control::Take { number: 3, channel: 1 }),
        Frame::Control(Control::Held(peer)),
        Frame::Control(Control::Reopened { generation: 2, shown: vec![0x41, 0] }),
        Frame::Control(Control::Will(Some(Change { generation: 1, mask: vec![1], value: vec![1] }))),
        Frame::Image(vec![1, 2, 3]),
        Frame::Show(Change { generation: 9, mask: vec![0xFF, 0x40], value: vec![1, 0] }),
        Frame::Data { channel: 1, bytes: b"YERC".to_vec() },
    ];
    let bytes = |frame: &Frame| {
        let mut bytes = Vec::new();
        frame.emit(&mut bytes);
        bytes
    };
    let each: Vec<Vec<u8>> = frames.iter().map(bytes).collect();
    [each.clone(), vec![each.concat()]].concat()
}

pub fn http(data: &[u8]) {
    let answer = |request: &armctl_transport::http::Request<'_>| match request.path {
        "/metrics" => Answer::text(Status::Ok, &"armctl_robot_up 1\n".repeat(100)),
        _ => Answer::text(Status::NotFound, request.accept.unwrap_or("no such page")),
    };
    // A client sends its request in pieces.
    let half = &data[..data.len() / 2];
    let first = respond(half, &answer);
    let Some(response) = first.or_else(|| respond(data, &answer)) else { return };
    let (head, _) = response.parts();
    assert!(head.starts_with("HTTP/1.1 ") && head.ends_with("\r\n\r\n"));
    assert_eq!(head.matches("\r\n\r\n").count(), 1, "a client cannot end the head");
}

pub fn http_requests() -> Vec<Vec<u8>> {
    const REQUESTS: [&str; 4] = [
        "GET /metrics HTTP/1.1\r\nHost: a\r\nAccept: application/openmetrics-text\r\nAccept-Encoding: br, gzip;q=0.5\r\n\r\n",
        "HEAD /metrics?x=1 HTTP/1.0\r\n\r\n",
        "POST /metrics HTTP/1.1\r\nContent-Length: 3\r\n\r\nabc",
        "GET / HTTP/1.1\r\n",
    ];
    REQUESTS.map(|request| request.as_bytes().to_vec()).to_vec()
}

/// The first byte selects the version; the rest are pieces from a broker.
pub fn mqtt(data: &[u8]) {
    let Some((first, rest)) = data.split_first() else { return };
    let version = if first % 2 == 0 { Version::V3 } else { Version::V5 };
    let message = |topic: &str| Message {
        topic: topic.to_owned(),
        payload: b"{}".to_vec(),
        retain: true,
        acknowledged: true,
        expiry: Some(Duration::from_secs(60)),
    };
    let hello = Hello {
        version,
        client_id: "armctl".to_owned(),
        user: None,
        password: None,
        keep_alive: Duration::from_secs(30),
        will: Some(message("will")),
    };
    let mut now = Instant::now();
    let mut session = Session::new(&hello, now, now + Duration::from_secs(10)).expect("a valid client");
    for (number, (control, piece)) in pieces(rest).enumerate() {
        now += pause(control);
        session.poll(now);
        session.handle(now, piece);
        seen(session.subscribe(now, &["a/+".to_owned()]).is_ok());
        seen(session.publish(now, &message("a/b")).is_ok());
        if number % 4 == 3 {
            session.ping(now);
        }
        while let Some(event) = session.next_event() {
            seen(format!("{event:?}"));
        }
        seen((session.due(), session.room()));
        assert!(session.outgoing.len() < 1 << 20, "the output is limited");
        if control & 0x40 != 0 {
            session.outgoing.clear();
        }
    }
    session.disconnect(now);
}

pub fn mqtt_packets() -> Vec<Vec<u8>> {
    const V3: [&[u8]; 6] = [
        &[0x20, 2, 0, 0],
        &[0x40, 2, 0, 1],
        &[0x90, 3, 0, 2, 1],
        &[0x30, 6, 0, 3, b'a', b'/', b'b', b'x'],
        &[0x32, 8, 0, 3, b'a', b'/', b'b', 0, 9, b'x'],
        &[0xD0, 0],
    ];
    const V5: [&[u8]; 7] = [
        &[0x20, 6, 0, 0, 3, 0x21, 0, 5],
        &[0x40, 4, 0, 1, 0x10, 0],
        &[0x90, 4, 0, 2, 0, 1],
        &[0x30, 7, 0, 3, b'a', b'/', b'b', 0, b'x'],
        &[0x32, 12, 0, 3, b'a', b'/', b'b', 0, 9, 3, 0x23, 0, 1, b'x'],
        &[0xD0, 0],
        &[0xE0, 2, 0x8B, 0],
    ];
    let script = |version: u8, packets: &[&[u8]]| {
        let packets: Vec<Vec<u8>> = packets.iter().map(|packet| packet.to_vec()).collect();
        [&[version][..], &seeds::script(0x41, &packets)].concat()
    };
    vec![script(0, &V3), script(1, &V5), script(1, &[&[0x20, 5, 0, 0x87, 2, 0x1F, 0]])]
}

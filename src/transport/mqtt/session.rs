//! MQTT protocol session: time and bytes in, bytes and events out. `mqtt-protocol-core` encodes the packets.

use std::collections::{HashMap, VecDeque};
use std::time::Duration;

use mqtt_protocol_core::mqtt::common::Cursor;
use mqtt_protocol_core::mqtt::connection::{self, ConnectionOptions, TimerKind};
use mqtt_protocol_core::mqtt::packet::{Packet, Properties, Qos, SubEntry, SubOpts, v3_1_1, v5_0};
use mqtt_protocol_core::mqtt::prelude::*;
use mqtt_protocol_core::mqtt::result_code::MqttError;
use mqtt_protocol_core::mqtt::{Connection, Version as Spoken, role};
use tokio::time::Instant;

use super::message::{Event, Hello, Message, Refusal, SendError, Version};
use super::packets::{IdentifierCheck, connect, expiry_property, texts};
use super::{FLOOD, Loss};

/// Maximum size of a packet from a broker, in bytes. Commands and states need a few hundred bytes.
pub const MAX_PACKET_SIZE: u32 = 256 * 1024;
/// Receive maximum: number of messages that a broker may send before this client has acknowledged them.
const RECEIVE_MAXIMUM: u16 = 16;
/// Time limit for the answer to a ping.
const PONG_TIMEOUT: Duration = Duration::from_secs(10);
/// First byte that a broker sends, in version 3.1.1 (section 3.2.1) and also in version 5.
const CONNACK: u8 = 0x20;
/// Size limit of a usual answer of a broker. An answer up to this size does not count as flood.
const ANSWER: u32 = 256;
/// Maximum number of bytes of acknowledgements that wait to be sent to a broker.
const REPLIES: usize = 64 * 1024;

/// A session, from CONNECT to its end. A session cannot be used again.
pub struct Session {
    inner: Connection<role::Client>,
    version: Version,
    /// Bytes to send. The caller removes the bytes that it has sent.
    pub outgoing: Vec<u8>,
    events: VecDeque<Event>,
    timers: Vec<(TimerKind, Instant)>,
    /// Messages in progress: packet identifier, and number of the message in this client. After the acknowledgement,
    /// the identifier is free again, even if the event of the acknowledgement is still in the queue.
    under_way: HashMap<u16, u64>,
    published: u64,
    answer_by: Option<Instant>,
    /// Number of the last ping that was sent. The field below is the number of the last answered ping.
    pings: u64,
    pongs: u64,
    has_heard: bool,
    flood: Flood,
    identifiers: IdentifierCheck,
    /// Number of bytes of replies that were queued after the connection last accepted all output.
    replies: usize,
    is_over: bool,
}

/// Counters of unsolicited traffic, counted from `since`.
#[derive(Debug)]
struct Flood {
    since: Instant,
    packets: u32,
    bytes: u32,
}

impl Flood {
    fn new(since: Instant) -> Self {
        Self { since, packets: 0, bytes: 0 }
    }

    fn bytes(&mut self, now: Instant, count: usize) {
        if now.saturating_duration_since(self.since) >= Duration::from_secs(FLOOD.2) {
            *self = Self::new(now);
        }
        self.bytes = self.bytes.saturating_add(u32::try_from(count).unwrap_or(u32::MAX));
    }

    fn packet(&mut self, is_answer: bool) {
        if is_answer {
            self.bytes = self.bytes.saturating_sub(ANSWER);
        } else {
            self.packets = self.packets.saturating_add(1);
        }
    }

    fn is_too_much(&self) -> bool {
        self.packets > FLOOD.0 || self.bytes > FLOOD.1
    }
}

impl Session {
    /// Creates a session and queues CONNECT. The broker must answer before `answer_by`.
    ///
    /// # Errors
    /// A text is not valid in MQTT: it is longer than 65,535 bytes, or contains NUL.
    pub fn new(hello: &Hello, now: Instant, answer_by: Instant) -> Result<Self, SendError> {
        let spoken = match hello.version {
            Version::V3 => Spoken::V3_1_1,
            Version::V5 => Spoken::V5_0,
        };
        let options =
            ConnectionOptions::new().maximum_packet_size_recv(MAX_PACKET_SIZE).receive_maximum(RECEIVE_MAXIMUM);
        let mut inner = Connection::with_options(spoken, options);
        inner.set_auto_pub_response(true);
        inner.set_pingresp_recv_timeout(u64::try_from(PONG_TIMEOUT.as_millis()).unwrap_or(u64::MAX));
        let mut session = Self {
            inner,
            version: hello.version,
            outgoing: Vec::new(),
            events: VecDeque::new(),
            timers: Vec::new(),
            under_way: HashMap::new(),
            published: 0,
            answer_by: Some(answer_by),
            pings: 0,
            pongs: 0,
            has_heard: false,
            flood: Flood::new(now),
            identifiers: IdentifierCheck::default(),
            replies: 0,
            is_over: false,
        };
        session.send(now, connect(hello)?)?;
        Ok(session)
    }

    /// Returns the next event.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Time at which [`poll`](Self::poll) must be called again.
    pub fn due(&self) -> Option<Instant> {
        self.timers.iter().map(|(_, at)| *at).chain(self.answer_by).min()
    }

    /// Executes the work that is due.
    pub fn poll(&mut self, now: Instant) {
        if self.answer_by.is_some_and(|by| by <= now) {
            self.lose(Loss::Unanswered);
        }
        while let Some(at) = self.timers.iter().position(|(_, at)| *at <= now).filter(|_| !self.is_over) {
            let (kind, _) = self.timers.swap_remove(at);
            if matches!(kind, TimerKind::PingrespRecv | TimerKind::PingreqRecv) {
                self.lose(Loss::Silent);
            } else {
                let events = self.inner.notify_timer_fired(kind);
                self.take(now, events);
            }
        }
    }

    /// Handles bytes from the broker.
    pub fn handle(&mut self, now: Instant, bytes: &[u8]) {
        // Only a server of another protocol begins with another byte than CONNACK. The error is reported now, because
        // such a server would never send a CONNACK.
        if let (Some(first), false) = (bytes.first(), std::mem::replace(&mut self.has_heard, true))
            && *first != CONNACK
        {
            return self.lose(Loss::Garbage(format!("the data begins with 0x{first:02X}")));
        }
        if !bytes.iter().all(|byte| self.identifiers.accepts(*byte)) {
            return self.lose(Loss::Garbage("a packet has the identifier 0".to_owned()));
        }
        self.flood.bytes(now, bytes.len());
        if self.outgoing.is_empty() {
            self.replies = 0;
        }
        let unsent = self.outgoing.len();
        let mut cursor = Cursor::new(bytes);
        let end = u64::try_from(bytes.len()).unwrap_or(u64::MAX);
        while !self.is_over && cursor.position() < end {
            let before = cursor.position();
            let events = self.inner.recv(&mut cursor);
            self.take(now, events);
            if self.flood.is_too_much() {
                self.lose(Loss::Flood);
            }
            if cursor.position() == before {
                break;
            }
        }
        self.replies += self.outgoing.len() - unsent;
        if self.replies > REPLIES {
            self.lose(Loss::Unread);
        }
    }

    /// Handles the end of the connection.
    pub fn lose(&mut self, loss: Loss) {
        if !std::mem::replace(&mut self.is_over, true) {
            self.timers.clear();
            self.answer_by = None;
            self.events.push_back(Event::Lost(loss));
        }
    }

    /// Number of further unacknowledged messages that the broker accepts now; `None` if the broker has set no limit.
    pub fn room(&self) -> Option<u16> {
        self.inner.get_receive_maximum_vacancy_for_send()
    }

    /// Queues a message. Returns the number that its acknowledgement will have; `None` for a message without
    /// acknowledgement.
    ///
    /// # Errors
    /// The message is not valid or too large. Nothing was sent.
    pub fn publish(&mut self, now: Instant, message: &Message) -> Result<Option<u64>, SendError> {
        let Message { topic, payload, retain, acknowledged, expiry } = message;
        // The standard forbids NUL (section 1.5.4), and some brokers close the connection.
        if topic.is_empty() || topic.contains('\0') {
            return Err(SendError::Invalid);
        }
        let id = if *acknowledged { Some(self.inner.acquire_packet_id()?) } else { None };
        let qos = if *acknowledged { Qos::AtLeastOnce } else { Qos::AtMostOnce };
        let built: Result<Packet, MqttError> = match self.version {
            Version::V3 => v3_1_1::Publish::builder().topic_name(topic.as_str()).and_then(|builder| {
                let packet = builder.qos(qos).retain(*retain).packet_id(id).payload(payload.as_slice()).build()?;
                Ok(packet.into())
            }),
            Version::V5 => v5_0::Publish::builder().topic_name(topic.as_str()).and_then(|builder| {
                let builder = builder.qos(qos).retain(*retain).packet_id(id).payload(payload.as_slice());
                let packet = builder
                    .props(expiry.map(expiry_property).transpose()?.into_iter().collect::<Properties>())
                    .build()?;
                Ok(packet.into())
            }),
        };
        let sent = built.map_err(SendError::from).and_then(|packet| self.send(now, packet));
        if sent.is_err()
            && let Some(id) = id
        {
            let events = self.inner.release_packet_id(id);
            self.take(now, events);
        }
        sent?;
        Ok(id.map(|id| {
            self.published += 1;
            self.under_way.insert(id, self.published);
            self.published
        }))
    }

    /// Subscribes to these topics.
    pub fn subscribe(&mut self, now: Instant, topics: &[String]) -> Result<(), SendError> {
        let entry = |topic: &String| SubEntry::new(topic.as_str(), SubOpts::new().set_qos(Qos::AtLeastOnce));
        let entries = topics.iter().map(entry).collect::<Result<Vec<_>, _>>()?;
        let id = self.inner.acquire_packet_id()?;
        let packet: Packet = match self.version {
            Version::V3 => v3_1_1::Subscribe::builder().packet_id(id).entries(entries).build()?.into(),
            Version::V5 => v5_0::Subscribe::builder().packet_id(id).entries(entries).build()?.into(),
        };
        self.send(now, packet)
    }

    /// Ends the subscription to these topics.
    pub fn unsubscribe(&mut self, now: Instant, topics: &[String]) -> Result<(), SendError> {
        let entries = topics.iter().map(String::as_str);
        let id = self.inner.acquire_packet_id()?;
        let packet: Packet = match self.version {
            Version::V3 => v3_1_1::Unsubscribe::builder().packet_id(id).entries(entries)?.build()?.into(),
            Version::V5 => v5_0::Unsubscribe::builder().packet_id(id).entries(entries)?.build()?.into(),
        };
        self.send(now, packet)
    }

    /// Queues a ping and returns its number. The answer shows that everything before the ping has arrived at the
    /// broker.
    pub fn ping(&mut self, now: Instant) -> u64 {
        let packet: Result<Packet, MqttError> = match self.version {
            Version::V3 => v3_1_1::Pingreq::builder().build().map(Into::into),
            Version::V5 => v5_0::Pingreq::builder().build().map(Into::into),
        };
        // A ping has no variable content, so it is always valid. If it does not fit into the output, it is not counted.
        let _sent = packet.map_err(SendError::from).and_then(|packet| self.send(now, packet));
        self.pings
    }

    /// Queues DISCONNECT, so that the broker does not publish the last will.
    pub fn disconnect(&mut self, now: Instant) {
        let packet: Result<Packet, MqttError> = match self.version {
            Version::V3 => v3_1_1::Disconnect::builder().build().map(Into::into),
            Version::V5 => v5_0::Disconnect::builder().build().map(Into::into),
        };
        // An error is ignored, because the caller closes the connection next.
        let _sent = packet.map_err(SendError::from).and_then(|packet| self.send(now, packet));
        self.timers.clear();
    }

    fn send(&mut self, now: Instant, packet: Packet) -> Result<(), SendError> {
        let events = self.inner.send(packet);
        let refused = events.iter().find_map(|event| match event {
            connection::Event::NotifyError(error) => Some(SendError::from(*error)),
            _ => None,
        });
        let events = events.into_iter().filter(|event| !matches!(event, connection::Event::NotifyError(_)));
        self.take(now, events.collect());
        refused.map_or(Ok(()), Err)
    }

    fn take(&mut self, now: Instant, events: Vec<connection::Event>) {
        let mut closes = false;
        for event in events {
            match event {
                connection::Event::RequestSendPacket { packet, .. } => {
                    if matches!(packet, Packet::V3_1_1Pingreq(_) | Packet::V5_0Pingreq(_)) {
                        self.pings += 1;
                    }
                    self.outgoing.extend(packet.to_continuous_buffer());
                }
                connection::Event::NotifyPacketReceived(packet) => self.receive(packet),
                connection::Event::RequestTimerReset { kind, duration_ms } => {
                    self.timers.retain(|(other, _)| *other != kind);
                    self.timers.push((kind, now + Duration::from_millis(duration_ms)));
                }
                connection::Event::RequestTimerCancel(kind) => self.timers.retain(|(other, _)| *other != kind),
                connection::Event::NotifyError(MqttError::PacketTooLarge) => self.lose(Loss::TooLarge),
                connection::Event::NotifyError(error) => self.lose(Loss::Garbage(error.to_string())),
                connection::Event::RequestClose => closes = true,
                connection::Event::NotifyPacketIdReleased(_) => {}
            }
        }
        // If an earlier error has ended the session, that error is kept. Otherwise the session ends with this general
        // reason.
        if closes {
            self.lose(Loss::Garbage("the broker does not follow the protocol".to_owned()));
        }
    }

    fn receive(&mut self, packet: Packet) {
        let is_connack = matches!(packet, Packet::V3_1_1Connack(_) | Packet::V5_0Connack(_));
        if is_connack && self.answer_by.take().is_none() {
            return self.lose(Loss::Protocol("a second CONNACK"));
        }
        self.flood.packet(match &packet {
            Packet::V3_1_1Puback(puback) => self.under_way.contains_key(&puback.packet_id()),
            Packet::V5_0Puback(puback) => self.under_way.contains_key(&puback.packet_id()),
            Packet::V3_1_1Pingresp(_) | Packet::V5_0Pingresp(_) => self.pongs < self.pings,
            // The codec accepts this packet only for a pending subscription.
            Packet::V3_1_1Suback(_) | Packet::V5_0Suback(_) => true,
            _ => is_connack,
        });
        let event = match packet {
            Packet::V3_1_1Connack(connack) => match connack.return_code() as u8 {
                0 => Event::Connected,
                code => Event::Refused(Refusal { version: Version::V3, code, reason: None, server: None }),
            },
            Packet::V5_0Connack(connack) => match connack.reason_code() as u8 {
                0 => Event::Connected,
                code => {
                    let (reason, server) = texts(connack.props());
                    Event::Refused(Refusal { version: Version::V5, code, reason, server })
                }
            },
            Packet::V3_1_1Puback(puback) => match self.under_way.remove(&puback.packet_id()) {
                Some(number) => Event::Acknowledged(number, None),
                None => return,
            },
            Packet::V5_0Puback(puback) => {
                let code = puback.reason_code().map_or(0, |code| code as u8);
                match self.under_way.remove(&puback.packet_id()) {
                    Some(number) => Event::Acknowledged(number, (code >= 0x80).then_some(code)),
                    None => return,
                }
            }
            Packet::V3_1_1Suback(suback) => {
                Event::Subscribed(suback.return_codes().iter().all(|code| (*code as u8) < 0x80))
            }
            Packet::V5_0Suback(suback) => {
                Event::Subscribed(suback.reason_codes().iter().all(|code| (*code as u8) < 0x80))
            }
            Packet::V3_1_1Publish(publish) => Event::Message(Message {
                topic: publish.topic_name().to_owned(),
                payload: publish.payload().as_slice().to_vec(),
                retain: publish.retain(),
                acknowledged: publish.qos() != Qos::AtMostOnce,
                expiry: None,
            }),
            Packet::V5_0Publish(publish) => Event::Message(Message {
                topic: publish.topic_name().to_owned(),
                payload: publish.payload().as_slice().to_vec(),
                retain: publish.retain(),
                acknowledged: publish.qos() != Qos::AtMostOnce,
                expiry: None,
            }),
            Packet::V3_1_1Pingresp(_) | Packet::V5_0Pingresp(_) => {
                // An answer is ignored if no ping is waiting for it.
                self.pongs = self.pings.min(self.pongs + 1);
                Event::Pong(self.pongs)
            }
            Packet::V5_0Disconnect(disconnect) => {
                let code = disconnect.reason_code().map_or(0, |code| code as u8);
                let reason = disconnect.props().as_ref().and_then(|props| texts(props).0);
                return self.lose(Loss::Goodbye { code, reason });
            }
            // These packets are answers to packets that this client never sends.
            _ => return,
        };
        self.events.push_back(event);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn hello(version: Version) -> Hello {
        Hello {
            version,
            client_id: "cell7".to_owned(),
            user: Some("plant".to_owned()),
            password: Some(b"secret".to_vec()),
            keep_alive: Duration::from_secs(30),
            will: Some(Message {
                topic: "armctl/cell7/state".to_owned(),
                payload: b"offline".to_vec(),
                retain: true,
                acknowledged: true,
                expiry: None,
            }),
        }
    }

    fn started(version: Version) -> (Session, Instant) {
        let now = Instant::now();
        (Session::new(&hello(version), now, now + Duration::from_secs(10)).unwrap(), now)
    }

    fn connected(version: Version) -> (Session, Instant) {
        let (mut session, now) = started(version);
        session.outgoing.clear();
        session.handle(now, if version == Version::V3 { &[0x20, 2, 0, 0] } else { &[0x20, 3, 0, 0, 0] });
        assert!(matches!(session.next_event(), Some(Event::Connected)));
        (session, now)
    }

    fn message(acknowledged: bool) -> Message {
        Message { topic: "a/b".to_owned(), payload: b"x".to_vec(), retain: true, acknowledged, expiry: None }
    }

    #[test]
    fn connect_packet_matches_the_standard() {
        // The expected bytes follow MQTT 3.1.1, sections 3.1.1 to 3.1.3: clean session, will with QoS 1 and retain,
        // user name and password.
        let (session, _) = started(Version::V3);
        let fields = [&b"cell7"[..], b"armctl/cell7/state", b"offline", b"plant", b"secret"];
        let mut expected = vec![0x10, 0, 0, 4];
        expected.extend(b"MQTT");
        expected.extend([4, 0b1110_1110, 0, 30]);
        for field in fields {
            expected.extend(u16::try_from(field.len()).unwrap().to_be_bytes());
            expected.extend(field);
        }
        expected[1] = u8::try_from(expected.len() - 2).unwrap();
        assert_eq!(*session.outgoing, expected);
        let shown = format!("{:?}", hello(Version::V5));
        assert!(!shown.contains("secret") && shown.contains("plant"), "{shown}");
    }

    #[test]
    fn only_version_5_sends_the_expiry() {
        // MQTT 5, sections 3.3.2.3 and 3.3.2.3.3: length of the properties, identifier 2, seconds in four bytes.
        const TOPIC: &[u8] = b"\0\x03a/b\0\x01";
        for (version, expiry, properties) in [
            (Version::V5, Some(Duration::from_millis(180_001)), &[5, 2, 0, 0, 0, 181][..]),
            (Version::V5, None, &[0]),
            (Version::V3, Some(Duration::from_secs(180)), &[]),
        ] {
            let (mut session, now) = connected(version);
            session.publish(now, &Message { expiry, ..message(true) }).unwrap();
            assert_eq!(session.outgoing[2..], [TOPIC, properties, b"x"].concat(), "{version:?} {expiry:?}");
        }
    }

    #[test]
    fn an_unsubscribe_is_no_event() {
        for (version, unsuback) in [(Version::V3, &[0xb0, 2, 0, 1][..]), (Version::V5, &[0xb0, 4, 0, 1, 0, 0])] {
            let (mut session, now) = connected(version);
            session.unsubscribe(now, &["a/b".to_owned()]).unwrap();
            assert_eq!(session.outgoing[0], 0xa2);
            session.handle(now, unsuback);
            assert!(session.next_event().is_none());
        }
    }

    #[test]
    fn a_message_is_acknowledged_by_its_number() {
        for version in [Version::V3, Version::V5] {
            let (mut session, now) = connected(version);
            let numbers = [(); 2].map(|()| session.publish(now, &message(true)).unwrap().unwrap());
            assert_eq!(session.outgoing[0], 0x33, "PUBLISH with QoS 1, kept");
            // Two acknowledgements arrive at once. Their identifiers are free before the events are taken from the
            // queue.
            session.handle(now, &[0x40, 2, 0, 1, 0x40, 2, 0, 2]);
            let third = session.publish(now, &message(true)).unwrap().unwrap();
            let mut acknowledged = Vec::new();
            while let Some(Event::Acknowledged(number, None)) = session.next_event() {
                acknowledged.push(number);
            }
            assert_eq!(acknowledged, numbers);
            assert!(!numbers.contains(&third));
            assert_eq!(session.publish(now, &message(false)), Ok(None));
        }
        // In MQTT 5, a broker can reject a message. "Not authorized" is a rejection; "no subscribers" is not.
        let (mut session, now) = connected(Version::V5);
        session.publish(now, &message(true)).unwrap();
        session.handle(now, &[0x40, 3, 0, 1, 0x87]);
        assert!(matches!(session.next_event(), Some(Event::Acknowledged(1, Some(0x87)))));
        session.publish(now, &message(true)).unwrap();
        session.handle(now, &[0x40, 3, 0, 1, 0x10]);
        assert!(matches!(session.next_event(), Some(Event::Acknowledged(2, None))));
    }

    #[test]
    fn refusal_has_code_and_text() {
        let (mut session, now) = started(Version::V3);
        session.handle(now, &[0x20, 2, 0, 5]);
        assert!(matches!(session.next_event(), Some(Event::Refused(Refusal { code: 5, .. }))));
        let (mut session, now) = started(Version::V5);
        session.handle(now, &[0x20, 8, 0, 0x87, 5, 0x1f, 0, 2, b'n', b'o']);
        let Some(Event::Refused(refusal)) = session.next_event() else { panic!("no refusal") };
        assert_eq!((refusal.code, refusal.reason.as_deref()), (0x87, Some("no")));
    }

    #[test]
    fn a_broker_that_hangs_is_noticed() {
        let (mut session, now) = started(Version::V5);
        assert_eq!(session.due(), Some(now + Duration::from_secs(10)));
        session.poll(now + Duration::from_secs(10));
        assert!(matches!(session.next_event(), Some(Event::Lost(Loss::Unanswered))));
        let (mut session, now) = connected(Version::V3);
        let ping = session.due().expect("a ping is due");
        assert!(ping <= now + Duration::from_secs(30));
        session.poll(ping);
        assert!(session.outgoing.ends_with(&[0xc0, 0]), "{:?}", session.outgoing);
        session.poll(ping + PONG_TIMEOUT);
        assert!(matches!(session.next_event(), Some(Event::Lost(Loss::Silent))));
    }

    #[test]
    fn oversized_or_invalid_packet_ends_the_session() {
        let (mut session, now) = connected(Version::V3);
        // A PUBLISH that states a length of 256 MB.
        session.handle(now, &[0x30, 0xff, 0xff, 0xff, 0x7f, 1, 2, 3]);
        assert!(matches!(session.next_event(), Some(Event::Lost(Loss::TooLarge))));
        let (mut session, now) = started(Version::V5);
        session.handle(now, b"HTTP/1.1 400 Bad Request\r\n\r\n");
        assert!(matches!(session.next_event(), Some(Event::Lost(Loss::Garbage(_)))));
        let (mut session, now) = connected(Version::V5);
        session.handle(now, &[0xe0, 1, 0x8e]);
        let Some(Event::Lost(loss)) = session.next_event() else { panic!("it goes on") };
        assert!(loss.is_takeover() && loss.to_string().contains("another client"), "{loss}");
    }

    #[test]
    fn second_connack_is_a_protocol_error() {
        for (version, connack) in [(Version::V3, &[0x20, 2, 0, 0][..]), (Version::V5, &[0x20, 3, 0, 0, 0])] {
            let (mut session, now) = connected(version);
            session.handle(now, &connack.repeat(4096));
            let Some(Event::Lost(loss)) = session.next_event() else { panic!("it goes on") };
            assert_eq!(loss.to_string(), "the broker does not follow the MQTT protocol: a second CONNACK");
            assert!(session.next_event().is_none());
        }
    }

    /// Handles the same packet again and again, with the pause `apart`. Returns the number of packets that the session
    /// accepted, and the reason for which it ended.
    fn accepted_packets(packet: &[u8], apart: Duration, most: usize) -> (usize, Option<String>) {
        let (mut session, now) = connected(Version::V3);
        let mut at = now;
        for number in 0..most {
            session.handle(at, packet);
            session.outgoing.clear();
            while let Some(event) = session.next_event() {
                if let Event::Lost(loss) = event {
                    return (number, Some(loss.to_string()));
                }
            }
            at += apart;
        }
        (most, None)
    }

    #[test]
    fn limits_the_rate_of_a_broker() {
        let large = [&[0x30, 0xff, 0xff, 0x07, 0, 1, b'a'][..], &vec![b'x'; 131_068]].concat();
        for (packet, most) in [(&[0x30, 3, 0, 1, b'a'][..], 1000), (&[0xd0, 0], 1000), (&large, 31)] {
            let (count, why) = accepted_packets(packet, Duration::ZERO, 5000);
            assert_eq!(count, most);
            assert!(why.unwrap().contains("the broker sends too much"));
            assert_eq!(accepted_packets(packet, Duration::from_secs(1), 5000), (5000, None), "what is slow goes on");
        }
    }

    #[test]
    fn expected_answers_do_not_count_as_a_flood() {
        let (mut session, now) = connected(Version::V5);
        // Each acknowledgement contains a reason of 100 letters.
        let mut puback = vec![0x40, 107, 0, 0, 0, 103, 0x1f, 0, 100];
        puback.extend([b'x'; 100]);
        for _ in 0..100_000 {
            let number = session.publish(now, &message(true)).unwrap();
            // Layout of PUBLISH: type, length, topic with its length, identifier.
            let id = [session.outgoing[7], session.outgoing[8]];
            session.outgoing.clear();
            puback[2..4].copy_from_slice(&id);
            session.handle(now, &puback);
            let Some(Event::Acknowledged(acknowledged, None)) = session.next_event() else { panic!("not taken") };
            assert_eq!(Some(acknowledged), number);
        }
    }

    #[test]
    fn limits_unread_replies() {
        let (mut session, now) = connected(Version::V3);
        session.outgoing.clear();
        // One packet every 100 ms does not count as flood. The test sends no output, so the replies wait.
        for number in 1..u16::MAX {
            let [high, low] = number.to_be_bytes();
            session.handle(now + Duration::from_millis(100) * number.into(), &[0x32, 5, 0, 1, b'a', high, low]);
        }
        assert!(session.outgoing.len() <= REPLIES + 4);
        let lost = std::iter::from_fn(|| session.next_event()).any(|event| matches!(event, Event::Lost(Loss::Unread)));
        assert!(lost);
    }

    #[test]
    fn rejects_invalid_topics() {
        let (mut session, now) = connected(Version::V5);
        session.outgoing.clear();
        for topic in ["", "a/+/b", "a/#", "a\0b"] {
            let message = Message { topic: topic.to_owned(), ..message(true) };
            assert_eq!(session.publish(now, &message), Err(SendError::Invalid), "{topic:?}");
        }
        assert!(session.outgoing.is_empty() && session.next_event().is_none());
    }

    proptest! {
        #[test]
        fn no_bytes_make_it_panic(chunks in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..64), 0..8), is_five: bool, is_open: bool) {
            let version = if is_five { Version::V5 } else { Version::V3 };
            let (mut session, now) = if is_open { connected(version) } else { started(version) };
            if is_open {
                session.publish(now, &message(true)).unwrap();
            }
            for chunk in chunks {
                session.handle(now, &chunk);
                while session.next_event().is_some() {}
            }
        }

        #[test]
        fn no_packets_make_it_panic(kind in 0_u8..16, flags in 0_u8..16, body in prop::collection::vec(any::<u8>(), 0..127), is_five: bool, is_open: bool) {
            let version = if is_five { Version::V5 } else { Version::V3 };
            let (mut session, now) = if is_open { connected(version) } else { started(version) };
            if is_open {
                session.publish(now, &message(true)).unwrap();
                session.subscribe(now, &["a/#".to_owned()]).unwrap();
            }
            let mut packet = vec![kind << 4 | flags, u8::try_from(body.len()).unwrap()];
            packet.extend(body);
            session.handle(now, &packet);
            session.handle(now, &packet);
            session.poll(now + Duration::from_secs(3600));
        }
    }
}

//! Sparkplug B node (Sparkplug 3.0.0) whose devices are robots.
//!
//! The node sends its birth message (the list of its values) when it is connected and its primary host, if one is set,
//! is online. A robot gets a birth message when it answers, and a death message when it does not answer. Data from
//! times without a connection is sent later as history. The only accepted command is a rebirth request. Nothing from
//! the broker reaches a robot.

mod metrics;
#[cfg(test)]
pub mod tests;

use std::collections::BTreeMap;
use std::fmt;
use std::rc::Rc;
use std::time::Duration;

use srad_types::constants::{BDSEQ, NODE_CONTROL_REBIRTH};
use srad_types::payload::metric::Value;
use srad_types::payload::{DataType, Message as _, Metric, Payload, StateBirthDeathCertificate};
use srad_types::topic::{DeviceMessage, NodeMessage, device_topic, node_topic, state_host_topic};

use super::Kind;
use super::message_format::{MessageFormat, Reaction};
use super::outbox::Record;
use super::topic::Levels;
use super::uplink::{Message, Will};
use crate::command::fleet::also::AlsoCommand;
use crate::command::fleet::poll::{Event, PollResult};
use armctl_frame::output::log::Level;
use armctl_frame::settings::Robot;

/// Type of a null value of a report, whose type is not known before it has a value.
const UNKNOWN: u32 = DataType::Unknown as u32;
/// Minimum time between two births. A rebirth that a host requests earlier waits until this time has passed.
const BIRTHS_MS: u64 = 1000;

mod kind {
    /// Changed values of a device.
    pub const DATA: u8 = 1;
    /// A device answers; all its values.
    pub const BIRTH: u8 = 2;
    /// A device does not answer.
    pub const DEATH: u8 = 3;
}

/// A robot as a Sparkplug device.
#[derive(Debug, Default)]
struct Device {
    /// Last metrics by name, with their aliases.
    metrics: BTreeMap<String, (u64, Metric)>,
    /// Whether the robot answers.
    is_up: bool,
    /// Whether hosts consider the device online.
    is_born: bool,
    /// Time of the last message with all values.
    data_sent_ms: u64,
}

/// Names of the node.
#[derive(Debug, Clone)]
pub struct Names {
    /// Group id.
    pub group: String,
    /// Node id.
    pub node: String,
    /// Primary host ids. The node only sends while one of these hosts is online; with no id, always.
    pub hosts: Vec<String>,
    /// Device ids.
    pub levels: Levels,
}

/// Saves the number of the next connection for the next process.
pub type Remember = Box<dyn FnMut(u8)>;

/// The node.
pub struct Node {
    names: Names,
    kinds: Vec<Kind>,
    also: Rc<[AlsoCommand]>,
    every_ms: u64,
    /// `bdSeq` (the number that a birth message and its death message have in common) of this connection and of the
    /// next connection.
    bd_seq: (u8, u8),
    remember: Remember,
    /// Sequence number of the next message.
    seq: u8,
    /// Number of birth messages so far.
    epoch: u64,
    is_connected: bool,
    is_born: bool,
    born_ms: u64,
    /// Whether a host has requested a rebirth that waits for [`BIRTHS_MS`].
    is_rebirth_due: bool,
    /// Broker of the connection.
    broker: usize,
    /// Time of the last message of each host at each broker, and its state. A new connection starts without states.
    hosts: BTreeMap<(usize, String), (u64, Option<bool>)>,
    devices: BTreeMap<String, Device>,
    next_alias: u64,
}

impl fmt::Debug for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}, born {}, {} devices", self.names, self.is_born, self.devices.len())
    }
}

impl Node {
    /// Creates a node for these kinds and extra commands; unchanged data is sent again after `every_ms`. `bd_seq` is
    /// the number of the first connection.
    pub fn new(
        names: Names,
        (kinds, also): (&[Kind], Rc<[AlsoCommand]>),
        every_ms: u64,
        (bd_seq, remember): (u8, Remember),
    ) -> Self {
        Self {
            names,
            kinds: kinds.to_vec(),
            also,
            every_ms,
            bd_seq: (bd_seq, bd_seq),
            remember,
            seq: 0,
            epoch: 0,
            is_connected: false,
            is_born: false,
            born_ms: 0,
            is_rebirth_due: false,
            broker: 0,
            hosts: BTreeMap::new(),
            devices: BTreeMap::new(),
            next_alias: 1,
        }
    }

    fn topic(&self, message: &NodeMessage) -> String {
        node_topic(&self.names.group, message, &self.names.node)
    }

    /// A message with the next sequence number.
    fn with_sequence(&mut self, topic: String, metrics: Vec<Metric>, now_ms: u64) -> Message {
        let seq = self.seq;
        self.seq = seq.wrapping_add(1);
        let payload = Payload { timestamp: Some(now_ms), metrics, seq: Some(seq.into()), uuid: None, body: None };
        Message { topic, payload: payload.encode_to_vec(), retain: false, acknowledged: false, expiry: None }
    }

    fn device_message(&mut self, message: &DeviceMessage, device: &str, metrics: Vec<Metric>, now_ms: u64) -> Message {
        let topic = device_topic(&self.names.group, message, &self.names.node, device);
        self.with_sequence(topic, metrics, now_ms)
    }

    /// NDEATH message. It has the `bdSeq` of the birth message of its connection, and no sequence number.
    fn death(&self, now_ms: u64) -> Message {
        let metrics = vec![bd_seq(self.bd_seq.0, now_ms)];
        let payload = Payload { timestamp: Some(now_ms), metrics, seq: None, uuid: None, body: None };
        Message {
            topic: self.topic(&NodeMessage::NDeath),
            payload: payload.encode_to_vec(),
            retain: false,
            acknowledged: true,
            expiry: None,
        }
    }

    /// NBIRTH and the DBIRTH of all devices that answer.
    fn births(&mut self, now_ms: u64) -> Vec<Message> {
        self.epoch += 1;
        self.seq = 0;
        self.is_born = true;
        self.is_rebirth_due = false;
        self.born_ms = now_ms;
        let mut rebirth = resolve_metric(NODE_CONTROL_REBIRTH, DataType::Boolean, Value::BooleanValue(false), now_ms);
        rebirth.alias = None;
        let software = Value::StringValue(concat!("armctl ", env!("CARGO_PKG_VERSION")).to_owned());
        let metrics = vec![
            bd_seq(self.bd_seq.0, now_ms),
            rebirth,
            resolve_metric("Properties/Software", DataType::String, software, now_ms),
        ];
        let mut messages = vec![self.with_sequence(self.topic(&NodeMessage::NBirth), metrics, now_ms)];
        let up: Vec<String> =
            self.devices.iter().filter(|(_, device)| device.is_up).map(|(id, _)| id.clone()).collect();
        for device in self.devices.values_mut() {
            device.is_born = false;
        }
        messages.extend(up.into_iter().filter_map(|id| self.birth(&id, now_ms)));
        messages
    }

    /// DBIRTH with all known metrics.
    fn birth(&mut self, id: &str, now_ms: u64) -> Option<Message> {
        let device = self.devices.get_mut(id)?;
        device.is_born = true;
        let whole = |(alias, metric): &(u64, Metric)| Metric { alias: Some(*alias), ..metric.clone() };
        let metrics = device.metrics.values().map(whole).collect();
        Some(self.device_message(&DeviceMessage::DBirth, id, metrics, now_ms))
    }

    /// Handles a successful poll of a robot.
    fn data_records(&mut self, look: &PollResult, now_ms: u64) -> Option<Record> {
        let id = self.names.levels.level_of(&look.robot).ok()?;
        let found = metrics::metrics_of_poll(look, &self.kinds, &self.also);
        let device = self.devices.entry(id.clone()).or_default();
        let was_up = std::mem::replace(&mut device.is_up, true);
        let is_due = now_ms.saturating_sub(device.data_sent_ms) >= self.every_ms;
        let mut has_new = !was_up;
        let mut changed = Vec::new();
        for mut metric in found {
            metric.timestamp = Some(now_ms);
            let Some(name) = metric.name.clone() else { continue };
            if let Some((_, last)) = device.metrics.get_mut(&name) {
                if metric.datatype == Some(UNKNOWN) {
                    metric.datatype = last.datatype;
                }
                // A metric keeps its first type, because hosts use the type from the birth message.
                if metric.datatype != last.datatype {
                    continue;
                }
                if last.value != metric.value || is_due {
                    changed.push(metric.clone());
                }
                *last = metric;
            } else if metric.datatype != Some(UNKNOWN) {
                has_new = true;
                changed.push(metric.clone());
                device.metrics.insert(name, (self.next_alias, metric));
                self.next_alias += 1;
            }
        }
        let kind = if has_new { kind::BIRTH } else { kind::DATA };
        let metrics =
            if has_new { device.metrics.values().map(|(_, metric)| metric.clone()).collect() } else { changed };
        if metrics.is_empty() {
            return None;
        }
        if has_new || is_due {
            device.data_sent_ms = now_ms;
        }
        Some(self.record(kind, id, metrics, now_ms))
    }

    /// Record for a robot that does not answer or was removed.
    fn death_record(&mut self, robot: &Robot, now_ms: u64) -> Option<Record> {
        let id = self.names.levels.level_of(robot).ok()?;
        let device = self.devices.get_mut(&id)?;
        std::mem::take(&mut device.is_up).then(|| self.record(kind::DEATH, id, Vec::new(), now_ms))
    }

    fn record(&self, kind: u8, key: String, metrics: Vec<Metric>, time_ms: u64) -> Record {
        let body = Payload { timestamp: Some(time_ms), metrics, seq: None, uuid: None, body: None }.encode_to_vec();
        Record { kind, time_ms, key, body, epoch: self.epoch }
    }

    /// DDATA with current or historical values.
    fn data(&mut self, record: &Record, is_history: bool, now_ms: u64) -> Vec<Message> {
        let Ok(Payload { metrics, .. }) = Payload::decode(&record.body[..]) else { return Vec::new() };
        let id = &record.key;
        let device = self.devices.entry(id.clone()).or_default();
        let mut has_new = false;
        let mut last_sent = Vec::with_capacity(metrics.len());
        for metric in metrics {
            let Some(name) = metric.name.clone() else { continue };
            let (alias, last) = device.metrics.entry(name).or_insert_with(|| {
                has_new = true;
                self.next_alias += 1;
                (self.next_alias - 1, Metric { value: None, is_null: Some(true), ..metric.clone() })
            });
            if metric.datatype != last.datatype {
                continue;
            }
            // The datatype is optional (tck-id-payloads-metric-datatype-not-req), but a decoder that does not store
            // birth messages needs it.
            last_sent.push(Metric {
                name: None,
                alias: Some(*alias),
                is_historical: is_history.then_some(true),
                properties: None,
                ..metric
            });
        }
        if last_sent.is_empty() {
            return Vec::new();
        }
        let (is_up, was_born) = (device.is_up, device.is_born);
        let mut messages = Vec::new();
        if has_new || !was_born {
            messages.extend(self.birth(id, now_ms));
        }
        messages.push(self.device_message(&DeviceMessage::DData, id, last_sent, now_ms));
        // The device has history, but its robot does not answer now.
        if !is_up {
            messages.extend(self.device_death(id, now_ms));
        }
        messages
    }

    /// DDEATH if hosts consider the device online.
    fn device_death(&mut self, id: &str, now_ms: u64) -> Option<Message> {
        let device = self.devices.get_mut(id)?;
        std::mem::take(&mut device.is_born).then(|| self.device_message(&DeviceMessage::DDeath, id, Vec::new(), now_ms))
    }

    /// Handles a STATE message of the host.
    fn handle_host_state(&mut self, name: &str, message: &Message, now_ms: u64) -> Reaction {
        let Ok(state) = StateBirthDeathCertificate::try_from(&message.payload[..]) else {
            return ignored("an unreadable state of the host");
        };
        // The brokers are not connected with each other, so their messages are not compared.
        let last = self.hosts.entry((self.broker, name.to_owned())).or_default();
        if state.timestamp < last.0 {
            return ignored("a state of the host that is older than the last state");
        }
        *last = (state.timestamp, Some(state.online));
        match (self.hosts.values().any(|(_, state)| *state == Some(true)), self.is_born) {
            (true, false) => Reaction {
                messages: self.births(now_ms),
                note: Some((Level::Notice, format!("the primary host {name} is online"))),
                ..Reaction::default()
            },
            // The node sends its death message, and the next connection waits for the host (section 5.4).
            (false, true) => {
                self.is_born = false;
                Reaction {
                    messages: vec![self.death(now_ms)],
                    note: Some((
                        Level::Notice,
                        format!("the primary host {name} is offline: armctl stores the data for the host"),
                    )),
                    reconnects: true,
                    ..Reaction::default()
                }
            }
            // At another broker, the host can be online (tck-id-operational-behavior-primary-application-state-with-
            // multiple-servers-walk).
            (false, false) => {
                Reaction {
                    note: Some((Level::Notice, format!("waiting for the primary host {name}, which is offline"))),
                    tries_next: self.names.hosts.iter().all(|host| {
                        self.hosts.get(&(self.broker, host.clone())).is_some_and(|(_, state)| state.is_some())
                    }),
                    ..Reaction::default()
                }
            }
            (true, true) => Reaction::default(),
        }
    }

    /// Handles a command of the host. Only rebirth is supported.
    fn handle_command(&mut self, message: &Message, now_ms: u64) -> Reaction {
        let Ok(payload) = Payload::decode(&message.payload[..]) else {
            return ignored("an unreadable command");
        };
        let is_rebirth = |metric: &Metric| {
            metric.name.as_deref() == Some(NODE_CONTROL_REBIRTH) && metric.value == Some(Value::BooleanValue(true))
        };
        if !payload.metrics.iter().any(is_rebirth) {
            return ignored("a command, because armctl only publishes");
        }
        if !self.is_born {
            return ignored("a rebirth command before the first birth messages");
        }
        let note = |text: &str| Some((Level::Detail, text.to_owned()));
        // If the clock was set back, the rebirth waits for the whole time once, and not for the old time.
        let remaining_ms = BIRTHS_MS.saturating_sub(now_ms.saturating_sub(self.born_ms));
        if remaining_ms == 0 {
            let messages = self.births(now_ms);
            return Reaction { messages, note: note("a host requested a rebirth"), ..Reaction::default() };
        }
        // The node sends no data until the rebirth (tck-id-operational-behavior-data-commands-rebirth-action-1). One
        // rebirth answers all requests of this time.
        if std::mem::replace(&mut self.is_rebirth_due, true) {
            return Reaction::default();
        }
        Reaction {
            note: note("a host requested a rebirth directly after the birth messages: armctl delays it"),
            delay: Some(Duration::from_millis(remaining_ms)),
            ..Reaction::default()
        }
    }
}

fn ignored(what: &str) -> Reaction {
    Reaction {
        note: Some((Level::Detail, format!("ignored a message from the broker: {what}"))),
        ..Reaction::default()
    }
}

fn resolve_metric(name: &str, kind: DataType, value: Value, now_ms: u64) -> Metric {
    let mut metric = Metric::new();
    metric.set_name(name.to_owned()).set_datatype(kind).set_timestamp(now_ms).set_value(value);
    metric
}

fn bd_seq(number: u8, now_ms: u64) -> Metric {
    resolve_metric(BDSEQ, DataType::Int64, Value::LongValue(number.into()), now_ms)
}

impl MessageFormat for Node {
    fn client_id(&self) -> String {
        format!("armctl-{}-{}", self.names.group, self.names.node)
    }

    fn set_broker(&mut self, broker: usize) {
        self.broker = broker;
    }

    fn will(&mut self, now_ms: u64) -> Will {
        let number = self.bd_seq.1;
        self.bd_seq = (number, number.wrapping_add(1));
        (self.remember)(self.bd_seq.1);
        self.death(now_ms)
    }

    fn topics(&self) -> Vec<String> {
        let hosts = self.names.hosts.iter().map(|host| state_host_topic(host));
        std::iter::once(self.topic(&NodeMessage::NCmd)).chain(hosts).collect()
    }

    fn first_messages(&mut self, now_ms: u64) -> Vec<Message> {
        self.is_connected = true;
        if self.names.hosts.is_empty() { self.births(now_ms) } else { Vec::new() }
    }

    fn connection_lost(&mut self) {
        (self.is_connected, self.is_born, self.is_rebirth_due) = (false, false, false);
        for (_, state) in self.hosts.values_mut() {
            *state = None;
        }
        for device in self.devices.values_mut() {
            device.is_born = false;
        }
    }

    fn handle_message(&mut self, message: &Message, now_ms: u64) -> Reaction {
        let host = self.names.hosts.iter().find(|host| message.topic == state_host_topic(host)).cloned();
        if !self.is_connected {
            Reaction::default()
        } else if let Some(host) = host {
            self.handle_host_state(&host, message, now_ms)
        } else if message.topic == self.topic(&NodeMessage::NCmd) {
            self.handle_command(message, now_ms)
        } else {
            ignored("an unexpected topic")
        }
    }

    fn delayed_messages(&mut self, now_ms: u64) -> Vec<Message> {
        if self.is_born && self.is_rebirth_due { self.births(now_ms) } else { Vec::new() }
    }

    fn convert_event(&mut self, event: &Event, now_ms: u64) -> Vec<Record> {
        match event {
            Event::Polled(look) => self.data_records(look, now_ms).into_iter().collect(),
            Event::Failed { robot, .. } | Event::Gone(robot) => self.death_record(robot, now_ms).into_iter().collect(),
            Event::Appeared(_) | Event::Inventory(_) => Vec::new(),
        }
    }

    fn is_ready(&self) -> bool {
        self.is_born && !self.is_rebirth_due
    }

    fn convert_record(&mut self, record: Record, now_ms: u64) -> Vec<Message> {
        let is_history = record.epoch < self.epoch;
        match record.kind {
            // Historical deaths are not sent.
            kind::DEATH if is_history => Vec::new(),
            kind::DEATH => self.device_death(&record.key, now_ms).into_iter().collect(),
            kind::BIRTH if !is_history => self.birth(&record.key, now_ms).into_iter().collect(),
            kind::BIRTH | kind::DATA => self.data(&record, is_history, now_ms),
            _ => Vec::new(),
        }
    }

    fn final_messages(&mut self, now_ms: u64) -> Vec<Message> {
        if self.is_born { vec![self.death(now_ms)] } else { Vec::new() }
    }
}

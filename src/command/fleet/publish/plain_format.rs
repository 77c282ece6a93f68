//! Plain message format: one retained topic per robot and kind, `PREFIX/ROBOT/status` or a template, with the envelope of `--json` as
//! payload.
//!
//! A message is sent after a change, and at the latest after a given time. If a robot does not answer, all its topics
//! report that. An old position therefore never appears as the current one.
//!
//! The broker deletes a retained message of a robot if no newer message follows ([`expiry`]). Retained messages that
//! this node no longer publishes are cleared ([`AnnouncedTopics`]).

use std::rc::Rc;

use jiff::Timestamp;
use serde::Deserialize;

use super::Kind;
use super::announced::AnnouncedTopics;
use super::message_format::{MessageFormat, Reaction};
use super::outbox::Record;
use super::topic::Topics;
use super::uplink::{Message, Will};
use crate::command::fleet::also::AlsoCommand;
use crate::command::fleet::axes::Axes;
use crate::command::fleet::poll::{Event, PollResult, RobotId};
use armctl_frame::face::overview::OverviewReport;
use armctl_frame::output::envelope::Envelope;
use armctl_frame::output::log::Level;
use armctl_frame::prelude::*;
use armctl_frame::robot::alarm::Alarm;
use armctl_frame::robot::state::PositionMm;

/// The alarms and errors of a robot.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Alarms {
    /// Active alarms, newest first.
    alarms: Vec<Alarm>,
}

/// Position of a robot.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Position {
    /// Position in base coordinates; null if it was not read, or if the controller has none.
    position: Option<PositionMm>,
    /// Reason why the position was not read; null if it was read.
    not_asked: Option<&'static str>,
}

/// Number of longest intervals between two messages of a topic, after which the last one expires.
const EXPIRY_INTERVALS: u32 = 3;
/// Longest pause of the poller between two polls of a robot that does not answer.
const LONGEST_PAUSE: Duration = Duration::from_secs(60);

/// Time after which a retained message of a robot expires, for robots that are polled at an interval, and data that is
/// sent again after `every`.
pub fn expiry(every: Duration, interval: Duration) -> Duration {
    every.max(interval).max(LONGEST_PAUSE) * EXPIRY_INTERVALS
}

/// Times of the plain format.
#[derive(Debug, Clone, Copy)]
pub struct Times {
    /// Unchanged data is sent again after this time.
    pub every_ms: u64,
    /// Retained messages of robots expire after this time.
    pub expiry: Duration,
}

/// The part of a received envelope that says who published it.
#[derive(Debug, Deserialize)]
struct Publisher {
    node: Option<String>,
}

/// Last message of a topic.
#[derive(Debug)]
struct SentState {
    /// The envelope without its time.
    what: Vec<u8>,
    at_ms: u64,
}

/// The plain message format.
#[derive(Debug)]
pub struct PlainFormat {
    topics: Topics,
    kinds: Vec<Kind>,
    also: Rc<[AlsoCommand]>,
    times: Times,
    /// Topics at each broker.
    announced: Vec<AnnouncedTopics>,
    /// Broker of the connection, and the broker that has accepted this client last.
    broker: usize,
    last_accepted: Option<usize>,
    sent: BTreeMap<RobotId, BTreeMap<String, SentState>>,
}

impl PlainFormat {
    /// Creates the format for these kinds and extra commands. `announced` are the topics of the previous process, at
    /// each broker. The topics of `robots` stay.
    pub fn new(
        topics: Topics,
        (kinds, also): (&[Kind], Rc<[AlsoCommand]>),
        times: Times,
        (announced, robots): (Vec<AnnouncedTopics>, &[Robot]),
    ) -> Self {
        let (kinds, sent) = (kinds.to_vec(), BTreeMap::new());
        let mut format = Self { topics, kinds, also, times, announced, broker: 0, last_accepted: None, sent };
        let mut topics: Vec<String> = robots.iter().flat_map(|robot| format.topics_of(robot)).collect();
        topics.push(format.state_topic());
        format.announced_here().announce(topics);
        format
    }

    /// Topics at the broker of the connection.
    fn announced_here(&mut self) -> &mut AnnouncedTopics {
        &mut self.announced[self.broker]
    }

    /// Topics of a robot; empty if the robot lacks a level of the template.
    fn topics_of(&self, robot: &Robot) -> Vec<String> {
        let also = self.also.iter().filter(|also| also.family() == robot.family).map(AlsoCommand::name);
        let names = self.kinds.iter().map(|kind| kind.name()).chain(also);
        names.filter_map(|name| self.topics.topic_of(robot, name).ok()).collect()
    }

    fn state_topic(&self) -> String {
        format!("{}/{}/state", self.topics.prefix, self.topics.node)
    }

    fn state(&self, state: &str) -> Message {
        Message {
            topic: self.state_topic(),
            payload: state.as_bytes().to_vec(),
            retain: true,
            acknowledged: true,
            expiry: None,
        }
    }

    /// Records for data that has changed or is due again.
    fn changed(&mut self, robot: &Robot, envelopes: Vec<(String, Envelope)>, now_ms: u64) -> Vec<Record> {
        let last_sent = self.sent.entry(RobotId::for_robot(robot)).or_default();
        let mut records = Vec::new();
        for (kind, envelope) in envelopes {
            // `publish` reports a robot without a topic once, when the robot appears.
            let Ok(key) = self.topics.topic_of(robot, &kind) else { continue };
            let Ok(what) = serde_json::to_vec(&envelope) else { continue };
            let is_due = last_sent
                .get(&kind)
                .is_none_or(|last| last.what != what || now_ms.saturating_sub(last.at_ms) >= self.times.every_ms);
            if !is_due {
                continue;
            }
            let time = i64::try_from(now_ms).ok().and_then(|ms| Timestamp::from_millisecond(ms).ok());
            let node = Some(self.topics.node.clone());
            let Ok(body) = serde_json::to_vec(&Envelope { time, node, ..envelope }) else { continue };
            self.announced[self.broker].announce([key.clone()]);
            records.push(Record { kind: 0, time_ms: now_ms, key, body, epoch: 0 });
            last_sent.insert(kind, SentState { what, at_ms: now_ms });
        }
        records
    }

    fn records_of_poll(&mut self, look: &PollResult, now_ms: u64) -> Vec<Record> {
        let robot = &look.robot;
        let mut line = OverviewReport { family: robot.family.name(), ..look.sample.line.clone() };
        let at = (line.state.position, line.not_asked);
        if self.kinds.contains(&Kind::Position) {
            // Otherwise each step of a motion would be published twice.
            (line.state.position, line.not_asked) = (None, Some("published in a separate topic"));
        }
        let mut envelopes = Vec::new();
        for kind in &self.kinds {
            let data = match kind {
                Kind::Status => serde_json::to_value(&line),
                Kind::Alarms => serde_json::to_value(Alarms { alarms: look.sample.alarms.clone() }),
                Kind::Position => serde_json::to_value(Position { position: at.0, not_asked: at.1 }),
                Kind::Axes => serde_json::to_value(Axes::of(&look.sample)),
            };
            let data = data.map_err(|error| Failure::local(format!("report as JSON: {error}")));
            envelopes.push((kind.name().to_owned(), Envelope::of(robot, kind.id(), data)));
        }
        for (text, answer) in &look.extras {
            if let Some(also) = self.also.iter().find(|also| also.text() == &**text) {
                envelopes.push((also.name().to_owned(), Envelope::of(robot, also.id(), answer.clone())));
            }
        }
        self.changed(robot, envelopes, now_ms)
    }

    /// Records for a robot that does not answer. The status reports the missing answer, together with all known data.
    /// The other data is unknown.
    fn failed(&mut self, robot: &Robot, failure: &Failure, now_ms: u64) -> Vec<Record> {
        let mut envelopes = Vec::new();
        for kind in &self.kinds {
            let failed = Envelope::of(robot, kind.id(), Err(failure.clone()));
            let silent = OverviewReport { family: robot.family.name(), ..OverviewReport::default() };
            let data = serde_json::to_value(silent).ok().filter(|_| *kind == Kind::Status);
            envelopes.push((kind.name().to_owned(), Envelope { data, ..failed }));
        }
        for also in self.also.iter().filter(|also| also.family() == robot.family) {
            envelopes.push((also.name().to_owned(), Envelope::of(robot, also.id(), Err(failure.clone()))));
        }
        self.changed(robot, envelopes, now_ms)
    }

    /// Handles the removal of a robot. Its retained messages are cleared after the broker was asked for them.
    fn withdraw(&mut self, robot: &Robot) {
        self.sent.remove(&RobotId::for_robot(robot));
        for topic in self.topics_of(robot) {
            self.announced.iter_mut().for_each(|announced| announced.withdraw(&topic));
        }
    }
}

impl MessageFormat for PlainFormat {
    fn client_id(&self) -> String {
        format!("armctl-{}", self.topics.node)
    }

    /// The topics of this process are now retained at the new broker, too. At the last broker, they stay until the next
    /// connection to it.
    fn set_broker(&mut self, broker: usize) {
        let current = self.announced_here().current();
        self.broker = broker;
        self.announced_here().announce(current);
    }

    fn will(&mut self, _now_ms: u64) -> Will {
        self.state("offline")
    }

    fn topics(&self) -> Vec<String> {
        Vec::new()
    }

    /// Another broker than the last one gets all data at the next poll.
    fn first_messages(&mut self, _now_ms: u64) -> Vec<Message> {
        if self.last_accepted.replace(self.broker).is_some_and(|last| last != self.broker) {
            self.sent.clear();
        }
        vec![self.state("online")]
    }

    fn connection_lost(&mut self) {
        self.announced_here().connection_lost();
    }

    /// The broker was asked for retained messages. If one is of another node, it stays.
    fn handle_message(&mut self, message: &Message, _now_ms: u64) -> Reaction {
        if !self.announced_here().is_asked(&message.topic) {
            let note = format!("ignored an unexpected message from the broker: {}", message.topic);
            return Reaction { note: Some((Level::Detail, note)), ..Reaction::default() };
        }
        let publisher: Option<Publisher> = serde_json::from_slice(&message.payload).ok();
        let Some(other) = publisher.and_then(|publisher| publisher.node).filter(|node| *node != self.topics.node)
        else {
            return Reaction::default();
        };
        self.announced_here().forget(&message.topic);
        let note = format!("{}: now published by the node {other}, so its message stays", message.topic);
        Reaction { note: Some((Level::Detail, note)), ..Reaction::default() }
    }

    fn convert_event(&mut self, event: &Event, now_ms: u64) -> Vec<Record> {
        self.announced.iter_mut().for_each(|announced| announced.retry(now_ms));
        match event {
            Event::Polled(look) => self.records_of_poll(look, now_ms),
            Event::Failed { robot, failure, .. } => self.failed(robot, failure, now_ms),
            Event::Gone(robot) => {
                self.withdraw(robot);
                Vec::new()
            }
            Event::Appeared(robot) => {
                let topics = self.topics_of(robot);
                self.announced_here().announce(topics);
                Vec::new()
            }
            Event::Inventory(_) => Vec::new(),
        }
    }

    fn next_question(&mut self) -> Vec<String> {
        self.announced_here().next_question()
    }

    /// Records that clear the retained messages of this node.
    fn end_question(&mut self, now_ms: u64) -> Vec<Record> {
        let empty = |key: String| Record { kind: 0, time_ms: now_ms, key, body: Vec::new(), epoch: 0 };
        self.announced_here().end_question().into_iter().map(empty).collect()
    }

    fn handle_arrival(&mut self, record: &Record) {
        if record.body.is_empty() && self.announced_here().is_clearing(&record.key) {
            self.announced_here().forget(&record.key);
        }
    }

    fn take_note(&mut self) -> Option<String> {
        self.announced.iter_mut().find_map(AnnouncedTopics::take_note)
    }

    fn is_ready(&self) -> bool {
        true
    }

    /// Data of a topic that is no longer published, such as that of a previous process, is sent without retain.
    fn convert_record(&mut self, record: Record, _now_ms: u64) -> Vec<Message> {
        let Record { key, body, .. } = record;
        let is_clear = body.is_empty();
        if is_clear && !self.announced_here().is_clearing(&key) {
            return Vec::new();
        }
        let is_current = self.announced_here().is_current(&key);
        let expiry = is_current.then_some(self.times.expiry);
        vec![Message { topic: key, payload: body, retain: is_clear || is_current, acknowledged: true, expiry }]
    }

    fn final_messages(&mut self, _now_ms: u64) -> Vec<Message> {
        vec![self.state("offline")]
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use armctl_frame::face::sample::{Axis, Sample, Whole};

    #[test]
    fn axes_have_units_and_torques() {
        let joint =
            Axis { name: "S".to_owned(), position: -400.0, unit: "pulses", torque: Some(12.0), ..Axis::default() };
        let rotation = Axis { name: "Rz".to_owned(), position: 90.5, unit: "deg", ..Axis::default() };
        let whole = Whole { axes: vec![joint, rotation], torque_unit: Some("raw"), ..Whole::default() };
        let axes = serde_json::to_value(Axes::of(&Sample { full: Some(whole), ..Sample::default() })).unwrap();
        assert_eq!(
            axes,
            json!({
                "axes": [
                    {"axis": "S", "position": -400.0, "unit": "pulses", "torque": 12.0, "torque_unit": "raw"},
                    {"axis": "Rz", "position": 90.5, "unit": "deg", "torque": null, "torque_unit": null},
                ],
                "not_asked": null,
            })
        );
    }
}

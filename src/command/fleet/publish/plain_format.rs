//! Plain message format: one retained topic per robot and kind, `PREFIX/ROBOT/status` or a template, with the envelope of `--json` as
//! payload.
//!
//! A message is sent after a change, and at the latest after a given time. If a robot does not answer, all its topics
//! report that. An old position therefore never appears as the current one.

use std::collections::BTreeMap;
use std::rc::Rc;

use jiff::Timestamp;

use super::Kind;
use super::extra_topic::ExtraTopic;
use super::message_format::{MessageFormat, Reaction};
use super::outbox::Record;
use super::topic::Topics;
use super::uplink::{Message, Will};
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
    node: String,
    topics: Topics,
    kinds: Vec<Kind>,
    also: Rc<[ExtraTopic]>,
    every_ms: u64,
    sent: BTreeMap<RobotId, BTreeMap<String, SentState>>,
}

impl PlainFormat {
    /// Creates the format for these kinds and extra commands; unchanged data is sent again after `every_ms`. `node` is
    /// a topic level.
    pub fn new((node, topics): (String, Topics), kinds: &[Kind], also: Rc<[ExtraTopic]>, every_ms: u64) -> Self {
        Self { node, topics, kinds: kinds.to_vec(), also, every_ms, sent: BTreeMap::new() }
    }

    fn state(&self, state: &str) -> Message {
        Message {
            topic: format!("{}/{}/state", self.topics.prefix, self.node),
            payload: state.as_bytes().to_vec(),
            retain: true,
            acknowledged: true,
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
                .is_none_or(|last| last.what != what || now_ms.saturating_sub(last.at_ms) >= self.every_ms);
            if !is_due {
                continue;
            }
            let time = i64::try_from(now_ms).ok().and_then(|ms| Timestamp::from_millisecond(ms).ok());
            let Ok(body) = serde_json::to_vec(&Envelope { time, ..envelope }) else { continue };
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
            };
            let data = data.map_err(|error| Failure::local(format!("report as JSON: {error}")));
            envelopes.push((kind.name().to_owned(), Envelope::of(robot, kind.id(), data)));
        }
        for (text, answer) in &look.extras {
            if let Some(also) = self.also.iter().find(|also| also.text() == &**text) {
                envelopes.push((also.level().to_owned(), Envelope::of(robot, also.id(), answer.clone())));
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
            envelopes.push((also.level().to_owned(), Envelope::of(robot, also.id(), Err(failure.clone()))));
        }
        self.changed(robot, envelopes, now_ms)
    }

    /// Records for a robot that was removed. They clear its retained messages.
    fn records_of_removed_robot(&mut self, robot: &Robot, now_ms: u64) -> Vec<Record> {
        let told = self.sent.remove(&RobotId::for_robot(robot)).unwrap_or_default();
        let empty = |key: String| Record { kind: 0, time_ms: now_ms, key, body: Vec::new(), epoch: 0 };
        told.into_keys().filter_map(|kind| self.topics.topic_of(robot, &kind).ok()).map(empty).collect()
    }
}

impl MessageFormat for PlainFormat {
    fn client_id(&self) -> String {
        format!("armctl-{}", self.node)
    }

    fn will(&mut self, _now_ms: u64) -> Will {
        self.state("offline")
    }

    fn topics(&self) -> Vec<String> {
        Vec::new()
    }

    fn first_messages(&mut self, _now_ms: u64) -> Vec<Message> {
        vec![self.state("online")]
    }

    fn connection_lost(&mut self) {}

    fn handle_message(&mut self, message: &Message, _now_ms: u64) -> Reaction {
        let note = format!("ignored an unexpected message from the broker: {}", message.topic);
        Reaction { note: Some((Level::Detail, note)), ..Reaction::default() }
    }

    fn convert_event(&mut self, event: &Event, now_ms: u64) -> Vec<Record> {
        match event {
            Event::Polled(look) => self.records_of_poll(look, now_ms),
            Event::Failed { robot, failure, .. } => self.failed(robot, failure, now_ms),
            Event::Gone(robot) => self.records_of_removed_robot(robot, now_ms),
            Event::Appeared(_) | Event::Inventory(_) => Vec::new(),
        }
    }

    fn is_ready(&self) -> bool {
        true
    }

    fn convert_record(&mut self, record: Record, _now_ms: u64) -> Vec<Message> {
        let Record { key, body, .. } = record;
        vec![Message { topic: key, payload: body, retain: true, acknowledged: true }]
    }

    fn final_messages(&mut self, _now_ms: u64) -> Vec<Message> {
        vec![self.state("offline")]
    }
}

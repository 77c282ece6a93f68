//! Envelope that all JSON answers have.

use jiff::Timestamp;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use crate::failure::Failure;
use crate::settings::Robot;
use crate::settings::place::Place;

/// Output of `--json` for a robot:
/// `{"robot":…,"family":…,"target":…,"simulated":…,"command":…,"ok":…,"data"|"error":…}`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[schemars(extend("allOf" = [
    {"if": {"properties": {"ok": {"const": true}}}, "then": {"required": ["data"], "not": {"required": ["error"]}}},
    {"if": {"properties": {"ok": {"const": false}}}, "then": {"required": ["error"]}},
    {"if": {"properties": {"robot": {"type": "string"}}}, "then": {"required": ["family", "target", "simulated"]}}
]))]
pub struct Envelope {
    /// Time when the answer was complete; only in `jsonl`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String", extend("format" = "date-time"))]
    pub time: Option<Timestamp>,
    /// File that contains the command; only in a batch.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub file: Option<String>,
    /// Line of the command in the file, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "usize")]
    pub line: Option<usize>,
    /// Name of the robot.
    pub robot: Option<String>,
    /// Family of the robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub family: Option<&'static str>,
    /// URL of the robot.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub target: Option<String>,
    /// Whether the robot is a simulator.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool")]
    pub simulated: Option<bool>,
    /// Place of the robot in the plant, if `robots.toml` sets it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Place")]
    pub place: Option<Place>,
    /// Name of the publisher, as in the topic of its state; only in `armctl publish`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub node: Option<String>,
    /// Command, for example `yerc.status`.
    pub command: Option<String>,
    /// Whether the command succeeded.
    pub ok: bool,
    /// Report of the command.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Value")]
    pub data: Option<Value>,
    /// The reason why the report is missing or incomplete.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ErrorBody")]
    pub error: Option<ErrorBody>,
}

/// The reason why a command failed: `{"kind":"refused","exit":3,"code":"0x2060","message":…,"hint":…}`.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ErrorBody {
    /// Exit code of this kind of failure.
    exit: u8,
    #[serde(flatten)]
    failure: Failure,
}

impl From<Failure> for ErrorBody {
    fn from(failure: Failure) -> Self {
        Self { exit: failure.kind.exit(), failure }
    }
}

impl Envelope {
    /// Creates the answer of one robot.
    pub fn of(robot: &Robot, command: &str, result: Result<Value, Failure>) -> Self {
        let (data, error) = match result {
            Ok(data) => (Some(data), None),
            Err(failure) => (None, Some(failure.into())),
        };
        Self {
            time: None,
            file: None,
            line: None,
            robot: Some(robot.name.clone()),
            family: Some(robot.family.name()),
            target: Some(robot.target.value.url().to_owned()),
            simulated: Some(robot.target.value.is_simulated()),
            place: Some(robot.place.clone()).filter(|place| !place.is_empty()),
            node: None,
            command: Some(command.to_owned()),
            ok: error.is_none(),
            data,
            error,
        }
    }

    /// Creates the answer of a command that needs no robot.
    pub fn local(command: &str, data: Value) -> Self {
        Self {
            time: None,
            file: None,
            line: None,
            robot: None,
            family: None,
            target: None,
            simulated: None,
            place: None,
            node: None,
            command: Some(command.to_owned()),
            ok: true,
            data: Some(data),
            error: None,
        }
    }

    /// Creates the answer for a failure that occurred before a robot was selected.
    pub fn failed(command: Option<&str>, failure: Failure) -> Self {
        Self {
            time: None,
            file: None,
            line: None,
            robot: None,
            family: None,
            target: None,
            simulated: None,
            place: None,
            node: None,
            command: command.map(ToOwned::to_owned),
            ok: false,
            data: None,
            error: Some(failure.into()),
        }
    }
}

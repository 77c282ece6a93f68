//! Kinds of argument values, for completion.

use crate::prelude::basics::*;
use armctl_controller::names::Kind;

/// Kind of value that has completion candidates.
#[derive(Debug, Clone, Copy)]
pub enum ValueKind {
    /// A robot of the inventory.
    Robot,
    /// A robot of the inventory, or a target URL.
    RobotOrUrl,
    /// A robot with an open session.
    Session,
    /// A backup folder.
    Backup,
    /// A tag in the inventory.
    Tag,
    /// A target URL.
    Url,
    /// A family.
    Family,
    /// A help topic, or the words of a command.
    HelpWord,
    /// The name of a report.
    Schema,
    /// A code for `explain`.
    Code(Family),
    /// A value from a table of a family.
    Listed(fn() -> Vec<Candidate>),
    /// A value that only a robot of the family can list.
    FromRobot(Family, CandidateFunction),
    /// A name, or a value from a table of a family.
    Named(Family, Named),
}

/// Allows `#[arg(add = ValueKind::Robot)]`.
impl clap::builder::ArgExt for ValueKind {}

/// Names that an argument accepts, and the alternatives to a name.
#[derive(Debug, Clone, Copy)]
pub struct Named {
    /// Kinds that the name may have.
    pub kinds: &'static [Kind],
    /// Endings that a name can have: empty, or `=on`.
    pub endings: &'static [&'static str],
    /// Candidates in addition to names.
    pub listed: fn() -> Vec<Candidate>,
}

/// Function that lists all candidates by means of a robot.
pub type CandidateFunction = for<'a> fn(&'a dyn Ask) -> LocalBoxFuture<'a, ()>;

/// Completion candidate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// The whole word.
    pub value: String,
    /// Description in one line.
    pub help: Option<String>,
    /// Whether more text must follow without a space, as after `udp://`.
    pub is_incomplete: bool,
}

impl Candidate {
    /// A complete word. The help may be empty.
    pub fn new(value: impl Into<String>, help: impl Into<String>) -> Self {
        let help = Some(help.into()).filter(|help| !help.is_empty());
        Self { value: value.into(), help, is_incomplete: false }
    }

    /// Marks the candidate as the start of a word.
    #[must_use]
    pub fn incomplete(self) -> Self {
        Self { is_incomplete: true, ..self }
    }
}

/// A robot that supplies candidates.
pub trait Ask {
    /// Data of a read command; `None` if the robot does not answer in time.
    fn data<'a>(&'a self, words: &'a [&'a str]) -> LocalBoxFuture<'a, Option<Value>>;
    /// Adds a candidate immediately. Candidates that come too late are ignored.
    fn add_candidate(&self, candidate: Candidate);
}

/// Rows of a list in the data of a command.
pub fn rows<'a>(data: Option<&'a Value>, list: &str) -> impl Iterator<Item = &'a Value> {
    data.and_then(|data| data.get(list)?.as_array()).into_iter().flatten()
}

/// Field of a row as text.
pub fn text(row: &Value, field: &str) -> String {
    match row.get(field) {
        Some(Value::String(text)) => text.clone(),
        Some(Value::Null) | None => String::new(),
        Some(other) => other.to_string(),
    }
}

//! Kinds of argument values, for completion.

use futures_util::future::LocalBoxFuture;
use serde_json::Value;

use crate::settings::target::Family;
use armctl_controller::names::Kind;

/// Kind of value with completion candidates.
#[derive(Debug, Clone, Copy)]
pub enum ValueKind {
    /// A robot of the inventory.
    Robot,
    /// A robot of the inventory, or a target URL.
    RobotOrUrl,
    /// A robot with an open session.
    Session,
    /// Backup folder.
    Backup,
    /// Inventory tag.
    Tag,
    /// Target URL.
    Url,
    /// A family.
    Family,
    /// Help topic, or the words of a command.
    HelpWord,
    /// The name of a report.
    Schema,
    /// Code for `explain`.
    Code(Family),
    /// Value from a table of a family.
    Listed(fn() -> Vec<Candidate>),
    /// Value that only a robot of the family can list.
    Asked(Family, Question),
    /// Name, or a value from a table of a family.
    Named(Family, Named),
}

/// Allows `#[arg(add = ValueKind::Robot)]`.
impl clap::builder::ArgExt for ValueKind {}

/// Kinds of names and alternatives.
#[derive(Debug, Clone, Copy)]
pub struct Named {
    /// Kinds of the names.
    pub kinds: &'static [Kind],
    /// Possible endings of a name: empty, or `=on`.
    pub endings: &'static [&'static str],
    /// Candidates in addition to names.
    pub listed: fn() -> Vec<Candidate>,
}

/// Function that reports all candidates of a kind.
pub type Question = for<'a> fn(&'a dyn Ask) -> LocalBoxFuture<'a, ()>;

/// Completion candidate.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// Whole word.
    pub value: String,
    /// One-line description.
    pub help: Option<String>,
    /// Whether more must follow without a space, as after `udp://`.
    pub is_incomplete: bool,
}

impl Candidate {
    /// Whole word; the help may be empty.
    pub fn new(value: impl Into<String>, help: impl Into<String>) -> Self {
        let help = Some(help.into()).filter(|help| !help.is_empty());
        Self { value: value.into(), help, is_incomplete: false }
    }

    /// Start of a word.
    #[must_use]
    pub fn incomplete(self) -> Self {
        Self { is_incomplete: true, ..self }
    }
}

/// Robot that supplies candidates.
pub trait Ask {
    /// Data of a read command; none if the robot does not answer in time.
    fn data<'a>(&'a self, words: &'a [&'a str]) -> LocalBoxFuture<'a, Option<Value>>;
    /// Reports a candidate immediately; late candidates are ignored.
    fn add_candidate(&self, candidate: Candidate);
}

/// Rows of a list in command data.
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

//! What values arguments have.

use futures_util::future::LocalBoxFuture;
use serde_json::Value;

use crate::controller::names::Kind;
use crate::settings::target::Family;

/// A kind of value that has candidates.
#[derive(Debug, Clone, Copy)]
pub enum ValueKind {
    /// A robot of the inventory.
    Robot,
    /// A robot of the inventory, or a target URL.
    RobotOrUrl,
    /// A robot whose link a session holds.
    Session,
    /// The folder of a backup.
    Backup,
    /// A tag of the inventory.
    Tag,
    /// A target URL.
    Url,
    /// A family.
    Family,
    /// A topic of `help`, or the words of a command.
    HelpWord,
    /// The name of a report.
    Schema,
    /// A code that `explain` explains.
    Code(Family),
    /// A value that the tables of a family list.
    Listed(fn() -> Vec<Candidate>),
    /// A value that only a robot of the family knows.
    Asked(Family, Question),
    /// A name of something, or what the tables of a family list.
    Named(Family, Named),
}

/// Names of which things, and what may stand in their place.
#[derive(Debug, Clone, Copy)]
pub struct Named {
    /// Of these.
    pub kinds: &'static [Kind],
    /// What follows a name: nothing, or `=on`.
    pub endings: &'static [&'static str],
    /// What is listed beside names.
    pub listed: fn() -> Vec<Candidate>,
}

/// Tells all candidates of a kind.
pub type Question = for<'a> fn(&'a dyn Ask) -> LocalBoxFuture<'a, ()>;

/// Something that could stand at the cursor.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Candidate {
    /// The whole word.
    pub value: String,
    /// What it is, in a line.
    pub help: Option<String>,
    /// Whether more must follow without a blank, as behind `udp://`.
    pub is_begun: bool,
}

impl Candidate {
    /// A whole word; the help may be empty.
    pub fn new(value: impl Into<String>, help: impl Into<String>) -> Self {
        let help = Some(help.into()).filter(|help| !help.is_empty());
        Self { value: value.into(), help, is_begun: false }
    }

    /// The beginning of a word.
    #[must_use]
    pub fn begun(self) -> Self {
        Self { is_begun: true, ..self }
    }
}

/// A robot that is asked for candidates.
pub trait Ask {
    /// What a command that reads reports; nothing where the robot has no time left, or no answer.
    fn data<'a>(&'a self, words: &'a [&'a str]) -> LocalBoxFuture<'a, Option<Value>>;
    /// Tells of a candidate at once: whatever comes too late is none.
    fn tell(&self, candidate: Candidate);
}

/// The rows of a list in what a command reports.
pub fn rows<'a>(data: Option<&'a Value>, list: &str) -> impl Iterator<Item = &'a Value> {
    data.and_then(|data| data.get(list)?.as_array()).into_iter().flatten()
}

/// A field of what a command reports, as text.
pub fn text(row: &Value, field: &str) -> String {
    match row.get(field) {
        Some(Value::String(text)) => text.clone(),
        Some(Value::Null) | None => String::new(),
        Some(other) => other.to_string(),
    }
}

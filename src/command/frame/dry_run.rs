//! What a dry run notes instead of sending it.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Value, json};

use super::report::Report;
use crate::failure::{Failure, Kind};
use crate::output::view::{Table, View};

/// What would be sent, in the order of sending.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    frames: Vec<Value>,
    then: Option<String>,
}

/// What an order would do about the frames before it.
#[derive(Debug, Clone, Copy, Default)]
pub struct Reason<'a> {
    /// What it is for.
    pub about: Option<&'a str>,
    /// What of the answers before it decides how it looks, or whether it is sent.
    pub depends_on: Option<&'a str>,
}

impl<'a> Reason<'a> {
    /// What a frame is for.
    pub fn about(about: &'a str) -> Self {
        Self { about: Some(about), depends_on: None }
    }

    /// What of the answers before a frame decides how it looks, or whether it is sent.
    #[must_use]
    pub fn depending_on(self, what: &'a str) -> Self {
        Self { depends_on: Some(what), ..self }
    }
}

impl Plan {
    /// Notes a frame: `frame` has the key of its family.
    pub fn note(&mut self, mut frame: Value, reason: Reason<'_>) {
        if let Some(frame) = frame.as_object_mut() {
            for (key, text) in [("about", reason.about), ("depends_on", reason.depends_on)] {
                if let Some(text) = text {
                    frame.insert(key.to_owned(), json!(text));
                }
            }
        }
        self.frames.push(frame);
    }

    /// Says in words what follows that cannot be shown.
    pub fn then(&mut self, what: &str) {
        let what = match self.then.take() {
            Some(before) => format!("{before}; {what}"),
            None => what.to_owned(),
        };
        self.then = Some(what);
    }

    /// The report.
    pub fn into_report(self) -> DryRun {
        DryRun { complete: self.then.is_none(), then: self.then, frames: self.frames }
    }
}

/// The answer to a question that a dry run does not ask. It ends the command, unless that can go on without.
pub fn unknown() -> Failure {
    Failure::new(Kind::NotKnown, "a dry run has no answer")
}

/// Whether a failure of a dry run is only that an answer is not known, in the words of whoever wanted it: what a controller
/// says cannot be wrong where none is asked.
pub fn is_end(failure: &Failure) -> bool {
    match failure.kind {
        Kind::NotKnown
        | Kind::Refused
        | Kind::NoAnswer
        | Kind::Malformed
        | Kind::OutcomeUnknown
        | Kind::ConditionNotMet
        | Kind::Mixed => true,
        Kind::Local | Kind::Usage | Kind::RefusedHere | Kind::PipeClosed | Kind::Interrupted => false,
    }
}

/// Answers as far as they are known: for a command that can go on without.
pub trait Known<T> {
    /// The answer; `None` in a dry run, which has none.
    fn known(self) -> Result<Option<T>, Failure>;
}

impl<T> Known<T> for Result<T, Failure> {
    fn known(self) -> Result<Option<T>, Failure> {
        match self {
            Err(failure) if failure.kind == Kind::NotKnown => Ok(None),
            answered => answered.map(Some),
        }
    }
}

/// What a dry run reports.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DryRun {
    /// What would be sent, in order: each under the key of its family, beside what it is about where that is known.
    #[schemars(extend("items" = {
        "type": "object",
        "properties": {
            "hex": {"description": "The bytes (yerc; messages to the board of a yrcx); `??` where an answer decides.",
                    "type": "string"},
            "wi": {"description": "The 16 command words (yrcx); `?` where an answer decides.",
                   "type": "array", "items": {"type": "string"}},
            "bits": {"description": "The words of bits (yrcx).", "type": "array", "items": {"type": "string"}},
            "text": {"description": "The line (toyo); `?` where an answer decides.", "type": "string"},
            "about": {"description": "What it is for.", "type": "string"},
            "depends_on": {"description": "What of the answers before it decides how it looks, or whether it is sent.",
                           "type": "string"}
        },
        "oneOf": [{"required": ["hex"]}, {"required": ["wi"]}, {"required": ["bits"]}, {"required": ["text"]}]
    }))]
    pub frames: Vec<Value>,
    /// Whether these are all; if not, what follows depends on answers in a way that cannot be shown.
    pub complete: bool,
    /// What follows, in words; null where nothing does.
    pub then: Option<String>,
}

impl Report for DryRun {
    fn view(&self) -> View {
        const EMPTY: &str = "nothing would be sent";
        let text = |frame: &Value, key: &str| frame.get(key).and_then(Value::as_str).map(ToOwned::to_owned);
        let purpose = |frame: &Value| match (text(frame, "about"), text(frame, "depends_on")) {
            (about, None) => about,
            (None, Some(on)) => Some(format!("depends on {on}")),
            (Some(about), Some(on)) => Some(format!("{about} (depends on {on})")),
        };
        let mut plain = Table::new(&["#", "frame"], EMPTY);
        let mut explained = Table::new(&["#", "purpose", "frame"], EMPTY);
        for (index, frame) in self.frames.iter().enumerate() {
            let shown = match frame.as_object().and_then(|object| object.values().next()) {
                Some(Value::String(text)) => text.clone(),
                Some(Value::Array(words)) => words.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" "),
                _ => frame.to_string(),
            };
            plain.row([(index + 1).into(), shown.as_str().into()]);
            explained.row([(index + 1).into(), purpose(frame).unwrap_or_default().into(), shown.into()]);
        }
        if let Some(then) = &self.then {
            plain.row(["…".into(), then.as_str().into()]);
            explained.row(["…".into(), then.as_str().into(), "".into()]);
        }
        let has_purpose = self.frames.iter().any(|frame| purpose(frame).is_some());
        View::table(if has_purpose { explained } else { plain })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plan_says_what_depends_on_answers_and_what_follows() {
        let mut plan = Plan::default();
        plan.note(json!({"text": "@STAS SNO=2"}), Reason::about("whether the host is ON"));
        plan.note(json!({"text": "@SPRM ?"}), Reason::about("write").depending_on("what the block holds"));
        let complete = plan.clone().into_report();
        assert!(complete.complete && complete.then.is_none());
        plan.then("a look at each point");
        plan.then("the same for the next task");
        let report = plan.into_report();
        assert!(!report.complete);
        assert_eq!(report.then.as_deref(), Some("a look at each point; the same for the next task"));
        assert_eq!(report.frames[0].get("depends_on"), None);
        assert_eq!(report.frames[1]["depends_on"], "what the block holds");
        let shown = crate::output::render::text(&report.view(), 120, false);
        assert!(
            shown.contains("write (depends on what the block holds)") && shown.contains("\u{2026}  a look"),
            "{shown}"
        );
    }
}

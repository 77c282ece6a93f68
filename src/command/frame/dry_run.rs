//! What a dry run notes instead of sending it.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value;

use super::report::Report;
pub use crate::client::{Plan, Reason};
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Section, Table, View};

impl From<Plan> for DryRun {
    fn from(Plan { frames, items, then }: Plan) -> Self {
        Self { frames, items, complete: then.is_none(), then }
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
        Kind::Local | Kind::Usage | Kind::Rejected | Kind::PipeClosed | Kind::Interrupted | Kind::Halted(_) => false,
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
            "fields": {"description": "What an order that moves something says, field by field; `?` where an answer \
                                       decides.",
                       "type": "array",
                       "items": {"type": "object", "required": ["name", "value"],
                                 "properties": {"name": {"type": "string"}, "value": {"type": "string"}}}},
            "about": {"description": "What it is for.", "type": "string"},
            "depends_on": {"description": "What of the answers before it decides how it looks, or whether it is sent.",
                           "type": "string"}
        },
        "oneOf": [{"required": ["hex"]}, {"required": ["wi"]}, {"required": ["bits"]}, {"required": ["text"]}]
    }))]
    pub frames: Vec<Value>,
    /// What would be done with each file or part: `write`, if what it `depends_on` is so, or `leave`, and `why`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("items" = {
        "type": "object",
        "required": ["item", "action"],
        "properties": {
            "item": {"description": "The file or the part.", "type": "string"},
            "action": {"enum": ["write", "leave"]},
            "bytes": {"description": "Of a file.", "type": "integer"},
            "values": {"description": "Of a part.", "type": "integer"},
            "depends_on": {"description": "What of the answers decides whether it is written.", "type": "string"},
            "why": {"description": "Why it is left as it is.", "type": "string"}
        }
    }))]
    pub items: Vec<Value>,
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
            for field in frame["fields"].as_array().into_iter().flatten() {
                let [name, value] = ["name", "value"].map(|key| text(field, key).unwrap_or_default());
                plain.row(["".into(), format!("{name}: {value}").into()]);
                explained.row(["".into(), name.into(), value.into()]);
            }
        }
        if let Some(then) = &self.then {
            plain.row(["…".into(), then.as_str().into()]);
            explained.row(["…".into(), then.as_str().into(), "".into()]);
        }
        let has_purpose = self.frames.iter().any(|frame| purpose(frame).is_some());
        let frames = Section::Table(if has_purpose { explained } else { plain });
        let items = (!self.items.is_empty()).then(|| Section::Table(self.planned_items()));
        View { sections: items.into_iter().chain([frames]).collect() }
    }
}

impl DryRun {
    fn planned_items(&self) -> Table {
        let mut table = Table::new(&["item", "would be", "size", "note"], "");
        for item in &self.items {
            let text = |key: &str| item[key].as_str().unwrap_or_default();
            let size =
                ["bytes", "values"].into_iter().find_map(|unit| Some(format!("{} {unit}", item[unit].as_u64()?)));
            let done = if text("action") == "write" { "written" } else { "left" };
            let note = match (text("depends_on"), text("why")) {
                ("", why) => why.to_owned(),
                (on, _) => format!("depends on {on}"),
            };
            table.row([text("item").into(), done.into(), Cell::maybe(size), note.into()]);
        }
        table
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_plan_says_what_depends_on_answers_and_what_follows() {
        let mut plan = Plan::default();
        plan.note(json!({"text": "@STAS SNO=2"}), Reason::about("whether the host is ON"));
        plan.note(json!({"text": "@SPRM ?"}), Reason::about("write").depending_on("what the block holds"));
        let complete = DryRun::from(plan.clone());
        assert!(complete.complete && complete.then.is_none());
        plan.then("a look at each point");
        plan.then("the same for the next task");
        let report = DryRun::from(plan);
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

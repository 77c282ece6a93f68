//! Dry run: frames are recorded instead of sent.

use crate::prelude::basics::*;
pub use armctl_client::{Plan, Reason};

impl From<Plan> for DryRun {
    fn from(Plan { frames, items, then }: Plan) -> Self {
        Self { frames, items, complete: then.is_none(), then }
    }
}

/// Failure of a read in a dry run. It ends the command, unless the command can continue without the answer.
pub fn unknown() -> Failure {
    Failure::new(Kind::DryRun, "a dry run has no answer")
}

/// Whether a failure of a dry run means only that an answer is missing. A malformed answer also counts, because a dry
/// run reads nothing.
pub fn is_end(failure: &Failure) -> bool {
    match failure.kind {
        Kind::DryRun
        | Kind::Refused
        | Kind::NoAnswer
        | Kind::Malformed
        | Kind::OutcomeUnknown
        | Kind::ConditionNotMet
        | Kind::Mixed => true,
        Kind::Local | Kind::Usage | Kind::Rejected | Kind::PipeClosed | Kind::Interrupted | Kind::Halted(_) => false,
    }
}

/// Answers that may be missing, for a command that can continue without them.
pub trait Known<T> {
    /// Returns the answer; `None` in a dry run.
    fn known(self) -> Result<Option<T>>;
}

impl<T> Known<T> for Result<T> {
    fn known(self) -> Result<Option<T>> {
        match self {
            Err(failure) if failure.kind == Kind::DryRun => Ok(None),
            answered => answered.map(Some),
        }
    }
}

/// Report of a dry run.
#[derive(Debug, Serialize, JsonSchema)]
pub struct DryRun {
    /// Frames in the order of sending. Each frame is under the key of its family, with its purpose if it is known.
    #[schemars(extend("items" = {
        "type": "object",
        "properties": {
            "hex": {"description": "Bytes of the frame (yerc, and messages to the board of a yrcx); `??` for bytes \
                                    that depend on an answer.",
                    "type": "string"},
            "wi": {"description": "The 16 words of a remote command (yrcx); `?` for words that depend on an answer.",
                   "type": "array", "items": {"type": "string"}},
            "bits": {"description": "The signal words (yrcx).", "type": "array", "items": {"type": "string"}},
            "text": {"description": "The block (toyo); `?` for parts that depend on an answer.", "type": "string"},
            "fields": {"description": "Fields of a motion command; `?` for values that depend on an answer.",
                       "type": "array",
                       "items": {"type": "object", "required": ["name", "value"],
                                 "properties": {"name": {"type": "string"}, "value": {"type": "string"}}}},
            "about": {"description": "Purpose of the frame.", "type": "string"},
            "depends_on": {"description": "Earlier answer that decides the content of the frame, or whether the frame \
                                           is sent.",
                           "type": "string"}
        },
        "oneOf": [{"required": ["hex"]}, {"required": ["wi"]}, {"required": ["bits"]}, {"required": ["text"]}]
    }))]
    pub frames: Vec<Value>,
    /// Actions for each file or part: `write`, which may depend on a condition in `depends_on`, or `leave`, with the
    /// reason in `why`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(extend("items" = {
        "type": "object",
        "required": ["item", "action"],
        "properties": {
            "item": {"description": "Name of the file or part.", "type": "string"},
            "action": {"enum": ["write", "leave"]},
            "bytes": {"description": "Of a file.", "type": "integer"},
            "values": {"description": "Of a part.", "type": "integer"},
            "depends_on": {"description": "Answer that decides whether the item is written.", "type": "string"},
            "why": {"description": "Reason why the item is not written.", "type": "string"}
        }
    }))]
    pub items: Vec<Value>,
    /// Whether the list is complete. If not, the frames after it depend on answers and cannot be shown.
    pub complete: bool,
    /// Description of the frames after the list; null if the list is complete.
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
            table.row([text("item").into(), done.into(), Cell::optional(size), note.into()]);
        }
        table
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn plan_lists_dependent_frames_and_what_follows() {
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

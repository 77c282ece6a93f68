//! Report of `teach` for all families, and positions from the output of other commands.

use serde_json::{Map, Value as Json};

use crate::prelude::basics::*;
use crate::robot::position::Position;

/// Result of teaching a point: the old and new content of the point, and the position of the robot.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TeachReport {
    /// Name of the point, for example `P5`, or its number.
    name: String,
    /// Old content; null if the point was not defined.
    old: Option<Position>,
    /// New content, as read back from the controller.
    new: Position,
    /// Position of the robot.
    position: Position,
    /// Whether the point was written; false if the content was already equal.
    written: bool,
    /// Numbers or names that identify the point in its family.
    #[serde(flatten)]
    with: Map<String, Json>,
}

impl TeachReport {
    /// Creates a report from the old content, the new content and the robot position.
    pub fn new(name: impl Into<String>, old: Option<Position>, new: Position, position: Position) -> Self {
        Self { name: name.into(), old, new, position, written: true, with: Map::new() }
    }

    /// Adds a name or a number to the report.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<Json>) -> Self {
        self.with.insert(name.to_owned(), value.into());
        self
    }

    /// Marks the point as unchanged if `is_unchanged`. In that case nothing was written.
    #[must_use]
    pub fn unchanged(self, is_unchanged: bool) -> Self {
        Self { written: !is_unchanged, ..self }
    }
}

impl Report for TeachReport {
    fn view(&self) -> View {
        let shown = |position: &Position| position.text.clone().unwrap_or_else(|| position.line());
        let old = self.old.as_ref().map_or_else(|| "undefined".to_owned(), shown);
        let result = if self.written { "taught" } else { "unchanged (already stored)" };
        View::fields([
            ("point", self.name.as_str().into()),
            ("old", old.into()),
            ("new", shown(&self.new).into()),
            ("result", Cell::from(result).tone(Tone::Good)),
        ])
    }
}

/// Failure: the point that was read back differs from the robot position.
pub fn mismatch(name: &str, taught: &str, held: &str) -> Failure {
    let message = format!("{name} was written, but contains {held}; the robot is at {taught}");
    Failure::new(Kind::Malformed, message)
        .hint("check the point, then teach it again: the robot moved, or another client wrote the point")
}

/// Failure: the point was written but could not be read back.
pub fn unverified(name: &str, failure: Failure, command: &str) -> Failure {
    let message = format!("{name} was written, but could not be read back: {}", failure.message);
    Failure { kind: Kind::OutcomeUnknown, message, ..failure }.hint(format!("read the point with `{command}`"))
}

/// Maximum size of the input. A position needs about a kilobyte, and this leaves room for a whole report.
const SIZE_LIMIT: u64 = 1 << 20;

/// Reads a position from the output of another command, in a file or on stdin (`-`), and returns it as the user would
/// type it. The output can be `text` of `position --json`, an item of `get --json`, or the position itself. If a robot
/// has several frames, the axes are used.
pub fn parse_printed_position(path: &Path) -> Result<String> {
    let json = printed_texts(path)?;
    let rows = ["positions", "items", "variables", "points"].iter().find_map(|list| json.get(*list)?.as_array());
    let found = match rows.map(Vec::as_slice) {
        Some([only]) => text(only),
        Some(rows) => rows.iter().find(|row| row["frame"] == "joint").and_then(text),
        None => text(&json),
    };
    let shown = path.display();
    found.ok_or_else(|| {
        Failure::usage(format!("{shown}: the file must contain exactly one position"))
            .hint("create the file with `position --json`, or with `get --json` for a single point")
    })
}

/// Text of a position or of the value of an item. If there is no text, it is formed from named coordinates: `x=1.5
/// y=2`.
fn text(json: &Json) -> Option<String> {
    if let Some(text) = json.get("text").and_then(Json::as_str) {
        return Some(text.to_owned());
    }
    let named = json.as_object()?.iter().filter(|(_, value)| value.is_number());
    let named = named.filter_map(|(name, value)| Some(format!("{}={value}", name.strip_suffix("_mm")?)));
    let typed = named.collect::<Vec<_>>().join(" ");
    if typed.is_empty() { text(json.get("value")?) } else { Some(typed) }
}

/// JSON in a file or on stdin (`-`). Of an envelope, only the data is returned.
fn printed_texts(path: &Path) -> Result<Json> {
    let shown = if path == Path::new("-") { "stdin".to_owned() } else { path.display().to_string() };
    let bytes = files::input(path, SIZE_LIMIT).with_context(|| shown.clone())?;
    let json: Result<Json, _> = serde_json::from_slice(&bytes);
    let mut json =
        json.map_err(|error| Failure::usage(format!("{shown}: {error}")).hint("use a file from `position --json`"))?;
    let data = json.as_object_mut().and_then(|envelope| envelope.remove("data"));
    Ok(data.unwrap_or(json))
}

#[cfg(test)]
mod tests {

    use super::*;

    #[test]
    fn parses_positions_printed_by_any_command() {
        assert_eq!(text(&json!({"frame": "base", "x_mm": 1.0, "text": "x=1.00"})).as_deref(), Some("x=1.00"));
        assert_eq!(text(&json!({"name": "P1", "value": {"text": "pulse:s=1"}})).as_deref(), Some("pulse:s=1"));
        assert_eq!(text(&json!({"point": 1, "x_mm": 1.5, "r_mm": -2.0, "ok": true})).as_deref(), Some("x=1.5 r=-2.0"));
        assert_eq!(text(&json!({"name": "P1", "value": null})), None);
    }
}

//! What teaching reports in every family, and positions that another command printed.

use std::path::Path;

use anyhow::Context as _;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value as Json};

use super::report::Report;
use crate::failure::{Failure, Kind};
use crate::files;
use crate::output::view::{Cell, Tone, View};

/// A taught point: what it was and is, and the position of the robot that was stored.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Taught<P, Q> {
    /// `P5`, or the number of the point.
    name: String,
    /// What it held; null where it was not defined.
    old: Option<P>,
    /// What it holds, as read back.
    new: P,
    /// Where the robot was.
    position: Q,
    /// Whether it was written; false where it held that already.
    written: bool,
    /// Which point it is, in the words of the family.
    #[serde(flatten)]
    with: Map<String, Json>,
    /// Old and new in words.
    #[serde(skip)]
    words: [String; 2],
}

impl<P, Q> Taught<P, Q> {
    /// Of values and how they are shown.
    pub fn new(name: impl Into<String>, old: Option<P>, new: P, position: Q, shown: impl Fn(&P) -> String) -> Self {
        let words = [old.as_ref().map_or_else(|| "undefined".to_owned(), &shown), shown(&new)];
        Self { name: name.into(), old, new, position, written: true, with: Map::new(), words }
    }

    /// With a name or a number that belongs to it.
    #[must_use]
    pub fn with(mut self, name: &str, value: impl Into<Json>) -> Self {
        self.with.insert(name.to_owned(), value.into());
        self
    }

    /// The same where nothing had to be written.
    #[must_use]
    pub fn unchanged(self, is_unchanged: bool) -> Self {
        Self { written: !is_unchanged, ..self }
    }
}

impl<P: Serialize + JsonSchema, Q: Serialize + JsonSchema> Report for Taught<P, Q> {
    fn view(&self) -> View {
        let [old, new] = &self.words;
        let result = if self.written { "taught" } else { "unchanged: it was there already" };
        View::fields([
            ("point", self.name.as_str().into()),
            ("old", old.as_str().into()),
            ("new", new.as_str().into()),
            ("result", Cell::from(result).tone(Tone::Good)),
        ])
    }
}

/// What was taught is not what is there.
pub fn mismatch(name: &str, taught: &str, held: &str) -> Failure {
    let message = format!("{name} was written and holds something else: {held}; the robot is at {taught}");
    Failure::new(Kind::Malformed, message)
        .hint("the robot moved meanwhile, or somebody else wrote the point: look, then teach it again")
}

/// It was written, but not read back.
pub fn not_read_back(name: &str, failure: Failure, command: &str) -> Failure {
    let message = format!("{name} was written, but not read back: {}", failure.message);
    Failure { kind: Kind::OutcomeUnknown, message, ..failure }.hint(format!("`{command}` tells what it holds"))
}

/// A position takes a kilobyte; this is room for a whole report around it.
const MOST: u64 = 1 << 20;

/// The JSON of a file, or of stdin for `-`: what another command printed. Of an envelope its data.
pub fn printed(path: &Path) -> Result<Json, Failure> {
    let shown = if path == Path::new("-") { "stdin".to_owned() } else { path.display().to_string() };
    let bytes = files::input(path, MOST).with_context(|| shown.clone())?;
    let json: Result<Json, _> = serde_json::from_slice(&bytes);
    let mut json = json.map_err(|error| {
        Failure::usage(format!("{shown}: {error}")).hint("it holds a position as `position --json` prints it")
    })?;
    let data = json.as_object_mut().and_then(|envelope| envelope.remove("data"));
    Ok(data.unwrap_or(json))
}

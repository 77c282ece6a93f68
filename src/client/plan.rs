//! What a dry run notes instead of sending it.

use serde_json::{Value, json};

/// What would be sent, in the order of sending.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    /// Each under the key of its family (`hex`, `wi`, `bits`, `text`), beside `about` and `depends_on` where there is a
    /// [`Reason`].
    pub frames: Vec<Value>,
    /// What a long work would do with each of its files or parts, in the form of the command.
    pub items: Vec<Value>,
    /// What follows that cannot be shown, in words.
    pub then: Option<String>,
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

/// A field of an order that moves something, in words: `("speed", "50.0 mm/s")`.
pub type FieldInWords = (String, String);

/// A frame with its fields in words, if it has any.
pub fn with_fields(mut frame: Value, fields: &[FieldInWords]) -> Value {
    if let Some(frame) = frame.as_object_mut().filter(|_| !fields.is_empty()) {
        let field = |(name, value): &FieldInWords| json!({ "name": name, "value": value });
        frame.insert("fields".to_owned(), fields.iter().map(field).collect());
    }
    frame
}

/// Fields of two orders, of which nothing is known where both differ.
pub fn in_common(one: Vec<FieldInWords>, other: &[FieldInWords]) -> Vec<FieldInWords> {
    let of = |(index, (name, value)): (usize, FieldInWords)| {
        let is_same = other.get(index).is_some_and(|(_, other)| *other == value);
        (name, if is_same { value } else { "?".to_owned() })
    };
    one.into_iter().enumerate().map(of).collect()
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
}

//! Shared TOML reader of parameters, points and programs: named values, with positions for errors.

use std::fmt::Write as _;
use std::ops::Range;

use toml_edit::{Document, Item, Table, TableLike, Value as Toml};

use super::plain;
use crate::findings::{Finding, Findings, SourceLocation};
use crate::nearest::nearest;
use crate::source;
use crate::toyo::field::{Field, Form, Value};

/// Comment that describes fields: `, mm` or `; J Japanese, E English`.
pub(super) fn comment(fields: &[Field]) -> String {
    let mut comment = String::new();
    let mut reported: Vec<String> = Vec::new();
    for field in fields {
        let about = match field.form {
            Form::Word(words) if words.iter().any(|word| word.text != word.about) => {
                let words = words.iter().map(|word| format!("{} {}", word.text.trim_end(), word.about));
                format!("; {}", words.collect::<Vec<_>>().join(", "))
            }
            _ if !field.unit.is_empty() => format!(", {}", field.unit),
            _ => continue,
        };
        if !reported.contains(&about) {
            comment.push_str(&about);
            reported.push(about);
        }
    }
    comment
}

/// Formats values: one field as a plain value, several as an inline table.
pub(super) fn toml(fields: &[Field], values: &[Value]) -> String {
    let quoted = |field: &Field, value: &Value| match value {
        Value::Number(_) => plain(field, value),
        _ => format!("\"{}\"", plain(field, value)),
    };
    if let ([field], [value]) = (fields, values) {
        return quoted(field, value);
    }
    let mut text = String::from("{ ");
    for (index, (field, value)) in fields.iter().zip(values).enumerate() {
        let comma = if index > 0 { ", " } else { "" };
        let _ = write!(text, "{comma}{} = {}", field.name, quoted(field, value));
    }
    text.push_str(" }");
    text
}

/// Parses TOML and passes the document to `walk`. Its result is returned only without errors.
pub(super) fn read<T>(bytes: &[u8], walk: impl FnOnce(&mut Reading<'_>, &Table) -> T) -> Result<T, Vec<Finding>> {
    let mut findings = Findings::default();
    let text = source::lines(bytes, &mut findings).join("\n");
    if findings.errors() > 0 {
        return Err(findings.into_errors());
    }
    let mut reading = Reading { places: Places::new(&text), findings };
    let result = match Document::parse(&text[..]) {
        Ok(document) => Some(walk(&mut reading, document.as_table())),
        Err(error) => {
            let at = reading.places.place(&error.span().unwrap_or_default());
            reading.findings.error(at, error.message().replace('\n', ", "), None);
            None
        }
    };
    result.filter(|_| reading.findings.errors() == 0).ok_or_else(|| reading.findings.into_errors())
}

/// State of a TOML reader.
pub(super) struct Reading<'t> {
    places: Places<'t>,
    pub findings: Findings,
}

impl Reading<'_> {
    /// The values of all fields of the entry `name`.
    pub fn values(&mut self, name: &str, fields: &'static [Field], item: &Item, at: SourceLocation) -> Vec<Value> {
        match (fields, item, item.as_table_like()) {
            ([field], Item::Value(value), _) => self.value(field, value).into_iter().collect(),
            ([field], ..) => {
                self.findings.error(at, format!("{name} must be one value: {}", field.expected()), None);
                Vec::new()
            }
            (fields, _, Some(table)) => self.fields(fields, table, at),
            (fields, ..) => {
                let names: Vec<String> = fields.iter().map(|field| format!("{} = …", field.name)).collect();
                let hint = format!("write {{ {} }}", names.join(", "));
                self.findings.error(at, format!("{name} has {} values", fields.len()), Some(hint));
                Vec::new()
            }
        }
    }

    /// All fields, in their order.
    fn fields(&mut self, fields: &'static [Field], table: &dyn TableLike, at: SourceLocation) -> Vec<Value> {
        for (name, _) in table.iter().filter(|(name, _)| !fields.iter().any(|field| field.name == *name)) {
            let at = self.key(table, name);
            self.unknown(at, "value", name, fields.iter().map(|field| field.name));
        }
        let mut values = Vec::with_capacity(fields.len());
        for field in fields {
            match table.get(field.name) {
                Some(Item::Value(value)) => values.extend(self.value(field, value)),
                Some(_) => {
                    let at = self.key(table, field.name);
                    self.findings.error(at, format!("{}: {} is expected", field.name, field.expected()), None);
                }
                None => self.findings.error(at, format!("{} is missing: {}", field.name, field.expected()), None),
            }
        }
        values
    }

    /// One value. Numbers are read from their text, so that no decimal is lost.
    fn value(&mut self, field: &Field, value: &Toml) -> Option<Value> {
        let span = value.span().unwrap_or_default();
        let text = match value {
            Toml::String(text) if !matches!(field.form, Form::Number(_)) => Some(&text.value()[..]),
            Toml::Integer(_) | Toml::Float(_) => self.places.text.get(span.clone()),
            _ => None,
        };
        let read = match text {
            Some(text) => field.read(text).map_err(|error| error.to_string()),
            None => Err(format!("{}: {} is expected", field.name, field.expected())),
        };
        read.map_err(|message| self.findings.error(self.places.place(&span), message, None)).ok()
    }

    /// Reports an unknown name.
    pub fn unknown(
        &mut self,
        at: SourceLocation,
        what: &str,
        name: &str,
        known: impl IntoIterator<Item = &'static str>,
    ) {
        if self.findings.is_full() {
            return self.findings.error(at, "", None);
        }
        let near = nearest(name, known).map(|near| format!("did you mean {near}?"));
        self.findings.error(at, format!("unknown {what} '{}'", name.escape_debug()), near);
    }

    /// Position of a key.
    pub fn key(&self, table: &dyn TableLike, name: &str) -> SourceLocation {
        self.places.place(&table.key(name).and_then(toml_edit::Key::span).unwrap_or_default())
    }
}

/// Line index of a text, for fast position lookup.
struct Places<'t> {
    text: &'t str,
    /// Start of each line.
    lines: Vec<usize>,
}

impl<'t> Places<'t> {
    fn new(text: &'t str) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { text, lines }
    }

    fn place(&self, span: &Range<usize>) -> SourceLocation {
        let line = self.lines.partition_point(|start| *start <= span.start);
        let start = self.lines.get(line.saturating_sub(1)).copied().unwrap_or_default();
        let column = self.text.get(start..span.start).map_or(0, |before| before.chars().count()) + 1;
        SourceLocation { line, column }
    }
}

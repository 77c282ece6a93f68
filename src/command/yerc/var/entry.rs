//! JSON form of a variable.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::Value as Json;

use super::in_form;
use super::position::{self, PositionData};
use crate::command::frame::items::ItemError;
use crate::command::frame::names;
use crate::command::yerc::each::{Outcome, ReadError};
use crate::controller::names::{Kind, Names};
use crate::controller::text::Encoding;
use crate::controller::text::hex;
use crate::controller::yerc::Model;
use crate::controller::yerc::payload::Text;
use crate::controller::yerc::variables::{Reference, Value, VariableKind};

/// A variable and its value.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Entry {
    /// `B0`.
    name: String,
    /// User name; null if there is none; absent in files.
    #[serde(skip_serializing_if = "Label::is_of_file")]
    #[schemars(with = "Option<String>")]
    label: Label,
    /// `variable`; in files `B`, `I`, `D`, `R`, `S`, `P`, `BP` or `EX`.
    kind: &'static str,
    number: u16,
    /// Whether the controller answered, even if there is no value; absent in files.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "bool")]
    ok: Option<bool>,
    /// Null if the controller has none.
    value: Option<Data>,
    /// Raw bytes, if the value does not convert back to them.
    #[serde(skip_serializing_if = "Option::is_none")]
    value_hex: Option<String>,
    /// The variable exists but was never taught.
    #[serde(skip_serializing_if = "is_false")]
    undefined: bool,
    /// Reason why the controller did not answer.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
    /// Reason for the missing value, for a failure.
    #[serde(skip)]
    missing: Option<ItemError>,
}

/// User name of a variable.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
#[serde(untagged)]
enum Label {
    /// Not present in files.
    #[default]
    OfFile,
    /// No name.
    Unnamed,
    /// This name.
    Named(String),
}

impl Label {
    const fn is_of_file(&self) -> bool {
        matches!(self, Self::OfFile)
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it so")]
const fn is_false(flag: &bool) -> bool {
    !*flag
}

/// The value of a variable.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Data {
    /// B, I, D.
    Integer(i32),
    /// R, with the fewest digits that convert back to it.
    Real(f64),
    /// S; also an R that is not a number: `NaN`, `inf`, `-inf`.
    Text(String),
    /// P, BP, EX.
    Position(Box<PositionData>),
}

/// Added status of a variable without a value. The manuals give 0xB001 a second meaning, which cannot occur when one
/// variable is read (3.3.16; DX chapter 5).
const UNDEFINED: [u32; 2] = [0xB005, 0xB001];

/// Whether a refusal to read one variable means that it is undefined.
pub fn is_undefined(denied: &ReadError) -> bool {
    matches!(denied, ReadError::Refused(refusal) if UNDEFINED.contains(&refusal.status.added))
}

impl Entry {
    /// Entry from an answer.
    pub fn new(reference: Reference, outcome: &Outcome<Value>, encoding: Encoding) -> Self {
        let (name, kind, number) = (reference.to_string(), VARIABLE, reference.number);
        let known = Self {
            name,
            label: Label::Unnamed,
            kind,
            number,
            ok: Some(true),
            value: None,
            value_hex: None,
            undefined: false,
            error: None,
            missing: None,
        };
        match outcome {
            Ok(value) => {
                let (data, value_hex) = data_of(value, encoding);
                Self { value: Some(data), value_hex, ..known }
            }
            Err(denied) => {
                let missing = Some(ItemError::new(reference.to_string(), denied.clone().into()));
                if is_undefined(denied) {
                    Self { undefined: true, missing, ..known }
                } else {
                    Self { ok: Some(false), error: missing.clone(), missing, ..known }
                }
            }
        }
    }

    /// Entry without the controller's status, for a file, in which null is sufficient.
    #[must_use]
    pub fn bare(self) -> Self {
        let letters = self.name.parse().map_or(self.kind, |reference: Reference| reference.kind.letters());
        Self { label: Label::default(), kind: letters, ok: None, undefined: false, error: None, missing: None, ..self }
    }

    /// Entry with the user name.
    #[must_use]
    pub fn labelled(self, names: &Names) -> Self {
        let label = names::label(names, Kind::Variable, &self.name);
        Self { label: label.map_or(Label::Unnamed, Label::Named), ..self }
    }

    /// User name.
    pub fn label(&self) -> Option<&str> {
        match &self.label {
            Label::Named(name) => Some(name),
            Label::Unnamed | Label::OfFile => None,
        }
    }

    /// Variable name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Value as text, or the reason why there is none.
    pub fn shown(&self) -> String {
        match (&self.value, &self.error) {
            (Some(data), _) => data.to_string(),
            (None, Some(error)) => error.cell().text,
            (None, None) => "undefined".to_owned(),
        }
    }

    /// Value in JSON; null if there is none.
    pub fn data(&self) -> Json {
        serde_json::to_value(&self.value).unwrap_or(Json::Null)
    }

    /// Whether the value is a number.
    pub fn is_number(&self) -> bool {
        matches!(self.value, Some(Data::Integer(_) | Data::Real(_)))
    }

    /// Whether it has a default value: 0, an empty text, or a position that was never taught.
    pub fn is_blank(&self) -> bool {
        match &self.value {
            Some(Data::Integer(number)) => *number == 0,
            Some(Data::Real(number)) => *number == 0.0,
            Some(Data::Text(text)) => text.is_empty(),
            Some(Data::Position(_)) => false,
            None => self.error.is_none(),
        }
    }

    /// Whether there is a value.
    pub fn has_value(&self) -> bool {
        self.value.is_some()
    }

    /// Reason why the controller did not answer.
    pub fn error(&self) -> Option<&ItemError> {
        self.error.as_ref()
    }

    /// Reason for the missing value: refused or undefined.
    pub fn missing(&self) -> Option<&ItemError> {
        self.missing.as_ref()
    }
}

impl std::fmt::Display for Data {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Integer(value) => value.fmt(f),
            // With a decimal point or an exponent, so that it is recognised as a real.
            Self::Real(value) => write!(f, "{value:?}"),
            Self::Text(text) => f.write_str(text),
            Self::Position(position) => f.write_str(position.text()),
        }
    }
}

fn data_of(value: &Value, encoding: Encoding) -> (Data, Option<String>) {
    let text = |bytes: &[u8]| {
        let name = encoding.name(bytes);
        (Data::Text(name.text), name.hex)
    };
    match value {
        Value::Byte(value) => (Data::Integer((*value).into()), None),
        Value::Integer(value) => (Data::Integer((*value).into()), None),
        Value::Double(value) => (Data::Integer(*value), None),
        Value::Real(value) => match shortest(*value) {
            Some(value) => (Data::Real(value), None),
            None => (Data::Text(value.to_string()), Some(hex(&value.to_le_bytes()))),
        },
        Value::Short(value) => text(value.as_bytes()),
        Value::Long(value) => text(value.as_bytes()),
        Value::Position(_) | Value::Base(_) | Value::External(_) => {
            let position = PositionData::of(value).map(Box::new);
            (position.map_or(Data::Text(String::new()), Data::Position), None)
        }
    }
}

/// 64-bit number with the digits of the 32-bit number; none if it is not a number.
fn shortest(value: f32) -> Option<f64> {
    if value.is_finite() { format!("{value:?}").parse().ok() } else { None }
}

/// Context for reading the variables of a file.
#[derive(Debug, Clone, Copy)]
pub struct Reading {
    /// Model of the target robot.
    pub model: Model,
    /// Encoding of the decoded strings.
    pub encoding: Encoding,
}

/// Kind of every item in a report.
const VARIABLE: &str = "variable";

const KEYS: [&str; 5] = ["name", "kind", "number", "value", "value_hex"];
/// Additional keys in reports.
const REPORTED: [&str; 4] = ["ok", "label", "undefined", "error"];

impl Reading {
    /// Reads an entry of a dump: the variable, and its value unless it is null. An error starts with the location in
    /// the entry, such as `.value: `.
    pub fn entry(self, entry: &Json) -> Result<(Reference, Option<Value>), String> {
        let object = entry.as_object().ok_or(": expected an object")?;
        if let Some(key) = object.keys().find(|key| !KEYS.iter().chain(&REPORTED).any(|known| known == key)) {
            return Err(format!(".{key}: unknown; there are {}", KEYS.join(", ")));
        }
        let name = object.get("name").and_then(Json::as_str).ok_or(".name: expected a name such as \"B0\"")?;
        let reference: Reference = name.parse().map_err(|error| format!(".name: {error}"))?;
        let reference = in_form(reference, self.model, false);
        if object.get("kind").is_some_and(|kind| kind != reference.kind.letters() && kind != VARIABLE) {
            return Err(format!(".kind: contradicts the name {name}"));
        }
        if object.get("number").is_some_and(|number| number.as_u64() != Some(reference.number.into())) {
            return Err(format!(".number: contradicts the name {name}"));
        }
        let bytes =
            object.get("value_hex").map(|digits| from_hex(digits).map_err(|error| format!(".value_hex: {error}")));
        let value = match (object.get("value"), bytes.transpose()?) {
            (None, _) => return Err(".value: missing; use null for an undefined variable".to_owned()),
            (Some(Json::Null), None) => None,
            (Some(value), Some(bytes)) => Some(self.exact(reference.kind, value, &bytes)?),
            (Some(value), None) => Some(self.value(reference.kind, value).map_err(|error| format!(".value{error}"))?),
        };
        Ok((reference, value))
    }

    /// Reads a value in the form of an entry. An error starts with the location in the value.
    pub fn value(self, kind: VariableKind, value: &Json) -> Result<Value, String> {
        let typed = |text: &[u8]| Value::from_text(kind, text).map_err(|error| format!(": {error}"));
        match (kind, value) {
            (VariableKind::P | VariableKind::Bp | VariableKind::Ex, Json::Object(object)) => {
                position::read(kind, object)
            }
            (VariableKind::P | VariableKind::Bp | VariableKind::Ex, Json::String(text)) => typed(text.as_bytes()),
            (VariableKind::P | VariableKind::Bp | VariableKind::Ex, _) => {
                Err(": expected an object or a text such as \"pulse:…\"".to_owned())
            }
            (VariableKind::S16 | VariableKind::S32, Json::String(text)) => {
                typed(&self.encoding.encode(text).map_err(|error| format!(": {error}"))?)
            }
            (VariableKind::S16 | VariableKind::S32, _) => Err(": expected a string".to_owned()),
            // The original digits, so that a real is not rounded twice.
            (_, Json::Number(number)) => typed(number.to_string().as_bytes()),
            _ => Err(": expected a number".to_owned()),
        }
    }

    /// A value defined by its bytes; the shown value must match them.
    fn exact(self, kind: VariableKind, shown: &Json, bytes: &[u8]) -> Result<Value, String> {
        let value = match kind {
            VariableKind::S16 => Text::new(bytes).map(Value::Short).map_err(|error| format!(".value_hex: {error}"))?,
            VariableKind::S32 => Text::new(bytes).map(Value::Long).map_err(|error| format!(".value_hex: {error}"))?,
            VariableKind::R => {
                let bytes = bytes.try_into().map_err(|_| ".value_hex: expected 4 bytes")?;
                Value::Real(f32::from_le_bytes(bytes))
            }
            _ => return Err(".value_hex: only strings and reals have one".to_owned()),
        };
        let (data, _) = data_of(&value, self.encoding);
        let expected = match data {
            Data::Text(text) => Json::String(text),
            Data::Real(value) => Json::from(value),
            Data::Integer(_) | Data::Position(_) => Json::Null,
        };
        if *shown == expected {
            Ok(value)
        } else {
            Err(".value: does not match value_hex; remove value_hex to use the value".to_owned())
        }
    }
}

fn from_hex(digits: &Json) -> Result<Vec<u8>, &'static str> {
    let wrong = "expected pairs of hexadecimal digits";
    let digits = digits.as_str().ok_or(wrong)?.as_bytes();
    if digits.len() % 2 == 1 {
        return Err(wrong);
    }
    let digit = |byte: u8| char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok()).ok_or(wrong);
    digits.chunks_exact(2).map(|pair| Ok(digit(pair[0])? << 4 | digit(pair[1])?)).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::command::yerc::link::{Refusal, RefusedRequest};
    use crate::controller::yerc::wire::Status;

    const READING: Reading = Reading { model: Model::Dx200, encoding: Encoding::ShiftJis };

    fn round(name: &str, value: &Value) -> Json {
        let reference = in_form(name.parse().unwrap(), READING.model, false);
        let json = serde_json::to_value(Entry::new(reference, &Ok(value.clone()), READING.encoding)).unwrap();
        // As read from a file.
        let json: Json = serde_json::from_str(&json.to_string()).unwrap();
        let (back, read) = READING.entry(&json).unwrap();
        assert_eq!((back, read.map(|value| value.emit())), (reference, Some(value.emit())), "{json}");
        json
    }

    #[test]
    fn numbers_survive_json() {
        assert_eq!(
            round("B7", &Value::Byte(255)),
            json!({"name": "B7", "label": null, "kind": "variable", "number": 7, "ok": true, "value": 255})
        );
        round("I0", &Value::Integer(-32768));
        round("D0", &Value::Double(i32::MIN));
        assert_eq!(round("R0", &Value::Real(1.1))["value"], json!(1.1));
        for bits in [0, 1, 0x8000_0000, 0x3F80_0001, 0x7F7F_FFFF, 0x0080_0000, 0x4B7F_FFFF, 0x7F80_0000, 0xFFC0_0001] {
            round("R0", &Value::Real(f32::from_bits(bits)));
        }
        let mut bits = 12345_u32;
        for _ in 0..20_000 {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            round("R0", &Value::Real(f32::from_bits(bits)));
        }
    }

    #[test]
    fn strings_survive_json() {
        let s = |bytes: &[u8]| Value::Long(Text::new(bytes).unwrap());
        assert_eq!(
            round("S0", &s(b"\x83\x65")),
            json!({"name": "S0", "label": null, "kind": "variable", "number": 0, "ok": true, "value": "テ"})
        );
        assert_eq!(round("S0", &s(b"A\xFF"))["value_hex"], json!("41ff"));
        round("S0", &s(b""));
        round("S0", &s(b"\x1b[31m\\x80"));
        round("S0", &s(&[0xFF; 32]));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let error = |json: Json| READING.entry(&json).unwrap_err();
        assert_eq!(error(json!({"name": "B0", "value": 256})), ".value: '256' is not a number from 0 to 255");
        assert_eq!(error(json!({"name": "B0", "value": 1.5})), ".value: '1.5' is not a number from 0 to 255");
        assert_eq!(error(json!({"name": "B0", "kind": "I", "value": 1})), ".kind: contradicts the name B0");
        assert_eq!(error(json!({"name": "B0", "number": 1, "value": 1})), ".number: contradicts the name B0");
        assert_eq!(error(json!({"name": "B0"})), ".value: missing; use null for an undefined variable");
        assert!(error(json!({"name": "B0", "vlaue": 1})).starts_with(".vlaue: unknown"));
        assert!(error(json!({"name": "S0", "value": "A", "value_hex": "42"})).contains("remove value_hex"));
        assert!(error(json!({"name": "S0", "value": "A", "value_hex": "4"})).starts_with(".value_hex"));
        assert_eq!(error(json!({"name": "P0", "value": {"type": "pulse"}})), ".value: axes are missing");
        let position = json!({"type": "base", "x_mm": "1"});
        assert_eq!(error(json!({"name": "P0", "value": position})), ".value.x_mm: expected a number");
        assert!(error(json!({"name": "S0", "value": "한"})).starts_with(".value: '한'"));
        assert!(error(json!([1])).starts_with(": expected an object"));
        assert_eq!(READING.entry(&json!({"name": "P0", "value": null})).unwrap().1, None);
    }

    #[test]
    fn refusals_say_whether_there_is_nothing_to_read() {
        let p = Reference::new(VariableKind::P, 3);
        let to = RefusedRequest::Robot { command: 0x7F, instance: 3 };
        let refused = |code| Err(ReadError::Refused(Refusal { status: Status::refused(code), to }));
        let undefined = Entry::new(p, &refused(0xB005), READING.encoding);
        assert_eq!((undefined.shown().as_str(), undefined.error()), ("undefined", None));
        let json = serde_json::to_value(&undefined).unwrap();
        assert_eq!(READING.entry(&json).unwrap(), (p, None));
        let refused = Entry::new(p, &refused(0x2010), READING.encoding);
        assert_eq!(refused.shown(), "the controller refused 0x7F (instance 3): manipulator is moving [0x2010]");
        assert_eq!(serde_json::to_value(&refused).unwrap()["error"]["asked"], "P3");
    }
}

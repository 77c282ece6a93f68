//! JSON form of positions: every axis with its unit, and the text of `var set`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value as Json, json};

use super::part::unlike;
use crate::controller::units::{self, Quantity, Unit};
use crate::controller::yerc::group::Group;
use crate::controller::yerc::payload::{
    BasePosition, ExtendedForm, ExternalPosition, Form, NamedAxis, Position, PositionKind,
};
use crate::controller::yerc::variables::{Value, VariableKind};

/// Position of a group as a variable value: P for robots, BP for bases, EX for stations.
pub fn held(group: Group, position: Position) -> Value {
    let Position { kind, axes, .. } = position;
    match group {
        Group::Robot(_) => Value::Position(position),
        Group::Base(_) => Value::Base(BasePosition { kind, axes }),
        Group::Station(_) => Value::External(ExternalPosition { kind, axes }),
    }
}

/// Value in the form of a robot position; for a base or a station only type and axes are valid.
pub fn as_position(value: &Value) -> Position {
    let bare = |kind, axes| Position { kind, form: Form(0), tool: 0, user: 0, extended: ExtendedForm(0), axes };
    match value {
        Value::Position(position) => *position,
        Value::Base(track) => bare(track.kind, track.axes),
        Value::External(station) => bare(station.kind, station.axes),
        _ => unlike()[0],
    }
}

/// A position.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PositionData {
    /// Notation of `var set`.
    text: String,
    /// `pulse`, `base`, `robot`, `user`, `tool`; `type5` for a type without a name.
    r#type: String,
    /// Type number.
    type_code: u32,
    /// `x_mm`, `y_mm`, `z_mm`, `rx_deg`, `ry_deg`, `rz_deg`, `re_deg`; `s_pulses`, `l_pulses`, …; `axis_8_pulses`.
    #[serde(flatten)]
    #[schemars(with = "BTreeMap<String, f64>")]
    axes: Map<String, Json>,
    /// Fields of robot positions only.
    #[serde(flatten)]
    arm: Option<Arm>,
}

/// Arm configuration of a position.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
struct Arm {
    tool: u32,
    user: u32,
    /// Decoded form: `back+upper+noflip`.
    form: String,
    form_code: u32,
    /// Decoded extended form.
    extended_form: String,
    extended_form_code: u32,
}

impl PositionData {
    /// Value as a position, if it is one.
    pub fn of(value: &Value) -> Option<Self> {
        let (text, kind, axes, shown) = match value {
            Value::Position(position) => {
                (position.to_string(), position.kind, position.named_axes(), position.shown_axes())
            }
            Value::Base(position) => {
                (position.to_string(), position.kind, position.named_axes(), position.shown_axes())
            }
            Value::External(position) => {
                (position.to_string(), position.kind, position.named_axes(), position.shown_axes())
            }
            _ => return None,
        };
        let arm = match value {
            Value::Position(position) => Some(Arm {
                tool: position.tool,
                user: position.user,
                form: position.form.words().collect::<Vec<_>>().join("+"),
                form_code: position.form.0,
                extended_form: position.extended.words().collect::<Vec<_>>().join("+"),
                extended_form_code: position.extended.0,
            }),
            _ => None,
        };
        let axes = axes.iter().take(shown).map(|axis| (key(axis), amount(axis.unit.show(axis.value)))).collect();
        Some(Self { text, r#type: type_name(kind), type_code: kind.word(), axes, arm })
    }

    /// Text in the notation of `var set`.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// Reads a position from its JSON object: from the text, from the fields, or from both if they agree. An error starts
/// with the location, such as `.x_mm: `.
pub fn read(kind: VariableKind, object: &Map<String, Json>) -> Result<Value, String> {
    let from_text = match object.get("text") {
        Some(Json::String(text)) => Some(parse(kind, text).map_err(|error| format!(".text{error}"))?),
        Some(_) => return Err(".text: expected a string".to_owned()),
        None => None,
    };
    let from_fields = if object.contains_key("type") { Some(read_fields(kind, object)?) } else { None };
    match (from_text, from_fields) {
        (Some(text), Some(fields)) if text != fields => {
            Err(": text contradicts the other fields; remove text to use the fields".to_owned())
        }
        (Some(_), None) if object.len() > 1 => {
            Err(": type is missing; give type and all axes, or only text".to_owned())
        }
        (Some(value), _) | (None, Some(value)) => Ok(value),
        (None, None) => Err(": text and type are missing".to_owned()),
    }
}

fn read_fields(kind: VariableKind, object: &Map<String, Json>) -> Result<Value, String> {
    let Some(Json::String(name)) = object.get("type") else {
        return Err(".type: expected a string".to_owned());
    };
    let mut parts = Vec::new();
    let mut given = Vec::new();
    for (name, value) in object {
        match name.as_str() {
            "text" | "type" | "type_code" | "form" | "extended_form" => {}
            "tool" | "user" if kind == VariableKind::P => parts.push(format!("{name}={}", number(name, value)?)),
            "form_code" if kind == VariableKind::P => parts.extend(flags("form", name, value)?),
            "extended_form_code" if kind == VariableKind::P => parts.extend(flags("ext", name, value)?),
            _ => {
                let axis = axis_of(name).ok_or_else(|| format!(".{name}: not a field of a position"))?;
                parts.push(format!("{axis}={}", number(name, value)?));
                given.push(name);
            }
        }
    }
    if parts.is_empty() {
        return Err(": axes are missing".to_owned());
    }
    let value = parse(kind, &format!("{name}:{}", parts.join(",")))?;
    let data = PositionData::of(&value).ok_or(": no position")?;
    agrees(object, "type_code", &json!(data.type_code))?;
    let names: Vec<String> = axes(&value).iter().map(key).collect();
    if let Some(name) = given.iter().find(|name| !names.contains(name)) {
        return Err(format!(".{name}: not a field of this position; its axes are {}", names.join(", ")));
    }
    if let Value::Position(position) = &value {
        words_agree(object, "form", "form_code", &position.form.words().collect::<Vec<_>>(), position.form == Form(0))?;
        let (extended, none) = (position.extended, position.extended == ExtendedForm(0));
        words_agree(object, "extended_form", "extended_form_code", &extended.words().collect::<Vec<_>>(), none)?;
    }
    Ok(value)
}

/// Decoded words without their code would be lost, and words that contradict the code are an error.
fn words_agree(
    object: &Map<String, Json>,
    words: &str,
    code: &str,
    expected: &[&'static str],
    is_default: bool,
) -> Result<(), String> {
    match (object.get(words), object.contains_key(code)) {
        (Some(found), _) if *found == json!(expected.join("+")) => Ok(()),
        (Some(_), true) => Err(format!(": {words} contradicts {code}; remove {words} to use {code}")),
        (Some(_), false) => Err(format!(": {code} is missing; it is the number of {words}")),
        (None, true) => Ok(()),
        (None, false) if is_default => Ok(()),
        (None, false) => Err(format!(": {code} is missing")),
    }
}

fn agrees(object: &Map<String, Json>, name: &str, expected: &Json) -> Result<(), String> {
    match object.get(name) {
        Some(found) if found != expected => Err(format!(".{name}: {found} contradicts the type, which is {expected}")),
        _ => Ok(()),
    }
}

fn parse(kind: VariableKind, text: &str) -> Result<Value, String> {
    Value::from_text(kind, text.as_bytes()).map_err(|error| format!(": {error}"))
}

/// Digits of a number as in the file.
fn number(name: &str, value: &Json) -> Result<String, String> {
    match value {
        Json::Number(number) => Ok(number.to_string()),
        _ => Err(format!(".{name}: expected a number")),
    }
}

/// Flags in the notation of `var set`; none for 0.
fn flags(key: &str, name: &str, value: &Json) -> Result<Option<String>, String> {
    let code = value.as_u64().and_then(|code| u32::try_from(code).ok());
    let code = code.ok_or_else(|| format!(".{name}: expected a number from 0 to 4294967295"))?;
    Ok((code != 0).then(|| format!("{key}={code:#x}")))
}

fn axes(value: &Value) -> Vec<NamedAxis> {
    match value {
        Value::Position(position) => position.named_axes().to_vec(),
        Value::Base(position) => position.named_axes().to_vec(),
        Value::External(position) => position.named_axes().to_vec(),
        _ => Vec::new(),
    }
}

/// `x_mm`, `s_pulses`, `axis_8_pulses`.
fn key(axis: &NamedAxis) -> String {
    let unit = suffix(axis.unit);
    if axis.key.starts_with(|c: char| c.is_ascii_digit()) {
        format!("axis_{}_{unit}", axis.key)
    } else {
        format!("{}_{unit}", axis.key)
    }
}

/// Whether a field is an axis: `x_mm`, `s_pulses`, `axis_8_pulses`.
pub fn is_axis(name: &str) -> bool {
    axis_of(name).is_some()
}

/// `x` of `x_mm`, `8` of `axis_8_pulses`.
fn axis_of(name: &str) -> Option<&str> {
    let (axis, unit) = name.rsplit_once('_')?;
    let known = [units::MILLIMETRE, units::DEGREE, units::PULSE].into_iter().any(|known| suffix(known) == unit);
    known.then(|| axis.strip_prefix("axis_").unwrap_or(axis))
}

const fn suffix(unit: Unit) -> &'static str {
    unit.symbol
}

/// Exact decimal as a JSON number.
fn amount(quantity: Quantity) -> Json {
    let text = quantity.to_string();
    serde_json::from_str(&text).unwrap_or(Json::String(text))
}

fn type_name(kind: PositionKind) -> String {
    PositionKind::ALL
        .iter()
        .find(|row| row.0 == kind)
        .map_or_else(|| format!("type{}", kind.word()), |row| row.2.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn object(json: &Json) -> Map<String, Json> {
        json.as_object().cloned().unwrap()
    }

    fn data(kind: VariableKind, text: &str) -> (Value, Json) {
        let value = parse(kind, text).unwrap();
        let json = serde_json::to_value(PositionData::of(&value).unwrap()).unwrap();
        (value, json)
    }

    #[test]
    fn positions_survive_json() {
        for (kind, text) in [
            (
                VariableKind::P,
                "base:x=100.000,y=-0.001,z=0.000,rx=180.0000,ry=0.0001,rz=-90.0000,tool=1,form=back+0x300",
            ),
            (VariableKind::P, "pulse:s=1000,l=-2000,u=3000,r=-4000,b=5000,t=-6000,e=7,8=-2147483648,ext=w-ge180"),
            (VariableKind::P, "type5:1=1,2=2,3=3,4=4,5=5,6=6"),
            (VariableKind::P, "base:x=2147483.647,y=1,z=1,rx=0,ry=0,rz=214748.3647,re=1.5"),
            (VariableKind::Bp, "base:x=1.5,y=-2.5,z=0"),
            (VariableKind::Bp, "pulse:1=-1"),
            (VariableKind::Ex, "pulse:1=100,2=200"),
        ] {
            let (value, json) = data(kind, text);
            let whole = object(&json);
            assert_eq!(read(kind, &whole), Ok(value.clone()), "{text}");
            let mut fields = whole.clone();
            fields.remove("text");
            assert_eq!(read(kind, &fields), Ok(value.clone()), "{text}");
            let text_alone = Map::from_iter([("text".to_owned(), whole["text"].clone())]);
            assert_eq!(read(kind, &text_alone), Ok(value), "{text}");
        }
    }

    #[test]
    fn names_carry_units() {
        let (_, json) = data(VariableKind::P, "base:x=100.000,y=0,z=0.5,rx=180,ry=0,rz=0,tool=1");
        assert_eq!(json["x_mm"], json!(100.0));
        assert_eq!(json["rx_deg"], json!(180.0));
        assert_eq!(json["type_code"], json!(16));
        let (_, json) = data(VariableKind::Ex, "pulse:1=100");
        assert_eq!(json, json!({"text": "pulse:1=100", "type": "pulse", "type_code": 0, "axis_1_pulses": 100}));
    }

    #[test]
    fn contradictions_are_refused() {
        let (_, json) = data(VariableKind::P, "base:x=1,y=2,z=3,rx=4,ry=5,rz=6");
        let changed = |name: &str, value: Json| {
            let mut object = object(&json);
            object.insert(name.to_owned(), value);
            read(VariableKind::P, &object).unwrap_err()
        };
        assert!(changed("x_mm", json!(9)).contains("remove text"));
        assert!(changed("x_mm", json!("9")).starts_with(".x_mm: expected a number"));
        assert!(changed("x_pulses", json!(9)).contains("twice"));
        assert!(changed("form_code", json!(1)).contains("form"));
        assert!(changed("type_code", json!(17)).starts_with(".type_code"));
        assert!(changed("speed", json!(17)).starts_with(".speed: not a field"));
        let mut lone = object(&json);
        lone.remove("x_mm");
        lone.insert("x_deg".to_owned(), json!(1));
        assert!(read(VariableKind::P, &lone).unwrap_err().starts_with(".x_deg: not a field of this position"));
        lone.remove("type");
        assert!(read(VariableKind::P, &lone).unwrap_err().starts_with(": type is missing"));
    }
}

//! JSON form of positions: every axis with its unit, and the text for `var set`.

use serde_json::{Map, Value as Json};

use super::position_word::different_words;
use crate::prelude::*;
use armctl_controller::units::{self, Quantity, Unit};
use armctl_controller::yerc::payload::{BasePosition, ExtendedForm, ExternalPosition, Form, MAX_AXES, NamedAxis};
use armctl_controller::yerc::variables::{Value, VariableKind};

/// Position of a group as the value of a variable: P for robots, BP for bases, EX for stations.
pub fn stored_position(group: Group, position: Position) -> Value {
    let Position { kind, axes, .. } = position;
    match group {
        Group::Robot(_) => Value::Position(position),
        Group::Base(_) => Value::Base(BasePosition { kind, axes }),
        Group::Station(_) => Value::External(ExternalPosition { kind, axes }),
    }
}

/// Value in the form of a robot position. For a base or a station, only the type and the axes are valid.
pub fn as_position(value: &Value) -> Position {
    let bare = |kind, axes| Position { kind, form: Form(0), tool: 0, user: 0, extended: ExtendedForm(0), axes };
    match value {
        Value::Position(position) => *position,
        Value::Base(track) => bare(track.kind, track.axes),
        Value::External(station) => bare(station.kind, station.axes),
        _ => different_words()[0],
    }
}

/// A position.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PositionData {
    /// Position in the notation of `var set`.
    text: String,
    /// Type: `pulse`, `base`, `robot`, `user`, `tool`; `type5` for a type without a name.
    r#type: String,
    /// Type number.
    type_code: u32,
    /// Values by axis: `x_mm`, `y_mm`, `z_mm`, `rx_deg`, `ry_deg`, `rz_deg`, `re_deg`; `s_pulses`, `l_pulses`, …;
    /// `axis_8_pulses`.
    #[serde(flatten)]
    #[schemars(with = "BTreeMap<String, f64>")]
    axes: Map<String, Json>,
    /// Fields that only robot positions have.
    #[serde(flatten)]
    arm: Option<Arm>,
}

/// Arm configuration of a position.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
struct Arm {
    tool: u32,
    user: u32,
    /// Form as words: `back+upper+noflip`.
    form: String,
    form_code: u32,
    /// Extended form as words.
    extended_form: String,
    extended_form_code: u32,
}

impl PositionData {
    /// The position in a value; `None` if the value is not a position.
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
        let axes = axes.iter().take(shown).map(|axis| (key(axis), parse_amount(axis.unit.show(axis.value)))).collect();
        Some(Self { text, r#type: type_name(kind), type_code: kind.word(), axes, arm })
    }

    /// Text that `var set` accepts.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Text of each table column, in the form that [`from_fields`] reads.
    pub fn fields(&self) -> BTreeMap<String, String> {
        let mut fields = BTreeMap::from([(TYPE.to_owned(), self.r#type.clone())]);
        fields.extend(self.axes.iter().map(|(name, amount)| (name.clone(), amount.to_string())));
        if let Some(arm) = &self.arm {
            let codes = [arm.tool, arm.user, arm.form_code, arm.extended_form_code];
            fields.extend(ARM.iter().zip(codes).map(|(name, code)| ((*name).to_owned(), code.to_string())));
        }
        fields
    }
}

/// Column of the type.
pub const TYPE: &str = "type";
/// Columns for numbers that only robot positions have.
pub const ARM: [&str; 4] = ["tool", "user", "form_code", "extended_form_code"];

/// Columns for all axes that a position can have.
pub fn axis_columns() -> impl Iterator<Item = String> {
    const CARTESIAN: [&str; 7] = ["x_mm", "y_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg", "re_deg"];
    const PULSES: [&str; 7] = ["s", "l", "u", "r", "b", "t", "e"];
    let pulses = PULSES.iter().map(|axis| format!("{axis}_{}", suffix(units::PULSE)));
    let numbered =
        UNITS.into_iter().flat_map(|unit| (1..=MAX_AXES).map(move |axis| format!("axis_{axis}_{}", suffix(unit))));
    CARTESIAN.map(ToOwned::to_owned).into_iter().chain(pulses).chain(numbered)
}

/// Units of axes.
const UNITS: [Unit; 3] = [units::PULSE, units::MILLIMETRE, units::DEGREE];

/// Position from the text of its columns. These are the type and all axes, and for a robot also `tool`, `user` and the
/// codes of the form.
///
/// # Errors
/// If a column is missing or wrong. The error names the column.
pub fn from_fields(kind: VariableKind, fields: &BTreeMap<String, String>) -> Result<Value, String> {
    let name = fields.get(TYPE).ok_or("`type` is missing; fill in `type` and all axes")?;
    let (mut parts, mut given) = (Vec::new(), Vec::new());
    for (column, text) in fields.iter().filter(|(column, _)| *column != TYPE) {
        match column.as_str() {
            "tool" | "user" if kind == VariableKind::P => parts.push(format!("{column}={text}")),
            "form_code" if kind == VariableKind::P => parts.extend(flags("form", column, text)?),
            "extended_form_code" if kind == VariableKind::P => parts.extend(flags("ext", column, text)?),
            _ => {
                let axis =
                    axis_of(column).ok_or_else(|| format!("`{column}` is not a column of a position of this kind"))?;
                parts.push(format!("{axis}={text}"));
                given.push(column);
            }
        }
    }
    if given.is_empty() {
        return Err("the axes are missing".to_owned());
    }
    let text = format!("{name}:{}", parts.join(","));
    let value = Value::from_text(kind, text.as_bytes()).map_err(|error| error.to_string())?;
    let names: Vec<String> = axes(&value).iter().map(key).collect();
    match given.into_iter().find(|name| !names.contains(name)) {
        Some(name) => Err(format!("{name} is not an axis of this position; its axes are {}", names.join(", "))),
        None => Ok(value),
    }
}

/// Flags in the notation of `var set`; `None` for 0.
fn flags(key: &str, column: &str, text: &str) -> Result<Option<String>, String> {
    let code: u32 = text.parse().map_err(|_| format!("{column}: '{text}' is not a number from 0 to 4294967295"))?;
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

/// Name of an axis field: `x_mm`, `s_pulses`, `axis_8_pulses`.
fn key(axis: &NamedAxis) -> String {
    let unit = suffix(axis.unit);
    if axis.key.starts_with(|c: char| c.is_ascii_digit()) {
        format!("axis_{}_{unit}", axis.key)
    } else {
        format!("{}_{unit}", axis.key)
    }
}

/// Whether a field is the field of an axis: `x_mm`, `s_pulses`, `axis_8_pulses`.
pub fn is_axis(name: &str) -> bool {
    axis_of(name).is_some()
}

/// Axis of a field: `x` for `x_mm`, `8` for `axis_8_pulses`.
fn axis_of(name: &str) -> Option<&str> {
    let (axis, unit) = name.rsplit_once('_')?;
    let known = UNITS.into_iter().any(|known| suffix(known) == unit);
    known.then(|| axis.strip_prefix("axis_").unwrap_or(axis))
}

const fn suffix(unit: Unit) -> &'static str {
    unit.symbol
}

/// Exact decimal number in JSON.
fn parse_amount(quantity: Quantity) -> Json {
    let text = quantity.to_string();
    serde_json::from_str(&text).unwrap_or(Json::String(text))
}

/// Position type with this name.
pub fn parse_named_values(name: &str) -> Option<PositionKind> {
    PositionKind::ALL.iter().find(|row| row.2 == name).map(|row| row.0)
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

    fn data(kind: VariableKind, text: &str) -> PositionData {
        PositionData::of(&Value::from_text(kind, text.as_bytes()).unwrap()).unwrap()
    }

    #[test]
    fn field_names_have_units() {
        let json =
            serde_json::to_value(data(VariableKind::P, "base:x=100.000,y=0,z=0.5,rx=180,ry=0,rz=0,tool=1")).unwrap();
        assert_eq!(json["x_mm"], json!(100.0));
        assert_eq!(json["rx_deg"], json!(180.0));
        assert_eq!(json["type_code"], json!(16));
        let json = serde_json::to_value(data(VariableKind::Ex, "pulse:1=100")).unwrap();
        assert_eq!(json, json!({"text": "pulse:1=100", "type": "pulse", "type_code": 0, "axis_1_pulses": 100}));
    }

    #[test]
    fn refuses_contradictions() {
        let fields = data(VariableKind::P, "base:x=1,y=2,z=3,rx=4,ry=5,rz=6").fields();
        let changed = |name: &str, text: &str| {
            let mut fields = fields.clone();
            fields.insert(name.to_owned(), text.to_owned());
            from_fields(VariableKind::P, &fields).unwrap_err()
        };
        assert!(changed("x_mm", "far").contains("far"));
        assert!(changed("x_pulses", "9").contains("twice"));
        assert!(changed("form_code", "-1").starts_with("form_code: '-1'"));
        assert!(changed("speed", "17").starts_with("`speed` is not a column of a position"));
        let mut single_value = fields.clone();
        single_value.remove("x_mm");
        single_value.insert("x_deg".to_owned(), "1".to_owned());
        assert!(
            from_fields(VariableKind::P, &single_value)
                .unwrap_err()
                .starts_with("x_deg is not an axis of this position")
        );
        single_value.remove(TYPE);
        assert!(from_fields(VariableKind::P, &single_value).unwrap_err().starts_with("`type` is missing"));
    }
}

//! Variables in a table for a spreadsheet: numbers, strings and the fields of positions in columns.
//!
//! A position may have only some of its columns. The other fields keep their value on the controller.

use super::position::{self, PositionData};
use super::position_word::different_words;
use super::value::Data;
use crate::prelude::*;
use armctl_controller::text::{hex, unhex};
use armctl_controller::yerc::payload::Text;
use armctl_controller::yerc::variables::{Value, VariableKind};

/// Text of each cell that is not empty, by column.
pub type Cells = BTreeMap<String, String>;

/// Column for numbers.
const NUMBER: &str = "value";
/// Column for strings, and for reals that are not a number.
const TEXT: &str = "text";
/// Column for the bytes, if the text cannot be converted back to these bytes.
const BYTES: &str = "value_hex";
/// Text for an empty string, because an empty cell means no value. A string that consists of these two characters also
/// has its bytes in the row.
const EMPTY: &str = "\"\"";
/// Highest tool number and user coordinate number (3.3.16). The lowest is 0.
pub const LAST_TOOL: u32 = 63;

/// Columns of a table.
pub fn fields() -> Vec<Field> {
    let number = |name: &'static str| Field::number(name, name);
    let mut fields = vec![number(NUMBER)];
    fields.extend([TEXT, BYTES, position::TYPE].map(|name| Field::text(name, name)));
    fields.extend(position::axis_columns().map(|name| Field { name: name.into(), ..number("") }));
    fields.extend(position::ARM.map(number));
    fields.into_iter().map(Field::optional).collect()
}

/// Cells for a value.
pub fn of(value: &Value, encoding: Encoding) -> Cells {
    let (data, bytes) = Data::of(value, encoding);
    let cell = |column: &str, text: String| (column.to_owned(), text);
    let mut cells = match data {
        Data::Position(position) => position.fields(),
        Data::Text(text) if text.is_empty() => Cells::from([cell(TEXT, EMPTY.to_owned())]),
        Data::Text(text) if text == EMPTY => Cells::from([cell(BYTES, hex(text.as_bytes())), cell(TEXT, text)]),
        // A row is one line of the file.
        Data::Text(text) if text.contains(char::is_control) => Cells::from([cell(BYTES, hex(string_bytes(value)))]),
        Data::Text(text) => Cells::from([cell(TEXT, text)]),
        number => Cells::from([cell(NUMBER, number.to_string())]),
    };
    cells.extend(bytes.map(|bytes| cell(BYTES, bytes)));
    cells
}

/// Bytes of a string; none for other values.
fn string_bytes(value: &Value) -> &[u8] {
    match value {
        Value::Short(text) => text.as_bytes(),
        Value::Long(text) => text.as_bytes(),
        _ => &[],
    }
}

/// Value of a number or a string, from its cells.
///
/// # Errors
/// If a cell is missing or wrong. The error names the cell.
pub fn plain(kind: VariableKind, cells: &Cells, encoding: Encoding) -> Result<Value, String> {
    let typed = |text: &[u8]| Value::from_text(kind, text).map_err(|error| error.to_string());
    let is_string = matches!(kind, VariableKind::S16 | VariableKind::S32);
    if let Some(column) = cells.keys().find(|column| ![NUMBER, TEXT, BYTES].contains(&column.as_str())) {
        return Err(format!("column `{column}` belongs to positions, and {} is not a position", kind.letters()));
    }
    match (cells.get(NUMBER), cells.get(TEXT), cells.get(BYTES)) {
        (None, text, Some(digits)) => exact(kind, text.map(String::as_str), digits, encoding),
        (Some(number), None, None) if !is_string => typed(number.as_bytes()),
        (None, Some(text), None) if is_string && text == EMPTY => typed(b""),
        (None, Some(text), None) if is_string => typed(&encoding.encode(text).map_err(|error| error.to_string())?),
        _ => {
            Err(format!("write the value of {} in column `{}`", kind.letters(), if is_string { TEXT } else { NUMBER }))
        }
    }
}

/// Value from its bytes. The displayed text must match these bytes.
fn exact(kind: VariableKind, shown: Option<&str>, digits: &str, encoding: Encoding) -> Result<Value, String> {
    let bytes = unhex(digits).ok_or_else(|| format!("{BYTES}: '{digits}' is not pairs of hexadecimal digits"))?;
    let wrong = |error| format!("{BYTES}: {error}");
    let value = match kind {
        VariableKind::S16 => Value::Short(Text::new(&bytes).map_err(wrong)?),
        VariableKind::S32 => Value::Long(Text::new(&bytes).map_err(wrong)?),
        VariableKind::R => {
            let bytes = bytes.try_into().map_err(|_| format!("{BYTES}: a real has 4 bytes"))?;
            Value::Real(f32::from_le_bytes(bytes))
        }
        _ => return Err(format!("{BYTES}: only strings and reals have bytes")),
    };
    match of(&value, encoding).get(TEXT).map(String::as_str) {
        expected if shown.is_none() || shown == expected => Ok(value),
        _ => Err(format!("{TEXT} does not match {BYTES}; remove {BYTES} to use the text")),
    }
}

/// Checks that a position can have these cells.
///
/// # Errors
/// If a position cannot have a cell. The error names the cell.
pub fn check_position(cells: &Cells) -> Result<(), String> {
    match cells.keys().find(|column| [NUMBER, TEXT, BYTES].contains(&column.as_str())) {
        Some(column) => Err(format!(
            "write the axes of a position in their own columns; column `{column}` is for numbers and strings"
        )),
        None => Ok(()),
    }
}

/// Complete position. Missing fields are taken from the current position.
///
/// # Errors
/// If a field is missing or wrong. The error names the field.
pub fn merge_over(cells: &Cells, kind: VariableKind, old: Option<&Value>) -> Result<Value, String> {
    let mut merged = old.and_then(PositionData::of).map(|data| data.fields()).unwrap_or_default();
    let is_other_type = cells.get(position::TYPE).is_some_and(|given| merged.get(position::TYPE) != Some(given));
    let is_alone = merged.is_empty() || is_other_type;
    if is_alone && !cells.contains_key(position::TYPE) {
        return Err("the position is undefined on the controller; fill in `type` and all axes".to_owned());
    }
    if is_alone {
        merged.clear();
    }
    merged.extend(cells.clone());
    let value = position::from_fields(kind, &merged)?;
    let all = PositionData::of(&value).filter(|_| is_alone).map(|data| data.fields()).unwrap_or_default();
    let is_missing = |name: &&String| position::is_axis(name) && !cells.contains_key(*name);
    let missing: Vec<&str> = all.keys().filter(is_missing).map(String::as_str).collect();
    if missing.is_empty() {
        return Ok(value);
    }
    Err(format!(
        "the position on the controller has another type, so all axes are necessary; {} is missing",
        missing.join(", ")
    ))
}

/// Two values that differ in all fields that are unknown, for a dry run.
pub fn zero_bytes(cells: &Cells, kind: VariableKind) -> Option<[Value; 2]> {
    if !kind.is_position() {
        let all = |byte| Value::parse(kind, &vec![byte; kind.size()]).ok();
        return Some([all(0)?, all(0x41)?]);
    }
    let is_pulses = cells.keys().any(|name| name.ends_with("_pulses")) || kind == VariableKind::Ex;
    let named_axes = cells.get(position::TYPE).and_then(|name| position::parse_named_values(name));
    let types = match (named_axes, kind) {
        (Some(named), _) => [named; 2],
        (None, _) if is_pulses => [PositionKind::Pulse; 2],
        (None, _) if cells.is_empty() => [PositionKind::Pulse, PositionKind::Base],
        (None, VariableKind::Bp) => [PositionKind::Base; 2],
        (None, _) => [PositionKind::Base, PositionKind::Robot],
    };
    let group = match kind {
        VariableKind::Bp => Group::Base(1),
        VariableKind::Ex => Group::Station(1),
        _ => Group::R1,
    };
    let whole = |at: usize| {
        let old = different_words()[at];
        let (tool, user) = (old.tool.min(LAST_TOOL), old.user.min(LAST_TOOL));
        let old = position::stored_position(group, Position { kind: types[at], tool, user, ..old });
        merge_over(cells, kind, Some(&old)).ok()
    };
    Some([whole(0)?, whole(1)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::yerc::variables::Reference;

    fn value(name: &str, text: &str) -> (VariableKind, Value) {
        let kind = name.parse::<Reference>().unwrap().kind;
        (kind, Value::from_text(kind, text.as_bytes()).unwrap())
    }

    /// Writes a value to cells and reads it back.
    #[track_caller]
    fn round_trips(kind: VariableKind, value: &Value) {
        let cells = of(value, Encoding::ShiftJis);
        let back =
            if kind.is_position() { merge_over(&cells, kind, None) } else { plain(kind, &cells, Encoding::ShiftJis) };
        assert_eq!(back.map(|value| value.emit()), Ok(value.emit()), "{cells:?}");
        let columns: Vec<String> = fields().into_iter().map(|field| field.name.into_owned()).collect();
        assert!(cells.keys().all(|column| columns.contains(column)), "{cells:?}");
        assert!(!cells.values().any(|text| text.contains(char::is_control)), "a file has one line a row: {cells:?}");
    }

    #[test]
    fn values_round_trip_through_cells() {
        for (name, text) in [
            ("B7", "255"),
            ("I0", "-32768"),
            ("D0", "-2147483648"),
            ("R3", "-1.5"),
            ("S2", "1.5;x"),
            ("S3", ""),
            ("S4", "\"\""),
            ("P2", "base:x=1000,y=0.5,z=1200,rx=180,ry=0,rz=-0.0001,re=1.5,tool=2,user=1,form=lower"),
            ("P3", "pulse:s=1,l=-2,u=3,r=4,b=5,t=6,e=7,8=-2147483648,ext=w-ge180"),
            ("P4", "type5:1=1,2=2,3=3,4=4,5=5,6=6"),
            ("BP1", "base:x=1.5,y=-2.5,z=0,4=1"),
            ("BP2", "pulse:1=-1"),
            ("EX1", "pulse:1=77,2=200"),
        ] {
            let (kind, value) = value(name, text);
            round_trips(kind, &value);
        }
        for bytes in [&b"\x83\x65"[..], b"\x83", b"\xff\x01x", b"a\"b,;\n"] {
            round_trips(VariableKind::S32, &Value::Long(Text::new(bytes).unwrap()));
        }
    }

    #[test]
    fn reals_round_trip_through_cells() {
        for bits in [0, 1, 0x8000_0000, 0x3F80_0001, 0x7F7F_FFFF, 0x0080_0000, 0x4B7F_FFFF, 0x7F80_0000, 0xFFC0_0001] {
            round_trips(VariableKind::R, &Value::Real(f32::from_bits(bits)));
        }
        let mut bits = 12345_u32;
        for _ in 0..5000 {
            bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            round_trips(VariableKind::R, &Value::Real(f32::from_bits(bits)));
        }
    }

    #[test]
    fn position_keeps_bytes_without_a_cell() {
        let old = value("P2", "base:x=1000,y=0.5,z=1200,rx=180,ry=0,rz=0,tool=2,form=lower").1;
        let over = |cells: &[(&str, &str)], old| {
            let cells = cells.iter().map(|(name, text)| ((*name).to_owned(), (*text).to_owned())).collect();
            merge_over(&cells, VariableKind::P, old)
        };
        let new = value("P2", "base:x=7.25,y=0.5,z=1200,rx=180,ry=0,rz=0,tool=2,form=lower").1;
        assert_eq!(over(&[("x_mm", "7.25")], Some(&old)), Ok(new));
        assert!(over(&[("type", "base"), ("x_mm", "1")], Some(&old)).is_ok());
        assert!(over(&[("type", "base"), ("x_mm", "1")], None).is_err());
        assert!(over(&[("x_mm", "1")], None).unwrap_err().contains("fill in `type` and all axes"));
        let pulses = value("P2", "pulse:s=1,l=2,u=3,r=4,b=5,t=6").1;
        assert!(over(&[("x_mm", "1")], Some(&pulses)).is_err());
        assert!(over(&[("type", "base"), ("x_mm", "1")], Some(&pulses)).unwrap_err().contains("missing"));
    }

    #[test]
    fn refuses_cells_of_another_kind() {
        let cells = |column: &str, text: &str| Cells::from([(column.to_owned(), text.to_owned())]);
        let plain = |kind, column, text| plain(kind, &cells(column, text), Encoding::ShiftJis).unwrap_err();
        assert!(plain(VariableKind::B, NUMBER, "256").contains("not a number from 0 to 255"));
        assert!(plain(VariableKind::B, TEXT, "5").contains("in column `value`"));
        assert!(plain(VariableKind::B, "x_mm", "5").contains("`x_mm` belongs to positions"));
        assert!(plain(VariableKind::S32, NUMBER, "5").contains("in column `text`"));
        assert!(check_position(&cells(NUMBER, "1")).unwrap_err().contains("`value` is for numbers"));
    }
}

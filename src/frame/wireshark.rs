//! Wireshark dissectors in Lua: the tables of a family as Lua data, and the code that reads them.

use serde::Serialize;
use serde_json::Value;

/// Functions that the dissectors of all families use. They come before the dissectors in the file.
pub const PRELUDE: &str = include_str!("wireshark.lua");

/// A field that Wireshark can filter and show.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FilterField {
    /// Filter name after the name of the protocol, for example `alarm_code`.
    pub key: String,
    /// Name in the packet details.
    pub name: String,
    /// Lua name of the field type, for example `UINT16`.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Lua name of the number base, for example `HEX`.
    pub base: &'static str,
    /// Names of values.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<(u32, String)>,
}

/// Filter fields of a protocol. Each key has one type, as Wireshark requires.
#[derive(Debug, Default, Serialize)]
#[serde(transparent)]
pub struct FilterFields(Vec<FilterField>);

impl FilterFields {
    /// Adds a field and returns its key. A field with the same name and type is added once; a field with the same name
    /// and another type gets the type as a suffix.
    pub fn add(&mut self, name: &str, kind: &'static str, base: &'static str) -> String {
        self.add_named(name, kind, base, Vec::new())
    }

    /// Adds a field whose values have names.
    pub fn add_named(
        &mut self,
        name: &str,
        kind: &'static str,
        base: &'static str,
        values: Vec<(u32, String)>,
    ) -> String {
        let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        let plain = words.collect::<Vec<_>>().join("_").to_ascii_lowercase();
        for key in [plain.clone(), format!("{plain}_{}", kind.to_ascii_lowercase())] {
            match self.0.iter().find(|field| field.key == key) {
                Some(field) if field.kind == kind => return key,
                Some(_) => {}
                None => {
                    self.0.push(FilterField { key: key.clone(), name: name.to_owned(), kind, base, values });
                    return key;
                }
            }
        }
        plain
    }
}

/// Lua source of a dissector: the tables, as the local variable `T`, and the code that reads them.
pub fn part(tables: &Value, code: &str) -> String {
    let mut lua = String::from("do\nlocal T = ");
    push_lua(tables, &mut lua);
    format!("{lua}\n{code}end\n")
}

/// A Lua table with these keys. A key that is a number in decimal is a number in Lua.
pub fn table<K: ToString, V: Into<Value>>(rows: impl IntoIterator<Item = (K, V)>) -> Value {
    Value::Object(rows.into_iter().map(|(key, value)| (key.to_string(), value.into())).collect())
}

/// Appends a value in the notation of Lua. A key with the value null is missing, as in a Lua table.
fn push_lua(value: &Value, lua: &mut String) {
    match value {
        Value::Null => lua.push_str("nil"),
        Value::Bool(_) | Value::Number(_) => lua.push_str(&value.to_string()),
        Value::String(text) => push_text(text, lua),
        Value::Array(items) => {
            lua.push('{');
            for item in items {
                push_lua(item, lua);
                lua.push(',');
            }
            lua.push('}');
        }
        Value::Object(entries) => {
            lua.push('{');
            for (key, value) in entries {
                lua.push('[');
                // Codes are numbers in the packets.
                match key.parse::<u32>() {
                    Ok(code) => lua.push_str(&code.to_string()),
                    Err(_) => push_text(key, lua),
                }
                lua.push_str("]=");
                push_lua(value, lua);
                lua.push_str(",\n");
            }
            lua.push('}');
        }
    }
}

fn push_text(text: &str, lua: &mut String) {
    lua.push('"');
    for byte in text.bytes() {
        match byte {
            b'"' | b'\\' => lua.extend(['\\', char::from(byte)]),
            b' '..=b'~' => lua.push(char::from(byte)),
            // Three digits, so that a digit after them is not a part of the escape.
            _ => lua.push_str(&format!("\\{byte:03}")),
        }
    }
    lua.push('"');
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_is_lua() {
        let mut lua = String::new();
        push_lua(&serde_json::json!({"16": ["a\"\\\n1", 2, true, null]}), &mut lua);
        assert_eq!(lua, "{[16]={\"a\\\"\\\\\\0101\",2,true,nil,},\n}");
    }

    #[test]
    fn fields_of_one_name_have_one_type() {
        let mut fields = FilterFields::default();
        let keys = [("UINT8"), ("INT16"), ("INT16"), ("UINT8")].map(|kind| fields.add("Value (B)", kind, "DEC"));
        assert_eq!(keys, ["value_b", "value_b_int16", "value_b_int16", "value_b"]);
        assert_eq!(fields.0.len(), 2);
    }
}

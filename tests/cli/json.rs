//! JSON of the transcripts: easy to read, without what differs from run to run, and as envelope and schema promise.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use serde_json::Value;

/// Widest line of indented JSON.
const WIDTH: usize = 100;

/// Text without times of ours; those of a controller are the same each time.
fn redacted(text: &str) -> String {
    let text = replaced(text, "\"time\":\"", |value| value.find('"').filter(|end| value[..*end].ends_with('Z')));
    let text = replaced(&text, "\"elapsed_ms\":", |value| value.find([',', '}']));
    let text = replaced(&text, "\"pid\":", |value| value.find([',', '}']));
    let text = replaced(&text, "\"since\":\"", |value| value.find('"').filter(|end| value[..*end].ends_with('Z')));
    let text = replaced(&text, "process ", |value| value.find(|c: char| !c.is_ascii_digit()).filter(|end| *end > 0));
    let text = replaced(&text, " since ", |value| {
        Some(DATE.len()).filter(|end| value.as_bytes().get(*end - 3) == Some(&b':'))
    });
    let text = replaced(&text, "\"taken_at\":\"", |value| value.find('"'));
    let text = replaced(&text, "\"taken_at\": \"", |value| value.find('"'));
    let end = |value: &str| value.starts_with(|next: char| next.is_ascii_digit()).then_some(value.len());
    replaced(&replaced(&text, "taken at   ", end), "elapsed (ms)  ", end)
}

/// A time as it stands in a sentence.
const DATE: &str = "2026-11-21 09:31:05";

/// Text with `[..]` for what follows a name; `end` finds where that ends.
fn replaced(text: &str, name: &str, end: impl Fn(&str) -> Option<usize>) -> String {
    let mut parts = text.split(name);
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |done, part| match end(part) {
        Some(end) => format!("{done}{name}{}{}", if name.ends_with(':') { "\"[..]\"" } else { "[..]" }, &part[end..]),
        None => format!("{done}{name}{part}"),
    })
}

/// A line as transcripts show it: JSON indented, and checked where it is an envelope.
pub fn shown(line: &str) -> String {
    let Some(value) = document(line) else { return redacted(line) };
    let one = std::slice::from_ref(&value);
    for envelope in value.as_array().map_or(one, Vec::as_slice).iter().filter(|value| value.get("ok").is_some()) {
        if let Err(why) = check(envelope) {
            panic!("{why} in\n{line}");
        }
    }
    pretty(&document(&redacted(line)).expect("what stands for a time is JSON, too"), 0)
}

fn document(line: &str) -> Option<Value> {
    serde_json::from_str(line).ok().filter(|value: &Value| value.is_object() || value.is_array())
}

/// Objects and lists on one line where they fit.
fn pretty(value: &Value, indent: usize) -> String {
    let flat = value.to_string();
    let inner = " ".repeat(indent + 2);
    let (open, close, items): (_, _, Vec<String>) = match value {
        _ if indent + flat.chars().count() <= WIDTH && indent > 0 => return flat,
        Value::Array(items) if !items.is_empty() => {
            ('[', ']', items.iter().map(|item| pretty(item, indent + 2)).collect())
        }
        Value::Object(fields) if !fields.is_empty() => {
            let fields = fields
                .iter()
                .map(|(name, item)| format!("{}: {}", Value::from(name.as_str()), pretty(item, indent + 2)));
            ('{', '}', fields.collect())
        }
        _ => return flat,
    };
    format!("{open}\n{inner}{}\n{}{close}", items.join(&format!(",\n{inner}")), " ".repeat(indent))
}

/// Keys of an envelope, in their order, and whether every envelope has them.
const KEYS: [(&str, bool); 9] = [
    ("time", false),
    ("robot", true),
    ("family", false),
    ("target", false),
    ("simulated", false),
    ("command", true),
    ("ok", true),
    ("data", false),
    ("error", false),
];

/// An envelope has the keys of the contract in their order, and data that follows the schema of its command.
fn check(envelope: &Value) -> Result<(), String> {
    let keys: Vec<&str> = envelope.as_object().into_iter().flatten().map(|(key, _)| key.as_str()).collect();
    let expected: Vec<&str> =
        KEYS.iter().filter(|(key, always)| *always || keys.contains(key)).map(|(key, _)| *key).collect();
    if keys != expected {
        return Err(format!("keys {keys:?}, not {expected:?}"));
    }
    let is_ok = envelope["ok"] == Value::Bool(true);
    if is_ok == keys.contains(&"error") || (is_ok && !keys.contains(&"data")) {
        return Err("ok, data and error contradict each other".into());
    }
    if envelope["robot"].is_string() && !(envelope["target"].is_string() && envelope["simulated"].is_boolean()) {
        return Err("a robot without target".into());
    }
    if let Some(error) = envelope.get("error") {
        let whole = error["exit"].is_u64() && error["kind"].is_string() && error["message"].is_string();
        whole.then_some(()).ok_or("an error without exit, kind or message")?;
    }
    let (Some(data), Some(command)) = (envelope.get("data"), envelope["command"].as_str()) else { return Ok(()) };
    let id = if data.get("frames").is_some() && command != "decode.yerc" { "dry-run" } else { command };
    let schema = schemas().get(id).ok_or_else(|| format!("`armctl schema` does not know {id}"))?;
    conforms(data, schema, schema, "data")
}

/// The schemas of all reports by command.
fn schemas() -> &'static BTreeMap<&'static str, Value> {
    static SCHEMAS: OnceLock<BTreeMap<&'static str, Value>> = OnceLock::new();
    SCHEMAS.get_or_init(|| {
        let all = armctl::command::common::schema::all();
        all.into_iter().map(|entry| (entry.id, (entry.schema)().to_value())).collect()
    })
}

/// Holds a value against the part of JSON Schema that our schemas use; objects have no field that the schema lacks.
fn conforms(value: &Value, schema: &Value, root: &Value, path: &str) -> Result<(), String> {
    if let Some(name) = schema.get("$ref").and_then(Value::as_str) {
        let found = root.pointer(name.trim_start_matches('#')).ok_or_else(|| format!("{path}: {name} is missing"))?;
        conforms(value, found, root, path)?;
    }
    if let Some(all) = schema.get("allOf").and_then(Value::as_array) {
        all.iter().try_for_each(|one| conforms(value, one, root, path))?;
    }
    for key in ["anyOf", "oneOf"] {
        let Some(ways) = schema.get(key).and_then(Value::as_array) else { continue };
        let reasons: Vec<String> = ways.iter().filter_map(|way| conforms(value, way, root, path).err()).collect();
        if reasons.len() == ways.len() {
            return Err(reasons.join("; "));
        }
    }
    if let Some(types) = schema.get("type") {
        let one = std::slice::from_ref(types);
        let types = types.as_array().map_or(one, Vec::as_slice);
        if !types.iter().any(|name| is_of(value, name.as_str().unwrap_or_default())) {
            return Err(format!("{path}: {value} is no {types:?}"));
        }
    }
    if schema.get("const").is_some_and(|only| only != value) {
        return Err(format!("{path}: {value} is not {}", schema["const"]));
    }
    if schema.get("enum").and_then(Value::as_array).is_some_and(|values| !values.contains(value)) {
        return Err(format!("{path}: {value} is none of {}", schema["enum"]));
    }
    if let (Some(items), Value::Array(values)) = (schema.get("items"), value) {
        for (index, value) in values.iter().enumerate() {
            conforms(value, items, root, &format!("{path}[{index}]"))?;
        }
    }
    let (Some(properties), Value::Object(fields)) = (schema.get("properties").and_then(Value::as_object), value) else {
        return Ok(());
    };
    let required = schema.get("required").and_then(Value::as_array).into_iter().flatten().filter_map(Value::as_str);
    for name in required {
        fields.contains_key(name).then_some(()).ok_or_else(|| format!("{path}: {name} is missing"))?;
    }
    // A flattened enum has its own fields beside these.
    let is_open = ["anyOf", "oneOf", "allOf", "$ref"].iter().any(|key| schema.get(key).is_some());
    for (name, value) in fields {
        match properties.get(name) {
            Some(schema) => conforms(value, schema, root, &format!("{path}.{name}"))?,
            None if is_open => {}
            None if schema.get("additionalProperties").is_some_and(Value::is_object) => {
                conforms(value, &schema["additionalProperties"], root, &format!("{path}.{name}"))?;
            }
            None => return Err(format!("{path}: the schema does not know {name}")),
        }
    }
    Ok(())
}

fn is_of(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        _ => false,
    }
}

#[test]
fn what_breaks_a_promise_is_found() {
    let envelope = |data: Value| serde_json::json!({"robot": null, "command": "sim.yerc", "ok": true, "data": data});
    let right = serde_json::json!({"family": "yerc", "model": "fs100", "target": "udp://127.0.0.1"});
    assert_eq!(check(&envelope(right.clone())), Ok(()));
    for (name, value) in [("model", Value::Null), ("more", Value::from(1))] {
        let mut wrong = right.clone();
        wrong[name] = value;
        assert!(check(&envelope(wrong)).is_err(), "{name}");
    }
    assert!(check(&serde_json::json!({"robot": null, "command": "sim.yerc", "ok": false})).is_err());
    assert!(check(&serde_json::json!({"command": "sim.yerc", "robot": null, "ok": true, "data": right})).is_err());
}

//! Validates JSON documents against the schemas of `armctl schema`. The validator is from other authors.

use std::collections::HashMap;
use std::sync::{Arc, Mutex};

use armctl_frame::failure::Kind;
use jsonschema::Validator;
use serde_json::Value;

/// Checks an envelope: its schema, the order of its keys, and the exit code of its kind. The data must match the schema
/// of the command or of a dry run.
pub fn check(envelope: &Value) -> Result<(), String> {
    matches_schema(envelope, "envelope")?;
    let schema = schema("envelope")?;
    let known = schema["properties"].as_object().into_iter().flatten().map(|(key, _)| key);
    let in_order: Vec<&String> = known.filter(|key| envelope.get(key.as_str()).is_some()).collect();
    let keys: Vec<&String> = envelope.as_object().into_iter().flatten().map(|(key, _)| key).collect();
    if keys != in_order {
        return Err(format!("keys {keys:?}, not {in_order:?}"));
    }
    if let Some(error) = envelope.get("error") {
        let kind: Kind = serde_json::from_value(error["kind"].clone()).map_err(|error| error.to_string())?;
        if error["exit"] != kind.exit() {
            return Err(format!("exit {} is not that of {kind:?}", error["exit"]));
        }
    }
    let (Some(data), Some(command)) = (envelope.get("data"), envelope["command"].as_str()) else { return Ok(()) };
    let is_rehearsal = data.get("frames").is_some() && !command.starts_with("decode.");
    matches_schema(data, if is_rehearsal { "dry-run" } else { command })
}

/// Checks a value against the schema with this id. Additional fields are not allowed.
fn matches_schema(value: &Value, id: &str) -> Result<(), String> {
    let wrong: Vec<String> =
        validator(id)?.iter_errors(value).map(|error| format!("{}: {error}", error.instance_path())).collect();
    if wrong.is_empty() { Ok(()) } else { Err(format!("not as the schema of {id} says: {}", wrong.join("; "))) }
}

/// Validator of a schema. It is created when it is needed and then cached, because a transcript needs few of the
/// schemas.
fn validator(id: &str) -> Result<Arc<Validator>, String> {
    static VALIDATORS: Mutex<Option<HashMap<String, Arc<Validator>>>> = Mutex::new(None);
    let mut validators = VALIDATORS.lock().expect("nobody panics with it");
    let made = validators.get_or_insert_default();
    if let Some(validator) = made.get(id) {
        return Ok(Arc::clone(validator));
    }
    let mut schema = schema(id)?;
    forbid_extra_keys(&mut schema);
    let validator = jsonschema::draft202012::new(&schema).map_err(|error| format!("the schema of {id}: {error}"))?;
    Ok(Arc::clone(made.entry(id.to_owned()).or_insert(Arc::new(validator))))
}

fn schema(id: &str) -> Result<Value, String> {
    let entry = armctl::command::about::schema::all().into_iter().find(|entry| entry.id == id);
    Ok((entry.ok_or_else(|| format!("`armctl schema` does not know {id}"))?.schema)().to_value())
}

/// Schemas allow additional fields, for future versions. The current data must not have any.
fn forbid_extra_keys(schema: &mut Value) {
    match schema {
        Value::Object(keys) => {
            let is_object = keys.get("properties").is_some_and(Value::is_object);
            if is_object && !keys.contains_key("additionalProperties") {
                keys.insert("unevaluatedProperties".into(), false.into());
            }
            for (key, inner) in keys {
                // An `if`, `then` or `else` part, or a variant of a flattened enum, has only some of the fields. The
                // other fields are in the outer schema.
                let is_part = matches!(key.as_str(), "if" | "then" | "else" | "not" | "allOf");
                let is_variant = is_object && matches!(key.as_str(), "anyOf" | "oneOf");
                if !(is_part || is_variant) {
                    forbid_extra_keys(inner);
                }
            }
        }
        Value::Array(items) => items.iter_mut().for_each(forbid_extra_keys),
        _ => {}
    }
}

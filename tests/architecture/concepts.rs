//! Checks that all families use the same name, type and unit for the same thing in their reports.

use std::collections::BTreeSet;

use serde_json::Value;

/// Keys with the same meaning in all reports, and the types that they may have. Null is always allowed.
#[rustfmt::skip]
const KEYS: &[(&str, &[&str])] = &[
    // Status.
    ("reachable", &["boolean"]), ("mode", &["string"]), ("controller_mode", &["string"]), ("servo_on", &["boolean"]),
    ("running", &["boolean"]), ("held", &["boolean"]), ("homed", &["boolean"]), ("emergency_stop", &["boolean"]),
    ("faulted", &["boolean"]), ("fault_code", &["string"]), ("fault_text", &["string"]),
    ("speed_override_percent", &["number", "integer"]),
    // Alarms.
    ("code", &["string"]), ("cause", &["string"]), ("remedy", &["string"]), ("severity", &["string"]),
    ("causes", &["array"]), ("remedies", &["array"]),
    // Positions.
    ("positions", &["array"]), ("frame", &["string"]), ("joints", &["array"]), ("axis", &["string"]),
    ("x_mm", &["number"]), ("y_mm", &["number"]), ("z_mm", &["number"]),
    ("rx_deg", &["number"]), ("ry_deg", &["number"]), ("rz_deg", &["number"]), ("re_deg", &["number"]),
    ("form", &["string"]), ("extended_form", &["string"]), ("user_frame", &["integer"]), ("tool", &["integer"]),
    // Items.
    ("items", &["array"]), ("name", &["string"]), ("label", &["string"]), ("kind", &["string"]), ("ok", &["boolean"]),
    ("error", &["object"]), ("address", &["string"]), ("meaning", &["string"]), ("in_manual", &["boolean"]),
    // Motion.
    ("accepted", &["boolean"]), ("targets", &["array"]), ("speed", &["object"]), ("reached", &["boolean"]),
    ("elapsed_ms", &["integer"]),
    // Programs.
    ("program", &["string"]), ("line", &["integer"]), ("step", &["integer"]), ("state", &["string"]),
    ("cycles", &["array"]),
    // Files.
    ("files", &["array"]), ("bytes", &["integer"]), ("sha256", &["string"]), ("path", &["string"]),
];

/// Synonyms that no report may use.
#[rustfmt::skip]
const OTHER_WORDS: &[(&str, &str)] = &[
    ("executing", "running"), ("is_running", "running"), ("paused", "held"), ("origin_complete", "homed"),
    ("servo", "servo_on"), ("estop", "emergency_stop"), ("alarm_code", "code"), ("error_code", "code"),
    ("override_percent", "speed_override_percent"), ("override", "speed_override_percent"),
    ("job", "program"), ("job_name", "program"), ("program_name", "program"), ("line_number", "line"),
    ("duration_ms", "elapsed_ms"), ("time_ms", "elapsed_ms"), ("took_ms", "elapsed_ms"),
    ("filename", "name"), ("file_name", "name"), ("alias", "label"), ("nickname", "label"),
    ("is_ok", "ok"), ("success", "ok"), ("failure", "error"), ("entries", "items"), ("values", "items"),
    ("x", "x_mm"), ("y", "y_mm"), ("z", "z_mm"), ("rx", "rx_deg"), ("ry", "ry_deg"), ("rz", "rz_deg"),
];

/// Exceptions: report, key, and the meaning of the key in this report.
#[rustfmt::skip]
const EXCEPTIONS: &[(&str, &str, &str)] = &[
    ("dry-run", "values", "how many values a part of a backup has"),
    ("robots.*", "line", "the production line of a robot"),
];

/// Reports about frames, local programs and boards. They use the terms of their protocols.
const SEPARATE_CONCEPTS: [&str; 5] = ["decode.", "sim", "toyo.sim.", "failure", "envelope"];

#[test]
fn concepts_have_one_name_type_and_unit() {
    let mut wrong = BTreeSet::new();
    for entry in armctl::command::about::schema::all() {
        if SEPARATE_CONCEPTS.iter().any(|part| entry.id == *part || part.ends_with('.') && entry.id.starts_with(part)) {
            continue;
        }
        let schema = (entry.schema)().to_value();
        collect_types(&schema, &schema, &mut |key, types| {
            if EXCEPTIONS.iter().any(|(id, known, _)| key == *known && is_of(entry.id, id)) {
                return;
            }
            if let Some((_, concept)) = OTHER_WORDS.iter().find(|(word, _)| *word == key) {
                wrong.insert(format!("{}: {key} is {concept} everywhere else", entry.id));
            }
            if let Some((_, known)) = KEYS.iter().find(|(known, _)| *known == key)
                && let Some(other) = types.iter().find(|other| !known.contains(&other.as_str()))
            {
                wrong.insert(format!("{}: {key} is {other}, and {} everywhere else", entry.id, known.join(" or ")));
            }
        });
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_exception_is_needed() {
    for (id, key, _) in EXCEPTIONS {
        let has = armctl::command::about::schema::all().into_iter().filter(|entry| is_of(entry.id, id)).any(|entry| {
            let (schema, mut found) = ((entry.schema)().to_value(), false);
            collect_types(&schema, &schema, &mut |other, _| found |= other == *key);
            found
        });
        assert!(has, "no report {id} has {key}");
    }
}

/// Whether a report has this name, or begins with the text before `*`, as in `yrcx.profibus.*`.
fn is_of(report: &str, pattern: &str) -> bool {
    pattern.strip_suffix('*').map_or(report == pattern, |front| report.starts_with(front))
}

/// Reports every key below a schema, with its types except null.
fn collect_types(schema: &Value, root: &Value, say: &mut impl FnMut(&str, &BTreeSet<String>)) {
    match schema {
        Value::Object(fields) => {
            if let Some(properties) = fields.get("properties").and_then(Value::as_object) {
                for (key, property) in properties {
                    let mut types = BTreeSet::new();
                    collect(property, root, &mut types, 0);
                    say(key, &types);
                }
            }
            fields.values().for_each(|value| collect_types(value, root, say));
        }
        Value::Array(items) => items.iter().for_each(|value| collect_types(value, root, say)),
        _ => {}
    }
}

/// Collects the types of a property.
fn collect(schema: &Value, root: &Value, types: &mut BTreeSet<String>, depth: usize) {
    assert!(depth < 10, "a schema that refers to itself");
    if let Some(path) = schema["$ref"].as_str() {
        let target = root.pointer(path.trim_start_matches('#')).expect("a reference leads somewhere");
        collect(target, root, types, depth + 1);
    }
    for key in ["anyOf", "oneOf"] {
        for part in schema[key].as_array().into_iter().flatten() {
            collect(part, root, types, depth + 1);
        }
    }
    let named = schema["type"]
        .as_str()
        .into_iter()
        .chain(schema["type"].as_array().into_iter().flatten().filter_map(Value::as_str));
    types.extend(named.filter(|name| *name != "null").map(ToOwned::to_owned));
    if schema["const"].is_string() {
        types.insert("string".to_owned());
    }
}

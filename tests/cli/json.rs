//! JSON in the transcripts: it is indented, has no values that change between runs, and is checked against the envelope
//! and its schema.

use serde_json::Value;

use crate::support::schemas::check;

/// Maximum width of indented JSON.
const WIDTH: usize = 100;

/// Text without values that change between runs. Times of a simulated controller are always the same, so they remain.
fn redact(text: &str) -> String {
    let text = replace_dates(text, "\"time\":\"", |value| value.find('"').filter(|end| value[..*end].ends_with('Z')));
    let text = replace_dates(&text, "\"elapsed_ms\":", |value| value.find([',', '}']));
    let text = replace_dates(&text, "\"round_trip_ms\":", |value| value.find([',', '}']));
    let text = replace_dates(&text, "\"pid\":", |value| value.find([',', '}']));
    let text = replace_dates(&text, "\"since\":\"", |value| value.find('"').filter(|end| value[..*end].ends_with('Z')));
    let text =
        replace_dates(&text, "process ", |value| value.find(|c: char| !c.is_ascii_digit()).filter(|end| *end > 0));
    let text = replace_dates(&text, " since ", |value| {
        Some(DATE.len()).filter(|end| value.as_bytes().get(*end - 3) == Some(&b':'))
    });
    let text = replace_dates(&text, "\"taken_at\":\"", |value| value.find('"'));
    let text = replace_dates(&text, "\"taken_at\": \"", |value| value.find('"'));
    let end = |value: &str| value.starts_with(|next: char| next.is_ascii_digit()).then_some(value.len());
    replace_dates(&replace_dates(&text, "taken at   ", end), "elapsed (ms)  ", end)
}

/// A time within a sentence, as an example of the format.
const DATE: &str = "2026-11-21 09:31:05";

/// Replaces the value after each `name` by `[..]`. `end` finds the end of the value.
fn replace_dates(text: &str, name: &str, end: impl Fn(&str) -> Option<usize>) -> String {
    let mut parts = text.split(name);
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |done, part| match end(part) {
        Some(end) => format!("{done}{name}{}{}", if name.ends_with(':') { "\"[..]\"" } else { "[..]" }, &part[end..]),
        None => format!("{done}{name}{part}"),
    })
}

/// A line as a transcript shows it. JSON is indented, and an envelope is also checked.
pub fn format_value(line: &str) -> String {
    let Some(value) = document(line) else { return redact(line) };
    let one = std::slice::from_ref(&value);
    for envelope in value.as_array().map_or(one, Vec::as_slice).iter().filter(|value| value.get("ok").is_some()) {
        if let Err(why) = check(envelope) {
            panic!("{why} in\n{line}");
        }
    }
    pretty(&document(&redact(line)).expect("what stands for a time is JSON, too"), 0)
}

fn document(line: &str) -> Option<Value> {
    serde_json::from_str(line).ok().filter(|value: &Value| value.is_object() || value.is_array())
}

/// Formats JSON. An object or list is on one line if it fits.
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

/// Function that corrupts a document, so that the check must fail.
type Corruption<'a> = &'a dyn Fn(&mut Value);

#[test]
fn finds_violations_of_the_json_contract() {
    let valid = serde_json::json!({
        "time": "2026-11-21T09:00:00Z", "robot": "cell3", "family": "yerc", "target": "sim:", "simulated": true,
        "command": "sim.yerc", "ok": true, "data": {"family": "yerc", "model": "fs100", "target": "udp://127.0.0.1"},
    });
    assert_eq!(check(&valid), Ok(()));
    let corrupted = |spoil: Corruption<'_>| {
        let mut envelope = valid.clone();
        spoil(&mut envelope);
        envelope
    };
    let failed = corrupted(&|envelope| {
        take(envelope, "data");
        envelope["ok"] = false.into();
        envelope["error"] = serde_json::json!({"exit": 3, "kind": "refused", "message": "no"});
    });
    assert_eq!(check(&failed), Ok(()));
    let dry_run = corrupted(&|envelope| {
        envelope["data"] = serde_json::json!({"frames": [{"hex": "5945"}], "complete": true, "then": null});
    });
    assert_eq!(check(&dry_run), Ok(()));

    let wrong: [(&str, Corruption<'_>); 11] = [
        ("a key too many", &|envelope| envelope["more"] = 1.into()),
        ("no command", &|envelope| take(envelope, "command")),
        ("no data", &|envelope| take(envelope, "data")),
        ("another order", &|envelope| {
            let robot = envelope.as_object_mut().expect("an object").remove("robot").expect("a robot");
            envelope["robot"] = robot;
        }),
        ("a robot nowhere", &|envelope| take(envelope, "target")),
        ("done, and an error", &|envelope| envelope["error"] = failed["error"].clone()),
        ("failed without a reason", &|envelope| envelope["ok"] = false.into()),
        ("data of the wrong kind", &|envelope| envelope["data"]["model"] = Value::Null),
        ("data too much", &|envelope| envelope["data"]["more"] = 1.into()),
        ("data too little", &|envelope| take(&mut envelope["data"], "target")),
        ("a frame of no family", &|envelope| envelope["data"] = serde_json::json!({"frames": [{"hax": "5945"}]})),
    ];
    for (what, spoil) in wrong {
        assert!(check(&corrupted(spoil)).is_err(), "{what} is not found");
    }
    for (key, value) in [("exit", Value::from(4)), ("kind", "no_such_kind".into()), ("message", Value::Null)] {
        let mut envelope = failed.clone();
        envelope["error"][key] = value;
        assert!(check(&envelope).is_err(), "a wrong {key} of an error is not found");
    }
}

fn take(value: &mut Value, key: &str) {
    // This keeps the order of the other keys.
    value.as_object_mut().expect("an object").shift_remove(key).expect("it is there");
}

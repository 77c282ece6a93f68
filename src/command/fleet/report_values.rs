//! Values of a report, for channels that have one name for each value: Sparkplug metrics, and Prometheus samples.

use serde_json::{Map, Value as Json};

/// Maximum number of values of a report.
const MAX_VALUES: usize = 2000;
/// Maximum number of nesting levels of a report.
const MAX_DEPTH: usize = 8;

/// Keys of an item that are the same at each poll.
const CONSTANTS: [&str; 7] = ["label", "kind", "unit", "number", "address", "meaning", "in_manual"];

/// A value of a report.
#[derive(Debug)]
pub struct ReportValue<'a> {
    /// Path of the value, such as `parts/items/B0`.
    pub path: String,
    /// A number, a text, a flag, or null.
    pub value: &'a Json,
    /// Constants of an item, without null: label, kind, unit.
    pub constants: Vec<(&'static str, &'a Json)>,
}

/// All values of a report, with names that begin with `start`. A list item has its name as a level of the path, or its
/// index. An item with a value is one value. The value of an item that could not be read is null.
pub fn values_of_report<'a>(start: &str, data: &'a Json) -> Vec<ReportValue<'a>> {
    let mut values = Vec::new();
    collect(start, data, 0, &mut values);
    values
}

fn collect<'a>(path: &str, data: &'a Json, depth: usize, values: &mut Vec<ReportValue<'a>>) {
    if values.len() >= MAX_VALUES || depth > MAX_DEPTH {
        return;
    }
    match data {
        Json::Object(fields) => {
            for (name, data) in fields {
                collect(&format!("{path}/{name}"), data, depth + 1, values);
            }
        }
        Json::Array(list) => {
            for (at, data) in list.iter().enumerate() {
                let name = data.get("name").and_then(Json::as_str).filter(|name| !name.is_empty());
                let path = format!("{path}/{}", name.map_or_else(|| at.to_string(), ToOwned::to_owned));
                match data {
                    Json::Object(item) if name.is_some() && item.contains_key("ok") => {
                        collect_item(&path, item, depth + 1, values);
                    }
                    _ => collect(&path, data, depth + 1, values),
                }
            }
        }
        _ => values.push(ReportValue { path: path.to_owned(), value: data, constants: Vec::new() }),
    }
}

/// The value of an item, and its further keys that can change.
fn collect_item<'a>(path: &str, item: &'a Map<String, Json>, depth: usize, values: &mut Vec<ReportValue<'a>>) {
    let start = values.len();
    // An item whose values have other keys has no value of its own.
    match item.get("value") {
        Some(value) => collect(path, value, depth, values),
        None if item.get("ok") == Some(&Json::Bool(true)) => {}
        None => collect(path, &Json::Null, depth, values),
    }
    let constants = CONSTANTS.into_iter().filter_map(|key| Some((key, item.get(key)?)));
    let constants: Vec<(&'static str, &Json)> = constants.filter(|(_, constant)| !constant.is_null()).collect();
    for value in values.iter_mut().skip(start) {
        value.constants.clone_from(&constants);
    }
    for (key, data) in item {
        let is_other = !CONSTANTS.contains(&&**key) && !["name", "ok", "value", "error"].contains(&&**key);
        if is_other {
            collect(&format!("{path}/{key}"), data, depth + 1, values);
        }
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn texts(data: &Json) -> Vec<String> {
        let values = values_of_report("a", data);
        values.iter().map(|value| format!("{} {} {:?}", value.path, value.value, value.constants)).collect()
    }

    #[test]
    fn item_is_one_value_with_its_constants() {
        let data = json!({
            "items": [
                {"name": "CN01", "label": "boxes", "kind": "counter", "raw": 7, "ok": true, "value": 7},
                {"name": "P0", "label": null, "ok": true, "value": {"x_mm": 1.5, "y_mm": null}},
                {"name": "CN02", "ok": false, "error": {"message": "refused"}},
                {"name": "servo", "ok": true, "elapsed_s": 9},
            ],
            "hours": [{"value": 3}],
        });
        assert_eq!(
            texts(&data),
            [
                r#"a/items/CN01 7 [("label", String("boxes")), ("kind", String("counter"))]"#,
                "a/items/CN01/raw 7 []",
                "a/items/P0/x_mm 1.5 []",
                "a/items/P0/y_mm null []",
                "a/items/CN02 null []",
                "a/items/servo/elapsed_s 9 []",
                "a/hours/0/value 3 []",
            ]
        );
    }

    #[test]
    fn limits_number_and_depth() {
        assert_eq!(values_of_report("a", &Json::Array(vec![json!(1); 10_000])).len(), MAX_VALUES);
        let deep = (0..100).fold(json!(1), |inner, _| json!({ "a": inner }));
        assert!(values_of_report("a", &deep).is_empty());
    }
}

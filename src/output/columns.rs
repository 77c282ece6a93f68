//! The columns of a list of things, from the schema of the report that it stands in: for a list without things.

use serde_json::Value;

/// How deep fields are followed: what nests deeper is one column.
const DEEPEST: usize = 4;

/// The names of the fields of what `list` holds, nested ones dotted, in the order of the schema.
pub fn of(schema: &Value, list: &str) -> Vec<String> {
    let mut columns = Vec::new();
    each(schema, &schema["properties"][list]["items"], DEEPEST, &mut |name| columns.push(name));
    columns
}

/// Calls `found` with the dotted name of every field that has none below it; whether there are fields.
fn each(root: &Value, schema: &Value, deep: usize, found: &mut dyn FnMut(String)) -> bool {
    let schema = resolved(root, schema);
    let Some(deep) = deep.checked_sub(1) else { return false };
    let mut has_fields = false;
    for (name, field) in schema["properties"].as_object().into_iter().flatten() {
        has_fields = true;
        let is_parent = each(root, field, deep, &mut |below| found(format!("{name}.{below}")));
        if !is_parent {
            found(name.clone());
        }
    }
    for kind in ["oneOf", "anyOf", "allOf"] {
        for one in schema[kind].as_array().into_iter().flatten() {
            has_fields |= each(root, one, deep, found);
        }
    }
    has_fields
}

/// What a reference leads to.
fn resolved<'a>(root: &'a Value, schema: &'a Value) -> &'a Value {
    let reference = schema["$ref"].as_str().and_then(|reference| reference.strip_prefix('#'));
    reference.and_then(|pointer| root.pointer(pointer)).unwrap_or(schema)
}

#[cfg(test)]
mod tests {
    use schemars::{JsonSchema, schema_for};

    use super::*;

    #[derive(JsonSchema)]
    #[expect(dead_code, reason = "only its schema matters")]
    struct Report {
        alarms: Vec<Alarm>,
        with_texts: bool,
    }

    #[derive(JsonSchema)]
    #[expect(dead_code, reason = "only its schema matters")]
    struct Alarm {
        code: u32,
        sub_code: Option<SubCode>,
    }

    #[derive(JsonSchema)]
    #[expect(dead_code, reason = "only its schema matters")]
    struct SubCode {
        raw: u32,
    }

    #[test]
    fn fields_of_what_is_listed_are_columns() {
        let schema = schema_for!(Report).to_value();
        assert_eq!(of(&schema, "alarms"), ["code", "sub_code.raw"]);
        assert_eq!(of(&schema, "with_texts"), [""; 0]);
    }
}

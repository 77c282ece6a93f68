//! CSV is made of the fields of the JSON: the same names, for every command that reads.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use armctl::command::leaves::leaves;
use armctl::controller::Risk;
use armctl::output::columns;
use serde_json::{Value, json};

/// What writes files, waits, or wants another target than a simulator.
const LEFT_OUT: [&str; 12] = [
    "watch",
    "--for",
    "--continuous",
    "auto-mode",
    "backup",
    "diff",
    "dump",
    "file",
    "--csv",
    "--toml",
    " -t ",
    "program get",
];

/// stdout of a line on the simulator, if it was done.
fn printed(line: &str, format: &str, folder: &Path) -> Option<String> {
    let words = line.split(' ').map(|word| word.trim_matches('\''));
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command
        .args(words)
        .args(["--sim", "-o", format])
        .current_dir(folder)
        .env("HOME", folder)
        .env_remove("ARMCTL_CONFIG");
    let output = command.output().expect("armctl starts");
    output.status.success().then(|| String::from_utf8(output.stdout).expect("CSV and JSON are UTF-8"))
}

/// Every name that a field can have as a column.
fn names(value: &Value, path: &str, found: &mut BTreeSet<String>) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Object(fields) if !fields.is_empty() => {
            for (name, value) in fields {
                names(value, &below(name), found);
            }
        }
        Value::Array(items) if !items.is_empty() => {
            for (index, item) in items.iter().enumerate() {
                names(item, &below(&index.to_string()), found);
                if item.is_object() && !path.contains('.') {
                    names(item, "", found);
                    names(item, path, found);
                }
            }
        }
        _ => {
            found.insert(path.to_owned());
        }
    }
}

#[test]
fn columns_are_the_fields_of_the_json() {
    let folder = tempfile::tempdir().expect("there is room for a folder");
    let mut compared = 0;
    for (line, _) in
        leaves().filter(|(line, risk)| *risk == Risk::Read && !LEFT_OUT.iter().any(|out| line.contains(out)))
    {
        if line.contains(" -r ") || line.contains("--jq") || line.contains("--json") {
            continue;
        }
        let Some(json) = printed(line, "json", folder.path()) else { continue };
        let csv = printed(line, "csv", folder.path()).expect("it is done as CSV, too");
        let envelope: Value = serde_json::from_str(&json).expect("an envelope");
        let mut known = BTreeSet::new();
        let envelope = if envelope.is_array() { envelope[0].clone() } else { envelope };
        names(&envelope["data"], "", &mut known);
        known.insert("robot".to_owned());
        // A list of nothing has the columns that its schema tells.
        let schema =
            format!("{}/docs/schemas/{}.json", env!("CARGO_MANIFEST_DIR"), envelope["command"].as_str().unwrap());
        let schema: Value = serde_json::from_str(&std::fs::read_to_string(schema).expect("a schema")).expect("JSON");
        for (name, _) in envelope["data"].as_object().into_iter().flatten().filter(|(_, value)| **value == json!([])) {
            known
                .extend(columns::of(&schema, name).into_iter().flat_map(|column| [format!("{name}.{column}"), column]));
        }
        let head = csv.lines().next().unwrap_or_default();
        let strange: Vec<&str> = head.split(',').filter(|name| !name.is_empty() && !known.contains(*name)).collect();
        assert_eq!(strange, Vec::<&str>::new(), "{line}: {head}\n{json}");
        compared += 1;
    }
    assert!(compared > 60, "{compared} commands were compared");
}

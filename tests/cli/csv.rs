//! The columns of CSV output come from the schema of the report. This is tested for every command that reads.

use std::path::Path;
use std::process::Command;

use armctl::command::example_lines::robot_lines;
use armctl_controller::Risk;
use armctl_frame::output::csv::{RowsOf, Sheet};
use serde_json::Value;

/// Words of commands that write files, wait, or need another target than a simulator.
const EXCLUDED: [&str; 12] = [
    "--svg",
    "--html",
    "watch",
    "--for",
    "--continuous",
    "auto-mode",
    "backup",
    "diff",
    "dump",
    "file",
    " -t ",
    "program get",
];

/// stdout of a command line on the simulator; `None` if the command failed.
fn print_report(line: &str, format: &str, folder: &Path) -> Option<String> {
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

#[test]
fn columns_come_from_the_schema_of_the_json() {
    let folder = tempfile::tempdir().expect("there is room for a folder");
    let mut compared = 0;
    for (line, _) in
        robot_lines().filter(|(line, risk)| *risk == Risk::Read && !EXCLUDED.iter().any(|out| line.contains(out)))
    {
        if line.contains(" -r ") || line.contains("--jq") || line.contains("--json") {
            continue;
        }
        let Some(json) = print_report(&line, "json", folder.path()) else { continue };
        let csv = print_report(&line, "csv", folder.path()).expect("it is done as CSV, too");
        let envelope: Value = serde_json::from_str(&json).expect("an envelope");
        let command = if envelope.is_array() { &envelope[0]["command"] } else { &envelope["command"] };
        let schema_of_report = armctl::command::about::schema::all().into_iter().find(|entry| *command == entry.id);
        let schema = (schema_of_report.expect("a schema").schema)().to_value();
        let head = csv.lines().next().unwrap_or_default();
        let head = head.strip_prefix("robot,").filter(|_| envelope.is_array()).unwrap_or(head);
        let variants = schema["anyOf"].as_array().into_iter().flatten();
        let variants = variants.map(|one| {
            one["$ref"]
                .as_str()
                .map_or(one, |place| schema.pointer(place.trim_start_matches('#')).expect("a definition"))
        });
        let lists = std::iter::once(&schema).chain(variants).filter_map(|one| one["properties"].as_object()).flatten();
        let lists = lists.map(|(name, _)| RowsOf::List(name.clone().leak()));
        let possible: Vec<String> = [RowsOf::Lists, RowsOf::Report]
            .into_iter()
            .chain(lists)
            .map(|rows| Sheet::from_schema(&schema, rows))
            .map(|sheet| if envelope.is_array() { sheet.with_outcome() } else { sheet }.header(&[]))
            .collect();
        assert!(possible.iter().any(|header| header.trim_end() == head), "{line}: {head}\n{possible:#?}");
        compared += 1;
    }
    assert!(compared > 60, "{compared} commands were compared");
}

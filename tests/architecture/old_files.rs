//! Files that a release wrote or read are still read: `robots.toml`, `alarms.toml` and backups in
//! `tests/data/contract/`. They only change with a new major version (CONTRIBUTING, "Versions").

use std::path::PathBuf;
use std::process::Command;

use serde_json::{Value, json};

use super::source::root;

#[test]
fn reads_every_key_of_robots_toml() {
    let inventory = contract("robots.toml");
    let listed = data(&["--config", &inventory, "robots", "list"], &[0]);
    let robots = listed["robots"].as_array().expect("a list of robots");
    assert_eq!(robots.len(), 7, "{listed}");
    let settings = [
        ("cell3", "model", "fs100", "robot"),
        ("cell3", "read_only", "true", "robot"),
        ("cell3", "encoding", "utf-8", "robot"),
        ("cell3", "timeout", "500ms", "robot"),
        ("cell3", "retries", "0", "robot"),
        ("tray", "hold", "true", "robot"),
        ("tray", "timeout", "3s", "defaults"),
        ("tray", "retries", "3", "defaults"),
    ];
    for (robot, name, value, origin) in settings {
        let shown = data(&["--config", &inventory, "robots", "show", robot], &[0]);
        let wanted = json!({"name": name, "value": value, "origin": origin});
        assert!(shown["settings"].as_array().is_some_and(|rows| rows.contains(&wanted)), "{wanted}: {shown}");
    }
}

#[test]
fn reads_alarms_toml() {
    let words = ["--config", &contract("robots.toml"), "-r", "cell3", "explain", "yerc", "4315"];
    assert!(data(&words, &[0]).to_string().contains("open clamp 2, reset, start again"));
}

#[test]
fn reads_backups_of_each_family() {
    for family in ["yerc", "yrcx", "toyo"] {
        let folder = contract(&format!("backup-{family}"));
        assert_eq!(data(&["backup", "--verify", &folder], &[0])["sound"], json!(true), "{family}");
        // What the simulator has can change; that a comparison is possible cannot.
        data(&["--sim", family, "diff", &folder], &[0, 8]);
        data(&["--sim", family, "restore", &folder, "--yes"], &[0]);
    }
}

fn contract(name: &str) -> String {
    let path: PathBuf = root().join("tests/data/contract").join(name);
    assert!(path.exists(), "{}", path.display());
    path.display().to_string()
}

/// Data of a command that ends with one of these exit codes.
fn data(words: &[&str], codes: &[i32]) -> Value {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    for (name, _) in std::env::vars_os().filter(|(name, _)| name.to_string_lossy().starts_with("ARMCTL_")) {
        command.env_remove(name);
    }
    let output = command.arg("--json").args(words).output().expect("armctl starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code().is_some_and(|code| codes.contains(&code)), "{words:?}: {errors}");
    let envelope: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|why| panic!("{words:?}: {why}"));
    envelope["data"].clone()
}

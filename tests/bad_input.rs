//! Mistakes of the operator and of everything around him, through the built binary: the right exit code, a message that
//! says what to do, and nothing lost.

use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Runs `armctl` in an empty home folder, with stdin closed and no environment of its own.
fn armctl(home: &Path, words: &str) -> Output {
    command(home, words).output().expect("the binary runs")
}

fn command(home: &Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.args(words.split_ascii_whitespace()).current_dir(home).env_clear().env("HOME", home).stdin(Stdio::null());
    command
}

#[track_caller]
fn fails(output: &Output, exit: i32, parts: &[&str]) {
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(exit), "{told}");
    for part in parts {
        assert!(told.contains(part), "'{part}' is not in:\n{told}");
    }
}

#[track_caller]
fn succeeds(output: &Output) {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn a_broken_inventory_does_not_keep_anybody_from_reading_the_help_on_it() {
    let home = tempfile::tempdir().unwrap();
    std::fs::write(home.path().join("robots.toml"), "garbage here").unwrap();
    let output = armctl(home.path(), "--config robots.toml yerc status");
    fails(&output, 2, &["robots.toml:1:", "`armctl help inventory`"]);
    for words in
        ["help inventory", "explain yerc 2060", "decode yerc 59455243", "completions bash", "schema yerc.status"]
    {
        let output = command(home.path(), words).env("ARMCTL_CONFIG", "robots.toml").output().unwrap();
        assert!(output.status.code() != Some(2), "{words}: {}", String::from_utf8_lossy(&output.stderr));
    }
    let output = command(home.path(), "help targets").env("ARMCTL_TARGET", "nonsense").output().unwrap();
    succeeds(&output);
}

#[test]
fn no_time_at_all_is_no_timeout() {
    let home = tempfile::tempdir().unwrap();
    fails(&armctl(home.path(), "--sim yerc var set B0=1 --timeout 0"), 2, &["no time at all"]);
    fails(&armctl(home.path(), "--sim yerc status --watch 0 --count 2"), 2, &["no time at all"]);
    fails(&armctl(home.path(), "--sim yerc file cmos x --wait 0"), 2, &["no time at all"]);
    let output = command(home.path(), "--sim yerc status").env("ARMCTL_TIMEOUT", "0s").output().unwrap();
    fails(&output, 2, &["ARMCTL_TIMEOUT", "no time at all"]);
}

#[test]
fn a_line_that_does_not_parse_fails_in_the_format_it_asks_for() {
    let home = tempfile::tempdir().unwrap();
    for format in ["--json", "-ojsonl", "--format=json", "-qo json"] {
        let output = armctl(home.path(), &format!("--sim yerc var set B0=256 {format}"));
        fails(&output, 2, &[]);
        let error: serde_json::Value = serde_json::from_slice(&output.stderr).expect(format);
        assert_eq!(error["error"]["exit"], 2, "{format}");
        assert!(output.stdout.is_empty(), "{format}");
    }
}

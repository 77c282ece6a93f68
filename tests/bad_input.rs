//! Mistakes of the operator and problems of the environment, tested with the built binary: exit code, message with a
//! hint, no lost data.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::{BufRead as _, BufReader};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use serde_json::Value;

/// Runs `armctl` in an empty home folder, with closed stdin and an empty environment.
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
    let message = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(exit), "{message}");
    for part in parts {
        assert!(message.contains(part), "'{part}' is not in:\n{message}");
    }
}

#[track_caller]
fn succeeds(output: &Output) {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn help_works_with_a_broken_inventory() {
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
fn rejects_a_timeout_of_zero() {
    let home = tempfile::tempdir().unwrap();
    fails(&armctl(home.path(), "--sim yerc var set B0=1 --timeout 0"), 2, &["is zero"]);
    fails(&armctl(home.path(), "--sim yerc status --watch 0 --count 2"), 2, &["is zero"]);
    fails(&armctl(home.path(), "--sim yerc file cmos x --wait 0"), 2, &["is zero"]);
    let output = command(home.path(), "--sim yerc status").env("ARMCTL_TIMEOUT", "0s").output().unwrap();
    fails(&output, 2, &["ARMCTL_TIMEOUT", "is zero"]);
}

#[test]
fn reports_syntax_errors_in_the_requested_format() {
    let home = tempfile::tempdir().unwrap();
    for format in ["--json", "-ojsonl", "--output=json", "-qo json"] {
        let output = armctl(home.path(), &format!("--sim yerc var set B0=256 {format}"));
        fails(&output, 2, &[]);
        let error: Value = serde_json::from_slice(&output.stderr).expect(format);
        assert_eq!(error["error"]["exit"], 2, "{format}");
        assert!(output.stdout.is_empty(), "{format}");
    }
}

/// A simulator on real ports. It runs until the end of the test.
struct Server {
    process: Child,
    url: String,
}

impl Server {
    fn start(home: &Path) -> Self {
        let mut process = command(home, "sim yerc --bind 127.0.0.1:0 --json").stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let told: Value = serde_json::from_str(&line).unwrap();
        Self { process, url: told["data"]["target"].as_str().unwrap().to_owned() }
    }

    fn data(&self, home: &Path, words: &str) -> Value {
        let output = armctl(home, &format!("-t {} --json {words}", self.url));
        succeeds(&output);
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["data"].take()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.process.kill().unwrap();
        self.process.wait().unwrap();
    }
}

#[cfg(unix)]
fn signal(process: &Child, name: &str) {
    assert!(Command::new("kill").arg(format!("-{name}")).arg(process.id().to_string()).status().unwrap().success());
}

/// Whether this process was started with SIGHUP (signal 1) ignored. `false` if this is unknown.
#[cfg(unix)]
fn is_hangup_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.is_some_and(|mask| u64::from_str_radix(mask.trim(), 16).unwrap() & 1 == 1)
}

#[cfg(unix)]
#[test]
fn every_end_of_a_move_holds_the_robot_first() {
    let home = tempfile::tempdir().unwrap();
    for name in ["INT", "TERM", "HUP"] {
        if name == "HUP" && is_hangup_ignored() {
            println!("skipped: SIGHUP is ignored here, as under nohup, and children keep that");
            continue;
        }
        let server = Server::start(home.path());
        let words = format!("-t {} yerc move pulse joint --pulses 90000,0,0,0,0,0 --speed 1% --yes --json", server.url);
        let moving = command(home.path(), &words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let deadline = format!("-t {} yerc status --watch 20ms --until .data.running --for 20s", server.url);
        succeeds(&armctl(home.path(), &deadline));
        signal(&moving, name);
        let output = moving.wait_with_output().unwrap();
        fails(&output, 130, &["the robot was stopped: HOLD is on"]);
        assert!(output.stdout.is_empty());
        assert_eq!(server.data(home.path(), "yerc status")["hold_sources"], serde_json::json!(["command"]), "{name}");
    }
}

#[cfg(unix)]
#[test]
fn watch_without_pause_ends_on_the_first_signal() {
    let home = tempfile::tempdir().unwrap();
    let mut watch = command(home.path(), "--sim yerc status -o jsonl --watch 1ms")
        .stderr(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut lines = BufReader::new(watch.stdout.take().unwrap()).lines();
    lines.next().unwrap().unwrap();
    signal(&watch, "INT");
    // The output is read to its end, so that the pipe does not fill up. The thread ends with the process.
    assert!(lines.all(|line| line.is_ok()));
    assert_eq!(watch.wait().unwrap().code(), Some(130));
}

#[test]
fn one_recording_contains_every_run_of_a_watch() {
    /// Number of packets in a capture file (blocks of type 6).
    fn packets(record: &[u8]) -> usize {
        let word = |at: usize| u32::from_le_bytes(record[at..at + 4].try_into().unwrap());
        let (mut at, mut count) = (0, 0);
        while at < record.len() {
            count += usize::from(word(at) == 6);
            at += usize::try_from(word(at + 4)).unwrap();
        }
        count
    }
    let home = tempfile::tempdir().unwrap();
    let recorded = |words: &str| {
        succeeds(&armctl(home.path(), words));
        packets(&std::fs::read(home.path().join("t.pcapng")).unwrap())
    };
    assert_eq!(recorded("--sim yerc status --trace t.pcapng --watch 1ms --count 3"), 6);
    assert_eq!(recorded("--sim yerc status --trace t.pcapng"), 2, "an older record is replaced");
    std::fs::write(
        home.path().join("robots.toml"),
        "[[robot]]\nname = \"a\"\nfamily = \"yerc\"\ntarget = \"sim:\"\n[[robot]]\nname = \"b\"\nfamily = \"yerc\"\n\
         target = \"sim:\"\n",
    )
    .unwrap();
    assert_eq!(recorded("--config robots.toml --all yerc status --trace t.pcapng"), 4, "two robots share it");
    assert_eq!(recorded("--sim toyo status --trace t.pcapng --count 2"), 20, "five pages a run");
}

#[test]
fn rejects_unsupported_commands_before_the_question() {
    let home = tempfile::tempdir().unwrap();
    // For a supported command, the question comes next: a motion without `--yes` and without a terminal fails with exit
    // code 7.
    let line = "yerc move joint --to 1,2,3,4,5,6 --speed 1% --group R8";
    fails(&armctl(home.path(), &format!("-t udp://127.0.0.1:9?model=fs100 {line}")), 2, &["robot number is 8"]);
    fails(&armctl(home.path(), &format!("-t udp://127.0.0.1:9?model=dx200 {line}")), 7, &["--yes"]);
}

#[test]
fn keeps_existing_files_with_one_exit_code() {
    let home = tempfile::tempdir().unwrap();
    for (name, words) in
        [("v.csv", "yerc var dump v.csv"), ("TESTJOB.JBI", "yerc file get TESTJOB.JBI"), ("c", "yerc file cmos c")]
    {
        std::fs::write(home.path().join(name), "mine").unwrap();
        fails(&armctl(home.path(), &format!("--sim {words}")), 1, &["was not changed", "--force"]);
        assert_eq!(std::fs::read(home.path().join(name)).unwrap(), b"mine");
    }
}

#[test]
fn rejects_control_characters_in_texts_and_names() {
    let home = tempfile::tempdir().unwrap();
    for words in [["say", "A\x1b[2J"], ["say", "two\nlines"]] {
        let output = command(home.path(), "--sim yerc").args(words).output().unwrap();
        fails(&output, 2, &["control character"]);
    }
    let output = command(home.path(), "--sim yerc job select").arg("A\x07B").output().unwrap();
    fails(&output, 2, &["the job name contains a control character: \\u{7}"]);
}

#[cfg(target_os = "linux")]
#[test]
fn reports_the_result_if_stdout_is_full() {
    let home = tempfile::tempdir().unwrap();
    let full = || std::fs::File::options().write(true).open("/dev/full").unwrap();
    let output = command(home.path(), "--sim yerc servo on").stdout(full()).output().unwrap();
    fails(&output, 1, &["succeeded, but the report could not be written", "no space left"]);
    let output = command(home.path(), "--sim yerc status").stdout(full()).output().unwrap();
    fails(&output, 1, &["error: stdout: no space left"]);
    // One of the two files is missing. This failure is reported even if the report cannot be written.
    let output =
        command(home.path(), "--sim yerc file get TESTJOB.JBI NOPE.JBI --json").stdout(full()).output().unwrap();
    fails(&output, 9, &["NOPE.JBI", "0xE29C"]);
}

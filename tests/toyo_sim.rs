//! `armctl sim toyo` as a process with a TCP port or a pseudo-terminal, a console, and an end.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Output, Stdio};

use serde_json::Value;

/// A running simulator.
struct Served {
    process: Child,
    stderr: BufReader<ChildStderr>,
    /// URL of the simulator.
    target: String,
}

impl Served {
    /// Starts a simulator and waits until it listens.
    fn start(folder: &Path, words: &str) -> Self {
        let mut process = armctl(folder, &format!("sim toyo {words} --jq .data.target"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let mut target = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut target).unwrap();
        let stderr = BufReader::new(process.stderr.take().unwrap());
        Self { process, stderr, target: target.trim_end().to_owned() }
    }

    /// Output of a command for it.
    fn data(&self, folder: &Path, words: &str) -> Value {
        let output = armctl(folder, &format!("--json -t {} toyo {words}", self.target)).output().unwrap();
        assert!(output.status.success(), "{words}: {}", stderr(&output));
        let envelope: Value = serde_json::from_slice(&output.stdout).unwrap();
        envelope["data"].clone()
    }

    /// A line on stderr.
    fn messages(&mut self) -> String {
        let mut line = String::new();
        self.stderr.read_line(&mut line).unwrap();
        line
    }

    /// Asks it to end, and returns its exit code.
    fn end(mut self, signal: &str) -> Option<i32> {
        let pid = self.process.id().to_string();
        assert!(Command::new("kill").args([signal, pid.as_str()]).status().unwrap().success());
        self.process.wait().unwrap().code()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // It may have ended as requested.
        self.process.kill().unwrap_or_default();
        self.process.wait().unwrap();
    }
}

fn armctl(folder: &Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.args(words.split(' ')).current_dir(folder).env_clear().env("HOME", folder).stdin(Stdio::null());
    command
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn pseudo_terminal_link_exists_while_served() {
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("port");
    for signal in ["-INT", "-TERM"] {
        let served = Served::start(folder.path(), "--pty --link port");
        assert_eq!(served.target, format!("serial://{}", link.canonicalize().map(|_| link.display()).unwrap()));
        served.data(folder.path(), "counter set 7 42");
        assert_eq!(served.data(folder.path(), "counter get 7")["items"][0]["value"], 42, "it keeps its state");
        let second = armctl(folder.path(), "sim toyo --pty --link port").output().unwrap();
        assert_eq!(second.status.code(), Some(1), "{}", stderr(&second));
        assert_eq!(served.end(signal), Some(0));
        assert!(!link.is_symlink(), "{signal}");
    }
}

/// Envelopes of a watch, up to a success or a failure.
fn wait_until(lines: &mut impl Iterator<Item = std::io::Result<String>>, ok: bool) {
    let is_so = |line: &String| line.contains(&format!(r#""ok":{ok}"#));
    assert!(lines.map_while(Result::ok).any(|line| is_so(&line)), "none came that has ok: {ok}");
}

#[test]
fn watch_survives_a_replugged_port() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("on.toml"), "host = true\n").unwrap();
    let mut served = Served::start(folder.path(), "--pty --link port");
    for (words, state) in [
        ("position --watch=50ms --count 2000", ""),
        ("status --watch=50ms --count 2000 --until .data.host_on", " --state on.toml"),
    ] {
        let words = format!("-o jsonl -t {} toyo {words}", served.target);
        let mut watch = armctl(folder.path(), &words).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(watch.stdout.take().unwrap()).lines();
        wait_until(&mut lines, true);
        assert_eq!(served.end("-INT"), Some(0));
        assert!(!folder.path().join("port").exists(), "the path is gone");
        wait_until(&mut lines, false);
        served = Served::start(folder.path(), &format!("--pty --link port{state}"));
        wait_until(&mut lines, true);
        if state.is_empty() {
            let pid = watch.id().to_string();
            assert!(Command::new("kill").args(["-INT", pid.as_str()]).status().unwrap().success());
        }
        // The condition became true on the returned controller.
        assert_eq!(watch.wait().unwrap().code(), Some(if state.is_empty() { 130 } else { 0 }));
    }
}

#[test]
fn console_sets_states_without_a_command() {
    let folder = tempfile::tempdir().unwrap();
    let mut served = Served::start(folder.path(), "--bind 127.0.0.1:0 --console");
    let mut console = served.process.stdin.take().unwrap();
    assert!(served.messages().starts_with("reach it:") && served.messages().starts_with("end it:"));
    console.write_all(b"input 0/01/3 on\n").unwrap();
    assert!(served.messages().contains("servo on"), "what is now");
    assert_eq!(served.data(folder.path(), "io get IN1.3")["items"][0]["value"], true);
    console.write_all(b"\ninptu 0/01/3 off\n").unwrap();
    assert!(served.messages().contains("inptu"));
    drop(console);
    assert!(served.messages().trim().is_empty() && served.messages().contains("`help`"), "a hint follows");
    // It continues after the end of the console input.
    assert_eq!(served.data(folder.path(), "io get IN1.3")["items"][0]["value"], true);
}

#[test]
fn simulates_line_speed_and_one_simulator_per_address() {
    let folder = tempfile::tempdir().unwrap();
    let served = Served::start(folder.path(), "--bind 127.0.0.1:0 --baud 115200 --axes 2");
    let address = served.target.strip_prefix("tcp://").unwrap().strip_suffix("?baud=115200").unwrap();
    let second = armctl(folder.path(), &format!("sim toyo --bind {address}")).output().unwrap();
    assert_eq!(second.status.code(), Some(4));
    assert!(stderr(&second).contains(&format!("cannot listen on TCP {address}: address")), "{}", stderr(&second));
    assert_eq!(served.data(folder.path(), "status")["homed"], false);
}

#[test]
fn warns_about_a_reachable_simulator() {
    let folder = tempfile::tempdir().unwrap();
    let mut served = Served::start(folder.path(), "--bind 0.0.0.0:0");
    assert_eq!(served.messages(), "warning: others on the network can reach this simulator\n");
    assert_eq!(served.end("-INT"), Some(0));
}

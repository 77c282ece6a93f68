//! `armctl sim toyo` as a process: TCP port or pseudo-terminal, console, end of the process.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Child, ChildStderr, Command, Output, Stdio};

use serde_json::Value;

/// A process that serves a simulator.
struct Served {
    process: Child,
    stderr: BufReader<ChildStderr>,
    /// URL of the simulator.
    target: String,
}

impl Served {
    /// Starts a simulator, and waits until it accepts connections.
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

    /// `data` of a command line for the simulator.
    fn data(&self, folder: &Path, words: &str) -> Value {
        let output = armctl(folder, &format!("--json -t {} toyo {words}", self.target)).output().unwrap();
        assert!(output.status.success(), "{words}: {}", stderr(&output));
        let envelope: Value = serde_json::from_slice(&output.stdout).unwrap();
        envelope["data"].clone()
    }

    /// The next line on stderr.
    fn next_message(&mut self) -> String {
        let mut line = String::new();
        self.stderr.read_line(&mut line).unwrap();
        line
    }

    /// Ends the process with a signal, and returns its exit code.
    fn end(mut self, signal: &str) -> Option<i32> {
        let pid = self.process.id().to_string();
        assert!(Command::new("kill").args([signal, pid.as_str()]).status().unwrap().success());
        self.process.wait().unwrap().code()
    }
}

impl Drop for Served {
    fn drop(&mut self) {
        // The process may already have ended.
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
fn a_pseudo_terminal_has_its_link_until_the_simulator_ends() {
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

/// Reads the envelopes of a watch until one has this value of `ok`.
fn read_until(lines: &mut impl Iterator<Item = std::io::Result<String>>, ok: bool) {
    let is_so = |line: &String| line.contains(&format!(r#""ok":{ok}"#));
    assert!(lines.map_while(Result::ok).any(|line| is_so(&line)), "none came that has ok: {ok}");
}

#[test]
fn a_watch_continues_after_its_port_is_unplugged_and_plugged_in() {
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
        read_until(&mut lines, true);
        assert_eq!(served.end("-INT"), Some(0));
        assert!(!folder.path().join("port").exists(), "the path is gone");
        read_until(&mut lines, false);
        served = Served::start(folder.path(), &format!("--pty --link port{state}"));
        read_until(&mut lines, true);
        if state.is_empty() {
            let pid = watch.id().to_string();
            assert!(Command::new("kill").args(["-INT", pid.as_str()]).status().unwrap().success());
        }
        // The condition of `--until` is true on the new controller, so this watch ends by itself.
        assert_eq!(watch.wait().unwrap().code(), Some(if state.is_empty() { 130 } else { 0 }));
    }
}

#[test]
fn the_console_switches_inputs() {
    let folder = tempfile::tempdir().unwrap();
    let mut served = Served::start(folder.path(), "--bind 127.0.0.1:0 --console");
    let mut console = served.process.stdin.take().unwrap();
    assert!(served.next_message().starts_with("reach it:") && served.next_message().starts_with("end it:"));
    console.write_all(b"input 0/01/3 on\n").unwrap();
    assert!(served.next_message().contains("servo on"), "the present state");
    assert_eq!(served.data(folder.path(), "io get IN1.3")["items"][0]["value"], true);
    console.write_all(b"\ninptu 0/01/3 off\n").unwrap();
    assert!(served.next_message().contains("inptu"));
    drop(console);
    assert!(served.next_message().trim().is_empty() && served.next_message().contains("`help`"), "a hint follows");
    // The simulator continues to serve after its console has ended.
    assert_eq!(served.data(folder.path(), "io get IN1.3")["items"][0]["value"], true);
}

#[test]
fn a_line_has_a_baud_rate_and_an_address_has_one_simulator() {
    let folder = tempfile::tempdir().unwrap();
    let served = Served::start(folder.path(), "--bind 127.0.0.1:0 --baud 115200 --axes 2");
    let address = served.target.strip_prefix("tcp://").unwrap().strip_suffix("?baud=115200").unwrap();
    let second = armctl(folder.path(), &format!("sim toyo --bind {address}")).output().unwrap();
    assert_eq!(second.status.code(), Some(4));
    assert!(stderr(&second).contains(&format!("cannot listen on TCP {address}: address")), "{}", stderr(&second));
    assert_eq!(served.data(folder.path(), "status")["homed"], false);
}

#[test]
fn a_simulator_on_all_interfaces_prints_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let mut served = Served::start(folder.path(), "--bind 0.0.0.0:0");
    assert_eq!(served.next_message(), "warning: other computers on the network can reach this simulator\n");
    assert_eq!(served.end("-INT"), Some(0));
}

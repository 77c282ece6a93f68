//! Watches of several robots, one of which is unreachable.

#![cfg(unix)]

use std::io::{BufRead as _, BufReader};
use std::net::{SocketAddr, TcpListener, UdpSocket};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use crate::support::simulator::Simulator;

/// The environment of a user with two robots: `here`, and `late`, whose port is closed.
struct Workspace {
    folder: TempDir,
    _here: Simulator,
    late: String,
}

impl Workspace {
    fn new() -> Self {
        let (folder, here) = (tempfile::tempdir().expect("a folder"), Simulator::start("yerc"));
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let late = listener.local_addr().expect("an address").to_string();
        let robots = [("here", "yerc", here.url.clone()), ("late", "toyo", format!("tcp://{late}"))];
        let entry = |(name, family, target): &(&str, &str, String)| {
            format!("[[robot]]\nname = \"{name}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\n")
        };
        std::fs::write(folder.path().join("robots.toml"), robots.iter().map(entry).collect::<String>())
            .expect("a file");
        Self { folder, _here: here, late }
    }

    fn watch(&self, words: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        let inventory = self.folder.path().join("robots.toml");
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path());
        command.env("ARMCTL_CONFIG", inventory).args(["-r", "here", "-r", "late", "--no-session", "status"]);
        command.args(words.split(' ')).stdin(Stdio::null()).stdout(Stdio::piped());
        command
    }
}

#[test]
fn for_bounds_the_wait_for_a_silent_robot() {
    // Both sockets accept data, but never answer.
    let (udp, tcp) = (UdpSocket::bind("127.0.0.1:0"), TcpListener::bind("127.0.0.1:0"));
    let address = |found: std::io::Result<SocketAddr>| found.expect("an address").to_string();
    let udp = udp.expect("a port");
    let tcp = tcp.expect("a port");
    let (yerc, toyo, yrcx) = (
        format!("udp://{}", address(udp.local_addr())),
        format!("tcp://{}", address(tcp.local_addr())),
        format!("eip://{}", address(tcp.local_addr())),
    );
    let folder = tempfile::tempdir().expect("a folder");
    for (target, words, exit) in [
        (&yerc, "wait idle", 4),
        (&yerc, "wait B5=3", 4),
        (&yerc, "yerc status --until idle", 4),
        (&yerc, "yerc var watch B0", 4),
        (&toyo, "wait idle", 4),
        (&toyo, "toyo status --until idle", 4),
        (&toyo, "wait reachable=false", 0),
        (&yrcx, "wait idle", 4),
        (&yrcx, "yrcx status --until idle", 4),
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", folder.path()).env("XDG_RUNTIME_DIR", folder.path()).stdin(Stdio::null());
        command.args(["-t", target, "--timeout", "30s"]).args(words.split(' ')).args(["--for", "200ms"]);
        let start = Instant::now();
        let output = command.output().expect("armctl runs");
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(exit), "{target} {words}: {said}");
        assert!(start.elapsed() < Duration::from_secs(20), "{target} {words}: {:?}", start.elapsed());
        assert!(exit == 0 || said.contains("no answer within 200ms (--for)"), "{said}");
    }
}

#[test]
fn counts_failures_of_each_round() {
    let workspace = Workspace::new();
    let output = workspace.watch("--watch 1ms --count 40").output().expect("armctl runs");
    let said = String::from_utf8(output.stderr).expect("UTF-8");
    let failures: Vec<&str> = said.lines().filter(|line| line.contains("nothing listens on TCP port")).collect();
    assert_eq!(failures.len(), 6, "{said}");
    assert!(failures.iter().all(|line| line.starts_with("error: late (tcp://")), "{said}");
    assert!(failures[5].contains(" (35 more times in "), "{said}");
    assert_eq!(said.matches("2 robots, 1 answers").count(), 1, "{said}");
    let shown = String::from_utf8(output.stdout).expect("UTF-8");
    assert_eq!(shown.matches("ROBOT").count(), 40, "the tables are data, and all are shown");
}

#[test]
fn watches_a_robot_that_becomes_reachable() {
    let workspace = Workspace::new();
    let mut watch = workspace.watch("--watch 20ms -o jsonl").spawn().expect("armctl starts");
    let lines = BufReader::new(watch.stdout.take().expect("a pipe")).lines().map_while(Result::ok);
    let mut late = lines
        .map(|line| serde_json::from_str::<Value>(&line).expect("an envelope"))
        .filter(|line| line["robot"] == "late");
    assert_eq!(late.next().expect("a line")["ok"], false);
    let _simulator = Simulator::start_with("toyo", &["--bind", &workspace.late]);
    assert!(late.any(|line| line["ok"] == true && line["data"]["reachable"] == true));
    watch.kill().expect("it runs");
    watch.wait().expect("it ends");
}

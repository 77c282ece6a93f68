//! `armctl publish` with a real broker, and with peers that are not brokers. The tests wait for conditions, never for a
//! fixed time.
#![allow(clippy::unwrap_used, reason = "what fails in here fails the test that wants it")]
#![cfg(all(unix, feature = "plant"))]

mod broker;
mod failover;
mod ownership;
mod sparkplug;
mod tls;

use std::fs::Permissions;
use std::io::{BufRead as _, BufReader, Read as _};
use std::os::unix::fs::PermissionsExt as _;
use std::process::{Child, ChildStderr, Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

use self::broker::{Mosquitto, NOT_INSTALLED, flooding, hostile};
use crate::support::schemas;

/// The environment of a user: an inventory.
pub struct Workspace {
    pub folder: TempDir,
}

impl Workspace {
    pub fn new(robots: &[(&str, &str, &str)]) -> Self {
        let workspace = Self { folder: tempfile::tempdir().unwrap() };
        workspace.write(robots);
        workspace
    }

    pub fn write(&self, robots: &[(&str, &str, &str)]) {
        let entry = |(name, family, target): &(&str, &str, &str)| {
            format!("[[robot]]\nname = \"{name}\"\nfamily = \"{family}\"\ntarget = \"{target}\"\n")
        };
        std::fs::write(self.folder.path().join("robots.toml"), robots.iter().map(entry).collect::<String>()).unwrap();
    }

    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path());
        command.env("ARMCTL_CONFIG", self.folder.path().join("robots.toml")).stdin(Stdio::null()).args(words);
        command
    }

    pub fn run(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }
}

pub fn fleet() -> Workspace {
    Workspace::new(&[("press", "yerc", "sim:"), ("loader", "toyo", "sim:"), ("picker", "yrcx", "sim:")])
}

/// A publisher that runs until it is dropped.
pub struct Publisher {
    process: Child,
    stderr: BufReader<ChildStderr>,
}

impl Publisher {
    pub fn start(mut command: Command) -> Self {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let stderr = BufReader::new(process.stderr.take().unwrap());
        Self { process, stderr }
    }

    /// Waits for this text on stderr. Returns the number of lines that were read, including the line with the text.
    pub fn wait_for_message(&mut self, part: &str) -> usize {
        let (mut line, mut lines) = (String::new(), 0);
        while !line.contains(part) {
            line.clear();
            assert!(self.stderr.read_line(&mut line).unwrap() > 0, "it never said '{part}'");
            lines += 1;
        }
        lines
    }

    pub fn signal(&self, signal: &str) {
        assert!(Command::new("kill").args([signal, &self.process.id().to_string()]).status().unwrap().success());
    }

    /// Waits until the publisher ends. Returns its exit code and its report.
    pub fn end(mut self) -> (Option<i32>, Value) {
        let (mut report, mut said) = (String::new(), String::new());
        self.process.stdout.take().unwrap().read_to_string(&mut report).unwrap();
        self.stderr.read_to_string(&mut said).unwrap();
        let code = self.process.wait().unwrap().code();
        (code, serde_json::from_str(&report).unwrap_or_default())
    }
}

impl Drop for Publisher {
    fn drop(&mut self) {
        self.process.kill().unwrap_or_default();
        let _ended = self.process.wait();
    }
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn publishes_an_envelope_per_robot_and_kind() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    for protocol in ["5", "3.1.1"] {
        let prefix = format!("plant/{}", protocol.replace('.', "-"));
        let extra_argument = ["--also", "parts=yerc var get B0..B2", "--also", "toyo counter get 1"];
        let words = ["publish", &broker.url(), "--count", "1", "--json", "--node", "cell7", "--prefix", &prefix];
        let output = fleet().run(&[&words[..], &extra_argument, &["--protocol", protocol]].concat());
        assert!(output.status.success(), "{}", stderr(&output));
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        schemas::check(&report).unwrap();
        let counts =
            ["robots", "published", "refused", "dropped", "undelivered"].map(|name| report["data"][name].as_u64());
        assert_eq!(counts, [Some(3), Some(11), Some(0), Some(0), Some(0)]);
        let mut listener = broker.listen(&format!("{prefix}/#"));
        let mut topics = Vec::new();
        for _ in 0..12 {
            let received = listener.next();
            assert!(received.is_kept, "{received:?}");
            topics.push(received.topic.strip_prefix(&format!("{prefix}/")).unwrap().to_owned());
            if received.topic.ends_with("/state") {
                assert_eq!(received.payload, "offline");
                continue;
            }
            let envelope: Value = serde_json::from_str(&received.payload).unwrap();
            schemas::check(&envelope).unwrap_or_else(|why| panic!("{why}: {envelope}"));
            assert!(envelope["ok"] == true && envelope["time"].is_string() && envelope["simulated"] == true);
        }
        topics.sort();
        let expected = [
            "cell7/state",
            "loader/alarms",
            "loader/counter-get-1",
            "loader/position",
            "loader/status",
            "picker/alarms",
            "picker/position",
            "picker/status",
            "press/alarms",
            "press/parts",
            "press/position",
            "press/status",
        ];
        assert_eq!(topics, expected);
    }
}

#[test]
fn every_exit_publishes_the_last_will() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    let (workspace, url) = (fleet(), broker.url());
    let mut listener = broker.listen("armctl/cell7/state");
    for (signal, code) in [("-TERM", Some(0)), ("-INT", Some(0)), ("-KILL", None)] {
        let publisher = Publisher::start(workspace.command(&["publish", &url, "--node", "cell7", "--json"]));
        listener.wait_for("armctl/cell7/state", |state| state == "online");
        publisher.signal(signal);
        listener.wait_for("armctl/cell7/state", |state| state == "offline");
        assert_eq!(publisher.end().0, code, "{signal}");
    }
}

#[test]
fn returning_broker_gets_missed_records_in_order() {
    let Some(mut broker) = Mosquitto::start_if_installed() else { return };
    let (workspace, url) = (fleet(), broker.url());
    // With `--every 1ms`, unchanged data is also published at every poll.
    let words =
        ["publish", &url, "--node", "cell7", "--json", "--watch", "50ms", "--every", "1ms", "--kinds", "status"];
    let mut publisher = Publisher::start(workspace.command(&words));
    publisher.wait_for_message("connected to");
    broker.listen("armctl/press/status").next();
    let time_of = |payload: &str| {
        let envelope: Value = serde_json::from_str(payload).unwrap();
        envelope["time"].as_str().unwrap().parse::<jiff::Timestamp>().unwrap()
    };
    loop {
        broker.kill();
        publisher.wait_for_message("next try in");
        broker.start_again();
        let mut listener = broker.listen("armctl/press/status");
        let restarted = jiff::Timestamp::now();
        publisher.wait_for_message("again after");
        let mut times = vec![time_of(&listener.next().payload)];
        while times.last().is_none_or(|last| *last < restarted) {
            times.push(time_of(&listener.next().payload));
        }
        assert!(times.is_sorted(), "{times:?}");
        // If the publisher was connected before the subscriber, the subscriber has missed the queue. The test is then
        // repeated.
        if times.iter().filter(|time| **time < restarted).count() > 1 {
            break;
        }
    }
    publisher.signal("-TERM");
    let (code, report) = publisher.end();
    let data = &report["data"];
    assert_eq!((code, &data["dropped"], &data["undelivered"]), (Some(0), &0.into(), &0.into()), "{report}");
    assert!(data["reconnects"].as_u64() >= Some(1), "{report}");
}

#[test]
fn queued_records_outlive_the_process() {
    let Some(mut broker) = Mosquitto::start_if_installed() else { return };
    let (workspace, url) = (fleet(), broker.url());
    broker.kill();
    let words =
        ["publish", &url, "--node", "cell7", "--json", "--watch", "50ms", "--every", "1ms", "--kinds", "status"];
    let mut publisher = Publisher::start(workspace.command(&[&words[..], &["-v"]].concat()));
    publisher.wait_for_message("next try in");
    // The second try is a second later, so the robots were polled in the meantime.
    publisher.wait_for_message("next try in");
    publisher.signal("-TERM");
    publisher.wait_for_message("stored on disk");
    let (code, report) = publisher.end();
    assert_eq!((code, &report["data"]["published"]), (Some(0), &0.into()));
    let ended = jiff::Timestamp::now();
    broker.start_again();
    let mut listener = broker.listen("armctl/+/status");
    let output = workspace.run(&["publish", &url, "--node", "cell7", "--count", "1", "--kinds", "status"]);
    assert!(stderr(&output).contains(" KiB "), "{}", stderr(&output));
    let envelope: Value = serde_json::from_str(&listener.next().payload).unwrap();
    assert!(envelope["time"].as_str().unwrap().parse::<jiff::Timestamp>().unwrap() < ended);
}

#[test]
fn removed_robot_is_cleared_at_the_broker() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    let workspace = fleet();
    let mut listener = broker.listen("armctl/+/status");
    let publisher = Publisher::start(workspace.command(&["publish", &broker.url(), "--watch", "50ms"]));
    listener.wait_for("armctl/press/status", |payload| !payload.is_empty());
    workspace.write(&[("loader", "toyo", "sim:")]);
    listener.wait_for("armctl/press/status", str::is_empty);
    drop(publisher);
}

#[test]
fn escapes_unusual_names_in_topics() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    let workspace = Workspace::new(&[]);
    // The port does not exist. The robot has no other name than its port.
    let words = [
        "-t",
        "serial:///dev/no+such#port",
        "publish",
        &broker.url(),
        "--count",
        "1",
        "--node",
        "a/b#c",
        "--kinds",
        "status",
    ];
    let output = workspace.run(&words);
    assert!(output.status.success(), "{}", stderr(&output));
    let mut listener = broker.listen("armctl/#");
    let mut topics = [listener.next().topic, listener.next().topic];
    topics.sort();
    assert_eq!(topics, ["armctl/a%2Fb%23c/state", "armctl/no%2Bsuch%23port/status"]);
}

#[test]
fn needs_the_right_password_and_never_prints_it() {
    if !broker::is_installed() {
        return eprintln!("{NOT_INSTALLED}");
    }
    let broker = Mosquitto::with("allow_anonymous false\npassword_file FOLDER/passwords\n", |folder| {
        let file = folder.join("passwords");
        let mut command = Command::new("mosquitto_passwd");
        command.args(["-b", "-c"]).arg(&file).args(["plant", "hunter2"]).stderr(Stdio::null());
        assert!(command.status().unwrap().success());
    });
    let (workspace, url) = (fleet(), broker.url());
    let publish = ["publish", &url[..], "--user", "plant", "--count", "1", "-vvv", "--kinds", "status"];
    for protocol in ["5", "3.1.1"] {
        let words = [&publish[..], &["--protocol", protocol]].concat();
        let mut right = workspace.command(&words);
        let right = right.env("ARMCTL_MQTT_PASSWORD", "hunter2").output().unwrap();
        assert!(right.status.success(), "{}", stderr(&right));
        let mut wrong = workspace.command(&words);
        let wrong = wrong.env("ARMCTL_MQTT_PASSWORD", "hunter3").output().unwrap();
        assert_eq!(wrong.status.code(), Some(2), "{}", stderr(&wrong));
        assert!(stderr(&wrong).contains("check --user"), "{}", stderr(&wrong));
        for output in [&right, &wrong] {
            assert!(!stderr(output).contains("hunter") && !String::from_utf8_lossy(&output.stdout).contains("hunter"));
        }
    }
    let file = workspace.folder.path().join("password");
    std::fs::write(&file, "hunter2\n").unwrap();
    let words = [&publish[..], &["--password-file", file.to_str().unwrap()]].concat();
    assert!(workspace.run(&words).status.success());
    // A password in the URL is refused, because other users could see it.
    let output = workspace.run(&["publish", "mqtt://plant:hunter2@127.0.0.1"]);
    assert_eq!(output.status.code(), Some(2));
    let messages = stderr(&output);
    assert!(messages.contains("--password-file") && messages.matches("hunter2").count() <= 1, "{messages}");
}

/// Messages of a publisher that uses a password file with these permissions and this URL. It runs in an empty network.
fn password_messages(url: &str, rights: u32, more: &[&str]) -> String {
    let workspace = fleet();
    let file = workspace.folder.path().join("password");
    std::fs::write(&file, "hunter2\n").unwrap();
    std::fs::set_permissions(&file, Permissions::from_mode(rights)).unwrap();
    let words = ["publish", url, "--count", "1", "--user", "plant", "--password-file", file.to_str().unwrap()];
    let own_file = workspace.command(&[&words[..], more].concat());
    let mut command = Command::new("unshare");
    command.arg("-Urn").arg(own_file.get_program()).args(own_file.get_args()).stdin(Stdio::null());
    command.envs(own_file.get_envs().filter_map(|(name, value)| Some((name, value?))));
    stderr(&command.output().unwrap())
}

#[test]
fn warns_once_about_a_readable_password() {
    let private_file = Command::new("unshare").args(["-Urn", "true"]).output();
    if !private_file.is_ok_and(|output| output.status.success()) {
        return eprintln!("skipped: there are no user namespaces here");
    }
    let (file, network) =
        ("other users of this computer can read this password", "sends the password without encryption");
    for (url, rights, more, warnings) in [
        ("mqtt://127.0.0.1", 0o600, &[][..], [0, 0]),
        ("mqtt://127.0.0.1", 0o640, &[], [1, 0]),
        ("mqtt://127.0.0.1", 0o604, &["--insecure"], [1, 0]),
        ("mqtt://192.0.2.1", 0o600, &[], [0, 1]),
        ("mqtt://192.0.2.1", 0o600, &["--insecure"], [0, 0]),
    ] {
        let said = password_messages(url, rights, more);
        let counts = [file, network].map(|warning| said.matches(warning).count());
        assert_eq!(counts, warnings, "{url} {rights:o} {more:?}: {said}");
        assert!(said.contains(&format!("{url}:")) && !said.contains("hunter2"), "{said}");
    }
}

#[test]
fn reports_peers_that_are_not_brokers() {
    let workspace = fleet();
    for (answer, closes, code, why) in [
        (&[0x20, 2, 0, 5][..], false, 2, "not authorized to connect"),
        (&[0x20, 2, 0, 2], false, 2, "does not accept the name of this client"),
        (&[0x20, 2, 0, 3], false, 4, "not available at the moment"),
        (&[0x20, 2, 0, 77], false, 4, "not send MQTT"),
        (b"HTTP/1.1 400 Bad Request\r\n\r\n", false, 4, "not send MQTT"),
        (b"SSH-2.0-OpenSSH_9.2\r\n", true, 4, "not send MQTT"),
        (&[0x30, 3, 0, 1, b'a'], false, 4, "not send MQTT"),
        (&[0x20, 0xff, 0xff, 0xff, 0x7f, 0, 0], false, 4, "packet that is longer than"),
        (&[0x20, 2, 0, 0, 0x30, 0xff, 0xff, 0xff, 0x7f], false, 4, "packet that is longer than"),
        (&[], true, 4, "closed the connection"),
    ] {
        let url = hostile(answer, closes);
        let output = workspace.run(&["publish", &url, "--count", "1", "--protocol", "3.1.1", "--kinds", "status"]);
        let said = stderr(&output);
        assert!(said.contains(why) && said.contains("hint:"), "{why}: {said}");
        assert_eq!(output.status.code(), Some(code), "{why}: {said}");
    }
}

#[test]
fn leaves_and_retries_flooding_brokers_without_blocking_the_exit() {
    /// Number of lines for two connections. Each connection is made and then lost, with messages about queued or
    /// refused data.
    const LINES: usize = 8;

    for (packet, why) in [
        (&[0x20, 2, 0, 0][..], "the broker does not follow the MQTT protocol: a second CONNACK; next try in "),
        (&[0x30, 3, 0, 1, b'a'], "the broker sends too much: "),
        (&[0xd0, 0], "the broker sends too much: "),
    ] {
        let workspace = fleet();
        let words = ["publish", &flooding(packet), "--protocol", "3.1.1", "--buffer-memory", "64K", "--json"];
        let mut publisher = Publisher::start(workspace.command(&words));
        let mut lines = publisher.wait_for_message("connected to");
        lines += publisher.wait_for_message(why);
        lines += publisher.wait_for_message("again after");
        publisher.signal("-TERM");
        let (code, report) = publisher.end();
        assert_eq!((code, &report["data"]["reconnects"]), (Some(0), &1.into()), "{report}");
        assert!(lines <= LINES, "{lines} lines");
    }
}

/// Runs in a namespace that has a disk of limited size.
#[test]
fn reports_a_full_disk_and_continues() {
    let alone = Command::new("unshare").args(["-Urm", "true"]).output();
    if !alone.is_ok_and(|output| output.status.success()) {
        return eprintln!("skipped: there are no user namespaces here");
    }
    let names: Vec<String> = (0..20).map(|number| format!("cell{number}")).collect();
    let robots: Vec<(&str, &str, &str)> = names.iter().map(|name| (&name[..], "yerc", "sim:")).collect();
    let workspace = Workspace::new(&robots);
    let full = workspace.folder.path().join("disk");
    std::fs::create_dir(&full).unwrap();
    let words = ["publish", "mqtt://127.0.0.1:1", "--watch", "50ms", "--every", "1ms", "--kinds", "status", "--json"];
    let buffer = ["--buffer-memory", "64K", "--buffer-disk", "16M", "--buffer-dir", full.to_str().unwrap()];
    let publish = workspace.command(&[&words[..], &buffer].concat());
    let mut command = Command::new("unshare");
    command.args(["-Urm", "sh", "-c", "mount -t tmpfs -o size=128k none \"$0\" && exec \"$@\""]).arg(&full);
    command.arg(publish.get_program()).args(publish.get_args()).stdin(Stdio::null());
    command.envs(publish.get_envs().filter_map(|(name, value)| Some((name, value?))));
    let mut publisher = Publisher::start(command);
    publisher.wait_for_message("cannot write messages to disk (no space left");
    publisher.signal("-TERM");
    let (code, report) = publisher.end();
    assert_eq!(code, Some(0));
    let dropped = ["dropped", "undelivered"].map(|name| report["data"][name].as_u64().unwrap());
    assert!(dropped.iter().sum::<u64>() > 0, "{report}");
}

#[test]
fn reports_two_publishers_with_the_same_name() {
    let Some(broker) = Mosquitto::start_if_installed() else { return };
    let (workspace, url) = (fleet(), broker.url());
    let mut first = Publisher::start(workspace.command(&["publish", &url, "--node", "cell7"]));
    first.wait_for_message("connected to");
    let output = workspace.run(&["publish", &url, "--node", "cell7", "--count", "1"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(stderr(&output).contains("another armctl publishes as 'cell7'"), "{}", stderr(&output));
}

//! Exit codes that need a faulty peer or a signal: malformed answers, a lost answer of a change, a full disk, Ctrl-C.

#![expect(clippy::needless_raw_string_hashes, reason = "as snapbox writes them")]

use std::io::{BufRead as _, BufReader, Read as _};
use std::net::UdpSocket;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;

use serde_json::Value;

use super::json;
use super::transcript::{Simulator, Workspace};

/// A controller that answers each request with the result of `answer`. It ends with the process.
fn peer(answer: impl Fn(&[u8]) -> Option<Vec<u8>> + Send + 'static) -> String {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let target = format!("udp://{}", socket.local_addr().expect("an address"));
    thread::spawn(move || {
        let mut buffer = [0; 2048];
        while let Ok((length, client)) = socket.recv_from(&mut buffer) {
            if let Some(bytes) = answer(&buffer[..length]) {
                socket.send_to(&bytes, client).expect("the client is there");
            }
        }
    });
    target
}

/// A successful answer without data, as for a write.
fn set_value(request: &[u8]) -> Vec<u8> {
    let mut answer = request[..24].to_vec();
    answer[6..8].copy_from_slice(&[0, 0]);
    answer[10] = 1;
    answer[12..16].copy_from_slice(&[0, 0, 0, 0x80]);
    answer.extend([request[29] | 0x80, 0, 0, 0, 0, 0, 0, 0]);
    answer
}

/// The error on stderr, which must be its only line. stdout must be empty.
fn failure(output: &Output) -> Value {
    assert_eq!(String::from_utf8_lossy(&output.stdout), "");
    let stderr = String::from_utf8_lossy(&output.stderr);
    let mut lines = stderr.lines();
    let envelope = lines.next().expect("a line on stderr");
    assert_eq!(lines.next(), None, "one line alone: {stderr}");
    json::format_value(envelope);
    let envelope: Value = serde_json::from_str(envelope).expect("an envelope");
    assert_eq!(envelope["error"]["exit"].as_i64(), output.status.code().map(i64::from));
    envelope["error"].clone()
}

#[test]
fn exits_5_for_a_malformed_answer() {
    let workspace = Workspace::new();
    // The answer to a status read has eight bytes of data, but this answer has none.
    let target = peer(|request| Some(set_value(request)));
    let output = workspace.armctl(&["-t", &target, "yerc", "status", "--json"]).output().expect("it runs");
    assert_eq!(output.status.code(), Some(5), "{output:?}");
    let error = failure(&output);
    assert_eq!(error["kind"], "malformed");
}

#[test]
fn exits_5_for_garbage() {
    let workspace = Workspace::new();
    let target = peer(|_| Some(b"HTTP/1.1 400 Bad Request\r\n\r\n".to_vec()));
    let line = ["-t", &target, "yerc", "status", "--json", "--timeout", "200ms", "--retries", "0"];
    let output = workspace.armctl(&line).output().expect("it runs");
    let error = failure(&output);
    snapbox::assert_data_eq!(
        format!("{} {}\n{}\n", error["exit"], error["kind"], error["message"])
            .replace(&target, "udp://127.0.0.1:10040"),
        snapbox::str![[r#"
5 "malformed"
"udp://127.0.0.1:10040: no valid answer within 200ms, but 1 truncated"

"#]]
    );
}

/// A controller that refuses reads and does not answer other requests.
fn refuses_to_report(request: &[u8]) -> Option<Vec<u8>> {
    let mut refused = set_value(request);
    refused[25] = 0x08;
    [0x01, 0x0E, 0x33].contains(&request[29]).then_some(refused)
}

#[test]
fn exits_6_if_the_answer_of_a_change_is_lost() {
    let workspace = Workspace::new();
    for change in [&["cycle", "once"][..], &["var", "set", "B0=1"], &["hold", "on"], &["job", "select", "MAIN"]] {
        let target = peer(refuses_to_report);
        let mut line = vec!["-t", &target, "--json", "--timeout", "100ms", "yerc"];
        line.extend(change);
        let output = workspace.armctl(&line).output().expect("it runs");
        assert_eq!(output.status.code(), Some(6), "{change:?}: {output:?}");
        let error = failure(&output);
        assert_eq!(error["kind"], "outcome_unknown");
        assert!(error["hint"].as_str().is_some_and(|hint| hint.contains("yerc")), "names the question: {error}");
    }
}

#[test]
fn exits_4_if_the_old_value_is_not_answered() {
    let target = peer(|_| None);
    let line = ["-t", &target, "--json", "--timeout", "100ms", "--retries", "0", "yerc", "var", "set", "B0=1"];
    let output = Workspace::new().armctl(&line).output().expect("it runs");
    assert_eq!(output.status.code(), Some(4), "{output:?}");
    let message = failure(&output)["message"].as_str().map(ToOwned::to_owned);
    assert!(message.is_some_and(|message| message.ends_with("; nothing was written")), "{output:?}");
}

#[test]
fn describes_exit_6() {
    let workspace = Workspace::new();
    let target = peer(refuses_to_report);
    let line = ["-t", &target, "--timeout", "100ms", "yerc", "cycle", "once"];
    let output = workspace.armctl(&line).output().expect("it runs");
    let stderr = String::from_utf8_lossy(&output.stderr).replace(&target, "udp://127.0.0.1:10040");
    snapbox::assert_data_eq!(
        stderr,
        snapbox::str![[r#"
error: udp://127.0.0.1:10040: the request was sent once, with no answer within 100ms: the result is unknown

hint: check before you repeat the command: use `armctl yerc status` to see the state

"#]]
    );
}

#[cfg(target_os = "linux")]
#[test]
fn exits_1_for_a_full_disk() {
    let workspace = Workspace::new();
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").expect("a disk that is full");
    let output = workspace.armctl(&["--sim", "yerc", "status"]).stdout(full).output().expect("it runs");
    assert_eq!(output.status.code(), Some(1));
    snapbox::assert_data_eq!(
        String::from_utf8_lossy(&output.stderr).into_owned(),
        snapbox::str![[r#"
error: stdout: no space left on device

hint: free some space, and repeat the command

"#]]
    );
}

#[test]
fn exits_0_if_the_reader_of_a_watch_closes() {
    let workspace = Workspace::new();
    let mut child = spawn(workspace.armctl(&["--sim", "yerc", "status", "--watch", "1ms", "-o", "jsonl"]));
    first_line(&mut child);
    let status = child.wait().expect("it ends by itself");
    assert_eq!(status.code(), Some(0), "{}", read_output(&mut child));
    assert_eq!(read_output(&mut child), "");
}

#[test]
fn interrupted_during_a_watch() {
    let workspace = Workspace::new();
    let mut child = spawn(workspace.armctl(&["--sim", "yerc", "status", "--watch", "1h", "-o", "jsonl"]));
    let line = first_line(&mut child);
    json::format_value(&line);
    interrupt(&child, "INT");
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let error: Value = serde_json::from_str(&read_output(&mut child)).expect("one line of JSON");
    assert_eq!(error["error"]["kind"], "interrupted");
    assert_eq!(error["error"]["exit"], 130);
}

#[test]
fn interrupted_during_a_move() {
    let workspace = Workspace::new();
    let simulator = Simulator::start("yerc", None);
    let status = |filter: &str| {
        let output =
            workspace.armctl(&["-t", &simulator.target, "yerc", "status", "--jq", filter]).output().expect("it runs");
        String::from_utf8(output.stdout).expect("UTF-8")
    };
    let line = ["-t", &simulator.target, "--yes", "yerc", "move", "relative", "--z", "-600", "--speed", "1mm/s"];
    let mut child = spawn(workspace.armctl(&line));
    // The motion takes ten minutes, so it is in progress when the controller reports that it runs.
    wait(&workspace, &simulator, ".data.running");
    interrupt(&child, "INT");
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    snapbox::assert_data_eq!(
        read_output(&mut child),
        snapbox::str![[r#"
stopping the robot: HOLD on
interrupted: the robot was stopped: HOLD is on; use `yerc hold off` to release HOLD

"#]]
    );
    assert_eq!(status(".data.hold_sources"), "[\"command\"]\n");
    // The robot slows down and stops. Only a command releases HOLD.
    wait(&workspace, &simulator, ".data.running | not");
    let released =
        workspace.armctl(&["-t", &simulator.target, "--yes", "yerc", "hold", "off"]).output().expect("it runs");
    assert!(released.status.success());
    assert_eq!(status("[.data.running, .data.hold_sources]"), "[false,[]]\n", "what was stopped does not go on");
}

#[test]
fn interrupted_during_a_move_with_on_interrupt_leave() {
    let workspace = Workspace::new();
    let simulator = Simulator::start("yerc", None);
    let line = [
        "-t",
        &simulator.target,
        "--yes",
        "--on-interrupt",
        "leave",
        "yerc",
        "move",
        "relative",
        "--z",
        "-600",
        "--speed",
        "1mm/s",
        "--json",
    ];
    let mut child = spawn(workspace.armctl(&line));
    wait(&workspace, &simulator, ".data.running");
    interrupt(&child, "INT");
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let error: Value = serde_json::from_str(&read_output(&mut child)).expect("one line of JSON");
    assert_eq!(error["error"]["exit"], 130);
    let output = workspace
        .armctl(&["-t", &simulator.target, "yerc", "status", "--jq", ".data.running"])
        .output()
        .expect("it runs");
    assert_eq!(String::from_utf8_lossy(&output.stdout), "true\n");
}

#[test]
fn interrupted_while_points_are_stored() {
    let workspace = Workspace::new();
    let rows: String = (1..=999).map(|point| format!("{point},{point},0,0,0\n")).collect();
    std::fs::write(workspace.path().join("many.csv"), format!("name,x_mm,y_mm,z_mm,r_mm\n{rows}")).expect("a file");
    // At this baud rate, the command takes half a minute.
    let line = ["-t", "sim:?baud=115200", "-vv", "toyo", "point", "restore", "many.csv", "--task", "2"];
    let line = [&line[..], &["--jq", "[.data.items[] | select(.written)] | length"]].concat();
    let mut child = spawn(workspace.armctl(&line));
    let mut stderr = BufReader::new(child.stderr.take().expect("stderr is a pipe")).lines().map_while(Result::ok);
    assert!(stderr.any(|line| line.contains("@WPAR T1 PT=003")));
    interrupt(&child, "INT");
    let rest: Vec<String> = stderr.collect();
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    let orders = rest.iter().filter_map(|line| line.strip_prefix("-> ")?.split("  #").next()).rev();
    // Reads of the status are left out: before a write, they check that the line is idle.
    let orders: Vec<&str> = orders.filter(|order| !order.starts_with("@STAS")).take(2).collect();
    assert_eq!(orders, ["@HSOF", "@CTSK TASK=01"], "what was changed for a while is put back");
    let mut written = String::new();
    child.stdout.take().expect("stdout is a pipe").read_to_string(&mut written).expect("it is read");
    let written: i64 = written.trim().parse().expect("a number");
    assert!((2..900).contains(&written), "{written} points are said to be written");
}

#[test]
fn server_prints_its_address_and_ends_on_a_signal() {
    let workspace = Workspace::new();
    for signal in ["INT", "TERM"] {
        let mut child = spawn(workspace.armctl(&["sim", "yerc", "--bind", "127.0.0.1:0", "--json"]));
        let line = first_line(&mut child);
        json::format_value(&line);
        let envelope: Value = serde_json::from_str(&line).expect("an envelope");
        let target = envelope["data"]["target"].as_str().expect("a URL");
        assert!(workspace.armctl(&["-t", target, "yerc", "status"]).output().expect("it runs").status.success());
        interrupt(&child, signal);
        assert_eq!(child.wait().expect("it ends").code(), Some(0), "this is how one ends a server");
        assert_eq!(read_output(&mut child), "");
    }
}

/// Waits until this filter is true for the status of a controller.
fn wait(workspace: &Workspace, simulator: &Simulator, until: &str) {
    let target = simulator.target.as_str();
    let line = ["-t", target, "yerc", "status", "--watch", "5ms", "--until", until, "--for", "1m"];
    let output = workspace.armctl(&line).output().expect("it runs");
    assert!(output.status.success(), "{until}: {output:?}");
}

fn spawn(mut command: Command) -> Child {
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts")
}

/// The first line on stdout. The test reads nothing after it.
fn first_line(child: &mut Child) -> String {
    let mut line = String::new();
    BufReader::new(child.stdout.take().expect("stdout is a pipe")).read_line(&mut line).expect("a line");
    line
}

/// Reads stderr to its end.
fn read_output(child: &mut Child) -> String {
    let mut text = String::new();
    let Some(mut stderr) = child.stderr.take() else { return text };
    stderr.read_to_string(&mut text).expect("UTF-8");
    text
}

fn interrupt(child: &Child, signal: &str) {
    let sent = Command::new("kill").args(["-s", signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
}

/// A command that writes a file leaves no partial file, whenever it is ended. It also removes the partial files of
/// earlier runs.
#[test]
fn leaves_no_partial_files() {
    let home = tempfile::tempdir().expect("there is room for a folder");
    let folder = home.path().join(".config/armctl");
    std::fs::create_dir_all(&folder).expect("a folder");
    let armctl = |words: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", home.path()).current_dir(home.path()).args(words.split(' '));
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    };
    let drafts = |folder: &Path| {
        let names = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").file_name());
        names.filter(|name| name.to_string_lossy().ends_with(".part")).count()
    };
    for number in 0..40 {
        let mut child = spawn(armctl(&format!("robots add r{number} udp://127.0.0.1")));
        // Each run ends the command at a different time.
        thread::sleep(std::time::Duration::from_millis(number / 2));
        let _gone = Command::new("kill").args(["-TERM", &child.id().to_string()]).stderr(Stdio::null()).status();
        child.wait().expect("it ends");
        assert_eq!(drafts(&folder), 0, "after {} ms", number / 2);
    }
    std::fs::write(folder.join(".armctl-dead.part"), "half").expect("written");
    std::fs::write(home.path().join(".armctl-dead.part"), "half").expect("written");
    assert!(armctl("robots list").status().expect("it runs").success());
    assert!(armctl("robots add desk sim: --family yerc").status().expect("it runs").success());
    let check = armctl("robots check desk").output().expect("it runs");
    assert_eq!((drafts(&folder), drafts(home.path())), (0, 0), "{}", String::from_utf8_lossy(&check.stderr));
}

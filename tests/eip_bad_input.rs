//! Runs the binary with faulty boards: wrong numbers in the URL, an existing owner, a target that is silent, resets
//! connections, or sends invalid answers. Each case has its message, hint and exit code.
#![cfg(unix)]
#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Shutdown, TcpListener, TcpStream, UdpSocket};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Arc, Mutex};
use std::thread;

use serde_json::Value;

fn armctl(target: &str, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env_clear().stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.args(["-t", target, "--timeout", "400ms", "--json", "-q", "--yes"]).args(line.split(' '));
    command
}

/// Exit code, kind, code, message and hint of a failure. The failure must be the only output.
fn error_of(target: &str, line: &str) -> (i32, String, String, String, String) {
    let Output { status, stdout, stderr } = armctl(target, line).output().unwrap();
    let stderr = String::from_utf8(stderr).unwrap();
    assert!(stdout.is_empty() && stderr.lines().count() == 1, "{line}: {stderr}");
    let envelope: Value = serde_json::from_str(&stderr).unwrap();
    let text = |key: &str| envelope["error"][key].as_str().unwrap_or_default().to_owned();
    let message = text("message").replace(&format!("{target}: "), "");
    assert_eq!(envelope["error"]["exit"].as_i64(), status.code().map(i64::from));
    (status.code().unwrap(), text("kind"), text("code"), message, text("hint"))
}

/// Asserts all parts of a failure except its kind.
#[track_caller]
fn assert_error(target: &str, line: &str, exit: i32, code: &str, message: &str, hint: &str) {
    let (found_exit, _, found_code, found_message, found_hint) = error_of(target, line);
    let found = (found_exit, &*found_code, &*found_message, &*found_hint);
    assert_eq!(found, (exit, code, message, hint), "{line} on {target}");
}

/// `armctl sim yrcx` on free ports. The process ends with the test.
struct Board {
    process: Child,
    target: String,
}

impl Board {
    fn start(arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().args(["sim", "yrcx", "--bind", "127.0.0.1:0", "--jq", ".data.target"]).args(arguments);
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut target = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut target).unwrap();
        Self { process, target: target.trim_end().to_owned() }
    }

    fn start_with(&self, query: &str) -> String {
        format!("{}?{query}", self.target)
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        // The process may have ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

const SIZE: &str = "set the sizes that a probe of the target finds";

#[test]
fn reports_wrong_instance_numbers() {
    let board = Board::start(&[]);
    let point = "swap `in=` and `out=` in the URL, or probe the target to find its assemblies";
    for (query, code, message, hint) in [
        (
            "in_size=50",
            "0x0109",
            "ForwardOpen was refused: invalid connection size (0x01/0x0109), the correct size is 50 bytes",
            SIZE,
        ),
        (
            "out_size=50",
            "0x0109",
            "ForwardOpen was refused: invalid connection size (0x01/0x0109), the correct size is 54 bytes",
            SIZE,
        ),
        ("in=101", "0x0117", "ForwardOpen was refused: invalid connection point (0x01/0x0117)", point),
        ("out=151", "0x0117", "ForwardOpen was refused: invalid connection point (0x01/0x0117)", point),
        ("in=150&out=100", "0x0117", "ForwardOpen was refused: invalid connection point (0x01/0x0117)", point),
    ] {
        assert_error(&board.start_with(query), "yrcx info servo", 3, code, message, hint);
    }
    for (query, code, part) in [
        ("config=9", "0x0118", "invalid configuration"),
        ("rpi=1ms", "0x0111", "RPI"),
        ("rpi=9s", "0x0111", "RPI"),
        ("key=1:0:0", "0x0114", "vendor"),
        ("key=636:12:0", "0x0115", "device type"),
        ("key=636:43:5:9.1", "0x0116", "revision"),
        ("role=listen_only&out=237", "0x0119", "no controlling connection"),
    ] {
        let (exit, kind, found, message, hint) = error_of(&board.start_with(query), "yrcx info servo");
        assert_eq!((exit, &*kind, &*found), (3, "refused", code), "{query}: {message}");
        assert!(message.contains(part) && !hint.is_empty(), "{query}: {message}; {hint}");
    }
    // The board still works after this.
    assert!(armctl(&board.target, "yrcx info servo").output().unwrap().status.success());
}

#[test]
fn monitor_connections_report_the_same_errors() {
    let board = Board::start(&[]);
    let (exit, _, _, message, hint) = error_of(&board.start_with("in=101"), "yrcx io get");
    assert_eq!(exit, 3);
    assert!(message.contains("to a read-only client") && hint.contains("role=input_only"), "{message}; {hint}");
    let hint = "check `in=` and `in_size=` in the URL; use `armctl yrcx eip probe` to find the values";
    assert_error(&board.start_with("in=1"), "yrcx io get", 5, "", "the input assembly has 0 bytes, not 48", hint);
    assert_error(
        &board.start_with("in_size=50"),
        "yrcx status",
        5,
        "",
        "the input assembly has 48 bytes, not 50",
        hint,
    );
}

#[test]
fn reports_an_existing_owner() {
    let board = Board::start(&[]);
    let mut owner = armctl(&board.target, "yrcx info servo --watch 1h").spawn().unwrap();
    BufReader::new(owner.stdout.take().unwrap()).lines().next().unwrap().unwrap();
    assert_error(
        &board.target,
        "yrcx info servo",
        3,
        "0x0106",
        "another master, such as a PLC, commands the controller: ForwardOpen was refused: ownership conflict (0x01/0x0106)",
        "stop the owner's connection first: remove the controller from the PLC's scan list, or close the session. \
         `armctl yrcx io get` and `armctl yrcx status` can read the signals at the same time",
    );
    let (exit, _, code, message, _) =
        error_of(&board.target, &format!("yrcx eip set 4 150 3 {} --yes", "00".repeat(48)));
    assert_eq!((exit, &*code), (3, "0x0c"), "{message}");
    let found = armctl(&board.target, "robots check").output().unwrap();
    let found: Value = serde_json::from_slice(&found.stdout).unwrap();
    let state = |name: &str| {
        let layers = found["data"]["layers"].as_array().unwrap();
        layers.iter().find(|layer| layer["layer"] == name).unwrap()["state"].clone()
    };
    assert_eq!((state("owner"), state("inputs"), found["ok"].clone()), ("warning".into(), "ok".into(), true.into()));
    let sent = Command::new("kill").args(["-s", "INT", &owner.id().to_string()]).status().unwrap();
    assert!(sent.success());
    assert_eq!(owner.wait().unwrap().code(), Some(130));
}

/// State of the layer `owner` in `robots check`, and the owner in the report of `yrcx eip probe`, without and with
/// `--try`.
fn owner(target: &str) -> (Value, Value, Value) {
    let data = |line: &str| {
        let output = armctl(target, line).output().unwrap();
        serde_json::from_slice::<Value>(&output.stdout).unwrap()["data"].clone()
    };
    let checked = data("robots check");
    let layers = checked["layers"].as_array().unwrap();
    let layer = layers.iter().find(|layer| layer["layer"] == "owner").unwrap();
    let owned = |line| data(line)["owned"].clone();
    (layer["state"].clone(), owned("yrcx eip probe"), owned("yrcx eip probe --try"))
}

#[test]
fn finds_the_owner_from_a_single_report() {
    // A read shows the state that the board reports. Only `--try` shows what the board refuses.
    for (fault, is_said) in [("trailing", true), ("unowned", false)] {
        let board = Board::start(&["--fault", fault]);
        assert_eq!(owner(&board.target), ("ok".into(), false.into(), false.into()), "{fault}");
        let mut holder = armctl(&board.target, "yrcx info servo --watch 1h").spawn().unwrap();
        BufReader::new(holder.stdout.take().unwrap()).lines().next().unwrap().unwrap();
        let (exit, _, code, message, _) = error_of(&board.target, "yrcx info servo");
        assert_eq!((exit, &*code), (3, "0x0106"), "{fault}: {message}");
        let layer = if is_said { "warning" } else { "ok" };
        assert_eq!(owner(&board.target), (layer.into(), is_said.into(), true.into()), "{fault}");
        let sent = Command::new("kill").args(["-s", "INT", &holder.id().to_string()]).status().unwrap();
        assert!(sent.success());
        assert_eq!(holder.wait().unwrap().code(), Some(130));
    }
}

/// Relays connections to a board, one after the other. Records the bytes from the clients.
fn recorded(board: &Board) -> (String, Arc<Mutex<Vec<u8>>>) {
    let (_, place) = board.target.split_once("://").unwrap();
    let board = place.split('?').next().unwrap().to_owned();
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("eip://{}", listener.local_addr().unwrap());
    let sent = Arc::new(Mutex::new(Vec::new()));
    let record = Arc::clone(&sent);
    thread::spawn(move || {
        for mut client in listener.incoming().map_while(Result::ok) {
            let mut server = TcpStream::connect(&board).unwrap();
            let (mut from, mut to) = (server.try_clone().unwrap(), client.try_clone().unwrap());
            thread::spawn(move || {
                // Either end may close the connection first.
                let _ = std::io::copy(&mut from, &mut to);
                let _ = to.shutdown(Shutdown::Both);
            });
            let mut buffer = [0; 4096];
            while let Ok(len @ 1..) = client.read(&mut buffer) {
                record.lock().unwrap().extend(&buffer[..len]);
                if server.write_all(&buffer[..len]).is_err() {
                    break;
                }
            }
            let _ = server.shutdown(Shutdown::Both);
        }
    });
    (target, sent)
}

/// A client that opens an owner connection takes control of the board. Therefore, monitoring commands must never
/// request such a connection.
#[test]
fn only_try_requests_an_owner_connection() {
    let board = Board::start(&[]);
    let (target, sent) = recorded(&board);
    let opens = || {
        let sent = std::mem::take(&mut *sent.lock().unwrap());
        // ForwardOpen and LargeForwardOpen requests to the connection manager (volume 1, 3-5.5.2).
        [0x54, 0x5B].map(|service| sent.windows(6).filter(|bytes| **bytes == [service, 2, 0x20, 6, 0x24, 1]).count())
    };
    for line in ["yrcx eip probe", "robots check", "yrcx eip identity", "yrcx status"] {
        assert!(armctl(&target, line).output().unwrap().status.success(), "{line}");
        assert_eq!(opens(), [0, 0], "{line}");
    }
    let unconfirmed = armctl(&target, "yrcx eip probe --try").args(["--dry-run"]).output().unwrap();
    assert_eq!((unconfirmed.status.code(), opens()), (Some(0), [0, 0]));
    let mut unconfirmed = Command::new(env!("CARGO_BIN_EXE_armctl"));
    unconfirmed.env_clear().stdin(Stdio::null()).args(["-t", &target, "yrcx", "eip", "probe", "--try"]);
    assert_eq!((unconfirmed.output().unwrap().status.code(), opens()), (Some(7), [0, 0]));
    assert!(armctl(&target, "yrcx eip probe --try").output().unwrap().status.success());
    assert!(opens()[0] > 0);
}

#[test]
fn serializes_concurrent_connections() {
    let board = Board::start(&[]);
    let mut connections = Vec::new();
    for _ in 0..30 {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        connections.push(command.args(["-t", &board.target, "--timeout", "20s", "yrcx", "status"]).spawn().unwrap());
    }
    for look in connections {
        let output = look.wait_with_output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

const NO_ADDRESS: &str = "check the address; check that the controller is on, and that its EtherNet/IP board is \
                          enabled";

#[test]
fn reports_faults_of_the_board() {
    const LINK: &str = "check the connection: use `-v` to count received packets";
    for (fault, line, message, hint) in [
        ("mute", "yrcx info servo", "no answer to RegisterSession within 400 ms", NO_ADDRESS),
        ("mute", "yrcx io get", "no answer to RegisterSession within 400 ms", NO_ADDRESS),
        ("reset", "yrcx info servo", "the TCP connection ended before the answer to ForwardOpen", NO_ADDRESS),
        (
            "reset",
            "yrcx io get",
            "the TCP connection ended before the answer to Get_Attribute_Single of the input assembly",
            NO_ADDRESS,
        ),
        (
            "frozen",
            "yrcx info servo",
            "no answer to servo-status: the controller did not start the command",
            "use `armctl yrcx status` to see the state of the controller",
        ),
        ("stall", "yrcx info servo", "the controller sends no data", LINK),
        ("wrong-id", "yrcx info servo", "the controller sends no data", LINK),
        ("wrong-size", "yrcx info servo", "the controller sends no data", LINK),
    ] {
        assert_error(&Board::start(&["--fault", fault]).target, line, 4, "", message, hint);
    }
    for line in ["yrcx info servo", "yrcx io get", "yrcx eip get 4 100 3"] {
        let (exit, _, _, message, hint) = error_of(&Board::start(&["--fault", "garbage"]).target, line);
        assert!(exit == 5 && message.contains("cannot decode"), "{line}: {exit} {message}");
        assert_eq!(hint, "check that this is the address of an EtherNet/IP device");
    }
    // The client skips duplicate images and images with an old or wrong counter. If all images are skipped, the board
    // counts as silent.
    for (fault, works) in [("double", true), ("half-rate", true), ("stale", false), ("wrong-sequence", false)] {
        let board = Board::start(&["--fault", fault]);
        let output = armctl(&board.target, "yrcx info servo").output().unwrap();
        assert_eq!(output.status.success(), works, "{fault}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(works || output.status.code() == Some(4), "{fault}");
    }
}

#[test]
fn never_repeats_a_change_whose_answer_is_lost() {
    let board = Board::start(&["--fault", "frozen"]);
    let (exit, kind, _, message, hint) = error_of(&board.target, "yrcx motor off --yes");
    assert_eq!((exit, &*kind), (6, "outcome_unknown"), "{message}");
    assert_eq!(hint, "use `armctl yrcx status` to see whether servos and motor power are on");
    // The old value is read first. Without an answer to this read, nothing is written.
    let board = Board::start(&["--fault", "reset"]);
    let (exit, kind, _, message, _) = error_of(&board.target, "yrcx eip set 0xF5 1 3 0200");
    assert_eq!((exit, &*kind), (4, "no_answer"), "{message}");
    assert!(message.ends_with("nothing was written"), "{message}");
    let board = Board::start(&["--fault", "reset-set"]);
    let (exit, kind, _, message, hint) = error_of(&board.target, "yrcx eip set 0xF5 1 3 0200");
    assert_eq!((exit, &*kind), (6, "outcome_unknown"), "{message}");
    assert_eq!(
        message,
        "the request was sent once, and the result is unknown: the TCP connection ended before the answer to Set_Attribute_Single"
    );
    assert_eq!(hint, "read the value with `armctl yrcx eip get 0xf5 1 3`");
}

/// A TCP server that calls `serve` for each connection. The server ends with the process.
fn other_server(serve: fn(TcpStream)) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let target = format!("eip://{}", listener.local_addr().unwrap());
    thread::spawn(move || {
        for stream in listener.incoming().map_while(Result::ok) {
            serve(stream);
        }
    });
    target
}

#[test]
fn reports_a_target_that_is_not_a_board() {
    let http = other_server(|mut stream| {
        // The client may have disconnected.
        let _ = stream.write_all(b"HTTP/1.1 400 Bad Request\r\nConnection: close\r\n\r\n");
        let _ = stream.read(&mut [0; 64]);
    });
    let closes = other_server(drop);
    let silent = other_server(std::mem::forget);
    for line in ["yrcx info servo", "yrcx io get", "yrcx eip identity", "status", "yrcx eip set 0xF5 1 3 00"] {
        for target in [&http, &closes, &silent] {
            let (exit, kind, _, message, hint) = match line {
                // `status` reports an unreachable address as a result.
                "status" => {
                    let output = armctl(target, line).output().unwrap();
                    let envelope: Value = serde_json::from_slice(&output.stdout).unwrap();
                    let text = |key: &str| envelope["error"][key].as_str().unwrap().to_owned();
                    assert_eq!(envelope["data"]["reachable"], false);
                    (output.status.code().unwrap(), text("kind"), String::new(), text("message"), text("hint"))
                }
                _ => error_of(target, line),
            };
            assert_eq!((exit, &*kind, &*hint), (4, "no_answer", NO_ADDRESS), "{line} on {target}: {message}");
        }
    }
    assert_error("eip://127.0.0.1:1", "yrcx io get", 4, "", "no TCP connection: connection refused", NO_ADDRESS);
    let hint = "check the name, or use the address of the controller";
    assert_error("eip://board.invalid", "yrcx io get", 4, "", "cannot find host 'board.invalid'", hint);
}

/// An answer to ListIdentity (volume 2, 2-4.2) with a product name that would clear a terminal.
fn hostile_identity(context: &[u8]) -> Vec<u8> {
    let name = b"\x1b[2J\x07evil\r\n\"<&\xff";
    let mut item = [&[1, 0][..], &[0, 2, 0xAF, 0x12, 10, 0, 0, 9], &[0; 8]].concat();
    item.extend([0x7C, 0x02, 43, 0, 5, 0, 1, 2, 0x30, 0, 0x40, 0xE2, 1, 0]);
    item.push(u8::try_from(name.len()).unwrap());
    item.extend(name);
    item.push(3);
    let data = [&[1, 0, 0x0C, 0][..], &u16::try_from(item.len()).unwrap().to_le_bytes(), &item].concat();
    let len = u16::try_from(data.len()).unwrap().to_le_bytes();
    [&[0x63, 0][..], &len, &[0; 8], context, &[0; 4], &data].concat()
}

#[test]
fn escapes_the_identity_of_unknown_devices() {
    let socket = UdpSocket::bind("127.0.0.1:0").unwrap();
    let address = socket.local_addr().unwrap().to_string();
    thread::spawn(move || {
        let mut buffer = [0; 64];
        while let Ok((24.., from)) = socket.recv_from(&mut buffer) {
            let context = buffer[12..20].to_vec();
            socket.send_to(b"nonsense", from).unwrap();
            socket.send_to(&hostile_identity(&context), from).unwrap();
        }
    });
    let discover = |format: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().args(["robots", "discover", &address, "--wait", "20s", "-o", format]);
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    for format in ["table", "csv", "json"] {
        let text = discover(format);
        assert!(text.contains("evil") && !text.chars().any(|c| c.is_control() && c != '\n'), "{text:?}");
    }
    let found: Value = serde_json::from_str(&discover("json")).unwrap();
    let board = &found["data"]["boards"][0];
    assert_eq!((&board["family"], &board["serial"]), (&"yrcx".into(), &"0x0001e240".into()));
    assert_eq!((&board["revision"], &board["state"]), (&"1.002".into(), &"operational".into()));
    assert_eq!(board["target"], format!("eip://{address}"), "where it answers counts, not what it says");
}

#[cfg(target_os = "linux")]
#[test]
fn discovers_all_devices_of_a_network() {
    // A board that listens on all addresses receives broadcasts of the loopback network.
    let Ok(socket) = UdpSocket::bind("0.0.0.0:0") else { return println!("skipped: no port") };
    let port = socket.local_addr().unwrap().port();
    thread::spawn(move || {
        let mut buffer = [0; 64];
        while let Ok((24.., from)) = socket.recv_from(&mut buffer) {
            // The context begins with the maximum response delay in milliseconds.
            assert_eq!(buffer[12..14], 500u16.to_le_bytes());
            socket.send_to(&hostile_identity(&buffer[12..20]), from).unwrap();
        }
    });
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    let broadcast = format!("127.255.255.255:{port}");
    command.env_clear().args(["robots", "discover", "--bind", "127.0.0.1", "--broadcast", &broadcast, "--json"]);
    let output = command.args(["--wait", "400ms", "--jq", ".data.boards[].target"]).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(String::from_utf8(output.stdout).unwrap(), format!("eip://127.0.0.1:{port}\n"));
}

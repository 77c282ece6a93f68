//! Peers that send endlessly, slowly, or wrong data. A command must end in time with an error, and its memory use must
//! stay constant.

use std::io::{BufRead as _, BufReader, Write as _};
use std::net::{TcpListener, UdpSocket};
use std::process::Command;
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::Duration;

use serialport::{SerialPort as _, TTYPort};

use super::workspace::{CommandResult, Workspace, result_of};

/// How a peer sends.
#[derive(Debug, Clone, Copy)]
enum FloodKind {
    Floods,
    /// Sends single bytes or datagrams. The pause between them is much shorter than the timeout of a try.
    Trickles,
}

const MANNERS: [FloodKind; 2] = [FloodKind::Floods, FloodKind::Trickles];

impl FloodKind {
    /// Sends the text repeatedly until the peer closes the connection.
    fn send(self, text: &[u8], mut send: impl FnMut(&[u8]) -> bool) {
        match self {
            Self::Floods => while send(text) {},
            Self::Trickles => {
                let mut bytes = text.chunks(1).cycle();
                while bytes.next().is_some_and(&mut send) {
                    thread::sleep(Duration::from_millis(30));
                }
            }
        }
    }
}

/// Starts a TCP server that sends this text to each client. Returns its port.
fn tcp(text: &'static [u8], manner: FloodKind) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("an address").port();
    thread::spawn(move || {
        for mut client in listener.incoming().map_while(Result::ok) {
            thread::spawn(move || manner.send(&text.repeat(2000), |bytes| client.write_all(bytes).is_ok()));
        }
    });
    port
}

/// Starts a UDP server that answers every request with invalid data. Returns its port.
fn udp(manner: FloodKind) -> u16 {
    let socket = UdpSocket::bind("127.0.0.1:0").expect("a port");
    let port = socket.local_addr().expect("an address").port();
    thread::spawn(move || {
        while let Ok((_, asked)) = socket.recv_from(&mut [0; 600]) {
            let mut left = 100_000;
            manner.send(b"YERC", |bytes| {
                left -= 1;
                left > 0 && socket.send_to(bytes, asked).is_ok()
            });
        }
    });
    port
}

/// A serial line that sends this text until the returned handle is dropped.
fn pty(text: &'static [u8], manner: FloodKind) -> (TTYPort, String) {
    let (mut master, port) = TTYPort::pair().expect("a pseudo-terminal");
    let path = port.name().expect("it has a name");
    master.set_timeout(Duration::from_secs(3600)).expect("it waits for room");
    thread::spawn(move || manner.send(&text.repeat(20), |bytes| master.write_all(bytes).is_ok()));
    (port, path)
}

/// Runs a line with limited memory and a time limit of one minute.
fn run(desk: &Workspace, target: &str, line: &str) -> CommandResult {
    let armctl = env!("CARGO_BIN_EXE_armctl");
    let line = format!("ulimit -v 900000; exec timeout 60 {armctl} -t '{target}' --timeout 500ms --yes {line}");
    let mut command = Command::new("sh");
    command.env_clear().env("PATH", "/usr/bin:/bin").env("HOME", desk.folder.path()).args(["-c", &line]);
    result_of(&command.output().expect("it runs"))
}

#[test]
fn gives_up_a_flooding_slcan_adapter() {
    let desk = Workspace::new("");
    for text in [&b"t4058AABBCCDDEEFF0011\r"[..], b"t42b8AABBCCDDEEFF0011\r", b"\r", b"t"] {
        let target = format!("slcan://127.0.0.1:{}?mac=5", tcp(text, FloodKind::Floods));
        for line in ["yrcx devicenet identity", "yrcx status", "yrcx stop"] {
            let result = run(&desk, &target, line);
            assert!(
                result.exit == Some(5) && result.stderr.contains("sends data without a pause"),
                "{line}: {result:?}"
            );
        }
    }
}

#[test]
fn flooding_and_trickling_peers_do_not_block_commands() {
    let desk = Workspace::new("");
    let check = |target: &str, cases: &[(&str, i32, &str)]| {
        for (line, exit, part) in cases {
            let came = run(&desk, target, line);
            assert!(came.exit == Some(*exit) && came.stderr.contains(part), "{target}: {line}: {came:?}");
        }
    };
    for manner in MANNERS {
        check(
            &format!("udp://127.0.0.1:{}", udp(manner)),
            &[("yerc status", 5, "within 1.8s"), ("yerc hold on", 6, "armctl cannot confirm that the robot is held")],
        );
        for text in [&b"\0"[..], b"\x6f\0\xff\0"] {
            let silent = [("yrcx status", 4, "within 500 ms"), ("yrcx stop", 4, "within 500 ms")];
            check(&format!("eip://127.0.0.1:{}", tcp(text, manner)), &silent);
        }
        check(
            &format!("slcan://127.0.0.1:{}?mac=5", tcp(b"t4058AABBCCDDEEFF0011\r", FloodKind::Trickles)),
            // The client stops at a limit of bytes or at a time limit for the first answer, whichever comes first.
            &[("yrcx status", 5, "slcan://")],
        );
        let (_port, path) = pty(b"\x68\x05\x05", manner);
        check(&format!("profibus://{path}?station=5"), &[("yrcx status", 4, "within 3000 ms")]);
        let (_port, path) = pty(b"@OK\r\n", manner);
        check(
            &format!("serial://{path}"),
            &[("toyo position", 5, ""), ("toyo stop", 6, "it is unknown whether the robot stopped")],
        );
    }
}

/// If another program is behind the device server, the first request is tried several times. No other request is sent.
#[test]
fn sends_one_request_to_an_unknown_peer() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    let asked = Arc::new(Mutex::new(Vec::new()));
    let requests = Arc::clone(&asked);
    thread::spawn(move || {
        for mut client in listener.incoming().map_while(Result::ok) {
            let lines = BufReader::new(client.try_clone().unwrap()).lines();
            for line in lines.map_while(Result::ok) {
                requests.lock().unwrap().push(line);
                client.write_all(b"@OK\r\n").unwrap_or_default();
            }
        }
    });
    let desk = Workspace::new("");
    let came = run(&desk, &format!("tcp://127.0.0.1:{port}"), "--retries 2 toyo position");
    assert!(came.exit == Some(5) && came.stderr.contains("it answers another request"), "{came:?}");
    assert_eq!(*asked.lock().unwrap(), ["@SYSP", "@SYSP", "@SYSP"]);
}

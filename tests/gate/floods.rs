//! Peers that send without end: a command ends with an error, and its memory stays flat.

use std::io::Write as _;
use std::net::TcpListener;
use std::process::Command;
use std::thread;

use super::desk::{Desk, came};

/// A TCP server that sends this without end to each client.
fn flooding(text: &'static [u8]) -> u16 {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("an address").port();
    thread::spawn(move || {
        for mut client in listener.incoming().map_while(Result::ok) {
            thread::spawn(move || while client.write_all(&text.repeat(2000)).is_ok() {});
        }
    });
    port
}

#[test]
fn an_slcan_adapter_that_floods_is_given_up() {
    let desk = Desk::new("");
    for text in [&b"t4058AABBCCDDEEFF0011\r"[..], b"t42b8AABBCCDDEEFF0011\r", b"\r", b"t"] {
        let port = flooding(text);
        for line in ["yrcx devicenet identity", "yrcx status", "yrcx stop"] {
            let armctl = env!("CARGO_BIN_EXE_armctl");
            let line = format!(
                "ulimit -v 600000; exec timeout 60 {armctl} -t 'slcan://127.0.0.1:{port}?mac=5' --timeout 500ms {line}"
            );
            let mut command = Command::new("sh");
            command.env_clear().env("PATH", "/usr/bin:/bin").env("HOME", desk.folder.path()).args(["-c", &line]);
            let came = came(&command.output().expect("it runs"));
            assert!(came.exit == Some(5) && came.stderr.contains("sends without end"), "{line}: {came:?}");
        }
    }
}

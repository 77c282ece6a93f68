//! Other programs between `armctl` and the simulated Toyo controller. `socat` makes a serial port from a TCP
//! connection, and `ser2net` makes a TCP port from a serial port. Both pass bytes like adapters and device servers do.
//!
//! If a program is absent, its test prints a message and passes. With `CI=true`, the program must be present.

#![expect(clippy::unwrap_used, reason = "helpers of tests fail by panicking")]
#![expect(clippy::print_stdout, reason = "a test that is skipped says so")]

use std::io::{BufRead as _, BufReader};
use std::net::{Ipv4Addr, SocketAddr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc;

use armctl_toyo::simulated::{self, Simulated};
use armctl_transport::stream_server::StreamServer;
use serde_json::Value;

/// A process that ends with the test.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // The process may already have ended.
        self.0.kill().unwrap_or_default();
        self.0.wait().unwrap();
    }
}

/// Type of the connection to a simulated controller.
enum ConnectionType {
    Tcp,
    PseudoTerminal,
}

/// Serves a simulated controller until the process ends. Returns the address of the controller, or the path of its
/// port.
fn serve(connection: ConnectionType) -> String {
    let (sender, target) = mpsc::channel();
    std::thread::spawn(move || {
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            let (mut server, name) = match connection {
                ConnectionType::Tcp => {
                    let any = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
                    let (server, address) = StreamServer::tcp(any, None, None).await.unwrap();
                    (server, address.to_string())
                }
                ConnectionType::PseudoTerminal => StreamServer::pseudo_terminal(None, None).unwrap(),
            };
            let mut controller = Simulated::new(simulated::start(None, None, None, None).unwrap());
            sender.send(name).unwrap();
            loop {
                server.turn(&mut controller).await.unwrap();
            }
        });
    });
    target.recv().unwrap()
}

/// Whether a program is installed. In CI, the program must be installed.
fn is_installed(program: &str, ask: &str) -> bool {
    let asked = Command::new(program).arg(ask).stdout(Stdio::null()).stderr(Stdio::null()).status();
    let is_there = asked.is_ok();
    assert!(is_there || std::env::var_os("CI").is_none(), "{program} must be there in CI");
    if !is_there {
        println!("skipped: {program} is not installed");
    }
    is_there
}

/// `data` of a command line that must succeed.
#[track_caller]
fn data(target: &str, words: &[&str]) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_armctl"))
        .args(["--json", "--yes", "-t", target, "toyo"])
        .args(words)
        .env_clear()
        .env("HOME", folder.path())
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?} over {target}: {errors}");
    let envelope: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(envelope["simulated"], false);
    envelope["data"].clone()
}

/// Runs typical first commands of a technician over the connection.
fn assert_commands_work(target: &str) {
    assert_eq!(data(target, &["status"])["homed"], false);
    data(target, &["home"]);
    let status = data(target, &["status"]);
    assert_eq!((&status["homed"], &status["host_on"]), (&true.into(), &false.into()), "{status}");
    data(target, &["point", "set", "1", "100", "20", "0", "0"]);
    let point = &data(target, &["point", "get", "1"])["items"][0]["value"];
    assert_eq!((&point["x_mm"], &point["y_mm"]), (&100.0.into(), &20.0.into()), "{point}");
    data(target, &["param", "set", "M10", "P"]);
    data(target, &["run", "point", "1"]);
    let place = &data(target, &["position"])["positions"][0];
    assert_eq!((&place["x_mm"], &place["y_mm"]), (&100.0.into(), &20.0.into()), "{place}");
}

#[test]
fn commands_work_through_socat() {
    if !is_installed("socat", "-V") {
        return;
    }
    let address = serve(ConnectionType::Tcp);
    let folder = tempfile::tempdir().unwrap();
    let port = folder.path().join("port");
    let terminal = format!("pty,raw,echo=0,link={}", port.display());
    let mut socat = Command::new("socat")
        .args(["-d", "-d", &terminal, &format!("tcp:{address}")])
        .stderr(Stdio::piped())
        .spawn()
        .map(Running)
        .unwrap();
    // socat prints this line when both ends are open.
    let stderr = BufReader::new(socat.0.stderr.take().unwrap());
    let mut lines = stderr.lines();
    assert!(lines.by_ref().any(|line| line.unwrap().contains("starting data transfer")), "socat ended");
    std::thread::spawn(move || lines.for_each(drop));
    assert_commands_work(&format!("serial://{}", port.display()));
}

#[test]
fn commands_work_through_ser2net() {
    if !is_installed("ser2net", "-v") {
        return;
    }
    let terminal = serve(ConnectionType::PseudoTerminal);
    let port = free_port();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ser2net.yaml");
    let lines = [
        "connection: &toyo".to_owned(),
        format!("  accepter: tcp,127.0.0.1,{port}"),
        format!("  connector: serialdev,{terminal},9600e81,local"),
    ];
    std::fs::write(&file, lines.join("\n") + "\n").unwrap();
    let _running = start_ser2net(&file);
    // ser2net prints nothing when it starts to listen.
    while TcpStream::connect((Ipv4Addr::LOCALHOST, port)).is_err() {
        std::thread::yield_now();
    }
    assert_commands_work(&format!("tcp://127.0.0.1:{port}"));
}

fn start_ser2net(file: &Path) -> Running {
    let child = Command::new("ser2net")
        .args(["-n", "-d", "-c"])
        .arg(file)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    Running(child)
}

/// A free port, because `ser2net` cannot select one.
fn free_port() -> u16 {
    TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port()
}

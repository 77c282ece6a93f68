//! `top`, services, watches and commands use a link for one client at the same time. A device server before a simulated
//! controller counts simultaneous connections.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;

use serde_json::Value;

use super::{Running, Workspace, simulator, stderr};
use crate::support::terminal::Terminal;

/// A serial device server.
struct DeviceServer {
    url: String,
    /// Number of connections that were opened during another connection.
    conflicts: Arc<AtomicUsize>,
    accepted: Arc<AtomicUsize>,
}

impl DeviceServer {
    /// Starts a device server for a simulator. When a second client connects, the server closes the first connection if
    /// `evicts` is set, and otherwise the second connection.
    fn proxy(target: &str, evicts: bool) -> Self {
        let controller: SocketAddr = target.strip_prefix("tcp://").unwrap().parse().unwrap();
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let url = format!("tcp://{}", listener.local_addr().unwrap());
        let (conflicts, accepted) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicUsize::new(0)));
        let server = Self { url, conflicts: Arc::clone(&conflicts), accepted: Arc::clone(&accepted) };
        thread::spawn(move || {
            let mut before: Option<TcpStream> = None;
            for client in listener.incoming() {
                let client = client.unwrap();
                accepted.fetch_add(1, Ordering::Relaxed);
                let is_there = |client: &TcpStream| {
                    client.set_nonblocking(true).unwrap();
                    let found = client.peek(&mut [0]);
                    client.set_nonblocking(false).unwrap();
                    !matches!(found, Ok(0)) && !found.is_err_and(|error| error.kind() != std::io::ErrorKind::WouldBlock)
                };
                if before.as_ref().is_some_and(is_there) {
                    conflicts.fetch_add(1, Ordering::Relaxed);
                    if !evicts {
                        continue;
                    }
                }
                if let Some(before) = before.replace(client.try_clone().unwrap()) {
                    before.shutdown(Shutdown::Both).unwrap_or_default();
                }
                let line = connected(controller);
                forward(client.try_clone().unwrap(), line.try_clone().unwrap());
                forward(line, client);
            }
        });
        server
    }
}

/// Connects to a simulator. The simulator accepts only one connection, so this function waits until the previous
/// connection is closed.
fn connected(controller: SocketAddr) -> TcpStream {
    loop {
        let line = TcpStream::connect(controller).unwrap();
        line.set_read_timeout(Some(std::time::Duration::from_millis(20))).unwrap();
        let is_released = matches!(line.peek(&mut [0]), Ok(0));
        line.set_read_timeout(None).unwrap();
        if !is_released {
            return line;
        }
    }
}

fn forward(mut from: TcpStream, mut to: TcpStream) {
    thread::spawn(move || {
        let mut buffer = [0; 1024];
        while let Ok(length) = from.read(&mut buffer) {
            if length == 0 || to.write_all(&buffer[..length]).is_err() {
                break;
            }
        }
        to.shutdown(Shutdown::Both).unwrap_or_default();
    });
}

/// A watch that runs until it is ended, and its output lines.
struct Watch {
    running: Running,
    lines: Arc<Mutex<Vec<String>>>,
}

impl Watch {
    fn start(mut command: Command) -> Self {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let lines = Arc::new(Mutex::new(Vec::new()));
        let (stdout, printed) = (process.stdout.take().unwrap(), Arc::clone(&lines));
        thread::spawn(move || {
            BufReader::new(stdout).lines().map_while(Result::ok).for_each(|line| printed.lock().unwrap().push(line));
        });
        let stderr = BufReader::new(process.stderr.take().unwrap());
        Self { running: Running { process, stderr, first: String::new() }, lines }
    }
}

#[test]
fn monitors_share_a_link_for_one_client() {
    for evicts in [false, true] {
        let simulator = simulator(&Workspace::new(&[]), "toyo", "127.0.0.1:0");
        let server = DeviceServer::proxy(&simulator.first, evicts);
        let workspace = Workspace::new(&[("cell", "toyo", &server.url)]);
        let mut top = Terminal::start(workspace.command("top --all --watch 50ms"), 100, 30).unwrap();
        let watch = Watch::start(workspace.command("-r cell toyo position --watch 50ms -o jsonl"));
        let metrics = Watch::start(workspace.command("serve metrics --all --listen 127.0.0.1:0 --watch 50ms"));
        // `publish` polls the robots with and without a broker.
        let publish = Watch::start(workspace.command("publish mqtt://127.0.0.1:1 --all --watch 50ms"));
        let seen = |watch: &Watch| watch.lines.lock().unwrap().len();
        while seen(&watch) < 40 {
            let output = workspace.run("-r cell toyo position --json");
            assert!(output.status.success(), "{}", stderr(&output));
        }
        top.wait_for_picture("cell  toyo  answer");
        for line in &*watch.lines.lock().unwrap() {
            assert_eq!(serde_json::from_str::<Value>(line).unwrap()["ok"], true, "{line}");
        }
        assert_eq!(server.conflicts.load(Ordering::Relaxed), 0, "evicts: {evicts}");
        assert!(
            workspace.listed_sessions()["clients"].as_array().unwrap().len() >= 4,
            "{}",
            workspace.listed_sessions()
        );
        for mut watch in [watch, metrics, publish] {
            watch.running.signal("TERM");
            let mut messages = String::new();
            watch.running.stderr.read_to_string(&mut messages).unwrap();
            assert!(!messages.contains("cell ("), "it says that something was wrong: {messages}");
        }
        top.press("q");
        assert!(top.end().success());
        // A session without clients ends by itself.
        while !workspace.files("sock").is_empty() {}
    }
}

/// The lines of a prompt or command file reach the link without a socket. Other processes still share the link.
#[test]
fn other_processes_share_the_link_of_a_prompt_and_a_command_file() {
    for words in ["-r cell --yes yerc repl", "-r cell --yes batch -"] {
        let simulator = simulator(&Workspace::new(&[]), "yerc", "127.0.0.1:0");
        let workspace = Workspace::new(&[("cell", "yerc", &simulator.first)]);
        let (file, prefix) =
            (workspace.folder.path().join("lines"), if words.ends_with("repl") { "" } else { "yerc " });
        let motion = format!("{prefix}move relative --z -600 --speed 1mm/s");
        let reads = format!("{prefix}status --quiet\n").repeat(20);
        std::fs::write(&file, format!("{reads}{motion}\n{prefix}servo off\n")).unwrap();
        let mut command = workspace.command(words);
        command.stdin(std::fs::File::open(&file).unwrap());
        let holder = Running::start(command, false);
        let pid = holder.process.id();
        let mover = workspace.until(|session| session["motion"] != Value::Null)["motion"].clone();
        assert_eq!((&mover["pid"], &mover["command"]), (&pid.into(), &motion.into()));
        let read = workspace.run("-r cell yerc status -v");
        let message = stderr(&read);
        assert!(message.contains(&format!("through the session of process {pid}")), "{words}: {message}");
        super::fails(&workspace.run("-r cell --yes yerc servo on"), 7, "another client is moving the robot");
        let stop = workspace.run("-r cell yerc hold on");
        assert!(stop.status.success(), "{words}: {}", stderr(&stop));
        let (code, said) = holder.end();
        assert_eq!(code, Some(8), "{words}: {said}");
        assert!(said.contains("hold by command was switched on"), "{words}: {said}");
        assert!(workspace.files("sock").is_empty(), "{words}");
        // The lines after the motion were not sent. A status before the end can meet the end of the session.
        let status = workspace.data("-r cell yerc status");
        assert_eq!((&status["held"], &status["servo_on"]), (&true.into(), &true.into()));
    }
}

/// Without a session, commands open the link one after the other.
#[test]
fn commands_wait_for_a_link_for_one_client() {
    let simulator = simulator(&Workspace::new(&[]), "toyo", "127.0.0.1:0");
    let server = DeviceServer::proxy(&simulator.first, true);
    let workspace = Workspace::new(&[("cell", "toyo", &server.url)]);
    let asked: Vec<_> = (0..8).map(|_| Running::start(workspace.command("-r cell toyo position"), false)).collect();
    for asked in asked {
        let (code, said) = asked.end();
        assert_eq!(code, Some(0), "{said}");
    }
    assert_eq!((server.conflicts.load(Ordering::Relaxed), server.accepted.load(Ordering::Relaxed)), (0, 8));
    assert!(workspace.files("sock").is_empty(), "a command opens no session");
}

/// The server does not evict a command with a direct link. Other commands report the process of this command.
#[test]
fn names_the_process_that_holds_a_link() {
    let simulator = simulator(&Workspace::new(&[]), "toyo", "127.0.0.1:0");
    let server = DeviceServer::proxy(&simulator.first, true);
    let workspace = Workspace::new(&[("cell", "toyo", &server.url)]);
    let jog = Running::start(workspace.command("-r cell toyo jog X + low --for 60s --yes"), false);
    while server.accepted.load(Ordering::Relaxed) == 0 {}
    let blocked_command = workspace.run("-r cell toyo position");
    super::fails(
        &blocked_command,
        4,
        &format!("process {} (`armctl -r cell toyo jog X + low --for 60s --yes`) is connected", jog.process.id()),
    );
    assert_eq!(server.conflicts.load(Ordering::Relaxed), 0);
    jog.signal("INT");
    assert_eq!(jog.end().0, Some(130));
}

//! PROFIBUS with independent implementations: a strict slave in Python, and the master of the PyPI package
//! `pyprofibus`. Both run on pseudo-terminals. Without Python or the package, the tests are skipped with a message.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Output, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

use serialport::{SerialPort, TTYPort};

/// A program that prints its address on its first line. It runs until it is dropped.
struct Running {
    child: Child,
    lines: BufReader<ChildStdout>,
}

impl Running {
    fn start(command: &mut Command) -> Self {
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().expect("it starts");
        let lines = BufReader::new(child.stdout.take().expect("a pipe"));
        Self { child, lines }
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.lines.read_line(&mut line).expect("it says something");
        line.trim().to_owned()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // The program may already have ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn armctl() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env("HOME", env!("CARGO_TARGET_TMPDIR")).env_remove("XDG_CONFIG_HOME");
    command
}

fn script(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/profibus").join(name)
}

fn has_python() -> bool {
    Command::new("python3").arg("--version").output().is_ok_and(|output| output.status.success())
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn independent_strict_slave_accepts_our_master() {
    if !has_python() {
        eprintln!("skipped: python3 is not here");
        return;
    }
    let mut slave = Running::start(Command::new("python3").arg(script("slave.py")).arg("3"));
    let port = slave.line();
    let url = format!("profibus://{port}?station=5&slot=500ms&watchdog=20s");
    // This slave returns its outputs as inputs, which a controller does not do. The command therefore fails, but it
    // opens and closes the link.
    let requests =
        armctl().args(["-t", &url, "--timeout", "1s", "--yes", "yrcx", "info", "servo"]).output().expect("it runs");
    let mut output = Vec::new();
    loop {
        let line = slave.line();
        let is_last = line.starts_with("images:") || line.is_empty();
        output.push(line);
        if is_last {
            break;
        }
    }
    let ended = slave.child.wait().expect("it ends");
    assert!(ended.success(), "{output:?}\n{}", text(&requests));
    assert!(output.contains(&"state: exchanges data".to_owned()), "{output:?}");
}

#[test]
fn pyprofibus_exchanges_images_with_our_simulator() {
    let Some(folder) = std::env::var_os("ARMCTL_PROFIBUS_PEERS").map(PathBuf::from) else {
        eprintln!("skipped: ARMCTL_PROFIBUS_PEERS does not name a folder of tests/profibus/install");
        return;
    };
    let mut simulator = Running::start(armctl().args(["sim", "yrcx", "--bus", "profibus"]));
    let said = simulator.line();
    let port = said.split("profibus://").nth(1).and_then(|rest| rest.split('?').next()).expect("a port");
    let python = folder.join("profibus/bin/python");
    let driver_output = Command::new(python).arg(script("master.py")).arg(port).output().expect("it runs");
    assert!(driver_output.status.success(), "{}", text(&driver_output));
}

/// A line with three ends: slave, master and listener. One pseudo-terminal has only two ends.
struct RelayedLine {
    is_over: Arc<AtomicBool>,
    threads: Vec<JoinHandle<()>>,
    /// Number of bytes that the listener has sent.
    said: Arc<AtomicUsize>,
}

impl RelayedLine {
    /// Connects to the slave at this port. Returns the ports of the master and of the listener.
    fn connect(slave: &str) -> (Self, String, String) {
        let slave = serialport::new(slave, 115_200).open_native().expect("the simulator's port opens");
        let [(master, of_master), (other, of_other)] = [(), ()].map(|()| {
            let (near, far) = TTYPort::pair().expect("a pseudo-terminal");
            let name = far.name().expect("it has a name");
            // The port is locked while this end is open.
            drop(far);
            (near, name)
        });
        let shared_state = |port: &TTYPort| Arc::new(Mutex::new(port.try_clone_native().expect("it can be cloned")));
        let (to_slave, to_master, to_other) = (shared_state(&slave), shared_state(&master), shared_state(&other));
        let (is_over, said) = (Arc::new(AtomicBool::new(false)), Arc::new(AtomicUsize::new(0)));
        let counted = Arc::clone(&said);
        let copy = |mut from: TTYPort, to: Vec<Arc<Mutex<TTYPort>>>, count: Option<Arc<AtomicUsize>>| {
            let is_over = Arc::clone(&is_over);
            from.set_timeout(Duration::from_millis(10)).expect("a time-out");
            std::thread::spawn(move || {
                let mut buffer = [0; 512];
                while !is_over.load(Ordering::SeqCst) {
                    // A read fails while the other end is closed.
                    let len = from.read(&mut buffer).unwrap_or(0);
                    if len == 0 {
                        std::thread::yield_now();
                    }
                    if let Some(count) = &count {
                        count.fetch_add(len, Ordering::SeqCst);
                    }
                    for port in &to {
                        let _ = port.lock().expect("nobody panics with it").write_all(&buffer[..len]);
                    }
                }
            })
        };
        let threads = vec![
            copy(slave, vec![to_master, Arc::clone(&to_other)], None),
            copy(master, vec![to_slave, to_other], None),
            copy(other, Vec::new(), Some(counted)),
        ];
        (Self { is_over, threads, said }, of_master, of_other)
    }
}

impl Drop for RelayedLine {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::SeqCst);
        for thread in self.threads.drain(..) {
            // If the thread panicked, it has already printed its message.
            let _ = thread.join();
        }
    }
}

#[test]
fn listener_reads_images_and_sends_nothing() {
    let mut simulator = Running::start(armctl().args(["sim", "yrcx", "--bus", "profibus"]));
    let said = simulator.line();
    let port = said.split("profibus://").nth(1).and_then(|rest| rest.split('?').next()).expect("a port");
    let (line, master, listener) = RelayedLine::connect(port);
    let folder = tempfile::tempdir().expect("a folder");
    let run = |url: &str, arguments: &[&str]| {
        let mut command = armctl();
        command.env("XDG_RUNTIME_DIR", folder.path()).args(["-t", url]).args(arguments);
        let output = command.output().expect("it runs");
        (text(&output), output.status.code())
    };
    let owner = format!("profibus://{master}?station=5&baud=500k&slot=500ms&watchdog=60s");
    let listens = format!("profibus://{listener}?station=5&baud=500k&role=listen");
    let opened = run(&owner, &["--yes", "session", "open", "--background"]);
    assert_eq!(opened.1, Some(0), "{opened:?}");
    for (shown, expected) in [("on", "emergency-stop    off"), ("off", "cpu-ok            on")] {
        let set = run(&owner, &["yrcx", "io", "set", &format!("20={shown}")]);
        assert_eq!(set.1, Some(0), "{set:?}");
        let seen = run(&listens, &["yrcx", "io", "get"]);
        assert!(seen.0.contains(expected) && seen.1 == Some(0), "{seen:?}");
    }
    let checked = run(&listens, &["robots", "check"]);
    assert!(
        checked.0.contains("armctl sends nothing") && checked.0.contains("received from the answers of the slave"),
        "{checked:?}"
    );
    let refused = run(&listens, &["--yes", "yrcx", "info", "servo"]);
    assert!(refused.0.contains("needs a connection that commands") && refused.1 == Some(2), "{refused:?}");
    let closed = run(&owner, &["session", "close"]);
    assert_eq!((closed.1, line.said.load(Ordering::SeqCst)), (Some(0), 0), "{closed:?}");
}

//! A real broker (mosquitto) as a process, a subscriber (`mosquitto_sub`), and peers that are not brokers.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread;

use tempfile::TempDir;

/// Message of a test that is skipped because there is no broker.
pub const NOT_INSTALLED: &str = "skipped: mosquitto and mosquitto-clients are not installed";

/// Debian installs daemons in folders that are not in the user's PATH.
fn path() -> String {
    format!("{}:/usr/sbin:/sbin", std::env::var("PATH").unwrap_or_default())
}

/// Whether broker and subscriber are installed.
pub fn is_installed() -> bool {
    let is_there = |name: &str| {
        let ran =
            Command::new(name).env("PATH", path()).arg("--help").stdout(Stdio::null()).stderr(Stdio::null()).status();
        ran.is_ok()
    };
    is_there("mosquitto") && is_there("mosquitto_sub")
}

/// A broker that runs until it is dropped.
pub struct Mosquitto {
    process: Child,
    pub port: u16,
    folder: TempDir,
}

impl Mosquitto {
    /// Starts a broker without authentication. If none is installed, prints that the test is skipped.
    #[expect(clippy::print_stderr, reason = "a test that is skipped says so")]
    pub fn start_if_installed() -> Option<Self> {
        if !is_installed() {
            eprintln!("{NOT_INSTALLED}");
            return None;
        }
        Some(Self::start())
    }

    /// Starts a broker without authentication.
    pub fn start() -> Self {
        Self::with("allow_anonymous true\n", |_| {})
    }

    /// Starts a broker with these settings. `prepare` creates files in the folder of the broker. The settings refer to
    /// this folder as `FOLDER`.
    pub fn with(settings: &str, prepare: impl FnOnce(&Path)) -> Self {
        let folder = tempfile::tempdir().unwrap();
        prepare(folder.path());
        let port = free_port();
        let settings = settings.replace("FOLDER", &folder.path().display().to_string());
        let settings = format!("user root\npersistence false\nlistener {port} 127.0.0.1\n{settings}");
        std::fs::write(folder.path().join("conf"), settings).unwrap();
        let process = Self::spawn(folder.path());
        let mut broker = Self { process, port, folder };
        broker.wait();
        broker
    }

    fn spawn(folder: &Path) -> Child {
        let mut command = Command::new("mosquitto");
        command.env("PATH", path()).arg("-c").arg(folder.join("conf"));
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }

    /// Waits until the broker listens.
    fn wait(&mut self) {
        while TcpStream::connect((Ipv4Addr::LOCALHOST, self.port)).is_err() {
            assert!(self.process.try_wait().unwrap().is_none(), "the broker ended");
            thread::yield_now();
        }
    }

    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    pub fn url(&self) -> String {
        format!("mqtt://127.0.0.1:{}", self.port)
    }

    pub fn kill(&mut self) {
        self.process.kill().unwrap();
        self.process.wait().unwrap();
    }

    /// Starts the broker again, at the same address as before.
    pub fn start_again(&mut self) {
        self.process = Self::spawn(self.folder.path());
        self.wait();
    }

    /// Subscribes to these topics. Retained messages are also received.
    pub fn listen(&self, topics: &str) -> Listener {
        Listener::new(self.port, topics, "%r %t %p", &[])
    }

    /// Like [`Self::listen`], but payloads are shown as hex digits.
    pub fn listen_hex(&self, topics: &str) -> Listener {
        Listener::new(self.port, topics, "%r %t %x", &[])
    }

    /// Publishes a message as another client.
    pub fn send(&self, topic: &str, payload: &[u8], is_kept: bool) {
        let mut command = Command::new("mosquitto_pub");
        command.env("PATH", path()).args([
            "-h",
            "127.0.0.1",
            "-q",
            "1",
            "-s",
            "-t",
            topic,
            "-p",
            &self.port.to_string(),
        ]);
        if is_kept {
            command.arg("-r");
        }
        let mut process = command.stdin(Stdio::piped()).spawn().unwrap();
        process.stdin.take().unwrap().write_all(payload).unwrap();
        assert!(process.wait().unwrap().success());
    }
}

impl Drop for Mosquitto {
    fn drop(&mut self) {
        self.process.kill().unwrap_or_default();
        let _ended = self.process.wait();
    }
}

/// A subscriber.
pub struct Listener {
    process: Child,
    lines: BufReader<ChildStdout>,
}

/// A received message.
#[derive(Debug, Clone)]
pub struct ReceivedMessage {
    pub is_kept: bool,
    pub topic: String,
    pub payload: String,
}

impl Listener {
    pub fn new(port: u16, topics: &str, format: &str, more: &[&str]) -> Self {
        // `stdbuf` makes the program write each line at once. With a pipe as its output, the program would buffer
        // lines.
        let mut command = Command::new("stdbuf");
        command.env("PATH", path()).args([
            "-oL",
            "mosquitto_sub",
            "-h",
            "127.0.0.1",
            "-q",
            "1",
            "-t",
            topics,
            "-F",
            format,
            "-d",
        ]);
        command.args(["-p", &port.to_string()]).args(more);
        let mut process = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let mut lines = BufReader::new(process.stdout.take().unwrap());
        // With `-d`, the program reports its subscription.
        let mut line = String::new();
        while !line.contains("Subscribed") {
            line.clear();
            assert!(lines.read_line(&mut line).unwrap() > 0, "it never subscribed");
        }
        Self { process, lines }
    }

    /// Returns the next message.
    pub fn next(&mut self) -> ReceivedMessage {
        loop {
            let mut line = String::new();
            assert!(self.lines.read_line(&mut line).unwrap() > 0, "the broker is gone");
            // Log lines of the program begin differently and are skipped.
            let mut fields = line.trim_end().splitn(3, ' ');
            if let (Some(kept @ ("0" | "1")), Some(topic)) = (fields.next(), fields.next()) {
                let payload = fields.next().unwrap_or_default().to_owned();
                return ReceivedMessage { is_kept: kept == "1", topic: topic.to_owned(), payload };
            }
        }
    }

    /// Reads messages until one of this topic satisfies `fits`. Returns this message.
    pub fn wait_for(&mut self, topic: &str, fits: impl Fn(&str) -> bool) -> ReceivedMessage {
        loop {
            let heard = self.next();
            if heard.topic == topic && fits(&heard.payload) {
                return heard;
            }
        }
    }
}

impl Drop for Listener {
    fn drop(&mut self) {
        self.process.kill().unwrap_or_default();
        let _ended = self.process.wait();
    }
}

fn free_port() -> u16 {
    TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap().local_addr().unwrap().port()
}

/// A peer that is not a broker. It reads the first packet and sends this answer. If `closes` is set, it then closes the
/// connection; otherwise it continues to read.
pub fn hostile(answer: &'static [u8], closes: bool) -> String {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = listener.local_addr().unwrap().port();
    // The thread ends with the test.
    thread::spawn(move || {
        for stream in listener.incoming() {
            let Ok(mut stream) = stream else { return };
            thread::spawn(move || {
                let mut buffer = [0; 4096];
                let _hello = stream.read(&mut buffer);
                let _answered = stream.write_all(answer);
                while !closes && stream.read(&mut buffer).is_ok_and(|len| len > 0) {}
            });
        }
    });
    format!("mqtt://127.0.0.1:{port}")
}

/// A broker that accepts each client, and then sends this packet repeatedly until the connection closes.
pub fn flooding(packet: &'static [u8]) -> String {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = listener.local_addr().unwrap().port();
    // The thread ends with the test.
    thread::spawn(move || {
        let flood = packet.repeat(4096);
        for stream in listener.incoming() {
            let Ok(mut stream) = stream else { return };
            let taken = stream.read(&mut [0; 4096]).and_then(|_| stream.write_all(&[0x20, 2, 0, 0]));
            while taken.is_ok() && stream.write_all(&flood).is_ok() {}
        }
    });
    format!("mqtt://127.0.0.1:{port}")
}

//! A real broker (mosquitto) as a process, who listens to it (`mosquitto_sub`), and brokers that are none.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread;

use tempfile::TempDir;

/// What a test says that has no broker.
pub const ABSENT: &str = "skipped: mosquitto and mosquitto-clients are not installed";

/// Debian keeps daemons out of the way of people.
fn path() -> String {
    format!("{}:/usr/sbin:/sbin", std::env::var("PATH").unwrap_or_default())
}

/// Whether there is one on this machine.
pub fn is_there() -> bool {
    let is_there = |name: &str| {
        let ran =
            Command::new(name).env("PATH", path()).arg("--help").stdout(Stdio::null()).stderr(Stdio::null()).status();
        ran.is_ok()
    };
    is_there("mosquitto") && is_there("mosquitto_sub")
}

/// A broker, as long as it is wanted.
pub struct Mosquitto {
    process: Child,
    pub port: u16,
    folder: TempDir,
}

impl Mosquitto {
    /// One that takes everybody.
    pub fn start() -> Self {
        Self::with("allow_anonymous true\n", |_| {})
    }

    /// With these settings; `prepare` makes files in its folder, which `FOLDER` stands for in the settings.
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

    /// Until it listens.
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

    /// At the same place as before.
    pub fn start_again(&mut self) {
        self.process = Self::spawn(self.folder.path());
        self.wait();
    }

    /// Somebody who listens to these topics from now on, with what was kept before.
    pub fn listen(&self, topics: &str) -> Listener {
        Listener::new(self.port, topics, "%r %t %p", &[])
    }

    /// The same, with payloads as hex digits.
    pub fn listen_hex(&self, topics: &str) -> Listener {
        Listener::new(self.port, topics, "%r %t %x", &[])
    }

    /// Sends a message as somebody else.
    pub fn tell(&self, topic: &str, payload: &[u8], is_kept: bool) {
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

/// Somebody who listens.
pub struct Listener {
    process: Child,
    lines: BufReader<ChildStdout>,
}

/// What was heard.
#[derive(Debug, Clone)]
pub struct Heard {
    pub is_kept: bool,
    pub topic: String,
    pub payload: String,
}

impl Listener {
    pub fn new(port: u16, topics: &str, format: &str, more: &[&str]) -> Self {
        // In a pipe it would keep lines to itself.
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
        // With -d it says when it is subscribed.
        let mut line = String::new();
        while !line.contains("Subscribed") {
            line.clear();
            assert!(lines.read_line(&mut line).unwrap() > 0, "it never subscribed");
        }
        Self { process, lines }
    }

    /// The next message.
    pub fn next(&mut self) -> Heard {
        loop {
            let mut line = String::new();
            assert!(self.lines.read_line(&mut line).unwrap() > 0, "the broker is gone");
            // What it says of itself begins otherwise.
            let mut fields = line.trim_end().splitn(3, ' ');
            if let (Some(kept @ ("0" | "1")), Some(topic)) = (fields.next(), fields.next()) {
                let payload = fields.next().unwrap_or_default().to_owned();
                return Heard { is_kept: kept == "1", topic: topic.to_owned(), payload };
            }
        }
    }

    /// Messages up to the first one of this topic that fits.
    pub fn until(&mut self, topic: &str, fits: impl Fn(&str) -> bool) -> Heard {
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

/// A broker that is none: it reads what is said first, answers so, and goes on reading, or closes the connection.
pub fn hostile(answer: &'static [u8], closes: bool) -> String {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = listener.local_addr().unwrap().port();
    // It ends with the test.
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

/// A broker that takes each client, and then repeats a packet for as long as the connection is open.
pub fn flooding(packet: &'static [u8]) -> String {
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, 0)).unwrap();
    let port = listener.local_addr().unwrap().port();
    // It ends with the test.
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

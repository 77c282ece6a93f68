//! A simulated controller that runs as a process.

use std::io::{BufRead as _, BufReader};
use std::net::SocketAddr;
use std::process::{Child, Command, Stdio};

/// A simulated controller that runs until it is dropped.
pub struct Simulator {
    process: Child,
    /// URL of the controller.
    pub url: String,
}

impl Simulator {
    /// Starts a simulator of a family on a free port.
    pub fn start(family: &str) -> Self {
        Self::start_with(family, &[])
    }

    /// Starts a simulator with additional arguments.
    pub fn start_with(family: &str, arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.args(["sim", family, "-q"]).args(arguments);
        if !arguments.contains(&"--bind") && !arguments.contains(&"--pty") {
            command.args(["--bind", "127.0.0.1:0"]);
        }
        command.stdin(Stdio::null()).stdout(Stdio::piped());
        let mut process = command.spawn().expect("the simulator starts");
        let mut line = String::new();
        BufReader::new(process.stdout.take().expect("a pipe")).read_line(&mut line).expect("it says where it is");
        let at = line.find("://").expect("a URL");
        let start = line[..at].rfind(' ').map_or(0, |space| space + 1);
        Self { process, url: line[start..].trim_end().to_owned() }
    }
}

impl Simulator {
    /// Address of the controller, and the parameters of the URL.
    #[allow(dead_code, reason = "whoever stands between wants it")]
    pub fn place(&self) -> (SocketAddr, &str) {
        let (_, place) = self.url.split_once("://").expect("a URL");
        let (address, settings) = place.split_once('?').unwrap_or((place, ""));
        (address.parse().expect("an address"), settings)
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        self.process.kill().unwrap_or_default();
        let _ended = self.process.wait();
    }
}

//! Tests of the simulator from the host side, in virtual time.

mod host;
mod instructions;
mod line;
mod memory;
mod motion;
mod replay;
mod routines;
mod start;
mod survival;
mod tasks;
mod transcripts;

use std::time::Duration;

use super::trace::What;
use super::{Simulator, Start};
use crate::Now;

struct Bench {
    sim: Simulator,
    now: Now,
}

/// Maximum run time in a test.
const MAX_TEST_TIME: Duration = Duration::from_secs(3600);

impl Bench {
    fn new(toml: &str) -> Self {
        let start = Start::parse(toml).unwrap_or_else(|error| panic!("{error}"));
        Self { sim: Simulator::new(start), now: Now::ZERO }
    }

    /// A controller with host ON and known origin.
    fn ready(toml: &str) -> Self {
        Self::new(&format!("host = true\norigin = true\n{toml}"))
    }

    /// A controller with host ON, known origin, and a program in task 1.
    fn with(steps: &[&str], toml: &str) -> Self {
        let steps: Vec<String> = steps.iter().map(|step| format!("\"{step}\"")).collect();
        Self::ready(&format!("steps.1 = [{}]\n{toml}", steps.join(", ")))
    }

    /// The controller after it has run the program.
    fn ran(steps: &[&str], toml: &str) -> Self {
        let mut bench = Self::with(steps, toml);
        bench.run();
        bench
    }

    /// Sends a block and returns the answer, both without line end.
    fn ask(&mut self, block: &str) -> String {
        self.sim.receive(self.now, format!("{block}\r\n").as_bytes());
        let answer = self.sim.transmit(self.now).unwrap_or_else(|| panic!("{block}: no answer"));
        assert_eq!(self.sim.transmit(self.now), None, "{block}: one answer");
        let text = String::from_utf8(answer).unwrap();
        text.strip_suffix("\r\n").unwrap().to_owned()
    }

    #[track_caller]
    fn answers(&mut self, block: &str, answer: &str) {
        assert_eq!(self.ask(block), answer, "{block}");
    }

    #[track_caller]
    fn ok(&mut self, block: &str) {
        let answer = self.ask(block);
        assert_eq!(answer, "@OK", "{block}: {:?}", self.sim.console(self.now, "why"));
    }

    /// Asserts that the controller refuses the block for this reason.
    #[track_caller]
    fn ng(&mut self, block: &str, why: &str) {
        assert_eq!(self.ask(block), "@NG", "{block}");
        let shown_reason = self.sim.console(self.now, "why").unwrap();
        assert!(shown_reason.contains(why), "{block}: {shown_reason}");
    }

    #[track_caller]
    fn console(&mut self, line: &str) -> String {
        self.sim.console(self.now, line).unwrap_or_else(|error| panic!("{line}: {error}"))
    }

    fn pass(&mut self, ms: u64) {
        self.now += Duration::from_millis(ms);
        self.sim.advance(self.now);
    }

    /// Advances the time until nothing runs, or no event is due.
    fn rest(&mut self) {
        let end = self.now + MAX_TEST_TIME;
        while self.sim.state().executing {
            let Some(wake) = self.sim.wake().filter(|wake| *wake <= end) else { break };
            self.now = self.now.max(wake);
            self.sim.advance(self.now);
        }
    }

    /// Starts the program and runs it to its end.
    fn run(&mut self) {
        self.ok("@SPST 0001");
        self.rest();
    }

    /// Starts the program and runs it for this time.
    fn start(&mut self, ms: u64) {
        self.ok("@SPST 0001");
        self.pass(ms);
    }

    /// Continues the program and runs it to its end.
    fn resume(&mut self) {
        self.ok("@SPST 0000");
        self.rest();
    }

    fn error(&self) -> Option<u8> {
        self.sim.state().error
    }

    fn page(&mut self, page: u8) -> u8 {
        let answer = self.ask(&format!("@STAS SNO={page}"));
        let hex = answer.split("ST1=").nth(1).unwrap().split(' ').next().unwrap();
        u8::from_str_radix(hex, 16).unwrap()
    }

    #[track_caller]
    fn at(&self, place: [f64; 4]) {
        let position = self.sim.state().position;
        let near = position.iter().zip(place).all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(near, "it is at {position:?}, not {place:?}");
    }

    fn counter(&self, number: usize) -> u16 {
        self.sim.counter(number).unwrap()
    }

    fn port(&self, port: usize) -> u8 {
        self.sim.output(0, port).unwrap()
    }
}

/// The controller after a run of the program.
fn ran(steps: &[&str]) -> Bench {
    Bench::ran(steps, "")
}

/// Asserts that this error ends the program.
#[track_caller]
fn fails(steps: &[&str], code: u8) -> Bench {
    let bench = ran(steps);
    assert_eq!(bench.error(), Some(code), "{steps:?}");
    bench
}

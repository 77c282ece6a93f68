//! YRCX controllers: the simulated controller reports the images that it receives.

use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStderr, Command, Stdio};

use armctl_controller::Risk;
use armctl_controller::yrcx::image::{COMMAND_WORDS, Image};
use armctl_controller::yrcx::signal::{Side, Signal, resting};
use armctl_controller::yrcx::table::Row;
use armctl_frame::settings::target::bus::simulators;

use super::{Bench, Effect, Recorder, in_parts};

/// The state has only the data that the lines overwrite, so that a complete backup is fast.
const STATE: &str = r#"
stock = false
[points]
1 = { mm = [1.0, 2.0, 3.0, 4.0] }
2 = { mm = [1.0, 2.0, 3.0, 4.0] }
7 = { mm = [1.0, 2.0, 3.0, 4.0] }
19 = { mm = [1.0, 2.0, 3.0, 4.0] }
100 = { mm = [1.0, 2.0, 3.0, 4.0] }
[comments]
100 = "TAUGHT"
[pallets]
1 = { counts = [2, 2, 1], first = 1 }
2 = { counts = [20, 20, 1], first = 1 }
10 = { counts = [2, 2, 1], first = 1 }
[shifts]
1 = [1.0, 2.0, 3.0, 4.0]
5 = [1.0, 2.0, 3.0, 4.0]
[hands]
1 = { robot = 1, data = [1, 2, 3, 0] }
"#;

/// A simulated controller that uses one of its fieldbuses.
pub struct Controller {
    process: Child,
    output: BufReader<ChildStderr>,
    url: String,
    last_image: Image,
    _state: tempfile::TempDir,
}

impl Controller {
    /// Starts a controller on this bus. `armctl` is a command of the binary without arguments.
    pub fn start(mut armctl: Command, bus: &str, more: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let state = folder.path().join("state.toml");
        std::fs::write(&state, STATE).expect("the state is written");
        armctl.args(["sim", "yrcx", "--console", "--bus", bus, "--state"]).arg(&state).args(more);
        let pipes = armctl.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut process = pipes.spawn().expect("the simulator starts");
        let mut line = String::new();
        let mut stdout = BufReader::new(process.stdout.take().expect("a pipe"));
        stdout.read_line(&mut line).expect("it says where it is");
        let output = BufReader::new(process.stderr.take().expect("a pipe"));
        let url = line.trim_end().rsplit(' ').next().expect("a URL").to_owned();
        assert!(url.contains("://"), "{bus}: {line}");
        Self { process, output, url, last_image: resting(), _state: folder }
    }

    /// Replaces a part of the URL, because the client needs another interface than the controller.
    pub fn url_of_bus(mut self, from: &str, to: &str) -> Self {
        self.url = self.url.replace(from, to);
        self
    }

    fn type_line(&mut self, line: &str) {
        writeln!(self.process.stdin.as_mut().expect("a pipe"), "{line}").expect("it takes a line");
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        let read = self.output.read_line(&mut line).expect("it answers");
        assert_ne!(read, 0, "the simulator has ended");
        line.trim_end().to_owned()
    }

    /// Effect of the changes in an image since the previous image.
    fn effect(&mut self, entry: &str) -> Effect {
        let Some((command, signals)) = entry.strip_prefix("WI ").and_then(|entry| entry.split_once(" SI ")) else {
            // A line that is not an image reports a change of the link. The next master starts with a resting image.
            self.last_image = resting();
            return Effect::Link;
        };
        let mut image = Image::default();
        let (command_words, signal_words) = image.0.split_at_mut(COMMAND_WORDS);
        for (words, text) in [(command_words, command), (signal_words, signals)] {
            for (word, text) in words.iter_mut().zip(text.split(',')) {
                *word = u16::from_str_radix(text, 16).expect("a word");
            }
        }
        let before = std::mem::replace(&mut self.last_image, image);
        if (before, image) == (resting(), resting()) {
            return Effect::Link;
        }
        let of_command = match (image.0[0], Row::from_word(image.0[0])) {
            (0, _) => Effect::Read,
            (_, Some(row)) => effect(row.risk),
            (_, None) => Effect::Danger,
        };
        let changes = Signal::all(Side::Input).filter(|signal| signal.is_on(&image) != signal.is_on(&before));
        let of_signals = changes.map(|signal| {
            let is_at_rest_on = signal.is_on(&resting());
            if is_at_rest_on && !signal.is_on(&image) {
                Effect::Stop
            } else {
                effect(signal.risk(signal.is_on(&image)))
            }
        });
        of_signals.max().unwrap_or(Effect::Read).max(of_command)
    }
}

fn effect(risk: Risk) -> Effect {
    match risk {
        Risk::Read => Effect::Read,
        Risk::Write => Effect::Write,
        Risk::Destroy | Risk::Motion => Effect::Danger,
    }
}

impl Recorder for Controller {
    fn family(&self) -> &'static str {
        "yrcx"
    }

    fn url(&self) -> &str {
        &self.url
    }

    fn take_effect(&mut self) -> Vec<(Effect, String)> {
        self.type_line("journal");
        let count = loop {
            let line = self.line();
            if let Some(count) = line.strip_suffix(" images") {
                break count.parse::<usize>().expect("a number");
            }
        };
        let entries: Vec<String> = (0..count).map(|_| self.line()).collect();
        entries.into_iter().map(|entry| (self.effect(&entry), entry)).collect()
    }
}

impl Drop for Controller {
    fn drop(&mut self) {
        self.process.kill().unwrap_or_default();
        let _ended = self.process.wait();
    }
}

/// Runs a part of the lines in all modes with a controller.
pub fn hold_all(mut controller: Controller, part: (usize, usize)) {
    let mut bench = Bench::new(&mut controller, part);
    // Some buses need a minute for a backup, so it comes from a controller within armctl.
    bench.write("state.toml", STATE);
    let backup = bench.desk.run("-t sim:?state=state.toml yrcx backup press");
    assert_eq!(backup.exit, Some(0), "{backup:?}");
    bench.prepare("session open --background --yes");
    // These changes make the controller differ from the backup.
    for line in ["point set 7 --mm 9,9,9,9", "comment set 100 OTHER", "shift-data set 1 9 9 9 9"] {
        bench.prepare(&format!("yrcx {line} --yes"));
    }
    bench.prepare("session close cell");
    bench.hold_all();
}

fn armctl() -> Command {
    Command::new(env!("CARGO_BIN_EXE_armctl"))
}

#[test]
fn ethernet_ip_commands_send_only_authorized_frames() {
    in_parts(2, |part| hold_all(Controller::start(armctl(), "eip", &["--bind", "127.0.0.1:0"]), part));
}

#[test]
fn devicenet_commands_send_only_authorized_frames() {
    // The check of MAC IDs makes each line wait for two seconds.
    in_parts(6, |part| hold_all(Controller::start(armctl(), "devicenet", &[]), part));
}

#[test]
fn profibus_commands_send_only_authorized_frames() {
    in_parts(4, |part| hold_all(Controller::start(armctl(), "profibus", &[]), part));
}

/// Checks that every fieldbus has a test in this file. Add a test here for each new fieldbus.
#[test]
fn every_fieldbus_has_its_recorder() {
    let buses: std::collections::BTreeSet<&str> = simulators().map(|(_, bus)| bus).collect();
    let known = [
        "devicenet",
        "eip",
        "profibus",
        #[cfg(target_os = "linux")]
        "profinet",
    ];
    assert_eq!(buses.into_iter().collect::<Vec<_>>(), known);
}

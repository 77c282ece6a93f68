//! Runs a transcript: typed commands, and the expected stdout, stderr and exit code.
//!
//! | line | meaning |
//! |---|---|
//! | `$ COMMAND` | typed into `sh`, in a folder that all commands of the transcript use |
//! | `2> TEXT` | a line on stderr; a line without a mark is stdout |
//! | `? N` | the exit code, if it is not 0 |
//! | `## TEXT` | a comment |
//!
//! JSON is indented. The test checks that the program printed it on a single line, and that envelope and schema are
//! correct. Values that change between runs are `[…]`. Progress lines are omitted, because they depend on the duration.
//! `udp://127.0.0.1:10040` is a yerc simulator of this transcript, `eip://127.0.0.1:44818` a yrcx simulator, and
//! `tcp://127.0.0.1:4001` a toyo simulator. They run on other ports than the transcript shows. Their start state is
//! `NAME.toml` next to `NAME.console`, if this file exists. The folder also contains the files of `files/`.

use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

use super::json;

/// Families, and the addresses that transcripts show for their simulators.
const DOCUMENTED: [(&str, &str); 3] =
    [("yerc", "udp://127.0.0.1:10040"), ("yrcx", "eip://127.0.0.1:44818"), ("toyo", "tcp://127.0.0.1:4001")];

/// Runs the transcript of this name, and compares the output. With `SNAPSHOTS=overwrite`, writes the output instead.
pub fn check(name: &str) {
    let path = folder().join(format!("{name}.console"));
    let text = std::fs::read_to_string(&path).expect("the transcript is there");
    let workspace = Workspace::new();
    let families = DOCUMENTED.iter().filter(|(_, target)| text.contains(target));
    let simulators: Vec<Simulator> = families
        .map(|(family, _)| {
            let state = folder().join(format!("{name}.toml"));
            Simulator::start(family, state.exists().then_some(state.as_path()))
        })
        .collect();
    let mut printed = String::new();
    for line in text.lines() {
        if line.starts_with("## ") {
            if !printed.is_empty() && !printed.lines().last().is_some_and(|last| last.starts_with("## ")) {
                printed.push('\n');
            }
            printed.push_str(&format!("{line}\n"));
        } else if let Some(command) = line.strip_prefix("$ ") {
            if !printed.is_empty() && !printed.lines().last().is_some_and(|last| last.starts_with("## ")) {
                printed.push('\n');
            }
            printed.push_str(&format!("{line}\n{}", workspace.command_line(command, &simulators)));
        }
    }
    let expected = snapbox::Data::read_from(&path, Some(snapbox::data::DataFormat::Text)).raw();
    snapbox::Assert::new().action_env("SNAPSHOTS").normalize_paths(false).eq(printed, expected);
}

/// Returns every command line of every transcript.
pub fn commands() -> Vec<String> {
    let texts = names().into_iter().map(|name| std::fs::read_to_string(folder().join(format!("{name}.console"))));
    let texts: Vec<String> = texts.collect::<Result<_, _>>().expect("transcripts are readable");
    texts.iter().flat_map(|text| text.lines()).filter_map(|line| Some(line.strip_prefix("$ ")?.to_owned())).collect()
}

/// Returns the names of all transcripts.
pub fn names() -> Vec<String> {
    let files = std::fs::read_dir(folder()).expect("the folder of the transcripts");
    let names = files
        .filter_map(|file| Some(file.expect("an entry").file_name().to_str()?.strip_suffix(".console")?.to_owned()));
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli")
}

/// Test environment with its own folder and home, without variables of armctl, and without a terminal.
pub struct Workspace {
    folder: TempDir,
}

impl Workspace {
    /// Creates an environment with the files of `files/`.
    pub fn new() -> Self {
        let workspace = Self { folder: tempfile::tempdir().expect("a folder") };
        std::fs::create_dir(workspace.path().join(".run")).expect("a folder for sockets");
        for file in std::fs::read_dir(folder().join("files")).expect("the folder of files") {
            let file = file.expect("an entry");
            std::fs::copy(file.path(), workspace.path().join(file.file_name())).expect("a file is copied");
        }
        workspace
    }

    /// Folder of the environment.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// A command that runs the binary in this environment.
    pub fn armctl(&self, arguments: &[&str]) -> Command {
        let mut command = self.command(env!("CARGO_BIN_EXE_armctl"));
        command.args(arguments);
        command
    }

    fn command(&self, program: &str) -> Command {
        let binary = Path::new(env!("CARGO_BIN_EXE_armctl"));
        let tools = binary.parent().expect("the binary is in a folder").to_owned();
        let path = std::env::var_os("PATH").unwrap_or_default();
        let path = std::env::join_paths(std::iter::once(tools).chain(std::env::split_paths(&path)));
        let mut command = Command::new(program);
        command.env_clear().env("PATH", path.expect("a search path")).current_dir(self.path());
        command.env("HOME", self.path()).env("XDG_CONFIG_HOME", self.path().join(".config"));
        command.env("XDG_RUNTIME_DIR", self.path().join(".run"));
        command.env("NO_COLOR", "1").env("TERM", "dumb").env("TZ", "UTC").env("LC_ALL", "C");
        command.stdin(Stdio::null());
        command
    }

    /// Runs a command. Returns the lines that the transcript has for it.
    fn command_line(&self, line: &str, simulators: &[Simulator]) -> String {
        let served_line = simulators.iter().fold(line.to_owned(), |line, simulator| simulator.reachable_url(&line));
        let output = self.command("sh").args(["-c", &served_line]).output().expect("sh runs");
        let output_text = |bytes: Vec<u8>| {
            let text = String::from_utf8(bytes).expect("what is shown is UTF-8");
            let text = simulators.iter().fold(text, |text, simulator| simulator.documented(&text));
            text.replace(&self.path().display().to_string(), "[FOLDER]")
        };
        let stdout = output_text(output.stdout);
        assert!(stdout.is_empty() || stdout.ends_with('\n'), "`{line}` leaves the last line open: {stdout}");
        let stdout: String = stdout.lines().map(|line| json::format_value(line) + "\n").collect();
        let stderr: String = output_text(output.stderr)
            .lines()
            .filter(|line| !is_progress(line))
            .map(|line| format!("2> {}\n", json::format_value(line).replace('\n', "\n2> ")))
            .collect();
        let code = match output.status.code() {
            Some(0) => String::new(),
            Some(code) => format!("? {code}\n"),
            None => format!("? {}\n", output.status),
        };
        stdout + &stderr + &code
    }
}

/// Whether a line is a progress line, for example `reading points: 40 %, 466 of 999, 12 s left`. Only a long command
/// prints such lines.
fn is_progress(line: &str) -> bool {
    line.ends_with(" left") && line.contains(" %, ")
}

impl Drop for Workspace {
    fn drop(&mut self) {
        // A background session must not outlive its test.
        if self.path().join(".run/armctl").exists() {
            let _ = self.armctl(&["session", "close", "--all", "--force"]).output();
        }
    }
}

/// `armctl sim FAMILY` on free ports. The process ends with the test.
pub struct Simulator {
    process: Child,
    /// URL of the simulator.
    pub target: String,
    /// URL that the transcripts show for this simulator.
    documented: &'static str,
}

impl Simulator {
    /// Starts a simulator and waits until it listens.
    pub fn start(family: &str, state: Option<&Path>) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.args(["sim", family, "--bind", "127.0.0.1:0", "--jq", ".data.target"]);
        if let Some(state) = state {
            command.arg("--state").arg(state);
        }
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut process = command.spawn().expect("the simulator starts");
        let mut target = String::new();
        let stdout = process.stdout.take().expect("stdout is a pipe");
        BufReader::new(stdout).read_line(&mut target).expect("the simulator says where it is");
        let found = DOCUMENTED.iter().find(|(other, _)| *other == family);
        let (_, documented) = found.expect("transcripts know the family");
        assert!(target.starts_with(&documented[..6]), "the simulator did not start");
        Self { process, target: target.trim_end().to_owned(), documented }
    }

    fn reachable_url(&self, command: &str) -> String {
        command.replace(self.documented, &format!("'{}'", self.target))
    }

    fn documented(&self, output: &str) -> String {
        let address = |url: &str| url[6..].split('?').next().unwrap_or_default().to_owned();
        let output = output.replace(&self.target, self.documented);
        output.replace(&address(&self.target), &address(self.documented))
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        // The process may already have ended.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

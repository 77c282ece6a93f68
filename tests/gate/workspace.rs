//! Environment of a test, with an inventory.

use std::process::{Command, Output, Stdio};

use serde_json::Value;
use tempfile::TempDir;

/// Home folder of a test. It contains the inventory, the sessions and the files.
pub struct Workspace {
    pub folder: TempDir,
}

/// Result of a command line.
#[derive(Debug)]
pub struct CommandResult {
    pub exit: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Workspace {
    /// Creates an environment with this text in `robots.toml`.
    pub fn new(inventory: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("robots.toml"), inventory).expect("it is written");
        std::fs::create_dir(folder.path().join("run")).expect("a folder");
        Self { folder }
    }

    /// A command line. Its words are separated by blanks.
    pub fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path().join("run"));
        command.env("ARMCTL_CONFIG", self.folder.path().join("robots.toml"));
        command.current_dir(self.folder.path()).stdin(Stdio::null()).args(line.split(' '));
        command
    }

    /// Runs a command line. Without a terminal, it cannot ask questions.
    pub fn run(&self, line: &str) -> CommandResult {
        result_of(&self.command(line).output().expect("it runs"))
    }

    /// Returns the `data` of a command line that must succeed.
    #[track_caller]
    pub fn data(&self, line: &str) -> Value {
        let came = self.run(&format!("{line} --json"));
        assert_eq!(came.exit, Some(0), "{line}: {came:?}");
        serde_json::from_str::<Value>(&came.stdout).expect("JSON")["data"].clone()
    }

    /// Asserts that a command line fails with this exit code, and that stderr contains this part.
    #[track_caller]
    pub fn fails(&self, line: &str, exit: i32, part: &str) {
        let came = self.run(line);
        assert!(came.exit == Some(exit) && came.stderr.contains(part), "{line}: {came:?}");
        assert!(came.stderr.contains("hint: "), "{line}: {came:?}");
    }
}

pub fn result_of(output: &Output) -> CommandResult {
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).expect("UTF-8");
    CommandResult { exit: output.status.code(), stdout: text(&output.stdout), stderr: text(&output.stderr) }
}

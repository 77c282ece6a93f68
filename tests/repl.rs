//! `armctl repl` on a terminal: prompt, completion, history, Ctrl-C, questions, shared link, every way to exit.
#![cfg(unix)]

use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

/// The environment of a user: a home folder.
struct Workspace {
    folder: TempDir,
}

impl Workspace {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn command(&self, line: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path());
        command.env("TERM", "xterm-256color").env("LANG", "C.UTF-8").args(line.split(' '));
        command
    }

    /// Starts `armctl repl` and waits for its first message.
    fn repl(&self, line: &str) -> Terminal {
        let mut repl = Terminal::start(self.command(line), 100, 30).expect("a terminal");
        repl.wait_for_text("ends the prompt.");
        repl
    }

    /// `data` of a command that another process runs.
    fn data(&self, line: &str) -> Value {
        let output = self.command(&format!("{line} --json")).output().expect("it runs");
        assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).expect("JSON")["data"].clone()
    }
}

#[test]
fn prompt_shows_the_robot_state() {
    let workspace = Workspace::new();
    let mut repl = workspace.repl("yerc --sim");
    repl.wait_for_text("sim [simulated, servo on] yerc>");
    repl.press("servo off\r");
    repl.wait_for_text("servo power is off");
    repl.wait_for_text("sim [simulated, servo off] yerc>");
    repl.press("job select NONE\r");
    repl.wait_for_text("no such job");
    repl.press("sta\t--jq .data.servo_on\r");
    repl.wait_for_text("false");
    repl.press("exit\r");
    assert_eq!(repl.end().code(), Some(0));
    assert!(repl.is_restored());
}

#[test]
fn completes_words_and_names_of_the_robot() {
    let workspace = Workspace::new();
    let mut repl = workspace.repl("toyo repl --sim");
    repl.press("param get soft-limit-p\t\r");
    repl.wait_for_text("soft-limit-plus  P01");
    repl.press("robots l\t\r");
    repl.wait_for_text("no robots");
    repl.wait_for_text("> ");
    repl.press("\x04");
    assert_eq!(repl.end().code(), Some(0));
}

#[test]
fn ctrl_c_stops_the_motion_but_not_the_prompt() {
    let workspace = Workspace::new();
    let mut repl = workspace.repl("yerc repl --sim");
    repl.press("move relative --z 400 --speed 1mm/s\r");
    repl.wait_for_text("R1 x=");
    repl.signal("INT");
    repl.wait_for_text("the robot was stopped: HOLD is on");
    repl.wait_for_text("[simulated, servo on, hold] yerc>");
    repl.press("hold off\r");
    repl.wait_for_text("HOLD is off");
    repl.wait_for_text("yerc> ");
    repl.press("half a line");
    // The prompt can also show a gray suggestion from an earlier line.
    repl.wait_for_text("a line");
    repl.press("\x03");
    repl.wait_for_text("yerc> ");
    repl.press("status --jq .ok\r");
    repl.wait_for_text("true");
    repl.wait_for_text("> ");
    repl.press("\x04");
    assert_eq!(repl.end().code(), Some(0));
    assert!(repl.is_restored());
}

#[test]
fn ctrl_c_twice_at_the_prompt_leaves() {
    let workspace = Workspace::new();
    let mut repl = workspace.repl("yerc repl --sim");
    repl.wait_for_text("yerc> ");
    repl.press("\x03");
    repl.wait_for_text("Ctrl-C again");
    repl.wait_for_text("yerc> ");
    repl.press("\x03");
    assert_eq!(repl.end().code(), Some(130));
    assert!(repl.is_restored());
}

#[test]
fn termination_restores_the_terminal() {
    for signal in ["TERM", "HUP", "QUIT"] {
        let workspace = Workspace::new();
        let mut repl = workspace.repl("yrcx repl --sim");
        // Before the prompt is shown, the terminal itself echoes keys.
        repl.wait_for_text("yrcx>");
        repl.press("half a line");
        repl.wait_for_text("half a line");
        repl.signal(signal);
        repl.wait_for_text(signal);
        assert_eq!(repl.end().code(), Some(130), "{signal}");
        assert!(repl.is_restored(), "{signal}");
    }
}

#[test]
fn moves_a_real_robot_after_the_question_over_a_shared_link() {
    let (workspace, simulator) = (Workspace::new(), Simulator::start("toyo"));
    let mut repl = workspace.repl(&format!("-t {} repl", simulator.url));
    repl.press("home\r");
    repl.wait_for_text("Continue? [y/N]");
    repl.press("n\r");
    repl.wait_for_text("not confirmed; the command changed nothing");
    let session = workspace.data("session list")["sessions"][0].clone();
    assert_eq!((session["pid"].as_u64(), session["link"].as_str()), (Some(repl.child.id().into()), Some("up")));
    assert!(workspace.data(&format!("-t {} toyo status", simulator.url)).is_object());
    repl.press("exit\r");
    assert_eq!(repl.end().code(), Some(0));
    assert_eq!(workspace.data("session list")["sessions"].as_array().map(Vec::len), Some(0));
}

#[test]
fn stores_the_line_history() {
    let workspace = Workspace::new();
    for (typed, shown) in [("explain yerc 2060\r", "0x2060"), ("\x1b[A\r", "0x2060")] {
        let mut repl = workspace.repl("repl");
        repl.press(typed);
        repl.wait_for_text(shown);
        repl.wait_for_text("> ");
        repl.press("\x04");
        assert_eq!(repl.end().code(), Some(0));
    }
}

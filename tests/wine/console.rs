//! Events, keys and the screen of a console.

use std::fs::File;
use std::process::{Child, Stdio};

use tempfile::TempDir;

use super::simulator::Simulator;
use super::terminal::Terminal;
use super::*;

/// Events of a console, by their number in Windows.
const CTRL_BREAK: u32 = 1;
const CLOSE: u32 = 2;
const LOGOFF: u32 = 5;
const SHUTDOWN: u32 = 6;
/// Ends the program without an event, as the Task Manager does.
const KILL: u32 = 99;

/// A controller whose robot moves for minutes with this command.
const MOVE: &str = "yerc move pulse joint --pulses 90000,0,0,0,0,0 --speed 0.1% --yes";

struct Robot {
    folder: TempDir,
    controller: Simulator,
}

impl Robot {
    fn with_power(wine: &Wine) -> Self {
        let robot = Self { folder: tempfile::tempdir().unwrap(), controller: Simulator::start("yerc") };
        let on = wine.run(robot.folder.path(), &format!("-t {} yerc servo on --yes", robot.controller.url));
        assert!(on.status.success(), "{}", stderr(&on));
        robot
    }

    /// Output of a command for this robot that reads.
    fn read(&self, words: &str) -> String {
        let output = here(self.folder.path(), &format!("-t {} yerc {words}", self.controller.url));
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }

    fn waits_until_it_moves(&self, is_moving: bool) {
        until(if is_moving { "the robot moves" } else { "the robot stands still" }, || {
            self.read("status --jq .data.running") == is_moving.to_string()
        });
    }

    /// Starts a motion in its own console. The event comes when the stdin of this process is closed.
    fn starts_to_move(&self, wine: &Wine, event: u32, output: &File) -> Child {
        let mut command = wine.wine();
        command.arg(wine.program.with_file_name(CONSOLE_EVENT)).arg(event.to_string());
        command.arg(windows_path(&wine.program)).args(["-t", &self.controller.url]).args(MOVE.split(' '));
        command.current_dir(self.folder.path()).stdin(Stdio::piped());
        let program = command.stdout(Stdio::null()).stderr(output.try_clone().unwrap()).spawn().unwrap();
        self.waits_until_it_moves(true);
        program
    }
}

#[test]
fn ctrl_c_stops_a_motion() {
    let Some(wine) = wine() else { return };
    let robot = Robot::with_power(wine);
    let mut command = wine.command(robot.folder.path(), &format!("-t {} {MOVE}", robot.controller.url));
    command.env("TERM", "xterm");
    let mut terminal = Terminal::start(command, 100, 30).unwrap();
    robot.waits_until_it_moves(true);
    // Wine makes Ctrl-C of this signal, which the terminal of a person sends.
    terminal.signal("INT");
    // Wine keeps the terminal open after the end, so the test does not read to its end.
    terminal.wait_for_text("HOLD is on");
    let ended = terminal.child.wait().unwrap();
    let written = String::from_utf8_lossy(&terminal.written).into_owned();
    assert_eq!(ended.code(), Some(130), "{written}");
    robot.waits_until_it_moves(false);
}

#[test]
fn every_event_of_the_console_stops_a_motion() {
    let Some(wine) = wine() else { return };
    for event in [CTRL_BREAK, CLOSE, LOGOFF, SHUTDOWN] {
        let robot = Robot::with_power(wine);
        let mut output = tempfile::tempfile().unwrap();
        let mut program = robot.starts_to_move(wine, event, &output);
        program.stdin.take();
        let ended = program.wait().unwrap();
        let mut text = String::new();
        output.rewind().unwrap();
        output.read_to_string(&mut text).unwrap();
        assert!(text.contains("the robot was stopped: HOLD is on"), "{event}: {text}");
        assert_eq!(ended.code(), Some(130), "{event}: {text}");
        robot.waits_until_it_moves(false);
    }
}

#[test]
fn guardian_stops_the_motion_of_a_killed_program() {
    let Some(wine) = wine() else { return };
    let robot = Robot::with_power(wine);
    let mut program = robot.starts_to_move(wine, KILL, &tempfile::tempfile().unwrap());
    program.stdin.take();
    assert_eq!(program.wait().unwrap().code(), Some(99));
    robot.waits_until_it_moves(false);
}

/// A full-screen program. The console of Wine draws escape sequences as if they were text, so it breaks them and the texts
/// at the end of its line. The line is long, so that this is rare. A real console executes the sequences.
struct Panel(Terminal);

impl Panel {
    fn start(wine: &Wine, folder: &TempDir, words: &str) -> Self {
        let mut command = wine.command(folder.path(), words);
        command.env("TERM", "xterm");
        Self(Terminal::start(command, 1000, 30).unwrap())
    }

    /// Reads until the console has drawn these texts since the last key.
    fn shows(&mut self, texts: &[&str]) {
        let start = Instant::now();
        let mut drawn = String::new();
        while !texts.iter().all(|text| drawn.contains(text)) {
            assert!(self.0.read() && start.elapsed() < PATIENCE, "it never drew {texts:?}, but\n{drawn}");
            drawn = String::from_utf8_lossy(&self.0.written).replace("\r\r\n", "");
        }
    }

    fn press(&mut self, keys: &str) {
        self.0.reads_keys();
        self.0.written.clear();
        self.0.press(keys);
    }

    /// Presses `q`, and reads until the program has ended.
    fn quit(mut self) {
        self.press("q");
        let start = Instant::now();
        let ended = loop {
            match self.0.child.try_wait().unwrap() {
                Some(ended) => break ended,
                None => assert!(start.elapsed() < PATIENCE, "it never ended"),
            }
            self.0.read();
        };
        assert_eq!(ended.code(), Some(0));
    }
}

#[test]
fn top_draws_robots_and_takes_keys() {
    let Some(wine) = wine() else { return };
    let folder = tempfile::tempdir().unwrap();
    inventory(folder.path(), &[("robot1", "yerc", "sim:"), ("robot2", "toyo", "sim:")]);
    let mut top = Panel::start(wine, &folder, "top --watch 100ms");
    top.shows(&["\x1b[?1049h", "armctl top", "robot1", "robot2", "automatic"]);
    top.press("\x1b[B");
    top.shows(&["robot2"]);
    top.press("\r");
    top.shows(&["SIGNALS"]);
    top.quit();
}

#[test]
fn teach_moves_a_robot_by_keys() {
    let Some(wine) = wine() else { return };
    let robot = Robot::with_power(wine);
    let mut teach = Panel::start(wine, &robot.folder, &format!("-t {} teach yerc", robot.controller.url));
    teach.shows(&["Continue? [y/N]"]);
    teach.press("y\r");
    teach.shows(&["\x1b[?1049h", "REAL CONTROLLER", "STOP"]);
    let x = || robot.read("position --coordinates base --jq .data.positions[0].x_mm");
    let before = x();
    teach.press("\x1b[C");
    until("a step", || x() != before);
    teach.quit();
}

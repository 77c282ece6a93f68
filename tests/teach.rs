//! `armctl teach` on a terminal, with simulated controllers. Each key is one limited step, and every end of the panel
//! stops the motion.
#![cfg(unix)]

use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

/// The environment of a user, and a controller with servo power.
struct Workspace {
    folder: TempDir,
    family: &'static str,
    controller: Simulator,
}

impl Workspace {
    fn new(family: &'static str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        Self { folder, family, controller: Simulator::start(family) }
    }

    /// A controller that starts in this state (TOML).
    fn in_state(family: &'static str, state: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("state.toml");
        std::fs::write(&file, state).expect("a file");
        let controller = Simulator::start_with(family, &["--state", file.to_str().expect("a path")]);
        Self { folder, family, controller }
    }

    /// Creates a controller whose axes can move.
    fn with_power(family: &'static str) -> Self {
        let workspace = Self::new(family);
        let on = workspace.run(&[family, "servo", "on", "--yes"]);
        assert!(on.status.success(), "{}", String::from_utf8_lossy(&on.stderr));
        workspace
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("XDG_RUNTIME_DIR", self.folder.path());
        command.env("TERM", "xterm-256color").env("LANG", "C.UTF-8").args(["-t", &self.controller.url]).args(words);
        command
    }

    fn run(&self, words: &[&str]) -> Output {
        self.command(words).output().expect("it runs")
    }

    fn data(&self, words: &str) -> Value {
        let words: Vec<&str> = words.split(' ').chain(["--json"]).collect();
        let output = self.run(&words);
        let envelope: Value = serde_json::from_slice(&output.stdout).expect("an envelope");
        assert_eq!(envelope["ok"], true, "{words:?}: {envelope}");
        envelope["data"].clone()
    }

    /// Repeats the command until it succeeds: the guardian or the adapter may not have finished the end of another
    /// command yet.
    fn reported_states(&self, words: &str) -> Value {
        let words: Vec<&str> = words.split(' ').chain(["--json"]).collect();
        let mut outputs = (0..MAX_POLLS).map(|_| self.run(&words));
        let output = outputs.find(|output| output.status.success()).expect("the controller answers");
        serde_json::from_slice::<Value>(&output.stdout).expect("an envelope")["data"].clone()
    }

    /// Starts the panel, which first asks for a confirmation.
    fn ask_panel(&self, words: &[&str]) -> Terminal {
        let command = self.command(&[&["teach", self.family], words].concat());
        let mut teach = Terminal::start(command, 100, 30).expect("a terminal");
        teach.wait_for_text("Continue? [y/N]");
        teach
    }

    /// Starts the panel, and waits until it shows the robot.
    fn panel(&self, words: &[&str]) -> Terminal {
        let mut teach = self.ask_panel(words);
        teach.press("y\r");
        teach.wait_for_picture("REAL CONTROLLER");
        teach.wait_for_picture("axis");
        teach
    }

    /// A panel in the middle of a step of ten millimeters at one millimeter per second. The step is long enough for a
    /// test.
    fn is_moving(&self, start: f64) -> Terminal {
        let mut teach = self.panel(&[]);
        teach.press("<++");
        teach.wait_for_picture("step 10 mm");
        teach.press("\x1b[C");
        teach.wait_for_picture("MOVING");
        self.wait_for_motion_from(start);
        teach
    }

    /// Waits until X in base coordinates differs from `start`. The step is then in progress.
    fn wait_for_motion_from(&self, start: f64) {
        assert!((0..MAX_POLLS).any(|_| self.x() > start), "nothing moves");
    }

    /// X of the robot in base coordinates.
    fn x(&self) -> f64 {
        self.data("yerc position --coordinates base")["positions"][0]["x_mm"].as_f64().expect("a number")
    }
}

/// Number of polls for an event. If the event does not occur within these polls, the test fails.
const MAX_POLLS: usize = 2000;

#[test]
fn refuses_unsupported_uses() {
    let workspace = Workspace::new("yerc");
    for (words, part) in [
        (&["teach", "yerc", "--dry-run"][..], "has no dry run"),
        (&["teach", "yerc", "-o", "json"], "is interactive"),
        (&["teach", "yerc", "--max-step", "0"], "above 0"),
        (&["teach", "yerc", "--yes"], "needs a terminal"),
        (&["teach", "yerc", "--watch"], "--watch"),
    ] {
        let output = workspace.run(words);
        let messages = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words:?}: {messages}");
        assert!(messages.contains(part), "{words:?}: {messages}");
    }
    let mut teach = workspace.ask_panel(&["--max-step", "1", "--max-speed", "5"]);
    let question = String::from_utf8_lossy(&teach.written).replace("\r\n", " ");
    for part in ["REAL CONTROLLER", "at most 1 mm", "at most 5 mm/s"] {
        assert!(question.contains(part), "{question}");
    }
    teach.press("n\r");
    teach.wait_for_text("nothing was sent");
    assert_eq!(teach.end().code(), Some(7));
    assert!(teach.is_restored());
}

#[test]
fn limits_step_sizes_and_speeds() {
    let workspace = Workspace::new("yerc");
    for (words, largest, fastest) in [(&[][..], "step 10 mm", "speed 10 mm/s"), (&["--max-step", "1"], "step 1 mm", "")]
    {
        let mut teach = workspace.panel(words);
        teach.press("++++++>>>>>>");
        teach.wait_for_picture(largest);
        teach.wait_for_picture(fastest);
        teach.press("------");
        teach.wait_for_picture("step 0.01 mm");
        teach.press("q");
        assert_eq!(teach.end().code(), Some(0));
        let drawn = String::from_utf8_lossy(&teach.written).into_owned();
        assert!(!drawn.contains("25 mm/s"), "{drawn}");
        assert!(teach.is_restored());
    }
}

#[test]
fn keys_move_one_axis_by_a_step() {
    let workspace = Workspace::with_power("yerc");
    let before = workspace.data("yerc position --coordinates base")["positions"][0].clone();
    let mut teach = workspace.panel(&[]);
    teach.press("\x1b[B\x1b[C");
    teach.wait_for_picture("ok move relative --y 0.1 --coordinate base --speed 5mm/s");
    teach.press("c");
    teach.wait_for_picture("tool  axis Y");
    teach.press("q");
    assert_eq!(teach.end().code(), Some(0));
    let after = workspace.data("yerc position --coordinates base")["positions"][0].clone();
    let moved = |name: &str| after[name].as_f64().unwrap() - before[name].as_f64().unwrap();
    assert!((moved("y_mm") - 0.1).abs() < 1e-6, "{before} {after}");
    for name in ["x_mm", "z_mm", "rx_deg", "ry_deg", "rz_deg"] {
        assert!(moved(name).abs() < 1e-6, "{name}: {before} {after}");
    }

    let workspace = Workspace::with_power("toyo");
    let before = workspace.data("toyo position")["positions"][0].clone();
    let mut teach = workspace.panel(&[]);
    teach.press("\x1b[C");
    teach.wait_for_picture("ok jog X + inch");
    teach.press("q");
    assert_eq!(teach.end().code(), Some(0));
    let after = workspace.data("toyo position")["positions"][0].clone();
    assert!(after["x_mm"].as_f64() > before["x_mm"].as_f64(), "{before} {after}");
    assert_eq!((&after["y_mm"], &after["z_mm"]), (&before["y_mm"], &before["z_mm"]));
}

#[test]
fn stops_a_step_when_the_program_is_killed() {
    let workspace = Workspace::with_power("yerc");
    let start = workspace.x();
    let mut teach = workspace.panel(&[]);
    teach.press("<+");
    teach.wait_for_picture("step 1 mm");
    // Keys that are pressed during a step are discarded.
    teach.press("\x1b[C\x1b[C\x1b[C\x1b[C");
    teach.wait_for_picture("MOVING");
    workspace.wait_for_motion_from(start);
    teach.child.kill().expect("it is killed");
    teach.child.wait().expect("it is our child");
    // The guardian stops the robot, and no further step follows.
    assert!((0..MAX_POLLS).any(|_| workspace.data("yerc status")["held"] == true), "{}", workspace.data("yerc status"));
    assert!((0..MAX_POLLS).any(|_| workspace.data("yerc status")["running"] == false), "it does not stop");
    assert!(workspace.x() < start + 1.0 + 1e-6, "{start} {}", workspace.x());
}

/// The process of the panel is killed or frozen during a motion. The robot must stop before it reaches the target.
#[test]
fn stops_a_motion_when_the_program_is_killed_or_frozen() {
    for signal in ["KILL", "STOP"] {
        // The motion is half a meter, at a tenth of the speed.
        let workspace = Workspace::with_power("toyo");
        workspace.data("toyo home --yes");
        workspace.data("toyo param set M10 P --yes");
        workspace.data("toyo override set 10 --yes");
        workspace.data("toyo point set 5 x=500 y=0 z=0 r=0 --yes");
        let mut teach = workspace.panel(&[]);
        // Before the panel is drawn, the terminal is in normal mode and may interpret Enter.
        teach.wait_for_picture("step 0.1 mm");
        teach.press("g5\r");
        teach.wait_for_picture("y moves to point 5");
        teach.press("y");
        teach.wait_for_picture("MOVING");
        let x = || workspace.reported_states("toyo position")["positions"][0]["x_mm"].as_f64().expect("a number");
        assert!((0..MAX_POLLS).any(|_| x() > 0.0), "nothing moves");
        end(teach, signal);
        assert!(
            (0..MAX_POLLS).any(|_| workspace.reported_states("toyo status")["running"] == false),
            "it does not stop"
        );
        assert!(x() < 500.0, "{signal}: {}", x());

        // A step of ten millimeters at one millimeter per second. The adapter accepts no other master until it detects
        // that the first master is gone.
        let workspace = Workspace::in_state("yrcx", "[[robot]]\nauto_speed = 10\n");
        let x = || workspace.reported_states("yrcx position --yes")["positions"][0]["x_mm"].as_f64().expect("a number");
        let mut teach = workspace.panel(&[]);
        teach.press("<<<+++");
        teach.wait_for_picture("step 10 mm");
        teach.press("\x1b[C");
        teach.wait_for_picture("● command");
        end(teach, signal);
        // Without its master, the adapter stops the robot and raises an alarm.
        let resting_position = || {
            let (before, after) = (x(), x());
            (before - after).abs() < 1e-9
        };
        assert!((0..MAX_POLLS).any(|_| resting_position()), "it does not stop");
        assert!(x() < 10.0, "{signal}: {}", x());
    }
}

/// Ends the panel with a signal. A frozen panel is killed by its guardian.
fn end(mut teach: Terminal, signal: &str) {
    teach.signal(signal);
    teach.child.wait().expect("it is our child");
}

#[test]
fn stop_works_during_a_step() {
    let workspace = Workspace::with_power("yerc");
    let start = workspace.x();
    let mut teach = workspace.is_moving(start);
    teach.press(" ");
    teach.wait_for_picture("ok hold on");
    teach.wait_until("it moves no more", |picture| !picture.text().contains("MOVING"));
    let stopped = workspace.x();
    assert!(start < stopped && stopped < start + 10.0, "{start} {stopped}");
    assert_eq!(workspace.data("yerc status")["held"], true);
    teach.press("q");
    assert_eq!(teach.end().code(), Some(0));
    assert!((workspace.x() - stopped).abs() < 1e-6);
}

#[test]
fn leaving_during_a_motion_stops_it() {
    for (key, code) in [("q", 0), ("\x03", 130)] {
        let workspace = Workspace::with_power("yerc");
        let start = workspace.x();
        let mut teach = workspace.is_moving(start);
        teach.press(key);
        assert_eq!(teach.end().code(), Some(code));
        assert!(teach.is_restored());
        let left_position = workspace.x();
        assert!(left_position < start + 10.0, "{start} {left_position}");
        assert_eq!(workspace.data("yerc status")["running"], false);
    }
}

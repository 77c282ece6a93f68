//! `armctl setup` on a terminal. It starts without an inventory and ends with a named, checked, read-only robot. Every
//! way to exit is tested.
#![cfg(unix)]

use std::process::Command;

use tempfile::TempDir;

use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

/// The environment of a user, who may have an inventory.
struct Workspace {
    folder: TempDir,
}

impl Workspace {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn setup(&self) -> Terminal {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("TERM", "xterm-256color").env("LANG", "C.UTF-8");
        command.args(["--config", "robots.toml", "setup"]).current_dir(self.folder.path());
        Terminal::start(command, 80, 24).expect("a terminal")
    }

    /// Text of the inventory; `None` if there is no file.
    fn inventory(&self) -> Option<String> {
        std::fs::read_to_string(self.folder.path().join("robots.toml")).ok()
    }
}

/// Keys that select another entry of a list.
const SECOND_ENTRY: &str = "\x1b[B";
const THIRD_ENTRY: &str = "\x1b[B\x1b[B";

/// Answers each question, in this order.
fn answer(setup: &mut Terminal, answers: &[(&str, &str)]) {
    for (question, answer) in answers {
        setup.wait_for_text(question);
        setup.press(&format!("{answer}\r"));
    }
}

#[test]
fn adds_a_checked_named_read_only_robot() {
    let (workspace, controller) = (Workspace::new(), Simulator::start("yerc"));
    let (address, _) = controller.place();
    let mut setup = workspace.setup();
    answer(&mut setup, &[("Where is the robot?", ""), ("a URL:", &address.to_string())]);
    answer(&mut setup, &[("Which controller is it?", "")]);
    setup.wait_for_text("the controller answers a status request");
    setup.wait_for_text("dx200, read from the software");
    answer(&mut setup, &[("Name [cell1]:", "cell 3"), ("Name [cell1]:", "cell3"), ("Read-only", "")]);
    setup.wait_for_text("read_only = true");
    answer(&mut setup, &[("Write this to robots.toml? [Y/n]", "")]);
    setup.wait_for_text("added cell3");
    assert_eq!(setup.end().code(), Some(0));
    assert!(setup.is_restored());
    let expected =
        format!("default = \"cell3\"\n\n[[robot]]\nname = \"cell3\"\ntarget = \"udp://{address}\"\nread_only = true\n");
    assert_eq!(workspace.inventory(), Some(expected));
}

#[test]
fn adds_a_simulator_and_changes_the_default() {
    let workspace = Workspace::new();
    let simulator = [
        ("Where is the robot?", THIRD_ENTRY),
        ("Which controller is it?", SECOND_ENTRY),
        ("eip://127.0.0.1:44818]:", "sim:"),
    ];
    let mut setup = workspace.setup();
    answer(&mut setup, &simulator);
    answer(&mut setup, &[("Name [cell1]:", ""), ("Read-only", "n"), ("Hold", "y"), ("Write this", "y")]);
    assert_eq!(setup.end().code(), Some(0));
    let mut setup = workspace.setup();
    answer(&mut setup, &simulator);
    answer(&mut setup, &[("Name [cell2]:", "cell1"), ("robot 'cell1' already exists", "")]);
    answer(&mut setup, &[("Read-only", "yes"), ("instead of cell1? [y/N]", "y"), ("Write this", "")]);
    assert_eq!(setup.end().code(), Some(0));
    let inventory = workspace.inventory().expect("it was written");
    assert!(inventory.starts_with("default = \"cell2\""), "{inventory}");
    assert!(inventory.contains("hold = true") && inventory.contains("read_only = true"), "{inventory}");
}

#[test]
fn shows_problems_and_asks_whether_to_continue() {
    let workspace = Workspace::new();
    let mut setup = workspace.setup();
    answer(&mut setup, &[("Where is the robot?", ""), ("a URL:", "robot")]);
    setup.wait_for_text("error:");
    answer(&mut setup, &[("Where is the robot?", ""), ("a URL:", "udp://127.0.0.1:1")]);
    setup.wait_for_text("failed");
    answer(
        &mut setup,
        &[("What now?", ""), ("What now?", SECOND_ENTRY), ("Where is the robot?", ""), ("a URL:", "tcp://127.0.0.1:1")],
    );
    answer(&mut setup, &[("What now?", THIRD_ENTRY), ("Name", "tray"), ("Read-only", ""), ("Write this", "n")]);
    setup.wait_for_text("nothing was written");
    assert_eq!(setup.end().code(), Some(7));
    assert_eq!(workspace.inventory(), None);
}

#[test]
fn escape_and_signals_write_nothing_and_restore_the_terminal() {
    for way in ["escape", "ctrl-c", "INT", "TERM"] {
        let workspace = Workspace::new();
        let mut setup = workspace.setup();
        setup.wait_for_text("no robot yet: use a simulator");
        setup.reads_keys();
        match way {
            "escape" => setup.press("\x1b"),
            "ctrl-c" => setup.press("\x03"),
            signal => setup.signal(signal),
        }
        assert_eq!(setup.end().code(), Some(130), "{way}");
        assert_terminal_restored(&setup, way);
        assert_eq!(workspace.inventory(), None);
    }
}

/// Asserts that the terminal modes are restored and the cursor is visible.
fn assert_terminal_restored(terminal: &Terminal, way: &str) {
    assert!(terminal.is_restored(), "{way}");
    let written = String::from_utf8_lossy(&terminal.written);
    assert!(written.rfind("\x1b[?25h") > written.rfind("\x1b[?25l"), "{way}: {written:?}");
}

/// Runs a command line on a terminal. The program asks for a missing name.
fn line(workspace: &Workspace, words: &[&str]) -> Terminal {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env_clear().env("HOME", workspace.folder.path()).env("TERM", "xterm-256color").env("LANG", "C.UTF-8");
    command.args(["--config", "robots.toml"]).args(words).current_dir(workspace.folder.path());
    Terminal::start(command, 80, 24).expect("a terminal")
}

#[test]
fn offers_a_choice_for_a_missing_name() {
    let workspace = Workspace::new();
    let mut select = line(&workspace, &["--sim", "yerc", "job", "select"]);
    select.wait_for_text("> COUNT");
    select.reads_keys();
    select.press("WAIT\r");
    // The command line is longer than a line of the terminal, so it wraps.
    select.wait_for_text("this list:\n  armctl --config robots.toml --sim yerc");
    select.wait_for_text("WAITIN is selected");
    assert_eq!(select.end().code(), Some(0));
    assert_terminal_restored(&select, "chosen");
    let robots = "[[robot]]\nname = \"cell3\"\ntarget = \"sim:\"\nfamily = \"yerc\"\n";
    std::fs::write(workspace.folder.path().join("robots.toml"), robots).unwrap();
    let mut status = line(&workspace, &["status", "-r"]);
    status.wait_for_text("cell3");
    status.reads_keys();
    status.press("\r");
    status.wait_for_text("armctl --config robots.toml status -r");
    assert_eq!(status.end().code(), Some(0));
}

#[test]
fn enter_does_not_remove_a_robot() {
    let robots = "[[robot]]\nname = \"cell3\"\ntarget = \"sim:\"\nfamily = \"yerc\"\n";
    let workspace = Workspace::new();
    std::fs::write(workspace.folder.path().join("robots.toml"), robots).unwrap();
    for (way, keys) in [("Esc", "\r\x1b"), ("Ctrl-C", "\r\x03"), ("TERM", "\r"), ("HUP", "\r")] {
        let mut remove = line(&workspace, &["robots", "remove"]);
        remove.wait_for_text("cell3");
        remove.reads_keys();
        remove.press(keys);
        if keys == "\r" {
            remove.wait_for_text("cell3");
            remove.reads_keys();
            remove.signal(way);
        }
        assert_eq!(remove.end().code(), Some(130), "{way}");
        assert_terminal_restored(&remove, way);
        assert_eq!(workspace.inventory().as_deref(), Some(robots), "{way}");
    }
}

#[test]
fn enter_does_not_select_a_deletion() {
    let workspace = Workspace::new();
    let mut delete = line(&workspace, &["--sim", "yerc", "file", "delete"]);
    delete.wait_for_text("COUNT.JBI");
    delete.reads_keys();
    delete.press("\r\x1b");
    assert_eq!(delete.end().code(), Some(130), "Enter took nothing, Esc left");
    assert_terminal_restored(&delete, "left");
}

#[test]
fn no_input_asks_nothing() {
    for words in [&["--no-input", "--sim", "yerc", "job", "select"][..], &["--json", "--sim", "yerc", "job", "select"]]
    {
        let mut refused = line(&Workspace::new(), words);
        assert_eq!(refused.end().code(), Some(2), "{words:?}");
    }
}

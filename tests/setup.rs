//! `armctl setup` on a terminal: from nothing to a robot that is named, checked and read-only; every way out.
#![cfg(unix)]

use std::process::Command;

use tempfile::TempDir;

use crate::support::simulator::Simulator;
use crate::support::terminal::Terminal;

/// A user with an inventory of his own.
struct Desk {
    folder: TempDir,
}

impl Desk {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder") }
    }

    fn setup(&self) -> Terminal {
        let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
        command.env_clear().env("HOME", self.folder.path()).env("TERM", "xterm-256color").env("LANG", "C.UTF-8");
        command.args(["--config", "robots.toml", "setup"]).current_dir(self.folder.path());
        Terminal::start(command, 80, 24).expect("a terminal")
    }

    /// The inventory; `None` where there is no file.
    fn inventory(&self) -> Option<String> {
        std::fs::read_to_string(self.folder.path().join("robots.toml")).ok()
    }
}

/// Answers each question that comes.
fn answer(setup: &mut Terminal, answers: &[(&str, &str)]) {
    for (question, answer) in answers {
        setup.says(question);
        setup.press(&format!("{answer}\r"));
    }
}

#[test]
fn an_address_becomes_a_robot_that_is_checked_named_and_read_only() {
    let (desk, controller) = (Desk::new(), Simulator::start("yerc"));
    let (address, _) = controller.place();
    let mut setup = desk.setup();
    answer(&mut setup, &[("Where is the robot?", ""), ("a URL:", &address.to_string())]);
    answer(&mut setup, &[("Which controller is it?", "1")]);
    setup.says("it answers a status request");
    setup.says("dx200, by its software");
    answer(&mut setup, &[("Name [cell1]:", "cell 3"), ("Name [cell1]:", "cell3"), ("Read-only", "")]);
    setup.says("read_only = true");
    answer(&mut setup, &[("Write this to robots.toml? [Y/n]", "")]);
    setup.says("added cell3");
    assert_eq!(setup.end().code(), Some(0));
    assert!(setup.is_as_before());
    let expected =
        format!("default = \"cell3\"\n\n[[robot]]\nname = \"cell3\"\ntarget = \"udp://{address}\"\nread_only = true\n");
    assert_eq!(desk.inventory(), Some(expected));
}

#[test]
fn a_simulator_is_set_up_as_well_and_a_second_robot_may_become_the_default() {
    let desk = Desk::new();
    let simulator =
        [("Where is the robot?", "3"), ("Which controller is it?", "2"), ("eip://127.0.0.1:44818]:", "sim:")];
    let mut setup = desk.setup();
    answer(&mut setup, &simulator);
    answer(&mut setup, &[("Name [cell1]:", ""), ("Read-only", "n"), ("Hold", "y"), ("Write this", "y")]);
    assert_eq!(setup.end().code(), Some(0));
    let mut setup = desk.setup();
    answer(&mut setup, &simulator);
    answer(&mut setup, &[("Name [cell2]:", "cell1"), ("robot 'cell1' exists already", "")]);
    answer(&mut setup, &[("Read-only", "yes"), ("instead of cell1? [y/N]", "y"), ("Write this", "")]);
    assert_eq!(setup.end().code(), Some(0));
    let inventory = desk.inventory().expect("it was written");
    assert!(inventory.starts_with("default = \"cell2\""), "{inventory}");
    assert!(inventory.contains("hold = true") && inventory.contains("read_only = true"), "{inventory}");
}

#[test]
fn what_is_in_the_way_is_shown_and_asked_about() {
    let desk = Desk::new();
    let mut setup = desk.setup();
    answer(&mut setup, &[("Where is the robot?", "4"), ("type a number from 1 to 3", "1"), ("a URL:", "robot")]);
    setup.says("error:");
    answer(&mut setup, &[("Where is the robot?", "1"), ("a URL:", "udp://127.0.0.1:1")]);
    setup.says("failed");
    answer(
        &mut setup,
        &[("What now?", ""), ("What now?", "2"), ("Where is the robot?", "1"), ("a URL:", "tcp://127.0.0.1:1")],
    );
    answer(&mut setup, &[("What now?", "3"), ("Name", "tray"), ("Read-only", ""), ("Write this", "n")]);
    setup.says("nothing was written");
    assert_eq!(setup.end().code(), Some(7));
    assert_eq!(desk.inventory(), None);
}

#[test]
fn no_answer_and_ctrl_c_write_nothing() {
    for exit in [7, 130] {
        let desk = Desk::new();
        let mut setup = desk.setup();
        setup.says("Number [1]:");
        if exit == 7 {
            setup.press("\x04");
        } else {
            setup.signal("INT");
        }
        assert_eq!(setup.end().code(), Some(exit));
        assert!(setup.is_as_before());
        assert_eq!(desk.inventory(), None);
    }
}

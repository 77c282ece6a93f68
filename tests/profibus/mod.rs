//! PROFIBUS against ends that share nothing with ours: a strict slave in Python, and the master of PyPI's `pyprofibus`. Both
//! run beside the binary, on pseudo-terminals; where Python or the package is missing, the tests say that they are skipped.

use std::io::{BufRead as _, BufReader};
use std::path::PathBuf;
use std::process::{Child, ChildStdout, Command, Output, Stdio};

/// A program that says on its first line where it is, and is ended with this.
struct Running {
    child: Child,
    lines: BufReader<ChildStdout>,
}

impl Running {
    fn start(command: &mut Command) -> Self {
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn().expect("it starts");
        let lines = BufReader::new(child.stdout.take().expect("a pipe"));
        Self { child, lines }
    }

    fn line(&mut self) -> String {
        let mut line = String::new();
        self.lines.read_line(&mut line).expect("it says something");
        line.trim().to_owned()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // One that has ended cannot be ended.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn armctl() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.env("HOME", env!("CARGO_TARGET_TMPDIR")).env_remove("XDG_CONFIG_HOME");
    command
}

fn script(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/profibus").join(name)
}

fn has_python() -> bool {
    Command::new("python3").arg("--version").output().is_ok_and(|output| output.status.success())
}

fn text(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

#[test]
fn a_strict_slave_that_shares_nothing_with_ours_has_nothing_to_complain_of() {
    if !has_python() {
        eprintln!("skipped: python3 is not here");
        return;
    }
    let mut slave = Running::start(Command::new("python3").arg(script("slave.py")).arg("3"));
    let port = slave.line();
    let url = format!("profibus://{port}?station=5&slot=500ms&watchdog=20s");
    // The slave shows what it is shown, which is no controller: the command fails, and the link is opened and closed.
    let asked =
        armctl().args(["-t", &url, "--timeout", "1s", "--yes", "yrcx", "info", "servo"]).output().expect("it runs");
    let mut said = Vec::new();
    loop {
        let line = slave.line();
        let is_last = line.starts_with("images:") || line.is_empty();
        said.push(line);
        if is_last {
            break;
        }
    }
    let ended = slave.child.wait().expect("it ends");
    assert!(ended.success(), "{said:?}\n{}", text(&asked));
    assert!(said.contains(&"state: exchanges data".to_owned()), "{said:?}");
}

#[test]
fn the_master_of_pyprofibus_exchanges_images_with_our_simulator() {
    let Some(folder) = std::env::var_os("ARMCTL_PROFIBUS_PEERS").map(PathBuf::from) else {
        eprintln!("skipped: ARMCTL_PROFIBUS_PEERS does not name a folder of tests/profibus/install");
        return;
    };
    let mut simulator = Running::start(armctl().args(["sim", "yrcx", "--bus", "profibus"]));
    let said = simulator.line();
    let port = said.split("profibus://").nth(1).and_then(|rest| rest.split('?').next()).expect("a port");
    let python = folder.join("profibus/bin/python");
    let driven = Command::new(python).arg(script("master.py")).arg(port).output().expect("it runs");
    assert!(driven.status.success(), "{}", text(&driven));
}

//! Time of commands without a robot: help, and completion candidates. The benchmark runs complete processes in turn,
//! and compares them with a process that only starts and ends.
//!
//! `cargo bench --bench startup`

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

mod common;

use std::process::{Command, Stdio};

use anyhow::ensure;

use common::table::{Goal, Row, Table};
use common::{Work, median, run_alternately};

/// Number of runs of each command.
const FULL: usize = 200;
const QUICK: usize = 2;

/// Time limit for help or candidates.
const GOAL: Goal = Goal::AtMost(10.0, "ms");

fn main() -> anyhow::Result<()> {
    common::run(&[("help", help), ("completion", completion)], &FULL, &QUICK)
}

fn help(rounds: &usize) -> anyhow::Result<Table> {
    let title = format!("Help and answers without a network, {rounds} processes each");
    compare(
        title,
        *rounds,
        [
            ("true", Command::new("true"), None),
            ("armctl --version", armctl(&["--version"]), Some(Goal::AtMost(3.0, "ms"))),
            ("armctl -h", armctl(&["-h"]), Some(GOAL)),
            ("armctl --help", armctl(&["--help"]), Some(GOAL)),
            ("armctl yerc --help", armctl(&["yerc", "--help"]), Some(GOAL)),
            ("armctl yrcx move --help", armctl(&["yrcx", "move", "--help"]), Some(GOAL)),
            ("armctl --sim yerc status", armctl(&["--sim", "yerc", "status"]), None),
        ],
    )
}

fn completion(rounds: &usize) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let robots = (0..200).map(|n| format!("[[robot]]\nname = \"cell{n}\"\ntarget = \"udp://10.0.0.{n}\"\n"));
    let inventory = folder.path().join("robots.toml");
    std::fs::write(&inventory, robots.collect::<String>())?;
    let inventory = inventory.to_string_lossy();
    let title = format!("Candidates for a shell, {rounds} processes each");
    compare(
        title,
        *rounds,
        [
            ("true", Command::new("true"), None),
            ("armctl yerc job se", tab(&["armctl", "yerc", "job", "se"]), Some(GOAL)),
            ("armctl -r (200 robots)", tab(&["armctl", "--config", &inventory, "-r", ""]), Some(GOAL)),
            ("armctl yrcx ", tab(&["armctl", "yrcx", ""]), Some(GOAL)),
            ("armctl explain yerc 0x", tab(&["armctl", "explain", "yerc", "0x"]), Some(GOAL)),
            ("armctl yerc job select (nobody to ask)", tab(&["armctl", "yerc", "job", "select", ""]), Some(GOAL)),
            (
                "armctl --sim yerc job select (asked)",
                tab(&["armctl", "--sim", "yerc", "job", "select", ""]),
                Some(GOAL),
            ),
        ],
    )
}

fn compare<const N: usize>(
    title: String,
    rounds: usize,
    contenders: [(&'static str, Command, Option<Goal>); N],
) -> anyhow::Result<Table> {
    let names = contenders.each_ref().map(|(name, _, goal)| (*name, *goal));
    let mut works = contenders.map(|(_, mut command, _)| {
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        move || {
            let status = command.status()?;
            ensure!(status.success(), "{command:?} ended with {status}");
            Ok(())
        }
    });
    let times = run_alternately(rounds, works.each_mut().map(|work| work as &mut dyn Work))?;
    let mut table = Table::new(title);
    for ((name, goal), times) in names.into_iter().zip(&times) {
        let ms = median(times) * 1e3;
        let row = Row::new(name, format!("{ms:.2} ms"));
        table.row(if let Some(goal) = goal { row.goal(ms, goal) } else { row });
    }
    Ok(table)
}

/// Returns a command with the binary of the same build, in an empty environment.
fn armctl(args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    for name in ["ARMCTL_CONFIG", "ARMCTL_TARGET", "ARMCTL_TIMEOUT", "ARMCTL_RETRIES", "ARMCTL_ENCODING"] {
        command.env_remove(name);
    }
    command.args(args);
    command
}

/// Returns the command that the scripts in `completions/` run when the user presses Tab.
fn tab(words: &[&str]) -> Command {
    let mut command = armctl(&["--"]);
    command.env("ARMCTL_COMPLETE", "zsh").args(words);
    command
}

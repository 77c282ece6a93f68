//! How long `armctl status` takes over a fleet of mixed families, beside the slowest of its controllers alone.
//!
//! Whole processes, from start to end, on one inventory; the controllers are simulators on the loopback, all in this
//! process, so that they share the machine's cores with the command. `cargo bench --bench fleet` measures 200 of them;
//! `-- --quick`, and `cargo test --benches`, only show that it works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};

use common::controllers::{Delays, FAMILIES, serve};
use common::table::{Goal, Row, Table};
use common::{in_turn, median, ratio, run};

/// How many controllers of yerc, toyo and yrcx there are, and how often the command runs.
struct Effort {
    fleet: [usize; 3],
    rounds: usize,
}

const FULL: Effort = Effort { fleet: [140, 40, 20], rounds: 21 };
const QUICK: Effort = Effort { fleet: [4, 2, 2], rounds: 1 };

/// The comparisons, by the word that chooses one.
const COMPARISONS: [(&str, common::Compare<Effort>); 2] = [("lines", lines), ("at-once", at_once)];

fn main() -> anyhow::Result<()> {
    run(&COMPARISONS, &FULL, &QUICK)
}

/// Controllers as they are: a Yaskawa takes some milliseconds for an answer, a Toyo is at the end of 9600 baud.
fn lines(effort: &Effort) -> anyhow::Result<Table> {
    let table = Table::new(format!("status of {} controllers on lines as they are", total(effort)));
    compare(table, effort, Some(Goal::AtMost(2.0, "x")), Delays { answer: Some("2..8ms"), baud: Some(9600) })
}

/// Controllers that answer at once: what is left is the work of this machine, for both ends.
fn at_once(effort: &Effort) -> anyhow::Result<Table> {
    let table = Table::new(format!("status of {} controllers that answer at once", total(effort)));
    compare(table, effort, None, Delays::default())
}

fn total(effort: &Effort) -> usize {
    effort.fleet.iter().sum()
}

fn compare(mut table: Table, effort: &Effort, goal: Option<Goal>, delays: Delays) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let inventory = folder.path().join("robots.toml");
    std::fs::write(&inventory, serve(effort.fleet, delays, 1)?)?;
    let ask = |who: &'static str| {
        let mut command = status(&inventory, folder.path(), who);
        move || {
            let status = command.status()?;
            ensure!(status.success(), "{command:?} ended with {status}");
            Ok(())
        }
    };
    let [mut all, mut yerc, mut toyo, mut yrcx] = [ask("*"), ask("yerc0"), ask("toyo0"), ask("yrcx0")];
    let times = in_turn(effort.rounds, [&mut all, &mut yerc, &mut toyo, &mut yrcx])?;
    let [all, ones @ ..] = &times;
    for (family, times) in FAMILIES.iter().zip(ones) {
        table.row(Row::new(family, format!("{:.1} ms", median(times) * 1e3)));
    }
    let slowest = ones.iter().max_by(|a, b| median(a).total_cmp(&median(b))).context("there are families")?;
    let times = ratio(all, slowest);
    let row = Row::new("all of them", format!("{:.1} ms ({times:.2} x)", median(all) * 1e3));
    table.row(match goal {
        Some(goal) => row.goal(times, goal),
        None => row,
    });
    Ok(table)
}

fn status(inventory: &Path, home: &Path, who: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.arg("--config").arg(inventory).args(["-r", who, "status", "--json"]);
    command.env_clear().env("HOME", home).stdin(Stdio::null()).stdout(Stdio::null());
    command
}

//! Duration of `armctl status` for a fleet of mixed families, compared with the slowest controller of the fleet alone.
//!
//! The benchmark runs complete processes with one inventory. The controllers are simulators on the loopback interface,
//! all in this process, so they share the CPU cores with the command. `cargo bench --bench fleet` measures 200
//! controllers. `-- --quick` and `cargo test --benches` only check that the benchmark works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};

use common::controllers::{Delays, FAMILIES, serve};
use common::table::{Goal, Row, Table};
use common::{median, ratio, run, run_alternately};

/// Number of controllers of yerc, toyo and yrcx, and number of runs.
struct Effort {
    fleet: [usize; 3],
    rounds: usize,
}

const FULL: Effort = Effort { fleet: [140, 40, 20], rounds: 21 };
const QUICK: Effort = Effort { fleet: [4, 2, 2], rounds: 1 };

/// Comparisons, by their argument.
const COMPARISONS: [(&str, common::Compare<Effort>); 2] = [("lines", lines), ("at-once", parallel_queries)];

fn main() -> anyhow::Result<()> {
    run(&COMPARISONS, &FULL, &QUICK)
}

/// Measures realistic controllers: a Yaskawa controller answers after some milliseconds, a Toyo controller has a line
/// of 9600 baud.
fn lines(effort: &Effort) -> anyhow::Result<Table> {
    let table = Table::new(format!("status of {} controllers on lines as they are", total(effort)));
    compare(table, effort, Some(Goal::AtMost(2.0, "x")), Delays { answer: Some("2..8ms"), baud: Some(9600) })
}

/// Measures controllers that answer at once. Only the work of this machine remains, for command and controllers.
fn parallel_queries(effort: &Effort) -> anyhow::Result<Table> {
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
    let times = run_alternately(effort.rounds, [&mut all, &mut yerc, &mut toyo, &mut yrcx])?;
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

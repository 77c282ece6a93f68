//! Measurement of `armctl top`.

use std::process::Command;
use std::time::{Duration, Instant};

use anyhow::ensure;

use crate::common::controllers::{Delays, serve};
use crate::common::process::cpu_time;
use crate::common::run;
use crate::common::table::{Goal, Row, Table};
use crate::terminal::Terminal;

/// Number of controllers of yerc, toyo and yrcx, and duration.
struct Effort {
    fleet: [usize; 3],
    time: Duration,
    every: &'static str,
}

const FULL: Effort = Effort { fleet: [40, 5, 5], time: Duration::from_secs(10), every: "100ms" };
const QUICK: Effort = Effort { fleet: [2, 1, 1], time: Duration::from_millis(300), every: "100ms" };

/// Maximum percentage of a CPU core.
const QUARTER: f64 = 25.0;

pub fn main() -> anyhow::Result<()> {
    run(&[("top", top)], &FULL, &QUICK)
}

/// Measures all robots in a list, and one robot in detail.
fn top(effort: &Effort) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("robots.toml");
    std::fs::write(&path, serve(effort.fleet, Delays::default(), 1)?)?;
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command.args(["top", "--watch", effort.every]).env("ARMCTL_CONFIG", &path).env("TERM", "xterm-256color");
    command.env("LANG", "C.UTF-8").env("XDG_RUNTIME_DIR", folder.path()).env_remove("NO_COLOR");
    let mut terminal = Terminal::start(command, 120, 60)?;
    let count: usize = effort.fleet.iter().sum();
    terminal.wait_for_picture(&format!("{count} robots · {count} answer"));
    let in_list = share(&mut terminal, effort.time)?;
    terminal.press("\r");
    terminal.wait_for_picture("SIGNALS");
    let on_screen = share(&mut terminal, effort.time)?;
    terminal.press("q");
    ensure!(terminal.end().success(), "top did not end well");
    let mut table = Table::new(format!("top: {count} robots every {}, of one core", effort.every));
    let goal = Goal::AtMost(QUARTER, "% of a core");
    table.row(Row::new("all in the list", format!("{in_list:.1} %")).goal(in_list, goal));
    table.row(Row::new("one on its screen, the others go on", format!("{on_screen:.1} %")).goal(on_screen, goal));
    Ok(table)
}

/// Returns the CPU time during this time, as a percentage of a CPU core.
fn share(terminal: &mut Terminal, time: Duration) -> anyhow::Result<f64> {
    let (began, before) = (Instant::now(), cpu_time(terminal.child.id())?);
    while began.elapsed() < time {
        ensure!(terminal.read(), "top wrote nothing any more");
    }
    let used = cpu_time(terminal.child.id())?.saturating_sub(before);
    Ok(100.0 * used.as_secs_f64() / began.elapsed().as_secs_f64())
}

//! Duration of reads through a session, over each fieldbus. Complete processes are compared with a process that only
//! prints its version, and with a process that does nothing. Signals are part of the cyclic data. A status needs remote
//! commands for servos and position, and each of these takes some cycles of the fieldbus. The controllers are `armctl
//! sim` in other processes; the PROFINET controller runs in another network namespace.

use std::process::{Command, Stdio};

use anyhow::{Context as _, ensure};

use super::common::table::{Goal, Row, Table};
use super::common::{Work, median, run_alternately};
use super::{Effort, namespaces};

/// Script that starts controllers with a session each, and then this program for the measurement.
const CHILD_VARIABLE: &str = r#"
export HOME="$FOLDER" XDG_RUNTIME_DIR="$FOLDER" XDG_CONFIG_HOME="$FOLDER/config"
unset ARMCTL_TARGET ARMCTL_ROBOT
serve() {
    name=$1 options=$2
    shift 2
    "$@" > "$FOLDER/$name.sim" 2>&1 & ALL="$ALL $!"
    wait_for '^reach it' "$FOLDER/$name.sim" $!
    target=$(sed -n "s/^reach it: .* -t '\(.*\)' yrcx.*/\1/p" "$FOLDER/$name.sim" | sed 's/@IFACE/@pc0/')
    "$ARMCTL" robots add $name "$target$options" --family yrcx > /dev/null || cat "$FOLDER/$name.sim"
    "$ARMCTL" -r $name --yes session open --background > /dev/null
}
serve eip '?rpi=5ms' "$ARMCTL" sim yrcx
serve devicenet '' "$ARMCTL" sim yrcx --bus devicenet
serve profibus '' "$ARMCTL" sim yrcx --bus profibus
serve profinet '' $THERE "$ARMCTL" sim yrcx --bus profinet --interface pd0
ROLE=status "$PROGRAM"
"$ARMCTL" session close --all > /dev/null
kill $ALL
wait
"#;

/// Commands, with their names in the table. The goal applies to signals.
const RUNS: [(&str, &[&str]); 10] = [
    ("true", &[]),
    ("armctl --version", &["--version"]),
    ("EtherNet/IP: signals", &["-r", "eip", "yrcx", "io", "get"]),
    ("EtherNet/IP: status", &["-r", "eip", "yrcx", "status"]),
    ("DeviceNet: signals", &["-r", "devicenet", "yrcx", "io", "get"]),
    ("DeviceNet: status", &["-r", "devicenet", "yrcx", "status"]),
    ("PROFIBUS DP: signals", &["-r", "profibus", "yrcx", "io", "get"]),
    ("PROFIBUS DP: status", &["-r", "profibus", "yrcx", "status"]),
    ("PROFINET IO: signals", &["-r", "profinet", "yrcx", "io", "get"]),
    ("PROFINET IO: status", &["-r", "profinet", "yrcx", "status"]),
];

pub fn compare(effort: &Effort) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    let program = std::env::current_exe()?;
    let commands = effort.commands.to_string();
    let variables = [
        ("PROGRAM", program.to_str().context("its path is UTF-8")?),
        ("ARMCTL", env!("CARGO_BIN_EXE_armctl")),
        ("FOLDER", folder.path().to_str().context("its path is UTF-8")?),
        ("COMMANDS", commands.as_str()),
    ];
    let mut table = Table::new("a controller seen through a session, whole processes: median, and 99 of 100 within");
    let Some(said) = namespaces::run(CHILD_VARIABLE, &variables) else {
        table.row(Row::new(namespaces::SKIPPED, String::new()));
        return Ok(table);
    };
    let figures: Vec<(f64, f64)> = said.lines().filter_map(figures).collect();
    ensure!(figures.len() == RUNS.len(), "{said}");
    for ((name, _), (median, most)) in RUNS.into_iter().zip(figures) {
        let row = Row::new(name, format!("{median:.2} ms, {most:.2} ms"));
        table.row(if name.ends_with("signals") { row.goal(median, Goal::AtMost(5.0, "ms")) } else { row });
    }
    Ok(table)
}

/// Parses a line of [`measure`] for one command.
fn figures(line: &str) -> Option<(f64, f64)> {
    let (median, most) = line.strip_prefix("measured ")?.split_once(' ')?;
    Some((median.parse().ok()?, most.parse().ok()?))
}

/// Runs all commands in turn. Prints a line for each with median and 99th percentile in milliseconds.
pub fn measure() -> anyhow::Result<()> {
    let rounds = std::env::var("COMMANDS")?.parse()?;
    let mut works = RUNS.map(|(_, words)| move || run(words));
    let times = run_alternately(rounds, works.each_mut().map(|work| work as &mut dyn Work))?;
    for mut times in times {
        times.sort_by(f64::total_cmp);
        let most = times.get(times.len() * 99 / 100).copied().unwrap_or(f64::NAN);
        println!("measured {} {}", median(&times) * 1000.0, most * 1000.0);
    }
    Ok(())
}

/// Runs a command to its end. Without words, runs a process that does nothing.
fn run(words: &[&str]) -> anyhow::Result<()> {
    let mut command = Command::new(if words.is_empty() { "true" } else { env!("CARGO_BIN_EXE_armctl") });
    let status = command.args(words).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).status()?;
    ensure!(status.success(), "armctl {}: {status}", words.join(" "));
    Ok(())
}

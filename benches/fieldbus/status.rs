//! How long it takes to see a controller through a session, over each fieldbus: whole processes, from start to end, beside one
//! that only says its version. Signals are what passes by itself; a status asks remote commands for servos and position, which
//! take some cycles of the fieldbus each.

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::ensure;

use super::Effort;
use super::common::table::{Goal, Row, Table};
use super::common::{in_turn, median};

/// The robots, by the fieldbus that each is simulated on.
const ROBOTS: [&str; 4] = ["eip", "devicenet", "profibus", "profinet"];

pub fn compare(effort: &Effort) -> anyhow::Result<Table> {
    let folder = tempfile::tempdir()?;
    for robot in ROBOTS {
        let target = format!("sim:?bus={robot}");
        armctl(folder.path(), &["robots", "add", robot, &target, "--family", "yrcx"])?;
        armctl(folder.path(), &["-r", robot, "--yes", "session", "open", "--background"])?;
    }
    let commands = |words: &'static [&'static str]| {
        let folder = folder.path();
        ROBOTS.map(|robot| move || armctl(folder, &[&["-r", robot, "yrcx"], words].concat()))
    };
    let (mut signals, mut statuses) = (commands(&["io", "get"]), commands(&["status"]));
    let [eip, devicenet, profibus, profinet] = &mut signals;
    let [of_eip, of_devicenet, of_profibus, of_profinet] = &mut statuses;
    let mut bare = || armctl(folder.path(), &["--version"]);
    let times = in_turn(
        effort.commands,
        [&mut bare, eip, of_eip, devicenet, of_devicenet, profibus, of_profibus, profinet, of_profinet],
    );
    armctl(folder.path(), &["session", "close", "--all"])?;
    let times = times?.map(|times| median(&times) * 1000.0);
    let mut table = Table::new("a controller seen through a session, whole processes");
    let names = [
        "armctl --version",
        "EtherNet/IP: signals",
        "EtherNet/IP: status",
        "DeviceNet: signals",
        "DeviceNet: status",
        "PROFIBUS DP: signals",
        "PROFIBUS DP: status",
        "PROFINET IO: signals",
        "PROFINET IO: status",
    ];
    for (name, time) in names.into_iter().zip(times) {
        let row = Row::new(name, format!("{time:.2} ms"));
        table.row(if name.ends_with("signals") { row.goal(time, Goal::AtMost(5.0, "ms")) } else { row });
    }
    Ok(table)
}

/// Runs to its end with an inventory and sessions of its own.
fn armctl(folder: &Path, arguments: &[&str]) -> anyhow::Result<()> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    command
        .args(arguments)
        .env("HOME", folder)
        .env("XDG_RUNTIME_DIR", folder)
        .env("XDG_CONFIG_HOME", folder.join("config"));
    command.env_remove("ARMCTL_TARGET").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let status = command.status()?;
    ensure!(status.success(), "armctl {}: {status}", arguments.join(" "));
    Ok(())
}

//! Whole processes: how they are started, and their statistics on Linux.

use std::fs;
use std::process::{Command, Stdio};
use std::thread;
use std::time::Duration;

use anyhow::{Context as _, ensure};

/// Interval at which the memory is read. The value is a high-water mark, so only an increase after the last read can be
/// missed.
const POLL_INTERVAL: Duration = Duration::from_millis(2);

/// CPU time of a process (proc(5)): fields 14 and 15, in hundredths of a second.
pub fn cpu_time(process: u32) -> anyhow::Result<Duration> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).context("this takes a Linux with /proc")?;
    // The name of the process is in parentheses and can contain blanks.
    let (_, fields) = stat.rsplit_once(')').context("no name in /proc")?;
    let fields: Vec<&str> = fields.split_ascii_whitespace().collect();
    let ticks = |at: usize| -> anyhow::Result<u64> { Ok(fields.get(at).context("too few fields in /proc")?.parse()?) };
    Ok(Duration::from_millis(10 * (ticks(11)? + ticks(12)?)))
}

/// Memory of a process in MB.
pub fn memory(process: u32) -> anyhow::Result<f64> {
    let status = fs::read_to_string(format!("/proc/{process}/status"))?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).context("no memory in /proc")?;
    let kilobytes: f64 = line.trim().trim_end_matches(" kB").parse()?;
    Ok(kilobytes * 1024.0 / 1e6)
}

/// Returns a command with the binary of the same build, without settings of the user.
pub fn unconfigured() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_armctl"));
    for name in ["ARMCTL_CONFIG", "ARMCTL_TARGET", "ARMCTL_TIMEOUT", "ARMCTL_RETRIES", "ARMCTL_ENCODING"] {
        command.env_remove(name);
    }
    run_silently(command)
}

/// Returns a process that only starts and ends.
pub fn run_empty_process() -> Command {
    run_silently(Command::new("true"))
}

fn run_silently(mut command: Command) -> Command {
    command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command
}

/// Runs a process to its end.
pub fn assert_success(command: &mut Command) -> anyhow::Result<()> {
    let status = command.status()?;
    ensure!(status.success(), "{command:?} ended with {status}");
    Ok(())
}

/// Measures the peak resident memory in bytes.
pub fn peak_memory(command: &mut Command) -> anyhow::Result<u64> {
    let mut child = command.spawn()?;
    let path = format!("/proc/{}/status", child.id());
    let mut peak = None;
    let status = loop {
        if let Some(bytes) = fs::read_to_string(&path).ok().as_deref().and_then(high_water) {
            peak = Some(bytes);
        }
        if let Some(status) = child.try_wait()? {
            break status;
        }
        thread::sleep(POLL_INTERVAL);
    };
    ensure!(status.success(), "{command:?} ended with {status}");
    peak.context("this system has no /proc that tells the memory of a process")
}

/// Parses the line `VmHWM:  1234 kB`.
fn high_water(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix(" kB")?.parse::<u64>().ok().map(|kib| kib * 1024)
}

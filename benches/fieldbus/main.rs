//! Costs of the fieldbuses of a yrcx controller: exchanges compared with the theoretical bit times, comparison of
//! masters, and the duration of a command through a session.
//!
//! `cargo bench --bench fieldbus` measures everything, with `-- devicenet profibus masters status profinet devices`
//! only the named parts. `-- --quick` and `cargo test --benches` only check that the benchmark works. Lines in virtual
//! time do not depend on this machine. Comparisons with network namespaces also run this program inside of the
//! namespaces; the variable `ROLE` selects its part.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[path = "../common/mod.rs"]
mod common;
#[cfg(target_os = "linux")]
mod devices;
#[cfg(unix)]
mod masters;
#[cfg(target_os = "linux")]
#[path = "../../tests/profinet/namespaces.rs"]
mod namespaces;
#[cfg(target_os = "linux")]
mod profinet;
#[cfg(target_os = "linux")]
mod status;
mod virtual_time;

use std::time::Duration;

use common::run;

/// Amount of work.
struct Effort {
    /// Number of exchanges for a line in virtual time.
    exchanges: u32,
    /// Duration of each run of a master, and number of runs.
    time: Duration,
    rounds: usize,
    /// Number of commands through each session.
    commands: usize,
}

const FULL: Effort = Effort { exchanges: 2000, time: Duration::from_secs(3), rounds: 5, commands: 200 };
const QUICK: Effort = Effort { exchanges: 20, time: Duration::from_millis(100), rounds: 1, commands: 1 };

/// Comparisons, by their argument.
const COMPARISONS: &[(&str, common::Compare<Effort>)] = &[
    ("devicenet", virtual_time::devicenet),
    ("profibus", virtual_time::profibus),
    #[cfg(unix)]
    ("masters", masters::compare),
    #[cfg(target_os = "linux")]
    ("status", status::compare),
    #[cfg(target_os = "linux")]
    ("profinet", profinet::compare),
    #[cfg(target_os = "linux")]
    ("devices", devices::compare),
];

fn main() -> anyhow::Result<()> {
    #[cfg(target_os = "linux")]
    match std::env::var("ROLE").as_deref() {
        Ok("controller") => return profinet::controller(),
        Ok("bare") => return profinet::bare_loop(),
        Ok("status") => return status::measure(),
        Ok("devices") => return devices::hold(),
        _ => {}
    }
    run(COMPARISONS, &FULL, &QUICK)
}

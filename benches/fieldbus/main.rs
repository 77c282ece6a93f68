//! What the fieldbuses of a yrcx cost: exchanges beside what the bits of their lines allow, masters side by side, and how long
//! a command takes through a session.
//!
//! `cargo bench --bench fieldbus` measures everything, with `-- devicenet profibus masters status profinet devices` only that;
//! `-- --quick`, and `cargo test --benches`, only show that all of it works. Lines of virtual time do not depend on this machine.
//! What needs network namespaces runs this program inside them as well, told by `ROLE` what it is there.

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

/// How much is measured.
struct Effort {
    /// Exchanges of a line in virtual time.
    exchanges: u32,
    /// For how long each master runs, and how often they take turns.
    time: Duration,
    rounds: usize,
    /// Commands through each session.
    commands: usize,
}

const FULL: Effort = Effort { exchanges: 2000, time: Duration::from_secs(3), rounds: 5, commands: 200 };
const QUICK: Effort = Effort { exchanges: 20, time: Duration::from_millis(100), rounds: 1, commands: 1 };

/// The comparisons, by the word that chooses one.
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
        Ok("bare") => return profinet::bare(),
        Ok("status") => return status::measure(),
        Ok("devices") => return devices::hold(),
        _ => {}
    }
    run(COMPARISONS, &FULL, &QUICK)
}

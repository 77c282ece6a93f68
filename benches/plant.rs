//! What `armctl serve metrics` takes of the machine to look at the controllers of a plant once a second.
//!
//! The controllers are simulated, of all families, on the loopback and in this process; the command is a process of its
//! own, and is read every five seconds as Prometheus would. What it used of the processor, the kernel's part included,
//! and of the memory is what Linux counts for it.
//!
//! `cargo bench --bench plant` watches 500 controllers for a minute, `-- --seconds=600` for ten; `-- --quick`, and
//! `cargo test --benches`, only show that it works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[cfg(all(unix, feature = "plant"))]
#[path = "common/mod.rs"]
mod common;
#[cfg(all(unix, feature = "plant"))]
#[path = "plant/measure.rs"]
mod measure;

#[cfg(all(unix, feature = "plant"))]
fn main() -> anyhow::Result<()> {
    measure::main()
}

#[cfg(not(all(unix, feature = "plant")))]
fn main() {
    println!("this takes Linux, and the feature `plant`");
}

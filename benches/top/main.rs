//! How much of a core `armctl top` takes to look at 50 controllers ten times a second.
//!
//! The controllers are simulated, on the loopback, in threads of this process: most of them yerc, some toyo and yrcx.
//! `top` is a process of its own, on a pseudo-terminal whose output is read as it comes; what it used of the processor
//! while it showed them is what Linux counts for it, the kernel's part included.
//!
//! `cargo bench --bench top`; `-- --quick`, and `cargo test --benches`, only show that it works.

#![expect(clippy::print_stdout, reason = "a benchmark reports to whoever runs it")]

#[cfg(unix)]
#[path = "../common/mod.rs"]
mod common;
#[cfg(unix)]
mod measure;
#[cfg(unix)]
#[path = "../../tests/support/terminal.rs"]
mod terminal;

#[cfg(unix)]
fn main() -> anyhow::Result<()> {
    measure::main()
}

#[cfg(not(unix))]
fn main() {
    println!("this takes a pseudo-terminal, which only Unix has");
}

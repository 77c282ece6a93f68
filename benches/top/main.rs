//! CPU time of `armctl top`, which polls 50 controllers ten times per second.
//!
//! The controllers are simulated on the loopback interface in threads of this process: most of them yerc, some toyo and
//! yrcx. `top` is a separate process on a pseudo-terminal, and its output is read. The CPU time of `top` is read from
//! the statistics of Linux, including the kernel.
//!
//! The benchmark is `cargo bench --bench top`. `-- --quick` and `cargo test --benches` only check that it works.

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

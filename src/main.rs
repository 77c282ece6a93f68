//! The `armctl` binary: words in, exit code out. `armctl::app` is where it begins.

use std::process::ExitCode;

fn main() -> ExitCode {
    armctl::app::main(std::env::args_os())
}

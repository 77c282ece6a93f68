//! The `armctl` binary. `armctl::app` contains the program.

use std::process::ExitCode;

fn main() -> ExitCode {
    armctl::app::main(std::env::args_os())
}

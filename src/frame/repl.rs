//! Arguments of `armctl repl`; `crate::app` runs it.

use clap::Args;

/// Arguments of `repl`: only the options of every command, which apply to each line.
#[derive(Debug, Args)]
#[command(after_help = "For lines and keys, see `armctl help repl`.")]
pub struct Repl {}

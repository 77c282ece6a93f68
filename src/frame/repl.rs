//! Arguments of `armctl repl`; `crate::app` runs it.

use clap::Args;

/// Arguments of `repl`. There are only the options of every command, and they apply to each line.
#[derive(Debug, Args)]
#[command(after_help = "For lines and keys, see `armctl help repl`.")]
pub struct Repl {}

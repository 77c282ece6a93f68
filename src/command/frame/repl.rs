//! `armctl repl`: what its command line says; `crate::app` runs it.

use clap::Args;

/// Arguments of `repl`: none beside the flags of every command, which are those of each line.
#[derive(Debug, Args)]
#[command(after_help = "Lines and keys: `armctl help repl`.")]
pub struct Repl {}

//! Arguments of `armctl batch`; `crate::app` runs it.

use std::path::PathBuf;

use armctl_controller::user_input;
use clap::Args;

/// Arguments of `batch`.
#[derive(Debug, Args)]
#[command(after_help = "For the file format, see `armctl help batch`.")]
pub struct Batch {
    /// File with one command per line, each with its family; - means stdin
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Continue after a failed line
    #[arg(short, long)]
    pub keep_going: bool,
    /// Value of ${NAME} in the file (repeatable)
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = user_input::split_setting(text, "a name", "a value", "SPEED=50")?;
    if is_name(name) { Ok((name.to_owned(), value.to_owned())) } else { Err(format!("'{name}' is not a valid name")) }
}

/// Whether a name consists of letters, digits and underscores.
pub fn is_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c == '_' || c.is_ascii_alphanumeric())
}

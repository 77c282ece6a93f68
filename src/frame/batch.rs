//! Arguments of `armctl batch` and `armctl rehearse`; `crate::app` runs them.

use clap::ValueHint;

use crate::prelude::basics::*;
use armctl_controller::simulator::run_options::Speed;

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

/// Arguments of `rehearse`.
#[derive(Debug, Args)]
#[command(
    after_help = "The robots of the backup become simulators in this process, under their names. armctl runs the \
                  commands on them, waits until they are idle, and reports what changed on each robot, how it moved, \
                  what needs a confirmation and what failed. Nothing is sent to a robot: a line that selects a robot \
                  by address is rejected. A command without --yes continues as if you had confirmed it.\n\nThe exit \
                  code is the exit code of the commands. See `armctl help simulator`."
)]
pub struct Rehearse {
    /// File with one command per line, as for `armctl batch`; - means stdin
    #[arg(value_name = "FILE", required_unless_present = "command", conflicts_with = "command")]
    pub file: Option<PathBuf>,
    /// Backup of a robot, or of several robots (`armctl backup --all FOLDER`)
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub from: PathBuf,
    /// Speed of the simulated time, such as 10x. Times in the commands, such as --for 5s, stay real times
    #[arg(long, value_name = "FACTOR", default_value_t)]
    pub speed: Speed,
    /// Longest wait for the end of motions and programs after the last command
    #[arg(long, value_name = "TIME", default_value = "1m", value_parser = duration::parse)]
    pub settle: Duration,
    /// Continue after a failed line
    #[arg(short, long)]
    pub keep_going: bool,
    /// Value of ${NAME} in the file (repeatable)
    #[arg(long, value_name = "NAME=VALUE", value_parser = assignment)]
    pub set: Vec<(String, String)>,
    /// A command instead of a file, after `--`
    #[arg(last = true, value_name = "COMMAND")]
    pub command: Vec<String>,
}

/// Whether a name consists of letters, digits and underscores.
pub fn is_name(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c == '_' || c.is_ascii_alphanumeric())
}

//! Start of the user's editor, which uses the terminal until it ends.

use std::io;
use std::path::Path;
use std::process::{Command, ExitStatus};

/// Starts an editor, given by the words of its command line, on a file. Waits until it ends.
pub fn wait_for(words: &[String], path: &Path) -> io::Result<ExitStatus> {
    let (program, arguments) = words.split_first().ok_or(io::ErrorKind::InvalidInput)?;
    Command::new(program).args(arguments).arg(path).status()
}

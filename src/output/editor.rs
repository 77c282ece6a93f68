//! The editor of the user, which has the terminal until it ends.

use std::io;
use std::path::Path;
use std::process::{Command, ExitStatus};

/// Starts an editor, named by the words of its command line, on a file, and waits until it has ended.
///
/// # Errors
/// It cannot be started.
pub fn wait_for(words: &[String], path: &Path) -> io::Result<ExitStatus> {
    let (program, arguments) = words.split_first().ok_or(io::ErrorKind::InvalidInput)?;
    Command::new(program).args(arguments).arg(path).status()
}

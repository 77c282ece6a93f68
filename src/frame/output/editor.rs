//! Start of the user's editor. The editor uses the terminal until it ends.

use std::io;
use std::path::Path;
use std::process::{Command, ExitStatus};

/// Starts an editor for a file, and waits until the editor ends. `words` is the command line of the editor.
pub fn wait_for(words: &[String], path: &Path) -> io::Result<ExitStatus> {
    let (program, arguments) = words.split_first().ok_or(io::ErrorKind::InvalidInput)?;
    Command::new(program).args(arguments).arg(path).status()
}

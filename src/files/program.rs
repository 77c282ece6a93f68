//! This very program, to start it again.

use std::io;
use std::path::{Path, PathBuf};

/// Path of the file that this process runs, also where an update has removed it or put another in its place: another
/// version may not take the words of this one, and a stop must not fail because of an update.
///
/// # Errors
/// What the system says when it does not tell the path.
pub fn this_program() -> io::Result<PathBuf> {
    let path = std::env::current_exe()?;
    // The usual path where there is one: lists of processes show it.
    let own = Path::new("/proc/self/exe");
    Ok(if !path.exists() && own.exists() { own.to_owned() } else { path })
}

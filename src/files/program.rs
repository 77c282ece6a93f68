//! Path of the running program. It is used to start the program again.

use std::io;
use std::path::{Path, PathBuf};

/// Path that starts the executable of this process, even if an update has removed or replaced the file. Another version
/// may not accept the same arguments, and a stop of the robot must not fail because of an update.
///
/// # Errors
/// The system does not report the path.
pub fn this_program() -> io::Result<PathBuf> {
    let path = std::env::current_exe()?;
    // Use the normal path if it still exists, because process lists show this path.
    let own = Path::new("/proc/self/exe");
    Ok(if !path.exists() && own.exists() { own.to_owned() } else { path })
}

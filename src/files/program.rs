//! Path of the running program, to start it again.

use std::io;
use std::path::{Path, PathBuf};

/// Path of the executable of this process, even if an update removed or replaced it. Another version may not accept
/// the same arguments, and a stop must not fail because of an update.
///
/// # Errors
/// The system does not report the path.
pub fn this_program() -> io::Result<PathBuf> {
    let path = std::env::current_exe()?;
    // The normal path if it exists, because process lists show it.
    let own = Path::new("/proc/self/exe");
    Ok(if !path.exists() && own.exists() { own.to_owned() } else { path })
}

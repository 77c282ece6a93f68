//! Other processes of this program.

use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

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

/// Environment variable of a process that this program started: number of processes of this program above it. The
/// arguments of the process contain all subcommands, so the name of the executable adds none. A copy of the executable
/// may have the name of a family.
const STARTED_BY_ITSELF: &str = "ARMCTL_CHILD";
/// Maximum number of processes in such a chain; a guardian of a session in the background has two above it. If this code
/// is in another program, such as a test, that program may start itself again and again.
const MAX_GENERATIONS: u8 = 5;

/// Creates a command that starts this program in its own process group. Ctrl-C and a closed terminal do not reach this
/// group.
///
/// # Errors
/// The errors of [`this_program`]; or this process is the last of a chain that is too long.
pub fn own_command() -> io::Result<Command> {
    let above = std::env::var(STARTED_BY_ITSELF).map_or(0, |above| above.parse().unwrap_or(MAX_GENERATIONS));
    if above >= MAX_GENERATIONS {
        return Err(io::Error::other("internal error: the program starts itself again and again"));
    }
    let mut command = Command::new(this_program()?);
    command.env(STARTED_BY_ITSELF, (above + 1).to_string());
    leave_process_group(&mut command);
    Ok(command)
}

/// Whether [`own_command`] started this process.
pub fn was_started_by_itself() -> bool {
    std::env::var_os(STARTED_BY_ITSELF).is_some()
}

#[cfg(unix)]
fn leave_process_group(command: &mut Command) {
    std::os::unix::process::CommandExt::process_group(command, 0);
}

/// Gives the process its own console without a window. A closed console window ends all processes of its console.
#[cfg(windows)]
fn leave_process_group(command: &mut Command) {
    const CREATE_NEW_PROCESS_GROUP: u32 = 0x200;
    const CREATE_NO_WINDOW: u32 = 0x0800_0000;

    std::os::windows::process::CommandExt::creation_flags(command, CREATE_NEW_PROCESS_GROUP | CREATE_NO_WINDOW);
}

//! Terminal settings. They are saved so that they can be restored: the editor may wait for a key when the process must
//! end.

use std::time::Duration;

use tokio::time::sleep;

use armctl_frame::output::prompt;

/// Number of checks whether the editor has changed the terminal settings. `RETRY_PAUSE` is the pause between two
/// checks.
const TRIES: u32 = 40;
const RETRY_PAUSE: Duration = Duration::from_millis(5);

/// The terminal on which the prompt runs.
#[derive(Debug)]
pub struct Terminal(());

impl Terminal {
    /// Saves the terminal settings.
    pub fn save() -> Self {
        prompt::save();
        Self(())
    }

    /// Restores the terminal settings while the editor reads a line. First waits until the editor has changed them.
    pub async fn restore_control(&self) {
        for _ in 0..TRIES {
            if Self::is_taken() {
                break;
            }
            sleep(RETRY_PAUSE).await;
        }
        prompt::restore();
    }

    /// Whether the terminal is in raw mode.
    #[cfg(unix)]
    fn is_taken() -> bool {
        let now = rustix::termios::tcgetattr(std::io::stdin());
        // If the terminal is closed, there is no need to wait for the editor.
        now.map_or(true, |now| !now.local_modes.contains(rustix::termios::LocalModes::ICANON))
    }

    #[cfg(not(unix))]
    fn is_taken() -> bool {
        true
    }
}

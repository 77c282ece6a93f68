//! Terminal settings, saved so that they can be restored. The editor can be waiting for a key when the process must
//! end.

use std::time::Duration;

use tokio::time::sleep;

use armctl_frame::output::prompt;

/// Attempts and interval of the check whether the editor has the terminal.
const TRIES: u32 = 40;
const RETRY_PAUSE: Duration = Duration::from_millis(5);

/// The terminal of the prompt.
#[derive(Debug)]
pub struct Terminal(());

impl Terminal {
    /// Saves the settings.
    pub fn save() -> Self {
        prompt::save();
        Self(())
    }

    /// Restores the settings while the editor reads a line. It first waits until the editor has changed them.
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
        // A closed terminal needs no settings.
        now.map_or(true, |now| !now.local_modes.contains(rustix::termios::LocalModes::ICANON))
    }

    #[cfg(not(unix))]
    fn is_taken() -> bool {
        true
    }
}

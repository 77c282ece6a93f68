//! Full-screen mode of the terminal. The terminal is restored at every end of the mode, also after a panic and while
//! the process is suspended.

use std::io::{self, BufWriter, Stdout, Write as _};
use std::mem::ManuallyDrop;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Once};
use std::thread::JoinHandle;
use std::time::Duration;

use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::cursor::{Hide, Show};
use ratatui::crossterm::style::ResetColor;
use ratatui::crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode};
use ratatui::crossterm::{event, execute};
use ratatui::{Frame, Terminal};

pub use ratatui::crossterm::event::{Event, KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

#[cfg(unix)]
use super::immediate_exit;
use super::{Screen, is_dumb};
use crate::failure::Failure;

/// Whether the terminal is in full-screen mode.
static IS_ACTIVE: AtomicBool = AtomicBool::new(false);
/// Ensures that the panic hook is installed once. The hook restores the terminal before it prints.
static OLD_PANIC_HOOK: Once = Once::new();

/// Size of the buffer for a screen update. The buffer allows one write per update.
const BUFFER_SIZE: usize = 64 * 1024;
/// Interval at which the key thread checks whether it must end.
const KEY_POLL: Duration = Duration::from_millis(100);

/// The terminal in full-screen mode. The mode ends when this value is dropped.
#[derive(Debug)]
pub struct Fullscreen {
    /// This value is never dropped, because its drop would panic on a closed terminal. [`restore`] restores the
    /// terminal.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<BufWriter<Stdout>>>>,
}

/// Thread that reads keys and size changes. It ends when this value is dropped.
#[derive(Debug)]
pub struct Keys {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Screen {
    /// Whether stdout is a terminal with cursor control.
    pub fn can_fill(&self) -> bool {
        self.is_stdout_terminal() && !is_dumb()
    }

    /// Whether the terminal can show characters outside ASCII, according to the locale and the terminal type.
    pub fn is_unicode(&self) -> bool {
        let given = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(given);
        is_unicode(given("TERM").as_deref(), locale.as_deref())
    }

    /// Enters full-screen mode.
    pub fn fullscreen(&self) -> Result<Fullscreen, Failure> {
        OLD_PANIC_HOOK.call_once(|| {
            let usual = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |panic| {
                restore();
                usual(panic);
            }));
        });
        let taken = activate()
            .and_then(|()| Terminal::new(CrosstermBackend::new(BufWriter::with_capacity(BUFFER_SIZE, io::stdout()))));
        match taken {
            Ok(terminal) => Ok(Fullscreen { terminal: ManuallyDrop::new(terminal) }),
            Err(error) => {
                restore();
                Err(terminal_lost(&error))
            }
        }
    }
}

impl Fullscreen {
    /// Draws the differences from the last screen.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame<'_>)) -> Result<(), Failure> {
        self.terminal.draw(render).map(|_| ()).map_err(|error| terminal_lost(&error))
    }

    /// Enters full-screen mode again and redraws the whole screen, because another program may have written to the
    /// terminal.
    pub fn refresh(&mut self) -> Result<(), Failure> {
        restore();
        // `clear` would request the cursor position from the terminal, and the terminal's answer would arrive among the
        // keys.
        let mut is_full_redraw = || {
            activate()?;
            let size = self.terminal.size()?;
            self.terminal.resize(size.into())
        };
        is_full_redraw().map_err(|error| terminal_lost(&error))
    }

    /// Restores the terminal and suspends the process, like Ctrl-Z. Returns when the process continues.
    #[cfg(unix)]
    pub fn suspend(&mut self) -> Result<(), Failure> {
        restore();
        immediate_exit::suspend();
        self.refresh()
    }

    /// Does nothing: not supported on this system.
    #[cfg(not(unix))]
    pub fn suspend(&mut self) -> Result<(), Failure> {
        Ok(())
    }
}

impl Drop for Fullscreen {
    fn drop(&mut self) {
        restore();
    }
}

impl Keys {
    /// Starts a thread that reads keys and size changes, and passes them to `tell` until `tell` returns `false`.
    pub fn listen(mut tell: impl FnMut(Event) -> bool + Send + 'static) -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        let watched = Arc::clone(&is_over);
        let thread = std::thread::spawn(move || {
            // If SIGHUP is ignored, as under `nohup`, no signal reports a closed terminal. Without this check, the wait
            // for keys would then become a busy loop.
            while !watched.load(Ordering::Relaxed) && terminal_exists(KEY_POLL) {
                match event::poll(Duration::ZERO) {
                    Ok(false) => {}
                    Ok(true) => {
                        let Ok(event) = event::read() else { return };
                        if !tell(event) {
                            return;
                        }
                    }
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    // The terminal is closed. A signal also reports this.
                    Err(_) => return,
                }
            }
        });
        Self { is_over, thread: Some(thread) }
    }
}

impl Drop for Keys {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::Relaxed);
        // Wait until the thread has ended, so that the next reader gets all keys. If the thread panicked, it has also
        // ended.
        let _ended = self.thread.take().map(JoinHandle::join);
    }
}

/// Whether a key was pressed together with Ctrl. Windows reports AltGr, which types characters such as `<` or `@` on many
/// keyboards, as Ctrl and Alt.
pub fn has_control(key: KeyEvent) -> bool {
    key.modifiers.contains(KeyModifiers::CONTROL) && !key.modifiers.contains(KeyModifiers::ALT)
}

/// Whether stdin is still a terminal. Waits at most `within` for a key.
#[cfg(unix)]
fn terminal_exists(within: Duration) -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let stdin = io::stdin();
    let mut watched = [PollFd::new(&stdin, PollFlags::IN)];
    let within = Timespec::try_from(within).ok();
    // An error is ignored: after an interrupted wait, there are no events.
    let _seen = poll(&mut watched, within.as_ref());
    !watched[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL)
}

#[cfg(not(unix))]
fn terminal_exists(within: Duration) -> bool {
    // The wait also ends at the first key.
    let _seen = event::poll(within);
    true
}

fn activate() -> io::Result<()> {
    IS_ACTIVE.store(true, Ordering::Relaxed);
    enable_raw_mode()?;
    execute!(io::stdout(), EnterAlternateScreen, Hide)
}

/// Restores the terminal. Errors are ignored.
pub fn restore() {
    if IS_ACTIVE.swap(false, Ordering::Relaxed) {
        // The raw mode ends first, because no other thread can block this step.
        let _cooked = disable_raw_mode();
        let _shown = execute!(io::stdout(), ResetColor, LeaveAlternateScreen, Show);
        let _flushed = io::stdout().flush();
    }
}

fn terminal_lost(error: &io::Error) -> Failure {
    Failure::io("the terminal", error)
}

fn is_unicode(terminal: Option<&str>, locale: Option<&str>) -> bool {
    if cfg!(windows) {
        return true;
    }
    let charset = locale.map(|locale| locale.to_ascii_lowercase().replace('-', ""));
    terminal != Some("linux") && charset.is_some_and(|charset| charset.contains("utf8"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn unicode_needs_a_utf8_locale_and_terminal() {
        assert!(is_unicode(Some("xterm"), Some("en_GB.UTF-8")));
        assert!(is_unicode(None, Some("ja_JP.utf8")));
        assert!(!is_unicode(Some("linux"), Some("en_GB.UTF-8")));
        assert!(!is_unicode(Some("xterm"), Some("ja_JP.SJIS")));
        assert!(!is_unicode(Some("xterm"), Some("C")));
        assert!(!is_unicode(Some("xterm"), None));
    }
}

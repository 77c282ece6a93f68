//! The whole terminal as one picture that changes. It is left as it was found on every way out: also after a panic, and
//! while the process is suspended.

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
use super::leave;
use super::{Screen, is_dumb};
use crate::failure::Failure;

/// Whether the terminal is not as it was found.
static IS_TAKEN: AtomicBool = AtomicBool::new(false);
/// A panic restores the terminal before it says anything.
static BEFORE_PANICS: Once = Once::new();

/// Room for a picture, which then leaves in one piece.
const PICTURE: usize = 64 * 1024;
/// How often the thread that waits for keys looks whether it is still wanted.
const GLANCE: Duration = Duration::from_millis(100);

/// The terminal, taken until dropped.
#[derive(Debug)]
pub struct Fullscreen {
    /// Never dropped: [`restore`] gives the terminal back, and where that is gone, the drop of this would break down.
    terminal: ManuallyDrop<Terminal<CrosstermBackend<BufWriter<Stdout>>>>,
}

/// Keys and changes of size, on their way from a thread of their own until dropped.
#[derive(Debug)]
pub struct Keys {
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Screen {
    /// Whether stdout is a terminal that can be drawn on.
    pub fn can_fill(&self) -> bool {
        self.is_stdout_terminal() && !is_dumb()
    }

    /// Whether the terminal shows more than ASCII, as far as the locale and the kind of terminal tell.
    pub fn is_unicode(&self) -> bool {
        let given = |name: &str| std::env::var(name).ok().filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(given);
        is_unicode(given("TERM").as_deref(), locale.as_deref())
    }

    /// Takes the terminal.
    pub fn fullscreen(&self) -> Result<Fullscreen, Failure> {
        BEFORE_PANICS.call_once(|| {
            let usual = std::panic::take_hook();
            std::panic::set_hook(Box::new(move |panic| {
                restore();
                usual(panic);
            }));
        });
        let taken =
            take().and_then(|()| Terminal::new(CrosstermBackend::new(BufWriter::with_capacity(PICTURE, io::stdout()))));
        match taken {
            Ok(terminal) => Ok(Fullscreen { terminal: ManuallyDrop::new(terminal) }),
            Err(error) => {
                restore();
                Err(lost(&error))
            }
        }
    }
}

impl Fullscreen {
    /// Draws what is different from the last picture.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame<'_>)) -> Result<(), Failure> {
        self.terminal.draw(render).map(|_| ()).map_err(|error| lost(&error))
    }

    /// Takes the terminal anew, and forgets what it shows: somebody else may have written on it.
    pub fn refresh(&mut self) -> Result<(), Failure> {
        restore();
        // Not `clear`, which asks the terminal where its cursor is: the answer would come among the keys.
        let mut anew = || {
            take()?;
            let size = self.terminal.size()?;
            self.terminal.resize(size.into())
        };
        anew().map_err(|error| lost(&error))
    }

    /// Gives the terminal back and suspends the process, as Ctrl-Z does. Returns when it goes on.
    #[cfg(unix)]
    pub fn suspend(&mut self) -> Result<(), Failure> {
        restore();
        leave::suspend();
        self.refresh()
    }

    /// There is no such thing here.
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
    /// Waits for keys and changes of size, and tells each until it is told `false`.
    pub fn listen(mut tell: impl FnMut(Event) -> bool + Send + 'static) -> Self {
        let is_over = Arc::new(AtomicBool::new(false));
        let watched = Arc::clone(&is_over);
        let thread = std::thread::spawn(move || {
            // Where hanging up is ignored, as under `nohup`, no signal tells that the terminal is gone; and what waits for
            // keys there spins for ever.
            while !watched.load(Ordering::Relaxed) && is_terminal_there(GLANCE) {
                match event::poll(Duration::ZERO) {
                    Ok(false) => {}
                    Ok(true) => {
                        let Ok(event) = event::read() else { return };
                        if !tell(event) {
                            return;
                        }
                    }
                    Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                    // The terminal is gone; a signal says so as well.
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
        // Whoever reads keys next gets all of them. One that broke down has ended as well.
        let _ended = self.thread.take().map(JoinHandle::join);
    }
}

/// Whether there is still a terminal behind stdin, after a key or at most this time.
#[cfg(unix)]
fn is_terminal_there(within: Duration) -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    let stdin = io::stdin();
    let mut watched = [PollFd::new(&stdin, PollFlags::IN)];
    let within = Timespec::try_from(within).ok();
    // An interrupted wait has seen nothing, which is no sign of an end.
    let _seen = poll(&mut watched, within.as_ref());
    !watched[0].revents().intersects(PollFlags::HUP | PollFlags::ERR | PollFlags::NVAL)
}

#[cfg(not(unix))]
fn is_terminal_there(within: Duration) -> bool {
    // Ends with the first key as well.
    let _seen = event::poll(within);
    true
}

fn take() -> io::Result<()> {
    IS_TAKEN.store(true, Ordering::Relaxed);
    enable_raw_mode()?;
    execute!(io::stdout(), EnterAlternateScreen, Hide)
}

/// Leaves the terminal as it was found; what it does not take any more cannot be helped.
pub fn restore() {
    if IS_TAKEN.swap(false, Ordering::Relaxed) {
        // First what no other thread can hold up.
        let _cooked = disable_raw_mode();
        let _shown = execute!(io::stdout(), ResetColor, LeaveAlternateScreen, Show);
        let _flushed = io::stdout().flush();
    }
}

fn lost(error: &io::Error) -> Failure {
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
    fn signs_beyond_ascii_need_a_locale_and_a_terminal_that_have_them() {
        assert!(is_unicode(Some("xterm"), Some("en_GB.UTF-8")));
        assert!(is_unicode(None, Some("ja_JP.utf8")));
        assert!(!is_unicode(Some("linux"), Some("en_GB.UTF-8")));
        assert!(!is_unicode(Some("xterm"), Some("ja_JP.SJIS")));
        assert!(!is_unicode(Some("xterm"), Some("C")));
        assert!(!is_unicode(Some("xterm"), None));
    }
}

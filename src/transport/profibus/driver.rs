//! Driver that runs a master on its own thread. The data exchange then does not depend on the rest of the program.

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use tokio::sync::watch;

use super::error::ProfibusError;
use super::master::{Master, State, View, Views};
use super::port::Port;
use super::settings::Settings;
use super::survey::{StationResult, Survey};
use super::wire::{Piece, Stream};
use crate::plain;

/// Longest wait at the port. After each wait, the thread checks whether the link was closed.
const READ_TIMEOUT: Duration = Duration::from_millis(10);
/// Pause before the port is reopened after a loss.
const REOPEN_PAUSE: Duration = Duration::from_secs(1);

/// Function that opens the port, for the first time and after a loss.
pub type Opener = Box<dyn FnMut() -> Result<Box<dyn Port>, ProfibusError> + Send>;
/// Function that records each telegram.
pub type Tap = Box<dyn Fn(&[u8]) + Send>;

/// An open link. When it is dropped, the driver releases the slave.
#[derive(Debug)]
pub struct Connection {
    shared: Arc<Shared>,
    pub(super) views: Views,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct Shared {
    master: Mutex<Master>,
    view: watch::Sender<View>,
    start: Instant,
    is_over: AtomicBool,
}

impl Connection {
    /// Opens the port and the link.
    ///
    /// # Errors
    /// The port or the link cannot be opened. A failed first opening is not repeated. A later loss of the link is not
    /// an error here, but a state of the view.
    pub async fn open(settings: Settings, mut opener: Opener, tap: Option<Tap>) -> Result<Self, ProfibusError> {
        let master = Master::new(Duration::ZERO, settings)?;
        let port = opener()?;
        let (view, views) = Views::new(master.view());
        let shared = Arc::new(Shared {
            master: Mutex::new(master),
            view,
            start: Instant::now(),
            is_over: AtomicBool::new(false),
        });
        let on_thread = Arc::clone(&shared);
        let thread = thread::Builder::new().name("profibus".to_owned());
        let thread = thread
            .spawn(move || Driver { shared: on_thread, port: Some(port), opener, tap: tap.map(Record::new) }.run());
        let thread =
            thread.map_err(|error| ProfibusError::Port { port: "thread".to_owned(), text: error.to_string() })?;
        let mut connection = Self { shared, views, thread: Some(thread) };
        connection.views.opened().await?;
        Ok(connection)
    }

    /// Current state.
    pub fn view(&self) -> View {
        self.shared.master().view()
    }

    /// Sends this image, starting with the next cycle; see [`Master::set_image`].
    pub fn set_image(&self, generation: u32, image: &[u8]) -> Result<u64, ProfibusError> {
        self.shared.master().set_image(generation, image)
    }

    /// Releases the slave and closes the link.
    ///
    /// # Errors
    /// The slave did not confirm the release. The slave then releases itself after its watchdog time.
    pub async fn close(mut self) -> Result<(), ProfibusError> {
        let now = self.shared.start.elapsed();
        self.shared.master().close(now);
        self.views.closed(None).await
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        let now = self.shared.start.elapsed();
        self.shared.master().close(now);
        self.shared.is_over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed.
            let _ = thread.join();
        }
    }
}

impl Shared {
    fn master(&self) -> MutexGuard<'_, Master> {
        self.master.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Driver that transfers characters between the master and its port.
struct Driver {
    shared: Arc<Shared>,
    port: Option<Box<dyn Port>>,
    opener: Opener,
    tap: Option<Record>,
}

impl Driver {
    fn run(mut self) {
        loop {
            let outcome = if let Some(mut port) = self.port.take() {
                self.turn(port.as_mut()).map(|()| self.port = Some(port))
            } else {
                self.reopen();
                Ok(())
            };
            if let Err(error) = outcome {
                let now = self.shared.start.elapsed();
                let error = ProfibusError::Gone(plain(&error));
                self.shared.master().port_failed(now, error);
            }
            let mut master = self.shared.master();
            let is_closed = master.view().state == State::Closed;
            if master.take_changed() {
                self.shared.view.send_replace(master.view());
            }
            if is_closed {
                return;
            }
        }
    }

    /// Sends the characters that are due, or waits for characters.
    fn turn(&mut self, port: &mut dyn Port) -> io::Result<()> {
        let (bytes, due) = {
            let mut master = self.shared.master();
            (master.poll(self.shared.start.elapsed()), master.due())
        };
        if let Some(bytes) = bytes {
            self.record(&bytes, true);
            return port.send(&bytes);
        }
        let wait = due.map_or(READ_TIMEOUT, |due| due.saturating_sub(self.shared.start.elapsed()).min(READ_TIMEOUT));
        let mut buffer = [0; 512];
        let len = port.receive(&mut buffer, wait)?;
        if len > 0 {
            self.record(&buffer[..len], false);
            self.shared.master().handle(self.shared.start.elapsed(), &buffer[..len]);
        }
        Ok(())
    }

    /// Reopens the port after a pause.
    fn reopen(&mut self) {
        let until = Instant::now() + REOPEN_PAUSE;
        while Instant::now() < until {
            if self.shared.is_over.load(Ordering::SeqCst) || self.shared.master().view().state != State::Lost {
                break;
            }
            thread::sleep(READ_TIMEOUT);
        }
        let now = self.shared.start.elapsed();
        if self.shared.master().view().state != State::Lost {
            // The link is being closed, but there is no port through which the slave could be released.
            self.shared.master().port_failed(now, ProfibusError::Ended);
            return;
        }
        if let Ok(port) = (self.opener)() {
            self.port = Some(port);
            self.shared.master().port_is_back(self.shared.start.elapsed());
        }
    }

    fn record(&mut self, bytes: &[u8], is_whole: bool) {
        if let Some(record) = &mut self.tap {
            record.pass(bytes, is_whole);
        }
    }
}

/// Recorder that splits the traffic into telegrams and passes them to a tap.
pub(super) struct Record {
    tap: Tap,
    stream: Stream,
}

impl Record {
    pub(super) fn new(tap: Tap) -> Self {
        Self { tap, stream: Stream::default() }
    }

    pub(super) fn pass(&mut self, bytes: &[u8], is_whole: bool) {
        if is_whole {
            self.stream.clear();
            return (self.tap)(bytes);
        }
        self.stream.push(bytes);
        while let Some(piece) = self.stream.next_piece() {
            match piece {
                Piece::Telegram(_, bytes) => (self.tap)(&bytes),
                Piece::Noise(byte, _) => (self.tap)(&[byte]),
            }
        }
    }
}

/// Runs a survey. The call blocks the thread.
pub fn survey(survey: &mut Survey, port: &mut dyn Port, tap: Option<Tap>) -> Result<Vec<StationResult>, ProfibusError> {
    let start = Instant::now();
    let mut record = tap.map(Record::new);
    let gone = |error: io::Error| ProfibusError::Gone(plain(&error));
    let mut buffer = [0; 512];
    loop {
        if let Some(result) = survey.result() {
            return result.map(<[StationResult]>::to_vec);
        }
        if let Some(bytes) = survey.poll(start.elapsed()) {
            if let Some(record) = &mut record {
                record.pass(&bytes, true);
            }
            port.send(&bytes).map_err(gone)?;
            continue;
        }
        let wait = survey.due().saturating_sub(start.elapsed()).min(READ_TIMEOUT);
        let len = port.receive(&mut buffer, wait).map_err(gone)?;
        if let Some(record) = record.as_mut().filter(|_| len > 0) {
            record.pass(&buffer[..len], false);
        }
        if len > 0 {
            survey.handle(start.elapsed(), &buffer[..len]);
        }
    }
}

//! Driver that runs a listener on its own thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::timeout;

use super::driver::{Opener, Record, Tap};
use super::error::ProfibusError;
use super::listener::{BusTraffic, Listener};
use crate::plain;

/// Longest wait at the port. After each wait, the thread checks whether the listener was dropped.
const READ_TIMEOUT: Duration = Duration::from_millis(10);

/// A listener for one station. It listens until it is dropped.
#[derive(Debug)]
pub struct ListenerDriver {
    news: watch::Receiver<Result<BusTraffic, ProfibusError>>,
    /// Traffic that was received so far.
    pub last: BusTraffic,
    station: u8,
    is_over: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl ListenerDriver {
    /// Opens the port and starts to listen.
    pub fn start(station: u8, mut opener: Opener, tap: Option<Tap>) -> Result<Self, ProfibusError> {
        let mut port = opener()?;
        let (tell, news) = watch::channel(Ok(BusTraffic::default()));
        let is_over = Arc::new(AtomicBool::new(false));
        let over = Arc::clone(&is_over);
        let mut record = tap.map(Record::new);
        let hear = move || {
            let mut listener = Listener::new(station);
            let mut buffer = [0; 512];
            while !over.load(Ordering::SeqCst) {
                match port.receive(&mut buffer, READ_TIMEOUT) {
                    Ok(len) => {
                        if let Some(record) = record.as_mut().filter(|_| len > 0) {
                            record.pass(&buffer[..len], false);
                        }
                        if len > 0 {
                            listener.handle(&buffer[..len]);
                            drop(tell.send_replace(Ok(listener.heard.clone())));
                        }
                    }
                    Err(error) => {
                        drop(tell.send_replace(Err(ProfibusError::Gone(plain(&error)))));
                        return;
                    }
                }
            }
        };
        let thread = thread::Builder::new().name("profibus".to_owned()).spawn(hear);
        let thread = thread.map_err(|error| ProfibusError::Port { port: "thread".to_owned(), text: plain(&error) })?;
        Ok(Self { news, last: BusTraffic::default(), station, is_over, thread: Some(thread) })
    }

    /// Waits until `condition` is true, at most for `longest`.
    ///
    /// # Errors
    /// The condition did not become true in time, or the port is gone.
    pub async fn until(
        &mut self,
        longest: Duration,
        mut condition: impl FnMut(&BusTraffic) -> bool,
    ) -> Result<BusTraffic, ProfibusError> {
        let wait = async {
            loop {
                let heard = self.news.borrow_and_update().clone()?;
                self.last = heard;
                if condition(&self.last) || self.news.changed().await.is_err() {
                    return Ok(self.last.clone());
                }
            }
        };
        match timeout(longest, wait).await {
            Ok(heard) => heard,
            Err(_) => Err(ProfibusError::NotHeard {
                station: self.station,
                after: longest,
                telegrams: self.last.telegrams,
                noise: self.last.noise,
            }),
        }
    }
}

impl Drop for ListenerDriver {
    fn drop(&mut self) {
        self.is_over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed.
            let _ = thread.join();
        }
    }
}

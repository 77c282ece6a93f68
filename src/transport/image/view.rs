//! What can be seen of a connection that exchanges images in a cycle of its own, on any fieldbus.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;

use super::LinkError;

/// How a connection is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// Being opened for the first time.
    Opening,
    /// Images travel, or questions can be asked.
    Open,
    /// Lost, or its data cannot be used; being opened again.
    Lost,
    /// Being closed.
    Closing,
    /// At its end: closed, or never opened.
    Closed,
}

/// An image from the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// The bytes.
    pub image: Arc<[u8]>,
    /// When it came.
    pub at: Duration,
    /// In which generation.
    pub generation: u32,
}

/// The errors of a fieldbus, as far as all have the same.
pub trait BusError: Clone + PartialEq + Into<LinkError> {
    /// What was wanted is for an opening that is over.
    const OUTDATED: Self;
    /// The connection is closed.
    const ENDED: Self;
}

/// All that can be seen of a connection: its errors `E`, what is counted on it `S`, and what only its bus has `D`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View<E, S, D> {
    /// How it is doing.
    pub state: State,
    /// Counts the openings; 0 before the first.
    pub generation: u32,
    /// The newest image of the device. It may stay when the connection is lost: compare the generation.
    pub input: Option<Input>,
    /// The newest change of what is shown that has left; where the bus answers, that was answered.
    pub sent: u64,
    /// Why it was lost, or not opened, the last time; while it is open, what went wrong here.
    pub trouble: Option<E>,
    /// What was counted, over all generations.
    pub statistics: S,
    /// What only this bus has.
    pub details: D,
}

impl<E: BusError, S: Default, D> View<E, S, D> {
    /// That of a connection that begins to open.
    pub fn new(details: D) -> Self {
        Self {
            state: State::Opening,
            generation: 0,
            input: None,
            sent: 0,
            trouble: None,
            statistics: S::default(),
            details,
        }
    }

    /// Whether something can be shown that is meant for this generation.
    ///
    /// # Errors
    /// When the connection is lost, was opened anew, or is closed.
    pub fn check(&self, generation: u32) -> Result<(), E> {
        match self.state {
            State::Open if generation == self.generation => Ok(()),
            State::Closing | State::Closed => Err(E::ENDED),
            State::Opening | State::Open | State::Lost => Err(E::OUTDATED),
        }
    }
}

/// The view of a connection as it changes.
#[derive(Debug)]
pub struct Views<E, S, D>(watch::Receiver<View<E, S, D>>);

impl<E: BusError, S: Clone, D: Clone> Views<E, S, D> {
    /// With the end that shows it.
    pub fn new(view: View<E, S, D>) -> (watch::Sender<View<E, S, D>>, Self) {
        let (shows, seen) = watch::channel(view);
        (shows, Self(seen))
    }

    /// What there is to see now.
    pub fn now(&self) -> View<E, S, D> {
        self.0.borrow().clone()
    }

    /// Waits for something new: an image, or a change of state. After the view that says that the connection is closed
    /// nothing comes any more.
    pub async fn changed(&mut self) {
        // The other end goes when all has ended; then nothing changes any more.
        if self.0.changed().await.is_err() {
            std::future::pending::<()>().await;
        }
    }

    /// Waits until the view is so. It never is again once the connection is closed.
    pub async fn until(&mut self, mut condition: impl FnMut(&View<E, S, D>) -> bool) -> View<E, S, D> {
        loop {
            let view = self.0.borrow_and_update().clone();
            if condition(&view) || view.state == State::Closed {
                return view;
            }
            if self.0.changed().await.is_err() {
                return self.now();
            }
        }
    }

    /// Waits until it is open. What does not come about is closed first.
    ///
    /// # Errors
    /// When it does not come about.
    pub async fn opened(&mut self) -> Result<(), E> {
        let view = self.until(|view| !matches!(view.state, State::Opening | State::Closing)).await;
        match view.state {
            State::Closed => Err(view.trouble.unwrap_or(E::ENDED)),
            _ => Ok(()),
        }
    }

    /// Waits until it is closed.
    ///
    /// # Errors
    /// What went wrong with that, as far as it is not what was wrong before.
    pub async fn closed(&mut self, before: Option<&E>) -> Result<(), E> {
        let view = self.until(|view| view.state == State::Closed).await;
        view.trouble.filter(|trouble| before != Some(trouble)).map_or(Ok(()), Err)
    }
}

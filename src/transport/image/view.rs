//! State of a cyclic image connection, the same for every fieldbus.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;

use super::LinkError;

/// State of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// The connection opens for the first time.
    Opening,
    /// The connection is open: images are exchanged, or requests are possible.
    Open,
    /// The connection was lost, or its data is invalid. It is opening again.
    Lost,
    /// The connection is being closed.
    Closing,
    /// The connection is closed, or it could not be opened.
    Closed,
}

/// An image from the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Input {
    /// Bytes of the image.
    pub image: Arc<[u8]>,
    /// Time of arrival.
    pub at: Duration,
    /// Generation of the connection.
    pub generation: u32,
}

/// Errors that every fieldbus has.
pub trait BusError: Clone + PartialEq + Into<LinkError> {
    /// The request is for an older generation.
    const OUTDATED: Self;
    /// The connection is closed.
    const ENDED: Self;
}

/// State of a connection, with error type `E`, counters `S` and bus-specific details `D`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct View<E, S, D> {
    /// State of the connection.
    pub state: State,
    /// Number of times that the connection was opened; 0 before the first opening.
    pub generation: u32,
    /// Newest image from the device. It may have arrived before the last loss; its generation shows this.
    pub input: Option<Input>,
    /// Number of the newest change that was sent. If the fieldbus has confirmations, the number of the newest confirmed
    /// change.
    pub sent: u64,
    /// Cause of the last loss or of the failed opening. While the connection is open, the last local error.
    pub last_error: Option<E>,
    /// Counters over all generations.
    pub statistics: S,
    /// Bus-specific details.
    pub details: D,
}

impl<E: BusError, S: Default, D> View<E, S, D> {
    /// Creates the view of a connection that starts to open.
    pub fn new(details: D) -> Self {
        Self {
            state: State::Opening,
            generation: 0,
            input: None,
            sent: 0,
            last_error: None,
            statistics: S::default(),
            details,
        }
    }

    /// Checks that an image for this generation can be sent.
    ///
    /// # Errors
    /// The connection is lost, was reopened, or is closed.
    pub fn check(&self, generation: u32) -> Result<(), E> {
        match self.state {
            State::Open if generation == self.generation => Ok(()),
            State::Closing | State::Closed => Err(E::ENDED),
            State::Opening | State::Open | State::Lost => Err(E::OUTDATED),
        }
    }
}

/// Receiver of view changes.
#[derive(Debug)]
pub struct Views<E, S, D>(watch::Receiver<View<E, S, D>>);

impl<E: BusError, S: Clone, D: Clone> Views<E, S, D> {
    /// Creates a sender and a receiver.
    pub fn new(view: View<E, S, D>) -> (watch::Sender<View<E, S, D>>, Self) {
        let (sender, receiver) = watch::channel(view);
        (sender, Self(receiver))
    }

    /// Current view.
    pub fn now(&self) -> View<E, S, D> {
        self.0.borrow().clone()
    }

    /// Waits for a change of the image or the state. After the connection is closed, this function never returns.
    pub async fn changed(&mut self) {
        // The sender was dropped with the connection, so no more changes follow.
        if self.0.changed().await.is_err() {
            std::future::pending::<()>().await;
        }
    }

    /// Waits until `condition` is true, or until the connection is closed.
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

    /// Waits until the connection is open. After a failed opening, waits until the connection is closed.
    ///
    /// # Errors
    /// The connection could not be opened.
    pub async fn opened(&mut self) -> Result<(), E> {
        let view = self.until(|view| !matches!(view.state, State::Opening | State::Closing)).await;
        match view.state {
            State::Closed => Err(view.last_error.unwrap_or(E::ENDED)),
            _ => Ok(()),
        }
    }

    /// Waits until the connection is closed. `before` is the error that was known before the close.
    ///
    /// # Errors
    /// A new error during the close.
    pub async fn closed(&mut self, before: Option<&E>) -> Result<(), E> {
        let view = self.until(|view| view.state == State::Closed).await;
        view.last_error.filter(|last_error| before != Some(last_error)).map_or(Ok(()), Err)
    }
}

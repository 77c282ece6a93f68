//! Image connection over a fieldbus with its own cycle and its own thread.

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::view::{BusError, State, View, Views};
use super::{Cause, Event, ImageConnection, LinkError, Outputs, ReportedState, Sizes, Traffic};

/// An open connection of a fieldbus.
pub trait Bus: fmt::Debug + 'static {
    /// Error type of the fieldbus.
    type Error: BusError;
    /// Counters of the fieldbus.
    type Statistics: Clone + Default;
    /// Details that only this fieldbus has.
    type Details: Clone;

    /// State of the connection.
    fn views(&mut self) -> &mut Views<Self::Error, Self::Statistics, Self::Details>;

    /// Sends this image to the device in this generation. Returns the number of the change. When `sent` of the view has
    /// reached this number, the image was sent.
    ///
    /// # Errors
    /// The connection is not open in this generation, or the image has another size.
    fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, Self::Error>;

    /// Converts an image to the byte order of the controller, if the fieldbus uses another byte order.
    fn native_order(&self, image: Arc<[u8]>) -> Arc<[u8]> {
        image
    }

    /// Returns the cause of a loss, and the state of the outputs after the loss.
    fn loss(&self, view: View<Self::Error, Self::Statistics, Self::Details>) -> (Cause, Outputs);

    /// Time without an image after which either end gives the connection up.
    fn watchdog(&self) -> Duration;

    /// Counters of the connection.
    fn traffic(&self) -> Traffic;

    /// Closes the connection.
    fn close(self) -> LocalBoxFuture<'static, Result<(), Self::Error>>;
}

/// An image connection over a [`Bus`].
#[derive(Debug)]
pub struct Cyclic<B> {
    bus: B,
    sizes: Sizes,
    generation: u32,
    /// Number of the change that was not sent yet.
    pending: Option<u64>,
}

impl<B: Bus> Cyclic<B> {
    /// Wraps an open connection.
    pub fn over(mut bus: B, sizes: Sizes) -> Self {
        let generation = bus.views().now().generation;
        Self { bus, sizes, generation, pending: None }
    }

    async fn wait(&mut self, reported: ReportedState<'_>) -> Event {
        loop {
            let view = self.bus.views().now();
            let is_open = view.state == State::Open;
            if reported.is_up && !(is_open && view.generation == self.generation) {
                self.pending = None;
                let (cause, outputs) = self.bus.loss(view);
                return Event::Lost(LinkError::Lost { cause, outputs });
            }
            if !reported.is_up && is_open {
                self.generation = view.generation;
                return Event::Reopened;
            }
            if reported.is_up && self.pending.is_some_and(|change| view.sent >= change) {
                self.pending = None;
                return Event::Sent;
            }
            if let Some(input) = view.input.filter(|input| input.generation == self.generation) {
                let image = self.bus.native_order(input.image);
                if reported.is_new(&image) {
                    return Event::Image(image);
                }
            }
            self.bus.views().changed().await;
        }
    }
}

impl<B: Bus> ImageConnection for Cyclic<B> {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn set_output(&mut self, image: &[u8]) -> Result<(), LinkError> {
        // The previous image must not be reported as sent after this call, even if the call fails.
        self.pending = None;
        match self.bus.set_image(self.generation, image) {
            Ok(change) => {
                self.pending = Some(change);
                Ok(())
            }
            // This error means that the connection was lost. `next` reports the loss.
            Err(error) if error == B::Error::OUTDATED || error == B::Error::ENDED => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(reported).boxed_local()
    }

    fn watchdog(&self) -> Duration {
        self.bus.watchdog()
    }

    fn traffic(&self) -> Option<Traffic> {
        Some(self.bus.traffic())
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        async move { self.bus.close().await.map_err(Into::into) }.boxed_local()
    }
}

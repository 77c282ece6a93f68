//! A connection over a fieldbus that exchanges images in a cycle of its own, on a thread of its own.

use std::fmt;
use std::sync::Arc;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::view::{BusError, State, View, Views};
use super::{Cause, Event, ImageConnection, Known, LinkError, Outputs, Sizes, Traffic};

/// An open connection, as its fieldbus has it.
pub trait Bus: fmt::Debug + 'static {
    /// What goes wrong on it.
    type Error: BusError;
    /// What is counted on it.
    type Statistics: Clone + Default;
    /// What only it has to see.
    type Details: Clone;

    /// What there is to see of it.
    fn views(&mut self) -> &mut Views<Self::Error, Self::Statistics, Self::Details>;

    /// Shows the device this image in this generation. The number is that of the change: it has left once the view's
    /// `sent` is as high.
    ///
    /// # Errors
    /// When the connection is not open in this generation, or the image has another size.
    fn set_image(&mut self, generation: u32, image: &[u8]) -> Result<u64, Self::Error>;

    /// An image of the device as it is meant, where the bus has it otherwise.
    fn turned(&self, image: Arc<[u8]>) -> Arc<[u8]> {
        image
    }

    /// Why the connection is lost, and what is now true of the outputs.
    fn loss(&self, view: View<Self::Error, Self::Statistics, Self::Details>) -> (Cause, Outputs);

    /// What was counted.
    fn traffic(&self) -> Traffic;

    /// Ends it properly.
    fn close(self) -> LocalBoxFuture<'static, Result<(), Self::Error>>;
}

/// A connection over such a bus.
#[derive(Debug)]
pub struct Cyclic<B> {
    bus: B,
    sizes: Sizes,
    /// The opening that is known of.
    generation: u32,
    /// The change that has not left yet.
    pending: Option<u64>,
}

impl<B: Bus> Cyclic<B> {
    /// Over this one, which is open.
    pub fn over(mut bus: B, sizes: Sizes) -> Self {
        let generation = bus.views().now().generation;
        Self { bus, sizes, generation, pending: None }
    }

    async fn wait(&mut self, known: Known<'_>) -> Event {
        loop {
            let view = self.bus.views().now();
            let is_open = view.state == State::Open;
            if known.is_up && !(is_open && view.generation == self.generation) {
                self.pending = None;
                let (cause, outputs) = self.bus.loss(view);
                return Event::Lost(LinkError::Lost { cause, outputs });
            }
            if !known.is_up && is_open {
                self.generation = view.generation;
                return Event::Reopened;
            }
            if known.is_up && self.pending.is_some_and(|change| view.sent >= change) {
                self.pending = None;
                return Event::Sent;
            }
            if let Some(input) = view.input.filter(|input| input.generation == self.generation) {
                let image = self.bus.turned(input.image);
                if known.is_news(&image) {
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

    fn show(&mut self, image: &[u8]) -> Result<(), LinkError> {
        // What was to be seen before is replaced, whatever becomes of this.
        self.pending = None;
        match self.bus.set_image(self.generation, image) {
            Ok(change) => {
                self.pending = Some(change);
                Ok(())
            }
            // The loss is told by `next`.
            Err(error) if error == B::Error::OUTDATED || error == B::Error::ENDED => Ok(()),
            Err(error) => Err(error.into()),
        }
    }

    fn next<'a>(&'a mut self, known: Known<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(known).boxed_local()
    }

    fn traffic(&self) -> Option<Traffic> {
        Some(self.bus.traffic())
    }

    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        async move { self.bus.close().await.map_err(Into::into) }.boxed_local()
    }
}

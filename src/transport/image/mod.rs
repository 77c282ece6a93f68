//! Image links: the interface that all fieldbuses implement. Both sides of a link repeatedly exchange a complete image.
//! They do not exchange a stream of bytes.
//!
//! A fieldbus sends the newest image in its own cycle. An image that is replaced before the next cycle is never sent.
//! To be sure that an image was sent, call [`ImageLink::set_output`] and wait for [`Event::Sent`]. After a loss, the
//! peer gets the resting image ([`image_after_loss`]) until a new image is set. Therefore no image from before a loss is
//! sent again.
//!
//! A fieldbus implements [`cyclic::Bus`] for a connection that controls the device, and [`ImageConnection`] for a
//! connection that only reads. Errors of devices are converted to [`LinkError`]. [`InProcess`] is a connection to a
//! peer in this process, for example a simulated controller.
//!
//! The connection of a link can also belong to another process that shares it: see [`session`](super::session).

pub mod cyclic;
mod error;
mod in_process;
pub mod tap;
#[cfg(test)]
mod tests;
pub mod view;

use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;
use tokio::task::yield_now;
use tokio::time::{Instant, timeout_at};

pub use self::error::{Cause, LinkError, Outputs};
pub use self::in_process::{CYCLE, ImagePeer, InProcess};
use super::session::client::{self, Attached, SessionBusy};
use super::session::wire::Change;

/// Image to the peer after a loss: the resting image. A bit that rests on stays off if it was off in the last image: an
/// emergency-stop input that the user switched off must not go on again when the link returns.
pub fn image_after_loss(resting: &[u8], last: &[u8]) -> Vec<u8> {
    // Before the first opening there is no last image.
    let last = last.iter().copied().chain(std::iter::repeat(u8::MAX));
    resting.iter().zip(last).map(|(resting, last)| resting & last).collect()
}

/// Event of a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// The last image of [`ImageLink::set_output`] was sent.
    Sent,
    /// A new image arrived from the peer, or its first image after the link opened.
    Image(Arc<[u8]>),
    /// The link was lost.
    Lost(LinkError),
    /// The link is open again.
    Reopened,
    /// Another user of the link has changed the image to the peer.
    OutputChanged(Change),
    /// The session refuses all images of this process, because the robot is read-only.
    Denied,
    /// There was no event before the deadline.
    Timeout,
}

/// A connection over a fieldbus. It is already open when it is created. After a loss, it opens again automatically,
/// until it is closed.
pub trait ImageConnection: fmt::Debug {
    /// Image sizes of the device in bytes.
    fn sizes(&self) -> Sizes;

    /// Sends this image, starting with the next cycle. `next` reports when the image was sent. While the connection is
    /// down, the image is dropped.
    ///
    /// # Errors
    /// The image has another size, or the connection is read-only. A loss is not an error here, because `next` reports
    /// it.
    fn set_output(&mut self, _image: &[u8]) -> Result<(), LinkError> {
        Err(LinkError::Settings(Cause::new("a read-only connection sends no outputs")))
    }

    /// Waits for an event that the caller does not know yet: [`Event::Sent`], [`Event::Image`], [`Event::Lost`] or
    /// [`Event::Reopened`]. The future is cancel safe.
    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event>;

    /// Time without an image after which either end gives the connection up, so that no image is older. It is 0 if
    /// images need no time.
    fn watchdog(&self) -> Duration {
        Duration::ZERO
    }

    /// Counters of the connection; `None` for a connection without a cycle.
    fn traffic(&self) -> Option<Traffic> {
        None
    }

    /// Closes the connection.
    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        std::future::ready(Ok(())).boxed_local()
    }
}

/// Image sizes in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// Size of the image to the device. 0 for a read-only connection.
    pub output: usize,
    /// Size of the image from the device.
    pub input: usize,
}

/// State that the caller of [`ImageConnection::next`] already knows.
#[derive(Debug, Clone, Copy)]
pub struct ReportedState<'a> {
    /// Whether the link is up.
    pub is_up: bool,
    /// Last image from the device since the link opened.
    pub image: Option<&'a Arc<[u8]>>,
}

impl ReportedState<'_> {
    /// Whether this image differs from the last image.
    pub fn is_new(&self, image: &[u8]) -> bool {
        self.is_up && self.image.is_none_or(|reported| **reported != *image)
    }
}

/// Counters of a connection.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Images sent.
    pub sent: u64,
    /// Images received.
    pub received: u64,
    /// Intervals of the images to the device and from the device, if the fieldbus uses agreed intervals.
    pub intervals: Option<(Duration, Duration)>,
    /// Irregular events: their number and their name, for example `(2, "late")`.
    pub irregular: Vec<(u64, &'static str)>,
}

/// A link to one peer, over a connection of this process or of another process.
#[derive(Debug)]
pub struct ImageLink {
    end: End,
    /// Last image from the peer. The link compares new images with it.
    last_input: Option<Arc<[u8]>>,
    is_up: bool,
    /// A value that must live as long as the link, for example an in-process peer.
    keep_alive: Option<Box<dyn fmt::Debug>>,
}

#[derive(Debug)]
enum End {
    Local(Box<dyn ImageConnection>),
    Session(Box<Attached>),
}

impl ImageLink {
    /// Creates a link over a connection.
    pub fn over(connection: impl ImageConnection + 'static) -> Self {
        Self { end: End::Local(Box::new(connection)), last_input: None, is_up: true, keep_alive: None }
    }

    /// Creates a link to a peer in this process.
    pub fn in_process(peer: Box<dyn ImagePeer>) -> Self {
        Self::over(InProcess::new(peer))
    }

    /// Creates a link over a session. Another process owns the connection of the session.
    pub fn in_session(attached: Box<Attached>) -> Self {
        let is_up = attached.welcome.down.is_none();
        Self { end: End::Session(attached), last_input: None, is_up, keep_alive: None }
    }

    /// Keeps a value alive until the link is closed.
    #[must_use]
    pub fn with_owned(self, keep_alive: Box<dyn fmt::Debug>) -> Self {
        Self { keep_alive: Some(keep_alive), ..self }
    }

    /// Whether the link is up.
    pub fn is_up(&self) -> bool {
        self.is_up
    }

    /// Size of the image to the peer in bytes; 0 for a read-only link.
    pub fn output_size(&self) -> usize {
        match &self.end {
            End::Local(connection) => connection.sizes().output,
            End::Session(attached) => attached.output().map_or(0, <[u8]>::len),
        }
    }

    /// See [`ImageConnection::watchdog`].
    pub fn watchdog(&self) -> Duration {
        match &self.end {
            End::Local(connection) => connection.watchdog(),
            End::Session(attached) => {
                let watchdog = attached.welcome.images.as_ref().map_or(0, |images| images.watchdog_ms);
                Duration::from_millis(watchdog)
            }
        }
    }

    /// Returns the image that the session sends to the peer at the moment; `None` without a session.
    pub fn output(&self) -> Option<&[u8]> {
        match &self.end {
            End::Session(attached) => attached.output(),
            End::Local(_) => None,
        }
    }

    /// Waits until `until` for exclusive control of the outputs that the processes of a session share.
    pub async fn acquire(&mut self, until: Instant) -> Result<(), SessionBusy> {
        match &mut self.end {
            End::Session(attached) => attached.acquire(until).await,
            End::Local(_) => Ok(()),
        }
    }

    /// Ends the exclusive control.
    pub fn release(&mut self) {
        if let End::Session(attached) = &mut self.end {
            attached.release();
        }
    }

    /// Sets the last will: bits (mask and value) that the session sends if this process is killed. `None` clears the
    /// last will. Without a session, this has no effect, because the link ends with the process.
    pub fn set_last_will(&mut self, bits: Option<(&[u8], &[u8])>) {
        if let End::Session(attached) = &mut self.end {
            attached.set_last_will(bits);
        }
    }

    /// Claims motion for this process, so that no other process of the session may move the robot.
    pub async fn claim_motion(&mut self) -> Result<(), SessionBusy> {
        match &mut self.end {
            End::Session(attached) => attached.claim_motion().await,
            End::Local(_) => Ok(()),
        }
    }

    /// Reason why the session has ended; `None` if it has not ended.
    pub fn ended(&self) -> Option<&str> {
        match &self.end {
            End::Session(attached) => attached.ended(),
            End::Local(_) => None,
        }
    }

    /// Sends this image, starting with the next cycle. [`Event::Sent`] reports when the image was sent. While the link
    /// is down, the image is dropped.
    ///
    /// # Errors
    /// The image has another size.
    pub fn set_output(&mut self, image: &[u8]) -> Result<(), LinkError> {
        match &mut self.end {
            // While the link is down, the image is dropped. It must not be sent after the loss.
            End::Local(_) if !self.is_up => Ok(()),
            End::Local(connection) => connection.set_output(image),
            End::Session(attached) => {
                attached.set_output(image);
                Ok(())
            }
        }
    }

    /// Waits until `until` for the next event. The future is cancel safe.
    pub async fn next(&mut self, until: Instant) -> Event {
        let event = match &mut self.end {
            End::Local(connection) => {
                let next = connection.next(ReportedState { is_up: self.is_up, image: self.last_input.as_ref() });
                if Instant::now() < until {
                    timeout_at(until, next).await.unwrap_or(Event::Timeout)
                } else {
                    // With an exhausted task budget, an image that has already arrived would not be read.
                    yield_now().await;
                    next.now_or_never().unwrap_or(Event::Timeout)
                }
            }
            End::Session(attached) => attached.event(until).await.into(),
        };
        match &event {
            Event::Image(image) => self.last_input = Some(Arc::clone(image)),
            Event::Lost(_) => (self.is_up, self.last_input) = (false, None),
            Event::Reopened => self.is_up = true,
            Event::Sent | Event::OutputChanged(_) | Event::Denied | Event::Timeout => {}
        }
        event
    }

    /// Counters of the link; `None` for a link without its own network connection.
    pub fn traffic(&self) -> Option<Traffic> {
        match &self.end {
            End::Local(connection) => connection.traffic(),
            End::Session(_) => None,
        }
    }

    /// Closes the link. A session stays open.
    pub async fn close(self) -> Result<(), LinkError> {
        let Self { end, keep_alive, .. } = self;
        let closed = match end {
            End::Local(connection) => connection.close().await,
            End::Session(attached) => {
                attached.leave().await;
                Ok(())
            }
        };
        // The peer must stay alive until the close is complete.
        drop(keep_alive);
        closed
    }
}

impl From<client::Event> for Event {
    fn from(event: client::Event) -> Self {
        match event {
            client::Event::Sent => Self::Sent,
            client::Event::Image(image) => Self::Image(image.into()),
            client::Event::OutputChanged(change) => Self::OutputChanged(change),
            client::Event::Denied => Self::Denied,
            // No cause with more details is needed: the session host has already reported the state of the outputs, if
            // it was able to do so.
            client::Event::Lost(why) => Self::Lost(LinkError::Silent(Cause::new(why))),
            client::Event::Reopened => Self::Reopened,
            client::Event::Timeout => Self::Timeout,
        }
    }
}

//! The seam for fieldbuses: links that carry images, which each side shows the other over and over, where other links
//! carry bytes that pass once.
//!
//! A fieldbus sends the newest image in its own rhythm; what is replaced before its turn never leaves. So whoever needs
//! an image to be seen shows it and waits for [`Event::Sent`]. After a loss the peer is shown what the connection rests
//! at until something is shown again: nothing that was meant for the time before happens a second time.
//!
//! Each fieldbus implements [`cyclic::Bus`] for a connection that commands, and [`ImageConnection`] for one that only
//! looks, with [`LinkError`] for whatever its devices say. [`InProcess`] is a connection whose other end is in this process,
//! such as a simulated controller.
//!
//! A link may be another process's, which lets several have it: see [`session`](super::session).

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
use tokio::time::{Instant, timeout_at};

pub use self::error::{Cause, LinkError, Outputs};
pub use self::in_process::{CYCLE, ImagePeer, InProcess};
use super::session::client::{self, Attached, SessionBusy};
use super::session::wire::Change;

/// What happens on a link.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// What was shown last has left.
    Sent,
    /// The peer shows something new; or it shows something for the first time since the link is up.
    Image(Arc<[u8]>),
    /// The link went down, and why.
    Lost(LinkError),
    /// The link is up again.
    Reopened,
    /// Somebody else who uses the link has changed what the peer is shown.
    Shown(Change),
    /// The process that holds the link shows the peer nothing of what this one wants: the peer is read-only.
    Denied,
    /// Nothing until then.
    Timeout,
}

/// A connection over a fieldbus, open from the beginning. It opens itself again after a loss, until it is closed.
pub trait ImageConnection: fmt::Debug {
    /// Bytes of the images, as the device has them.
    fn sizes(&self) -> Sizes;

    /// Shows the device this image from the next cycle on; `next` tells when it has left. While the connection is down,
    /// nothing is kept for later.
    ///
    /// # Errors
    /// When the image does not have the size of the connection, or nothing can be shown at all, as where the connection
    /// only looks. A loss is none: `next` tells it.
    fn show(&mut self, _image: &[u8]) -> Result<(), LinkError> {
        Err(LinkError::Settings(Cause::new("a link that only reads or listens shows nothing")))
    }

    /// Waits for what is new to whoever knows this much: [`Event::Sent`], [`Event::Image`], [`Event::Lost`] or
    /// [`Event::Reopened`]. The future may be dropped.
    fn next<'a>(&'a mut self, known: Known<'a>) -> LocalBoxFuture<'a, Event>;

    /// What was counted; `None` for what has no cycle of its own.
    fn traffic(&self) -> Option<Traffic> {
        None
    }

    /// Ends it properly.
    fn close(self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        std::future::ready(Ok(())).boxed_local()
    }
}

/// Bytes of images.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Sizes {
    /// What the device takes; 0 where nothing is shown to it.
    pub output: usize,
    /// What it shows.
    pub input: usize,
}

/// What has been told of a connection.
#[derive(Debug, Clone, Copy)]
pub struct Known<'a> {
    /// Whether it is up.
    pub is_up: bool,
    /// What the device was last told to show, since it is up.
    pub image: Option<&'a Arc<[u8]>>,
}

impl Known<'_> {
    /// Whether this image would be news.
    pub fn is_news(&self, image: &[u8]) -> bool {
        self.is_up && self.image.is_none_or(|known| **known != *image)
    }
}

/// What was counted on a connection.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Images that left.
    pub sent: u64,
    /// Images that came.
    pub received: u64,
    /// Time between two images to the device and from it, where that is agreed.
    pub intervals: Option<(Duration, Duration)>,
    /// How often something went otherwise than it should, and what: `(2, "late")`.
    pub odd: Vec<(u64, &'static str)>,
}

/// A link to one peer: a connection of this process, or one that another process holds.
#[derive(Debug)]
pub struct ImageLink {
    end: End,
    /// What the peer was last told to show, to tell news from repetition.
    seen: Option<Arc<[u8]>>,
    is_up: bool,
    /// What must live as long as the link, such as the other end where that is in this process.
    kept: Option<Box<dyn fmt::Debug>>,
}

#[derive(Debug)]
enum End {
    Own(Box<dyn ImageConnection>),
    Session(Box<Attached>),
}

impl ImageLink {
    /// A link over this connection.
    pub fn over(connection: impl ImageConnection + 'static) -> Self {
        Self { end: End::Own(Box::new(connection)), seen: None, is_up: true, kept: None }
    }

    /// A link to a peer in this process.
    pub fn in_process(peer: Box<dyn ImagePeer>) -> Self {
        Self::over(InProcess::new(peer))
    }

    /// A link that another process holds.
    pub fn in_session(attached: Box<Attached>) -> Self {
        let is_up = attached.welcome.down.is_none();
        Self { end: End::Session(attached), seen: None, is_up, kept: None }
    }

    /// Keeps something until the link is closed.
    #[must_use]
    pub fn keeping(self, kept: Box<dyn fmt::Debug>) -> Self {
        Self { kept: Some(kept), ..self }
    }

    /// Whether the link is up.
    pub fn is_up(&self) -> bool {
        self.is_up
    }

    /// Bytes of the image that the peer takes; 0 where nothing is shown to it.
    pub fn output_size(&self) -> usize {
        match &self.end {
            End::Own(connection) => connection.sizes().output,
            End::Session(attached) => attached.shown().map_or(0, <[u8]>::len),
        }
    }

    /// What the peer is shown already where another process holds the link.
    pub fn shown(&self) -> Option<&[u8]> {
        match &self.end {
            End::Session(attached) => attached.shown(),
            End::Own(_) => None,
        }
    }

    /// Waits until the exclusive part of what is shown is this process's to change, but not longer than `until`.
    pub async fn take(&mut self, until: Instant) -> Result<(), SessionBusy> {
        match &mut self.end {
            End::Session(attached) => attached.take(until).await,
            End::Own(_) => Ok(()),
        }
    }

    /// Lets others change the exclusive part.
    pub fn give(&mut self) {
        if let End::Session(attached) = &mut self.end {
            attached.over();
        }
    }

    /// Has a session show these bits, mask and value, if this process dies; or no more. Without one, the link dies with it.
    pub fn set_last_will(&mut self, bits: Option<(&[u8], &[u8])>) {
        if let End::Session(attached) = &mut self.end {
            attached.set_last_will(bits);
        }
    }

    /// Becomes the only one who moves the robot.
    pub async fn claim_motion(&mut self) -> Result<(), SessionBusy> {
        match &mut self.end {
            End::Session(attached) => attached.claim_motion().await,
            End::Own(_) => Ok(()),
        }
    }

    /// Why the process that held the link holds it no longer.
    pub fn ended(&self) -> Option<&str> {
        match &self.end {
            End::Session(attached) => attached.ended(),
            End::Own(_) => None,
        }
    }

    /// Shows the peer this image from the next cycle on; [`Event::Sent`] tells when it has left. While the link is down
    /// it never does.
    ///
    /// # Errors
    /// When the image does not have the size of the connection.
    pub fn show(&mut self, image: &[u8]) -> Result<(), LinkError> {
        match &mut self.end {
            // What is meant for the time before a loss must not happen after it.
            End::Own(_) if !self.is_up => Ok(()),
            End::Own(connection) => connection.show(image),
            End::Session(attached) => {
                attached.show(image);
                Ok(())
            }
        }
    }

    /// Waits for the next thing to happen, but not longer than `until`. The future may be dropped.
    pub async fn next(&mut self, until: Instant) -> Event {
        let event = match &mut self.end {
            End::Own(connection) => {
                let next = connection.next(Known { is_up: self.is_up, image: self.seen.as_ref() });
                if Instant::now() < until {
                    timeout_at(until, next).await.unwrap_or(Event::Timeout)
                } else {
                    next.now_or_never().unwrap_or(Event::Timeout)
                }
            }
            End::Session(attached) => attached.event(until).await.into(),
        };
        match &event {
            Event::Image(image) => self.seen = Some(Arc::clone(image)),
            Event::Lost(_) => (self.is_up, self.seen) = (false, None),
            Event::Reopened => self.is_up = true,
            Event::Sent | Event::Shown(_) | Event::Denied | Event::Timeout => {}
        }
        event
    }

    /// What was counted; `None` for what has no network of its own.
    pub fn traffic(&self) -> Option<Traffic> {
        match &self.end {
            End::Own(connection) => connection.traffic(),
            End::Session(_) => None,
        }
    }

    /// Ends it properly; one that another process holds goes on.
    pub async fn close(self) -> Result<(), LinkError> {
        let Self { end, kept, .. } = self;
        let closed = match end {
            End::Own(connection) => connection.close().await,
            End::Session(attached) => {
                attached.leave().await;
                Ok(())
            }
        };
        // The other end must not go before it is told.
        drop(kept);
        closed
    }
}

impl From<client::Event> for Event {
    fn from(event: client::Event) -> Self {
        match event {
            client::Event::Sent => Self::Sent,
            client::Event::Image(image) => Self::Image(image.into()),
            client::Event::Shown(change) => Self::Shown(change),
            client::Event::Denied => Self::Denied,
            // What is true of the outputs, the process that holds the link has told where it could.
            client::Event::Lost(why) => Self::Lost(LinkError::Silent(Cause::new(why))),
            client::Event::Reopened => Self::Reopened,
            client::Event::Timeout => Self::Timeout,
        }
    }
}

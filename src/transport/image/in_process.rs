//! Image connection to a peer in this process. The connection uses tokio's clock, which tests can pause and advance.

use std::fmt;
use std::time::Duration;

use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;
use tokio::time::{Instant, sleep_until};

use super::{Cause, Event, ImageConnection, LinkError, Outputs, ReportedState, Sizes};

/// Peer of an in-process connection, for example a simulated controller.
pub trait ImagePeer: fmt::Debug {
    /// Handles an image that arrives at `now`. `None` means that the connection to the master has ended.
    fn input(&mut self, now: Duration, image: Option<&[u8]>);
    /// Returns the image of the peer at `now`; `None` while the link is down.
    fn output(&mut self, now: Duration) -> Option<Vec<u8>>;
    /// Time at which the output of the peer next changes if it receives no input.
    fn wake(&self) -> Option<Duration>;
}

/// Cycle time of an in-process link.
pub const CYCLE: Duration = Duration::from_millis(5);

/// A connection to a peer in this process.
#[derive(Debug)]
pub struct InProcess {
    peer: Box<dyn ImagePeer>,
    start: Instant,
    /// Size of the images in both directions.
    size: usize,
    /// Image that was not sent yet.
    pending: Option<Vec<u8>>,
    /// Earliest time to send the next image.
    due: Duration,
}

impl InProcess {
    /// Creates a connection that has not sent an image yet. The first image of the peer sets the image size of both
    /// directions.
    pub fn new(mut peer: Box<dyn ImagePeer>) -> Self {
        let size = peer.output(Duration::ZERO).map_or(0, |image| image.len());
        Self { peer, start: Instant::now(), size, pending: None, due: Duration::ZERO }
    }

    async fn wait(&mut self, reported: ReportedState<'_>) -> Event {
        loop {
            let now = self.start.elapsed();
            let last_output = self.peer.output(now);
            match (&last_output, reported.is_up) {
                (None, true) => {
                    self.pending = None;
                    let cause = Cause::new("the other side of the connection has ended");
                    return Event::Lost(LinkError::Lost { cause, outputs: Outputs::Released });
                }
                (Some(_), false) => return Event::Reopened,
                _ => {}
            }
            if reported.is_up
                && now >= self.due
                && let Some(image) = self.pending.take()
            {
                self.peer.input(now, Some(&image));
                self.due = now + CYCLE;
                return Event::Sent;
            }
            if let Some(image) = last_output.filter(|image| reported.is_new(image)) {
                return Event::Image(image.into());
            }
            // A peer whose time is never in the future is polled once per cycle.
            let wake = self.peer.wake().map(|wake| if wake > now { wake } else { now + CYCLE });
            let leave = self.pending.as_ref().filter(|_| reported.is_up).map(|_| self.due);
            match wake.into_iter().chain(leave).min() {
                Some(due) => sleep_until(self.start + due).await,
                None => std::future::pending().await,
            }
        }
    }
}

impl ImageConnection for InProcess {
    fn sizes(&self) -> Sizes {
        Sizes { output: self.size, input: self.size }
    }

    fn set_output(&mut self, image: &[u8]) -> Result<(), LinkError> {
        self.pending = Some(image.to_vec());
        Ok(())
    }

    fn next<'a>(&'a mut self, reported: ReportedState<'a>) -> LocalBoxFuture<'a, Event> {
        self.wait(reported).boxed_local()
    }

    fn close(mut self: Box<Self>) -> LocalBoxFuture<'static, Result<(), LinkError>> {
        self.peer.input(self.start.elapsed(), None);
        std::future::ready(Ok(())).boxed_local()
    }
}

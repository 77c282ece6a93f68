//! A byte stream to a controller, whatever carries it.

use std::io;

use tokio::time::Instant;

use super::line::InProcessLine;
use super::serial::Serial;
use super::session::client::{Attached, SessionBusy};
use super::sim::Peer;
use super::tcp::Tcp;

/// A byte stream. Its futures may be dropped: nothing that was received is lost, nothing that was sent is cut.
#[derive(Debug)]
pub enum Stream<P> {
    /// A serial port.
    Serial(Serial),
    /// A serial port behind a device server.
    Tcp(Tcp),
    /// A peer in this process.
    InProcess(Box<InProcessLine<P>>),
    /// A stream that another process holds, and lets several have one after the other.
    Session(Box<Attached>),
}

impl<P: Peer> Stream<P> {
    /// Waits until the stream is this process's, but not longer than `until`. The future may be dropped.
    ///
    /// # Errors
    /// [`SessionBusy`], where another process holds the stream.
    pub async fn take(&mut self, until: Instant) -> Result<(), SessionBusy> {
        match self {
            Self::Session(attached) => attached.take(until).await,
            Self::Serial(_) | Self::Tcp(_) | Self::InProcess(_) => Ok(()),
        }
    }

    /// Lets others have it.
    pub fn give(&mut self) {
        if let Self::Session(attached) = self {
            attached.over();
        }
    }

    /// Becomes the only one who moves the robot.
    ///
    /// # Errors
    /// [`SessionBusy`], where another process holds the stream.
    pub async fn claim_motion(&mut self) -> Result<(), SessionBusy> {
        match self {
            Self::Session(attached) => attached.claim_motion().await,
            Self::Serial(_) | Self::Tcp(_) | Self::InProcess(_) => Ok(()),
        }
    }

    /// Leaves it. One that another process holds goes on.
    pub async fn leave(self) {
        if let Self::Session(attached) = self {
            attached.leave().await;
        }
    }

    /// Sends bytes; they may still be on their way when this returns.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the other end is gone: unplugged, or closed.
    pub async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Serial(serial) => serial.send(bytes).await,
            Self::Tcp(tcp) => tcp.send(bytes).await,
            Self::Session(attached) => attached.send(0, bytes).await,
            Self::InProcess(line) => {
                line.send(bytes);
                Ok(())
            }
        }
    }

    /// Waits for bytes, but not longer than `until`; `None` after silence.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the other end is gone: unplugged, or closed.
    pub async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        match self {
            Self::Serial(serial) => serial.receive(buffer, until).await,
            Self::Tcp(tcp) => tcp.receive(buffer, until).await,
            Self::Session(attached) => attached.read(buffer, until).await,
            Self::InProcess(line) => Ok(line.receive(buffer, until).await),
        }
    }

    /// Drops what has arrived and was not received; what is still on its way comes.
    pub fn discard(&mut self) {
        match self {
            Self::Serial(serial) => serial.discard(),
            Self::Tcp(tcp) => tcp.discard(),
            Self::InProcess(line) => line.discard(),
            // Its holder has discarded what came before.
            Self::Session(_) => {}
        }
    }
}

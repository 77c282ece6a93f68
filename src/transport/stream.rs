//! Byte stream to a controller over any link.

use std::io;

use tokio::time::Instant;

use super::line::InProcessLine;
use super::serial::Serial;
use super::session::client::{Attached, SessionBusy};
use super::sim::Peer;
use super::tcp::Tcp;

/// A byte stream. Its futures are cancel safe: received bytes are not lost, and a started send is completed.
#[derive(Debug)]
pub enum Stream<P> {
    /// A serial port.
    Serial(Serial),
    /// A serial port behind a device server.
    Tcp(Tcp),
    /// An in-process peer.
    InProcess(Box<InProcessLine<P>>),
    /// A stream that a session owns. Several processes share it.
    Session(Box<Attached>),
}

impl<P: Peer> Stream<P> {
    /// Waits until `until` for exclusive use of the stream by this process. The future is cancel safe. Only a stream in
    /// a session needs the wait.
    ///
    /// # Errors
    /// [`SessionBusy`] if a session refuses the use.
    pub async fn take(&mut self, until: Instant) -> Result<(), SessionBusy> {
        match self {
            Self::Session(attached) => attached.acquire(until).await,
            Self::Serial(_) | Self::Tcp(_) | Self::InProcess(_) => Ok(()),
        }
    }

    /// Ends the exclusive use.
    pub fn release_line(&mut self) {
        if let Self::Session(attached) = self {
            attached.release();
        }
    }

    /// Claims motion for this process, so that no other process of the session may move the robot.
    ///
    /// # Errors
    /// [`SessionBusy`] if a session refuses the claim.
    pub async fn claim_motion(&mut self) -> Result<(), SessionBusy> {
        match self {
            Self::Session(attached) => attached.claim_motion().await,
            Self::Serial(_) | Self::Tcp(_) | Self::InProcess(_) => Ok(()),
        }
    }

    /// Detaches from the stream. A session keeps its line open.
    pub async fn leave(self) {
        if let Self::Session(attached) = self {
            attached.leave().await;
        }
    }

    /// Sends bytes. The bytes may still be in transit when this function returns.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the other end is unplugged or closed.
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

    /// Waits until `until` for bytes. Returns `None` after a timeout.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the other end is unplugged or closed.
    pub async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        match self {
            Self::Serial(serial) => serial.receive(buffer, until).await,
            Self::Tcp(tcp) => tcp.receive(buffer, until).await,
            Self::Session(attached) => attached.read(buffer, until).await,
            Self::InProcess(line) => Ok(line.receive(buffer, until).await),
        }
    }

    /// Discards received bytes. Bytes in transit still arrive.
    pub fn discard(&mut self) {
        match self {
            Self::Serial(serial) => serial.discard(),
            Self::Tcp(tcp) => tcp.discard(),
            Self::InProcess(line) => line.discard(),
            // The session host discards old bytes when a client gets exclusive use of the line.
            Self::Session(_) => {}
        }
    }
}

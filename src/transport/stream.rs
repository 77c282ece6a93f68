//! Byte stream to a controller over any link.

use std::io;

use tokio::time::Instant;

use super::line::InProcessLine;
use super::serial::Serial;
use super::session::client::{Attached, SessionBusy};
use super::sim::Peer;
use super::tcp::Tcp;

/// A byte stream. Its futures are cancel safe: received bytes are not lost, a started send is completed.
#[derive(Debug)]
pub enum Stream<P> {
    /// A serial port.
    Serial(Serial),
    /// A serial port behind a device server.
    Tcp(Tcp),
    /// An in-process peer.
    InProcess(Box<InProcessLine<P>>),
    /// A stream in a session, which several processes share.
    Session(Box<Attached>),
}

impl<P: Peer> Stream<P> {
    /// Waits until this process has exclusive use of the stream, at most until `until`. Cancel safe.
    ///
    /// # Errors
    /// [`SessionBusy`], in a session.
    pub async fn take(&mut self, until: Instant) -> Result<(), SessionBusy> {
        match self {
            Self::Session(attached) => attached.acquire(until).await,
            Self::Serial(_) | Self::Tcp(_) | Self::InProcess(_) => Ok(()),
        }
    }

    /// Gives up exclusive use.
    pub fn give(&mut self) {
        if let Self::Session(attached) = self {
            attached.release();
        }
    }

    /// Claims the right to move the robot for this process alone.
    ///
    /// # Errors
    /// [`SessionBusy`], in a session.
    pub async fn claim_motion(&mut self) -> Result<(), SessionBusy> {
        match self {
            Self::Session(attached) => attached.claim_motion().await,
            Self::Serial(_) | Self::Tcp(_) | Self::InProcess(_) => Ok(()),
        }
    }

    /// Detaches from the stream. A session continues.
    pub async fn leave(self) {
        if let Self::Session(attached) = self {
            attached.leave().await;
        }
    }

    /// Sends bytes. They can still be in transit when this returns.
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

    /// Waits for bytes, at most until `until`; `None` after a timeout.
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

    /// Drops received bytes. Bytes in transit still arrive.
    pub fn discard(&mut self) {
        match self {
            Self::Serial(serial) => serial.discard(),
            Self::Tcp(tcp) => tcp.discard(),
            Self::InProcess(line) => line.discard(),
            // The host drops old bytes when a client takes the line.
            Self::Session(_) => {}
        }
    }
}

//! A byte stream to a controller, whatever carries it.

use std::io;

use tokio::time::Instant;

use super::line::InProcessLine;
use super::serial::Serial;
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
}

impl<P: Peer> Stream<P> {
    /// Sends bytes; they may still be on their way when this returns.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the other end is gone: unplugged, or closed.
    pub async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Serial(serial) => serial.send(bytes).await,
            Self::Tcp(tcp) => tcp.send(bytes).await,
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
            Self::InProcess(line) => Ok(line.receive(buffer, until).await),
        }
    }

    /// Drops what has arrived and was not received; what is still on its way comes.
    pub fn discard(&mut self) {
        match self {
            Self::Serial(serial) => serial.discard(),
            Self::Tcp(tcp) => tcp.discard(),
            Self::InProcess(line) => line.discard(),
        }
    }
}

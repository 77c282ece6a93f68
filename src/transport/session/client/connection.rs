//! Connection of a session client to its host, in another process or in this one.

use std::io;
use std::time::Duration;

use tokio::time::{Instant, timeout_at};

use super::AttachError;
use crate::session::direct::{ClientEnds, HostHandle};
use crate::session::location::SessionPath;
use crate::session::socket::{self, WriteHalf};
use crate::session::wire::{Control, Frame, Reader, WireError};

/// Time limit for answers that the host can give without a request to the device.
pub const ANSWER_TIMEOUT: Duration = Duration::from_secs(3);

/// Connection to a host.
#[derive(Debug)]
pub enum Connection {
    /// The host is in another process.
    Socket { reader: Reader, writer: WriteHalf, unsent: Vec<u8> },
    /// The host is in this process.
    Channel(ClientEnds),
    /// The host is in this process, and the client has sent it nothing yet. Before its first frame, the client joins
    /// the host with this Hello.
    Unjoined { host: HostHandle, hello: Box<Control> },
}

impl Connection {
    pub async fn connect(location: &SessionPath) -> Result<Option<Self>, AttachError> {
        if !location.check()? {
            return Ok(None);
        }
        let ends = socket::connect(&location.socket()).await?;
        Ok(ends.map(|(read, write)| Self::Socket { reader: Reader::new(read), writer: write, unsent: Vec::new() }))
    }

    /// Queues a frame, and sends as many bytes as the socket accepts now.
    pub fn send_control(&mut self, control: Control) {
        self.send_frame(Frame::Control(control));
    }

    /// An error is ignored here: the next read reports it.
    pub fn send_frame(&mut self, frame: Frame) {
        match self {
            Self::Socket { writer, unsent, .. } => {
                frame.emit(unsent);
                if let Ok(sent) = writer.try_write(unsent) {
                    unsent.drain(..sent);
                }
            }
            Self::Channel(ends) => drop(ends.to_host.send(frame)),
            Self::Unjoined { host, hello } => {
                let ends = ClientEnds::join(&host.joins);
                drop(ends.to_host.send(Frame::Control((**hello).clone())));
                drop(ends.to_host.send(frame));
                *self = Self::Channel(ends);
            }
        }
    }

    /// Sends the last frame of this client, without a runtime.
    pub fn send_last(&mut self, control: Control) {
        match self {
            Self::Socket { writer, unsent, .. } => {
                Frame::Control(control).emit(unsent);
                socket::write_last(writer, unsent);
            }
            Self::Channel(ends) => drop(ends.to_host.send(Frame::Control(control))),
            Self::Unjoined { .. } => {}
        }
    }

    pub async fn flush(&mut self) -> io::Result<()> {
        let Self::Socket { writer, unsent, .. } = self else { return Ok(()) };
        while !unsent.is_empty() {
            writer.writable().await?;
            match writer.try_write(unsent) {
                Ok(sent) => drop(unsent.drain(..sent)),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Waits for the next frame. Returns `None` after the host has closed the connection. The future is cancel safe.
    pub async fn next(&mut self) -> Result<Option<Frame>, WireError> {
        self.flush().await?;
        match self {
            Self::Socket { reader, .. } => reader.next().await,
            Self::Channel(ends) => Ok(ends.from_host.recv().await),
            Self::Unjoined { .. } => std::future::pending().await,
        }
    }

    /// Waits for the answer of the host. The time limit is short, because the host answers at once.
    pub async fn answer(&mut self) -> Result<Control, AttachError> {
        match timeout_at(Instant::now() + ANSWER_TIMEOUT, self.next()).await {
            Err(_) => Err(AttachError::Silent),
            Ok(Ok(Some(Frame::Control(control)))) => Ok(control),
            Ok(Ok(None)) => Ok(Control::Ended("the session has just ended".to_owned())),
            Ok(Ok(Some(_))) => Err(AttachError::WrongVersion),
            Ok(Err(error)) if is_gone(&error) => Ok(Control::Ended("the session has just ended".to_owned())),
            Ok(Err(error)) => Err(error.into()),
        }
    }
}

/// Whether the error means that the other end of the socket is closed.
pub fn is_gone(error: &WireError) -> bool {
    use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset, NotConnected, UnexpectedEof};

    let gone = [BrokenPipe, ConnectionAborted, ConnectionReset, NotConnected, UnexpectedEof];
    matches!(error, WireError::Io(error) if gone.contains(&error.kind()))
}

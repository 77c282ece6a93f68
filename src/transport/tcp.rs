//! TCP stream to a serial device server that passes on raw bytes (no Telnet, no RFC 2217).

use std::io;
use std::net::SocketAddr;

use thiserror::Error;
use tokio::io::AsyncReadExt as _;
use tokio::net::TcpStream;
use tokio::time::{Instant, timeout_at};

use super::closed_error;

/// Reason why a server cannot be reached.
#[derive(Debug, Error)]
pub enum ConnectError {
    /// The host name has no address.
    #[error("the name has no address")]
    NotFound,
    /// No program listens on the port.
    #[error("no program listens on this port")]
    Refused,
    /// The host or its network is unreachable.
    #[error("no route to the host")]
    Unreachable,
    /// The host did not answer before the deadline.
    #[error("no answer")]
    TimedOut,
    /// Any other error.
    #[error("{0}")]
    Io(#[from] io::Error),
}

/// A TCP connection.
#[derive(Debug)]
pub struct Tcp {
    stream: TcpStream,
    /// Unsent bytes of a [`Tcp::send`] whose future was dropped. The next send sends these bytes first, so that no
    /// message stays incomplete.
    unsent: Vec<u8>,
}

impl Tcp {
    /// Connects to the first address of the host that answers before `until`.
    ///
    /// # Errors
    /// The [`ConnectError`] of the last address.
    pub async fn open(host: &str, port: u16, until: Instant) -> Result<Self, ConnectError> {
        let stream = timeout_at(until, connect(host, port)).await.unwrap_or(Err(ConnectError::TimedOut))?;
        stream.set_nodelay(true)?;
        Ok(Self { stream, unsent: Vec::new() })
    }

    /// Local and remote address.
    pub fn address_pair(&self) -> io::Result<(SocketAddr, SocketAddr)> {
        Ok((self.stream.local_addr()?, self.stream.peer_addr()?))
    }

    /// Sends bytes.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the server has closed the connection or is gone.
    pub async fn send(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.unsent.extend(bytes);
        while !self.unsent.is_empty() {
            self.stream.writable().await.map_err(closed_error)?;
            match self.stream.try_write(&self.unsent) {
                Ok(len) => drop(self.unsent.drain(..len)),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => {}
                Err(error) => return Err(closed_error(error)),
            }
        }
        Ok(())
    }

    /// Waits until `until` for bytes. Returns `None` after a timeout.
    ///
    /// # Errors
    /// [`NotConnected`](io::ErrorKind::NotConnected) if the server has closed the connection or is gone.
    pub async fn receive(&mut self, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        match timeout_at(until, self.stream.read(buffer)).await {
            Err(_) => Ok(None),
            Ok(Ok(0)) => Err(closed_error("the server closed the connection")),
            Ok(Ok(len)) => Ok(Some(len)),
            Ok(Err(error)) => Err(closed_error(error)),
        }
    }

    /// Drops all received bytes.
    pub fn discard(&mut self) {
        // An error is ignored here: the next read reports it.
        while self.stream.try_read(&mut [0; 1024]).is_ok_and(|len| len > 0) {}
    }
}

pub(crate) async fn connect(host: &str, port: u16) -> Result<TcpStream, ConnectError> {
    let addresses = tokio::net::lookup_host((host, port)).await.map_err(|_| ConnectError::NotFound)?;
    let mut failed = ConnectError::NotFound;
    for address in addresses {
        match TcpStream::connect(address).await {
            Ok(stream) => return Ok(stream),
            Err(error) => failed = connect_error(error),
        }
    }
    Err(failed)
}

fn connect_error(error: io::Error) -> ConnectError {
    use io::ErrorKind::{ConnectionRefused, HostUnreachable, NetworkUnreachable, TimedOut};

    match error.kind() {
        ConnectionRefused => ConnectError::Refused,
        HostUnreachable | NetworkUnreachable => ConnectError::Unreachable,
        TimedOut => ConnectError::TimedOut,
        _ => ConnectError::Io(error),
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::AsyncWriteExt as _;
    use tokio::net::{TcpListener, TcpSocket};

    use super::super::testing::soon;
    use super::*;

    async fn pair() -> (Tcp, TcpStream) {
        let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
        let port = listener.local_addr().unwrap().port();
        let (tcp, accepted) = tokio::join!(Tcp::open("127.0.0.1", port, soon()), listener.accept());
        (tcp.unwrap(), accepted.unwrap().0)
    }

    #[tokio::test]
    async fn bytes_go_both_ways() {
        let (mut tcp, mut server) = pair().await;
        assert!(tcp.stream.nodelay().unwrap());
        tcp.send(b"@STAS\r\n").await.unwrap();
        let mut buffer = [0; 64];
        assert_eq!(server.read(&mut buffer).await.unwrap(), 7);
        server.write_all(b"@OK\r\n").await.unwrap();
        assert_eq!(tcp.receive(&mut buffer, soon()).await.unwrap(), Some(5));
        assert_eq!(tcp.receive(&mut buffer, Instant::now()).await.unwrap(), None);
        assert_eq!(tcp.address_pair().unwrap(), (server.peer_addr().unwrap(), server.local_addr().unwrap()));
    }

    #[tokio::test]
    async fn discards_received_bytes() {
        let (mut tcp, mut server) = pair().await;
        server.write_all(&[b'x'; 5000]).await.unwrap();
        let mut buffer = [0; 64];
        assert_eq!(tcp.receive(&mut buffer, soon()).await.unwrap(), Some(64));
        // Some of these bytes may still be in transit on the loopback interface.
        let mut left = 5000 - 64;
        while left > 0 {
            tcp.stream.readable().await.unwrap();
            left -= tcp.stream.peek(&mut [0; 5000]).await.unwrap().min(left);
            tcp.discard();
        }
        assert_eq!(tcp.receive(&mut buffer, Instant::now()).await.unwrap(), None);
    }

    #[tokio::test]
    async fn closed_server_is_an_error() {
        let (mut tcp, server) = pair().await;
        drop(server);
        let error = tcp.receive(&mut [0; 8], soon()).await.unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::NotConnected);
        // `discard` does not fail, and the next read still reports the error.
        tcp.discard();
        assert_eq!(tcp.receive(&mut [0; 8], soon()).await.unwrap_err().kind(), io::ErrorKind::NotConnected);
    }

    #[tokio::test]
    async fn closed_port_refuses() {
        // The socket is bound but does not listen. So no other program gets the port, and a connection is refused.
        let socket = TcpSocket::new_v4().unwrap();
        socket.bind("127.0.0.1:0".parse().unwrap()).unwrap();
        let port = socket.local_addr().unwrap().port();
        assert!(matches!(Tcp::open("127.0.0.1", port, soon()).await, Err(ConnectError::Refused)));
    }

    #[tokio::test]
    async fn a_name_without_address_is_not_found() {
        assert!(matches!(Tcp::open("no host", 4001, soon()).await, Err(ConnectError::NotFound)));
    }

    #[test]
    fn distinguishes_connect_errors() {
        use io::ErrorKind::{ConnectionRefused, HostUnreachable, NetworkUnreachable, Other, TimedOut};

        let texts = [ConnectionRefused, HostUnreachable, NetworkUnreachable, TimedOut, Other]
            .map(|kind| connect_error(io::Error::new(kind, "other")).to_string());
        assert_eq!(
            texts,
            ["no program listens on this port", "no route to the host", "no route to the host", "no answer", "other"]
        );
    }
}

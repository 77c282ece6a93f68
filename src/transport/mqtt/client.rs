//! MQTT driver: transfers the bytes of a session over TCP or TLS.

use std::future::poll_fn;
use std::io;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, timeout_at};

use super::super::tcp::{self, ConnectError};
use super::tls::{Tls, TlsError};
use super::{Event, Hello, Loss, Message, SendError, Session};

/// Bytes per read.
const CHUNK: usize = 16 * 1024;
/// Time after which a broker counts as blocked if it reads no bytes.
const UNREAD: Duration = Duration::from_secs(30);

/// Address of a broker.
#[derive(Debug, Clone)]
pub struct Endpoint {
    /// Host name or address.
    pub host: String,
    /// TCP port.
    pub port: u16,
    /// TLS settings; `None` without TLS.
    pub tls: Option<Arc<Tls>>,
}

trait Duplex: AsyncRead + AsyncWrite + Unpin {}

impl<T: AsyncRead + AsyncWrite + Unpin> Duplex for T {}

/// A connection to a broker.
pub struct Client {
    stream: Box<dyn Duplex>,
    session: Session,
    buffer: Vec<u8>,
    is_flushed: bool,
    /// Time since which the connection accepts no bytes; `None` while it accepts bytes.
    stuck_since: Option<Instant>,
}

impl Client {
    /// Connects to a broker and sends CONNECT. The first event is the answer of the broker. `within` is the time limit
    /// for connecting and for this answer.
    pub async fn open(endpoint: &Endpoint, hello: &Hello, within: Duration) -> Result<Self, Loss> {
        let by = Instant::now() + within;
        let opened = timeout_at(by, stream(endpoint)).await.unwrap_or(Err(ConnectError::TimedOut.into()))?;
        let invalid = |error: SendError| Loss::Io(format!("cannot encode the packet: {error}"));
        let session = Session::new(hello, Instant::now(), by).map_err(invalid)?;
        Ok(Self { stream: opened, session, buffer: vec![0; CHUNK], is_flushed: true, stuck_since: None })
    }

    /// Waits for the next event. The future is cancel safe. No more events follow after [`Event::Lost`].
    pub async fn next(&mut self) -> Event {
        loop {
            if let Some(event) = self.session.next_event() {
                return event;
            }
            let stuck = self.stuck_since.map(|since| since + UNREAD);
            let due = self.session.due().into_iter().chain(stuck).min();
            let moved = poll_fn(|cx| self.turn(cx));
            let moved = match due {
                Some(due) => timeout_at(due, moved).await,
                None => Ok(moved.await),
            };
            match moved {
                Ok(Ok(len)) => self.session.handle(Instant::now(), &self.buffer[..len]),
                Ok(Err(loss)) => self.session.lose(loss),
                Err(_) if stuck.is_some_and(|stuck| stuck <= Instant::now()) => self.session.lose(Loss::Unread),
                Err(_) => self.session.poll(Instant::now()),
            }
        }
    }

    /// Publishes a message: see [`Session::publish`].
    pub fn publish(&mut self, message: &Message) -> Result<Option<u64>, SendError> {
        self.session.publish(Instant::now(), message)
    }

    /// Subscribes to topics: see [`Session::subscribe`].
    pub fn subscribe(&mut self, topics: &[String]) -> Result<(), SendError> {
        self.session.subscribe(Instant::now(), topics)
    }

    /// Ends the subscription to topics: see [`Session::unsubscribe`].
    pub fn unsubscribe(&mut self, topics: &[String]) -> Result<(), SendError> {
        self.session.unsubscribe(Instant::now(), topics)
    }

    /// Sends a ping: see [`Session::ping`].
    pub fn ping(&mut self) -> u64 {
        self.session.ping(Instant::now())
    }

    /// Returns how many messages can be sent now: see [`Session::room`].
    pub fn room(&self) -> Option<u16> {
        self.session.room()
    }

    /// Number of bytes that the connection has not accepted yet.
    pub fn unsent(&mut self) -> usize {
        self.session.outgoing.len()
    }

    /// Sends DISCONNECT, so that the broker does not publish the last will, and closes the connection. This can take
    /// any time, so the caller must set a time limit.
    pub async fn close(mut self) {
        self.session.disconnect(Instant::now());
        // An error is ignored: if the connection to the broker is already lost, DISCONNECT is not needed.
        let _closed: io::Result<()> = poll_fn(|cx| {
            ready!(self.flush(cx))?;
            Pin::new(&mut *self.stream).poll_shutdown(cx)
        })
        .await;
    }

    /// Writes pending bytes, then reads.
    fn turn(&mut self, cx: &mut Context<'_>) -> Poll<Result<usize, Loss>> {
        if let Poll::Ready(Err(error)) = self.flush(cx) {
            // If the broker has sent a last message, this message explains more than the write error.
            return match self.read(cx) {
                Poll::Ready(Ok(len)) => Poll::Ready(Ok(len)),
                _ => Poll::Ready(Err(loss(&error))),
            };
        }
        self.read(cx)
    }

    fn read(&mut self, cx: &mut Context<'_>) -> Poll<Result<usize, Loss>> {
        let mut buffer = ReadBuf::new(&mut self.buffer);
        Poll::Ready(match ready!(Pin::new(&mut *self.stream).poll_read(cx, &mut buffer)) {
            Ok(()) if buffer.filled().is_empty() => Err(Loss::Closed),
            Ok(()) => Ok(buffer.filled().len()),
            Err(error) => Err(loss(&error)),
        })
    }

    fn flush(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        while !self.session.outgoing.is_empty() {
            self.is_flushed = false;
            self.stuck_since.get_or_insert_with(Instant::now);
            let sent = ready!(Pin::new(&mut *self.stream).poll_write(cx, &self.session.outgoing))?;
            if sent == 0 {
                return Poll::Ready(Err(io::ErrorKind::WriteZero.into()));
            }
            self.session.outgoing.drain(..sent);
            self.stuck_since = None;
        }
        if !self.is_flushed {
            ready!(Pin::new(&mut *self.stream).poll_flush(cx))?;
            self.is_flushed = true;
        }
        Poll::Ready(Ok(()))
    }
}

async fn stream(endpoint: &Endpoint) -> Result<Box<dyn Duplex>, Loss> {
    let stream = tcp::connect(&endpoint.host, endpoint.port).await?;
    stream.set_nodelay(true).map_err(|error| loss(&error))?;
    match &endpoint.tls {
        None => Ok(Box::new(stream)),
        Some(tls) => Ok(Box::new(tls.connect(stream).await.map_err(Loss::Tls)?)),
    }
}

fn loss(error: &io::Error) -> Loss {
    use io::ErrorKind::{BrokenPipe, ConnectionAborted, ConnectionReset, UnexpectedEof};

    match TlsError::of(error) {
        Some(error) => Loss::Tls(error),
        None if matches!(error.kind(), BrokenPipe | ConnectionAborted | ConnectionReset | UnexpectedEof) => {
            Loss::Closed
        }
        None => Loss::Io(super::super::plain(error)),
    }
}

#[cfg(test)]
mod tests {
    use tokio::io::AsyncWriteExt as _;
    use tokio::time::sleep;

    use super::super::Version;
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn leaves_a_broker_that_does_not_read() {
        let hello = Hello {
            version: Version::V3,
            client_id: "cell7".to_owned(),
            user: None,
            password: None,
            keep_alive: Duration::from_secs(30),
            will: None,
        };
        let now = Instant::now();
        let session = Session::new(&hello, now, now + Duration::from_secs(10)).unwrap();
        // The buffer is smaller than CONNECT, so the client needs more than one write.
        let (stream, mut broker) = tokio::io::duplex(8);
        let mut client =
            Client { stream: Box::new(stream), session, buffer: vec![0; CHUNK], is_flushed: true, stuck_since: None };
        let talks = async {
            broker.write_all(&[0x20, 2, 0, 0]).await.unwrap();
            loop {
                sleep(Duration::from_secs(1)).await;
                broker.write_all(&[0xd0, 0]).await.unwrap();
            }
        };
        let last = async {
            loop {
                if let Event::Lost(loss) = client.next().await {
                    return loss;
                }
            }
        };
        let loss = tokio::select! {
            loss = last => loss,
            () = talks => unreachable!("it has no end"),
        };
        assert!(matches!(loss, Loss::Unread), "{loss}");
        assert!(now.elapsed() <= UNREAD + Duration::from_secs(1), "{:?}", now.elapsed());
    }
}

//! Server that connects a [`Peer`] to a byte stream. The client side is [`serial`](super::serial) and
//! [`tcp`](super::tcp).

use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::mpsc::UnboundedReceiver;
use tokio::time::Instant;

use super::fault::LineFaultSpec;
use super::line::{Pace, Wire};
use super::pty::Pty;
use super::sim::Peer;

/// Bytes per read or write.
const BUFFER_SIZE: usize = 4096;
/// Maximum number of bytes that wait for a TCP client. The server disconnects a client that does not read them.
const MAX_UNSENT: usize = 1 << 20;

/// A line with a peer, for one client at a time.
#[derive(Debug)]
pub struct StreamServer {
    end: End,
    wire: Wire,
    start: Instant,
}

#[derive(Debug)]
enum End {
    Tcp(Tcp),
    Pty(Pty),
}

enum Event {
    Sent(usize),
    /// A client connected or disconnected.
    Changed,
}

impl StreamServer {
    /// Listens on TCP like a device server. With port 0, the system selects a port. Only one client at a time uses the
    /// line. The server disconnects all other clients at once, so that they get an error.
    pub async fn tcp(
        address: SocketAddr,
        pace: Option<Pace>,
        faults: Option<LineFaultSpec>,
    ) -> io::Result<(Self, SocketAddr)> {
        let listener = TcpListener::bind(address).await?;
        let local = listener.local_addr()?;
        Ok((Self::new(End::Tcp(Tcp { listener, client: None, second: None, unsent: Vec::new() }), pace, faults), local))
    }

    /// Creates a pseudo-terminal. Returns it with the path of its port.
    ///
    /// # Errors
    /// [`Unsupported`](io::ErrorKind::Unsupported) on systems without pseudo-terminals.
    pub fn pseudo_terminal(pace: Option<Pace>, faults: Option<LineFaultSpec>) -> io::Result<(Self, String)> {
        let (pty, path) = Pty::open()?;
        Ok((Self::new(End::Pty(pty), pace, faults), path))
    }

    fn new(end: End, pace: Option<Pace>, faults: Option<LineFaultSpec>) -> Self {
        Self { end, wire: Wire::new(pace, faults), start: Instant::now() }
    }

    /// Time since the start of the server. The peer uses this clock.
    pub fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// Changes the faults of the line.
    pub fn set_faults(&mut self, faults: Option<LineFaultSpec>) {
        self.wire.set_faults(faults);
    }

    /// Serves until the sender of `faults` is dropped, or until the line fails. Each value of `faults` replaces the
    /// faults of the line.
    pub async fn run(&mut self, peer: &mut impl Peer, mut faults: UnboundedReceiver<Option<LineFaultSpec>>) {
        loop {
            tokio::select! {
                end = self.turn(peer) => if end.is_err() { return },
                changed = faults.recv() => match changed {
                    Some(faults) => self.set_faults(faults),
                    None => return,
                },
            }
        }
    }

    /// Waits for one event and handles it. The caller calls this function in a loop.
    pub async fn turn(&mut self, peer: &mut impl Peer) -> io::Result<()> {
        let mut buffer = [0; BUFFER_SIZE];
        let due = self.wire.due(peer).map(|due| self.start + due);
        let event = tokio::select! {
            event = self.end.event(&mut buffer) => Some(event?),
            () = sleep(due) => None,
        };
        let now = self.now();
        self.wire.run(now, peer);
        match event {
            Some(Event::Sent(len)) => self.wire.send(now, &buffer[..len]),
            // Bytes in transit are lost: the client to which they were sent is no longer connected.
            Some(Event::Changed) => self.wire.lose(now),
            None => {}
        }
        self.wire.run(now, peer);
        loop {
            let len = self.wire.take(now, &mut buffer);
            if len == 0 {
                return Ok(());
            }
            self.end.write(&buffer[..len])?;
        }
    }
}

async fn sleep(until: Option<Instant>) {
    match until {
        Some(until) => tokio::time::sleep_until(until).await,
        None => std::future::pending().await,
    }
}

impl End {
    async fn event(&mut self, buffer: &mut [u8]) -> io::Result<Event> {
        match self {
            Self::Tcp(tcp) => tcp.event(buffer).await,
            Self::Pty(pty) => pty.read(buffer).await.map(Event::Sent),
        }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        match self {
            Self::Tcp(tcp) => {
                tcp.write(bytes);
                Ok(())
            }
            Self::Pty(pty) => pty.write(bytes),
        }
    }
}

#[derive(Debug)]
struct Tcp {
    listener: TcpListener,
    client: Option<TcpStream>,
    /// A client that connected while another one seemed to be connected.
    second: Option<TcpStream>,
    /// Bytes that the client has not accepted yet.
    unsent: Vec<u8>,
}

impl Tcp {
    async fn event(&mut self, buffer: &mut [u8]) -> io::Result<Event> {
        loop {
            let Some(client) = &mut self.client else {
                let client = match self.second.take() {
                    Some(client) => client,
                    None => accept(&self.listener).await?,
                };
                // `None` if the client has already disconnected.
                self.client = client.set_nodelay(true).is_ok().then_some(client);
                return Ok(Event::Changed);
            };
            if self.second.is_some() {
                // The listener can be ready before the runtime has asked the operating system about the first client,
                // which may have ended before. The runtime asks during this wait.
                tokio::task::yield_now().await;
                match client.try_read(buffer) {
                    Err(error) if error.kind() == io::ErrorKind::WouldBlock => self.second = None,
                    Ok(len) if len > 0 => {
                        self.second = None;
                        return Ok(Event::Sent(len));
                    }
                    _ => {
                        self.leave();
                        return Ok(Event::Changed);
                    }
                }
            }
            let (mut reading, mut writing) = client.split();
            tokio::select! {
                // Because of `biased`, the server handles the end of a client before it accepts the next client.
                biased;
                read = reading.read(buffer) => match read {
                    Ok(len) if len > 0 => return Ok(Event::Sent(len)),
                    // The client is gone, for whatever reason.
                    _ => {
                        self.leave();
                        return Ok(Event::Changed);
                    }
                },
                written = writing.write(&self.unsent), if !self.unsent.is_empty() => match written {
                    Ok(len) => drop(self.unsent.drain(..len)),
                    Err(_) => self.leave(),
                },
                second = accept(&self.listener) => self.second = Some(second?),
            }
        }
    }

    /// Writes as many bytes as the client accepts now, and keeps the rest.
    fn write(&mut self, bytes: &[u8]) {
        let Some(client) = &self.client else { return };
        // An error is ignored here: the next read reports it.
        let written = if self.unsent.is_empty() { client.try_write(bytes).unwrap_or(0) } else { 0 };
        self.unsent.extend(bytes.get(written..).unwrap_or_default());
        if self.unsent.len() > MAX_UNSENT {
            self.leave();
        }
    }

    fn leave(&mut self) {
        self.client = None;
        self.unsent.clear();
    }
}

/// Waits for the next client. A client that has already disconnected is skipped.
async fn accept(listener: &TcpListener) -> io::Result<TcpStream> {
    loop {
        match listener.accept().await {
            Ok((client, _)) => return Ok(client),
            Err(error) if matches!(error.kind(), io::ErrorKind::ConnectionAborted | io::ErrorKind::ConnectionReset) => {
            }
            Err(error) => return Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::future::Future;
    use std::net::Ipv4Addr;

    use super::super::tcp;
    use super::super::testing::{Mirror, soon};
    use super::*;

    /// Runs the server until `clients` ends.
    async fn with<T>(server: &mut StreamServer, peer: &mut Mirror, clients: impl Future<Output = T>) -> T {
        let mut clients = std::pin::pin!(clients);
        loop {
            tokio::select! {
                done = &mut clients => return done,
                outcome = server.turn(peer) => outcome.unwrap(),
            }
        }
    }

    async fn on_loopback() -> (StreamServer, u16) {
        let any = SocketAddr::from((Ipv4Addr::LOCALHOST, 0));
        let (server, address) = StreamServer::tcp(any, None, None).await.unwrap();
        (server, address.port())
    }

    async fn connect(port: u16) -> tcp::Tcp {
        tcp::Tcp::open("127.0.0.1", port, soon()).await.unwrap()
    }

    /// Sends a line, and receives the same number of bytes.
    async fn ask(client: &mut tcp::Tcp, line: &[u8]) -> io::Result<Vec<u8>> {
        client.send(line).await?;
        let (mut bytes, mut buffer) = (Vec::new(), [0; BUFFER_SIZE]);
        while bytes.len() < line.len() {
            let len = client.receive(&mut buffer, soon()).await?.expect("an answer");
            bytes.extend(&buffer[..len]);
        }
        Ok(bytes)
    }

    #[tokio::test]
    async fn tcp_clients_use_the_line_in_turn() {
        let (mut server, port) = on_loopback().await;
        let clients = async {
            for _ in 0..50 {
                let mut client = connect(port).await;
                assert_eq!(ask(&mut client, b"abc\n").await.unwrap(), b"\ncba");
            }
        };
        with(&mut server, &mut Mirror::default(), clients).await;
    }

    #[tokio::test]
    async fn rejects_a_second_client() {
        let (mut server, port) = on_loopback().await;
        let clients = async {
            let mut first = connect(port).await;
            assert_eq!(ask(&mut first, b"ab\n").await.unwrap(), b"\nba");
            let mut second = connect(port).await;
            let error = second.receive(&mut [0; 8], soon()).await.unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::NotConnected);
            assert_eq!(ask(&mut first, b"cd\n").await.unwrap(), b"\ndc");
        };
        with(&mut server, &mut Mirror::default(), clients).await;
    }

    #[tokio::test]
    async fn drops_the_answer_for_a_disconnected_client() {
        let (mut server, port) = on_loopback().await;
        // One character takes eleven seconds, so the test ends before the answer is complete.
        server.wire = Wire::new(Some(Pace::new(1, 11)), None);
        let mut peer = Mirror::default();
        let client = connect(port).await;
        server.turn(&mut peer).await.unwrap();
        peer.answers.push_back(b"late".to_vec());
        server.turn(&mut peer).await.unwrap();
        assert!(server.wire.due(&peer).is_some());
        drop(client);
        server.turn(&mut peer).await.unwrap();
        assert_eq!(server.wire.due(&peer), None);
    }

    #[tokio::test]
    async fn delivers_large_data_to_a_reading_client() {
        let (mut server, port) = on_loopback().await;
        let mut line = vec![b'x'; 500_000];
        line.push(b'\n');
        let clients = async { ask(&mut connect(port).await, &line).await.unwrap() };
        let bytes = with(&mut server, &mut Mirror::default(), clients).await;
        assert!(bytes.iter().rev().eq(&line));
    }

    #[cfg(unix)]
    mod pseudo_terminal {
        use serialport::{DataBits, Parity, StopBits};

        use super::super::super::serial::{Line, OpenError, Serial};
        use super::*;

        fn open(path: &str) -> Serial {
            let path = path.to_owned();
            let (data_bits, parity, stop_bits) = (DataBits::Eight, Parity::Even, StopBits::One);
            let line = Line { path, baud: 9600, data_bits, parity, stop_bits };
            // The thread that used the port before this test may still be closing it.
            loop {
                match Serial::open(&line) {
                    Err(OpenError::Busy) => std::thread::yield_now(),
                    opened => return opened.unwrap(),
                }
            }
        }

        async fn ask(serial: &mut Serial, line: &[u8], count: usize) -> Vec<u8> {
            serial.send(line).await.unwrap();
            let (mut bytes, mut buffer) = (Vec::new(), [0; BUFFER_SIZE]);
            while bytes.len() < count {
                let len = serial.receive(&mut buffer, soon()).await.unwrap().expect("an answer");
                bytes.extend(&buffer[..len]);
            }
            bytes
        }

        #[tokio::test]
        async fn clients_come_and_go() {
            let (mut server, path) = StreamServer::pseudo_terminal(None, None).unwrap();
            let clients = async {
                for _ in 0..20 {
                    assert_eq!(ask(&mut open(&path), b"abc\n", 4).await, b"\ncba");
                }
            };
            with(&mut server, &mut Mirror::default(), clients).await;
        }

        #[tokio::test]
        async fn applies_faults_to_the_line() {
            let faults = "echo,dup=100%".parse().unwrap();
            let (mut server, path) = StreamServer::pseudo_terminal(None, Some(faults)).unwrap();
            let clients = async { ask(&mut open(&path), b"ab\n", 18).await };
            let bytes = with(&mut server, &mut Mirror::default(), clients).await;
            assert_eq!(bytes, b"aabb\n\n\n\nbbbbaaaa\n\n");
        }

        #[tokio::test]
        async fn unread_output_does_not_block_the_server() {
            let (mut server, path) = StreamServer::pseudo_terminal(None, None).unwrap();
            let mut peer = Mirror::default();
            for _ in 0..200 {
                peer.answers.push_back(vec![b'x'; 1000]);
                server.wire.run(server.now(), &mut peer);
                // Writes as if an event of the peer were due.
                let now = server.now();
                let mut buffer = [0; BUFFER_SIZE];
                let len = server.wire.take(now, &mut buffer);
                server.end.write(&buffer[..len]).unwrap();
            }
            let clients = async { ask(&mut open(&path), b"abc\n", 4).await };
            assert!(with(&mut server, &mut peer, clients).await.ends_with(b"\ncba"));
        }
    }
}

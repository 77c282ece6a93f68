//! UDP sockets to one host, one per port.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use tokio::net::UdpSocket;
use tokio::task::coop::consume_budget;
use tokio::time::{Instant, timeout_at};

/// Connected UDP sockets. For a connected socket, the kernel drops datagrams from other hosts and reports a closed
/// port.
#[derive(Debug)]
pub struct Udp {
    channels: Vec<Channel>,
}

/// A port of the host. Its socket opens at the first use.
#[derive(Debug)]
struct Channel {
    peer: SocketAddr,
    open: Option<Open>,
}

#[derive(Debug)]
struct Open {
    socket: UdpSocket,
    /// Local address of the socket. It is cached, because every frame needs it and a system call takes a tenth of a
    /// round trip.
    local: SocketAddr,
    /// Whether a datagram was sent, and none was received since.
    awaits_answer: bool,
}

impl Udp {
    /// Creates channels for the ports of `host`, in this order. A socket opens at its first use.
    pub async fn open(host: &str, ports: &[u16]) -> io::Result<Self> {
        let address = if let Ok(address) = host.parse::<IpAddr>() {
            address
        } else {
            let mut found = tokio::net::lookup_host((host, 0)).await?;
            found.next().ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "the name has no address"))?.ip()
        };
        let channels = ports.iter().map(|port| Channel { peer: SocketAddr::new(address, *port), open: None });
        Ok(Self { channels: channels.collect() })
    }

    /// Creates channels to the same ports with new sockets.
    #[must_use]
    pub fn with_new_sockets(&self) -> Self {
        Self { channels: self.channels.iter().map(|channel| Channel { peer: channel.peer, open: None }).collect() }
    }

    /// Remote address of a channel.
    pub fn peer(&self, channel: usize) -> SocketAddr {
        self.channels[channel].peer
    }

    /// Local address of a channel, after its first use.
    pub fn local(&self, channel: usize) -> Option<SocketAddr> {
        self.channels[channel].open.as_ref().map(|open| open.local)
    }

    /// Replaces the socket of a channel. The client then cannot receive a late datagram for the old socket.
    pub fn renew(&mut self, channel: usize) {
        self.channels[channel].open = None;
    }

    /// Sends one datagram.
    pub async fn send(&mut self, channel: usize, bytes: &[u8]) -> io::Result<()> {
        let open = self.channels[channel].open().await?;
        let sent = match open.socket.try_send(bytes) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => open.socket.send(bytes).await?,
            result => result?,
        };
        open.awaits_answer = true;
        if sent == bytes.len() { Ok(()) } else { Err(io::Error::other("the datagram was cut short")) }
    }

    /// Waits until `until` for one datagram. Bytes that do not fit into `buffer` are dropped.
    pub async fn receive(&mut self, channel: usize, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        let open = self.channels[channel].open().await?;
        // Other tasks (Ctrl-C, other robots) get time to run, even if datagrams arrive without a pause.
        consume_budget().await;
        // A peer on this computer (a simulator or proxy) gets time to answer first. If it answers now, the client needs
        // no failed read, timer and wait in the reactor. This saves a tenth of the round trip. For a remote peer, the
        // cost is negligible. Only once for each request: on a busy computer, each yield costs milliseconds, and a few
        // stray datagrams would use up the time for the answer.
        if std::mem::take(&mut open.awaits_answer) {
            std::thread::yield_now();
        }
        match open.socket.try_recv(buffer) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                timeout_at(until, open.socket.recv(buffer)).await.ok().transpose()
            }
            received => received.map(Some),
        }
    }
}

impl Channel {
    async fn open(&mut self) -> io::Result<&mut Open> {
        if self.open.is_none() {
            let peer = self.peer;
            let any: IpAddr = if peer.is_ipv4() { Ipv4Addr::UNSPECIFIED.into() } else { Ipv6Addr::UNSPECIFIED.into() };
            let socket = UdpSocket::bind(SocketAddr::new(any, 0)).await?;
            socket.connect(peer).await?;
            self.open = Some(Open { local: socket.local_addr()?, socket, awaits_answer: false });
        }
        Ok(self.open.as_mut().expect("opened above"))
    }
}

//! UDP sockets to one host, one a port.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use tokio::net::UdpSocket;
use tokio::task::coop::consume_budget;
use tokio::time::{Instant, timeout_at};

/// Connected sockets: the kernel drops what others send and reports a closed port.
#[derive(Debug)]
pub struct Udp {
    channels: Vec<Channel>,
}

/// A port of the host, and the socket to it once there is one.
#[derive(Debug)]
struct Channel {
    peer: SocketAddr,
    open: Option<Open>,
}

#[derive(Debug)]
struct Open {
    socket: UdpSocket,
    /// Asked for once: it is wanted for every frame, and asking costs as much as a tenth of a round trip.
    local: SocketAddr,
}

impl Udp {
    /// For the ports of `host`, in the order that `channel` counts them. Sockets are opened when first used.
    ///
    /// # Errors
    /// When the name does not resolve.
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

    /// The same ports, by sockets of their own.
    #[must_use]
    pub fn another(&self) -> Self {
        Self { channels: self.channels.iter().map(|channel| Channel { peer: channel.peer, open: None }).collect() }
    }

    /// The address of a channel's peer.
    pub fn peer(&self, channel: usize) -> SocketAddr {
        self.channels[channel].peer
    }

    /// The own address of a channel, once it has been used.
    pub fn local(&self, channel: usize) -> Option<SocketAddr> {
        self.channels[channel].open.as_ref().map(|open| open.local)
    }

    /// Gives a channel a new socket, so that nothing late on the old one is heard or mistaken.
    pub fn renew(&mut self, channel: usize) {
        self.channels[channel].open = None;
    }

    /// Sends one datagram.
    pub async fn send(&mut self, channel: usize, bytes: &[u8]) -> io::Result<()> {
        let socket = self.channels[channel].socket().await?;
        let sent = match socket.try_send(bytes) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => socket.send(bytes).await?,
            result => result?,
        };
        if sent == bytes.len() { Ok(()) } else { Err(io::Error::other("the datagram was cut short")) }
    }

    /// Waits for one datagram, but not longer than `until`; what does not fit `buffer` is cut.
    pub async fn receive(&mut self, channel: usize, buffer: &mut [u8], until: Instant) -> io::Result<Option<usize>> {
        let socket = self.channels[channel].socket().await?;
        // Where datagrams come without a pause, Ctrl-C and other robots have their turn all the same.
        consume_budget().await;
        // A peer on this machine (a simulator, a proxy) is given the processor before anybody looks. That it has answered
        // by then saves a fruitless look, a timer and a wait in the reactor: a tenth of such a round trip. With a peer
        // elsewhere it costs nothing that could be noticed.
        std::thread::yield_now();
        match socket.try_recv(buffer) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => {
                timeout_at(until, socket.recv(buffer)).await.ok().transpose()
            }
            received => received.map(Some),
        }
    }
}

impl Channel {
    async fn socket(&mut self) -> io::Result<&UdpSocket> {
        if self.open.is_none() {
            let peer = self.peer;
            let any: IpAddr = if peer.is_ipv4() { Ipv4Addr::UNSPECIFIED.into() } else { Ipv6Addr::UNSPECIFIED.into() };
            let socket = UdpSocket::bind(SocketAddr::new(any, 0)).await?;
            socket.connect(peer).await?;
            self.open = Some(Open { local: socket.local_addr()?, socket });
        }
        Ok(&self.open.as_ref().expect("opened above").socket)
    }
}

//! UDP sockets to one host, one a port.

use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use tokio::net::UdpSocket;

/// Connected sockets: the kernel drops what others send and reports a closed port.
#[derive(Debug)]
pub struct Udp {
    peers: Vec<SocketAddr>,
    sockets: Vec<Option<UdpSocket>>,
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
        let peers = ports.iter().map(|port| SocketAddr::new(address, *port)).collect();
        Ok(Self { peers, sockets: ports.iter().map(|_| None).collect() })
    }

    /// The address of a channel's peer.
    pub fn peer(&self, channel: usize) -> SocketAddr {
        self.peers[channel]
    }

    /// The own address of a channel, once it has been used.
    pub fn local(&self, channel: usize) -> Option<SocketAddr> {
        self.sockets[channel].as_ref().and_then(|socket| socket.local_addr().ok())
    }

    /// Gives a channel a new socket, so that nothing late on the old one is heard or mistaken.
    pub fn renew(&mut self, channel: usize) {
        self.sockets[channel] = None;
    }

    /// Sends one datagram.
    pub async fn send(&mut self, channel: usize, bytes: &[u8]) -> io::Result<()> {
        let socket = self.socket(channel).await?;
        let sent = match socket.try_send(bytes) {
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => socket.send(bytes).await?,
            result => result?,
        };
        if sent == bytes.len() { Ok(()) } else { Err(io::Error::other("the datagram was cut short")) }
    }

    /// Waits for one datagram; what does not fit `buffer` is cut.
    pub async fn receive(&mut self, channel: usize, buffer: &mut [u8]) -> io::Result<usize> {
        self.socket(channel).await?.recv(buffer).await
    }

    async fn socket(&mut self, channel: usize) -> io::Result<&UdpSocket> {
        let peer = self.peers[channel];
        let slot = &mut self.sockets[channel];
        if slot.is_none() {
            let any: IpAddr = if peer.is_ipv4() { Ipv4Addr::UNSPECIFIED.into() } else { Ipv6Addr::UNSPECIFIED.into() };
            let socket = UdpSocket::bind(SocketAddr::new(any, 0)).await?;
            socket.connect(peer).await?;
            *slot = Some(socket);
        }
        Ok(slot.as_ref().expect("filled above"))
    }
}

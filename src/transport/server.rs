//! UDP server for a [`Service`]. The client side is [`udp`](super::udp).

use std::collections::HashMap;
use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use tokio::net::UdpSocket;
use tokio::time::Instant;

use super::fault::Faults;

/// A service for many clients, for example a simulated controller.
pub trait Service {
    /// Handles a datagram from a client.
    fn receive(&mut self, now: Duration, channel: usize, client: u64, bytes: &[u8]);
    /// Returns the next datagram due at `now`: channel, client, bytes.
    fn transmit(&mut self, now: Duration) -> Option<(usize, u64, Vec<u8>)>;
    /// Time of the next event.
    fn wake(&self) -> Option<Duration>;
}

/// Maximum number of known clients. If more clients appear, the server forgets all clients and drops the datagrams in
/// transit. UDP allows such losses.
const MAX_CLIENTS: usize = 4096;
/// Size of the receive buffer: larger than any frame, so that oversized datagrams are detected.
const BUFFER: usize = 2048;

/// A UDP server with one socket per channel.
#[derive(Debug)]
pub struct Server {
    sockets: [UdpSocket; 2],
    clients: HashMap<SocketAddr, u64>,
    addresses: Vec<SocketAddr>,
    start: Instant,
    faults: Option<(Faults, Faults)>,
    /// Datagrams that faults delay: due time, whether the datagram goes to the service, channel, client, bytes.
    delayed: Vec<(Duration, bool, usize, u64, Vec<u8>)>,
}

impl Server {
    /// Binds the sockets of both channels. With port 0, the system selects a port.
    pub async fn bind(addresses: [SocketAddr; 2], faults: Option<(Faults, Faults)>) -> io::Result<Self> {
        let sockets = [UdpSocket::bind(addresses[0]).await?, UdpSocket::bind(addresses[1]).await?];
        Ok(Self {
            sockets,
            clients: HashMap::new(),
            addresses: Vec::new(),
            start: Instant::now(),
            faults,
            delayed: Vec::new(),
        })
    }

    /// Local address of a channel.
    pub fn local(&self, channel: usize) -> io::Result<SocketAddr> {
        self.sockets[channel].local_addr()
    }

    /// Time since the start of the server. The service uses this clock.
    pub fn now(&self) -> Duration {
        self.start.elapsed()
    }

    /// Changes the faults for datagrams to the service and from the service. Datagrams in transit keep the old faults.
    pub fn set_faults(&mut self, faults: Option<(Faults, Faults)>) {
        self.faults = faults;
    }

    /// Waits for one event and handles it. The caller calls this function in a loop.
    pub async fn turn(&mut self, service: &mut impl Service) -> io::Result<()> {
        let mut buffers = [[0; BUFFER]; 2];
        let due = self.delayed.iter().map(|flight| flight.0).chain(service.wake()).min();
        let [robot, file] = &self.sockets;
        let [first, second] = &mut buffers;
        let arrived = tokio::select! {
            arrived = robot.recv_from(first) => Some((0, arrived)),
            arrived = file.recv_from(second) => Some((1, arrived)),
            () = sleep(self.start, due) => None,
        };
        let now = self.now();
        match arrived {
            Some((channel, Ok((len, from)))) => {
                let client = self.client(from);
                self.launch(now, true, channel, client, &buffers[channel][..len]);
            }
            // An error report about one client that is gone (ICMP port unreachable) must not stop the server.
            Some((_, Err(error))) if is_about_one_client(&error) => {}
            Some((_, Err(error))) => return Err(error),
            None => {}
        }
        loop {
            while let Some((channel, client, bytes)) = service.transmit(now) {
                self.launch(now, false, channel, client, &bytes);
            }
            let Some(index) =
                (0..self.delayed.len()).filter(|i| self.delayed[*i].0 <= now).min_by_key(|i| self.delayed[*i].0)
            else {
                return Ok(());
            };
            let (_, inward, channel, client, bytes) = self.delayed.remove(index);
            if inward {
                service.receive(now, channel, client, &bytes);
            } else {
                self.send(channel, client, &bytes).await?;
            }
        }
    }

    fn launch(&mut self, now: Duration, inward: bool, channel: usize, client: u64, bytes: &[u8]) {
        let faults = self.faults.as_mut().map(|(there, back)| if inward { there } else { back });
        let flights = match faults {
            Some(faults) => faults.pass(now, bytes),
            None => vec![(now, bytes.to_vec())],
        };
        self.delayed.extend(flights.into_iter().map(|(at, bytes)| (at, inward, channel, client, bytes)));
    }

    async fn send(&self, channel: usize, client: u64, bytes: &[u8]) -> io::Result<()> {
        let address = usize::try_from(client).ok().and_then(|index| self.addresses.get(index));
        let Some(address) = address else { return Ok(()) };
        match self.sockets[channel].send_to(bytes, address).await {
            Err(error) if !is_about_one_client(&error) => Err(error),
            _ => Ok(()),
        }
    }

    fn client(&mut self, address: SocketAddr) -> u64 {
        if let Some(client) = self.clients.get(&address) {
            return *client;
        }
        if self.addresses.len() >= MAX_CLIENTS {
            self.clients.clear();
            self.addresses.clear();
        }
        let client = self.addresses.len() as u64;
        self.addresses.push(address);
        self.clients.insert(address, client);
        client
    }
}

async fn sleep(start: Instant, due: Option<Duration>) {
    match due {
        Some(due) => tokio::time::sleep_until(start + due).await,
        None => std::future::pending().await,
    }
}

fn is_about_one_client(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionRefused, ConnectionReset, HostUnreachable, NetworkUnreachable};

    matches!(error.kind(), ConnectionRefused | ConnectionReset | HostUnreachable | NetworkUnreachable)
}

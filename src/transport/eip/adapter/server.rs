//! Socket server for an adapter: TCP for sessions, UDP on the same port for ListIdentity, and UDP for images.

use std::collections::BTreeMap;
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::io::{AsyncReadExt as _, AsyncWriteExt as _};
use tokio::net::{TcpListener, TcpStream};
use tokio::runtime::Handle;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

use super::super::engine::{Alarm, Engine, Prepared, spawn};
use super::super::{IO_PORT, Now, PORT};
use super::{Adapter, Application, Output, Setup};
use crate::fault::Faults;

/// Size of the receive buffer: the size of the largest datagram.
const BUFFER: usize = 65_536;
/// Maximum number of clients. If there are more, the server closes their TCP connections at once.
const MAX_CLIENTS: usize = 64;
/// If the system selects the port: number of attempts to bind TCP and UDP to the same port.
const TRIES: usize = 16;

/// Pause after a failed accept.
const PAUSE: Duration = Duration::from_millis(50);

/// Addresses of an adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AdapterAddresses {
    /// IP address.
    pub address: Ipv4Addr,
    /// TCP port for sessions, and UDP port for ListIdentity. With 0, the system selects the port.
    pub port: u16,
    /// UDP port for images. With 0, the system selects the port. Some originators ignore the port in the reply and
    /// always use 2222.
    pub io_port: u16,
}

impl AdapterAddresses {
    /// Returns this address with the standard ports.
    pub const fn usual(address: Ipv4Addr) -> Self {
        Self { address, port: PORT, io_port: IO_PORT }
    }

    /// Returns this address with ports that the system selects.
    pub const fn anywhere(address: Ipv4Addr) -> Self {
        Self { address, port: 0, io_port: 0 }
    }
}

/// A running adapter. A drop stops it, but does not close its connections: the originators must detect the loss.
#[derive(Debug)]
pub struct Server<A: Application + 'static> {
    inner: Arc<SharedState<A>>,
    address: SocketAddrV4,
    /// UDP port for images.
    pub io_port: u16,
    _engine: Engine,
}

#[derive(Debug)]
struct SharedState<A> {
    start: Instant,
    alarm: Arc<Alarm>,
    images: UdpSocket,
    discovery: UdpSocket,
    state: Mutex<State<A>>,
}

#[derive(Debug)]
struct State<A> {
    adapter: Adapter<A>,
    lines: BTreeMap<u64, UnboundedSender<Vec<u8>>>,
    last: u64,
    /// Faults to inject: first for images to the adapter, then for images from the adapter.
    faults: Option<(Faults, Faults)>,
    /// Images that fault injection delays.
    delayed: Vec<(Now, Delayed)>,
}

#[derive(Debug)]
enum Delayed {
    Arriving(SocketAddrV4, Vec<u8>),
    Leaving(SocketAddrV4, Vec<u8>),
}

impl<A: Application> Server<A> {
    /// Starts the server. `faults` apply to images to and from the adapter.
    pub fn start(
        setup: Setup,
        application: A,
        listen: AdapterAddresses,
        faults: Option<(Faults, Faults)>,
    ) -> io::Result<Self> {
        let prepared = Prepared::new()?;
        let (sessions, discovery) = bind(listen)?;
        let images = UdpSocket::bind((listen.address, listen.io_port))?;
        images.set_nonblocking(true)?;
        discovery.set_nonblocking(true)?;
        sessions.set_nonblocking(true)?;
        let (SocketAddr::V4(address), SocketAddr::V4(image_address)) = (sessions.local_addr()?, images.local_addr()?)
        else {
            return Err(io::ErrorKind::Unsupported.into());
        };
        let mut adapter = Adapter::new(setup, application);
        adapter.listens(address, image_address.port());
        let (sessions, handle_datagram, handle_discovery) = {
            let _here = prepared.handle().enter();
            let (images, discovery) = (images.try_clone()?, discovery.try_clone()?);
            let udp = tokio::net::UdpSocket::from_std;
            (TcpListener::from_std(sessions)?, udp(images)?, udp(discovery)?)
        };
        let alarm = Arc::new(Alarm::default());
        let start = Instant::now();
        let state = State { adapter, lines: BTreeMap::new(), last: 0, faults, delayed: Vec::new() };
        let inner =
            Arc::new(SharedState { start, alarm: Arc::clone(&alarm), images, discovery, state: Mutex::new(state) });
        spawn(prepared.handle(), accept(Arc::clone(&inner), sessions, prepared.handle().clone()));
        spawn(prepared.handle(), receive(Arc::clone(&inner), handle_datagram, SharedState::handle_datagram));
        spawn(prepared.handle(), receive(Arc::clone(&inner), handle_discovery, SharedState::handle_discovery));
        let for_engine = Arc::clone(&inner);
        let engine = prepared.start("adapter", start, alarm, move || for_engine.run_due())?;
        Ok(Self { inner, address, io_port: image_address.port(), _engine: engine })
    }

    /// Address for sessions.
    pub const fn address(&self) -> SocketAddrV4 {
        self.address
    }

    /// Changes the faults for images to the adapter and from the adapter.
    pub fn set_faults(&self, faults: Option<(Faults, Faults)>) {
        self.inner.state().faults = faults;
    }

    /// Calls `look` with the adapter and the current time.
    pub fn with<T>(&self, look: impl FnOnce(&mut Adapter<A>, Now) -> T) -> T {
        let result = look(&mut self.inner.state().adapter, self.inner.start.elapsed());
        self.inner.alarm.set(Some(Now::ZERO));
        result
    }
}

impl<A: Application> SharedState<A> {
    fn state(&self) -> MutexGuard<'_, State<A>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls `change` with the state, then executes the actions that result.
    fn with(&self, change: impl FnOnce(&mut State<A>, Now)) {
        let mut state = self.state();
        let now = self.start.elapsed();
        change(&mut state, now);
        let wake = self.execute_actions(&mut state, now);
        self.alarm.set(wake);
    }

    /// Executes the work that is due. Returns the time at which it must be called again.
    fn run_due(&self) -> Option<Now> {
        let mut state = self.state();
        let now = self.start.elapsed();
        let (due, later) = std::mem::take(&mut state.delayed).into_iter().partition(|(at, _)| *at <= now);
        state.delayed = later;
        let mut due: Vec<(Now, Delayed)> = due;
        due.sort_by_key(|(at, _)| *at);
        for (_, delayed) in due {
            match delayed {
                Delayed::Arriving(from, bytes) => state.adapter.receive_datagram(now, from, &bytes),
                Delayed::Leaving(to, bytes) => send(&self.images, to, &bytes),
            }
        }
        self.execute_actions(&mut state, now)
    }

    fn execute_actions(&self, state: &mut State<A>, now: Now) -> Option<Now> {
        while let Some(output) = state.adapter.poll(now) {
            match output {
                Output::Send(client, bytes) => {
                    if let Some(line) = state.lines.get(&client) {
                        // An error means that the TCP connection is closed. The task of the connection reports this.
                        let _ = line.send(bytes);
                    }
                }
                Output::HangUp(client) => {
                    state.lines.remove(&client);
                    state.adapter.disconnected(client);
                }
                Output::Datagram(to, bytes) => match &mut state.faults {
                    None => send(&self.images, to, &bytes),
                    Some((_, back)) => {
                        let copies = back.pass(now, &bytes);
                        state.delayed.extend(copies.into_iter().map(|(at, bytes)| (at, Delayed::Leaving(to, bytes))));
                    }
                },
                Output::Discovered(to, bytes) => send(&self.discovery, to, &bytes),
            }
        }
        state.delayed.iter().map(|(at, _)| *at).chain(state.adapter.wake()).min()
    }

    fn handle_datagram(&self, from: SocketAddrV4, bytes: &[u8]) {
        self.with(|state, now| match &mut state.faults {
            None => state.adapter.receive_datagram(now, from, bytes),
            Some((there, _)) => {
                let copies = there.pass(now, bytes);
                state.delayed.extend(copies.into_iter().map(|(at, bytes)| (at, Delayed::Arriving(from, bytes))));
            }
        });
    }

    fn handle_discovery(&self, from: SocketAddrV4, bytes: &[u8]) {
        self.with(|state, _| state.adapter.discovered(from, bytes));
    }
}

/// UDP is unreliable, so a send error is ignored, as in a real device.
fn send(socket: &UdpSocket, to: SocketAddrV4, bytes: &[u8]) {
    let _ = socket.send_to(bytes, to);
}

/// Binds TCP and UDP to the same port.
fn bind(listen: AdapterAddresses) -> io::Result<(std::net::TcpListener, UdpSocket)> {
    let mut tries = if listen.port == 0 { TRIES } else { 1 };
    loop {
        let sessions = std::net::TcpListener::bind((listen.address, listen.port))?;
        match UdpSocket::bind((listen.address, sessions.local_addr()?.port())) {
            Err(_) if tries > 1 => tries -= 1,
            discovery => return Ok((sessions, discovery?)),
        }
    }
}

async fn accept<A: Application + 'static>(inner: Arc<SharedState<A>>, sessions: TcpListener, handle: Handle) {
    loop {
        // An error means that the peer has already disconnected, or that there are too many open files. Both states are
        // temporary.
        let Ok((stream, SocketAddr::V4(from))) = sessions.accept().await else {
            tokio::time::sleep(PAUSE).await;
            continue;
        };
        let (line, orders) = unbounded_channel();
        let mut client = None;
        inner.with(|state, _| {
            if state.lines.len() < MAX_CLIENTS {
                state.last += 1;
                state.lines.insert(state.last, line);
                state.adapter.connected(state.last, *from.ip());
                client = Some(state.last);
            }
        });
        if let Some(client) = client {
            spawn(&handle, serve(Arc::clone(&inner), client, stream, orders));
        }
    }
}

async fn serve<A: Application>(
    inner: Arc<SharedState<A>>,
    client: u64,
    mut stream: TcpStream,
    mut orders: UnboundedReceiver<Vec<u8>>,
) {
    // An error is ignored: the option only saves time. Without it, an answer may wait for the acknowledgement of the
    // previous answer.
    let _ = stream.set_nodelay(true);
    let (mut from, mut to) = stream.split();
    let mut buffer = [0; 4096];
    loop {
        tokio::select! {
            biased;
            order = orders.recv() => match order {
                Some(bytes) if to.write_all(&bytes).await.is_ok() => {}
                _ => break,
            },
            read = from.read(&mut buffer) => match read {
                Ok(len @ 1..) => inner.with(|state, now| state.adapter.received(now, client, &buffer[..len])),
                Ok(0) | Err(_) => break,
            },
        }
    }
    inner.with(|state, _| {
        state.lines.remove(&client);
        state.adapter.disconnected(client);
    });
}

async fn receive<A: Application>(
    inner: Arc<SharedState<A>>,
    socket: tokio::net::UdpSocket,
    take: fn(&SharedState<A>, SocketAddrV4, &[u8]),
) {
    let mut buffer = vec![0; BUFFER];
    loop {
        // An error concerns only one peer (Windows: port unreachable). The other peers are not affected.
        if let Ok((len, SocketAddr::V4(from))) = socket.recv_from(&mut buffer).await {
            take(&inner, from, &buffer[..len]);
        }
    }
}

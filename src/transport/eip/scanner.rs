//! Driver for any number of connections. All of them use one UDP socket.

use std::collections::{BTreeMap, HashMap};
use std::io;
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Instant;

use tokio::runtime::Handle;
use tokio::sync::{mpsc, oneshot, watch};

use super::engine::{Alarm, Engine, Prepared, spawn};
use super::error::EipError;
use super::explicit::{Answer, Message};
use super::originator::{Action, Identifiers, Originator, View, Views};
use super::session::{Ask, Token};
use super::settings::Settings;
use super::tap::Tap;
use super::wire::{Command, Cyclic};
use super::{IO_PORT, Now};
use crate::local_error::LocalError;

mod tcp;

use tcp::Line;

/// First token for messages of callers. The originator itself uses the lower tokens.
const FIRST_TOKEN: u64 = 2;
/// Maximum number of datagrams that are handled before other tasks can run.
const MAX_PER_WAKEUP: usize = 64;
/// Size of the receive buffer: the size of the largest datagram.
const BUFFER: usize = 65_536;

/// Scanner with its connections. Clones are cheap and share the connections. The threads of the scanner stop when the
/// last clone and the last connection are dropped.
#[derive(Debug, Clone)]
pub struct Scanner {
    owner: Arc<Owner>,
}

#[derive(Debug)]
struct Owner {
    inner: Arc<SharedState>,
    /// Dropping this value stops the threads. `inner` alone cannot do this, because the threads also hold a reference
    /// to it.
    _engine: Engine,
}

#[derive(Debug)]
struct SharedState {
    start: Instant,
    alarm: Arc<Alarm>,
    handle: Handle,
    socket: UdpSocket,
    local: SocketAddrV4,
    identifiers: Arc<Identifiers>,
    slots: Mutex<BTreeMap<u64, Slot>>,
    last: AtomicU64,
    /// Memberships in multicast groups: number of connections for each group and interface.
    groups: Mutex<HashMap<(Ipv4Addr, Ipv4Addr), usize>>,
}

/// A connection with its driver state.
#[derive(Debug)]
struct Slot {
    core: Originator,
    tap: Tap,
    line: Option<Line>,
    /// Local address from which the device is reached. Unspecified until it is known.
    local_address: Ipv4Addr,
    view: watch::Sender<View>,
    answers: HashMap<Token, oneshot::Sender<Result<Vec<u8>, EipError>>>,
}

impl Scanner {
    /// Returns the scanner of this process, bound to all local addresses. All connections share its socket.
    pub fn shared() -> Result<Self, EipError> {
        static SHARED: Mutex<Weak<Owner>> = Mutex::new(Weak::new());
        let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(owner) = shared.upgrade() {
            return Ok(Self { owner });
        }
        let scanner = Self::start(Ipv4Addr::UNSPECIFIED)?;
        *shared = Arc::downgrade(&scanner.owner);
        Ok(scanner)
    }

    /// Starts a scanner on UDP port 2222, or on any port if another program uses port 2222.
    pub fn start(address: Ipv4Addr) -> Result<Self, EipError> {
        let failed = |error: io::Error| LocalError::new("cannot open a UDP socket for images", &error);
        let socket = match UdpSocket::bind((address, IO_PORT)) {
            Err(error) if error.kind() == io::ErrorKind::AddrInUse => UdpSocket::bind((address, 0)),
            bound => bound,
        };
        Ok(Self::on(socket.map_err(failed)?).map_err(failed)?)
    }

    fn on(socket: UdpSocket) -> io::Result<Self> {
        socket.set_nonblocking(true)?;
        let SocketAddr::V4(local) = socket.local_addr()? else { return Err(io::ErrorKind::Unsupported.into()) };
        let engine = Prepared::new()?;
        let handle_datagram = {
            let _guard = engine.handle().enter();
            tokio::net::UdpSocket::from_std(socket.try_clone()?)?
        };
        let alarm = Arc::new(Alarm::default());
        let start = Instant::now();
        let inner = Arc::new(SharedState {
            start,
            alarm: Arc::clone(&alarm),
            handle: engine.handle().clone(),
            socket,
            local,
            identifiers: Arc::new(Identifiers::random()),
            slots: Mutex::default(),
            last: AtomicU64::new(0),
            groups: Mutex::default(),
        });
        spawn(engine.handle(), receive_datagram(Arc::clone(&inner), handle_datagram));
        let for_engine = Arc::clone(&inner);
        let engine = engine.start("eip", start, alarm, move || for_engine.run_due())?;
        Ok(Self { owner: Arc::new(Owner { inner, _engine: engine }) })
    }

    /// UDP port on which images arrive.
    pub fn port(&self) -> u16 {
        self.owner.inner.local.port()
    }

    /// Opens a connection to the device at this TCP address. The connection stays open until it is closed or dropped.
    ///
    /// # Errors
    /// The device does not answer, or refuses. A failed first opening is not repeated. A later loss of the connection
    /// is not an error here, but a state of the view.
    pub async fn open(&self, target: SocketAddrV4, settings: Settings, tap: Tap) -> Result<Connection, EipError> {
        let inner = &self.owner.inner;
        if settings.multicast && self.port() != IO_PORT {
            let text = format!("multicast images use UDP port {IO_PORT}, but another program on this computer uses it");
            return Err(EipError::Impossible(text));
        }
        let core = Originator::new(target, self.port(), settings, Arc::clone(&inner.identifiers))?;
        let (view, views) = Views::new(core.view());
        let slot = Slot { core, tap, line: None, local_address: *inner.local.ip(), view, answers: HashMap::new() };
        let id = inner.last.fetch_add(1, Ordering::Relaxed);
        inner.slots().insert(id, slot);
        inner.with(id, |_, _| ());
        let mut connection = Connection { owner: Arc::clone(&self.owner), id, views, tokens: FIRST_TOKEN };
        connection.views.opened().await?;
        Ok(connection)
    }
}

/// An open connection. A dropped connection is closed, unless the process ends before that.
#[derive(Debug)]
pub struct Connection {
    owner: Arc<Owner>,
    id: u64,
    /// Its states: the current one, and those that follow.
    pub views: Views,
    tokens: u64,
}

impl Connection {
    /// Current time on the clock that the view uses for its images.
    pub fn now(&self) -> Now {
        self.owner.inner.now()
    }

    /// Sends this image, starting with the next interval; see [`Originator::set_image`].
    pub fn set_image(&self, generation: u32, image: &[u8]) -> Result<u64, EipError> {
        self.with(|core| core.set_image(generation, image))
    }

    /// Sets the run/idle bit; see [`Originator::set_run`].
    pub fn set_run(&self, generation: u32, run: bool) -> Result<u64, EipError> {
        self.with(|core| core.set_run(generation, run))
    }

    /// Sends a request to an object of the device in the session of this connection. A refusal is returned as an
    /// answer.
    pub async fn ask(&mut self, what: &'static str, message: &Message) -> Result<Answer, EipError> {
        let token = Token(self.tokens);
        self.tokens += 1;
        let (sender, answer) = oneshot::channel();
        let ask = Ask { token, what, command: Command::SEND_RR_DATA, data: message.emit()? };
        self.owner.inner.with(self.id, |slot, _| {
            slot.answers.insert(token, sender);
            slot.core.ask(ask);
        });
        let data = answer.await.unwrap_or(Err(EipError::Ended))?;
        Answer::parse(what, &data)
    }

    /// Closes the connection: sends one image in idle mode, then ForwardClose. Fails if the device did not confirm the
    /// close.
    pub async fn close(mut self) -> Result<(), EipError> {
        let before = self.views.now().last_error;
        self.with(|core| {
            core.close();
            Ok(())
        })
        .or_else(|last_error| if last_error == EipError::Ended { Ok(()) } else { Err(last_error) })?;
        self.views.closed(before.as_ref()).await
    }

    fn with<T>(&self, change: impl FnOnce(&mut Originator) -> Result<T, EipError>) -> Result<T, EipError> {
        self.owner.inner.with(self.id, |slot, _| change(&mut slot.core)).unwrap_or(Err(EipError::Ended))
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.owner.inner.with(self.id, |slot, _| slot.core.close());
    }
}

impl SharedState {
    fn now(&self) -> Now {
        self.start.elapsed()
    }

    fn slots(&self) -> MutexGuard<'_, BTreeMap<u64, Slot>> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls `change` with a connection, then executes the actions that result. Returns `None` if the connection is
    /// closed.
    fn with<T>(self: &Arc<Self>, id: u64, change: impl FnOnce(&mut Slot, Now) -> T) -> Option<T> {
        let mut slots = self.slots();
        let slot = slots.get_mut(&id)?;
        let now = self.now();
        let result = change(slot, now);
        self.execute_actions(id, slot, now);
        self.alarm.set(slot.core.wake());
        if slot.core.is_finished() {
            slots.remove(&id);
        }
        Some(result)
    }

    /// Executes the work that is due. Returns the time at which it must be called again.
    fn run_due(self: &Arc<Self>) -> Option<Now> {
        let mut slots = self.slots();
        let now = self.now();
        for (id, slot) in slots.iter_mut() {
            if slot.core.wake().is_some_and(|wake| wake <= now) {
                self.execute_actions(*id, slot, now);
            }
        }
        slots.retain(|_, slot| !slot.core.is_finished());
        slots.values().filter_map(|slot| slot.core.wake()).min()
    }

    /// Executes the actions of a connection, and publishes its view.
    fn execute_actions(self: &Arc<Self>, id: u64, slot: &mut Slot, now: Now) {
        while let Some(action) = slot.core.poll(now) {
            match action {
                Action::Connect => {
                    let (line, orders) = Line::new();
                    spawn(
                        &self.handle,
                        tcp::run(Arc::clone(self), id, line.number, slot.core.target(), slot.tap.clone(), orders),
                    );
                    slot.line = Some(line);
                }
                Action::Send(bytes) => {
                    if let Some(line) = &slot.line {
                        line.send(bytes);
                    }
                }
                Action::Disconnect => slot.line = None,
                Action::Datagram(to, bytes) => {
                    // The datagram is recorded before it is sent. Otherwise, a trace could show the answer before the
                    // request.
                    slot.tap.pass(false, SocketAddrV4::new(slot.local_address, self.local.port()), to, &bytes);
                    if let Err(error) = self.socket.send_to(&bytes, to) {
                        slot.core.failed(LocalError::new("cannot send an image", &error).into());
                    }
                }
                Action::Join(group) => {
                    if let Err(error) = self.join_group(group, slot.local_address) {
                        slot.core.failed(LocalError::new("cannot join the multicast group", &error).into());
                    }
                }
                Action::Leave(group) => self.leave_group(group, slot.local_address),
                Action::Answer(token, result) => {
                    if let Some(answer) = slot.answers.remove(&token) {
                        // An error means that the caller no longer waits for the answer.
                        let _ = answer.send(result);
                    }
                }
            }
        }
        if slot.core.take_changed() {
            slot.view.send_replace(slot.core.view());
        }
    }

    fn handle_datagram(&self, from: SocketAddrV4, bytes: &[u8]) {
        let Ok(datagram) = Cyclic::parse(bytes) else { return };
        let now = self.now();
        let mut slots = self.slots();
        // Several connections to one device can share a multicast group.
        for slot in slots.values_mut().filter(|slot| slot.core.expects(*from.ip(), datagram.id)) {
            slot.tap.pass(false, from, SocketAddrV4::new(slot.local_address, self.local.port()), bytes);
            slot.core.receive_datagram(now, from.port(), &datagram);
            if slot.core.take_changed() {
                slot.view.send_replace(slot.core.view());
            }
        }
    }

    fn groups(&self) -> MutexGuard<'_, HashMap<(Ipv4Addr, Ipv4Addr), usize>> {
        self.groups.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn join_group(&self, group: Ipv4Addr, local_address: Ipv4Addr) -> io::Result<()> {
        let mut groups = self.groups();
        let members = groups.entry((group, local_address)).or_default();
        if *members == 0 {
            self.socket.join_multicast_v4(&group, &local_address)?;
        }
        *members += 1;
        Ok(())
    }

    fn leave_group(&self, group: Ipv4Addr, local_address: Ipv4Addr) {
        let mut groups = self.groups();
        let Some(members) = groups.get_mut(&(group, local_address)).filter(|members| **members > 0) else { return };
        *members -= 1;
        if *members == 0 {
            // An error is ignored: if the interface is gone, its membership has ended too.
            let _ = self.socket.leave_multicast_v4(&group, &local_address);
        }
    }
}

/// Receives datagrams until the runtime ends.
async fn receive_datagram(inner: Arc<SharedState>, socket: tokio::net::UdpSocket) {
    let mut buffer = vec![0; BUFFER];
    loop {
        if socket.readable().await.is_err() {
            return;
        }
        for _ in 0..MAX_PER_WAKEUP {
            match socket.try_recv_from(&mut buffer) {
                Ok((len, SocketAddr::V4(from))) => inner.handle_datagram(from, &buffer[..len]),
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                // An error concerns only one device (Windows: port unreachable). The other devices are not affected.
                Ok(_) | Err(_) => {}
            }
        }
        tokio::task::yield_now().await;
    }
}

//! Driver for any number of connections on one interface: one raw socket, one UDP socket, one thread.
//!
//! The exchange of images does not depend on the rest of the program. For example, a prompt that waits for input must
//! not stop a robot. The thread waits for the sockets and for the clock at the same time, with a resolution below 1 ms.

use std::collections::BTreeMap;
use std::net::SocketAddrV4;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread::JoinHandle;
use std::time::Instant;

use etherparse::PacketBuilder;
use tokio::sync::watch;

use super::Now;
use super::controller::identifiers::Identifiers;
use super::controller::view::{Statistics, View, Views};
use super::controller::{Action, Controller, LocalAddress};
use super::error::ProfinetError;
use super::interface::Interface;
use super::settings::Settings;
use super::sockets::{BUFFER, Sockets};
use super::wire::Mac;
use super::wire::alarm::Notification;
use super::wire::rpc;
use crate::image::tap::{Tap, TrafficRecord};
use crate::local_error::LocalError;

/// Network interface with its connections. Clones are cheap and share the connections. The thread of the interface
/// stops when the last clone and the last connection are dropped.
#[derive(Debug, Clone)]
pub struct Network {
    owner: Arc<Owner>,
}

#[derive(Debug)]
struct Owner {
    name: String,
    inner: Arc<Inner>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct Inner {
    start: Instant,
    local_address: LocalAddress,
    identifiers: Arc<Identifiers>,
    sockets: Sockets,
    slots: Mutex<BTreeMap<u64, Slot>>,
    last: AtomicU64,
    is_over: AtomicBool,
}

/// A connection with its driver state.
#[derive(Debug)]
struct Slot {
    core: Controller,
    tap: Tap,
    view: watch::Sender<View>,
}

impl Network {
    /// Returns the network of this process on an interface. All callers share it.
    pub fn shared(interface: &str) -> Result<Self, ProfinetError> {
        static SHARED: Mutex<Vec<Weak<Owner>>> = Mutex::new(Vec::new());
        let mut shared = SHARED.lock().unwrap_or_else(PoisonError::into_inner);
        shared.retain(|owner| owner.strong_count() > 0);
        if let Some(owner) = shared.iter().filter_map(Weak::upgrade).find(|owner| owner.name == interface) {
            return Ok(Self { owner });
        }
        let network = Self::start(&Interface::find(interface)?)?;
        shared.push(Arc::downgrade(&network.owner));
        Ok(network)
    }

    fn start(interface: &Interface) -> Result<Self, ProfinetError> {
        let (sockets, ip) = Sockets::open(interface)?;
        let inner = Arc::new(Inner {
            start: Instant::now(),
            local_address: LocalAddress { mac: interface.mac, ip },
            identifiers: Arc::new(Identifiers::random()),
            sockets,
            slots: Mutex::default(),
            last: AtomicU64::new(0),
            is_over: AtomicBool::new(false),
        });
        let runs = Arc::clone(&inner);
        let thread = std::thread::Builder::new().name("profinet".to_owned());
        let thread = thread
            .spawn(move || runs.run())
            .map_err(|error| LocalError::new("cannot start the thread of the connections", &error))?;
        Ok(Self { owner: Arc::new(Owner { name: interface.name.clone(), inner, thread: Some(thread) }) })
    }

    /// Opens a connection. The connection stays open until it is closed or dropped.
    ///
    /// # Errors
    /// The device is not found, does not answer, or refuses. A later loss of the connection is not an error here, but a
    /// state of the view.
    pub async fn open(&self, settings: Settings, tap: Tap) -> Result<Connection, ProfinetError> {
        let inner = &self.owner.inner;
        let core = Controller::new(inner.local_address, settings, Arc::clone(&inner.identifiers))?;
        let (view, views) = Views::new(core.view());
        let id = inner.last.fetch_add(1, Ordering::Relaxed);
        inner.slots().insert(id, Slot { core, tap, view });
        inner.sockets.wake_up();
        let mut connection = Connection { owner: Arc::clone(&self.owner), id, views };
        connection.views.opened().await?;
        Ok(connection)
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        self.inner.is_over.store(true, Ordering::SeqCst);
        self.inner.sockets.wake_up();
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed.
            let _ = thread.join();
        }
    }
}

/// An open connection. A dropped connection is closed, unless the process ends before that.
#[derive(Debug)]
pub struct Connection {
    owner: Arc<Owner>,
    id: u64,
    /// Its states: the current one, and those that follow.
    pub views: Views,
}

impl Connection {
    /// Current counters. The view has counters too, but they are as old as the last change of the view.
    pub fn statistics(&self) -> Statistics {
        self.with(|core, _| core.statistics()).unwrap_or_else(|| self.views.now().statistics)
    }

    /// Sends this image, starting with the next cycle; see [`Controller::set_image`].
    pub fn set_image(&self, generation: u32, image: &[u8]) -> Result<u64, ProfinetError> {
        self.with(|core, _| core.set_image(generation, image)).unwrap_or(Err(ProfinetError::Ended))
    }

    /// Returns the next alarm.
    pub fn take_alarm(&self) -> Option<Notification> {
        self.with(|core, _| core.take_alarm()).flatten()
    }

    /// Closes the connection. Cyclic frames continue until the device has answered the release. Fails if the device
    /// does not answer.
    pub async fn close(mut self) -> Result<(), ProfinetError> {
        let before = self.views.now().last_error;
        self.with(Controller::close);
        self.owner.inner.sockets.wake_up();
        self.views.closed(before.as_ref()).await
    }

    fn with<T>(&self, change: impl FnOnce(&mut Controller, Now) -> T) -> Option<T> {
        let inner = &self.owner.inner;
        let mut slots = inner.slots();
        let now = inner.now();
        slots.get_mut(&self.id).map(|slot| change(&mut slot.core, now))
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.with(Controller::close);
        self.owner.inner.sockets.wake_up();
    }
}

impl Inner {
    fn now(&self) -> Now {
        self.start.elapsed()
    }

    fn slots(&self) -> MutexGuard<'_, BTreeMap<u64, Slot>> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Body of the thread. Executes the work that is due, then waits for the next deadline, frame or datagram.
    fn run(&self) {
        let mut buffer = vec![0; BUFFER];
        loop {
            let next = self.turn();
            if next.is_none() && self.is_over.load(Ordering::SeqCst) {
                return;
            }
            self.sockets.wait(next.map(|next| next.saturating_sub(self.now())));
            self.sockets.hear(&mut buffer, |bytes| self.frame(bytes), |from, bytes| self.datagram(from, bytes));
        }
    }

    /// Executes the work that is due. Returns the time at which it must be called again.
    fn turn(&self) -> Option<Now> {
        let mut slots = self.slots();
        let now = self.now();
        for slot in slots.values_mut() {
            self.follow(slot, now);
        }
        slots.retain(|_, slot| !slot.core.is_finished());
        slots.values().filter_map(|slot| slot.core.wake()).min()
    }

    /// Executes the actions of a connection, and publishes its view.
    fn follow(&self, slot: &mut Slot, now: Now) {
        while let Some(action) = slot.core.poll(now) {
            match action {
                Action::Frame(bytes) => {
                    slot.tap.pass(|| TrafficRecord::Frame(bytes.clone()));
                    if let Err(error) = self.sockets.send_frame(&bytes) {
                        slot.core.failed(LocalError::new("cannot send a frame", &error).into());
                    }
                }
                Action::Datagram(to, bytes) => {
                    let from = SocketAddrV4::new(self.local_address.ip.address, rpc::PORT);
                    let card = slot.core.card().unwrap_or_default();
                    slot.tap.pass(|| TrafficRecord::Frame(in_frame(self.local_address.mac, card, from, to, &bytes)));
                    if let Err(error) = self.sockets.send_datagram(to, &bytes) {
                        slot.core.failed(LocalError::new("cannot send a call", &error).into());
                    }
                }
            }
        }
        if slot.core.take_changed() {
            slot.view.send_replace(slot.core.view());
        }
    }

    fn frame(&self, bytes: &[u8]) {
        let now = self.now();
        for slot in self.slots().values_mut() {
            if slot.core.is_for_connection(bytes) {
                slot.tap.pass(|| TrafficRecord::Frame(bytes.to_vec()));
            }
            slot.core.frame(now, bytes);
        }
    }

    fn datagram(&self, from: SocketAddrV4, bytes: &[u8]) {
        let now = self.now();
        let to = SocketAddrV4::new(self.local_address.ip.address, rpc::PORT);
        for slot in self.slots().values_mut() {
            if slot.core.address() == Some(*from.ip()) {
                let card = slot.core.card().unwrap_or_default();
                slot.tap.pass(|| TrafficRecord::Frame(in_frame(card, self.local_address.mac, from, to, bytes)));
            }
            slot.core.datagram(now, from, bytes);
        }
    }
}

/// Puts a datagram into its Ethernet frame, for a recording. A reader of the recording needs the MAC addresses to
/// identify the connections.
pub(super) fn in_frame(source: Mac, destination: Mac, from: SocketAddrV4, to: SocketAddrV4, bytes: &[u8]) -> Vec<u8> {
    const IP_TTL: u8 = 64;
    let headers = PacketBuilder::ethernet2(source.0, destination.0)
        .ipv4(from.ip().octets(), to.ip().octets(), IP_TTL)
        .udp(from.port(), to.port());
    let mut frame = Vec::with_capacity(headers.size(bytes.len()));
    // This cannot fail, because a datagram always fits into a packet.
    let _ = headers.write(&mut frame, bytes);
    frame
}

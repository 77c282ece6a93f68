//! In-process network with one device, this computer, and a virtual clock. The device answers requests at once. An open
//! connection follows the clock of the program.

use std::collections::{BTreeMap, VecDeque};
use std::fmt;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::time::Duration;

use super::Now;
use super::controller::identifiers::Identifiers;

use super::controller::{Action, Controller, LocalAddress};
use super::device::{Application, Device};
use super::error::ProfinetError;
use super::interface::Interface;
use super::settings::Settings;
use super::wire::Mac;
use super::wire::dcp::IpSuite;
use super::wire::rpc::PORT;
use crate::fault::{FaultSpec, Faults};
use crate::image::ImagePeer;
use crate::image::view::State;

/// Addresses of this computer.
pub(super) const OUR_ADDRESS: LocalAddress = LocalAddress { mac: Mac([2, 0, 0, 0, 0, 1]), ip: suite(1) };
/// Addresses of the device.
const DEVICE_ADDRESS: (Mac, IpSuite) = (Mac([2, 0, 0, 0, 0, 2]), suite(2));
/// Maximum virtual time for opening or closing a connection.
const MAX_VIRTUAL_TIME: Duration = Duration::from_secs(120);

/// Returns an address from a range that is reserved for documentation (RFC 5737). No real network has such addresses.
const fn suite(host: u8) -> IpSuite {
    let address = Ipv4Addr::new(192, 0, 2, host);
    IpSuite { address, mask: Ipv4Addr::new(255, 255, 255, 0), gateway: Ipv4Addr::UNSPECIFIED }
}

/// The device on the network.
trait Station: Send {
    fn frame(&mut self, now: Now, bytes: &[u8]);
    fn datagram(&mut self, now: Now, from: SocketAddrV4, bytes: &[u8]);
    fn poll(&mut self, now: Now) -> Option<Action>;
    fn wake(&self) -> Option<Now>;
    /// Address from which the device answers, if this is not its own address.
    fn answers_from(&self) -> Option<Ipv4Addr>;
}

impl<A: Application + Send> Station for Device<A> {
    fn frame(&mut self, now: Now, bytes: &[u8]) {
        self.frame(now, bytes);
    }

    fn datagram(&mut self, now: Now, from: SocketAddrV4, bytes: &[u8]) {
        self.datagram(now, from, bytes);
    }

    fn poll(&mut self, now: Now) -> Option<Action> {
        self.poll(now)
    }

    fn wake(&self) -> Option<Now> {
        self.wake()
    }

    fn answers_from(&self) -> Option<Ipv4Addr> {
        self.answers_from()
    }
}

/// An in-process network. It exists until its last clone is dropped.
#[derive(Debug, Clone)]
pub struct Network {
    name: String,
    inner: Arc<Mutex<Inner>>,
}

struct Inner {
    now: Now,
    station: Box<dyn Station>,
    /// Frames from the device that were not read yet.
    frames: VecDeque<Vec<u8>>,
    datagrams: VecDeque<(SocketAddrV4, Vec<u8>)>,
    /// Faults to inject: first for traffic to the device, then for traffic from the device.
    faults: Option<(Faults, Faults)>,
    /// Frames and datagrams in transit, by arrival time and sequence number.
    in_flight: BTreeMap<(Now, u64), (Route, Vec<u8>)>,
    sent: u64,
}

/// Maximum number of frames and datagrams in transit.
const MAX_IN_FLIGHT: usize = 10_000;

/// Type and direction of a frame or datagram.
#[derive(Debug, Clone, Copy)]
enum Route {
    FrameThere,
    DatagramThere,
    FrameBack,
    DatagramBack(SocketAddrV4),
}

impl fmt::Debug for Inner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Inner").field("now", &self.now).finish_non_exhaustive()
    }
}

/// All networks of this process, by interface name.
static ALL: Mutex<Vec<(String, Weak<Mutex<Inner>>)>> = Mutex::new(Vec::new());

fn all() -> MutexGuard<'static, Vec<(String, Weak<Mutex<Inner>>)>> {
    ALL.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Network {
    /// Creates a network with a device. The device gets its MAC and IP address from the network. The faults apply to
    /// both directions.
    pub fn new<A: Application + Send + 'static>(
        device: impl FnOnce(Mac, IpSuite) -> Device<A>,
        faults: Option<FaultSpec>,
    ) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(1);
        // The name contains a colon. No Linux interface can have such a name.
        let name = format!("sim:{}", COUNT.fetch_add(1, Ordering::Relaxed));
        let station = Box::new(device(DEVICE_ADDRESS.0, DEVICE_ADDRESS.1));
        let inner = Inner {
            now: Now::ZERO,
            station,
            frames: VecDeque::new(),
            datagrams: VecDeque::new(),
            faults: faults.map(Faults::pair),
            in_flight: BTreeMap::new(),
            sent: 0,
        };
        let inner = Arc::new(Mutex::new(inner));
        let mut all = all();
        all.retain(|(_, other)| other.strong_count() > 0);
        all.push((name.clone(), Arc::downgrade(&inner)));
        Self { name, inner }
    }

    /// Finds a network by interface name.
    pub fn find(name: &str) -> Option<Self> {
        let inner = all().iter().find(|(other, _)| other == name).and_then(|(_, inner)| inner.upgrade())?;
        Some(Self { name: name.to_owned(), inner })
    }

    /// The interface of this computer to the network.
    pub fn interface(&self) -> Interface {
        Interface::simulated(self.name.clone(), OUR_ADDRESS, self.clone())
    }

    /// Opens a connection.
    pub fn open(&self, settings: Settings) -> Result<Link, ProfinetError> {
        let controller = Controller::new(OUR_ADDRESS, settings, Arc::new(Identifiers::random()))?;
        let mut link = Link { controller, network: self.clone(), start: Now::ZERO };
        link.run_until(|state| matches!(state, State::Open | State::Closed));
        let view = link.controller.view();
        match (view.state, view.last_error) {
            (State::Open, _) => {
                link.start = self.inner().now;
                Ok(link)
            }
            (_, Some(error)) => Err(error),
            (_, None) => Err(ProfinetError::Ended),
        }
    }

    fn inner(&self) -> MutexGuard<'_, Inner> {
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn now(&self) -> Now {
        self.inner().now
    }

    pub(super) fn send_frame(&self, bytes: &[u8]) {
        self.inner().send(Route::FrameThere, bytes);
    }

    pub(super) fn send_datagram(&self, to: SocketAddrV4, bytes: &[u8]) {
        if to == SocketAddrV4::new(DEVICE_ADDRESS.1.address, PORT) {
            self.inner().send(Route::DatagramThere, bytes);
        }
    }

    /// Returns the next frame that arrives before `until`.
    pub(super) fn receive_frame(&self, until: Now) -> Option<Vec<u8>> {
        self.inner().hear(until, |inner| inner.frames.pop_front())
    }

    /// Returns the next datagram that arrives before `until`.
    pub(super) fn receive_datagram(&self, until: Now) -> Option<(SocketAddrV4, Vec<u8>)> {
        self.inner().hear(until, |inner| inner.datagrams.pop_front())
    }
}

impl Inner {
    /// Sends a frame or datagram, with fault injection.
    fn send(&mut self, way: Route, bytes: &[u8]) {
        let Some((there, back)) = &mut self.faults else { return self.arrive(way, bytes) };
        let faults = if matches!(way, Route::FrameThere | Route::DatagramThere) { there } else { back };
        for (at, bytes) in faults.pass(self.now, bytes) {
            self.sent += 1;
            if self.in_flight.len() < MAX_IN_FLIGHT {
                self.in_flight.insert((at, self.sent), (way, bytes));
            }
        }
    }

    fn arrive(&mut self, way: Route, bytes: &[u8]) {
        match way {
            Route::FrameThere => self.station.frame(self.now, bytes),
            Route::DatagramThere => {
                self.station.datagram(self.now, SocketAddrV4::new(OUR_ADDRESS.ip.address, PORT), bytes);
            }
            Route::FrameBack => self.frames.push_back(bytes.to_vec()),
            Route::DatagramBack(from) => self.datagrams.push_back((from, bytes.to_vec())),
        }
    }

    /// Delivers all frames and datagrams that are due, and lets the device do its work.
    fn settle(&mut self) {
        loop {
            if let Some(first) = self.in_flight.first_entry().filter(|first| first.key().0 <= self.now) {
                let (way, bytes) = first.remove();
                self.arrive(way, &bytes);
            } else if let Some(action) = self.station.poll(self.now) {
                match action {
                    Action::Frame(bytes) => self.send(Route::FrameBack, &bytes),
                    Action::Datagram(_, bytes) => {
                        let from = self.station.answers_from().unwrap_or(DEVICE_ADDRESS.1.address);
                        self.send(Route::DatagramBack(SocketAddrV4::new(from, PORT)), &bytes);
                    }
                }
            } else {
                return;
            }
        }
    }

    /// Time of the next event.
    fn wake(&self) -> Option<Now> {
        let arrival = self.in_flight.first_key_value().map(|((at, _), _)| *at);
        arrival.into_iter().chain(self.station.wake()).min()
    }

    fn hear<T>(&mut self, until: Now, mut take: impl FnMut(&mut Self) -> Option<T>) -> Option<T> {
        loop {
            self.settle();
            if let Some(taken) = take(self) {
                return Some(taken);
            }
            let Some(wake) = self.wake().filter(|wake| *wake < until) else {
                self.now = self.now.max(until);
                return None;
            };
            self.now = self.now.max(wake);
        }
    }
}

/// A connection to the device.
#[derive(Debug)]
pub struct Link {
    controller: Controller,
    network: Network,
    /// Virtual time at which the clock of the program started.
    start: Now,
}

impl Link {
    /// Executes the work that is due. Returns the time at which it must be called again.
    fn settle(&mut self, inner: &mut Inner) -> Option<Now> {
        let controller = &mut self.controller;
        loop {
            inner.settle();
            if let Some(bytes) = inner.frames.pop_front() {
                controller.frame(inner.now, &bytes);
            } else if let Some((from, bytes)) = inner.datagrams.pop_front() {
                controller.datagram(inner.now, from, &bytes);
            } else if let Some(action) = controller.poll(inner.now) {
                match action {
                    Action::Frame(bytes) => inner.send(Route::FrameThere, &bytes),
                    Action::Datagram(to, bytes) if *to.ip() == DEVICE_ADDRESS.1.address => {
                        inner.send(Route::DatagramThere, &bytes);
                    }
                    Action::Datagram(..) => {}
                }
            } else {
                return controller.wake().into_iter().chain(inner.wake()).min();
            }
        }
    }

    /// Runs the connection until `until`, or until the condition is true.
    fn run(&mut self, until: Now, is_enough: impl Fn(&Controller) -> bool) {
        let network = self.network.clone();
        let mut inner = network.inner();
        loop {
            let next = self.settle(&mut inner);
            if is_enough(&self.controller) {
                return;
            }
            let Some(next) = next.filter(|next| *next <= until) else {
                inner.now = inner.now.max(until);
                return;
            };
            inner.now = inner.now.max(next);
        }
    }

    fn run_until(&mut self, condition: impl Fn(State) -> bool) {
        let until = self.network.now() + MAX_VIRTUAL_TIME;
        self.run(until, |controller| condition(controller.view().state));
    }
}

impl ImagePeer for Link {
    fn input(&mut self, now: Duration, image: Option<&[u8]>) {
        let Some(image) = image else {
            let now = self.network.now();
            self.controller.close(now);
            return self.run_until(|state| state == State::Closed);
        };
        self.run(self.start + now, |_| false);
        let generation = self.controller.view().generation;
        // An error means that the link was lost. The image is then too old and is not sent.
        if let Ok(change) = self.controller.set_image(generation, image) {
            // This function may return only after the image was sent. For this, the virtual clock may advance by a
            // cycle.
            let (before, until) = (self.network.now(), self.network.now() + self.controller.settings().watchdog);
            self.run(until, |controller| controller.view().sent >= change || controller.view().state != State::Open);
            self.start += self.network.now().saturating_sub(before);
        }
    }

    fn output(&mut self, now: Duration) -> Option<Vec<u8>> {
        self.run(self.start + now, |_| false);
        let view = self.controller.view();
        view.input.filter(|_| view.state == State::Open).map(|input| input.image.to_vec())
    }

    fn wake(&self) -> Option<Duration> {
        let network = self.network.inner().wake();
        let next = self.controller.wake().into_iter().chain(network).min()?;
        Some(next.saturating_sub(self.start))
    }
}

//! Shared CAN adapters. Each adapter has a thread that runs the master, so that the polls do not depend on the rest of
//! the program. For example, a prompt that waits for input must not stop a robot.

use std::collections::{BTreeMap, HashMap};
use std::fmt;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use serialport::{DataBits, Parity, StopBits};
use tokio::net::TcpStream;
use tokio::runtime::Builder;
use tokio::sync::{Notify, oneshot, watch};
use tokio::time::{Instant, sleep, sleep_until, timeout};

use super::Now;
use super::can::pipe::Pipe;
use super::can::{Bitrate, CanPort, Frame, Health, PortError, PortEvent, SlcanPort};
use super::error::Error;
use super::monitor::{LastTraffic, Monitor};
use super::scanner::{DiscoveredNode, Identity, Reply, Scanner, Token, View, Views};
use super::settings::Settings;
use super::wire::{Answer, Mac, Request};
pub use crate::image::tap::Tap;
use crate::image::tap::TrafficRecord;
use crate::serial::{self, Line};

/// Pause between attempts to reopen an adapter.
const REOPEN_INTERVAL: Duration = Duration::from_secs(1);
/// Time limit for a connection to an SLCAN server.
const CONNECT: Duration = Duration::from_secs(5);
/// Time for the adapter to process the last command before the port is closed.
const CLOSE_DELAY: Duration = Duration::from_millis(20);
/// Interval of the checks for traffic in [`Network::listen`].
const LISTEN_TIME: Duration = Duration::from_millis(50);

/// Location of an adapter.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum AdapterLocation {
    /// SLCAN on a serial port. USB adapters ignore the baud rate.
    Serial {
        /// Name of the port, for example `/dev/ttyACM0` or `COM3`.
        path: String,
        /// Baud rate of the port.
        baud: u32,
    },
    /// SLCAN behind TCP.
    Tcp {
        /// Host name or address.
        host: String,
        /// TCP port.
        port: u16,
    },
    /// A Linux CAN interface.
    SocketCan(String),
}

impl fmt::Display for AdapterLocation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Serial { path, .. } => f.write_str(path),
            Self::Tcp { host, port } => write!(f, "{host}:{port}"),
            Self::SocketCan(interface) => f.write_str(interface),
        }
    }
}

/// An adapter and its configuration.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Adapter {
    /// Location of the adapter.
    pub place: AdapterLocation,
    /// The bit rate of the bus.
    pub bitrate: Bitrate,
    /// Identity of the master. `None` means listen-only: this node sends nothing, not even acknowledgements.
    pub identity: Option<Identity>,
}

/// An open adapter. Clones are cheap and share the adapter. The adapter closes with the last clone and the last
/// connection.
#[derive(Debug, Clone)]
pub struct Network {
    owner: Arc<Owner>,
}

#[derive(Debug)]
struct Owner {
    inner: Arc<Inner>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug)]
struct Inner {
    adapter: Adapter,
    start: Instant,
    wake: Notify,
    last: AtomicU64,
    state: Mutex<SharedState>,
    /// Counter of bus events. A change wakes the waiting tasks.
    news: watch::Sender<u64>,
}

/// State shared by the thread and its callers.
#[derive(Debug)]
struct SharedState {
    /// The master; `None` in listen-only mode.
    scanner: Option<Scanner>,
    monitor: Monitor,
    health: Health,
    views: BTreeMap<u64, watch::Sender<View>>,
    pending_requests: HashMap<Token, oneshot::Sender<Result<Answer, Error>>>,
    found: Option<oneshot::Sender<Vec<DiscoveredNode>>>,
    taps: Vec<Tap>,
    /// Current failure of the adapter; `None` while the adapter works.
    last_error: Option<Error>,
    frames: u64,
    is_over: bool,
}

impl Network {
    /// Opens an adapter, or shares one that is already open in this process. While the adapter is open, frames are also
    /// passed to `tap`.
    ///
    /// # Errors
    /// The adapter cannot be opened, or is already open with other settings.
    pub async fn open(adapter: &Adapter, tap: Tap) -> Result<Self, Error> {
        // This lock is held while an adapter opens. A concurrent caller then waits and shares the adapter.
        static SHARED: tokio::sync::Mutex<Vec<Weak<Owner>>> = tokio::sync::Mutex::const_new(Vec::new());
        let mut shared = SHARED.lock().await;
        {
            shared.retain(|owner| owner.strong_count() > 0);
            let same = |owner: &Arc<Owner>| owner.inner.adapter.place == adapter.place;
            if let Some(owner) = shared.iter().filter_map(Weak::upgrade).find(same) {
                let other = &owner.inner.adapter;
                // A user that only listens can share the adapter of a master.
                let fits = adapter.identity.is_none() || adapter.identity == other.identity;
                if !fits || adapter.bitrate != other.bitrate {
                    let place = &adapter.place;
                    return Err(Error::Settings(format!(
                        "{place} is in use with another bit rate or master MAC; an adapter can have only one bit rate \
                         and one master MAC"
                    )));
                }
                if tap.is_open() {
                    owner.inner.lock().taps.push(tap);
                }
                return Ok(Self { owner });
            }
        }
        let network = Self::start(adapter.clone(), tap).await?;
        shared.push(Arc::downgrade(&network.owner));
        Ok(network)
    }

    /// Opens an adapter without sharing it.
    async fn start(adapter: Adapter, tap: Tap) -> Result<Self, Error> {
        let inside = SharedState {
            scanner: adapter.identity.map(Scanner::new),
            monitor: Monitor::default(),
            health: Health::default(),
            views: BTreeMap::new(),
            pending_requests: HashMap::new(),
            found: None,
            taps: vec![tap],
            last_error: None,
            frames: 0,
            is_over: false,
        };
        let inner = Arc::new(Inner {
            adapter,
            start: Instant::now(),
            wake: Notify::new(),
            last: AtomicU64::new(1),
            state: Mutex::new(inside),
            news: watch::channel(0).0,
        });
        let (opened, is_open) = oneshot::channel();
        let failed =
            |error: &std::io::Error| Error::Settings(format!("cannot start a thread for the adapter: {error}"));
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|error| failed(&error))?;
        let shared = Arc::clone(&inner);
        let work = move || runtime.block_on(run(shared, opened));
        let thread = thread::Builder::new().name("devicenet".to_owned()).spawn(work).map_err(|error| failed(&error))?;
        let owner = Arc::new(Owner { inner, thread: Some(thread) });
        is_open.await.unwrap_or(Err(Error::Ended))?;
        Ok(Self { owner })
    }

    /// Opens a connection to a slave. The connection stays open until it is closed or dropped.
    ///
    /// # Errors
    /// The slave does not answer, or refuses. A failed first opening is not repeated. A later loss of the connection is
    /// not an error here, but a state of the view.
    pub async fn connect(&self, settings: Settings) -> Result<Connection, Error> {
        let inner = &self.owner.inner;
        let number = inner.last.fetch_add(1, Ordering::Relaxed);
        let views = {
            let mut state = inner.lock();
            if let Some(last_error) = &state.last_error {
                return Err(last_error.clone());
            }
            let scanner = state.scanner.as_mut().ok_or_else(|| Error::Settings(ONLY_LISTENS.to_owned()))?;
            scanner.open(number, settings)?;
            let view = scanner.view(number).cloned().ok_or(Error::Ended)?;
            let (sender, views) = Views::new(view);
            state.views.insert(number, sender);
            views
        };
        inner.wake.notify_one();
        let mut connection = Connection { network: self.clone(), number, views };
        connection.views.opened().await?;
        Ok(connection)
    }

    /// Finds the nodes on the bus without allocating connections.
    ///
    /// # Errors
    /// Another node has this MAC, or the adapter fails.
    pub async fn find(&self) -> Result<Vec<DiscoveredNode>, Error> {
        let inner = &self.owner.inner;
        let (sender, found) = oneshot::channel();
        {
            let now = inner.now();
            let mut state = inner.lock();
            let scanner = state.scanner.as_mut().ok_or_else(|| Error::Settings(ONLY_LISTENS.to_owned()))?;
            scanner.find(now);
            state.found = Some(sender);
        }
        inner.wake.notify_one();
        let found = found.await;
        let last_error = inner.lock().last_error.clone();
        found.map_err(|_| last_error.unwrap_or(Error::Ended))
    }

    /// Listens to the traffic of a slave and its master for at most `longest`.
    pub async fn listen(&self, slave: Mac, longest: Duration) -> LastTraffic {
        let until = Instant::now() + longest;
        loop {
            let last_traffic = self.owner.inner.lock().monitor.last_traffic(slave);
            if last_traffic.is_whole() || Instant::now() >= until {
                return last_traffic;
            }
            sleep(LISTEN_TIME).await;
        }
    }

    /// Last traffic of a slave and its master.
    pub fn last_traffic(&self, slave: Mac) -> LastTraffic {
        self.owner.inner.lock().monitor.last_traffic(slave)
    }

    /// Current time on the clock of [`LastTraffic`].
    pub fn now(&self) -> Now {
        self.owner.inner.now()
    }

    /// Waits until the counter of bus events differs from `seen`, and updates `seen`. Returns at once if the counter
    /// already differs.
    pub async fn changed(&self, seen: &mut u64) {
        let mut news = self.owner.inner.news.subscribe();
        // `self` keeps the sender alive, so this wait cannot fail.
        let now = news.wait_for(|count| count != seen).await.map_or(*seen, |count| *count);
        *seen = now;
    }

    /// Current failure of the adapter.
    pub fn last_error(&self) -> Option<Error> {
        self.owner.inner.lock().last_error.clone()
    }

    /// Health of the adapter, and the number of frames received.
    pub fn health(&self) -> (Health, u64) {
        let state = self.owner.inner.lock();
        (state.health, state.frames)
    }
}

const ONLY_LISTENS: &str = "the adapter only listens";

/// An open connection. A dropped connection is closed, unless the process ends before that.
#[derive(Debug)]
pub struct Connection {
    network: Network,
    number: u64,
    /// Its states: the current one, and those that follow.
    pub views: Views,
}

impl Connection {
    /// Sends this image, starting with the next poll; see [`Scanner::set_image`].
    ///
    /// # Errors
    /// The connection is not open in this generation, or the image has another size.
    pub fn set_image(&self, generation: u32, image: &[u8]) -> Result<u64, Error> {
        let changed = self.with(|scanner, _| scanner.set_image(self.number, generation, image));
        changed.unwrap_or(Err(Error::Ended))
    }

    /// Sends an explicit request. A refusal is returned as an answer.
    pub async fn ask(&self, request: Request) -> Result<Answer, Error> {
        let inner = &self.network.owner.inner;
        let token = Token(inner.last.fetch_add(1, Ordering::Relaxed));
        let (sender, answer) = oneshot::channel();
        inner.lock().pending_requests.insert(token, sender);
        self.with(|scanner, _| scanner.ask(self.number, token, request));
        answer.await.unwrap_or(Err(Error::Ended))
    }

    /// Closes the connection, and releases the connections of the slave.
    ///
    /// # Errors
    /// The slave did not confirm the release.
    pub async fn close(mut self) -> Result<(), Error> {
        let before = self.views.now().last_error;
        self.with(|scanner, now| scanner.close(now, self.number));
        self.views.closed(before.as_ref()).await
    }

    /// The adapter that the connection uses.
    pub const fn network(&self) -> &Network {
        &self.network
    }

    fn with<T>(&self, change: impl FnOnce(&mut Scanner, Now) -> T) -> Option<T> {
        let inner = &self.network.owner.inner;
        let now = inner.now();
        let result = inner.lock().scanner.as_mut().map(|scanner| change(scanner, now));
        inner.wake.notify_one();
        result
    }
}

impl Drop for Connection {
    fn drop(&mut self) {
        self.with(|scanner, now| scanner.close(now, self.number));
    }
}

impl Drop for Owner {
    fn drop(&mut self) {
        self.inner.lock().is_over = true;
        self.inner.wake.notify_one();
        // The drop waits for the thread, which first releases open connections. If the drop runs on this thread itself,
        // it must not wait.
        if let Some(thread) = self.thread.take().filter(|thread| thread.thread().id() != thread::current().id()) {
            let _ = thread.join();
        }
    }
}

impl Inner {
    fn now(&self) -> Now {
        self.start.elapsed()
    }

    fn lock(&self) -> MutexGuard<'_, SharedState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl SharedState {
    /// Publishes changed views and delivers answers.
    fn publish(&mut self) {
        let Some(scanner) = &mut self.scanner else { return };
        for number in scanner.changed() {
            if let (Some(view), Some(views)) = (scanner.view(number), self.views.get(&number)) {
                views.send_replace(view.clone());
            }
        }
        while let Some(Reply { token, result, .. }) = scanner.reply() {
            if let Some(answer) = self.pending_requests.remove(&token) {
                // An error means that the caller no longer waits for the answer.
                let _ = answer.send(result);
            }
        }
        if let Some(found) = scanner.found()
            && let Some(sender) = self.found.take()
        {
            let _ = sender.send(found);
        }
        if scanner.failure().is_some() {
            self.last_error = scanner.failure().cloned();
            self.found = None;
        }
        for number in scanner.clear() {
            self.views.remove(&number);
        }
    }

    fn is_finished(&self) -> bool {
        self.is_over && self.scanner.as_ref().is_none_or(Scanner::is_idle)
    }
}

/// Passes a frame to all taps.
fn pass(taps: &[Tap], frame: &Frame) {
    for tap in taps {
        tap.pass(|| TrafficRecord::Frame(frame.to_capture()));
    }
}

/// Body of the thread. Opens the adapter. After a loss, opens the adapter again if connections wait for it.
async fn run(inner: Arc<Inner>, opened: oneshot::Sender<Result<(), Error>>) {
    let tap = inner.lock().taps.first().cloned().unwrap_or_default();
    let mut port = match open(&inner.adapter, tap).await {
        Ok(port) => port,
        Err(error) => {
            // An error means that the caller no longer waits for the result.
            let _ = opened.send(Err(Error::Port(error)));
            return;
        }
    };
    let _ = opened.send(Ok(()));
    loop {
        let Err(error) = exchange(&inner, port.as_mut()).await else {
            drop(port);
            sleep(CLOSE_DELAY).await;
            return;
        };
        {
            let now = inner.now();
            let mut state = inner.lock();
            state.last_error = Some(Error::Port(error.clone()));
            state.monitor = Monitor::default();
            if let Some(scanner) = &mut state.scanner {
                scanner.fail(now, &Error::Port(error));
            }
            state.publish();
        }
        inner.news.send_modify(|count| *count += 1);
        drop(port);
        port = loop {
            if inner.lock().is_over {
                return;
            }
            let _ = timeout(REOPEN_INTERVAL, inner.wake.notified()).await;
            sleep(REOPEN_INTERVAL / 4).await;
            inner.lock().publish();
            if let Ok(port) = open(&inner.adapter, Tap::default()).await {
                break port;
            }
        };
        let mut state = inner.lock();
        state.last_error = None;
        if let Some(scanner) = &mut state.scanner {
            scanner.restart();
        }
    }
}

/// Transfers frames between master and adapter until the network is closed or the adapter fails.
async fn exchange(inner: &Inner, port: &mut dyn CanPort) -> Result<(), PortError> {
    loop {
        let wake = {
            let now = inner.now();
            let mut state = inner.lock();
            state.health = port.health();
            let SharedState { scanner, taps, .. } = &mut *state;
            if let Some(scanner) = scanner {
                scanner.handle_health(now, port.health());
                while let Some(frame) = scanner.poll(now) {
                    // The frame is recorded before it is sent. Otherwise, a trace could show the answer before the
                    // request.
                    pass(taps, &frame);
                    port.send(&frame)?;
                }
            }
            let wake = scanner.as_ref().and_then(Scanner::wake);
            state.publish();
            if state.is_finished() {
                return Ok(());
            }
            wake
        };
        let heard = tokio::select! {
            heard = port.next() => Some(heard?),
            () = async {
                match wake {
                    Some(wake) => sleep_until(inner.start + wake).await,
                    None => std::future::pending().await,
                }
            } => None,
            () = inner.wake.notified() => None,
        };
        let Some(heard) = heard else { continue };
        let now = inner.now();
        {
            let mut state = inner.lock();
            let SharedState { scanner, monitor, taps, frames, .. } = &mut *state;
            match heard {
                PortEvent::Frame(frame) => {
                    *frames += 1;
                    pass(taps, &frame);
                    monitor.handle_frame(now, &frame);
                    if let Some(scanner) = scanner {
                        scanner.handle(now, &frame);
                    }
                }
                // Nothing to do here: the loop reads the health again in every pass.
                PortEvent::Health(_) => {}
            }
        }
        inner.news.send_modify(|count| *count += 1);
    }
}

/// Opens an adapter. `tap` records the setup of the adapter.
async fn open(adapter: &Adapter, tap: Tap) -> Result<Box<dyn CanPort>, PortError> {
    let listens = adapter.identity.is_none();
    let name = adapter.place.to_string();
    let failed = |why: String, advice: &'static str| PortError::Open { path: name.clone(), why, advice: advice.into() };
    let pipe = match &adapter.place {
        AdapterLocation::Serial { path, baud } => {
            let line = Line {
                path: path.clone(),
                baud: *baud,
                data_bits: DataBits::Eight,
                parity: Parity::None,
                stop_bits: StopBits::One,
            };
            let port = serial::open(&line, serial::MAX_BAUD_DEVIATION)
                .map_err(|error| failed(error.to_string(), serial_advice(&error)))?;
            Pipe::serial(port).map_err(|error| failed(error.to_string(), "plug the adapter in again"))?
        }
        AdapterLocation::Tcp { host, port } => {
            let advice = "check host and port, and that the SLCAN server runs";
            let connected = timeout(CONNECT, TcpStream::connect((host.as_str(), *port))).await;
            let stream = connected.map_err(|_| failed("no answer".to_owned(), advice))?;
            let stream = stream.map_err(|error| match error.kind() {
                std::io::ErrorKind::ConnectionRefused => failed("no program listens on this port".to_owned(), advice),
                _ => failed(error.to_string(), advice),
            })?;
            Pipe::tcp(stream).map_err(|error| failed(error.to_string(), advice))?
        }
        AdapterLocation::SocketCan(interface) => return socket_can(interface),
    };
    Ok(Box::new(SlcanPort::start(name, pipe, adapter.bitrate, listens, tap).await?))
}

#[cfg(target_os = "linux")]
fn socket_can(interface: &str) -> Result<Box<dyn CanPort>, PortError> {
    Ok(Box::new(super::can::socketcan::SocketCan::open(interface)?))
}

#[cfg(not(target_os = "linux"))]
fn socket_can(interface: &str) -> Result<Box<dyn CanPort>, PortError> {
    let why = "only Linux has CAN interfaces".to_owned();
    Err(PortError::Open { path: interface.to_owned(), why, advice: "use an SLCAN adapter: slcan://".into() })
}

const fn serial_advice(error: &serial::OpenError) -> &'static str {
    match error {
        serial::OpenError::Absent => "plug the adapter in, and check the name of its port: `armctl robots discover`",
        serial::OpenError::Busy => "end the other program, or use the session of the robot",
        serial::OpenError::Forbidden => serial::OpenError::PERMISSION,
        _ => "check the port and its baud rate",
    }
}

//! Virtual CAN bus behind SLCAN adapters, for tests and simulators. Each client (TCP or pseudo-terminal) gets its own
//! adapter. A frame of one client goes to all other clients. A simulated slave can also be on the bus.

use std::collections::BTreeMap;
use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use tokio::net::TcpListener;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::{Notify, oneshot};
use tokio::time::{Instant, sleep, sleep_until};

use super::Now;
use super::can::pipe::{Pipe, Writer};
use super::can::slcan::{BELL, CR, Command, Line, Lines, emit, flag};
use super::can::{Bitrate, Frame};
use super::device::{Application, Device, DeviceFault};
use crate::fault::Faults;
use crate::pty::Pty;

/// Maximum number of bytes that wait for a client. Further frames for this client are lost, as in the full queue of a
/// real adapter.
const MAX_QUEUED_BYTES: usize = 64 * 1024;
/// Maximum number of clients. Further clients are disconnected at once.
const MAX_CLIENTS: usize = 64;
/// Maximum number of frames that fault injection delays at the same time.
const MAX_DELAYED: usize = 1024;
/// Pause after a failed accept.
const PAUSE: Duration = Duration::from_millis(50);
const BUFFER: usize = 4096;

/// Endpoint of a hub.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Listen {
    /// TCP. With port 0, the system selects a port.
    Tcp(SocketAddr),
    /// A pseudo-terminal.
    Pty,
}

/// A running hub. It stops when it is dropped.
pub struct Hub<A: Application + 'static> {
    inner: Arc<Inner<A>>,
    /// Addresses of the endpoints in the order of `listen`, for example `127.0.0.1:40000` or `/dev/pts/4`.
    pub endpoint_addresses: Vec<String>,
    quit: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

impl<A: Application + 'static> fmt::Debug for Hub<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Hub {:?}", self.endpoint_addresses)
    }
}

struct Inner<A> {
    start: Instant,
    bitrate: Bitrate,
    wake: Notify,
    state: Mutex<SharedState<A>>,
}

struct SharedState<A> {
    device: Option<Device<A>>,
    clients: BTreeMap<u64, Client>,
    last: u64,
    /// Faults to inject: first for frames to the slave, then for frames from the slave.
    faults: Option<(Faults, Faults)>,
    /// Frames that fault injection delays: due time, whether the frame goes to the slave, frame.
    delayed: Vec<(Now, bool, Frame)>,
}

/// A connected adapter.
#[derive(Debug)]
struct Client {
    writer: Writer,
    mode: Mode,
    bitrate: Option<u8>,
    with_times: bool,
    flags: u8,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Mode {
    Closed,
    Open,
    Listening,
}

impl<A: Application + 'static> Hub<A> {
    /// Starts a hub, with or without a slave. `faults` apply to frames to and from the slave.
    pub fn start(
        bitrate: Bitrate,
        device: Option<Device<A>>,
        listen: &[Listen],
        faults: Option<(Faults, Faults)>,
    ) -> io::Result<Self> {
        let runtime = Builder::new_current_thread().enable_all().build()?;
        let state = SharedState { device, clients: BTreeMap::new(), last: 0, faults, delayed: Vec::new() };
        let inner = Arc::new(Inner { start: Instant::now(), bitrate, wake: Notify::new(), state: Mutex::new(state) });
        let mut endpoint_addresses = Vec::new();
        for listen in listen {
            endpoint_addresses.push(serve(&runtime, &inner, *listen)?);
        }
        let (quit, quits) = oneshot::channel::<()>();
        let shared = Arc::clone(&inner);
        let work = move || {
            runtime.block_on(async {
                tokio::select! {
                    () = run_slave(&shared) => {}
                    // An error means that the hub was dropped. The thread must then end too.
                    _ = quits => {}
                }
            });
        };
        let thread = thread::Builder::new().name("slcan-hub".to_owned()).spawn(work)?;
        Ok(Self { inner, endpoint_addresses, quit: Some(quit), thread: Some(thread) })
    }

    /// Changes the faults for frames to the slave and from the slave.
    pub fn set_faults(&self, faults: Option<(Faults, Faults)>) {
        self.inner.lock().faults = faults;
    }

    /// Calls `look` with the slave and the current time, and returns its result. Returns `None` if the hub has no
    /// slave.
    pub fn with<T>(&self, look: impl FnOnce(&mut Device<A>, Now) -> T) -> Option<T> {
        let now = self.inner.start.elapsed();
        let result = self.inner.lock().device.as_mut().map(|device| look(device, now));
        self.inner.wake.notify_one();
        result
    }
}

impl<A: Application + 'static> Drop for Hub<A> {
    fn drop(&mut self) {
        self.quit = None;
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed.
            let _ = thread.join();
        }
    }
}

impl<A> Inner<A> {
    fn lock(&self) -> MutexGuard<'_, SharedState<A>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Opens an endpoint and accepts clients.
fn serve<A: Application + 'static>(runtime: &Runtime, inner: &Arc<Inner<A>>, listen: Listen) -> io::Result<String> {
    let inner = Arc::clone(inner);
    match listen {
        Listen::Tcp(address) => {
            let listener = std::net::TcpListener::bind(address)?;
            listener.set_nonblocking(true)?;
            let place = listener.local_addr()?.to_string();
            let listener = {
                let _here = runtime.enter();
                TcpListener::from_std(listener)?
            };
            runtime.spawn(accept(inner, listener));
            Ok(place)
        }
        Listen::Pty => {
            let (pty, path) = Pty::open()?;
            runtime.spawn(terminal(inner, pty));
            Ok(path)
        }
    }
}

async fn accept<A: Application + 'static>(inner: Arc<Inner<A>>, listener: TcpListener) {
    loop {
        let Ok((stream, _)) = listener.accept().await else {
            sleep(PAUSE).await;
            continue;
        };
        if inner.lock().clients.len() >= MAX_CLIENTS {
            continue;
        }
        // The client may already have disconnected.
        let Ok(mut pipe) = Pipe::tcp(stream) else { continue };
        let inner = Arc::clone(&inner);
        tokio::spawn(async move {
            let number = inner.join(pipe.writer.clone());
            let mut lines = Lines::default();
            while let Ok(bytes) = pipe.read().await {
                inner.take(number, &mut lines, &bytes);
            }
            inner.lock().clients.remove(&number);
        });
    }
}

async fn terminal<A: Application + 'static>(inner: Arc<Inner<A>>, mut pty: Pty) {
    let (writer, mut outgoing) = Writer::queue();
    let number = inner.join(writer.clone());
    let mut lines = Lines::default();
    let mut buffer = vec![0; BUFFER];
    loop {
        tokio::select! {
            read = pty.read(&mut buffer) => match read {
                Ok(len) => inner.take(number, &mut lines, buffer.get(..len).unwrap_or_default()),
                Err(_) => break,
            },
            bytes = outgoing.recv() => match bytes {
                Some(bytes) => {
                    writer.written(bytes.len());
                    if pty.write(&bytes).is_err() {
                        break;
                    }
                }
                None => break,
            },
        }
    }
    inner.lock().clients.remove(&number);
}

/// Runs the slave until its next event.
async fn run_slave<A: Application>(inner: &Inner<A>) {
    loop {
        let wake = inner.lock().advance(inner.start.elapsed());
        tokio::select! {
            () = inner.wake.notified() => {}
            () = async {
                match wake {
                    Some(wake) => sleep_until(inner.start + wake).await,
                    None => std::future::pending().await,
                }
            } => {}
        }
    }
}

impl<A: Application> Inner<A> {
    fn join(&self, writer: Writer) -> u64 {
        let mut state = self.lock();
        state.last += 1;
        let number = state.last;
        let client = Client { writer, mode: Mode::Closed, bitrate: None, with_times: false, flags: 0 };
        state.clients.insert(number, client);
        number
    }

    /// Handles bytes from a client.
    fn take(&self, number: u64, lines: &mut Lines, bytes: &[u8]) {
        let now = self.start.elapsed();
        let mut state = self.lock();
        for line in bytes.iter().filter_map(|byte| lines.push(*byte)) {
            let answer = state.command(now, number, &line, self.bitrate);
            if let Some(client) = state.clients.get(&number) {
                client.writer.write(&answer);
            }
        }
        drop(state);
        self.wake.notify_one();
    }
}

impl<A: Application> SharedState<A> {
    /// Executes a line from a client, and returns the answer.
    fn command(&mut self, now: Now, number: u64, line: &Line, bitrate: Bitrate) -> Vec<u8> {
        let is_off = self.device.as_ref().is_some_and(|device| device.fault == Some(DeviceFault::BusOff));
        let is_alone =
            self.device.is_none() && self.clients.values().filter(|client| client.mode == Mode::Open).count() < 2;
        let Some(client) = self.clients.get_mut(&number) else { return Vec::new() };
        let (yes, no) = (vec![CR], vec![BELL]);
        let is_right = client.bitrate == Some(digit(bitrate));
        match line.command() {
            Command::Empty => yes,
            Command::Close => {
                client.mode = Mode::Closed;
                yes
            }
            Command::Bitrate(digit) if client.mode == Mode::Closed => {
                client.bitrate = Some(digit);
                yes
            }
            Command::Open | Command::Listen if client.mode == Mode::Closed && client.bitrate.is_some() => {
                client.mode = if line.command() == Command::Open { Mode::Open } else { Mode::Listening };
                yes
            }
            Command::Timestamps(with_times) if client.mode == Mode::Closed => {
                client.with_times = with_times;
                yes
            }
            Command::Setting if client.mode == Mode::Closed => yes,
            Command::Version => b"V1013\r".to_vec(),
            Command::Number => b"NA123\r".to_vec(),
            Command::Flags if client.mode != Mode::Closed => {
                let flags = match (is_off, is_right && !is_alone) {
                    (true, _) => flag::BUS_ERROR | flag::PASSIVE | flag::WARNING,
                    // No other node is on the bus to acknowledge the frames of this client.
                    (_, false) if client.mode == Mode::Open => flag::BUS_ERROR | flag::PASSIVE,
                    _ => 0,
                };
                let flags = flags | std::mem::take(&mut client.flags);
                format!("F{flags:02X}\r").into_bytes()
            }
            Command::Send(_) | Command::SendOther { .. } if client.mode != Mode::Open || is_off => no,
            Command::SendOther { is_extended } => {
                if is_extended {
                    b"Z\r".to_vec()
                } else {
                    b"z\r".to_vec()
                }
            }
            Command::Send(frame) => {
                if is_right {
                    self.broadcast(Some(number), &frame, bitrate);
                    self.deliver(now, frame);
                }
                b"z\r".to_vec()
            }
            _ => no,
        }
    }

    /// Sends a frame to all clients with an open channel, except the sender of the frame.
    fn broadcast(&mut self, from: Option<u64>, frame: &Frame, bitrate: Bitrate) {
        for (number, client) in &mut self.clients {
            if Some(*number) == from || client.mode == Mode::Closed || client.bitrate != Some(digit(bitrate)) {
                continue;
            }
            if client.writer.waiting() > MAX_QUEUED_BYTES {
                client.flags |= flag::OVERRUN;
                continue;
            }
            let mut line = emit(frame);
            if client.with_times {
                line.pop();
                line.extend(b"0000\r");
            }
            client.writer.write(&line);
        }
    }

    fn deliver(&mut self, now: Now, frame: Frame) {
        match &mut self.faults {
            None => {
                if let Some(device) = &mut self.device {
                    device.handle(now, &frame);
                }
            }
            Some((to, _)) => {
                let passed = to.pass(now, &frame.to_capture());
                let frames = passed.iter().filter_map(|(at, bytes)| Some((*at, true, Frame::from_capture(bytes)?)));
                self.delayed.extend(frames);
                self.delayed.truncate(MAX_DELAYED);
            }
        }
    }

    /// Executes the work that is due. Returns the time at which it must be called again.
    fn advance(&mut self, now: Now) -> Option<Now> {
        let due: Vec<(Now, bool, Frame)> = self.delayed.extract_if(.., |(at, ..)| *at <= now).collect();
        let is_off = self.device.as_ref().is_some_and(|device| device.fault == Some(DeviceFault::BusOff));
        let bitrate = self.device.as_ref().map(|device| device.setup.bitrate)?;
        for (_, to_device, frame) in due {
            match &mut self.device {
                Some(device) if to_device => device.handle(now, &frame),
                _ => self.broadcast(None, &frame, bitrate),
            }
        }
        while let Some(frame) = self.device.as_mut().and_then(|device| device.poll(now)) {
            match &mut self.faults {
                _ if is_off => {}
                None => self.broadcast(None, &frame, bitrate),
                Some((_, from)) => {
                    let passed = from.pass(now, &frame.to_capture());
                    let frames =
                        passed.iter().filter_map(|(at, bytes)| Some((*at, false, Frame::from_capture(bytes)?)));
                    self.delayed.extend(frames);
                }
            }
        }
        let delayed = self.delayed.iter().map(|(at, ..)| *at);
        delayed.chain(self.device.as_ref().and_then(Device::wake)).min()
    }
}

/// Digit of the SLCAN command that selects this bit rate.
const fn digit(bitrate: Bitrate) -> u8 {
    match bitrate {
        Bitrate::K125 => 4,
        Bitrate::K250 => 5,
        Bitrate::K500 => 6,
    }
}

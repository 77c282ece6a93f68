//! A device on a real interface: its frames, its calls, its clock, in a thread.

use std::fmt;
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::{SocketAddr, SocketAddrV4, UdpSocket};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use socket2::Socket;

use super::super::Now;
use super::super::controller::Action;
use super::super::error::ProfinetError;
use super::super::interface::Interface;
use super::super::wire::frame::ETHER_TYPE;
use super::super::wire::rpc;
use super::{Application, Device, Setup};

/// Frames or datagrams taken at once before the clock is looked at.
const AT_ONCE: usize = 64;
/// Room for the longest datagram.
const BUFFER: usize = 65_536;

/// A device that answers on an interface until it is dropped. On a real card it hears requests to all only if the card
/// lets them through: `ip maddress add 01:0e:cf:00:00:00 dev IFACE`.
pub struct Server<A> {
    inner: Arc<Inner<A>>,
    thread: Option<JoinHandle<()>>,
}

struct Inner<A> {
    start: Instant,
    raw: Socket,
    udp: UdpSocket,
    bell: UnixStream,
    device: Mutex<Device<A>>,
    is_over: AtomicBool,
}

impl<A> fmt::Debug for Server<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Server").finish_non_exhaustive()
    }
}

impl<A: Application + Send + 'static> Server<A> {
    /// Starts a device with the card and the address of an interface, whatever `setup` says of them; it takes no other
    /// address, as that is the operator's to set.
    ///
    /// # Errors
    /// When the interface cannot be used, or its sockets cannot be had.
    pub fn start(interface: &Interface, setup: Setup, application: A) -> Result<Self, ProfinetError> {
        let raw = interface.raw_socket(ETHER_TYPE)?;
        interface.check()?;
        let ip = interface.address()?;
        let failed = |error: &std::io::Error| ProfinetError::local("UDP socket for calls", error);
        let udp = UdpSocket::bind((ip.address, rpc::PORT)).map_err(|error| match error.kind() {
            ErrorKind::AddrInUse => ProfinetError::PortTaken { address: ip.address },
            _ => failed(&error),
        })?;
        udp.set_nonblocking(true).map_err(|error| failed(&error))?;
        let (bell, heard) = UnixStream::pair().map_err(|error| failed(&error))?;
        for end in [&bell, &heard] {
            end.set_nonblocking(true).map_err(|error| failed(&error))?;
        }
        let setup = Setup { mac: interface.mac, ip: Some(ip), takes_ip: false, ..setup };
        let inner = Arc::new(Inner {
            start: Instant::now(),
            raw,
            udp,
            bell,
            device: Mutex::new(Device::new(setup, application)),
            is_over: AtomicBool::new(false),
        });
        let runs = Arc::clone(&inner);
        let thread = std::thread::Builder::new().name("profinet-device".to_owned());
        let thread = thread.spawn(move || runs.run(heard)).map_err(|error| failed(&error))?;
        Ok(Self { inner, thread: Some(thread) })
    }

    /// Does something with the device, and what follows from it.
    pub fn with<T>(&self, change: impl FnOnce(&mut Device<A>, Now) -> T) -> T {
        let result = change(&mut self.inner.device(), self.inner.start.elapsed());
        self.inner.ring();
        result
    }
}

impl<A> Drop for Server<A> {
    fn drop(&mut self) {
        self.inner.is_over.store(true, Ordering::SeqCst);
        self.inner.ring();
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has said so already.
            let _ = thread.join();
        }
    }
}

impl<A> Inner<A> {
    fn ring(&self) {
        // Where the buffer is full it is awake.
        let _ = (&self.bell).write(&[0]);
    }

    fn device(&self) -> std::sync::MutexGuard<'_, Device<A>> {
        self.device.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<A: Application> Inner<A> {
    fn run(&self, mut bell: UnixStream) {
        let mut buffer = vec![0; BUFFER];
        while !self.is_over.load(Ordering::SeqCst) {
            let wait = self.turn().map(|next| next.saturating_sub(self.start.elapsed()));
            let wait = wait.map(|wait| Timespec::try_from(wait).unwrap_or(Timespec { tv_sec: 1, tv_nsec: 0 }));
            let mut sources = [
                PollFd::new(&self.raw, PollFlags::IN),
                PollFd::new(&self.udp, PollFlags::IN),
                PollFd::new(&bell, PollFlags::IN),
            ];
            if poll(&mut sources, wait.as_ref()).is_err_and(|error| error != rustix::io::Errno::INTR) {
                // Nothing else would slow it down.
                std::thread::park_timeout(Duration::from_millis(1));
            }
            while bell.read(&mut buffer).is_ok_and(|read| read > 0) {}
            self.hear(&mut buffer);
        }
    }

    fn turn(&self) -> Option<Now> {
        let mut device = self.device();
        while let Some(action) = device.poll(self.start.elapsed()) {
            // What cannot be sent is lost, as on any cable.
            let _ = match action {
                Action::Frame(bytes) => (&self.raw).write(&bytes),
                Action::Datagram(to, bytes) => self.udp.send_to(&bytes, to),
            };
        }
        device.wake()
    }

    fn hear(&self, buffer: &mut [u8]) {
        for _ in 0..AT_ONCE {
            let Ok(length) = (&self.raw).read(buffer) else { break };
            self.device().frame(self.start.elapsed(), &buffer[..length]);
        }
        for _ in 0..AT_ONCE {
            let (length, from): (usize, SocketAddrV4) = match self.udp.recv_from(buffer) {
                Ok((length, SocketAddr::V4(from))) => (length, from),
                Ok(_) => continue,
                Err(error) if error.kind() == ErrorKind::ConnectionRefused => continue,
                Err(_) => break,
            };
            self.device().datagram(self.start.elapsed(), from, &buffer[..length]);
        }
    }
}

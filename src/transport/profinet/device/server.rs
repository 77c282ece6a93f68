//! Driver that runs a device on a network interface, on its own thread.

use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use super::super::Now;
use super::super::controller::Action;
use super::super::error::ProfinetError;
use super::super::interface::Interface;
use super::super::sockets::{BUFFER, Sockets};
use super::{Application, Device, Setup};
use crate::local_error::LocalError;

/// A device that runs until it is dropped. On a real network card, the interface must accept the multicast address: `ip
/// maddress add 01:0e:cf:00:00:00 dev IFACE`.
pub struct Server<A> {
    inner: Arc<Inner<A>>,
    thread: Option<JoinHandle<()>>,
}

struct Inner<A> {
    start: Instant,
    sockets: Sockets,
    device: Mutex<Device<A>>,
    is_over: AtomicBool,
}

impl<A> fmt::Debug for Server<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Server").finish_non_exhaustive()
    }
}

impl<A: Application + Send + 'static> Server<A> {
    /// Starts a device. The device has the MAC and IP address of the interface, and not the addresses in `setup`. DCP
    /// cannot change the IP address, because it belongs to this computer.
    pub fn start(interface: &Interface, setup: Setup, application: A) -> Result<Self, ProfinetError> {
        let (sockets, ip) = Sockets::open(interface)?;
        let setup = Setup { mac: interface.mac, ip: Some(ip), takes_ip: false, ..setup };
        let inner = Arc::new(Inner {
            start: Instant::now(),
            sockets,
            device: Mutex::new(Device::new(setup, application)),
            is_over: AtomicBool::new(false),
        });
        let runs = Arc::clone(&inner);
        let thread = std::thread::Builder::new().name("profinet-device".to_owned());
        let thread = thread
            .spawn(move || runs.run())
            .map_err(|error| LocalError::new("cannot start the thread of the device", &error))?;
        Ok(Self { inner, thread: Some(thread) })
    }

    /// Calls `change` with the device, then executes the actions that result.
    pub fn with<T>(&self, change: impl FnOnce(&mut Device<A>, Now) -> T) -> T {
        let result = change(&mut self.inner.device(), self.inner.start.elapsed());
        self.inner.sockets.wake_up();
        result
    }
}

impl<A> Drop for Server<A> {
    fn drop(&mut self) {
        self.inner.is_over.store(true, Ordering::SeqCst);
        self.inner.sockets.wake_up();
        if let Some(thread) = self.thread.take() {
            // An error means that the thread panicked. The panic was already printed.
            let _ = thread.join();
        }
    }
}

impl<A> Inner<A> {
    fn device(&self) -> std::sync::MutexGuard<'_, Device<A>> {
        self.device.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<A: Application> Inner<A> {
    fn run(&self) {
        let mut buffer = vec![0; BUFFER];
        while !self.is_over.load(Ordering::SeqCst) {
            self.sockets.wait(self.turn().map(|next| next.saturating_sub(self.start.elapsed())));
            self.sockets.hear(
                &mut buffer,
                |bytes| self.device().frame(self.start.elapsed(), bytes),
                |from, bytes| self.device().datagram(self.start.elapsed(), from, bytes),
            );
        }
    }

    fn turn(&self) -> Option<Now> {
        let mut device = self.device();
        while let Some(action) = device.poll(self.start.elapsed()) {
            // An error is ignored: a frame that cannot be sent is lost, as on a real cable.
            let _ = match action {
                Action::Frame(bytes) => self.sockets.send_frame(&bytes),
                Action::Datagram(to, bytes) => self.sockets.send_datagram(to, &bytes),
            };
        }
        device.wake()
    }
}

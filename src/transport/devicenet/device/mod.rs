//! Simulated DeviceNet slave (group 2 only server) with the objects of the predefined master/slave connection set. The
//! slave has no sockets and no clock. It is stricter than real devices. It shares no decoder with the master, so that
//! an error in a decoder is noticed.

use std::collections::VecDeque;
use std::fmt;
use std::time::Duration;

use super::Now;
use super::can::{Bitrate, Frame};
use super::wire::{DuplicateCheck, Id, Mac};

mod allocation;
mod fault;
mod messages;
mod objects;
mod polled;

use self::allocation::Allocation;
pub use self::fault::DeviceFault;
use self::messages::Messages;
use self::polled::Polled;

/// Interval of the duplicate MAC checks.
const CHECK: Duration = Duration::from_secs(1);

/// Configuration of a slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setup {
    /// MAC of the slave.
    pub mac: Mac,
    /// Bit rate of the bus.
    pub bitrate: Bitrate,
    /// Vendor id.
    pub vendor: u16,
    /// Device type.
    pub device_type: u16,
    /// Product code.
    pub product: u16,
    /// Major and minor revision.
    pub revision: (u8, u8),
    /// Serial number.
    pub serial: u32,
    /// Product name, at most 255 characters.
    pub name: String,
    /// Size of the images in bytes, the same in both directions.
    pub size: u16,
}

impl Setup {
    /// Returns the configuration of a slave with the identity of an older YAMAHA controller. The identity is from the
    /// EDS file of that controller.
    pub fn sample_controller(mac: Mac, bitrate: Bitrate, size: u16) -> Self {
        Self {
            mac,
            bitrate,
            vendor: 636,
            device_type: 0,
            product: 1,
            revision: (1, 1),
            serial: 1,
            name: "YRCX simulator of armctl".to_owned(),
            size,
        }
    }
}

/// Application behind the slave.
pub trait Application: Send {
    /// Receives a new image from the master.
    fn image_out(&mut self, now: Now, image: &[u8]);
    /// Updates the image to the master. The buffer contains the previous image.
    fn image_in(&mut self, now: Now, image: &mut [u8]);
    /// Handles the end of the poll connection. Either the master released the connection, or it timed out.
    fn on_master_lost(&mut self, now: Now);
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// The slave checks its MAC. Contains the number of checks that were sent, and the time of the next step.
    Checking(u8, Now),
    OnLine,
    /// Another node has the MAC of this slave, so the slave stays off line.
    Faulted,
}

/// A simulated slave.
pub struct Device<A> {
    /// The configuration.
    pub setup: Setup,
    /// The application.
    pub application: A,
    phase: Phase,
    allocation: Allocation,
    messages: Messages,
    polled: Option<Polled>,
    image_in: Vec<u8>,
    /// The active fault.
    pub fault: Option<DeviceFault>,
    outbox: VecDeque<Frame>,
    answers: u64,
}

impl<A> fmt::Debug for Device<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Device {} {:?} {:?}", self.setup.mac, self.phase, self.allocation)
    }
}

impl<A: Application> Device<A> {
    /// Creates a slave in its state after power-on. The slave checks its MAC before it goes on line.
    pub fn new(setup: Setup, application: A) -> Self {
        Self {
            image_in: vec![0; setup.size.into()],
            messages: Messages::new(setup.mac),
            setup,
            application,
            phase: Phase::Checking(0, Now::ZERO),
            allocation: Allocation::default(),
            polled: None,
            fault: None,
            outbox: VecDeque::new(),
            answers: 0,
        }
    }

    /// Creates a slave that is already on line.
    pub fn on_line(setup: Setup, application: A) -> Self {
        Self { phase: Phase::OnLine, ..Self::new(setup, application) }
    }

    /// Activates a fault; `None` deactivates the active fault.
    pub const fn set_fault(&mut self, fault: Option<DeviceFault>) {
        self.fault = fault;
    }

    /// Whether the slave is on line.
    pub fn is_on_line(&self) -> bool {
        self.phase == Phase::OnLine
    }

    /// The master that owns the connections of the slave.
    pub const fn master(&self) -> Option<Mac> {
        self.allocation.master()
    }

    /// Returns the next frame to send at `now`. The caller repeats the call until it returns `None`.
    pub fn poll(&mut self, now: Now) -> Option<Frame> {
        match self.phase {
            Phase::Checking(2, due) if now >= due => self.phase = Phase::OnLine,
            Phase::Checking(asked @ 0..2, due) if now >= due => {
                self.phase = Phase::Checking(asked + 1, now + CHECK);
                self.check(self.setup.mac, false);
            }
            _ => {}
        }
        self.expire(now);
        self.outbox.extend(self.messages.poll(now));
        if self.fault == Some(DeviceFault::Mute) {
            self.outbox.clear();
        }
        self.outbox.pop_front()
    }

    /// Latest time of the next call of [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        if !self.outbox.is_empty() {
            return Some(Now::ZERO);
        }
        let own = match self.phase {
            Phase::Checking(_, due) => Some(due),
            Phase::OnLine | Phase::Faulted => None,
        };
        let polled = self.polled.as_ref().and_then(Polled::until);
        [own, polled, self.explicit_until(), self.messages.wake()].into_iter().flatten().min()
    }

    /// Handles a frame from the bus.
    pub fn handle(&mut self, now: Now, frame: &Frame) {
        let mac = self.setup.mac;
        match Id::parse(frame.id()) {
            Some(Id::Duplicate(checked)) => self.checked(checked, frame.data()),
            _ if self.phase != Phase::OnLine => {}
            Some(Id::Unconnected(meant)) if meant == mac => self.request(now, frame.data(), false),
            Some(Id::Request(meant)) if meant == mac => self.request(now, frame.data(), true),
            Some(Id::Poll(meant)) if meant == mac => self.polled(now, frame.data()),
            _ => {}
        }
    }

    fn check(&mut self, mac: Mac, is_answer: bool) {
        let check = DuplicateCheck { is_answer, port: 0, vendor: self.setup.vendor, serial: self.setup.serial };
        self.outbox.extend(Frame::new(Id::Duplicate(mac).emit(), &check.emit()));
    }

    fn checked(&mut self, checked: Mac, bytes: &[u8]) {
        let Some(check) = DuplicateCheck::parse(bytes) else { return };
        if self.fault == Some(DeviceFault::DuplicateMac) && !check.is_answer {
            self.check(checked, true);
        }
        if checked != self.setup.mac {
            return;
        }
        match self.phase {
            Phase::Checking(..) => self.phase = Phase::Faulted,
            Phase::OnLine if !check.is_answer => self.check(checked, true),
            Phase::OnLine | Phase::Faulted => {}
        }
    }

    /// Closes connections that timed out.
    fn expire(&mut self, now: Now) {
        if let Some(polled) = &mut self.polled
            && polled.expire(now)
        {
            self.application.on_master_lost(now);
        }
        if self.explicit_until().is_some_and(|until| now >= until) {
            self.allocation.clear();
            self.messages.reset();
            self.forget_poll(now);
        }
    }

    /// Deadline of the explicit connection. While the poll connection is established, the explicit connection has no
    /// deadline.
    fn explicit_until(&self) -> Option<Now> {
        let is_polled = self.polled.as_ref().is_some_and(Polled::is_established);
        self.allocation.explicit_until().filter(|_| !is_polled)
    }

    /// Closes the poll connection.
    fn forget_poll(&mut self, now: Now) {
        if self.polled.take().is_some_and(|polled| polled.is_established()) {
            self.application.on_master_lost(now);
        }
    }
}

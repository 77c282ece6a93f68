//! The other end: a slave that knows group 2 only, with the objects of the predefined set. Without sockets and without a
//! clock. It is stricter than devices are, and reads what comes with code of its own.

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

/// Between the questions whether the MAC is free.
const CHECK: Duration = Duration::from_secs(1);

/// What a slave is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setup {
    /// Its MAC.
    pub mac: Mac,
    /// How fast its bus is.
    pub bitrate: Bitrate,
    /// Its maker.
    pub vendor: u16,
    /// The kind of device.
    pub device_type: u16,
    /// The product.
    pub product: u16,
    /// Major and minor revision.
    pub revision: (u8, u8),
    /// Its serial number.
    pub serial: u32,
    /// Its name, 255 characters at most.
    pub name: String,
    /// Bytes of its images, the same both ways.
    pub size: u16,
}

impl Setup {
    /// With the identity of an older controller of YAMAHA, as its EDS file has it.
    pub fn stand_in(mac: Mac, bitrate: Bitrate, size: u16) -> Self {
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

/// What a slave is for.
pub trait Application: Send {
    /// A new image from the master.
    fn image_out(&mut self, now: Now, image: &[u8]);
    /// Fills the image that goes to the master; it has the bytes of the last time.
    fn image_in(&mut self, now: Now, image: &mut [u8]);
    /// The master is gone: released it, or went silent.
    fn master_gone(&mut self, now: Now);
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Asked so often whether its MAC is free; the next step is due then.
    Checking(u8, Now),
    OnLine,
    /// Another node has its MAC.
    Faulted,
}

/// The slave.
pub struct Device<A> {
    setup: Setup,
    application: A,
    phase: Phase,
    allocation: Allocation,
    messages: Messages,
    polled: Option<Polled>,
    image_in: Vec<u8>,
    fault: Option<DeviceFault>,
    outbox: VecDeque<Frame>,
    answers: u64,
}

impl<A> fmt::Debug for Device<A> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Device {} {:?} {:?}", self.setup.mac, self.phase, self.allocation)
    }
}

impl<A: Application> Device<A> {
    /// One that is switched on, and goes on line once it has found its MAC to be free.
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

    /// One that has been on line for long.
    pub fn on_line(setup: Setup, application: A) -> Self {
        Self { phase: Phase::OnLine, ..Self::new(setup, application) }
    }

    /// What it is for.
    pub const fn application(&mut self) -> &mut A {
        &mut self.application
    }

    /// What it is.
    pub const fn setup(&self) -> &Setup {
        &self.setup
    }

    /// Makes it do something wrong from now on, or no longer.
    pub const fn misbehave(&mut self, fault: Option<DeviceFault>) {
        self.fault = fault;
    }

    /// What it does wrong.
    pub const fn fault(&self) -> Option<DeviceFault> {
        self.fault
    }

    /// Whether it is on line.
    pub fn is_on_line(&self) -> bool {
        self.phase == Phase::OnLine
    }

    /// Who has its connections.
    pub const fn master(&self) -> Option<Mac> {
        self.allocation.master()
    }

    /// A frame to send at `now`; call until there is none.
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
        if self.fault == Some(DeviceFault::Silence) {
            self.outbox.clear();
        }
        self.outbox.pop_front()
    }

    /// When to call again at the latest.
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

    /// A frame from the bus.
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

    /// Lets go of what was silent for too long.
    fn expire(&mut self, now: Now) {
        if let Some(polled) = &mut self.polled
            && polled.expire(now)
        {
            self.application.master_gone(now);
        }
        if self.explicit_until().is_some_and(|until| now >= until) {
            self.allocation.clear();
            self.messages.reset();
            self.forget_poll(now);
        }
    }

    /// The explicit connection goes with its master's silence, but not while polls come.
    fn explicit_until(&self) -> Option<Now> {
        let is_polled = self.polled.as_ref().is_some_and(Polled::is_established);
        self.allocation.explicit_until().filter(|_| !is_polled)
    }

    /// The poll connection is gone.
    fn forget_poll(&mut self, now: Now) {
        if self.polled.take().is_some_and(|polled| polled.is_established()) {
            self.application.master_gone(now);
        }
    }
}

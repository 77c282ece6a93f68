//! What stations are asked over: a network card, or a simulated device.

use std::collections::VecDeque;
use std::fmt;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

use super::Now;
use super::controller::{Action, Here};
use super::device::{Application, Device};
use super::error::ProfinetError;
use super::wire::dcp::IpSuite;
use super::wire::{Mac, arp, rpc};

/// Something that came.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Arrived {
    /// A frame.
    Frame(Vec<u8>),
    /// A datagram, and who sent it.
    Datagram(SocketAddrV4, Vec<u8>),
}

/// Ways to stations, and a clock.
pub trait Medium: fmt::Debug + Send {
    /// The card of this end, and its address if it has one.
    fn here(&self) -> (Mac, Option<IpSuite>);

    /// The time of its clock.
    fn now(&self) -> Now;

    /// Sends a frame.
    ///
    /// # Errors
    /// When the interface does not take it.
    fn send(&mut self, frame: &[u8]) -> Result<(), ProfinetError>;

    /// Sends a datagram to the port for calls of a station.
    ///
    /// # Errors
    /// Likewise.
    fn call(&mut self, to: Ipv4Addr, bytes: &[u8]) -> Result<(), ProfinetError>;

    /// What comes next, or `None` when this moment has come.
    ///
    /// # Errors
    /// When nothing can be heard.
    fn next(&mut self, until: Now) -> Result<Option<Arrived>, ProfinetError>;
}

/// A network of simulated devices, in virtual time.
#[derive(Debug)]
pub struct Simulated<A> {
    here: Here,
    now: Now,
    devices: Vec<Device<A>>,
    came: VecDeque<Arrived>,
}

impl<A: Application> Simulated<A> {
    /// A network of this end and these devices.
    pub fn new(here: Here, devices: Vec<Device<A>>) -> Self {
        Self { here, now: Duration::ZERO, devices, came: VecDeque::new() }
    }

    /// The devices.
    pub fn devices(&self) -> &[Device<A>] {
        &self.devices
    }

    fn follow(&mut self) {
        for device in &mut self.devices {
            while let Some(action) = device.poll(self.now) {
                self.came.push_back(match action {
                    Action::Frame(bytes) => Arrived::Frame(bytes),
                    Action::Datagram(_, bytes) => {
                        let from = address(device).unwrap_or(Ipv4Addr::UNSPECIFIED);
                        Arrived::Datagram(SocketAddrV4::new(from, rpc::PORT), bytes)
                    }
                });
            }
        }
    }
}

fn address<A: Application>(device: &Device<A>) -> Option<Ipv4Addr> {
    device.setup().ip.map(|suite| suite.address)
}

impl<A: Application + fmt::Debug + Send> Medium for Simulated<A> {
    fn here(&self) -> (Mac, Option<IpSuite>) {
        (self.here.mac, Some(self.here.ip))
    }

    fn now(&self) -> Now {
        self.now
    }

    fn send(&mut self, frame: &[u8]) -> Result<(), ProfinetError> {
        for device in &mut self.devices {
            device.frame(self.now, frame);
        }
        let mac = |device: &Device<A>| device.setup().mac;
        // What the system of each would answer.
        let asked = arp::question(frame);
        let holders = self.devices.iter().filter(|device| asked.is_some() && address(device) == asked);
        let answers = holders.zip(asked).map(|(device, asked)| Arrived::Frame(arp::answer(mac(device), self.here.mac, asked)));
        self.came.extend(answers);
        Ok(())
    }

    fn call(&mut self, to: Ipv4Addr, bytes: &[u8]) -> Result<(), ProfinetError> {
        let from = SocketAddrV4::new(self.here.ip.address, rpc::PORT);
        for device in self.devices.iter_mut().filter(|device| address(device) == Some(to)) {
            device.datagram(self.now, from, bytes);
        }
        Ok(())
    }

    fn next(&mut self, until: Now) -> Result<Option<Arrived>, ProfinetError> {
        loop {
            self.follow();
            if let Some(arrived) = self.came.pop_front() {
                return Ok(Some(arrived));
            }
            if self.now >= until {
                return Ok(None);
            }
            let wake = self.devices.iter().filter_map(Device::wake).min();
            self.now = wake.unwrap_or(until).clamp(self.now, until);
        }
    }
}

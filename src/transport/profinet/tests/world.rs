//! Test bench: a controller and a device on a network in virtual time, with fault injection.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use super::super::Now;
use super::super::controller::identifiers::Identifiers;
use super::super::controller::view::{State, View};
use super::super::controller::{Action, Controller, LocalAddress};
use super::super::device::{Application, Device, Event, Setup};
use super::super::layout::Layout;
use super::super::settings::{Settings, Station};
use super::super::wire::Mac;
use super::super::wire::dcp::IpSuite;
use super::super::wire::record::Im0;
use super::super::wire::rpc::{Datagram, Kind, PORT};
use crate::fault::{FaultSpec, Faults};

const MAX_HOLD_TIME: Duration = Duration::from_millis(120);
pub const MS: Duration = Duration::from_millis(1);
pub const OUR_ADDRESS: LocalAddress = LocalAddress { mac: Mac([2, 0, 0, 0, 0, 1]), ip: suite([192, 168, 78, 1]) };
pub const DEVICE_ADDRESS: Mac = Mac([2, 0, 0, 0, 0, 2]);
pub const ADDRESS: Ipv4Addr = Ipv4Addr::new(192, 168, 78, 2);

pub const fn suite(address: [u8; 4]) -> IpSuite {
    let [a, b, c, d] = address;
    let address = Ipv4Addr::new(a, b, c, d);
    IpSuite { address, mask: Ipv4Addr::new(255, 255, 255, 0), gateway: address }
}

/// Application that returns the received image with all bits inverted.
#[derive(Debug, Default)]
pub struct Mirror {
    pub image: Option<Vec<u8>>,
    /// Every new image, in order; `None` for an invalid image.
    pub history: Vec<Option<Vec<u8>>>,
    pub events: Vec<Event>,
}

impl Application for Mirror {
    fn image_out(&mut self, _: Now, image: Option<&[u8]>) {
        self.image = image.map(<[u8]>::to_vec);
        if self.history.last() != Some(&self.image) {
            self.history.push(self.image.clone());
        }
    }

    fn image_in(&mut self, _: Now, image: &mut [u8]) {
        for (at, byte) in image.iter_mut().enumerate() {
            *byte = !self.image.as_ref().and_then(|image| image.get(at)).copied().unwrap_or(0xFF);
        }
    }

    fn event(&mut self, _: Now, event: &Event) {
        self.events.push(event.clone());
    }
}

pub fn setup() -> Setup {
    Setup {
        mac: DEVICE_ADDRESS,
        name: "yrcx-sim".to_owned(),
        kind: "YRCX like".to_owned(),
        id: (0xFFFF, 1),
        instance: 1,
        ip: Some(suite([192, 168, 78, 2])),
        takes_ip: true,
        layout: Layout::two_modules(0x101, 0x102),
        shortest: 32,
        im0: Im0 { vendor: 0xFFFF, order_id: "RCX340".to_owned(), software: ('V', 1, 0, 0), ..Im0::default() },
    }
}

pub fn settings() -> Settings {
    let station = Station::Name("yrcx-sim".to_owned());
    Settings { resting: resting(), ..Settings::new(station, Layout::two_modules(0x101, 0x102)) }
}

/// Returns a resting image that is not all zeros.
pub fn resting() -> Vec<u8> {
    let mut image = vec![0; 48];
    image[32] = 0x41;
    image
}

pub fn native_order(image: &[u8]) -> Vec<u8> {
    image.iter().map(|byte| !byte).collect()
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Packet {
    FrameOut(Vec<u8>),
    FrameIn(Vec<u8>),
    CallOut(SocketAddrV4, Vec<u8>),
    CallIn(SocketAddrV4, Vec<u8>),
}

#[derive(Debug)]
pub struct World {
    pub now: Now,
    pub controller: Controller,
    pub device: Device<Mirror>,
    /// A second device in the same network, if the test needs one.
    pub twin: Option<Device<Mirror>>,
    /// Whether the cable is connected.
    pub cable: bool,
    /// Frames of the controller with their times.
    pub frames: Vec<(Now, Vec<u8>)>,
    /// Datagrams of the controller.
    pub calls: Vec<Vec<u8>>,
    /// Input images, in the order of arrival.
    pub shown: Vec<Arc<[u8]>>,
    /// All traffic as Ethernet frames, if recorded.
    pub record: Option<Vec<(Now, Vec<u8>)>>,
    faults: (Faults, Faults),
    wire: BinaryHeap<Reverse<(Now, u64, Packet)>>,
    order: u64,
}

impl World {
    pub fn new(setup: Setup, settings: Settings, faults: &str) -> Self {
        let faults: FaultSpec = if faults.is_empty() { FaultSpec::default() } else { faults.parse().unwrap() };
        Self {
            // The time does not start at 0, so that code that depends on 0 fails.
            now: Duration::from_secs(1000),
            controller: Controller::new(OUR_ADDRESS, settings, Arc::new(Identifiers::random())).unwrap(),
            device: Device::new(setup, Mirror::default()),
            twin: None,
            cable: true,
            frames: Vec::new(),
            calls: Vec::new(),
            shown: Vec::new(),
            record: None,
            faults: Faults::pair(faults),
            wire: BinaryHeap::new(),
            order: 0,
        }
    }

    /// Creates a world with an open connection and data in both directions.
    pub fn open(setup: Setup, settings: Settings, faults: &str) -> Self {
        let mut world = Self::new(setup, settings, faults);
        world.until_open();
        world
    }

    /// Runs until the device has answered the resting image.
    pub fn until_open(&mut self) {
        self.until(60_000 * MS, |world| {
            let view = world.view();
            let is_resting =
                |image: &[u8]| native_order(image).iter().zip(resting()).all(|(byte, rest)| byte & !rest == 0);
            view.state == State::Open && view.input.is_some_and(|input| is_resting(&input.image))
        });
    }

    pub fn view(&self) -> View {
        self.controller.view()
    }

    /// Returns the calls of this operation.
    pub fn calls(&self, operation: u16) -> Vec<Vec<u8>> {
        let is_one = |bytes: &&Vec<u8>| {
            let header = Datagram::parse(bytes).unwrap().header;
            (header.kind, header.operation) == (Kind::REQUEST, operation)
        };
        self.calls.iter().filter(is_one).cloned().collect()
    }

    /// Runs until the condition is true, but at most for `most`.
    pub fn until(&mut self, max_len: Duration, condition: impl Fn(&Self) -> bool) {
        let end = self.now + max_len;
        while !condition(self) {
            let goes_on = self.step(end);
            assert!(goes_on || condition(self), "it did not come about within {max_len:?}: {:?}", self.view());
        }
    }

    /// Runs for a time.
    pub fn run(&mut self, time: Duration) {
        let end = self.now + time;
        while self.step(end) {}
    }

    /// Runs until the connection is closed.
    pub fn run_to_deadline(&mut self) -> View {
        self.until(120_000 * MS, |world| world.view().state == State::Closed);
        self.view()
    }

    fn step(&mut self, end: Now) -> bool {
        self.settle();
        let next = self.wire.peek().map(|Reverse((at, ..))| *at);
        let twin = self.twin.as_ref().and_then(Device::wake);
        let next = [next, self.controller.wake(), self.device.wake(), twin].into_iter().flatten().min();
        let Some(next) = next.filter(|next| *next <= end) else {
            self.now = end;
            return false;
        };
        self.now = self.now.max(next);
        if self.wire.peek().is_some_and(|Reverse((at, ..))| *at <= self.now)
            && let Some(Reverse((_, _, packet))) = self.wire.pop()
        {
            self.deliver(packet);
        }
        true
    }

    /// Lets both sides do all the work that is due now.
    pub fn settle(&mut self) {
        loop {
            let local_reference = self.controller.poll(self.now);
            let remote_reference = self.device.poll(self.now);
            let twins = self.twin.as_mut().and_then(|twin| twin.poll(self.now));
            if local_reference.is_none() && remote_reference.is_none() && twins.is_none() {
                break;
            }
            match local_reference {
                Some(Action::Frame(bytes)) => {
                    self.frames.push((self.now, bytes.clone()));
                    self.launch(true, &bytes, Packet::FrameOut);
                }
                Some(Action::Datagram(to, bytes)) => {
                    self.calls.push(bytes.clone());
                    self.launch(true, &bytes, |bytes| Packet::CallOut(to, bytes));
                }
                None => {}
            }
            let from = SocketAddrV4::new(self.device.answers_from().unwrap_or(ADDRESS), PORT);
            for action in [remote_reference, twins].into_iter().flatten() {
                match action {
                    Action::Frame(bytes) => self.launch(false, &bytes, Packet::FrameIn),
                    Action::Datagram(_, bytes) => self.launch(false, &bytes, |bytes| Packet::CallIn(from, bytes)),
                }
            }
        }
        if let Some(input) = self.controller.view().input
            && self.shown.last() != Some(&input.image)
        {
            self.shown.push(input.image);
        }
    }

    fn launch(&mut self, outward: bool, bytes: &[u8], packet: impl Fn(Vec<u8>) -> Packet) {
        if !self.cable {
            return;
        }
        if let Some(record) = &mut self.record {
            let bytes = match packet(bytes.to_vec()) {
                Packet::FrameOut(bytes) | Packet::FrameIn(bytes) => bytes,
                Packet::CallOut(to, bytes) => ethernet(OUR_ADDRESS.ip.address, *to.ip(), &bytes),
                Packet::CallIn(from, bytes) => ethernet(*from.ip(), OUR_ADDRESS.ip.address, &bytes),
            };
            record.push((self.now, bytes));
        }
        let faults = if outward { &mut self.faults.0 } else { &mut self.faults.1 };
        for (at, bytes) in faults.pass(self.now, bytes) {
            let packet = packet(bytes);
            let is_frame = matches!(packet, Packet::FrameOut(_) | Packet::FrameIn(_));
            // The cycle counter shows that a frame is old only if the frame is delayed by at most 128 ms. No switch
            // delays a frame for a longer time, so such a frame is dropped here.
            if is_frame && at > self.now + MAX_HOLD_TIME {
                continue;
            }
            self.order += 1;
            self.wire.push(Reverse((at, self.order, packet)));
        }
    }

    fn deliver(&mut self, packet: Packet) {
        let now = self.now;
        let local_address = SocketAddrV4::new(OUR_ADDRESS.ip.address, PORT);
        match packet {
            Packet::FrameOut(bytes) => {
                self.device.frame(now, &bytes);
                if let Some(twin) = &mut self.twin {
                    twin.frame(now, &bytes);
                }
            }
            Packet::FrameIn(bytes) => self.controller.frame(now, &bytes),
            Packet::CallOut(to, bytes) if to == SocketAddrV4::new(ADDRESS, PORT) => {
                self.device.datagram(now, local_address, &bytes);
            }
            Packet::CallOut(..) => {}
            Packet::CallIn(from, bytes) => self.controller.datagram(now, from, &bytes),
        }
    }
}

/// Wraps a datagram into an Ethernet frame, without checksums.
fn ethernet(from: Ipv4Addr, to: Ipv4Addr, bytes: &[u8]) -> Vec<u8> {
    let (local_address, there) = if from == OUR_ADDRESS.ip.address {
        (OUR_ADDRESS.mac, DEVICE_ADDRESS)
    } else {
        (DEVICE_ADDRESS, OUR_ADDRESS.mac)
    };
    let length = |header: usize| u16::try_from(header + bytes.len()).unwrap().to_be_bytes();
    let mut out = [there.0, local_address.0].concat();
    out.extend([8, 0, 0x45, 0]);
    out.extend(length(28));
    out.extend([0, 0, 0, 0, 64, 17, 0, 0]);
    out.extend(from.octets());
    out.extend(to.octets());
    for port in [PORT, PORT] {
        out.extend(port.to_be_bytes());
    }
    out.extend(length(8));
    out.extend([0, 0]);
    out.extend(bytes);
    out
}

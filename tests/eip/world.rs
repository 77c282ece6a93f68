//! An originator and an adapter on a network in virtual time. TCP is reliable or down, and UDP has the requested
//! faults.

use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::net::{Ipv4Addr, SocketAddrV4};
use std::sync::Arc;
use std::time::Duration;

use armctl_transport::eip::adapter::{Adapter, Application, Event, Output, Setup};
use armctl_transport::eip::error::EipError;
use armctl_transport::eip::originator::{Action, Identifiers, Originator, State, View};
use armctl_transport::eip::session::{Ask, Token};
use armctl_transport::eip::settings::{Multiplier, Settings};
use armctl_transport::eip::wire::{Command, Cyclic, Identity, Revision};
use armctl_transport::eip::{IO_PORT, Now, PORT};
use armctl_transport::fault::{FaultSpec, Faults};

pub const MS: Duration = Duration::from_millis(1);
/// Transit time of TCP.
const TRIP_TIME: Duration = MS;
pub const ORIGINATOR_ADDRESS: Ipv4Addr = Ipv4Addr::new(10, 0, 0, 1);
pub const ADAPTER_ADDRESS: Ipv4Addr = Ipv4Addr::new(10, 0, 0, 2);

/// An application that returns the received image with every bit inverted.
#[derive(Debug, Default)]
pub struct Mirror {
    pub image: Vec<u8>,
    pub run: bool,
    /// Every image that differs from the previous image, with the run bit.
    pub history: Vec<(Vec<u8>, bool)>,
    pub events: Vec<Event>,
}

impl Application for Mirror {
    fn image_out(&mut self, _: Now, _: u32, image: &[u8], run: bool) {
        (self.image, self.run) = (image.to_vec(), run);
        if self.history.last().is_none_or(|last| last.0 != image || last.1 != run) {
            self.history.push((image.to_vec(), run));
        }
    }

    fn image_in(&mut self, _: Now, _: u32, image: &mut [u8]) {
        for (at, byte) in image.iter_mut().enumerate() {
            *byte = !self.image.get(at).copied().unwrap_or(0xFF);
        }
    }

    fn event(&mut self, _: Now, event: &Event) {
        self.events.push(event.clone());
    }
}

/// Identity of an RCX of 2011, with the values from its data sheet.
pub fn identity() -> Identity {
    Identity {
        address: SocketAddrV4::new(ADAPTER_ADDRESS, PORT),
        vendor: 636,
        device_type: 43,
        product: 5,
        revision: Revision { major: 1, minor: 2 },
        status: 0,
        serial: 0x0102_0304,
        name: "RCX".to_owned(),
        state: Some(3),
    }
}

pub fn setup() -> Setup {
    Setup::new(identity(), (100, 48), (150, 48), 1)
}

pub fn settings() -> Settings {
    Settings { output_size: 48, input_size: 48, resting: resting(), ..Settings::default() }
}

/// Settings with the longest timeout, for tests in real time: on a busy machine, the connection must not be lost.
pub fn with_long_timeout() -> Settings {
    Settings { multiplier: Multiplier::of(512).unwrap(), ..settings() }
}

/// A resting image in which not all bits are zero.
pub fn resting() -> Vec<u8> {
    let mut image = vec![0; 48];
    image[32] = 0x41;
    image
}

/// A packet in transit.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Packet {
    Connected(u32),
    Refused(u32),
    ToAdapter(u32, Vec<u8>),
    ToOriginator(u32, Vec<u8>),
    HangUp(u32),
    ImageOut(SocketAddrV4, Vec<u8>),
    ImageIn(SocketAddrV4, Vec<u8>),
}

#[derive(Debug)]
pub struct World {
    pub now: Now,
    pub originator: Originator,
    pub adapter: Adapter<Mirror>,
    /// Whether TCP connections are possible.
    pub tcp: bool,
    /// Whether packets arrive at all.
    pub cable: bool,
    pub answers: Vec<(Token, Result<Vec<u8>, EipError>)>,
    /// Every frame sent on TCP, with its direction.
    pub frames: Vec<(bool, Vec<u8>)>,
    /// Every cyclic datagram sent to the adapter.
    pub images_out: Vec<(Now, Vec<u8>)>,
    pub joined: Vec<Ipv4Addr>,
    /// Number of the TCP connection.
    connection: u32,
    faults: (Faults, Faults),
    wire: BinaryHeap<Reverse<(Now, u64, Packet)>>,
    order: u64,
}

impl World {
    pub fn new(setup: Setup, settings: Settings, faults: &str) -> Self {
        let target = SocketAddrV4::new(ADAPTER_ADDRESS, PORT);
        let numbers = Arc::new(Identifiers::new(0x0506_0708, 0x0101, 0x1000));
        let faults: FaultSpec = if faults.is_empty() { FaultSpec::default() } else { faults.parse().unwrap() };
        Self {
            // The start time is not 0, so that no code can rely on 0.
            now: Duration::from_secs(1000),
            originator: Originator::new(target, IO_PORT, settings, numbers).unwrap(),
            adapter: Adapter::new(setup, Mirror::default()),
            tcp: true,
            cable: true,
            answers: Vec::new(),
            frames: Vec::new(),
            images_out: Vec::new(),
            joined: Vec::new(),
            connection: 0,
            faults: Faults::pair(faults),
            wire: BinaryHeap::new(),
            order: 0,
        }
    }

    /// A world with an open connection, after the first image from the adapter.
    pub fn open(setup: Setup, settings: Settings, faults: &str) -> Self {
        let mut world = Self::new(setup, settings, faults);
        world.run_until(20_000 * MS, |world| world.view().input.is_some());
        assert_eq!(world.view().state, State::Open);
        world
    }

    pub fn view(&self) -> View {
        self.originator.view()
    }

    /// Sends a request through the session.
    pub fn ask(&mut self, token: u64, data: Vec<u8>) {
        let ask = Ask { token: Token(token), what: "the test", command: Command::SEND_RR_DATA, data };
        self.originator.ask(ask);
    }

    /// Runs until the condition is true. The test fails if this takes longer than `most`.
    pub fn run_until(&mut self, most: Duration, condition: impl Fn(&Self) -> bool) {
        let end = self.now + most;
        while !condition(self) {
            let goes_on = self.step(end);
            assert!(goes_on || condition(self), "it did not come about within {most:?}: {:?}", self.view());
        }
    }

    /// Runs for this time.
    pub fn run(&mut self, time: Duration) {
        let end = self.now + time;
        while self.step(end) {}
    }

    /// Executes the next event, if it comes before `end`.
    fn step(&mut self, end: Now) -> bool {
        self.settle();
        let next = self.wire.peek().map(|Reverse((at, ..))| *at);
        let next = [next, self.originator.wake(), self.adapter.wake()].into_iter().flatten().min();
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

    /// Lets both ends do all work that they have at the current time.
    fn settle(&mut self) {
        loop {
            let action = self.originator.poll(self.now);
            let output = self.adapter.poll(self.now);
            if action.is_none() && output.is_none() {
                return;
            }
            if let Some(action) = action {
                self.act(action);
            }
            match output {
                Some(Output::Send(client, bytes)) => {
                    self.frames.push((false, bytes.clone()));
                    self.send(Packet::ToOriginator(u32::try_from(client).unwrap(), bytes));
                }
                Some(Output::HangUp(client)) => self.send(Packet::HangUp(u32::try_from(client).unwrap())),
                Some(Output::Datagram(to, bytes)) => self.put_on_wire(false, to, &bytes),
                Some(Output::Discovered(..)) | None => {}
            }
        }
    }

    fn act(&mut self, action: Action) {
        match action {
            Action::Connect => {
                self.connection += 1;
                let connection = self.connection;
                if self.cable {
                    self.send(if self.tcp { Packet::Connected(connection) } else { Packet::Refused(connection) });
                }
            }
            Action::Send(bytes) => {
                self.frames.push((true, bytes.clone()));
                self.send(Packet::ToAdapter(self.connection, bytes));
            }
            Action::Disconnect => {
                self.adapter.disconnected(self.connection.into());
                self.connection += 1;
            }
            Action::Datagram(to, bytes) => {
                self.images_out.push((self.now, bytes.clone()));
                self.put_on_wire(true, to, &bytes);
            }
            Action::Join(group) => self.joined.push(group),
            Action::Leave(group) => self.joined.retain(|joined| *joined != group),
            Action::Answer(token, result) => self.answers.push((token, result)),
        }
    }

    /// Sends by TCP.
    fn send(&mut self, packet: Packet) {
        if self.cable {
            self.place_on_wire(self.now + TRIP_TIME, packet);
        }
    }

    /// Sends by UDP.
    fn put_on_wire(&mut self, outward: bool, to: SocketAddrV4, bytes: &[u8]) {
        if !self.cable {
            return;
        }
        let faults = if outward { &mut self.faults.0 } else { &mut self.faults.1 };
        for (at, bytes) in faults.pass(self.now, bytes) {
            self.place_on_wire(at, if outward { Packet::ImageOut(to, bytes) } else { Packet::ImageIn(to, bytes) });
        }
    }

    fn place_on_wire(&mut self, at: Now, packet: Packet) {
        self.order += 1;
        self.wire.push(Reverse((at, self.order, packet)));
    }

    fn deliver(&mut self, packet: Packet) {
        let current = self.connection;
        match packet {
            Packet::Connected(connection) if connection == current => {
                self.adapter.connected(connection.into(), ORIGINATOR_ADDRESS);
                self.originator.connected(self.now);
            }
            Packet::Refused(connection) if connection == current => {
                let text = "refused".to_owned();
                self.originator
                    .disconnected(&EipError::Unreachable { kind: std::io::ErrorKind::ConnectionRefused, text });
            }
            Packet::ToAdapter(connection, bytes) if connection == current || bytes[0] == 0x66 => {
                self.adapter.received(self.now, connection.into(), &bytes);
            }
            Packet::ToOriginator(connection, bytes) if connection == current => {
                self.originator.received(self.now, &bytes);
            }
            Packet::HangUp(connection) if connection == current => {
                self.adapter.disconnected(connection.into());
                self.originator.disconnected(&EipError::Hangup("the test"));
            }
            Packet::ImageOut(to, bytes) if to == SocketAddrV4::new(ADAPTER_ADDRESS, IO_PORT) => {
                self.adapter.receive_datagram(self.now, SocketAddrV4::new(ORIGINATOR_ADDRESS, IO_PORT), &bytes);
            }
            Packet::ImageIn(to, bytes) if *to.ip() == ORIGINATOR_ADDRESS || self.joined.contains(to.ip()) => {
                let Ok(datagram) = Cyclic::parse(&bytes) else { return };
                if self.originator.expects(ADAPTER_ADDRESS, datagram.id) {
                    self.originator.receive_datagram(self.now, IO_PORT, &datagram);
                }
            }
            _ => {}
        }
    }
}

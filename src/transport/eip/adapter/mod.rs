//! Simulated EtherNet/IP adapter with assemblies. The adapter has no sockets and no clock. It is stricter than real
//! devices.

use std::collections::{BTreeMap, VecDeque};
use std::net::{Ipv4Addr, SocketAddrV4};
use std::ops::RangeInclusive;
use std::time::Duration;

use super::class1::{Consumer, DatagramResult, Producer};
use super::settings::Role;
use super::wire::{
    Close, Closed, Command, Cyclic, Frame, Frames, Identity, Item, Refused, Reply, Request, RrData, Services, Status,
    Triad, service,
};
use super::{Now, PORT};
use crate::refuse_if;

mod fault;
mod objects;
mod open;
pub mod server;

pub use fault::AdapterFault;

/// Class and instance of the connection manager.
const MANAGER: (u32, u32) = (6, 1);
/// Encapsulation status codes.
const UNSUPPORTED_COMMAND: u32 = 0x01;
const NO_MEMORY: u32 = 0x02;
const INCORRECT_DATA: u32 = 0x03;
const INVALID_SESSION: u32 = 0x64;
const INVALID_LENGTH: u32 = 0x65;
const UNSUPPORTED_VERSION: u32 = 0x69;
/// General status codes.
const PATH_SEGMENT: u8 = 0x04;
const UNKNOWN_DESTINATION: u8 = 0x05;
const UNKNOWN_SERVICE: u8 = 0x08;
const NOT_ENOUGH_DATA: u8 = 0x13;
/// Extended status of a refused close.
const NOT_FOUND: u16 = 0x0107;

/// Use of an assembly, as the originator sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// The adapter produces the data.
    Input,
    /// The adapter consumes the data.
    Output,
    /// The originator sends the data when it opens a connection.
    Configuration,
}

/// An assembly.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Assembly {
    /// Instance number.
    pub instance: u32,
    /// Use of the assembly.
    pub purpose: Purpose,
    /// Size in bytes.
    pub size: u16,
}

/// Configuration of an adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setup {
    /// Identity of the adapter. Its address is replaced by the address on which the adapter listens.
    pub identity: Identity,
    /// Assemblies.
    pub assemblies: Vec<Assembly>,
    /// Output instance of input-only connections.
    pub input_only: u32,
    /// Output instance of listen-only connections.
    pub listen_only: u32,
    /// Supported intervals (RPI).
    pub rpi: RangeInclusive<Duration>,
    /// The adapter rounds requested intervals up to a multiple of this time.
    pub tick: Duration,
    /// Maximum number of connections.
    pub most_connections: usize,
    /// Maximum number of sessions.
    pub most_sessions: usize,
    /// UDP port for images.
    pub io_port: u16,
    /// Multicast group of images.
    pub group: Ipv4Addr,
}

/// Application behind the adapter.
pub trait Application: Send {
    /// Receives a new image from the owner, with the run/idle bit.
    fn image_out(&mut self, now: Now, instance: u32, image: &[u8], run: bool);
    /// Updates the image to originators. The buffer contains the previous image.
    fn image_in(&mut self, now: Now, instance: u32, image: &mut [u8]);
    /// Whether the device answers no request and sends no image.
    fn is_silent(&mut self, _now: Now) -> bool {
        false
    }
    /// Handles the opening or the end of a connection.
    fn event(&mut self, now: Now, event: &Event);
}

/// Event of a connection.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Event {
    /// The connection was opened.
    Opened(Peer),
    /// The originator closed the connection. A listen-only connection also closes if the connection on which it depends
    /// closes.
    Closed(Peer),
    /// The originator timed out.
    TimedOut(Peer),
}

/// Originator of a connection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Peer {
    /// IP address.
    pub address: Ipv4Addr,
    /// Role of the connection.
    pub role: Role,
    /// Produced assembly.
    pub input: u32,
    /// Consumed assembly, if the originator is the owner.
    pub output: Option<u32>,
    /// Interval from originator to target.
    pub o_t: Duration,
    /// Interval from target to originator.
    pub t_o: Duration,
}

/// An action that the driver must execute.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Output {
    /// Send these bytes to a TCP client.
    Send(u64, Vec<u8>),
    /// Close the TCP connection of a client.
    HangUp(u64),
    /// Send an image from the UDP port for images.
    Datagram(SocketAddrV4, Vec<u8>),
    /// Send a ListIdentity answer.
    Discovered(SocketAddrV4, Vec<u8>),
}

#[derive(Debug)]
struct Client {
    address: Ipv4Addr,
    frames: Frames,
    session: Option<u32>,
}

/// An open I/O connection.
#[derive(Debug)]
struct IoConnection {
    peer: Peer,
    triad: Triad,
    consumer: Consumer,
    /// Sender of the images. `None` if another connection already sends to the same group.
    producer: Option<Producer>,
    t_o_id: u32,
    destination: SocketAddrV4,
    is_multicast: bool,
    run: bool,
}

/// A simulated adapter.
#[derive(Debug)]
pub struct Adapter<A> {
    setup: Setup,
    /// The application.
    pub application: A,
    images: BTreeMap<u32, Vec<u8>>,
    clients: BTreeMap<u64, Client>,
    connections: Vec<IoConnection>,
    last_session: u32,
    last_id: u32,
    fault: Option<AdapterFault>,
    outputs: VecDeque<Output>,
}

impl<A: Application> Adapter<A> {
    /// Creates an adapter without connections.
    pub fn new(setup: Setup, application: A) -> Self {
        let images = setup.assemblies.iter().map(|assembly| (assembly.instance, vec![0; assembly.size.into()]));
        Self {
            images: images.collect(),
            setup,
            application,
            clients: BTreeMap::new(),
            connections: Vec::new(),
            last_session: 0,
            last_id: fastrand::u32(..),
            fault: None,
            outputs: VecDeque::new(),
        }
    }

    /// Sets the address and the image port. The driver calls this function after it has bound the sockets.
    pub const fn listens(&mut self, address: SocketAddrV4, io_port: u16) {
        self.setup.identity.address = address;
        self.setup.io_port = io_port;
    }

    /// Activates a fault; `None` deactivates the active fault.
    pub const fn set_fault(&mut self, fault: Option<AdapterFault>) {
        self.fault = fault;
    }

    /// Originators of the open connections.
    pub fn peers(&self) -> impl Iterator<Item = &Peer> {
        self.connections.iter().map(|connections| &connections.peer)
    }

    /// Handles a new TCP client.
    pub fn connected(&mut self, client: u64, address: Ipv4Addr) {
        self.clients.insert(client, Client { address, frames: Frames::default(), session: None });
    }

    /// Handles the end of a TCP client. Its I/O connections stay open until they time out.
    pub fn disconnected(&mut self, client: u64) {
        self.clients.remove(&client);
    }

    /// Handles bytes from a TCP client.
    pub fn received(&mut self, now: Now, client: u64, bytes: &[u8]) {
        let Some(state) = self.clients.get_mut(&client) else { return };
        state.frames.push(bytes);
        while let Some(bytes) = self.clients.get_mut(&client).and_then(|state| state.frames.pop()) {
            let Ok(frame) = Frame::parse(&bytes) else { return };
            match self.fault {
                _ if self.application.is_silent(now) => {}
                Some(AdapterFault::Mute) => {}
                Some(AdapterFault::Reset) if frame.command == Command::SEND_RR_DATA => {
                    self.outputs.push_back(Output::HangUp(client));
                }
                Some(AdapterFault::ResetSet) if is_set(&frame) => self.outputs.push_back(Output::HangUp(client)),
                Some(AdapterFault::Garbage) if frame.command == Command::SEND_RR_DATA => {
                    let noise = Frame { data: &[0xFF; 40], ..frame };
                    self.outputs.push_back(Output::Send(client, noise.emit()));
                }
                _ => self.take(now, client, &frame),
            }
        }
    }

    /// Handles a datagram on the ListIdentity port.
    pub fn discovered(&mut self, from: SocketAddrV4, bytes: &[u8]) {
        let Ok(frame) = Frame::parse(bytes) else { return };
        if self.fault == Some(AdapterFault::Mute) {
            return;
        }
        if let Some(data) = self.listed(frame.command) {
            let answer = Frame { session: 0, status: 0, data: &data, ..frame };
            self.outputs.push_back(Output::Discovered(from, answer.emit()));
        }
    }

    /// Handles a datagram on the image port.
    pub fn receive_datagram(&mut self, now: Now, from: SocketAddrV4, bytes: &[u8]) {
        let Ok(datagram) = Cyclic::parse(bytes) else { return };
        let is_meant = |connections: &&mut IoConnection| {
            connections.consumer.id() == datagram.id && connections.peer.address == *from.ip()
        };
        let Some(connections) = self.connections.iter_mut().find(is_meant) else { return };
        let DatagramResult::Image { run, image } = connections.consumer.take(now, &datagram) else { return };
        connections.run = run;
        let Some(instance) = connections.peer.output else { return };
        if let Some(kept) = self.images.get_mut(&instance) {
            kept.copy_from_slice(image);
        }
        self.application.image_out(now, instance, image, run);
    }

    /// Returns the next action at `now`. The caller repeats the call until it returns `None`.
    pub fn poll(&mut self, now: Now) -> Option<Output> {
        if self.outputs.is_empty() {
            self.expire(now);
            self.produce(now);
        }
        self.outputs.pop_front()
    }

    /// Latest time of the next call of [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        if !self.outputs.is_empty() {
            return Some(Now::ZERO);
        }
        let times = self.connections.iter().flat_map(|connections| {
            [connections.producer.as_ref().map(Producer::due), Some(connections.consumer.until())].into_iter().flatten()
        });
        times.min()
    }

    fn expire(&mut self, now: Now) {
        while let Some(index) = self.connections.iter().position(|connections| now >= connections.consumer.until()) {
            let peer = self.remove(now, index);
            self.application.event(now, &Event::TimedOut(peer));
        }
    }

    fn produce(&mut self, now: Now) {
        let fault = if self.application.is_silent(now) { Some(AdapterFault::Stall) } else { self.fault };
        for connections in &mut self.connections {
            let Some(producer) = connections.producer.as_mut().filter(|producer| now >= producer.due()) else {
                continue;
            };
            let instance = connections.peer.input;
            let Some(image) = self.images.get_mut(&instance) else { continue };
            if fault != Some(AdapterFault::Frozen) || producer.sent == 0 {
                self.application.image_in(now, instance, image);
            }
            let datagram = producer.produce(now, None, image);
            for bytes in fault::images(fault, producer.sent, datagram) {
                self.outputs.push_back(Output::Datagram(connections.destination, bytes));
            }
        }
    }

    /// Removes a connection, and the listen-only connections that depend on it.
    fn remove(&mut self, now: Now, index: usize) -> Peer {
        let connections = self.connections.remove(index);
        if connections.is_multicast {
            let mut same =
                self.connections.iter_mut().filter(|other| other.is_multicast && other.t_o_id == connections.t_o_id);
            if let (Some(producer), Some(next)) = (connections.producer, same.next()) {
                next.producer = Some(producer);
            }
            let feeds =
                |other: &IoConnection| other.t_o_id == connections.t_o_id && other.peer.role != Role::ListenOnly;
            if !self.connections.iter().any(feeds) {
                let listens = |other: &mut IoConnection| other.is_multicast && other.t_o_id == connections.t_o_id;
                let orphans: Vec<IoConnection> = self.connections.extract_if(.., listens).collect();
                for orphan in orphans {
                    self.application.event(now, &Event::Closed(orphan.peer));
                }
            }
        }
        connections.peer
    }

    fn take(&mut self, now: Now, client: u64, frame: &Frame<'_>) {
        let Some(state) = self.clients.get(&client) else { return };
        let (session, address) = (state.session, state.address);
        let result = match frame.command {
            Command::NOP => return,
            Command::UNREGISTER_SESSION => {
                self.outputs.push_back(Output::HangUp(client));
                return;
            }
            Command::REGISTER_SESSION => self.register(client, frame.data),
            Command::SEND_RR_DATA if session.is_none_or(|session| session != frame.session) => Err(INVALID_SESSION),
            Command::SEND_RR_DATA => match RrData::parse(frame.data) {
                Ok(data) => Ok((frame.session, self.message(now, address, &data))),
                Err(_) => Err(INCORRECT_DATA),
            },
            command => self.listed(command).map(|data| (frame.session, data)).ok_or(UNSUPPORTED_COMMAND),
        };
        let answer = match &result {
            Ok((session, data)) => Frame { session: *session, status: 0, data, ..*frame },
            Err(status) => Frame { status: *status, data: &[], ..*frame },
        };
        self.outputs.push_back(Output::Send(client, answer.emit()));
    }

    fn register(&mut self, client: u64, data: &[u8]) -> Result<(u32, Vec<u8>), u32> {
        let [version, 0, options @ ..] = data else { return Err(INVALID_LENGTH) };
        refuse_if(options.len() != 2, INVALID_LENGTH)?;
        refuse_if(*version != 1 || options != [0, 0], UNSUPPORTED_VERSION)?;
        let sessions = self.clients.values().filter(|client| client.session.is_some()).count();
        let state = self.clients.get_mut(&client).ok_or(NO_MEMORY)?;
        refuse_if(state.session.is_some(), UNSUPPORTED_COMMAND)?;
        refuse_if(sessions >= self.setup.most_sessions, NO_MEMORY)?;
        self.last_session += 1;
        state.session = Some(self.last_session);
        Ok((self.last_session, data.to_vec()))
    }

    /// Returns the data of the answer to a list command.
    fn listed(&self, command: Command) -> Option<Vec<u8>> {
        match command {
            Command::LIST_IDENTITY => Some(self.identity().emit()),
            Command::LIST_SERVICES => Some(Services::cyclic().emit()),
            Command::LIST_INTERFACES => Some(Item::emit_all(&[])),
            _ => None,
        }
    }

    /// Returns the identity with the current status (volume 1, 5-2.2.1.5).
    fn identity(&self) -> Identity {
        let is_owned = self.connections.iter().any(|connections| connections.peer.role == Role::ExclusiveOwner);
        let is_owned = is_owned && self.fault != Some(AdapterFault::Unowned);
        let extended = match (self.connections.is_empty(), self.connections.iter().any(|connections| connections.run)) {
            (true, _) => 3,
            (false, true) => 6,
            (false, false) => 7,
        };
        Identity { status: u16::from(is_owned) | extended << 4, ..self.setup.identity.clone() }
    }

    /// Answers an unconnected message.
    fn message(&mut self, now: Now, from: Ipv4Addr, data: &RrData<'_>) -> Vec<u8> {
        let Ok(request) = Request::parse(data.message) else {
            let service = data.message.first().copied().unwrap_or_default();
            let reply = Reply { service, status: Status::general(PATH_SEGMENT), data: &[] }.emit();
            return RrData::new(&reply).emit();
        };
        let mut addresses = (None, None);
        let answer = match (request.path.object_named(), request.service) {
            (Some((class, instance, None)), kind) if (class, instance) == MANAGER => match kind {
                service::FORWARD_OPEN | service::LARGE_FORWARD_OPEN => {
                    let large = kind == service::LARGE_FORWARD_OPEN;
                    let opened = self.open(now, from, data.t_o, request.data, large);
                    opened.map(|opened| {
                        addresses = opened.addresses;
                        opened.data
                    })
                }
                service::FORWARD_CLOSE => self.close(now, request.data),
                _ => Err((Status::general(UNKNOWN_SERVICE), Vec::new())),
            },
            (Some(object), _) => {
                self.object(now, object, &request).map_err(|general| (Status::general(general), Vec::new()))
            }
            (None, _) => Err((Status::general(UNKNOWN_DESTINATION), Vec::new())),
        };
        let (status, data) = match answer {
            Ok(data) => (Status::OK, data),
            Err((status, data)) => (status, data),
        };
        let reply = Reply { service: request.service, status, data: &data }.emit();
        let mut answer = RrData { o_t: addresses.0, t_o: addresses.1, ..RrData::new(&reply) }.emit();
        if self.fault == Some(AdapterFault::Trailing) && request.service == service::FORWARD_OPEN {
            answer.extend(fault::TRAILING);
        }
        answer
    }

    fn close(&mut self, now: Now, data: &[u8]) -> Result<Vec<u8>, (Status, Vec<u8>)> {
        let Ok(close) = Close::parse(data) else {
            return Err((Status::general(NOT_ENOUGH_DATA), Vec::new()));
        };
        let Some(index) = self.connections.iter().position(|connections| connections.triad == close.triad) else {
            let refused = Refused { triad: close.triad, remaining: Some(0) };
            return Err((Status::connection(NOT_FOUND, &[]), refused.emit()));
        };
        let peer = self.remove(now, index);
        self.application.event(now, &Event::Closed(peer));
        Ok(Closed { triad: close.triad }.emit())
    }
}

impl Setup {
    /// Creates the configuration of an adapter with one input, one output and one empty configuration assembly.
    pub fn new(identity: Identity, input: (u32, u16), output: (u32, u16), configuration: u32) -> Self {
        let assembly = |instance, purpose, size| Assembly { instance, purpose, size };
        Self {
            identity: Identity { address: SocketAddrV4::new(Ipv4Addr::UNSPECIFIED, PORT), ..identity },
            assemblies: vec![
                assembly(input.0, Purpose::Input, input.1),
                assembly(output.0, Purpose::Output, output.1),
                assembly(configuration, Purpose::Configuration, 0),
            ],
            // Most data sheets give these instance numbers.
            input_only: 238,
            listen_only: 237,
            rpi: Duration::from_millis(2)..=Duration::from_millis(3200),
            tick: Duration::from_millis(1),
            most_connections: 8,
            most_sessions: 8,
            io_port: super::IO_PORT,
            group: Ipv4Addr::new(239, 192, 1, 32),
        }
    }

    fn assembly(&self, instance: u32, purpose: Purpose) -> Option<&Assembly> {
        self.assemblies.iter().find(|assembly| assembly.instance == instance && assembly.purpose == purpose)
    }
}

/// Whether the frame is a Set_Attribute_Single.
fn is_set(frame: &Frame<'_>) -> bool {
    frame.command == Command::SEND_RR_DATA
        && RrData::parse(frame.data).is_ok_and(|data| data.message.first() == Some(&service::SET_ATTRIBUTE_SINGLE))
}

//! What can be asked of stations, and set at them, without a connection: who is there, names, addresses, records.
//!
//! Each call blocks for as long as it says.

use std::io::{self, ErrorKind, Read as _, Write as _};
use std::net::{Ipv4Addr, SocketAddr, SocketAddrV4, UdpSocket};
use std::time::{Duration, Instant};

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use socket2::Socket;

use super::controller::client::{Client, Outcome, Step};
use super::error::ProfinetError;
use super::interface::Interface;
use super::wire::block::BlockType;
use super::wire::dcp::{self, Block, Dcp, Kind, Service, Station};
use super::wire::frame::{Frame, id};
use super::wire::record::{self, Im0, RealModule, Record, index};
use super::wire::rpc::{self, Datagram, operation};
use super::wire::{Mac, Uuid};

/// Over how many steps of 10 ms stations spread their answers when all are asked.
const SPREAD: u16 = 128;
/// How long to wait for a station that was asked alone, and how often.
const PATIENCE: Duration = Duration::from_secs(1);
const TRIES: u32 = 3;
/// Stations that are told of; a network has a few hundred.
const MOST: usize = 4096;
/// Room for a frame or a datagram.
const BUFFER: usize = 65_536;
/// Room for a record.
const ROOM: u32 = 4000;

/// A station that answered. What it says of itself is untrusted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// Its card.
    pub mac: Mac,
    /// What it says.
    pub station: Station,
}

/// All stations of a network, by name and card.
///
/// # Errors
/// When the interface cannot be used.
pub fn stations(interface: &Interface, wait: Duration) -> Result<Vec<Found>, ProfinetError> {
    interface.check()?;
    let socket = interface.raw_socket()?;
    let xid = fastrand::u32(1..);
    let request = Dcp::identify_all(xid, SPREAD);
    send(&socket, interface.mac, Mac::DCP_IDENTIFY, id::DCP_IDENTIFY, &request)?;
    let mut found: Vec<Found> = Vec::new();
    let until = Instant::now() + wait;
    hear(&socket, until, |frame| {
        let dcp = Dcp::parse(frame.payload).ok().filter(|dcp| dcp.service == Service::Identify && dcp.xid == xid)?;
        let station =
            dcp.station().ok().filter(|_| frame.destination == interface.mac && dcp.kind == Kind::Response)?;
        if found.len() < MOST && found.iter().all(|other| other.mac != frame.source) {
            found.push(Found { mac: frame.source, station });
        }
        None::<()>
    })?;
    found.sort_by(|one, two| (&one.station.name, one.mac).cmp(&(&two.station.name, two.mac)));
    Ok(found)
}

/// The station of a name.
///
/// # Errors
/// When the interface cannot be used, nobody has the name, or two have.
pub fn by_name(interface: &Interface, name: &str) -> Result<Found, ProfinetError> {
    interface.check()?;
    let station = format!("station '{name}'");
    dcp::check_name(name).map_err(|why| ProfinetError::Impossible(format!("'{name}' is not a name: {why}")))?;
    let socket = interface.raw_socket()?;
    let mut found: Option<Found> = None;
    for _ in 0..TRIES {
        let xid = fastrand::u32(1..);
        send(&socket, interface.mac, Mac::DCP_IDENTIFY, id::DCP_IDENTIFY, &Dcp::identify(xid, name))?;
        let twin = hear(&socket, Instant::now() + PATIENCE, |frame| {
            let dcp =
                Dcp::parse(frame.payload).ok().filter(|dcp| dcp.service == Service::Identify && dcp.xid == xid)?;
            let said = dcp.station().ok().filter(|said| said.name == name && frame.destination == interface.mac)?;
            match &found {
                Some(first) if first.mac != frame.source => return Some((first.mac, frame.source)),
                Some(_) => {}
                None => found = Some(Found { mac: frame.source, station: said }),
            }
            None
        })?;
        if let Some(cards) = twin {
            return Err(ProfinetError::Duplicate { station, cards });
        }
        if let Some(found) = found {
            return Ok(found);
        }
    }
    Err(ProfinetError::NotFound { station, after: PATIENCE * TRIES })
}

/// Sets something at a station: its name, its address, that it blinks. The same goes out three times at most, which does
/// no harm.
///
/// # Errors
/// When the interface cannot be used, the station does not answer, or refuses.
pub fn change(interface: &Interface, mac: Mac, what: &'static str, block: &Block) -> Result<(), ProfinetError> {
    interface.check()?;
    let socket = interface.raw_socket()?;
    let request = Dcp::change(fastrand::u32(1..), vec![block.clone()]);
    for _ in 0..TRIES {
        send(&socket, interface.mac, mac, id::DCP_GET_SET, &request)?;
        let answer = hear(&socket, Instant::now() + PATIENCE, |frame| {
            let is_its = frame.source == mac && frame.destination == interface.mac && frame.id == id::DCP_GET_SET;
            // Some stations do not copy the Xid.
            let dcp = Dcp::parse(frame.payload).ok().filter(|dcp| is_its && dcp.service == Service::Set)?;
            match dcp.kind {
                Kind::Request => None,
                Kind::Unsupported => Some(1),
                Kind::Response => {
                    dcp.outcomes().into_iter().find(|(setting, _)| *setting == block.setting).map(|(_, error)| error)
                }
            }
        })?;
        match answer {
            Some(0) => return Ok(()),
            Some(error) => return Err(ProfinetError::Dcp { what, error }),
            None => {}
        }
    }
    Err(ProfinetError::NoAnswer { what, after: PATIENCE * TRIES })
}

/// What a device says of itself in its records, each as far as it has it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// I&M0.
    pub im0: Result<Im0, ProfinetError>,
    /// The modules that are there.
    pub modules: Result<Vec<RealModule>, ProfinetError>,
}

/// Asks a device for its records without a connection: who it is, and which modules it has.
///
/// # Errors
/// When no socket can be had. That a record is refused or not answered stands in its place.
pub fn identity(here: Ipv4Addr, found: &Found) -> Result<Identity, ProfinetError> {
    let station = || format!("station '{}'", found.station.name);
    let address = found.station.address().ok_or_else(|| ProfinetError::NoAddress { station: station() })?;
    let failed = |error: &io::Error| ProfinetError::local("UDP socket for calls", error);
    let socket = UdpSocket::bind((here, 0)).map_err(|error| failed(&error))?;
    let (vendor, device) = found.station.id.unwrap_or_default();
    let object = rpc::object(found.station.instance.unwrap_or(1), device, vendor);
    let mut client = Client::new(object, Uuid::random());
    let target = SocketAddrV4::new(address, rpc::PORT);
    let mut ask = |what, index| read(&socket, target, &mut client, what, index);
    let malformed = |what| move |error| ProfinetError::Malformed { what, error };
    let (im0, real) = ("Read of I&M0", "Read of the modules");
    Ok(Identity {
        im0: ask(im0, index::IM0).and_then(|bytes| Im0::parse(&bytes).map_err(malformed(im0))),
        modules: ask(real, index::REAL_IDENTIFICATION)
            .and_then(|bytes| record::parse_identification(&bytes).map_err(malformed(real))),
    })
}

fn read(
    socket: &UdpSocket,
    target: SocketAddrV4,
    client: &mut Client,
    what: &'static str,
    index: u16,
) -> Result<Vec<u8>, ProfinetError> {
    let asked = Record { sequence: 0, ar: Uuid::NIL, api: 0, slot: 0, subslot: 1, index, length: ROOM };
    let blocks = asked.emit(BlockType::READ, 0, &[]);
    let blocks = exchange(socket, target, client, &blocks)?.blocks(what)?;
    let (_, record) = Record::parse_answer(&blocks).map_err(|error| ProfinetError::Malformed { what, error })?;
    Ok(record.to_vec())
}

/// Calls, and waits for what comes of it.
fn exchange(
    socket: &UdpSocket,
    target: SocketAddrV4,
    client: &mut Client,
    blocks: &[u8],
) -> Result<Outcome, ProfinetError> {
    let failed = |error: &io::Error| ProfinetError::local("calling the device", error);
    let start = Instant::now();
    let first = client.call(start.elapsed(), operation::READ_IMPLICIT, blocks, TRIES);
    socket.send_to(&first, target).map_err(|error| failed(&error))?;
    let mut buffer = vec![0; BUFFER];
    loop {
        let mut step = client.poll(start.elapsed());
        if step.is_none() {
            let wake = client.wake().unwrap_or_default().saturating_sub(start.elapsed());
            socket.set_read_timeout(Some(wake.max(Duration::from_millis(1)))).map_err(|error| failed(&error))?;
            // Nothing, or somebody else, or an interruption: the clock goes on.
            if let Ok((length, SocketAddr::V4(from))) = socket.recv_from(&mut buffer)
                && from.ip() == target.ip()
            {
                let datagram = Datagram::parse(&buffer[..length]).ok();
                step = datagram.and_then(|datagram| client.handle(start.elapsed(), &datagram));
            }
        }
        match step {
            Some(Step::Done(outcome)) => return Ok(outcome),
            Some(Step::Send(bytes)) => {
                socket.send_to(&bytes, target).map_err(|error| failed(&error))?;
            }
            None => {}
        }
    }
}

fn send(socket: &Socket, source: Mac, destination: Mac, id: u16, dcp: &Dcp) -> Result<(), ProfinetError> {
    let payload = dcp.emit();
    let frame = Frame { destination, source, tag: None, id, payload: &payload };
    let mut socket = socket;
    socket.write_all(&frame.emit()).map_err(|error| ProfinetError::local("sending a frame", &error))
}

/// Hands on each frame that comes until something is made of one, or time is over.
fn hear<T>(
    socket: &Socket,
    until: Instant,
    mut take: impl FnMut(&Frame<'_>) -> Option<T>,
) -> Result<Option<T>, ProfinetError> {
    let mut buffer = vec![0; BUFFER];
    loop {
        let left = until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Ok(None);
        }
        let wait = Timespec::try_from(left).ok();
        // An interruption is like a time that was shorter.
        let _ = poll(&mut [PollFd::new(socket, PollFlags::IN)], wait.as_ref());
        let mut source = socket;
        match source.read(&mut buffer) {
            Ok(length) => {
                let frame = Frame::parse(&buffer[..length]).ok();
                if let Some(made) = frame.and_then(|frame| take(&frame)) {
                    return Ok(Some(made));
                }
            }
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::Interrupted) => {}
            Err(error) => return Err(ProfinetError::local("hearing frames", &error)),
        }
    }
}

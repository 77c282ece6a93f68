//! What can be asked of stations, and set at them, without a connection: who is there, names, addresses, records.

use std::net::Ipv4Addr;
use std::time::Duration;

use super::Now;
use super::controller::client::{Client, Outcome, Step};
use super::error::ProfinetError;
use super::medium::{Arrived, Medium};
use super::settings::Station;
use super::wire::block::BlockType;
use super::wire::dcp::{self, Block, Dcp, Kind, Service, Station as Said};
use super::wire::frame::{Frame, id};
use super::wire::record::{self, Im0, RealModule, Record, index};
use super::wire::rpc::{self, Datagram, operation};
use super::wire::status::Status;
use super::wire::{Mac, Uuid, arp};

/// Over how many steps of 10 ms stations spread their answers when all are asked.
const SPREAD: u16 = 128;
/// How long to wait for a station that was asked alone, and how often.
const PATIENCE: Duration = Duration::from_secs(1);
const TRIES: u32 = 3;
/// After the first answer, for another station that has the same name.
const TWIN: Duration = Duration::from_millis(250);
/// How long to wait for whoever has an address, each of the tries.
const ARP: Duration = Duration::from_millis(300);
/// How often to look whether what was set is there, and for how long.
const LOOK: Duration = Duration::from_millis(200);
const SETTLE: Duration = Duration::from_secs(5);
/// Stations that are told of; a network has a few hundred.
const MOST: usize = 4096;
/// Room for a record.
const ROOM: u32 = 4000;

/// A station that answered. What it says of itself is untrusted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Found {
    /// Its card.
    pub mac: Mac,
    /// What it says.
    pub station: Said,
}

/// All stations of a network, by name and card.
///
/// # Errors
/// When the interface cannot be used.
pub fn stations(medium: &mut dyn Medium, wait: Duration) -> Result<Vec<Found>, ProfinetError> {
    let until = medium.now() + wait;
    let mut found: Vec<Found> = Vec::new();
    let request = Dcp::identify_all(fastrand::u32(1..), SPREAD);
    identify(medium, &request)?;
    while let Some(other) = identified(medium, until, &request)? {
        if found.len() < MOST && found.iter().all(|found| found.mac != other.mac) {
            found.push(other);
        }
    }
    found.sort_by(|one, two| (&one.station.name, one.mac).cmp(&(&two.station.name, two.mac)));
    Ok(found)
}

/// The station of a name or a card.
///
/// # Errors
/// When the interface cannot be used, nobody is it, or two are.
pub fn find(medium: &mut dyn Medium, wanted: &Station) -> Result<Found, ProfinetError> {
    for _ in 0..TRIES {
        let request = looking_for(wanted);
        let mut until = medium.now() + PATIENCE;
        let mut first: Option<Found> = None;
        identify(medium, &request)?;
        while let Some(found) = identified(medium, until, &request)? {
            let is_it = match wanted {
                Station::Name(name) => found.station.name == *name,
                Station::Mac(mac) => found.mac == *mac,
            };
            match &first {
                _ if !is_it => {}
                None => {
                    until = until.min(medium.now() + TWIN);
                    first = Some(found);
                }
                Some(first) if first.mac != found.mac => {
                    let cards = (first.mac, found.mac);
                    return Err(ProfinetError::Duplicate { station: wanted.to_string(), cards });
                }
                Some(_) => {}
            }
        }
        if let Some(found) = first {
            return Ok(found);
        }
    }
    Err(ProfinetError::NotFound { station: wanted.to_string(), after: PATIENCE * TRIES })
}

/// The question for a station. That of a card is a question to all, as not every station has Get.
pub fn looking_for(wanted: &Station) -> Dcp {
    let xid = fastrand::u32(1..);
    match wanted {
        Station::Name(name) => Dcp::identify(xid, name),
        Station::Mac(_) => Dcp::identify_all(xid, 1),
    }
}

/// The frame of a question for stations.
pub fn identify_frame(source: Mac, request: &Dcp) -> Vec<u8> {
    let payload = request.emit();
    Frame { destination: Mac::DCP_IDENTIFY, source, tag: None, id: id::DCP_IDENTIFY, payload: &payload }.emit()
}

/// The frame that sets something at a station.
pub fn change_frame(source: Mac, destination: Mac, request: &Dcp) -> Vec<u8> {
    let payload = request.emit();
    Frame { destination, source, tag: None, id: id::DCP_GET_SET, payload: &payload }.emit()
}

/// Sets something at a station: its name, its address, that it blinks. The same goes out three times at most, which does
/// no harm.
///
/// # Errors
/// When the interface cannot be used, the station does not answer, or refuses.
pub fn change(medium: &mut dyn Medium, mac: Mac, what: &'static str, block: &Block) -> Result<(), ProfinetError> {
    let here = medium.here().0;
    let request = Dcp::change(fastrand::u32(1..), vec![block.clone()]);
    for _ in 0..TRIES {
        medium.send(&change_frame(here, mac, &request))?;
        let until = medium.now() + PATIENCE;
        let answer = hear(medium, until, |frame| {
            let is_its = frame.source == mac && frame.destination == here && frame.id == id::DCP_GET_SET;
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

/// Waits until a station says of itself what was set.
///
/// # Errors
/// When it does not within some seconds, or the interface cannot be used.
pub fn settled(
    medium: &mut dyn Medium,
    mac: Mac,
    what: &'static str,
    is_so: impl Fn(&dcp::Station) -> bool,
) -> Result<Found, ProfinetError> {
    let end = medium.now() + SETTLE;
    while medium.now() < end {
        let request = looking_for(&Station::Mac(mac));
        let until = medium.now() + LOOK;
        identify(medium, &request)?;
        while let Some(found) = identified(medium, until, &request)? {
            if found.mac == mac && is_so(&found.station) {
                return Ok(found);
            }
        }
    }
    Err(ProfinetError::NoAnswer { what, after: SETTLE })
}

/// Which other card than this has an address, if one answers.
///
/// # Errors
/// When the interface cannot be used.
pub fn holder(medium: &mut dyn Medium, address: Ipv4Addr, except: Mac) -> Result<Option<Mac>, ProfinetError> {
    let (here, own) = medium.here();
    // The system does not answer its own question.
    if own.is_some_and(|own| own.address == address) {
        return Ok(Some(here));
    }
    for _ in 0..TRIES {
        medium.send(&arp::probe(here, address))?;
        let until = medium.now() + ARP;
        while let Some(arrived) = medium.next(until)? {
            let Arrived::Frame(bytes) = arrived else { continue };
            if let Some((mac, _)) = arp::holder(&bytes).filter(|(mac, held)| *held == address && *mac != except) {
                return Ok(Some(mac));
            }
        }
    }
    Ok(None)
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
/// When it has no address. That a record is refused or not answered stands in its place.
pub fn identity(medium: &mut dyn Medium, found: &Found) -> Result<Identity, ProfinetError> {
    let station = || format!("station '{}'", found.station.name);
    let address = found.station.address().ok_or_else(|| ProfinetError::NoAddress { station: station() })?;
    let (vendor, device) = found.station.id.unwrap_or_default();
    let object = rpc::object(found.station.instance.unwrap_or(1), device, vendor);
    let mut client = Client::new(object, Uuid::random());
    let mut ask = |what, index| read(medium, address, &mut client, what, index);
    let malformed = |what| move |error| ProfinetError::Malformed { what, error };
    let (im0, real) = ("Read of I&M0", "Read of the modules");
    Ok(Identity {
        im0: ask(im0, index::IM0).and_then(|bytes| Im0::parse(&bytes).map_err(malformed(im0))),
        modules: ask(real, index::REAL_IDENTIFICATION)
            .and_then(|bytes| record::parse_identification(&bytes).map_err(malformed(real))),
    })
}

fn read(
    medium: &mut dyn Medium,
    target: Ipv4Addr,
    client: &mut Client,
    what: &'static str,
    index: u16,
) -> Result<Vec<u8>, ProfinetError> {
    let asked = Record { sequence: 0, ar: Uuid::NIL, api: 0, slot: 0, subslot: 1, index, length: ROOM };
    let blocks = asked.emit(BlockType::READ, 0, &[]);
    match exchange(medium, target, client, &blocks)? {
        Outcome::Answer(0, blocks) => {
            let (_, record) =
                Record::parse_answer(&blocks).map_err(|error| ProfinetError::Malformed { what, error })?;
            Ok(record.to_vec())
        }
        Outcome::Answer(status, _) => Err(ProfinetError::Refused { what, status: Status(status) }),
        Outcome::Rejected(status) => Err(ProfinetError::Rejected { what, status }),
        Outcome::Malformed(error) => Err(ProfinetError::Malformed { what, error }),
        Outcome::Silent(after) => Err(ProfinetError::NoAnswer { what, after }),
    }
}

/// Calls, and waits for what comes of it.
fn exchange(
    medium: &mut dyn Medium,
    target: Ipv4Addr,
    client: &mut Client,
    blocks: &[u8],
) -> Result<Outcome, ProfinetError> {
    let first = client.call(medium.now(), operation::READ_IMPLICIT, blocks, TRIES);
    medium.call(target, &first)?;
    loop {
        let mut step = client.poll(medium.now());
        if step.is_none() {
            let wake = client.wake().unwrap_or_default();
            if let Some(Arrived::Datagram(from, bytes)) = medium.next(wake)?
                && *from.ip() == target
            {
                let datagram = Datagram::parse(&bytes).ok();
                step = datagram.and_then(|datagram| client.handle(medium.now(), &datagram));
            }
        }
        match step {
            Some(Step::Done(outcome)) => return Ok(outcome),
            Some(Step::Send(bytes)) => medium.call(target, &bytes)?,
            None => {}
        }
    }
}

fn identify(medium: &mut dyn Medium, request: &Dcp) -> Result<(), ProfinetError> {
    let here = medium.here().0;
    medium.send(&identify_frame(here, request))
}

/// The next station that answers a question.
fn identified(medium: &mut dyn Medium, until: Now, request: &Dcp) -> Result<Option<Found>, ProfinetError> {
    let here = medium.here().0;
    hear(medium, until, |frame| {
        let dcp = Dcp::parse(frame.payload).ok()?;
        let is_answer = dcp.service == Service::Identify && dcp.kind == Kind::Response && dcp.xid == request.xid;
        let is_one = is_answer && frame.destination == here && !frame.source.is_group();
        dcp.station().ok().filter(|_| is_one).map(|station| Found { mac: frame.source, station })
    })
}

/// Hands on each frame that comes until something is made of one, or time is over.
fn hear<T>(
    medium: &mut dyn Medium,
    until: Now,
    mut take: impl FnMut(&Frame<'_>) -> Option<T>,
) -> Result<Option<T>, ProfinetError> {
    while let Some(arrived) = medium.next(until)? {
        let Arrived::Frame(bytes) = arrived else { continue };
        if let Some(made) = Frame::parse(&bytes).ok().and_then(|frame| take(&frame)) {
            return Ok(Some(made));
        }
    }
    Ok(None)
}

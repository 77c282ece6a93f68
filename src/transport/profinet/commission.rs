//! Services of a station that need no connection: discovery, names, addresses, records.
//!
//! All calls block the thread until their time limit.

use std::net::{Ipv4Addr, SocketAddrV4};
use std::time::Duration;

use super::Now;
use super::controller::client::{Client, Outcome, Step};
use super::error::ProfinetError;
use super::interface::Interface;
use super::port::{Calls, Frames};
use super::settings;
use super::wire::block::BlockType;
use super::wire::dcp::{Block, Dcp, Kind, Service, Station};
use super::wire::frame::{Frame, id};
use super::wire::record::{self, Im0, RealModule, Record, index};
use super::wire::rpc::{self, Datagram, operation};
use super::wire::{Mac, Uuid, arp};

/// Time within which stations answer a broadcast, in steps of 10 ms. Each station waits for its own delay.
const RESPONSE_WINDOW: u16 = 128;
/// Time limit per attempt to reach a single station. The constant below is the number of attempts.
const ATTEMPT_TIMEOUT: Duration = Duration::from_secs(1);
const TRIES: u32 = 3;
/// Waiting time after the first answer, in which a second station with the same name can answer.
const DUPLICATE_WINDOW: Duration = Duration::from_millis(250);
/// Time limit of each ARP attempt.
const ARP: Duration = Duration::from_millis(300);
/// Interval of the checks whether a setting is active. The constant below is the time limit of these checks.
const CHECK_INTERVAL: Duration = Duration::from_millis(200);
const SETTLE_TIMEOUT: Duration = Duration::from_secs(5);
/// Maximum number of reported stations. A network has a few hundred.
const MAX_STATIONS: usize = 4096;
/// Size in bytes of the buffer for a record.
const RECORD_BUFFER_SIZE: u32 = 4000;

/// A station that answered. The texts from the station are untrusted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StationInfo {
    /// MAC address.
    pub mac: Mac,
    /// Data that the station reports.
    pub station: Station,
}

/// Finds all stations of a network.
pub fn stations(interface: &Interface, wait: Duration) -> Result<Vec<StationInfo>, ProfinetError> {
    let frames = Frames::open(interface)?;
    let question = Dcp::identify_all(fastrand::u32(1..), RESPONSE_WINDOW);
    frames.send(&identify(interface.mac, &question))?;
    let until = frames.now() + wait;
    let mut found: Vec<StationInfo> = Vec::new();
    while let Some(other) = parse_identified(interface, &frames, until, &question)? {
        if found.len() < MAX_STATIONS && found.iter().all(|found| found.mac != other.mac) {
            found.push(other);
        }
    }
    found.sort_by(|one, two| (&one.station.name, one.mac).cmp(&(&two.station.name, two.mac)));
    Ok(found)
}

/// Finds one station by name or MAC address.
///
/// # Errors
/// The interface cannot be used, the station does not answer, or two stations have the same name.
pub fn find(interface: &Interface, wanted: &settings::Station) -> Result<StationInfo, ProfinetError> {
    let frames = Frames::open(interface)?;
    for _ in 0..TRIES {
        let question = search_filter(wanted, fastrand::u32(1..));
        frames.send(&identify(interface.mac, &question))?;
        let mut until = frames.now() + ATTEMPT_TIMEOUT;
        let mut first: Option<StationInfo> = None;
        while let Some(found) = parse_identified(interface, &frames, until, &question)? {
            let is_it = match wanted {
                settings::Station::Name(name) => found.station.name == *name,
                settings::Station::Mac(mac) => found.mac == *mac,
            };
            match &first {
                _ if !is_it => {}
                // A MAC address is unique, so the search for a second station is not needed.
                None if matches!(wanted, settings::Station::Mac(_)) => return Ok(found),
                None => {
                    until = until.min(frames.now() + DUPLICATE_WINDOW);
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
    Err(ProfinetError::NotFound { station: wanted.to_string(), after: ATTEMPT_TIMEOUT * TRIES })
}

/// Searches for another station with the same name as the station `than`, and returns its MAC address.
pub fn find_duplicate(
    interface: &Interface,
    named: &settings::Station,
    than: Mac,
) -> Result<Option<Mac>, ProfinetError> {
    let frames = Frames::open(interface)?;
    for _ in 0..TRIES {
        let question = search_filter(named, fastrand::u32(1..));
        frames.send(&identify(interface.mac, &question))?;
        let until = frames.now() + DUPLICATE_WINDOW;
        while let Some(found) = parse_identified(interface, &frames, until, &question)? {
            if found.mac != than && settings::Station::Name(found.station.name) == *named {
                return Ok(Some(found.mac));
            }
        }
    }
    Ok(None)
}

/// Returns the DCP request that searches for a station. If the station is identified by its MAC address, the request
/// goes to all stations, because not every station supports Get.
pub fn search_filter(wanted: &settings::Station, xid: u32) -> Dcp {
    match wanted {
        settings::Station::Name(name) => Dcp::identify(xid, name),
        settings::Station::Mac(_) => Dcp::identify_all(xid, 1),
    }
}

/// Returns the frame of a DCP Identify request.
pub fn identify(source: Mac, question: &Dcp) -> Vec<u8> {
    let payload = question.emit();
    Frame { destination: Mac::DCP_IDENTIFY, source, tag: None, id: id::DCP_IDENTIFY, payload: &payload }.emit()
}

/// Returns the frame of a DCP Set request.
pub fn set(source: Mac, destination: Mac, xid: u32, block: &Block) -> Vec<u8> {
    let payload = Dcp::change(xid, vec![block.clone()]).emit();
    Frame { destination, source, tag: None, id: id::DCP_GET_SET, payload: &payload }.emit()
}

/// Sets a value of a station: the name, the address, or blinking. Without an answer, the request is sent up to three
/// times. A repetition is harmless.
pub fn change(interface: &Interface, mac: Mac, what: &'static str, block: &Block) -> Result<(), ProfinetError> {
    let frames = Frames::open(interface)?;
    let request = set(interface.mac, mac, fastrand::u32(1..), block);
    for _ in 0..TRIES {
        frames.send(&request)?;
        let answer = frames.hear(frames.now() + ATTEMPT_TIMEOUT, |frame| {
            let is_its = frame.source == mac && frame.destination == interface.mac && frame.id == id::DCP_GET_SET;
            // The Xid (transaction id) is not checked, because some stations do not copy it into the answer.
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
    Err(ProfinetError::NoAnswer { what, after: ATTEMPT_TIMEOUT * TRIES })
}

/// Waits until the station reports the new value.
///
/// # Errors
/// The station did not report the new value within some seconds, or the interface cannot be used.
pub fn wait_until_active(
    interface: &Interface,
    mac: Mac,
    what: &'static str,
    is_so: impl Fn(&Station) -> bool,
) -> Result<StationInfo, ProfinetError> {
    let frames = Frames::open(interface)?;
    let end = frames.now() + SETTLE_TIMEOUT;
    while frames.now() < end {
        let question = search_filter(&settings::Station::Mac(mac), fastrand::u32(1..));
        frames.send(&identify(interface.mac, &question))?;
        let until = frames.now() + CHECK_INTERVAL;
        while let Some(found) = parse_identified(interface, &frames, until, &question)? {
            if found.mac == mac && is_so(&found.station) {
                return Ok(found);
            }
        }
    }
    Err(ProfinetError::NoAnswer { what, after: SETTLE_TIMEOUT })
}

/// Returns the MAC address of a station, other than `except`, that answers an ARP request for this IP address.
pub fn holder(interface: &Interface, address: Ipv4Addr, except: Mac) -> Result<Option<Mac>, ProfinetError> {
    // The operating system of this computer does not answer an ARP request from this computer itself.
    if interface.ip.is_some_and(|own| own.address == address) {
        return Ok(Some(interface.mac));
    }
    let frames = Frames::of_arp(interface)?;
    for _ in 0..TRIES {
        frames.send(&arp::probe(interface.mac, address))?;
        let until = frames.now() + ARP;
        while let Some(bytes) = frames.next(until)? {
            if let Some((mac, _)) = arp::holder(&bytes).filter(|(mac, held)| *held == address && *mac != except) {
                return Ok(Some(mac));
            }
        }
    }
    Ok(None)
}

/// Returns the next station that answers.
fn parse_identified(
    interface: &Interface,
    frames: &Frames,
    until: Now,
    question: &Dcp,
) -> Result<Option<StationInfo>, ProfinetError> {
    frames.hear(until, |frame| {
        let dcp = Dcp::parse(frame.payload).ok()?;
        let is_answer = dcp.service == Service::Identify && dcp.kind == Kind::Response && dcp.xid == question.xid;
        let is_one = is_answer && frame.destination == interface.mac && !frame.source.is_group();
        dcp.station().ok().filter(|_| is_one).map(|station| StationInfo { mac: frame.source, station })
    })
}

/// Identity records of a device. Each record has its own result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// I&M0 record: order number, serial number and revisions of the device.
    pub im0: Result<Im0, ProfinetError>,
    /// Modules that are really plugged into the device.
    pub modules: Result<Vec<RealModule>, ProfinetError>,
}

/// Reads the identity and module records of a device without a connection.
///
/// # Errors
/// No socket can be opened. If the device refuses a record or does not answer, the field of this record contains the
/// error.
pub fn identity(interface: &Interface, found: &StationInfo) -> Result<Identity, ProfinetError> {
    let station = || format!("station '{}'", found.station.name);
    let address = found.station.address().ok_or_else(|| ProfinetError::NoAddress(station()))?;
    let calls = Calls::open(interface, found.mac, SocketAddrV4::new(address, rpc::PORT))?;
    let (vendor, device) = found.station.id.unwrap_or_default();
    let object = rpc::object(found.station.instance.unwrap_or(1), device, vendor);
    let mut client = Client::new(object, Uuid::random());
    let mut ask = |what, index| read(&calls, &mut client, what, index);
    let malformed = |what| move |error| ProfinetError::Malformed { what, error };
    let (im0, real) = ("Read of I&M0", "Read of the modules");
    Ok(Identity {
        im0: ask(im0, index::IM0).and_then(|bytes| Im0::parse(&bytes).map_err(malformed(im0))),
        modules: ask(real, index::REAL_IDENTIFICATION)
            .and_then(|bytes| record::parse_identification(&bytes).map_err(malformed(real))),
    })
}

fn read(calls: &Calls, client: &mut Client, what: &'static str, index: u16) -> Result<Vec<u8>, ProfinetError> {
    let asked = Record { sequence: 0, ar: Uuid::NIL, api: 0, slot: 0, subslot: 1, index, length: RECORD_BUFFER_SIZE };
    let blocks = asked.emit(BlockType::READ, 0, &[]);
    let blocks = exchange(calls, client, &blocks)?.blocks(what)?;
    let (_, record) = Record::parse_answer(&blocks).map_err(|error| ProfinetError::Malformed { what, error })?;
    Ok(record.to_vec())
}

fn exchange(calls: &Calls, client: &mut Client, blocks: &[u8]) -> Result<Outcome, ProfinetError> {
    calls.send(&client.call(calls.now(), operation::READ_IMPLICIT, blocks, TRIES))?;
    loop {
        let mut step = client.poll(calls.now());
        if step.is_none()
            && let Some(bytes) = calls.hear(client.wake().unwrap_or_default())?
        {
            let datagram = Datagram::parse(&bytes).ok();
            step = datagram.and_then(|datagram| client.handle(calls.now(), &datagram));
        }
        match step {
            Some(Step::Done(outcome)) => return Ok(outcome),
            Some(Step::Send(bytes)) => calls.send(&bytes)?,
            None => {}
        }
    }
}

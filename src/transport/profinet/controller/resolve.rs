//! Name resolution: finds the device by name or MAC address, and sets its IP address if requested.

use std::net::Ipv4Addr;
use std::time::Duration;

use super::super::Now;
use super::super::error::ProfinetError;
use super::super::settings::Station;
use super::super::wire::Mac;
use super::super::wire::dcp::{self, Block, Dcp, IpSuite, Kind, Service, Setting};
use super::super::wire::frame::{Frame, id};
use super::view::{Device, State, Step};
use super::{Action, Controller, Phase};

/// Time limit per attempt. The constant below is the number of attempts.
const ATTEMPT_TIMEOUT: Duration = Duration::from_secs(1);
const TRIES: u32 = 3;
/// Waiting time after the first answer, in which a second device with the same name can answer.
const DUPLICATE_WINDOW: Duration = Duration::from_millis(250);
/// Interval of the checks whether an address is active. The constant below is the time limit of these checks.
const CHECK_INTERVAL: Duration = Duration::from_millis(100);
const SETTLE_TIMEOUT: Duration = Duration::from_secs(5);

/// State of the search for the device.
#[derive(Debug)]
pub(super) struct Search {
    xid: u32,
    tries: u32,
    until: Now,
    found: Option<ResolvedStation>,
}

#[derive(Debug, Clone)]
struct ResolvedStation {
    mac: Mac,
    station: dcp::Station,
}

impl Search {
    pub(super) const fn wake(&self) -> Now {
        self.until
    }
}

/// State of the assignment of an IP address.
#[derive(Debug)]
pub(super) struct Address {
    found: ResolvedStation,
    suite: IpSuite,
    xid: u32,
    tries: u32,
    until: Now,
    /// Time limit for the address to become active; `None` before the answer to Set.
    active_until: Option<Now>,
}

impl Address {
    pub(super) const fn wake(&self) -> Now {
        self.until
    }
}

impl Controller {
    pub(super) fn resolve(&mut self, now: Now) {
        self.device = None;
        if self.view.generation == 0 {
            self.show(State::Opening);
        }
        self.set_step(Step::Resolve);
        let xid = self.identifiers.xid();
        self.phase = Phase::Resolve(Search { xid, tries: TRIES - 1, until: now + ATTEMPT_TIMEOUT, found: None });
        self.ask_who(xid);
    }

    fn ask_who(&mut self, xid: u32) {
        let dcp = match &self.settings.station {
            Station::Name(name) => Dcp::identify(xid, name),
            Station::Mac(_) => Dcp::identify_all(xid, 1),
        };
        self.send_dcp(Mac::DCP_IDENTIFY, id::DCP_IDENTIFY, &dcp);
    }

    fn send_dcp(&mut self, destination: Mac, frame_id: u16, dcp: &Dcp) {
        let payload = dcp.emit();
        let frame = Frame { destination, source: self.local_address.mac, tag: None, id: frame_id, payload: &payload };
        self.actions.push_back(Action::Frame(frame.emit()));
    }

    /// Continues after the time limit of the search: uses the device that was found, or repeats the request.
    pub(super) fn search_on(&mut self, now: Now) {
        let Phase::Resolve(search) = &mut self.phase else { return };
        if let Some(found) = search.found.take() {
            self.found(now, found);
        } else if search.tries == 0 {
            self.handle_loss(now, ProfinetError::NotFound { station: self.station(), after: ATTEMPT_TIMEOUT * TRIES });
        } else {
            search.tries -= 1;
            search.until = now + ATTEMPT_TIMEOUT;
            let xid = search.xid;
            self.ask_who(xid);
        }
    }

    fn found(&mut self, now: Now, found: ResolvedStation) {
        let has = found.station.address();
        match self.settings.ip {
            Some(suite) if has != Some(suite.address) => self.set_address(now, found, suite),
            _ => match has {
                None => self.handle_loss(now, ProfinetError::NoAddress(self.station())),
                Some(address) => self.end_search(now, &found, address),
            },
        }
    }

    fn set_address(&mut self, now: Now, found: ResolvedStation, suite: IpSuite) {
        if !self.local_address.ip.is_same_network(suite.address) {
            let (station, device, local_address) = (self.station(), suite.address, self.local_address.ip.address);
            return self.handle_loss(now, ProfinetError::OtherNetwork { station, device, local_address });
        }
        self.set_step(Step::Address);
        let xid = self.identifiers.xid();
        let mac = found.mac;
        let address = Address { found, suite, xid, tries: TRIES - 1, until: now + ATTEMPT_TIMEOUT, active_until: None };
        self.phase = Phase::Address(address);
        self.send_set(mac, xid, &suite);
    }

    fn send_set(&mut self, mac: Mac, xid: u32, suite: &IpSuite) {
        let dcp = Dcp::change(xid, vec![Block::set_ip(suite, false)]);
        self.send_dcp(mac, id::DCP_GET_SET, &dcp);
    }

    /// Continues after a time limit: repeats a Set that was not answered, or checks whether the address is active.
    pub(super) fn address_on(&mut self, now: Now) {
        const SERVICE_NAME: &str = "DCP Set IP";
        let Phase::Address(address) = &mut self.phase else { return };
        let (mac, suite) = (address.found.mac, address.suite);
        match address.active_until {
            Some(until) if until <= now => {
                self.handle_loss(now, ProfinetError::NoAnswer { what: SERVICE_NAME, after: SETTLE_TIMEOUT });
            }
            Some(_) => {
                address.until = now + CHECK_INTERVAL;
                let xid = self.identifiers.xid();
                if let Phase::Address(address) = &mut self.phase {
                    address.xid = xid;
                }
                self.ask_who(xid);
            }
            None if address.tries == 0 => {
                self.handle_loss(now, ProfinetError::NoAnswer { what: SERVICE_NAME, after: ATTEMPT_TIMEOUT * TRIES });
            }
            None => {
                address.tries -= 1;
                address.until = now + ATTEMPT_TIMEOUT;
                let xid = address.xid;
                self.send_set(mac, xid, &suite);
            }
        }
    }

    /// Handles a DCP frame that may be an answer.
    pub(super) fn handle_dcp(&mut self, now: Now, frame: &Frame<'_>) {
        if frame.destination != self.local_address.mac {
            return;
        }
        let Ok(dcp) = Dcp::parse(frame.payload) else { return };
        if dcp.kind == Kind::Request {
            return;
        }
        match dcp.service {
            Service::Identify => self.identified(now, frame.source, &dcp),
            Service::Set => self.was_set(now, frame.source, &dcp),
            Service::Get | Service::Hello => {}
        }
    }

    fn identified(&mut self, now: Now, mac: Mac, dcp: &Dcp) {
        let Ok(station) = dcp.station() else { return };
        let is_it = !mac.is_group()
            && match &self.settings.station {
                Station::Name(name) => station.name == *name,
                Station::Mac(wanted) => mac == *wanted,
            };
        if !is_it {
            return;
        }
        match &mut self.phase {
            Phase::Resolve(search) if dcp.xid == search.xid => match &search.found {
                // A MAC address is unique, so the search for a second device is not needed.
                None if matches!(self.settings.station, Station::Mac(_)) => {
                    self.found(now, ResolvedStation { mac, station });
                }
                None => {
                    search.found = Some(ResolvedStation { mac, station });
                    search.until = now + DUPLICATE_WINDOW;
                }
                Some(first) if first.mac != mac => {
                    let cards = (first.mac, mac);
                    self.handle_loss(now, ProfinetError::Duplicate { station: self.station(), cards });
                }
                Some(_) => {}
            },
            Phase::Address(address)
                if address.active_until.is_some()
                    && dcp.xid == address.xid
                    && mac == address.found.mac
                    && station.address() == Some(address.suite.address) =>
            {
                let found = ResolvedStation { mac, station };
                let address = address.suite.address;
                self.end_search(now, &found, address);
            }
            _ => {}
        }
    }

    fn was_set(&mut self, now: Now, mac: Mac, dcp: &Dcp) {
        // The Xid (transaction id) is not checked, because some devices do not copy it into this answer.
        let Phase::Address(address) = &mut self.phase else { return };
        if mac != address.found.mac || address.active_until.is_some() {
            return;
        }
        let outcome = dcp.outcomes().into_iter().find(|(setting, _)| *setting == Setting::IP);
        let error = if dcp.kind == Kind::Unsupported { Some(1) } else { outcome.map(|(_, error)| error) };
        match error {
            Some(0) => {
                address.active_until = Some(now + SETTLE_TIMEOUT);
                address.until = now + CHECK_INTERVAL;
            }
            Some(error) => self.handle_loss(now, ProfinetError::Dcp { what: "DCP Set IP", error }),
            None => {}
        }
    }

    /// Continues with the opening, because the device was found and has its address.
    fn end_search(&mut self, now: Now, found: &ResolvedStation, address: Ipv4Addr) {
        let station = self.station();
        if found.station.ip.is_some_and(|(_, origin)| origin.is_in_conflict()) {
            return self.handle_loss(now, ProfinetError::AddressConflict { station, address });
        }
        let local_address = self.local_address.ip.address;
        if !self.local_address.ip.is_same_network(address) || address == local_address {
            return self.handle_loss(now, ProfinetError::OtherNetwork { station, device: address, local_address });
        }
        let id = found.station.id.unwrap_or_default();
        let instance = found.station.instance.unwrap_or(1);
        let name = found.station.name.clone();
        self.device = Some(Device { mac: found.mac, name, address, id });
        self.connect(now, instance);
    }
}

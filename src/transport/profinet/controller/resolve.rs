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
const PATIENCE: Duration = Duration::from_secs(1);
const TRIES: u32 = 3;
/// Waiting time after the first answer, in which a second device with the same name can answer.
const TWIN: Duration = Duration::from_millis(250);
/// Interval of the checks whether an address is active. The constant below is the time limit of these checks.
const LOOK: Duration = Duration::from_millis(100);
const SETTLE: Duration = Duration::from_secs(5);

/// State of the search for the device.
#[derive(Debug)]
pub(super) struct Search {
    xid: u32,
    tries: u32,
    until: Now,
    found: Option<Found>,
}

#[derive(Debug, Clone)]
struct Found {
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
    found: Found,
    suite: IpSuite,
    xid: u32,
    tries: u32,
    until: Now,
    /// Time limit for the address to become active; `None` before the answer to Set.
    settle: Option<Now>,
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
        let xid = self.numbers.xid();
        self.phase = Phase::Resolve(Search { xid, tries: TRIES - 1, until: now + PATIENCE, found: None });
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
        let frame = Frame { destination, source: self.here.mac, tag: None, id: frame_id, payload: &payload };
        self.actions.push_back(Action::Frame(frame.emit()));
    }

    /// Continues after the time limit of the search: uses the device that was found, or repeats the request.
    pub(super) fn search_on(&mut self, now: Now) {
        let Phase::Resolve(search) = &mut self.phase else { return };
        if let Some(found) = search.found.take() {
            self.found(now, found);
        } else if search.tries == 0 {
            self.lost(now, ProfinetError::NotFound { station: self.station(), after: PATIENCE * TRIES });
        } else {
            search.tries -= 1;
            search.until = now + PATIENCE;
            let xid = search.xid;
            self.ask_who(xid);
        }
    }

    fn found(&mut self, now: Now, found: Found) {
        let has = found.station.address();
        match self.settings.ip {
            Some(suite) if has != Some(suite.address) => self.set_address(now, found, suite),
            _ => match has {
                None => self.lost(now, ProfinetError::NoAddress { station: self.station() }),
                Some(address) => self.located(now, &found, address),
            },
        }
    }

    fn set_address(&mut self, now: Now, found: Found, suite: IpSuite) {
        if !self.here.ip.reaches(suite.address) {
            let (station, device, here) = (self.station(), suite.address, self.here.ip.address);
            return self.lost(now, ProfinetError::OtherNetwork { station, device, here });
        }
        self.set_step(Step::Address);
        let xid = self.numbers.xid();
        let mac = found.mac;
        let address = Address { found, suite, xid, tries: TRIES - 1, until: now + PATIENCE, settle: None };
        self.phase = Phase::Address(address);
        self.send_set(mac, xid, &suite);
    }

    fn send_set(&mut self, mac: Mac, xid: u32, suite: &IpSuite) {
        let dcp = Dcp::change(xid, vec![Block::set_ip(suite, false)]);
        self.send_dcp(mac, id::DCP_GET_SET, &dcp);
    }

    /// Continues after a time limit: repeats a Set that was not answered, or checks whether the address is active.
    pub(super) fn address_on(&mut self, now: Now) {
        const WHAT: &str = "DCP Set IP";
        let Phase::Address(address) = &mut self.phase else { return };
        let (mac, suite) = (address.found.mac, address.suite);
        match address.settle {
            Some(until) if until <= now => {
                self.lost(now, ProfinetError::NoAnswer { what: WHAT, after: SETTLE });
            }
            Some(_) => {
                address.until = now + LOOK;
                let xid = self.numbers.xid();
                if let Phase::Address(address) = &mut self.phase {
                    address.xid = xid;
                }
                self.ask_who(xid);
            }
            None if address.tries == 0 => {
                self.lost(now, ProfinetError::NoAnswer { what: WHAT, after: PATIENCE * TRIES });
            }
            None => {
                address.tries -= 1;
                address.until = now + PATIENCE;
                let xid = address.xid;
                self.send_set(mac, xid, &suite);
            }
        }
    }

    /// Handles a DCP frame that may be an answer.
    pub(super) fn heard_dcp(&mut self, now: Now, frame: &Frame<'_>) {
        if frame.destination != self.here.mac {
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
                None if matches!(self.settings.station, Station::Mac(_)) => self.found(now, Found { mac, station }),
                None => {
                    search.found = Some(Found { mac, station });
                    search.until = now + TWIN;
                }
                Some(first) if first.mac != mac => {
                    let cards = (first.mac, mac);
                    self.lost(now, ProfinetError::Duplicate { station: self.station(), cards });
                }
                Some(_) => {}
            },
            Phase::Address(address)
                if address.settle.is_some()
                    && dcp.xid == address.xid
                    && mac == address.found.mac
                    && station.address() == Some(address.suite.address) =>
            {
                let found = Found { mac, station };
                let address = address.suite.address;
                self.located(now, &found, address);
            }
            _ => {}
        }
    }

    fn was_set(&mut self, now: Now, mac: Mac, dcp: &Dcp) {
        // The Xid (transaction id) is not checked, because some devices do not copy it into this answer.
        let Phase::Address(address) = &mut self.phase else { return };
        if mac != address.found.mac || address.settle.is_some() {
            return;
        }
        let outcome = dcp.outcomes().into_iter().find(|(setting, _)| *setting == Setting::IP);
        let error = if dcp.kind == Kind::Unsupported { Some(1) } else { outcome.map(|(_, error)| error) };
        match error {
            Some(0) => {
                address.settle = Some(now + SETTLE);
                address.until = now + LOOK;
            }
            Some(error) => self.lost(now, ProfinetError::Dcp { what: "DCP Set IP", error }),
            None => {}
        }
    }

    /// Continues with the opening, because the device was found and has its address.
    fn located(&mut self, now: Now, found: &Found, address: Ipv4Addr) {
        let station = self.station();
        if found.station.ip.is_some_and(|(_, origin)| origin.is_in_conflict()) {
            return self.lost(now, ProfinetError::AddressConflict { station, address });
        }
        let here = self.here.ip.address;
        if !self.here.ip.reaches(address) || address == here {
            return self.lost(now, ProfinetError::OtherNetwork { station, device: address, here });
        }
        let id = found.station.id.unwrap_or_default();
        let instance = found.station.instance.unwrap_or(1);
        let name = found.station.name.clone();
        self.device = Some(Device { mac: found.mac, name, address, id });
        self.connect(now, instance);
    }
}

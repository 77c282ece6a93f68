//! DeviceNet master: its own MAC, and connections to any number of slaves on one adapter. The master has no sockets and
//! no clock.

use std::collections::{BTreeMap, VecDeque};
use std::time::Duration;

use super::Now;
use super::can::{BusState, Frame, Health};
use super::error::Error;
use super::settings::Settings;
use super::wire::{Answer, DuplicateCheck, Id, Mac, Request};

mod connection;
mod finder;
mod polling;
mod transaction;
mod view;

use self::connection::Connection;
pub use self::finder::DiscoveredNode;
use self::finder::Finder;
pub use self::view::{Details, Input, State, Statistics, View, Views};

/// Interval of the duplicate MAC checks. After the last check, the master waits for the same time.
const CHECK: Duration = Duration::from_secs(1);
/// Number of duplicate MAC checks.
const CHECKS: u8 = 2;

/// Number that identifies a request of a caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Token(pub u64);

/// Result of a request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reply {
    /// Number of the connection.
    pub connection: u64,
    /// Token of the request.
    pub token: Token,
    /// The answer or error.
    pub result: Result<Answer, Error>,
}

/// Identity of the master.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Identity {
    /// MAC of the master.
    pub mac: Mac,
    /// Vendor id.
    pub vendor: u16,
    /// Serial number.
    pub serial: u32,
}

/// Observed state of the bus.
#[derive(Debug)]
pub(crate) struct Bus {
    pub(crate) health: Health,
    /// Time of the last frame from each MAC; the index is the MAC.
    last_frame_at: [Option<Now>; 64],
}

impl Bus {
    /// Whether the node `mac` has sent a frame after `since`.
    pub(crate) fn is_heard(&self, mac: Mac, since: Now) -> bool {
        self.last_frame_at[usize::from(mac.number())].is_some_and(|heard| heard >= since)
    }

    /// Whether a node other than `mac` has sent a frame after `since`.
    pub(crate) fn is_alive_without(&self, mac: Mac, since: Now) -> bool {
        let others = self.last_frame_at.iter().enumerate().filter(|(number, _)| *number != usize::from(mac.number()));
        others.filter_map(|(_, heard)| *heard).any(|heard| heard >= since)
    }
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Phase {
    /// The master has not been polled yet, or the adapter was opened again.
    New,
    /// The master checks its MAC. Contains the number of checks that were sent, and the time of the next step.
    Checking(u8, Now),
    OnLine,
    /// The master is off the bus for this reason.
    Failed(Error),
}

/// A DeviceNet master on one adapter.
#[derive(Debug)]
pub struct Scanner {
    identity: Identity,
    phase: Phase,
    bus: Bus,
    connections: BTreeMap<u64, Connection>,
    finder: Option<Finder>,
    found: Option<Vec<DiscoveredNode>>,
    outbox: VecDeque<Frame>,
    replies: VecDeque<Reply>,
}

impl Scanner {
    /// Creates a master that is not on line yet.
    pub const fn new(identity: Identity) -> Self {
        let health = Health { state: BusState::Active, overruns: 0, rejected: 0 };
        Self {
            identity,
            phase: Phase::New,
            bus: Bus { health, last_frame_at: [None; 64] },
            connections: BTreeMap::new(),
            finder: None,
            found: None,
            outbox: VecDeque::new(),
            replies: VecDeque::new(),
        }
    }

    /// Identity of the master.
    pub const fn identity(&self) -> Identity {
        self.identity
    }

    /// Whether the duplicate MAC check has passed.
    pub fn is_on_line(&self) -> bool {
        self.phase == Phase::OnLine
    }

    /// Opens a connection with a new number.
    ///
    /// # Errors
    /// The settings are invalid, or there is already a connection to the slave.
    pub fn open(&mut self, number: u64, settings: Settings) -> Result<(), Error> {
        settings.check(self.identity.mac)?;
        if let Phase::Failed(error) = &self.phase {
            return Err(error.clone());
        }
        if self.bus.health.state == BusState::Off {
            return Err(Error::BusOff);
        }
        if self.connections.values().any(|connection| connection.slave() == settings.slave) {
            let mac = settings.slave;
            return Err(Error::Settings(format!("this process already has a connection with MAC {mac}")));
        }
        self.connections.insert(number, Connection::new(self.identity.mac, settings));
        Ok(())
    }

    /// State of a connection; `None` if the connection has ended and was removed.
    pub fn view(&self, number: u64) -> Option<&View> {
        self.connections.get(&number).map(Connection::view)
    }

    /// Returns the connections whose view has changed after the last call.
    pub fn changed(&mut self) -> Vec<u64> {
        self.connections
            .iter_mut()
            .filter_map(|(number, connection)| connection.take_changed().then_some(*number))
            .collect()
    }

    /// Sends this image, starting with the next poll. Returns the number of the change. When `sent` of the view has
    /// reached this number, the slave has accepted the image.
    ///
    /// # Errors
    /// The connection is not open in this generation, or the image has another size.
    pub fn set_image(&mut self, number: u64, generation: u32, image: &[u8]) -> Result<u64, Error> {
        self.connections.get_mut(&number).ok_or(Error::Ended)?.set_image(generation, image)
    }

    /// Queues an explicit request; [`reply`](Self::reply) returns the answer.
    pub fn ask(&mut self, number: u64, token: Token, request: Request) {
        match self.connections.get_mut(&number) {
            Some(connection) => connection.ask(token, request),
            None => self.replies.push_back(Reply { connection: number, token, result: Err(Error::Ended) }),
        }
    }

    /// Returns the next answer.
    pub fn reply(&mut self) -> Option<Reply> {
        self.replies.pop_front()
    }

    /// Closes a connection.
    pub fn close(&mut self, now: Now, number: u64) {
        if let Some(connection) = self.connections.get_mut(&number) {
            connection.close(now);
        }
    }

    /// Starts node discovery without connections; [`found`](Self::found) returns the result.
    pub fn find(&mut self, now: Now) {
        self.found = None;
        self.finder = Some(Finder::new(now, self.identity));
        self.give_up_search();
    }

    /// Ends the discovery if the adapter is in the state bus-off, because it can then send no checks.
    fn give_up_search(&mut self) {
        if self.bus.health.state == BusState::Off
            && let Some(finder) = self.finder.take()
        {
            self.found = Some(finder.found());
        }
    }

    /// Returns the result of the last discovery; `None` until the discovery is complete.
    pub fn found(&mut self) -> Option<Vec<DiscoveredNode>> {
        self.found.take()
    }

    /// Reason why the master is permanently off the bus.
    pub const fn failure(&self) -> Option<&Error> {
        match &self.phase {
            Phase::Failed(error) => Some(error),
            _ => None,
        }
    }

    /// Handles the opening of the adapter. The master checks its MAC again before it sends anything else.
    pub fn restart(&mut self) {
        self.phase = Phase::New;
        self.bus.health = Health::default();
        self.outbox.clear();
    }

    /// Handles a failure of the adapter. Open connections wait until the adapter is open again.
    pub fn fail(&mut self, now: Now, error: &Error) {
        for connection in self.connections.values_mut() {
            connection.fail(now, error.clone());
        }
        (self.finder, self.phase) = (None, Phase::Failed(error.clone()));
        self.outbox.clear();
        self.collect_results();
    }

    /// Handles a health report of the adapter.
    pub fn handle_health(&mut self, now: Now, health: Health) {
        let was_off = std::mem::replace(&mut self.bus.health, health).state == BusState::Off;
        if health.state == BusState::Off && !was_off {
            for connection in self.connections.values_mut() {
                connection.fail(now, Error::BusOff);
            }
            self.give_up_search();
            self.collect_results();
        }
    }

    /// Handles a frame from the bus.
    pub fn handle(&mut self, now: Now, frame: &Frame) {
        let Some(id) = Id::parse(frame.id()) else { return };
        if let Some(heard) = id.sender().and_then(|mac| self.bus.last_frame_at.get_mut(usize::from(mac.number()))) {
            *heard = Some(now);
        }
        match id {
            Id::Duplicate(mac) => {
                if let Some(check) = DuplicateCheck::parse(frame.data()) {
                    self.checked(now, mac, check);
                }
            }
            Id::Answer(mac) | Id::PollAnswer(mac) => {
                let Self { connections, bus, .. } = self;
                if let Some(connection) = connections.values_mut().find(|connection| connection.slave() == mac) {
                    connection.take(now, id, frame.data(), bus);
                }
                self.collect_results();
            }
            _ => {}
        }
    }

    /// Returns the next frame to send at `now`. The caller repeats the call until it returns `None`.
    pub fn poll(&mut self, now: Now) -> Option<Frame> {
        if self.outbox.is_empty() {
            self.advance(now);
        }
        self.outbox.pop_front()
    }

    /// Latest time of the next call of [`poll`](Self::poll).
    pub fn wake(&self) -> Option<Now> {
        if !self.outbox.is_empty() {
            return Some(Now::ZERO);
        }
        match self.phase {
            Phase::New => Some(Now::ZERO),
            Phase::Checking(_, due) => Some(due),
            // The adapter can send nothing until it has left the state bus-off.
            Phase::OnLine if self.bus.health.state == BusState::Off => None,
            Phase::OnLine => {
                let connections = self.connections.values().filter_map(Connection::wake);
                connections.chain(self.finder.as_ref().map(Finder::wake)).min()
            }
            Phase::Failed(_) => None,
        }
    }

    /// Removes connections that have ended and whose results were collected. Returns their numbers.
    pub fn clear(&mut self) -> Vec<u64> {
        let is_ended = |(number, connection): (&u64, &Connection)| connection.is_finished().then_some(*number);
        let ended: Vec<u64> = self.connections.iter().filter_map(is_ended).collect();
        self.connections.retain(|number, _| !ended.contains(number));
        ended
    }

    /// Whether the master has nothing to do: it has no connection and no discovery, or it is off the bus.
    pub fn is_idle(&self) -> bool {
        let is_off = matches!(self.phase, Phase::Failed(_)) || self.bus.health.state == BusState::Off;
        is_off || self.connections.is_empty() && self.finder.is_none()
    }

    fn advance(&mut self, now: Now) {
        match self.phase {
            Phase::New => self.ask_for_mac(now, 0),
            Phase::Checking(CHECKS, due) if now >= due => self.phase = Phase::OnLine,
            Phase::Checking(asked, due) if now >= due => self.ask_for_mac(now, asked),
            _ => {}
        }
        if self.phase != Phase::OnLine || self.bus.health.state == BusState::Off {
            return;
        }
        let Self { connections, bus, outbox, .. } = self;
        for connection in connections.values_mut() {
            connection.poll(now, bus, outbox);
        }
        if let Some(finder) = &mut self.finder {
            self.outbox.extend(finder.poll(now));
            if finder.is_over(now) {
                self.found = self.finder.take().map(Finder::found);
            }
        }
        self.collect_results();
    }

    fn ask_for_mac(&mut self, now: Now, asked: u8) {
        self.outbox.extend(self.check(false));
        self.phase = Phase::Checking(asked + 1, now + CHECK);
    }

    fn check(&self, is_answer: bool) -> Option<Frame> {
        let Identity { mac, vendor, serial } = self.identity;
        let check = DuplicateCheck { is_answer, port: 0, vendor, serial };
        Frame::new(Id::Duplicate(mac).emit(), &check.emit())
    }

    /// Handles a duplicate MAC check: a request or an answer.
    fn checked(&mut self, now: Now, mac: Mac, check: DuplicateCheck) {
        if let Some(finder) = &mut self.finder {
            finder.handle_check(now, mac, check);
        }
        if mac != self.identity.mac {
            return;
        }
        match self.phase {
            Phase::New | Phase::Checking(..) => {
                let DuplicateCheck { vendor, serial, .. } = check;
                let error = Error::Duplicate { mac, vendor, serial };
                self.fail(now, &error);
            }
            Phase::OnLine if !check.is_answer => self.outbox.extend(self.check(true)),
            Phase::OnLine | Phase::Failed(_) => {}
        }
    }

    fn collect_results(&mut self) {
        for (number, connection) in &mut self.connections {
            while let Some((token, result)) = connection.reply() {
                self.replies.push_back(Reply { connection: *number, token, result });
            }
        }
    }
}

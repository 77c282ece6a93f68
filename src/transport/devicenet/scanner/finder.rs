//! Node discovery without connections: every node that is on line answers a duplicate MAC check of its MAC.
//!
//! A node that is about to go on line would interpret such a check as a conflict, and stay off line. Therefore the
//! finder first listens for longer than the interval between the checks of a starting node. It then sends no check for
//! the MACs of the starting nodes that it has found.

use std::collections::BTreeMap;
use std::time::Duration;

use super::Identity;
use crate::devicenet::Now;
use crate::devicenet::can::Frame;
use crate::devicenet::wire::{DuplicateCheck, Id, Mac};

/// Time for which the finder listens before its first check. The constant below is the time after which a starting node
/// is on line: it sends two checks, one second apart, and goes on line one second later.
const LISTEN: Duration = Duration::from_millis(1200);
const GOING_ON_LINE: Duration = Duration::from_millis(2200);
/// Pause between checks, so that a slow adapter can keep up.
const PAUSE: Duration = Duration::from_millis(10);
/// Time limit for the answer to the last check.
const LAST_ANSWER_TIMEOUT: Duration = Duration::from_millis(300);
/// Number of checks per MAC.
const ROUNDS: u8 = 2;

/// A node that was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DiscoveredNode {
    /// MAC of the node.
    pub mac: Mac,
    /// Vendor id.
    pub vendor: u16,
    /// Serial number of the node.
    pub serial: u32,
    /// Whether the node answered a check. If not, only the checks that the node sent itself were received.
    pub is_on_line: bool,
}

#[derive(Debug)]
pub(super) struct Finder {
    own_identity: Identity,
    due: Now,
    /// Time of the last check.
    last_check_at: Now,
    /// MACs that are still to be checked, in reverse order.
    remaining: Vec<Mac>,
    /// Starting nodes, each with the time at which the node is on line.
    booting: BTreeMap<Mac, Now>,
    found: BTreeMap<Mac, DiscoveredNode>,
}

impl Finder {
    pub(super) fn new(now: Now, own_identity: Identity) -> Self {
        let round = || Mac::all().filter(|mac| *mac != own_identity.mac);
        let mut remaining: Vec<Mac> = (0..ROUNDS).flat_map(|_| round()).collect();
        remaining.reverse();
        Self {
            own_identity,
            due: now + LISTEN,
            last_check_at: now,
            remaining,
            booting: BTreeMap::new(),
            found: BTreeMap::new(),
        }
    }

    pub(super) const fn wake(&self) -> Now {
        self.due
    }

    pub(super) fn is_over(&self, now: Now) -> bool {
        self.remaining.is_empty() && now >= self.due
    }

    pub(super) fn found(self) -> Vec<DiscoveredNode> {
        self.found.into_values().collect()
    }

    /// Returns the next check if one is due.
    pub(super) fn poll(&mut self, now: Now) -> Option<Frame> {
        if now < self.due {
            return None;
        }
        while let Some(mac) = self.remaining.pop() {
            let is_booting = self.booting.get(&mac).is_some_and(|until| now < *until);
            let is_known = self.found.get(&mac).is_some_and(|found| found.is_on_line);
            if is_booting || is_known {
                continue;
            }
            self.due = now + PAUSE;
            self.last_check_at = now;
            let check = DuplicateCheck {
                is_answer: false,
                port: 0,
                vendor: self.own_identity.vendor,
                serial: self.own_identity.serial,
            };
            return Frame::new(Id::Duplicate(mac).emit(), &check.emit());
        }
        self.due = self.due.max(self.last_check_at + LAST_ANSWER_TIMEOUT);
        None
    }

    /// Handles a duplicate MAC check of another node.
    pub(super) fn handle_check(&mut self, now: Now, mac: Mac, check: DuplicateCheck) {
        let DuplicateCheck { is_answer, vendor, serial, .. } = check;
        if !is_answer {
            self.booting.insert(mac, now + GOING_ON_LINE);
        }
        let is_on_line = is_answer || self.found.get(&mac).is_some_and(|found| found.is_on_line);
        if mac != self.own_identity.mac {
            self.found.insert(mac, DiscoveredNode { mac, vendor, serial, is_on_line });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    #[test]
    fn does_not_ask_a_node_that_goes_on_line() {
        let mac = |number| Mac::new(number).unwrap();
        let own_identity = Identity { mac: mac(0), vendor: 0xFFFF, serial: 1 };
        let mut finder = Finder::new(Now::ZERO, own_identity);
        let check = |is_answer| DuplicateCheck { is_answer, port: 0, vendor: 636, serial: 9 };
        finder.handle_check(MS * 100, mac(5), check(false));
        let (mut now, mut last_check_at) = (Now::ZERO, Vec::new());
        while !finder.is_over(now) {
            now = now.max(finder.wake());
            if let Some(frame) = finder.poll(now) {
                assert!(now >= LISTEN, "listens first");
                last_check_at.push(frame.id());
                if frame.id() == Id::Duplicate(mac(7)).emit() {
                    finder.handle_check(now, mac(7), check(true));
                }
            }
            assert!(now < MS * 5000);
        }
        let times = |number| last_check_at.iter().filter(|id| **id == Id::Duplicate(mac(number)).emit()).count();
        // The finder does not check MAC 7, which has already answered, MAC 5, which was starting, and MAC 0, which is
        // its own MAC.
        assert_eq!((times(0), times(5), times(7), times(8)), (0, 0, 1, 2));
        let found: Vec<(u8, bool)> =
            finder.found().iter().map(|found| (found.mac.number(), found.is_on_line)).collect();
        assert_eq!(found, [(5, false), (7, true)]);
    }
}

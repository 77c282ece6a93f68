//! The address of a controller without the many ways to write it: what sessions, read-only robots and backups go by.

use std::net::{IpAddr, Ipv4Addr, ToSocketAddrs as _};
use std::path::Path;

use super::{Place, Target};

/// Where a controller is, however its URL is written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Address {
    /// On the network. The transport is part of it: two servers may share a number.
    Network {
        /// `udp`, `tcp`, or that of a fieldbus.
        scheme: &'static str,
        /// Name or address, in its plainest form.
        host: Host,
        /// Port.
        port: u16,
    },
    /// A device of this machine.
    Device(String),
    /// One of several controllers on a line.
    Station {
        /// The adapter that leads to the line.
        line: Box<Self>,
        /// Its number there.
        number: u8,
    },
    /// A device on a network where each has names of several kinds.
    Named {
        /// The network: the fieldbus, and the interface that leads to it.
        network: String,
        /// What the name is: two names of one kind are two devices, of two kinds only the network can tell.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A simulator of this process; two with the same parameters are not the same.
    Simulated,
}

/// A host.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Host {
    /// An address.
    Address(IpAddr),
    /// A name that only a resolver knows.
    Name(String),
}

impl Host {
    fn new(text: &str) -> Self {
        let name = text.trim_end_matches('.').to_ascii_lowercase();
        match name.parse::<IpAddr>() {
            Ok(address) => Self::Address(address.to_canonical()),
            // What it is everywhere (RFC 6761).
            Err(_) if name == "localhost" => Self::Address(Ipv4Addr::LOCALHOST.into()),
            Err(_) => Self::Name(name),
        }
    }

    /// Whether both lead to one machine. Names are looked up only where that can tell.
    fn meets(&self, other: &Self, port: u16) -> bool {
        if let (Self::Address(one), Self::Address(other)) = (self, other) {
            return one == other;
        }
        self == other || {
            let known = self.resolved(port);
            other.resolved(port).iter().any(|address| known.contains(address))
        }
    }

    fn resolved(&self, port: u16) -> Vec<IpAddr> {
        match self {
            Self::Address(address) => vec![*address],
            Self::Name(name) => (name.as_str(), port)
                .to_socket_addrs()
                .map(|found| found.map(|address| address.ip().to_canonical()).collect())
                .unwrap_or_default(),
        }
    }
}

impl Address {
    /// Where the target is.
    pub fn of(target: &Target) -> Self {
        match &target.place {
            Place::Udp(udp) => Self::network("udp", &udp.host, udp.port),
            Place::Tcp(tcp) => Self::network("tcp", &tcp.host, tcp.port),
            Place::Bus(bus) => bus.address().clone(),
            Place::Serial(serial) => Self::device(&serial.path),
            Place::Sim(_) => Self::Simulated,
        }
    }

    /// A host on the network.
    pub(super) fn network(scheme: &'static str, host: &str, port: u16) -> Self {
        Self::Network { scheme, host: Host::new(host), port }
    }

    /// A device of this machine.
    pub(super) fn device(path: &str) -> Self {
        // Links such as those of /dev/serial/by-id lead to the device; a port that is not there has its own name.
        let real = std::fs::canonicalize(Path::new(path));
        let path = real.map_or_else(|_| path.to_owned(), |path| path.display().to_string());
        Self::Device(if cfg!(windows) { path.to_ascii_uppercase() } else { path })
    }

    /// A station on a line that this leads to.
    pub(super) fn station(self, number: u8) -> Self {
        Self::Station { line: Box::new(self), number }
    }

    /// Whether both are one controller.
    pub fn meets(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Network { scheme, host, port },
                Self::Network { scheme: other_scheme, host: other_host, port: other_port },
            ) => scheme == other_scheme && port == other_port && host.meets(other_host, *port),
            (Self::Device(path), Self::Device(other)) => path == other,
            (Self::Named { .. }, Self::Named { .. }) => self == other,
            (Self::Station { line, number }, Self::Station { line: other_line, number: other }) => {
                number == other && line.meets(other_line)
            }
            _ => false,
        }
    }

    /// Whether both may be one controller although they do not meet: only their network can tell.
    pub fn may_meet(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Named { network, kind, .. }, Self::Named { network: other_network, kind: other_kind, .. }) => {
                network == other_network && kind != other_kind
            }
            _ => false,
        }
    }

    /// In words that are the same for every spelling: `udp 192.168.1.31 10040`. `None` for a simulator.
    pub fn key(&self) -> Option<String> {
        match self {
            Self::Network { scheme, host: Host::Address(address), port } => Some(format!("{scheme} {address} {port}")),
            Self::Network { scheme, host: Host::Name(name), port } => Some(format!("{scheme} {name} {port}")),
            Self::Device(path) => Some(format!("device {path}")),
            Self::Named { network, name, .. } => Some(format!("{network} {name}")),
            Self::Station { line, number } => line.key().map(|line| format!("{line} station {number}")),
            Self::Simulated => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn address(url: &str) -> Address {
        Address::of(&url.parse().unwrap())
    }

    #[test]
    fn spellings_of_one_address_are_one_controller() {
        for (one, other) in [
            ("udp://192.168.1.31", "udp://192.168.1.31:10040?model=fs100"),
            ("udp://127.0.0.1", "udp://localhost"),
            ("udp://LOCALHOST.", "udp://127.0.0.1:10040"),
            ("udp://[::ffff:10.0.0.1]", "udp://10.0.0.1"),
            ("udp://Cell3", "udp://cell3"),
            ("eip://10.0.0.1:44818", "eip://10.0.0.1?rpi=5ms"),
            ("serial:///dev/../dev/null", "serial:///dev/null?baud=19200"),
            ("serial:///dev/ttyNOT", "serial:///dev/ttyNOT?baud=19200"),
            ("slcan:///dev/ttyNOT?mac=5", "slcan:///dev/ttyNOT?bitrate=125k&mac=5"),
            ("slcan://localhost:4001?mac=5", "slcan://127.0.0.1:4001?mac=5&cycle=30ms"),
            ("can://can0?mac=5", "can://can0?mac=5&master=1"),
        ] {
            assert!(address(one).meets(&address(other)), "{one} {other}");
            assert_eq!(address(one).key(), address(other).key());
        }
    }

    #[test]
    fn other_controllers_are_others() {
        for (one, other) in [
            ("udp://10.0.0.1", "udp://10.0.0.2"),
            ("udp://10.0.0.1", "udp://10.0.0.1:10050"),
            ("tcp://10.0.0.1:10040", "udp://10.0.0.1:10040"),
            ("serial:///dev/null", "serial:///dev/zero"),
            ("sim:", "sim:"),
            ("can://can0?mac=5", "can://can0?mac=6"),
            ("can://can0?mac=5", "can://can1?mac=5"),
        ] {
            assert!(!address(one).meets(&address(other)), "{one} {other}");
            assert!(!address(one).may_meet(&address(other)), "{one} {other}");
        }
    }
}

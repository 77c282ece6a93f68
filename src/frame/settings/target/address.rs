//! Normalized address of a controller, independent of the form of its URL. It is used for sessions, read-only robots
//! and backups.

use std::net::{IpAddr, Ipv4Addr, ToSocketAddrs as _};
use std::path::Path;

use super::{Place, Target};

/// Address of a controller.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Address {
    /// On the network. The transport is part of it, because two servers can have the same port number.
    Network {
        /// Scheme: `udp`, `tcp`, or that of a fieldbus.
        scheme: &'static str,
        /// Normalized host.
        host: Host,
        /// Port.
        port: u16,
    },
    /// A device of this computer.
    Device(String),
    /// A station on a shared line.
    Station {
        /// Adapter of the line.
        line: Box<Self>,
        /// Station number.
        number: u8,
    },
    /// A device on a network with several kinds of names.
    Named {
        /// Fieldbus and interface.
        network: String,
        /// Kind of the name. Two names of one kind are two devices. For two kinds, only the network can decide.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// A simulator of this process; two with the same options are different.
    Simulated,
}

/// A host.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Host {
    /// An IP address.
    Address(IpAddr),
    /// A host name.
    Name(String),
}

impl Host {
    fn new(text: &str) -> Self {
        let name = text.trim_end_matches('.').to_ascii_lowercase();
        match name.parse::<IpAddr>() {
            Ok(address) => Self::Address(address.to_canonical()),
            // Loopback on every system (RFC 6761).
            Err(_) if name == "localhost" => Self::Address(Ipv4Addr::LOCALHOST.into()),
            Err(_) => Self::Name(name),
        }
    }

    /// Whether both are the same host. Names are resolved only if necessary.
    fn matches(&self, other: &Self, port: u16) -> bool {
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
    /// Address of a target.
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

    /// A device of this computer.
    pub(super) fn device(path: &str) -> Self {
        // `\\.\com3` and `COM3` are one port. The path is not resolved, because that would open the port.
        if cfg!(windows) {
            return Self::Device(path.trim_start_matches(r"\\.\").to_ascii_uppercase());
        }
        // Links such as those in /dev/serial/by-id are resolved. A missing port keeps its name.
        let real = std::fs::canonicalize(Path::new(path));
        Self::Device(real.map_or_else(|_| path.to_owned(), |path| path.display().to_string()))
    }

    /// A station on the line of this address.
    pub(super) fn station(self, number: u8) -> Self {
        Self::Station { line: Box::new(self), number }
    }

    /// Whether both are the same controller.
    pub fn meets(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Network { scheme, host, port },
                Self::Network { scheme: other_scheme, host: other_host, port: other_port },
            ) => scheme == other_scheme && port == other_port && host.matches(other_host, *port),
            (Self::Device(path), Self::Device(other)) => path == other,
            (Self::Named { .. }, Self::Named { .. }) => self == other,
            (Self::Station { line, number }, Self::Station { line: other_line, number: other }) => {
                number == other && line.meets(other_line)
            }
            _ => false,
        }
    }

    /// Whether the controller can have a second address.
    pub fn has_aliases(&self) -> bool {
        matches!(self, Self::Named { .. })
    }

    /// Whether both can be the same controller although they do not meet; only their network can decide.
    pub fn may_match(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Named { network, kind, .. }, Self::Named { network: other_network, kind: other_kind, .. }) => {
                network == other_network && kind != other_kind
            }
            _ => false,
        }
    }

    /// Normalized text, the same for every form of the URL: `udp 192.168.1.31 10040`. `None` for a simulator.
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
    fn spellings_of_one_address_match() {
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
    fn different_controllers_do_not_match() {
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
            assert!(!address(one).may_match(&address(other)), "{one} {other}");
        }
    }
}

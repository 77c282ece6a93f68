//! Addresses without a scheme, which the family determines.

use std::fmt;
use std::net::{IpAddr, SocketAddr};
use std::str::FromStr;

use super::{Family, Target};
use crate::failure::Failure;

/// A given target: a URL, or a network address or serial port whose scheme depends on the family.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TargetArgument {
    /// A URL.
    Url(Target),
    /// `192.168.1.31`, `192.168.1.31:10040`, `COM3`, `\\.\COM12`, `/dev/ttyUSB0`.
    Bare(String),
}

impl TargetArgument {
    /// Target for a family.
    ///
    /// # Errors
    /// The family is unknown, or does not use this kind of address.
    pub fn resolve(&self, family: Option<Family>) -> Result<Target, Failure> {
        let bare = match self {
            Self::Url(target) => return Ok(target.clone()),
            Self::Bare(bare) => bare,
        };
        let incomplete = |why: &str, hint: String| Err(Failure::usage(format!("target '{bare}': {why}")).hint(hint));
        let host = bare.parse::<IpAddr>().map_or_else(
            |_| bare.clone(),
            |ip| match ip {
                IpAddr::V4(ip) => ip.to_string(),
                IpAddr::V6(ip) => format!("[{ip}]"),
            },
        );
        let has_port = bare.parse::<SocketAddr>().is_ok();
        let url = match (family, is_serial(bare)) {
            (Some(Family::Yerc), false) => format!("udp://{host}"),
            (Some(Family::Yrcx), false) => format!("eip://{host}"),
            (Some(Family::Toyo), false) if has_port => format!("tcp://{host}"),
            (Some(Family::Toyo), true) => format!("serial://{bare}"),
            (Some(Family::Toyo), false) => {
                return incomplete(
                    "the port is missing; device servers have no default port",
                    format!("write tcp://{host}:PORT"),
                );
            }
            (Some(Family::Yerc), true) => {
                return incomplete("a yerc robot has no serial port", "write udp://HOST".into());
            }
            (Some(Family::Yrcx), true) => {
                let ways = format!("write slcan://{bare}?mac=N (DeviceNet) or profibus://{bare}?station=N");
                return incomplete("armctl cannot infer the fieldbus from this port", ways);
            }
            (None, false) => {
                let port = if has_port { "" } else { ":PORT" };
                let ways = format!("write udp://{host} (yerc), eip://{host} (yrcx) or tcp://{host}{port} (toyo)");
                return incomplete("armctl cannot infer the family from this address", ways);
            }
            (None, true) => {
                return incomplete(
                    "armctl cannot infer the family from this address",
                    format!("write serial://{bare} for a toyo controller"),
                );
            }
        };
        url.parse()
    }

    /// Whether the text is an address without a scheme.
    pub fn is_bare(text: &str) -> bool {
        is_serial(text) || text.parse::<IpAddr>().is_ok() || text.parse::<SocketAddr>().is_ok()
    }
}

impl FromStr for TargetArgument {
    type Err = Failure;

    fn from_str(text: &str) -> Result<Self, Failure> {
        if Self::is_bare(text) { Ok(Self::Bare(text.to_owned())) } else { text.parse().map(Self::Url) }
    }
}

impl fmt::Display for TargetArgument {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Url(target) => target.fmt(f),
            Self::Bare(bare) => f.write_str(bare),
        }
    }
}

fn is_serial(text: &str) -> bool {
    let device = text.strip_prefix(r"\\.\");
    let is_com = |text: &str| text.get(..3).is_some_and(|com| com.eq_ignore_ascii_case("com"));
    let number = |text: &str| text.get(3..).is_some_and(|number| number.parse::<u8>().is_ok());
    text.starts_with("/dev/") || is_com(device.unwrap_or(text)) && number(device.unwrap_or(text))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn family_completes_a_bare_address() {
        for (text, family, expected) in [
            ("127.0.0.1", Some(Family::Yerc), "udp://127.0.0.1"),
            ("127.0.0.1:10050", Some(Family::Yerc), "udp://127.0.0.1:10050"),
            ("::1", Some(Family::Yerc), "udp://[::1]"),
            ("127.0.0.1", Some(Family::Yrcx), "eip://127.0.0.1"),
            ("127.0.0.1:4001", Some(Family::Toyo), "tcp://127.0.0.1:4001"),
            ("COM3", Some(Family::Toyo), "serial://COM3"),
            (r"\\.\COM12", Some(Family::Toyo), r"serial://\\.\COM12"),
            ("/dev/ttyUSB0", Some(Family::Toyo), "serial:///dev/ttyUSB0"),
            ("udp://127.0.0.1", None, "udp://127.0.0.1"),
        ] {
            let target = text.parse::<TargetArgument>().unwrap().resolve(family).unwrap();
            assert_eq!(target.url(), expected, "{text}");
            assert!(family.is_none_or(|family| target.check(family).is_ok()), "{text}");
        }
    }

    #[test]
    fn asks_for_missing_parts_of_a_bare_address() {
        for (text, family, hint) in [
            ("127.0.0.1", None, "udp://127.0.0.1 (yerc)"),
            ("127.0.0.1", Some(Family::Toyo), "tcp://127.0.0.1:PORT"),
            ("COM3", Some(Family::Yerc), "udp://HOST"),
            ("/dev/ttyUSB0", Some(Family::Yrcx), "profibus:///dev/ttyUSB0"),
            ("/dev/ttyUSB0", None, "serial:///dev/ttyUSB0"),
        ] {
            let failure = text.parse::<TargetArgument>().unwrap().resolve(family).unwrap_err();
            assert!(failure.hint.as_ref().is_some_and(|it| it.contains(hint)), "{text}: {failure:?}");
        }
        for text in ["robot", "COMET", "com", "cell3:10040"] {
            assert!(text.parse::<TargetArgument>().is_err(), "{text}");
        }
    }
}

//! `eip://` URLs: a class 1 connection of EtherNet/IP. The manufacturer has not published its numbers, so they are
//! options. The defaults are those of an older controller of the same manufacturer.

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::time::Duration;

use super::bus::{Place, Scheme};
use super::{Address, Query, choice, confirmer, host_and_port, port};
use crate::settings::duration;

/// The scheme.
pub const SCHEME: Scheme = Scheme {
    name: "eip",
    bus: "eip",
    simulators: &["eip"],
    shortest: "eip://HOST",
    form: "eip://HOST[:44818][?in=100&out=150&config=1&rpi=20ms]",
    about: "yrcx: name or address of the network board",
    parse: |place, query| {
        let eip = parse(place, query)?;
        Ok(Place {
            address: Address::network("eip", &eip.host, eip.port),
            short_name: eip.host.clone(),
            is_owner: eip.role == EipRole::Owner,
            options: Arc::new(eip),
        })
    },
};

/// A controller as an EtherNet/IP adapter.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Eip {
    /// Host name or IPv4 address.
    pub host: String,
    /// TCP port.
    pub port: u16,
    /// Connection type.
    pub role: EipRole,
    /// Produced assembly of the controller.
    pub input: u32,
    /// Consumed assembly of the controller; for connections that only listen, the heartbeat instance.
    pub output: u32,
    /// Configuration assembly, for controllers that need one.
    pub configuration: Option<u32>,
    /// Size of the produced assembly in bytes. The image is at its start.
    pub input_size: u16,
    /// Size of the consumed assembly in bytes. The image is at its start.
    pub output_size: u16,
    /// Packet interval in both directions.
    pub rpi: Duration,
    /// Timeout multiplier: intervals without a packet before the connection is lost.
    pub multiplier: u32,
    /// Whether the controller sends to a multicast group.
    pub multicast: bool,
    /// Electronic key.
    pub key: Option<EipKey>,
}

/// Connection type.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum EipRole {
    /// Control, as the only originator.
    Owner,
    /// Read the image.
    InputOnly,
    /// Read the image that another originator has requested.
    ListenOnly,
}

/// Electronic key: vendor, device type, product and revision; 0 means any.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct EipKey {
    /// Vendor id.
    pub vendor: u16,
    /// Device type.
    pub device_type: u16,
    /// Product code.
    pub product: u16,
    /// Major revision.
    pub major: u8,
    /// Minor revision.
    pub minor: u8,
}

/// Default TCP port.
const PORT: u16 = 44818;
/// Valid sizes: at least an image (chapter 1, section 1: 24 words), at most a datagram.
const SIZES: RangeInclusive<u16> = 48..=65_000;
const RPIS: RangeInclusive<Duration> = Duration::from_millis(1)..=Duration::from_secs(10);
const RPI: Duration = Duration::from_millis(20);

/// Parses the part after `eip:`.
fn parse(place: &str, query: &mut Query) -> Result<Eip, String> {
    let (host, own_port) = host_and_port(confirmer("eip", place)?)?;
    if host.contains(':') {
        return Err(format!("'{host}' is an IPv6 address; EtherNet/IP needs IPv4"));
    }
    let roles = [("owner", EipRole::Owner), ("input_only", EipRole::InputOnly), ("listen_only", EipRole::ListenOnly)];
    Ok(Eip {
        host,
        port: own_port.map_or(Ok(PORT), |text| port("port", text))?,
        role: choice(query, "role", roles)?,
        input: instance(query, "in")?.unwrap_or(100),
        output: instance(query, "out")?.unwrap_or(150),
        configuration: match query.take("config").as_deref() {
            None => Some(1),
            Some("none") => None,
            Some(text) => Some(number("config", text, "a number from 1 to 65535, or `none`")?),
        },
        input_size: size(query, "in_size")?,
        output_size: size(query, "out_size")?,
        rpi: rpi(query)?,
        multiplier: choice(
            query,
            "multiplier",
            [("16", 16), ("4", 4), ("8", 8), ("32", 32), ("64", 64), ("128", 128), ("256", 256), ("512", 512)],
        )?,
        multicast: choice(query, "multicast", [("no", false), ("yes", true)])?,
        key: query.take("key").map(|text| key(&text)).transpose()?,
    })
}

fn instance(query: &mut Query, name: &str) -> Result<Option<u32>, String> {
    query.take(name).map(|text| number(name, &text, "a number from 1 to 65535")).transpose()
}

fn number(name: &str, text: &str, allowed: &str) -> Result<u32, String> {
    match text.parse::<u16>() {
        Ok(number @ 1..) => Ok(number.into()),
        _ => Err(format!("{name} must be {allowed}, not '{text}'")),
    }
}

fn size(query: &mut Query, name: &str) -> Result<u16, String> {
    let Some(text) = query.take(name) else { return Ok(*SIZES.start()) };
    match text.parse() {
        Ok(size) if SIZES.contains(&size) => Ok(size),
        _ => {
            let (least, most) = (SIZES.start(), SIZES.end());
            Err(format!("{name} must be a number from {least} (the image) to {most}, not '{text}'"))
        }
    }
}

fn rpi(query: &mut Query) -> Result<Duration, String> {
    let Some(text) = query.take("rpi") else { return Ok(RPI) };
    match duration::parse(&text).map_err(|error| format!("rpi: {error}"))? {
        rpi if RPIS.contains(&rpi) => Ok(rpi),
        _ => Err(format!("rpi must be a time from 1ms to 10s, not '{text}'")),
    }
}

/// Parses `VENDOR:TYPE:PRODUCT[:MAJOR.MINOR]`.
fn key(text: &str) -> Result<EipKey, String> {
    let wrong = || format!("key must be VENDOR:TYPE:PRODUCT[:MAJOR.MINOR], for example 636:43:5:1.1, not '{text}'");
    let (key, revision) = match text.split(':').collect::<Vec<_>>()[..] {
        [vendor, device_type, product] => ([vendor, device_type, product], None),
        [vendor, device_type, product, revision] => ([vendor, device_type, product], Some(revision)),
        _ => return Err(wrong()),
    };
    let number = |text: &str| text.parse::<u16>().map_err(|_| wrong());
    let (major, minor) = match revision {
        None => (0, 0),
        Some(revision) => {
            let (major, minor) = revision.split_once('.').ok_or_else(wrong)?;
            // The highest bit of the major revision is the compatibility flag.
            let major = major.parse().ok().filter(|major| *major < 0x80).ok_or_else(wrong)?;
            (major, minor.parse().map_err(|_| wrong())?)
        }
    };
    Ok(EipKey { vendor: number(key[0])?, device_type: number(key[1])?, product: number(key[2])?, major, minor })
}

#[cfg(test)]
mod tests {
    use super::super::bus::testing::{options, rejects};
    use super::{Eip, EipKey, EipRole};
    use std::time::Duration;

    #[test]
    fn a_host_is_enough() {
        let usual = Eip {
            host: "rcx".to_owned(),
            port: 44818,
            role: EipRole::Owner,
            input: 100,
            output: 150,
            configuration: Some(1),
            input_size: 48,
            output_size: 48,
            rpi: Duration::from_millis(20),
            multiplier: 16,
            multicast: false,
            key: None,
        };
        assert_eq!(options::<Eip>("eip://rcx"), usual.clone());
        assert_eq!(
            options::<Eip>("eip://rcx:44818/?in=100&out=150&config=1&rpi=20ms&multiplier=16&multicast=no"),
            usual
        );
    }

    #[test]
    fn parses_every_part_of_a_url() {
        let url = "eip://10.0.0.2:1?in=101&out=151&config=none&in_size=50&out_size=64&rpi=5ms&multiplier=4\
                   &multicast=yes&role=input_only&key=636:43:5:1.2";
        let key = EipKey { vendor: 636, device_type: 43, product: 5, major: 1, minor: 2 };
        let expected = Eip {
            host: "10.0.0.2".to_owned(),
            port: 1,
            role: EipRole::InputOnly,
            input: 101,
            output: 151,
            configuration: None,
            input_size: 50,
            output_size: 64,
            rpi: Duration::from_millis(5),
            multiplier: 4,
            multicast: true,
            key: Some(key),
        };
        assert_eq!(options::<Eip>(url), expected);
    }

    #[test]
    fn names_mistakes_in_urls() {
        rejects(&[
            ("eip:h", "slashes"),
            ("eip://", "host is missing"),
            ("eip://[::1]", "IPv6"),
            ("eip://h:0", "1 to 65535"),
            ("eip://h?in=0", "in must be a number from 1"),
            ("eip://h?out=x", "out must be a number from 1"),
            ("eip://h?config=no", "or `none`, not 'no'"),
            ("eip://h?in_size=46", "in_size must be a number from 48"),
            ("eip://h?out_size=65001", "to 65000"),
            ("eip://h?rpi=0ms", "rpi must be a time from 1ms"),
            ("eip://h?rpi=soon", "rpi: 'soon' is not a valid duration"),
            ("eip://h?multiplier=5", "not '5'"),
            ("eip://h?multicast=maybe", "multicast must be no or yes"),
            ("eip://h?role=boss", "role must be owner or input_only or listen_only"),
            ("eip://h?key=1:2", "key must be VENDOR"),
            ("eip://h?key=1:2:3:128.1", "key must be VENDOR"),
            ("eip://h?rpm=20ms", "unknown parameter 'rpm'; did you mean 'rpi'?"),
        ]);
    }
}

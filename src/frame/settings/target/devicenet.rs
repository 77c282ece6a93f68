//! `slcan:` and `can:` URLs: a DeviceNet slave behind a CAN adapter.

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::time::Duration;

use super::bus::{Place, Scheme};
use super::{Address, Query, baud, choice, confirmer, host_and_port, port};
use crate::settings::duration;
use armctl_transport::devicenet::can::Bitrate;
use armctl_transport::devicenet::network;
use armctl_transport::devicenet::settings::{CYCLES, Images, RATES};
use armctl_transport::devicenet::wire::Mac;

/// Fieldbus of both schemes.
pub const BUS: &str = "devicenet";

/// An SLCAN adapter.
pub const SLCAN: Scheme = Scheme {
    name: "slcan",
    bus: BUS,
    simulators: &["devicenet", "devicenet-compact"],
    shortest: "slcan:///dev/ttyACM0?mac=5",
    form: "slcan:///dev/ttyACM0?mac=5[&bitrate=500k&master=0&cycle=20ms], slcan://HOST:PORT?mac=5",
    about: "yrcx on DeviceNet: port of an SLCAN adapter, or host and port",
    parse: |place, query| node(slcan(place, query)?, query),
};

/// A Linux CAN interface.
pub const CAN: Scheme = Scheme {
    name: "can",
    bus: BUS,
    simulators: &[],
    shortest: "can://can0?mac=5",
    form: "can://can0?mac=5[&master=0&cycle=20ms]",
    about: "yrcx on DeviceNet: CAN interface of Linux",
    parse: |place, query| {
        let interface = confirmer("can", place)?;
        let is_name =
            (1..16).contains(&interface.len()) && !interface.contains(|c: char| c.is_whitespace() || "/:".contains(c));
        if !is_name {
            return Err(format!("'{interface}' is not the name of an interface such as can0"));
        }
        node(network::AdapterLocation::SocketCan(interface.to_owned()), query)
    },
};

/// A controller as a DeviceNet slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceNet {
    /// Adapter.
    pub place: network::AdapterLocation,
    /// MAC ID of the controller.
    pub mac: Mac,
    /// MAC ID of this master.
    pub master: Mac,
    /// Bit rate of the bus. For a Linux interface, the administrator sets it.
    pub bitrate: Bitrate,
    /// Interval of polls.
    pub cycle: Duration,
    /// Expected packet rate. After four times this without a poll, the controller stops.
    pub rate: Duration,
}

/// Baud rate of a real serial line to an adapter; USB adapters ignore it.
const BAUD: u32 = 115_200;

fn slcan(place: &str, query: &mut Query) -> Result<network::AdapterLocation, String> {
    let rest = confirmer("slcan", place)?;
    if rest.starts_with('/') || rest.to_ascii_uppercase().starts_with("COM") && !rest.contains(':') {
        let baud = baud(query)?.unwrap_or(BAUD);
        return Ok(network::AdapterLocation::Serial { path: rest.to_owned(), baud });
    }
    let (host, own_port) = host_and_port(rest)?;
    let own_port =
        own_port.ok_or("the port is missing, for example slcan://HOST:PORT?mac=5; a serial port has three slashes")?;
    Ok(network::AdapterLocation::Tcp { host, port: port("port", own_port)? })
}

/// Parses the options that both schemes have.
fn node(place: network::AdapterLocation, query: &mut Query) -> Result<Place, String> {
    let mac = query.take("mac").ok_or("mac is missing: add the controller's MAC ID, for example mac=5")?;
    let mac: Mac = mac.parse().map_err(|error| format!("mac: {error}"))?;
    let master = query.take("master").map_or(Ok(Mac::default()), |text| text.parse());
    let master = master.map_err(|error| format!("master: {error}"))?;
    if master == mac {
        return Err(format!("mac and master are both {mac}: this master needs a MAC ID that no other node has"));
    }
    let bitrate = match place {
        network::AdapterLocation::SocketCan(_) => Bitrate::K500,
        _ => choice(query, "bitrate", [("500k", Bitrate::K500), ("250k", Bitrate::K250), ("125k", Bitrate::K125)])?,
    };
    let usual = Images::usual(Vec::new(), Some(bitrate));
    let cycle = time(query, "cycle", &CYCLES)?.unwrap_or(usual.cycle);
    let rate = time(query, "rate", &RATES)?.unwrap_or(Images::rate_of(cycle));
    if rate < cycle {
        return Err("rate is shorter than cycle: the controller would time out between two polls".to_owned());
    }
    let address = match &place {
        network::AdapterLocation::Serial { path, .. } => Address::device(path),
        network::AdapterLocation::Tcp { host, port } => Address::network("slcan", host, *port),
        network::AdapterLocation::SocketCan(interface) => Address::Device(format!("can {interface}")),
    };
    Ok(Place {
        address: address.station(mac.number()),
        short_name: format!("{place} MAC {mac}"),
        is_owner: true,
        options: Arc::new(DeviceNet { place, mac, master, bitrate, cycle, rate }),
    })
}

fn time(query: &mut Query, name: &str, allowed: &RangeInclusive<Duration>) -> Result<Option<Duration>, String> {
    let Some(text) = query.take(name) else { return Ok(None) };
    match duration::parse(&text).map_err(|error| format!("{name}: {error}"))? {
        time if allowed.contains(&time) => Ok(Some(time)),
        _ => {
            let (least, most) = (allowed.start().as_millis(), allowed.end().as_millis());
            Err(format!("{name} must be a time from {least}ms to {most}ms, not '{text}'"))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::bus::testing::{options, rejects};
    use super::*;

    #[test]
    fn parses_urls_of_adapters() {
        let usual = DeviceNet {
            place: network::AdapterLocation::Serial { path: "/dev/ttyACM0".to_owned(), baud: 115_200 },
            mac: Mac::new(5).unwrap(),
            master: Mac::new(0).unwrap(),
            bitrate: Bitrate::K500,
            cycle: Duration::from_millis(20),
            rate: Duration::from_millis(100),
        };
        assert_eq!(options::<DeviceNet>("slcan:///dev/ttyACM0?mac=5"), usual.clone());
        let all = "slcan:///dev/ttyACM0?mac=5&bitrate=500k&baud=115200&master=0&cycle=20ms&rate=100ms";
        assert_eq!(options::<DeviceNet>(all), usual.clone());
        let place = network::AdapterLocation::Serial { path: "COM3".to_owned(), baud: 115_200 };
        assert_eq!(options::<DeviceNet>("slcan://COM3?mac=5"), DeviceNet { place, ..usual.clone() });
        let place = network::AdapterLocation::Tcp { host: "10.0.0.1".to_owned(), port: 4001 };
        assert_eq!(
            options::<DeviceNet>("slcan://10.0.0.1:4001?mac=5"),
            DeviceNet { place: place.clone(), ..usual.clone() }
        );
        let slow = DeviceNet {
            place,
            bitrate: Bitrate::K125,
            cycle: Duration::from_millis(50),
            rate: Duration::from_millis(250),
            ..usual.clone()
        };
        assert_eq!(options::<DeviceNet>("slcan://10.0.0.1:4001?mac=5&bitrate=125k"), slow);
        let place = network::AdapterLocation::SocketCan("can0".to_owned());
        assert_eq!(options::<DeviceNet>("can://can0?mac=5"), DeviceNet { place, ..usual });
    }

    #[test]
    fn names_mistakes_in_urls() {
        rejects(&[
            ("slcan:/dev/ttyACM0?mac=5", "slashes"),
            ("slcan:///dev/ttyACM0", "mac is missing"),
            ("slcan:///dev/ttyACM0?mac=64", "0 to 63"),
            ("slcan:///dev/ttyACM0?mac=5&master=x", "master: a MAC ID"),
            ("slcan:///dev/ttyACM0?mac=5&master=5", "both 5"),
            ("slcan:///dev/ttyACM0?mac=5&bitrate=1M", "500k or 250k or 125k, not '1M'"),
            ("slcan:///dev/ttyACM0?mac=5&cycle=0ms", "cycle must be a time from 1ms"),
            ("slcan:///dev/ttyACM0?mac=5&rate=2m", "rate must be a time"),
            ("slcan:///dev/ttyACM0?mac=5&cycle=30ms&rate=20ms", "rate is shorter than cycle"),
            ("slcan:///dev/ttyACM0?mac=5&baud=1", "baud must be a number"),
            ("slcan://host?mac=5", "port is missing"),
            ("slcan://host:0?mac=5", "1 to 65535"),
            ("can://can0?mac=5&bitrate=500k", "bitrate"),
            ("can:///dev/can0?mac=5", "can0"),
            ("can://?mac=5", "name of an interface"),
        ]);
    }
}

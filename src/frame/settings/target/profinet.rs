//! `profinet://` URLs: an IO device on an Ethernet interface of this computer, by station name or MAC address. The
//! manufacturer has not published modules and numbers of its unit, so `layout=` or `gsdml=` is necessary.

use std::net::Ipv4Addr;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use super::bus::{Place, Scheme};
use super::{Address, Query, choice, confirmer};
use crate::settings::duration;
use armctl_transport::profinet::layout::Layout;
use armctl_transport::profinet::settings::{MAX_WATCHDOG, Settings, Startup, Station};
use armctl_transport::profinet::wire::Mac;
use armctl_transport::profinet::wire::dcp::{IpSuite, check_name};

/// The scheme.
pub const SCHEME: Scheme = Scheme {
    name: "profinet",
    bus: "profinet",
    simulators: &["profinet"],
    shortest: "profinet://STATION@IFACE",
    form: "profinet://STATION@IFACE[?gsdml=FILE&cycle=16ms&watchdog=320ms&ip=ADDRESS/24], or layout=MODULES for gsdml=FILE",
    about: "yrcx: name (or MAC address) of the station, and the Ethernet interface of this computer",
    parse: |place, query| {
        let profinet = parse(place, query)?;
        let (_, name) = words(&profinet.station);
        Ok(Place {
            address: address(&profinet.interface, &profinet.station),
            short_name: format!("{name} on {}", profinet.interface),
            is_owner: true,
            options: Arc::new(profinet),
        })
    },
};

/// A controller as an IO device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Profinet {
    /// Station name or MAC address.
    pub station: Station,
    /// Name of the interface.
    pub interface: String,
    /// IP address to assign, if the device has another one.
    pub ip: Option<IpSuite>,
    /// Cycle time.
    pub cycle: Duration,
    /// Watchdog time of both ends.
    pub watchdog: Duration,
    /// Module layout.
    pub layout: Option<Layout>,
    /// GSDML file, which also contains the modules.
    pub gsdml: Option<PathBuf>,
    /// Startup mode.
    pub startup: Startup,
    /// Whether command words have their high byte first.
    pub is_big_endian: bool,
}

/// Address of a station on the network of an interface.
pub fn address(interface: &str, station: &Station) -> Address {
    let (kind, name) = words(station);
    Address::Named { network: format!("profinet {interface}"), kind, name }
}

/// Kind and text of a station's name.
fn words(station: &Station) -> (&'static str, String) {
    match station {
        Station::Name(name) => ("station", name.clone()),
        Station::Mac(mac) => ("card", mac.to_string()),
    }
}

/// Default cycle time.
const CYCLE: Duration = Duration::from_millis(16);
/// Default watchdog in cycles, long enough for a busy computer.
const CYCLES: u32 = 20;
/// Default prefix length of an IP address.
const PREFIX: u32 = 24;

/// Parses the part after `profinet:`.
fn parse(place: &str, query: &mut Query) -> Result<Profinet, String> {
    let place = confirmer("profinet", place)?;
    let (station, interface) = place
        .rsplit_once('@')
        .ok_or("the interface is missing, for example profinet://STATION@eth0; `ip link` lists the interfaces")?;
    let is_name = !interface.is_empty() && !interface.contains(|c: char| c.is_whitespace() || c == '/');
    if !is_name {
        return Err(format!("'{interface}' is not the name of an interface such as eth0"));
    }
    let cycle = query.take("cycle").map_or(Ok(CYCLE), |text| cycle(&text))?;
    let usual = (cycle * CYCLES).clamp(CYCLE * CYCLES, MAX_WATCHDOG);
    let watchdog = query.take("watchdog").map_or(Ok(usual), |text| watchdog(&text, cycle))?;
    let layout = query.take("layout").map(|text| text.parse()).transpose();
    let layout = layout.map_err(|error: String| format!("layout: {error}"))?;
    let gsdml = query.take("gsdml").map(PathBuf::from);
    if layout.is_some() && gsdml.is_some() {
        return Err("layout and gsdml both define the modules: remove one of them".to_owned());
    }
    Ok(Profinet {
        station: self::station(station)?,
        interface: interface.to_owned(),
        ip: query.take("ip").map(|text| suite(&text)).transpose()?,
        cycle,
        watchdog,
        layout,
        gsdml,
        startup: choice(query, "startup", [("advanced", Startup::Advanced), ("legacy", Startup::Legacy)])?,
        is_big_endian: choice(query, "words", [("le", false), ("be", true)])?,
    })
}

/// Parses a station name or MAC address.
fn station(text: &str) -> Result<Station, String> {
    if text.is_empty() {
        return Err("the station is missing, for example profinet://STATION@eth0".to_owned());
    }
    if text.contains(':') {
        let mac: Mac = text.parse()?;
        return if mac.is_group() {
            Err(format!("{mac} is a group address, not the address of one network card"))
        } else {
            Ok(Station::Mac(mac))
        };
    }
    // In a URL, upper case is accepted, but station names only have lower case.
    name(&text.to_ascii_lowercase()).map(Station::Name)
}

/// Checks a station name.
pub fn name(text: &str) -> Result<String, String> {
    let wrong = |why| format!("'{text}' is not a valid station name: {why}{}", similar(text));
    check_name(text).map(|()| text.to_owned()).map_err(wrong)
}

/// Suggests a valid name, in the way of engineering tools.
fn similar(name: &str) -> String {
    let name = name.to_ascii_lowercase().replace(['_', ' '], "-");
    if check_name(&name).is_ok() { format!("; did you mean '{name}'?") } else { String::new() }
}

/// Parses a cycle time: a power of two in ms.
fn cycle(text: &str) -> Result<Duration, String> {
    let cycle = duration::parse(text).map_err(|error| format!("cycle: {error}"))?;
    if ratio(cycle).is_some() {
        return Ok(cycle);
    }
    let near = u64::try_from(cycle.as_millis()).unwrap_or(u64::MAX).clamp(1, 512).next_power_of_two();
    Err(format!(
        "cycle must be 1ms, 2ms, 4ms, 8ms, 16ms, 32ms, 64ms, 128ms, 256ms or 512ms, not '{text}'; try {near}ms"
    ))
}

fn ratio(cycle: Duration) -> Option<u16> {
    Settings { cycle, ..Settings::new(Station::Mac(Mac::default()), Layout::default()) }.ratio()
}

fn watchdog(text: &str, cycle: Duration) -> Result<Duration, String> {
    let watchdog = duration::parse(text).map_err(|error| format!("watchdog: {error}"))?;
    let least = cycle * 3;
    if (least..=MAX_WATCHDOG).contains(&watchdog) {
        return Ok(watchdog);
    }
    let (least, most) = (least.as_millis(), MAX_WATCHDOG.as_millis());
    Err(format!("watchdog must be a time from {least}ms (three cycles) to {most}ms, not '{text}'"))
}

/// Parses `192.168.0.5`, optionally with a prefix length.
pub fn suite(text: &str) -> Result<IpSuite, String> {
    let wrong = || format!("ip must be an address such as 192.168.0.5 or 192.168.0.5/24, not '{text}'");
    let (address, bits) = match text.split_once('/') {
        None => (text, PREFIX),
        Some((address, bits)) => (address, bits.parse().map_err(|_| wrong())?),
    };
    let address: Ipv4Addr = address.parse().map_err(|_| wrong())?;
    if !(1..=30).contains(&bits) {
        return Err(format!("ip: the mask must have 1 to 30 bits, not {bits}"));
    }
    let mask = u32::MAX << (32 - bits);
    let host = u32::from(address) & !mask;
    if host == 0 || host == !mask || address.is_multicast() || address.is_loopback() {
        return Err(format!("ip: {address}/{bits} is not a valid device address"));
    }
    Ok(IpSuite { address, mask: mask.into(), gateway: Ipv4Addr::UNSPECIFIED })
}

#[cfg(test)]
mod tests {
    use super::super::bus::testing::{options, rejects};
    use super::*;

    #[test]
    fn parses_every_part_of_a_url() {
        let ms = Duration::from_millis;
        let usual = options::<Profinet>("profinet://Robot-7@eth0");
        assert_eq!((&usual.station, usual.interface.as_str()), (&Station::Name("robot-7".to_owned()), "eth0"));
        assert_eq!((usual.cycle, usual.watchdog, usual.is_big_endian), (ms(16), ms(320), false));
        assert_eq!((usual.layout, usual.gsdml, usual.ip), (None, None, None));
        let url = "profinet://02:00:00:00:00:AB@enp3s0?ip=10.0.0.5/16&cycle=64ms&watchdog=1s&words=be&startup=legacy\
                   &layout=1:0x101:i48,2:0x102:o48";
        let all = options::<Profinet>(url);
        assert_eq!(all.station, Station::Mac(Mac([2, 0, 0, 0, 0, 0xAB])));
        assert_eq!((all.cycle, all.watchdog, all.is_big_endian), (ms(64), ms(1000), true));
        assert_eq!(all.startup, Startup::Legacy);
        let suite = all.ip.unwrap();
        assert_eq!((suite.address, suite.mask), ([10, 0, 0, 5].into(), [255, 255, 0, 0].into()));
        assert_eq!(all.layout.unwrap().to_string(), "1:0x101:i48,2:0x102:o48");
        let slow = options::<Profinet>("profinet://a@eth0?cycle=512ms&gsdml=unit.xml");
        assert_eq!((slow.watchdog, slow.gsdml), (ms(1920), Some(PathBuf::from("unit.xml"))));
    }

    #[test]
    fn names_mistakes_in_urls() {
        rejects(&[
            ("profinet:robot@eth0", "slashes"),
            ("profinet://robot", "the interface is missing"),
            ("profinet://@eth0", "the station is missing"),
            ("profinet://robot@", "name of an interface"),
            ("profinet://robot@eth 0", "name of an interface"),
            ("profinet://robot_7@eth0", "did you mean 'robot-7'?"),
            ("profinet://-robot@eth0", "begins or ends with '-'"),
            ("profinet://01:0e:cf:00:00:00@eth0", "group address"),
            ("profinet://02:00@eth0", "not a MAC address"),
            ("profinet://robot@eth0?cycle=20ms", "try 32ms"),
            ("profinet://robot@eth0?cycle=soon", "cycle: 'soon'"),
            ("profinet://robot@eth0?watchdog=30ms", "48ms (three cycles) to 1920ms, not '30ms'"),
            ("profinet://robot@eth0?watchdog=3s", "to 1920ms"),
            ("profinet://robot@eth0?layout=1:2:x", "layout: '1:2:x' is not a submodule such as"),
            ("profinet://robot@eth0?layout=1:1:i48&gsdml=a.xml", "remove one"),
            ("profinet://robot@eth0?ip=robot", "ip must be an address"),
            ("profinet://robot@eth0?ip=10.0.0.0/24", "not a valid device address"),
            ("profinet://robot@eth0?ip=10.0.0.5/33", "1 to 30 bits"),
            ("profinet://robot@eth0?words=middle", "words must be le or be"),
            ("profinet://robot@eth0?rate=1", "unknown parameter 'rate'"),
        ]);
    }

    #[test]
    fn spellings_of_one_station_match() {
        let address = |url: &str| Address::of(&url.parse().unwrap());
        let robot = address("profinet://robot-7@eth0?cycle=8ms");
        assert!(robot.meets(&address("profinet://ROBOT-7@eth0")));
        for other in ["profinet://robot-8@eth0", "profinet://robot-7@eth1"].map(address) {
            assert!(!robot.meets(&other) && !robot.may_match(&other), "{other:?}");
        }
        let card = address("profinet://02:00:00:00:00:AB@eth0");
        assert!(!robot.meets(&card) && robot.may_match(&card), "only the network knows whether it is the same");
        assert!(card.meets(&address("profinet://02:00:00:00:00:ab@eth0?cycle=8ms")));
        assert!(!robot.may_match(&address("profinet://02:00:00:00:00:AB@eth1")), "another network");
    }
}

//! Target URLs. A target URL contains the location and the transport of a robot.

mod address;
mod bare;
pub mod bus;
pub mod devicenet;
pub mod eip;
pub mod profibus;
pub mod profinet;
mod url;

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Duration;

use serde::Deserialize;
use serialport::{DataBits, Parity, StopBits};

use crate::failure::Failure;
use armctl_files as files;

use self::url::{Query, baud, choice, confirmer, host_and_port, percent_decoded, port};

use super::model::ModelSetting;

pub use address::Address;
pub use bare::TargetArgument;
pub use bus::{BUSES, Bus};

/// A controller family. It has the name of its subcommand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// Yaskawa FS100, DX100, DX200, YRC1000: high-speed Ethernet server.
    Yerc,
    /// OMRON / Yamaha YRCX, remote commands over a fieldbus.
    Yrcx,
    /// Toyo, RS-232C host communication.
    Toyo,
}

impl Family {
    /// All families, in the order of the help texts.
    pub const ALL: [Self; 3] = [Self::Yerc, Self::Yrcx, Self::Toyo];

    /// Name of the family. It is the subcommand, the name of a link to the binary, and the value in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Yerc => "yerc",
            Self::Yrcx => "yrcx",
            Self::Toyo => "toyo",
        }
    }

    /// Example URL for hints.
    pub const fn address(self) -> &'static str {
        match self {
            Self::Yerc => "udp://HOST",
            Self::Yrcx => bus::USUAL.shortest,
            Self::Toyo if cfg!(windows) => "serial://COM3 or tcp://HOST:PORT",
            Self::Toyo => "serial:///dev/ttyUSB0 or tcp://HOST:PORT",
        }
    }

    /// Default time limit of one attempt. On a network, a controller answers in 5 to 20 ms, and a busy controller
    /// within seconds. On a serial line, it answers within one second (TO 1-3).
    pub const fn timeout(self) -> Duration {
        match self {
            Self::Yerc | Self::Yrcx => Duration::from_secs(3),
            Self::Toyo => Duration::from_millis(1500),
        }
    }

    /// Whether controllers of this family have different models. The settings can then contain a model.
    pub const fn has_model(self) -> bool {
        matches!(self, Self::Yerc)
    }

    /// Whether a URL scheme is valid for the family.
    fn is_reached_over(self, scheme: &str) -> bool {
        scheme == "sim"
            || match self {
                Self::Yerc => scheme == "udp",
                Self::Yrcx => BUSES.iter().any(|bus| bus.name == scheme),
                Self::Toyo => ["serial", "tcp"].contains(&scheme),
            }
    }
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Family {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.into_iter().find(|family| family.name() == text);
        found.ok_or_else(|| format!("unknown family '{text}'; known: yerc, yrcx and toyo"))
    }
}

/// A parsed target URL.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Target {
    /// The URL as the user typed it.
    url: String,
    /// Parts of the URL.
    pub place: Place,
}

/// Parts of a target URL.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// `udp://HOST[:10040][?file_port=PORT+1&model=auto|fs100|dx100|dx200|yrc1000&move_words=25|26]`.
    Udp(Udp),
    /// `serial:///dev/ttyUSB0[?baud=9600&parity=even|odd|none&data_bits=7|8&stop_bits=1|2]`, `serial://COM3`.
    Serial(Serial),
    /// `tcp://HOST:PORT[?baud=9600]`.
    Tcp(Tcp),
    /// `sim:[?model=…&axes=…&baud=…&state=FILE&from=FOLDER&replay=FILE&fault=…]`: the built-in simulator of the family, in
    /// this process.
    Sim(Sim),
    /// A URL of one of the [`BUSES`].
    Bus(Bus),
}

/// A high-speed Ethernet server on the network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Udp {
    /// Host name or address.
    pub host: String,
    /// Port of the robot server.
    pub port: u16,
    /// Port of the file server.
    pub file_port: u16,
    /// Options of the controller.
    pub traits: YercTraits,
}

/// URL options of a yerc controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct YercTraits {
    /// Controller model.
    pub model: Option<ModelSetting>,
    /// Number of words of the cartesian move: 25 or 26. FS 3.3.39 gives 25 for the FS100; all public clients send 26.
    pub move_words: Option<u8>,
}

/// A serial port of this computer. The defaults are the settings of a Toyo controller (TO 1-2): 9600 baud, 8 data bits,
/// even parity, 1 stop bit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Serial {
    /// Name of the port, for example `/dev/ttyUSB0` or `COM3`.
    pub path: String,
    /// Bits per second.
    pub baud: u32,
    /// Data bits in a character.
    pub data_bits: DataBits,
    /// Parity bit.
    pub parity: Parity,
    /// Stop bits in a character.
    pub stop_bits: StopBits,
}

/// A serial line behind a device server on the network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tcp {
    /// Host name or address.
    pub host: String,
    /// TCP port of the serial line on the device server.
    pub port: u16,
    /// Baud rate of the line, for the calculation of transmission times. The device server has its own setting.
    pub baud: u32,
}

/// The built-in simulator.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sim {
    /// Options of a yerc controller.
    pub traits: YercTraits,
    /// Number of axes of a toyo controller, 1 to 4.
    pub axes: Option<u8>,
    /// Baud rate of the line to a toyo controller. Without a baud rate, transmission takes no time.
    pub baud: Option<u32>,
    /// File with the start state.
    pub state: Option<PathBuf>,
    /// Backup of a robot, whose data the simulator starts with.
    pub from: Option<PathBuf>,
    /// Recording of a robot, whose answers the simulator gives.
    pub replay: Option<PathBuf>,
    /// Faults of link and device, in the format of `armctl sim --fault`.
    pub fault: Option<String>,
    /// Fieldbus of a yrcx controller: one of [`bus::simulators`]. Without this setting, a network is simulated only if
    /// the network has faults.
    pub bus: Option<&'static str>,
}

/// File name of the manifest of a backup. No file of a controller has this ending.
pub const MANIFEST: &str = "manifest.json";
/// Maximum size of a manifest. No controller has so many files that its manifest is larger.
pub const MAX_MANIFEST: u64 = 64 << 20;

/// Family in the manifest of a backup; `None` without a readable manifest.
pub fn family_of_backup(folder: &Path) -> Option<Family> {
    #[derive(Deserialize)]
    struct Head {
        family: String,
    }
    let text = files::text(&folder.join(MANIFEST), MAX_MANIFEST).ok()?;
    serde_json::from_str::<Head>(&text).ok()?.family.parse().ok()
}

/// UDP port of the robot server (from the frame table of the manual).
const ROBOT_PORT: u16 = 10040;
/// Default baud rate of a serial line (TO 1-2).
const BAUD: u32 = 9600;

impl Target {
    /// Returns the target of the simulator with its built-in start state.
    pub fn simulator() -> Self {
        Self { url: "sim:".to_owned(), place: Place::Sim(Sim::default()) }
    }

    /// The URL as the user typed it.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Whether the target is a simulator.
    pub fn is_simulated(&self) -> bool {
        matches!(self.place, Place::Sim(_))
    }

    /// Scheme of the URL: `udp`, `sim`, …
    pub fn scheme(&self) -> &str {
        match &self.place {
            Place::Udp(_) => "udp",
            Place::Serial(_) => "serial",
            Place::Tcp(_) => "tcp",
            Place::Sim(_) => "sim",
            Place::Bus(bus) => bus.scheme.name,
        }
    }

    /// Address of the robot. Different forms of a URL have the same address.
    pub fn address(&self) -> Address {
        Address::of(self)
    }

    /// Short name for messages without an inventory: the host, the port name without its folder, or `sim`.
    pub fn short_name(&self) -> String {
        match &self.place {
            Place::Udp(udp) => udp.host.clone(),
            Place::Serial(serial) => serial.path.rsplit(['/', '\\']).next().unwrap_or_default().to_owned(),
            Place::Tcp(tcp) => tcp.host.clone(),
            Place::Sim(_) => "sim".to_owned(),
            Place::Bus(bus) => bus.short_name().to_owned(),
        }
    }

    /// Options of a yerc controller.
    pub fn traits(&self) -> YercTraits {
        match &self.place {
            Place::Udp(udp) => udp.traits,
            Place::Sim(sim) => sim.traits,
            Place::Serial(_) | Place::Tcp(_) | Place::Bus(_) => YercTraits::default(),
        }
    }

    /// The family of this URL, if only one family can use it.
    pub fn family(&self) -> Option<Family> {
        let mut families = Family::ALL.into_iter().filter(|family| family.is_reached_over(self.scheme()));
        let first = families.next();
        if families.next().is_some() { None } else { first }
    }

    /// Family of the backup that a simulator starts with. It is no part of the URL: the folder can be missing, and an
    /// inventory with this URL must still be readable.
    pub fn family_of_backup(&self) -> Option<Family> {
        match &self.place {
            Place::Sim(Sim { from: Some(folder), .. }) => family_of_backup(folder),
            _ => None,
        }
    }

    /// Checks that the URL and all its options are valid for a family.
    pub fn check(&self, family: Family) -> Result<(), String> {
        if !family.is_reached_over(self.scheme()) {
            return Err(format!("a {family} robot cannot have a {}: URL", self.scheme()));
        }
        match &self.place {
            Place::Sim(sim) => sim.check(family),
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.url)
    }
}

impl FromStr for Target {
    type Err = Failure;

    fn from_str(url: &str) -> Result<Self, Failure> {
        let (scheme, rest) = url.split_once(':').unwrap_or(("", url));
        let wrong = |why: String| Failure::usage(format!("target '{url}': {why}")).hint(hint(scheme));
        if scheme.is_empty() && url.contains('.') && url.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.') {
            return Err(wrong("it is not a valid IPv4 address; write four numbers from 0 to 255".into()));
        }
        if scheme.contains('.') && !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(wrong(format!("port {rest} is not from 1 to 65535")));
        }
        if scheme.is_empty() {
            let is_family = url.parse::<Family>().is_ok();
            let family = if is_family { "this is a family, but the target is a URL; " } else { "" };
            return Err(wrong(format!("{family}the scheme is missing, for example udp://")));
        }
        let (place, query) = rest.split_once('?').unwrap_or((rest, ""));
        let mut query = Query::parse(query).map_err(wrong)?;
        let place = match scheme {
            "udp" => udp(place, &mut query).map(Place::Udp),
            "serial" => serial(place, &mut query).map(Place::Serial),
            "tcp" => tcp(place, &mut query).map(Place::Tcp),
            "sim" => sim(place, &mut query).map(Place::Sim),
            _ => match BUSES.iter().find(|bus| bus.name == scheme) {
                Some(bus) => Bus::parse(bus, place, &mut query).map(Place::Bus),
                None => Err(format!("unknown scheme '{scheme}'")),
            },
        };
        let place = place.map_err(wrong)?;
        query.finish().map_err(wrong)?;
        Ok(Self { url: url.to_owned(), place })
    }
}

/// Returns the form of a URL with this scheme. For an unknown scheme, returns the forms of all schemes.
fn hint(scheme: &str) -> String {
    let buses = BUSES.iter().map(|bus| (bus.name, bus.form));
    match FORMS.into_iter().chain(buses).find(|(known, _)| *known == scheme) {
        Some((_, form)) => format!("write {form}; see `armctl help targets`"),
        None => format!(
            "write udp://HOST, {}, serial:///dev/ttyUSB0, serial://COM3 or tcp://HOST:PORT for a controller, or sim: \
             for the simulator; see `armctl help targets`",
            BUSES.iter().map(|bus| bus.shortest).collect::<Vec<_>>().join(", ")
        ),
    }
}

/// Forms of URLs that are not fieldbuses.
const FORMS: [(&str, &str); 4] = [
    ("udp", "udp://HOST[:10040][?file_port=PORT+1&model=auto]"),
    ("serial", "serial:///dev/ttyUSB0[?baud=9600&parity=even&data_bits=8&stop_bits=1], or serial://COM3"),
    ("tcp", "tcp://HOST:PORT[?baud=9600]"),
    ("sim", "sim:[?state=FILE&from=FOLDER&replay=FILE&fault=drop=5%25]"),
];

fn udp(place: &str, query: &mut Query) -> Result<Udp, String> {
    let confirmer = confirmer("udp", place)?;
    let (host, port) = host_and_port(confirmer)?;
    let port = match port {
        Some(port) => self::port("port", port)?,
        None => ROBOT_PORT,
    };
    let file_port = match query.take("file_port") {
        Some(port) => self::port("file_port", &port)?,
        // The default is the next port. With port forwarding, this is the port after the forwarded port.
        None => port.checked_add(1).ok_or(
            "port 65535 is the last port, so there is no next port for files; set the \
                                           port for files with file_port=PORT",
        )?,
    };
    Ok(Udp { host, port, file_port, traits: traits(query)? })
}

fn serial(place: &str, query: &mut Query) -> Result<Serial, String> {
    let path = place.strip_prefix("//").ok_or("two slashes are missing after serial:")?;
    let path = percent_decoded(path)?;
    if path.is_empty() {
        return Err("the port is missing".to_owned());
    }
    if path.contains('/') && !path.starts_with('/') {
        return Err(format!("'{path}' is not a valid port; a path starts with a third slash"));
    }
    Ok(Serial {
        path,
        baud: baud(query)?.unwrap_or(BAUD),
        data_bits: choice(query, "data_bits", [("8", DataBits::Eight), ("7", DataBits::Seven)])?,
        parity: choice(query, "parity", [("even", Parity::Even), ("odd", Parity::Odd), ("none", Parity::None)])?,
        stop_bits: choice(query, "stop_bits", [("1", StopBits::One), ("2", StopBits::Two)])?,
    })
}

fn tcp(place: &str, query: &mut Query) -> Result<Tcp, String> {
    let (host, port) = host_and_port(confirmer("tcp", place)?)?;
    let port = self::port("port", port.ok_or("the port is missing; device servers have no default port")?)?;
    Ok(Tcp { host, port, baud: baud(query)?.unwrap_or(BAUD) })
}

fn sim(place: &str, query: &mut Query) -> Result<Sim, String> {
    if !place.is_empty() {
        let family = place.parse::<Family>().map(|family| format!("; the target is sim: and the family is {family}"));
        let family = family.unwrap_or_else(|_| "; parameters start with ?".to_owned());
        return Err(format!("'{place}' after sim: has no meaning{family}"));
    }
    let axes = match query.take("axes") {
        None => None,
        Some(text) => match text.parse() {
            Ok(axes @ 1..=4) => Some(axes),
            _ => return Err(format!("axes must be a number from 1 to 4, not '{text}'")),
        },
    };
    let [state, from, replay] = ["state", "from", "replay"].map(|key| query.take(key).map(PathBuf::from));
    if state.is_some() && from.is_some() {
        return Err("a simulator starts with either state or from".to_owned());
    }
    if state.is_some() && replay.is_some() {
        return Err("a simulator has either state or replay".to_owned());
    }
    Ok(Sim {
        traits: traits(query)?,
        axes,
        baud: baud(query)?,
        state,
        from,
        replay,
        fault: query.take("fault"),
        bus: query.take("bus").map(|name| bus(&name)).transpose()?,
    })
}

/// Finds a fieldbus that simulators support, by name.
fn bus(name: &str) -> Result<&'static str, String> {
    let found = bus::simulators().find(|(known, _)| *known == name);
    found.map(|(known, _)| known).ok_or_else(|| {
        let all: Vec<&str> = bus::simulators().map(|(known, _)| known).collect();
        format!("bus must be {}, not '{name}'", all.join(" or "))
    })
}

impl Sim {
    /// Returns an error if an option belongs to another family.
    fn check(&self, family: Family) -> Result<(), String> {
        let given = [
            ("model", self.traits.model.is_some(), Family::Yerc),
            ("move_words", self.traits.move_words.is_some(), Family::Yerc),
            ("axes", self.axes.is_some(), Family::Toyo),
            ("baud", self.baud.is_some(), Family::Toyo),
            ("bus", self.bus.is_some(), Family::Yrcx),
        ];
        match given.iter().find(|(_, is_given, owner)| *is_given && *owner != family) {
            Some((key, _, owner)) => Err(format!("'{key}' in a sim: URL is for {owner}, not for {family}")),
            None => Ok(()),
        }
    }
}

fn traits(query: &mut Query) -> Result<YercTraits, String> {
    let model = query.take("model").map(|name| name.parse()).transpose()?;
    let move_words = match query.take("move_words").as_deref() {
        None => None,
        Some("25") => Some(25),
        Some("26") => Some(26),
        Some(other) => return Err(format!("move_words must be 25 or 26, not '{other}'")),
    };
    Ok(YercTraits { model, move_words })
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::yerc::Model;

    fn target(url: &str) -> Target {
        url.parse().unwrap()
    }

    #[test]
    fn ports_default_to_those_of_the_protocol() {
        let Place::Udp(udp) = target("udp://10.0.0.2").place else { panic!("not udp") };
        assert_eq!((udp.host.as_str(), udp.port, udp.file_port), ("10.0.0.2", 10040, 10041));
        let Place::Udp(udp) = target("udp://10.0.0.2:20040").place else { panic!("not udp") };
        assert_eq!((udp.port, udp.file_port), (20040, 20041), "files are one port above");
        assert!("udp://10.0.0.2:65535".parse::<Target>().is_err_and(|failure| failure.message.contains("file_port")));
    }

    #[test]
    fn parses_every_part_of_a_udp_url() {
        let Place::Udp(udp) = target("udp://[::1]:2000?file_port=2001&model=fs100&move_words=25").place else {
            panic!("not udp")
        };
        assert_eq!((udp.host.as_str(), udp.port, udp.file_port), ("::1", 2000, 2001));
        assert_eq!(udp.traits, YercTraits { model: Some(ModelSetting::Is(Model::Fs100)), move_words: Some(25) });
    }

    #[test]
    fn names_mistakes_in_urls() {
        for (url, part) in [
            ("robot", "scheme"),
            ("http://x", "unknown scheme"),
            ("udp:x", "slashes"),
            ("udp://", "host is missing"),
            ("udp://0.0.0.0", "0.0.0.0 is not a valid robot address"),
            ("udp://0", "0 is not a valid robot address"),
            ("udp://0x0.0:10040", "is not a valid robot address"),
            ("udp://[::]", ":: is not a valid robot address"),
            ("udp://[::ffff:0.0.0.0]", "is not a valid robot address"),
            ("udp://h:0", "1 to 65535"),
            ("udp://h:70000", "1 to 65535"),
            ("udp://h?modle=fs100", "modle"),
            ("udp://h?model=xrc", "known: auto, fs100, dx100, dx200 and yrc1000"),
            ("udp://h?model=fs100&model=dx200", "twice"),
            ("sim:dx200", "has no meaning"),
            ("sim:?fault=%4", "invalid %"),
            ("sim:?axes=5", "axes must be a number from 1 to 4"),
            ("sim:?bus=can", "devicenet-compact or profibus or profinet, not 'can'"),
            ("sim:?baud=fast", "50 to 4000000"),
            ("serial:COM3", "slashes"),
            ("serial://", "port is missing"),
            ("serial://dev/ttyUSB0", "third slash"),
            ("serial://COM3?baud=0", "50 to 4000000, not '0'"),
            ("serial://COM3?baud=5000000", "50 to 4000000"),
            ("serial://COM3?parity=mark", "parity must be even or odd or none, not 'mark'"),
            ("serial://COM3?data_bits=5", "data_bits must be 8 or 7, not '5'"),
            ("serial://COM3?stop_bits=1.5", "stop_bits must be 1 or 2, not '1.5'"),
            ("serial://COM3?flow=rts", "unknown parameter 'flow'"),
            ("tcp:h:1", "slashes"),
            ("tcp://h", "port is missing"),
            ("tcp://:4001", "host is missing"),
            ("tcp://0.0.0.0:4001", "is not a valid robot address"),
            ("tcp://h:0", "1 to 65535"),
            ("tcp://h:4001?parity=odd", "unknown parameter 'parity'; known: baud"),
        ] {
            let failure = url.parse::<Target>().unwrap_err();
            assert!(failure.message.contains(part), "{url}: {}", failure.message);
            let (scheme, hint) = (url.split(':').next().unwrap(), failure.hint.unwrap());
            assert!(hint.contains(&format!("write {scheme}:")) || hint.contains("udp://HOST, eip://HOST,"), "{hint}");
        }
    }

    #[test]
    fn parses_every_part_of_a_serial_url() {
        let usual = Serial {
            path: "/dev/ttyUSB0".to_owned(),
            baud: 9600,
            data_bits: DataBits::Eight,
            parity: Parity::Even,
            stop_bits: StopBits::One,
        };
        assert_eq!(target("serial:///dev/ttyUSB0").place, Place::Serial(usual.clone()));
        assert_eq!(
            target("serial:///dev/ttyUSB0?baud=9600&parity=even&data_bits=8&stop_bits=1").place,
            Place::Serial(usual.clone())
        );
        let other = Serial {
            path: "COM3".to_owned(),
            baud: 38_400,
            data_bits: DataBits::Seven,
            parity: Parity::None,
            stop_bits: StopBits::Two,
        };
        assert_eq!(target("serial://COM3?stop_bits=2&parity=none&baud=38400&data_bits=7").place, Place::Serial(other));
        let odd = Serial { path: "/dev/a b".to_owned(), parity: Parity::Odd, ..usual };
        assert_eq!(target("serial:///dev/a%20b?parity=odd").place, Place::Serial(odd));
    }

    #[test]
    fn parses_every_part_of_a_tcp_url() {
        let tcp = |host: &str, port, baud| Place::Tcp(Tcp { host: host.to_owned(), port, baud });
        assert_eq!(target("tcp://moxa:4001").place, tcp("moxa", 4001, 9600));
        assert_eq!(target("tcp://[::1]:4001/?baud=19200").place, tcp("::1", 4001, 19_200));
    }

    #[test]
    fn simulator_takes_parameters_of_its_family() {
        for (url, family, why) in [
            ("sim:?axes=2&baud=9600&state=a.toml&fault=echo", Family::Toyo, None),
            ("sim:?model=fs100&move_words=25&state=a.toml", Family::Yerc, None),
            ("sim:?state=a.toml&bus=eip&fault=drop=5%25,stall", Family::Yrcx, None),
            ("sim:?bus=eip", Family::Toyo, Some("'bus' in a sim: URL is for yrcx, not for toyo")),
            ("sim:?bus=eip", Family::Yrcx, None),
            ("sim:?bus=eip", Family::Toyo, Some("'bus' in a sim: URL is for yrcx, not for toyo")),
            ("sim:?axes=2", Family::Yerc, Some("'axes' in a sim: URL is for toyo, not for yerc")),
            ("sim:?baud=9600", Family::Yerc, Some("'baud' in a sim: URL is for toyo, not for yerc")),
            ("sim:?model=fs100", Family::Toyo, Some("'model' in a sim: URL is for yerc, not for toyo")),
            ("sim:?move_words=25", Family::Toyo, Some("'move_words' in a sim: URL is for yerc, not for toyo")),
            ("tcp://h:1", Family::Yerc, Some("a yerc robot cannot have a tcp: URL")),
            ("udp://h", Family::Toyo, Some("a toyo robot cannot have a udp: URL")),
        ] {
            assert_eq!(target(url).check(family).err().as_deref(), why, "{url}");
        }
    }

    #[test]
    fn shortens_names() {
        for (url, name) in [
            ("udp://10.0.0.2:10040", "10.0.0.2"),
            ("serial:///dev/serial/by-id/usb-FTDI-if00?baud=19200", "usb-FTDI-if00"),
            ("serial://COM3", "COM3"),
            ("tcp://moxa:4001", "moxa"),
            ("eip://rcx340?rpi=5ms", "rcx340"),
            ("sim:?axes=2", "sim"),
        ] {
            assert_eq!(target(url).short_name(), name);
        }
    }

    #[test]
    fn infers_the_family_of_a_scheme() {
        assert_eq!(target("udp://h").family(), Some(Family::Yerc));
        assert_eq!(target("sim:").family(), None);
        assert_eq!(target("serial:///dev/ttyUSB0").family(), Some(Family::Toyo));
        assert_eq!(target("tcp://h:4001").family(), Some(Family::Toyo));
        assert_eq!(target("eip://h").family(), Some(Family::Yrcx));
    }
}

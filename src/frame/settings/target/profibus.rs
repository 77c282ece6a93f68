//! `profibus://` URLs: a PROFIBUS DP slave behind an adapter. The manufacturer has not published ident number and
//! configuration of its unit. What the URL omits is read from the slave.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use super::bus::{Place, Scheme};
use super::{Address, Query, choice};
use crate::settings::duration;

/// Default address of this program: the usual one of a single master.
const MASTER: u8 = 2;
const MAX_STATION: u8 = 125;
/// Bit rates that adapters support.
const RATES: [(&str, u32); 7] = [
    ("500k", 500_000),
    ("9.6k", 9_600),
    ("19.2k", 19_200),
    ("45.45k", 45_450),
    ("93.75k", 93_750),
    ("187.5k", 187_500),
    ("1.5M", 1_500_000),
];
/// Bit rates of the bus that are too fast for adapters.
const TOO_FAST: [&str; 3] = ["3M", "6M", "12M"];

/// The scheme.
pub const SCHEME: Scheme = Scheme {
    name: "profibus",
    bus: "profibus",
    simulators: &["profibus"],
    shortest: "profibus:///dev/ttyUSB0?station=5",
    form: "profibus:///dev/ttyUSB0?station=5[&baud=500k&slot=10ms&gsd=FILE]",
    about: "yrcx: RS-485 adapter, and the station of the controller",
    parse: |place, query| {
        let profibus = parse(place, query)?;
        let address = match Address::device(&profibus.port) {
            // Several stations can share a line.
            Address::Device(port) => Address::Device(format!("{port} station {}", profibus.station)),
            other => other,
        };
        Ok(Place {
            address,
            short_name: format!("station {} on {}", profibus.station, profibus.port),
            is_owner: profibus.is_owner,
            options: Arc::new(profibus),
        })
    },
};

/// A controller as a PROFIBUS DP slave.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Profibus {
    /// The adapter: `/dev/ttyUSB0`, `COM3`.
    pub port: String,
    /// Station address of the slave.
    pub station: u8,
    /// Address of this program.
    pub master: u8,
    /// Bits per second.
    pub baud: u32,
    /// Whether the connection controls the robot; if not, it only listens to another master.
    pub is_owner: bool,
    /// Time limit for the start of an answer.
    pub slot: Option<Duration>,
    /// Number of repetitions of a request.
    pub retries: Option<u8>,
    /// Time between two exchanges.
    pub cycle: Option<Duration>,
    /// Watchdog time of the slave.
    pub watchdog: Option<Duration>,
    /// Expected ident number.
    pub ident: Option<u16>,
    /// Identifier bytes.
    pub configuration: Option<Vec<u8>>,
    /// User parameters.
    pub parameters: Option<Vec<u8>>,
    /// GSD file.
    pub gsd: Option<PathBuf>,
    /// Module of the GSD file, if several fit.
    pub module: Option<String>,
    /// Whether command words have their high byte first.
    pub is_big_endian: bool,
}

/// Parses the part after `profibus:`.
fn parse(place: &str, query: &mut Query) -> Result<Profibus, String> {
    let port = place.strip_prefix("//").ok_or("two slashes are missing after profibus:")?;
    if port.is_empty() || port == "/" {
        return Err("the adapter is missing, for example profibus:///dev/ttyUSB0?station=5".to_owned());
    }
    let station =
        query.take("station").ok_or("station is missing: add the address of the controller on the bus (0 to 125)")?;
    let gsd = query.take("gsd").map(PathBuf::from);
    let module = query.take("module");
    if module.is_some() && gsd.is_none() {
        return Err("module needs a GSD file: add gsd=FILE".to_owned());
    }
    Ok(Profibus {
        port: port.to_owned(),
        station: address("station", &station)?,
        master: query.take("master").map_or(Ok(MASTER), |text| address("master", &text))?,
        baud: query.take("baud").map_or(Ok(RATES[0].1), |text| baud(&text))?,
        is_owner: choice(query, "role", [("owner", true), ("listen", false)])?,
        slot: time(query, "slot")?,
        retries: query.take("retries").map(|text| retries(&text)).transpose()?,
        cycle: time(query, "cycle")?,
        watchdog: time(query, "watchdog")?,
        ident: query.take("ident").map(|text| ident(&text)).transpose()?,
        configuration: query.take("cfg").map(|text| bytes("cfg", &text)).transpose()?,
        parameters: query.take("prm").map(|text| bytes("prm", &text)).transpose()?,
        gsd,
        module,
        is_big_endian: choice(query, "words", [("le", false), ("be", true)])?,
    })
}

fn address(name: &str, text: &str) -> Result<u8, String> {
    let address = text.parse().ok().filter(|address| *address <= MAX_STATION);
    address.ok_or_else(|| format!("{name} must be a number from 0 to {MAX_STATION}, not '{text}'"))
}

/// Parses `500k`, or a number.
fn baud(text: &str) -> Result<u32, String> {
    if TOO_FAST.contains(&text) {
        return Err(format!("baud: {text} is too fast for a serial adapter; set the bus to 1.5M or less"));
    }
    let found = RATES.iter().find(|(name, baud)| *name == text || baud.to_string() == text);
    found.map(|(_, baud)| *baud).ok_or_else(|| {
        let names = RATES.map(|(name, _)| name).join(", ");
        format!("baud must be one of {names}, not '{text}'")
    })
}

fn retries(text: &str) -> Result<u8, String> {
    text.parse()
        .ok()
        .filter(|count| *count <= 15)
        .ok_or_else(|| format!("retries must be a number from 0 to 15, not '{text}'"))
}

fn time(query: &mut Query, name: &str) -> Result<Option<Duration>, String> {
    query.take(name).map(|text| duration::parse(&text).map_err(|error| format!("{name}: {error}"))).transpose()
}

fn ident(text: &str) -> Result<u16, String> {
    let digits = text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")).unwrap_or(text);
    let ident = (digits.len() <= 4).then(|| u16::from_str_radix(digits, 16).ok()).flatten();
    ident.ok_or_else(|| format!("ident must have up to four hexadecimal digits such as 0x1234, not '{text}'"))
}

/// Parses `C0D7D7`, optionally with dots or colons.
fn bytes(name: &str, text: &str) -> Result<Vec<u8>, String> {
    let wrong = || format!("{name} must be bytes in hexadecimal such as C0D7D7, not '{text}'");
    let digits: Vec<char> = text.chars().filter(|character| !matches!(character, '.' | ':' | ' ')).collect();
    if digits.len() % 2 == 1 || digits.len() > 2 * 244 {
        return Err(wrong());
    }
    let byte = |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16).map_err(|_| wrong());
    digits.chunks(2).map(byte).collect()
}

#[cfg(test)]
mod tests {
    use super::super::bus::testing::{options, rejects};
    use super::*;

    #[test]
    fn parses_every_part_of_a_url() {
        let usual = options::<Profibus>("profibus:///dev/ttyUSB0?station=5");
        assert_eq!((usual.port.as_str(), usual.station, usual.master), ("/dev/ttyUSB0", 5, 2));
        assert_eq!((usual.baud, usual.is_owner, usual.is_big_endian), (500_000, true, false));
        assert_eq!(usual.configuration.as_ref().or(usual.parameters.as_ref()), None);
        let url = "profibus://COM3?station=125&master=1&baud=1.5M&role=listen&slot=30ms&retries=2&cycle=50ms&watchdog=1s\
                   &ident=0xBEEF&cfg=C0.D7.D7&prm=000000&gsd=a.gsd&module=M&words=be";
        let all = options::<Profibus>(url);
        let ms = |ms| Some(Duration::from_millis(ms));
        assert_eq!((all.port.as_str(), all.station, all.master, all.baud), ("COM3", 125, 1, 1_500_000));
        assert_eq!((all.is_owner, all.slot, all.retries, all.cycle), (false, ms(30), Some(2), ms(50)));
        assert_eq!((all.watchdog, all.ident, all.is_big_endian), (ms(1000), Some(0xBEEF), true));
        assert_eq!((all.configuration, all.parameters), (Some(vec![0xC0, 0xD7, 0xD7]), Some(vec![0; 3])));
        assert_eq!((all.gsd, all.module.as_deref()), (Some(PathBuf::from("a.gsd")), Some("M")));
    }

    #[test]
    fn names_mistakes_in_urls() {
        rejects(&[
            ("profibus:COM3?station=5", "slashes"),
            ("profibus://?station=5", "adapter is missing"),
            ("profibus:///dev/ttyUSB0", "station is missing"),
            ("profibus:///dev/ttyUSB0?station=126", "0 to 125, not '126'"),
            ("profibus:///dev/ttyUSB0?station=5&master=x", "master must be a number"),
            ("profibus:///dev/ttyUSB0?station=5&baud=12M", "too fast"),
            ("profibus:///dev/ttyUSB0?station=5&baud=fast", "1.5M, not 'fast'"),
            ("profibus:///dev/ttyUSB0?station=5&role=boss", "role must be owner or listen"),
            ("profibus:///dev/ttyUSB0?station=5&slot=soon", "slot: 'soon'"),
            ("profibus:///dev/ttyUSB0?station=5&retries=16", "retries must be a number from 0 to 15"),
            ("profibus:///dev/ttyUSB0?station=5&ident=12345", "four hexadecimal digits"),
            ("profibus:///dev/ttyUSB0?station=5&cfg=C0D", "cfg must be bytes in hexadecimal"),
            ("profibus:///dev/ttyUSB0?station=5&prm=GG", "prm must be bytes in hexadecimal"),
            ("profibus:///dev/ttyUSB0?station=5&module=M", "add gsd=FILE"),
            ("profibus:///dev/ttyUSB0?station=5&words=middle", "words must be le or be"),
            ("profibus:///dev/ttyUSB0?station=5&speed=1", "unknown parameter 'speed'"),
        ]);
    }

    #[test]
    fn stations_on_one_line_are_different_controllers() {
        let address = |url: &str| Address::of(&url.parse().unwrap());
        let five = address("profibus:///dev/null?station=5");
        assert!(five.meets(&address("profibus:///dev/../dev/null?station=5&baud=9.6k")));
        assert!(!five.meets(&address("profibus:///dev/null?station=6")));
    }
}

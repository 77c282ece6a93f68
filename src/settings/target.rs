//! Target URLs: where a robot is, and over which transport.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use crate::controller::yerc::Model;
use crate::failure::Failure;

/// A controller family, named like its subcommand.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// Yaskawa FS100 / DX200, high-speed Ethernet server.
    Yerc,
    /// OMRON / Yamaha YRCX, remote commands over a fieldbus.
    Yrcx,
    /// Toyo, RS-232C host communication.
    Toyo,
}

impl Family {
    /// Every family, in the order help texts list them.
    pub const ALL: [Self; 3] = [Self::Yerc, Self::Yrcx, Self::Toyo];

    /// The subcommand, the name of a link to the binary, and the value in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Yerc => "yerc",
            Self::Yrcx => "yrcx",
            Self::Toyo => "toyo",
        }
    }

    /// The kinds of URL that reach it.
    const fn schemes(self) -> &'static [&'static str] {
        match self {
            Self::Yerc => &["udp", "sim"],
            Self::Yrcx => &["eip", "sim"],
            Self::Toyo => &["serial", "tcp", "sim"],
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
        found.ok_or_else(|| format!("unknown family '{text}'; there are yerc, yrcx and toyo"))
    }
}

/// Where a robot is: one URL, taken apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Target {
    /// As given.
    url: String,
    /// Its parts.
    pub place: Place,
}

/// What a target URL leads to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Place {
    /// `udp://HOST[:10040][?file_port=10041&model=fs100|dx200&move_words=25|26]`.
    Udp(Udp),
    /// `sim:[?model=…&state=FILE&fault=…]`: the built-in simulator of the family, in this process.
    Sim(Sim),
    /// A URL of a family that this version has no link for yet.
    Other {
        /// `eip`, `serial` or `tcp`.
        scheme: String,
    },
}

/// A high-speed Ethernet server on the network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Udp {
    /// Name or address.
    pub host: String,
    /// Port of the robot server.
    pub port: u16,
    /// Port of the file server.
    pub file_port: u16,
    /// What stands in the URL about the controller.
    pub traits: YercTraits,
}

/// What a URL can say about a yerc controller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct YercTraits {
    /// Controller model.
    pub model: Option<Model>,
    /// Words of the cartesian move, 25 or 26 (FS 3.3.39 prints 25 for the FS100; every public client sends 26).
    pub move_words: Option<u8>,
}

/// The built-in simulator.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sim {
    /// Controller model.
    pub traits: YercTraits,
    /// A file with the start state.
    pub state: Option<PathBuf>,
    /// Faults on the line, in the form of `armctl sim --fault`.
    pub fault: Option<String>,
}

/// Port of the robot server (spec: frame table; UDP).
const ROBOT_PORT: u16 = 10040;
/// Port of the file server.
const FILE_PORT: u16 = 10041;

impl Target {
    /// The simulator with its built-in start state.
    pub fn simulator() -> Self {
        Self { url: "sim:".to_owned(), place: Place::Sim(Sim::default()) }
    }

    /// The URL as given.
    pub fn url(&self) -> &str {
        &self.url
    }

    /// Whether nothing real can move.
    pub fn is_simulated(&self) -> bool {
        matches!(self.place, Place::Sim(_))
    }

    /// `udp`, `sim`, …
    pub fn scheme(&self) -> &str {
        match &self.place {
            Place::Udp(_) => "udp",
            Place::Sim(_) => "sim",
            Place::Other { scheme } => scheme,
        }
    }

    /// A short name for messages where no inventory gives one: the host, or `sim`.
    pub fn short_name(&self) -> String {
        match &self.place {
            Place::Udp(udp) => udp.host.clone(),
            Place::Sim(_) => "sim".to_owned(),
            Place::Other { .. } => self.url.clone(),
        }
    }

    /// What the URL says about a yerc controller.
    pub fn traits(&self) -> YercTraits {
        match &self.place {
            Place::Udp(udp) => udp.traits,
            Place::Sim(sim) => sim.traits,
            Place::Other { .. } => YercTraits::default(),
        }
    }

    /// The only family this URL can reach, if it is but one.
    pub fn family(&self) -> Option<Family> {
        let mut fitting = Family::ALL.into_iter().filter(|family| family.schemes().contains(&self.scheme()));
        let first = fitting.next();
        if fitting.next().is_some() { None } else { first }
    }

    /// Whether `family` can be reached over this URL.
    pub fn reaches(&self, family: Family) -> bool {
        family.schemes().contains(&self.scheme())
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
        let wrong = |why: String| {
            Failure::usage(format!("target '{url}': {why}")).hint(
                "write udp://HOST[:10040][?file_port=10041&model=dx200] for a controller, or sim: for the simulator",
            )
        };
        let (scheme, rest) =
            url.split_once(':').ok_or_else(|| wrong("there is no scheme such as udp:// in it".into()))?;
        let (place, query) = rest.split_once('?').unwrap_or((rest, ""));
        let mut query = Query::parse(query).map_err(wrong)?;
        let place = match scheme {
            "udp" => Place::Udp(udp(place, &mut query).map_err(wrong)?),
            "sim" => Place::Sim(sim(place, &mut query).map_err(wrong)?),
            "eip" | "serial" | "tcp" => Place::Other { scheme: scheme.to_owned() },
            _ => return Err(wrong(format!("unknown scheme '{scheme}'"))),
        };
        if !matches!(place, Place::Other { .. }) {
            query.finish().map_err(wrong)?;
        }
        Ok(Self { url: url.to_owned(), place })
    }
}

fn udp(place: &str, query: &mut Query) -> Result<Udp, String> {
    let authority = place.strip_prefix("//").ok_or("two slashes are missing after udp:")?;
    let authority = authority.strip_suffix('/').unwrap_or(authority);
    let (host, port) = host_and_port(authority)?;
    let port = match port {
        Some(port) => self::port("port", port)?,
        None => ROBOT_PORT,
    };
    let file_port = match query.take("file_port") {
        Some(port) => self::port("file_port", &port)?,
        None => FILE_PORT,
    };
    Ok(Udp { host, port, file_port, traits: traits(query)? })
}

fn sim(place: &str, query: &mut Query) -> Result<Sim, String> {
    if !place.is_empty() {
        return Err(format!("'{place}' after sim: means nothing; parameters start with ?"));
    }
    Ok(Sim { traits: traits(query)?, state: query.take("state").map(PathBuf::from), fault: query.take("fault") })
}

fn traits(query: &mut Query) -> Result<YercTraits, String> {
    let model = query.take("model").map(|name| name.parse()).transpose()?;
    let move_words = match query.take("move_words").as_deref() {
        None => None,
        Some("25") => Some(25),
        Some("26") => Some(26),
        Some(other) => return Err(format!("move_words is 25 or 26, not '{other}'")),
    };
    Ok(YercTraits { model, move_words })
}

/// Splits `host:port`, `[v6]:port`, or either without a port.
fn host_and_port(authority: &str) -> Result<(String, Option<&str>), String> {
    let (host, port) = if let Some(rest) = authority.strip_prefix('[') {
        let (host, rest) = rest.split_once(']').ok_or("the bracket of the IPv6 address is not closed")?;
        match rest.strip_prefix(':') {
            Some(port) => (host, Some(port)),
            None if rest.is_empty() => (host, None),
            None => return Err(format!("'{rest}' after the address is no port")),
        }
    } else {
        match authority.split_once(':') {
            Some((host, port)) => (host, Some(port)),
            None => (authority, None),
        }
    };
    if host.is_empty() {
        return Err("the host is missing".to_owned());
    }
    if host.chars().any(|c| c.is_whitespace() || c.is_control() || "/@#".contains(c)) {
        return Err(format!("'{host}' is no host name"));
    }
    Ok((host.to_owned(), port))
}

fn port(name: &str, text: &str) -> Result<u16, String> {
    match text.parse() {
        Ok(port) if port > 0 => Ok(port),
        _ => Err(format!("{name} is a number from 1 to 65535, not '{text}'")),
    }
}

/// The part of a URL after `?`.
struct Query(Vec<(String, String)>);

impl Query {
    fn parse(text: &str) -> Result<Self, String> {
        let mut pairs: Vec<(String, String)> = Vec::new();
        for pair in text.split('&').filter(|pair| !pair.is_empty()) {
            let (key, value) = pair.split_once('=').ok_or_else(|| format!("'{pair}' has no value"))?;
            if pairs.iter().any(|(known, _)| known == key) {
                return Err(format!("'{key}' is there twice"));
            }
            pairs.push((key.to_owned(), percent_decoded(value)?));
        }
        Ok(Self(pairs))
    }

    fn take(&mut self, key: &str) -> Option<String> {
        let index = self.0.iter().position(|(known, _)| known == key)?;
        Some(self.0.remove(index).1)
    }

    /// What nobody took is a mistake, not decoration.
    fn finish(&self) -> Result<(), String> {
        match self.0.first() {
            None => Ok(()),
            Some((key, _)) => Err(format!("unknown parameter '{key}'")),
        }
    }
}

fn percent_decoded(text: &str) -> Result<String, String> {
    let wrong = || format!("'{text}' has a damaged % escape");
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let mut digit = || rest.next().and_then(|byte| char::from(byte).to_digit(16)).ok_or_else(wrong);
        let value = digit()? * 16 + digit()?;
        bytes.push(u8::try_from(value).map_err(|_| wrong())?);
    }
    String::from_utf8(bytes).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn target(url: &str) -> Target {
        url.parse().unwrap()
    }

    #[test]
    fn ports_default_to_those_of_the_protocol() {
        let Place::Udp(udp) = target("udp://10.0.0.2").place else { panic!("not udp") };
        assert_eq!((udp.host.as_str(), udp.port, udp.file_port), ("10.0.0.2", 10040, 10041));
    }

    #[test]
    fn everything_a_udp_url_can_say() {
        let Place::Udp(udp) = target("udp://[::1]:2000?file_port=2001&model=fs100&move_words=25").place else {
            panic!("not udp")
        };
        assert_eq!((udp.host.as_str(), udp.port, udp.file_port), ("::1", 2000, 2001));
        assert_eq!(udp.traits, YercTraits { model: Some(Model::Fs100), move_words: Some(25) });
    }

    #[test]
    fn mistakes_are_named() {
        for (url, part) in [
            ("robot", "scheme"),
            ("http://x", "unknown scheme"),
            ("udp:x", "slashes"),
            ("udp://", "host is missing"),
            ("udp://h:0", "1 to 65535"),
            ("udp://h:70000", "1 to 65535"),
            ("udp://h?modle=fs100", "modle"),
            ("udp://h?model=yrc1000", "unknown model"),
            ("udp://h?model=fs100&model=dx200", "twice"),
            ("sim:dx200", "means nothing"),
            ("sim:?fault=%4", "damaged"),
        ] {
            let failure = url.parse::<Target>().unwrap_err();
            assert!(failure.message.contains(part), "{url}: {}", failure.message);
            assert!(failure.hint.is_some());
        }
    }

    #[test]
    fn a_scheme_tells_the_family_where_only_one_uses_it() {
        assert_eq!(target("udp://h").family(), Some(Family::Yerc));
        assert_eq!(target("sim:").family(), None);
        assert!(target("serial:///dev/ttyUSB0").reaches(Family::Toyo));
    }
}

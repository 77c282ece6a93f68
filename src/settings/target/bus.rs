//! URLs of the fieldbuses that a yrcx may be on. Each fieldbus has a file here and a line for each of its schemes in
//! [`BUSES`]; `command/yrcx/buses.rs` has what is done over it.

use std::any::Any;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

#[cfg(target_os = "linux")]
use super::profinet;
use super::{Address, Query, devicenet, eip, profibus};

/// The one that hints name first.
pub const USUAL: Scheme = eip::SCHEME;

/// All of them.
pub static BUSES: &[Scheme] = &[
    eip::SCHEME,
    devicenet::SLCAN,
    devicenet::CAN,
    profibus::SCHEME,
    #[cfg(target_os = "linux")]
    profinet::SCHEME,
];

/// What `bus=` of a `sim:` URL may be, with the fieldbus that it names.
pub fn simulators() -> impl Iterator<Item = (&'static str, &'static str)> {
    BUSES.iter().flat_map(|scheme| scheme.simulators.iter().map(|name| (*name, scheme.bus)))
}

/// A kind of URL that leads to a yrcx over a fieldbus.
#[derive(Debug, Clone, Copy)]
pub struct Scheme {
    /// What stands before the colon.
    pub name: &'static str,
    /// The fieldbus: the word of its commands (`armctl yrcx eip`), and the name of its folders.
    pub bus: &'static str,
    /// What `bus=` of a `sim:` URL may be to have a controller on it simulated.
    pub simulators: &'static [&'static str],
    /// The shortest URL there is, for hints: `eip://HOST`.
    pub shortest: &'static str,
    /// What URLs look like, with the options that matter most.
    pub form: &'static str,
    /// What comes after it, for completion.
    pub about: &'static str,
    /// Reads what stands between the scheme and the question mark, and takes the options that it knows.
    pub(super) parse: fn(&str, &mut Query) -> Result<Place, String>,
}

/// Where a URL of a fieldbus leads, and what else it says.
pub struct Place {
    /// Which controller it is.
    pub address: Address,
    /// A short name of it, for messages: a host, a port, a station.
    pub short_name: String,
    /// Whether a connection is to command the controller; else it only sees.
    pub is_owner: bool,
    /// All that the URL says, for whoever knows the bus.
    pub options: Arc<dyn Any + Send + Sync>,
}

/// A controller on a fieldbus.
#[derive(Clone)]
pub struct Bus {
    /// The kind of URL.
    pub scheme: &'static Scheme,
    /// Whether a connection is to command the controller; else it only sees.
    pub is_owner: bool,
    /// Whoever only looks now and then wants no images in shorter intervals than this.
    pub calm: Duration,
    address: Address,
    short_name: String,
    options: Arc<dyn Any + Send + Sync>,
    /// What was parsed.
    text: String,
}

impl Bus {
    pub(super) fn parse(scheme: &'static Scheme, place: &str, query: &mut Query) -> Result<Self, String> {
        let text = format!("{place}?{query}");
        let Place { address, short_name, is_owner, options } = (scheme.parse)(place, query)?;
        Ok(Self { scheme, is_owner, calm: Duration::ZERO, address, short_name, options, text })
    }

    /// Which controller it is.
    pub fn address(&self) -> &Address {
        &self.address
    }

    /// A short name of it, for messages.
    pub fn short_name(&self) -> &str {
        &self.short_name
    }

    /// What the URL says, in the type of its scheme.
    pub fn options<T: Any>(&self) -> Option<&T> {
        self.options.downcast_ref()
    }
}

impl fmt::Debug for Bus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.scheme.name, self.text)
    }
}

impl PartialEq for Bus {
    fn eq(&self, other: &Self) -> bool {
        (self.scheme.name, &self.text, self.calm) == (other.scheme.name, &other.text, other.calm)
    }
}

impl Eq for Bus {}

#[cfg(test)]
mod tests {
    use super::super::Target;
    use super::*;

    #[test]
    fn every_scheme_says_how_its_urls_look() {
        for scheme in BUSES {
            assert!(scheme.shortest.starts_with(&format!("{}:", scheme.name)), "{scheme:?}");
            assert!(scheme.form.starts_with(&format!("{}:", scheme.name)), "{scheme:?}");
            let target: Target = scheme.shortest.to_lowercase().parse().unwrap();
            assert_eq!(target.scheme(), scheme.name);
            assert_eq!(target.family(), Some(super::super::Family::Yrcx));
        }
    }
}

//! Fieldbus URLs for yrcx. Each fieldbus has a file here and a line per scheme in [`BUSES`]. `command/yrcx/buses.rs`
//! has its commands.

use std::any::Any;
use std::fmt;
use std::sync::Arc;
use std::time::Duration;

use super::{Address, Query, devicenet, eip, profibus, profinet};

/// Scheme that hints name first.
pub const USUAL: Scheme = eip::SCHEME;

/// All schemes.
pub static BUSES: &[Scheme] = &[eip::SCHEME, devicenet::SLCAN, devicenet::CAN, profibus::SCHEME, profinet::SCHEME];

/// Values of `bus=` in a `sim:` URL, with their fieldbus.
pub fn simulators() -> impl Iterator<Item = (&'static str, &'static str)> {
    BUSES.iter().flat_map(|scheme| scheme.simulators.iter().map(|name| (*name, scheme.bus)))
}

/// A URL scheme for yrcx over a fieldbus.
#[derive(Debug, Clone, Copy)]
pub struct Scheme {
    /// Name before the colon.
    pub name: &'static str,
    /// Name of the fieldbus: its command word (`armctl yrcx eip`) and its folders.
    pub bus: &'static str,
    /// Values of `bus=` in a `sim:` URL for this fieldbus.
    pub simulators: &'static [&'static str],
    /// Shortest URL for hints: `eip://HOST`.
    pub shortest: &'static str,
    /// Form of the URL with the most important options.
    pub form: &'static str,
    /// Description for completion.
    pub about: &'static str,
    /// Parses the part between the scheme and the question mark, and takes its options from the query.
    pub(super) parse: fn(&str, &mut Query) -> Result<Place, String>,
}

/// Parsed part of a fieldbus URL.
pub struct Place {
    /// Address of the controller.
    pub address: Address,
    /// Short name for messages: host, port or station.
    pub short_name: String,
    /// Whether a connection controls the robot; if not, it only reads.
    pub is_owner: bool,
    /// All options, in the type of the fieldbus.
    pub options: Arc<dyn Any + Send + Sync>,
}

/// A controller on a fieldbus.
#[derive(Clone)]
pub struct Bus {
    /// URL scheme.
    pub scheme: &'static Scheme,
    /// Whether a connection controls the robot; if not, it only reads.
    pub is_owner: bool,
    /// Minimum interval of images for a caller that reads rarely.
    pub listen_before: Duration,
    address: Address,
    short_name: String,
    options: Arc<dyn Any + Send + Sync>,
    /// Text of the URL.
    text: String,
}

impl Bus {
    pub(super) fn parse(scheme: &'static Scheme, place: &str, query: &mut Query) -> Result<Self, String> {
        let text = format!("{place}?{query}");
        let Place { address, short_name, is_owner, options } = (scheme.parse)(place, query)?;
        Ok(Self { scheme, is_owner, listen_before: Duration::ZERO, address, short_name, options, text })
    }

    /// Address of the controller.
    pub fn address(&self) -> &Address {
        &self.address
    }

    /// Short name for messages.
    pub fn short_name(&self) -> &str {
        &self.short_name
    }

    /// Options in the type of the fieldbus.
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
        (self.scheme.name, &self.text, self.listen_before) == (other.scheme.name, &other.text, other.listen_before)
    }
}

impl Eq for Bus {}

#[cfg(test)]
pub(super) mod testing {
    use std::any::Any;

    use super::super::{Place, Target};

    /// Options of a fieldbus URL.
    pub fn options<T: Any + Clone>(url: &str) -> T {
        match url.parse::<Target>().unwrap().place {
            Place::Bus(bus) => bus.options::<T>().unwrap().clone(),
            other => panic!("{other:?}"),
        }
    }

    /// Each URL is wrong, with this part in its message.
    pub fn rejects(cases: &[(&str, &str)]) {
        for (url, part) in cases {
            let failure = url.parse::<Target>().unwrap_err();
            assert!(failure.message.contains(part), "{url}: {failure}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Target;
    use super::*;

    #[test]
    fn every_scheme_describes_its_urls() {
        for scheme in BUSES {
            assert!(scheme.shortest.starts_with(&format!("{}:", scheme.name)), "{scheme:?}");
            assert!(scheme.form.starts_with(&format!("{}:", scheme.name)), "{scheme:?}");
            let target: Target = scheme.shortest.to_lowercase().parse().unwrap();
            assert_eq!(target.scheme(), scheme.name);
            assert_eq!(target.family(), Some(super::super::Family::Yrcx));
        }
    }
}

//! Fault injection with a seed, without sockets and clock: [`Faults`] for datagrams, [`LineFaults`] for a serial line.
//! [`SimulatorFaults`] adds the faults of the simulated device itself.
//!
//! The input is the traffic that is sent. The output is the traffic that arrives. The same seed and the same traffic
//! give the same faults on every computer.

mod datagram;
mod line;

use std::fmt;
use std::ops::RangeInclusive;
use std::time::Duration;

use fastrand::Rng;
use thiserror::Error;

/// Declares the faults of a simulated device. Columns: variant, name, effect.
#[cfg(feature = "fieldbus")]
macro_rules! device_faults {
    ($(#[$doc:meta])* $device:ident { $($fault:ident $name:literal $effect:literal,)* }) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
        pub enum $device {
            $(#[doc = $effect] $fault,)*
        }

        impl $device {
            /// All faults with their names.
            pub const ALL: [(&str, Self); [$($name),*].len()] = [$(($name, Self::$fault),)*];
        }
    };
}

pub use datagram::{FaultSpec, Faults};
#[cfg(feature = "fieldbus")]
pub(crate) use device_faults;
pub use line::{FaultedCharacters, LineFaultSpec, LineFaults};

/// Longest delay that a specification can contain.
const MAX_DELAY: Duration = Duration::from_secs(60);

/// A rate in steps of 0.01 %.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Share(u16);

impl Share {
    /// A rate of 0 %.
    pub const NONE: Self = Self(0);
    /// A rate of 100 %.
    pub const ALL: Self = Self(10_000);

    /// The rate in steps of 1/10,000.
    pub const fn per_10_000(self) -> u16 {
        self.0
    }

    /// The rate as a number from 0.0 to 1.0.
    pub fn fraction(self) -> f64 {
        f64::from(self.0) / f64::from(Self::ALL.0)
    }

    fn occurs(self, rng: &mut Rng) -> bool {
        rng.u16(0..Self::ALL.0) < self.0
    }

    /// Parses a rate, for example "5%" or "0.25%".
    fn parse(text: &str) -> Option<Self> {
        let number = text.strip_suffix('%')?;
        let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
        let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
        if !digits(whole) || !digits(fraction) || fraction.len() > 2 {
            return None;
        }
        let hundredths: u16 = format!("{fraction:0<2}").parse().ok()?;
        let share = whole.parse::<u16>().ok()?.checked_mul(100)?.checked_add(hundredths)?;
        (share <= Self::ALL.0).then_some(Self(share))
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.0 / 100, self.0 % 100) {
            (whole, 0) => write!(f, "{whole}%"),
            (whole, hundredths) if hundredths % 10 == 0 => write!(f, "{whole}.{}%", hundredths / 10),
            (whole, hundredths) => write!(f, "{whole}.{hundredths:02}%"),
        }
    }
}

/// Error of a [`FaultSpec`] or [`LineFaultSpec`] text.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum FaultSpecError {
    /// A fault that needs a value has none.
    #[error("{key} needs a value: {form}")]
    NoValue {
        /// The key.
        key: &'static str,
        /// Valid form of the value.
        form: &'static str,
    },
    /// The text contains an unknown fault.
    #[error("unknown fault '{name}'; the faults are {known}")]
    Unknown {
        /// The name.
        name: String,
        /// The valid names.
        known: String,
    },
    /// The text contains two faults of the device. A device can have only one fault at a time.
    #[error("{first} and {second} cannot be used together")]
    TwoOfDevice {
        /// The first fault.
        first: &'static str,
        /// The second fault.
        second: &'static str,
    },
    /// The text contains a key twice.
    #[error("{0} appears twice")]
    Twice(&'static str),
    /// The value is not valid for its key.
    #[error("{key}: '{value}' is not {form}")]
    Value {
        /// The key.
        key: &'static str,
        /// The value.
        value: String,
        /// Valid form of the value.
        form: &'static str,
    },
    /// A key that has no value was given one.
    #[error("{key} takes no value, but has the value '{value}'")]
    NeedlessValue {
        /// The key.
        key: &'static str,
        /// The value.
        value: String,
    },
}

const SHARE_FORM: &str = "a percentage from 0% to 100% with at most two decimals, for example 2.5%";
const DELAY_FORM: &str = "a time or range of up to 60s in us, ms or s, for example 20ms or 0..50ms";
const SEED_FORM: &str = "a whole number from 0 to 18446744073709551615";

/// Faults of a link that can be written as text.
pub trait FaultText: Default + 'static {
    /// Names of the faults, each with the function that sets its value.
    const KEYS: &'static [Key<Self>];
}

/// Name of a fault, with the function that sets its value in `S`.
pub type Key<S> = (&'static str, Setter<S>);

/// Function that sets one value of `S`.
#[derive(Debug)]
pub enum Setter<S> {
    /// A key with a value. The text describes the valid values. The function parses and sets a value, and returns
    /// `None` if the value is invalid.
    Value(&'static str, fn(&mut S, &str) -> Option<()>),
    /// A key without a value.
    Flag(fn(&mut S)),
}

/// Faults of a simulator: faults of its link, and at most one fault of the device.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SimulatorFaults<S, D> {
    /// Faults of the link; `None` if the text contains none.
    pub link: Option<S>,
    /// Fault of the device.
    pub device: Option<D>,
}

impl<S, D> Default for SimulatorFaults<S, D> {
    fn default() -> Self {
        Self { link: None, device: None }
    }
}

/// Names of the faults that a simulator supports.
#[derive(Debug, Clone, Copy)]
pub struct FaultNames<D: 'static> {
    /// Names of the faults of the link. They are a subset of [`FaultText::KEYS`].
    pub link: &'static [&'static str],
    /// Faults of the device, by name.
    pub device: &'static [(&'static str, D)],
}

impl<D: Copy> FaultNames<D> {
    /// Parses a text, for example `drop=5%,stall,seed=7`.
    ///
    /// # Errors
    /// [`FaultSpecError`] for an unknown name, a repeated name or an invalid value. The error for an unknown name
    /// contains the known names.
    pub fn parse<S: FaultText>(&self, text: &str) -> Result<SimulatorFaults<S, D>, FaultSpecError> {
        let of_device = |part: &str| self.device.iter().find(|(name, _)| *name == part);
        let (device, link): (Vec<&str>, Vec<&str>) =
            text.split(',').map(str::trim).partition(|part| of_device(part).is_some());
        let mut faults = SimulatorFaults::default();
        if !link.is_empty() {
            let keys: Vec<&Key<S>> = S::KEYS.iter().filter(|(name, _)| self.link.contains(name)).collect();
            faults.link = Some(parse(&link, &keys, self.device.iter().map(|(name, _)| *name))?);
        }
        let mut named = device.into_iter().filter_map(of_device);
        if let Some((first, fault)) = named.next() {
            faults.device = Some(*fault);
            match named.next() {
                Some((second, _)) if first == second => return Err(FaultSpecError::Twice(first)),
                Some((second, _)) => return Err(FaultSpecError::TwoOfDevice { first, second }),
                None => {}
            }
        }
        Ok(faults)
    }
}

/// Parses the faults of a link. All names in [`FaultText::KEYS`] are valid.
fn parse_link<S: FaultText>(text: &str) -> Result<S, FaultSpecError> {
    let parts: Vec<&str> = text.split(',').map(str::trim).collect();
    parse(&parts, &S::KEYS.iter().collect::<Vec<_>>(), [])
}

/// Parses the parts of a text. Each name may occur once. `others` contains more valid names that are not in `keys`;
/// only the error for an unknown name uses them.
fn parse<S: Default>(
    parts: &[&str],
    keys: &[&'static Key<S>],
    others: impl IntoIterator<Item = &'static str>,
) -> Result<S, FaultSpecError> {
    let mut spec = S::default();
    let mut seen = Vec::new();
    for part in parts {
        let (name, value) = part.split_once('=').map_or((*part, None), |(name, value)| (name, Some(value)));
        let Some((key, setter)) = keys.iter().find(|(key, _)| *key == name) else {
            let known: Vec<&str> = keys.iter().map(|(key, _)| *key).chain(others).collect();
            return Err(FaultSpecError::Unknown { name: name.to_owned(), known: known.join(", ") });
        };
        if seen.contains(key) {
            return Err(FaultSpecError::Twice(key));
        }
        seen.push(*key);
        match (setter, value) {
            (Setter::Flag(set), None) => set(&mut spec),
            (Setter::Flag(_), Some(value)) => {
                return Err(FaultSpecError::NeedlessValue { key, value: value.to_owned() });
            }
            (Setter::Value(form, set), Some(value)) => {
                set(&mut spec, value).ok_or_else(|| FaultSpecError::Value { key, value: value.to_owned(), form })?;
            }
            (Setter::Value(form, _), None) => return Err(FaultSpecError::NoValue { key, form }),
        }
    }
    Ok(spec)
}

/// Writes the rates that are not 0, each followed by a comma.
fn write_shares(f: &mut fmt::Formatter<'_>, shares: &[(&str, Share)]) -> fmt::Result {
    let mut some = shares.iter().filter(|(_, share)| *share != Share::NONE);
    some.try_for_each(|(key, share)| write!(f, "{key}={share},"))
}

/// Writes a delay, followed by a comma. Writes nothing if the delay is 0.
fn write_delay(f: &mut fmt::Formatter<'_>, delay: &RangeInclusive<Duration>) -> fmt::Result {
    let (least, most) = (delay.start(), delay.end());
    match least == most {
        true if most.is_zero() => Ok(()),
        true => write!(f, "delay={},", DelayText(*most)),
        false => write!(f, "delay={}..{},", DelayText(*least), DelayText(*most)),
    }
}

/// A time, shown in the largest unit that represents it exactly. The resolution is 1 µs.
struct DelayText(Duration);

impl fmt::Display for DelayText {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let micros = self.0.as_micros();
        match UNITS.iter().rev().find(|(_, unit)| micros.is_multiple_of(u128::from(*unit))) {
            Some((name, unit)) if micros > 0 => write!(f, "{}{name}", micros / u128::from(*unit)),
            _ => f.write_str("0ms"),
        }
    }
}

const UNITS: [(&str, u64); 3] = [("us", 1), ("ms", 1_000), ("s", 1_000_000)];

/// Parses a delay, for example "20ms", "0..50ms" or "500us..2ms". A lower limit without a unit has the unit of the
/// upper limit.
fn delay(text: &str) -> Option<RangeInclusive<Duration>> {
    let Some((least, most)) = text.split_once("..") else {
        let (number, unit) = number_and_unit(text);
        let fixed = time(number, unit)?;
        return Some(fixed..=fixed);
    };
    let (most_number, most_unit) = number_and_unit(most);
    let (least_number, least_unit) = number_and_unit(least);
    let least = time(least_number, if least_unit.is_empty() { most_unit } else { least_unit })?;
    let most = time(most_number, most_unit)?;
    (least <= most).then_some(least..=most)
}

fn number_and_unit(text: &str) -> (&str, &str) {
    text.split_at(text.bytes().take_while(u8::is_ascii_digit).count())
}

fn time(number: &str, unit: &str) -> Option<Duration> {
    let (_, micros) = UNITS.iter().find(|(name, _)| *name == unit)?;
    let time = Duration::from_micros(number.parse::<u64>().ok()?.checked_mul(*micros)?);
    (time <= MAX_DELAY).then_some(time)
}

fn between(rng: &mut Rng, range: &RangeInclusive<Duration>) -> Duration {
    let micros = |time: &Duration| u64::try_from(time.as_micros()).unwrap_or(u64::MAX);
    let (least, most) = (micros(range.start()), micros(range.end()));
    // The limits can be in the wrong order only in a specification that was not parsed from text.
    Duration::from_micros(if least < most { rng.u64(least..=most) } else { least })
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMES: FaultNames<u8> = FaultNames { link: &["drop", "delay", "seed"], device: &[("stall", 1), ("mute", 2)] };

    fn parsed(text: &str) -> Result<SimulatorFaults<FaultSpec, u8>, String> {
        NAMES.parse(text).map_err(|error| error.to_string())
    }

    #[test]
    fn faults_of_link_and_device_share_one_text() {
        let link = |text: &str| Some(text.parse::<FaultSpec>().unwrap());
        assert_eq!(parsed("stall"), Ok(SimulatorFaults { link: None, device: Some(1) }));
        assert_eq!(parsed("seed=7,drop=5%"), Ok(SimulatorFaults { link: link("drop=5%,seed=7"), device: None }));
        let both = SimulatorFaults { link: link("drop=5%,seed=7"), device: Some(2) };
        assert_eq!(parsed("drop=5%, mute, seed=7"), Ok(both));
    }

    #[test]
    fn errors_of_simulator_faults_list_the_names() {
        let names = "the faults are drop, delay, seed, stall, mute";
        for (text, message) in [
            ("", format!("unknown fault ''; {names}")),
            ("loud", format!("unknown fault 'loud'; {names}")),
            ("stall=1", format!("unknown fault 'stall'; {names}")),
            ("busy=5%", format!("unknown fault 'busy'; {names}")),
            ("stall,mute", "stall and mute cannot be used together".to_owned()),
            ("mute,mute", "mute appears twice".to_owned()),
        ] {
            assert_eq!(parsed(text), Err(message), "{text}");
        }
    }
}

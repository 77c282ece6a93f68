//! Parsers for the parts of a target URL.

use std::fmt;
use std::net::Ipv6Addr;
use std::ops::RangeInclusive;

use armctl_controller::similar_word::nearest;

const BAUDS: RangeInclusive<u32> = 50..=4_000_000;

/// Part between the slashes and the query.
pub fn confirmer<'a>(scheme: &str, place: &'a str) -> Result<&'a str, String> {
    let confirmer = place.strip_prefix("//").ok_or_else(|| format!("two slashes are missing after {scheme}:"))?;
    Ok(confirmer.strip_suffix('/').unwrap_or(confirmer))
}

/// Takes an option with fixed values; the first is the default.
pub fn choice<T: Copy, const N: usize>(query: &mut Query, key: &str, known: [(&str, T); N]) -> Result<T, String> {
    let Some(given) = query.take(key) else { return Ok(known[0].1) };
    let value = known.iter().find(|(word, _)| *word == given);
    value.map(|(_, value)| *value).ok_or_else(|| {
        let words = known.map(|(word, _)| word).join(" or ");
        format!("{key} must be {words}, not '{given}'")
    })
}

/// Takes the baud rate, if present.
pub fn baud(query: &mut Query) -> Result<Option<u32>, String> {
    let Some(text) = query.take("baud") else { return Ok(None) };
    match text.parse() {
        Ok(baud) if BAUDS.contains(&baud) => Ok(Some(baud)),
        _ => Err(format!("baud must be a number from {} to {}, not '{text}'", BAUDS.start(), BAUDS.end())),
    }
}

/// Splits `host:port`, `[v6]:port`, or either without a port.
pub fn host_and_port(confirmer: &str) -> Result<(String, Option<&str>), String> {
    let (host, port) = if let Some(rest) = confirmer.strip_prefix('[') {
        let (host, rest) = rest.split_once(']').ok_or("the bracket of the IPv6 address is not closed")?;
        match rest.strip_prefix(':') {
            Some(port) => (host, Some(port)),
            None if rest.is_empty() => (host, None),
            None => return Err(format!("'{rest}' after the address is not a port")),
        }
    } else {
        match confirmer.split_once(':') {
            Some((host, port)) => (host, Some(port)),
            None => (confirmer, None),
        }
    };
    if host.is_empty() {
        return Err("the host is missing".to_owned());
    }
    if host.chars().any(|c| c.is_whitespace() || c.is_control() || "/@#".contains(c)) {
        return Err(format!("'{host}' is not a valid host name"));
    }
    if is_unspecified(host) {
        return Err(format!("{host} is not a valid robot address"));
    }
    Ok((host.to_owned(), port))
}

/// Whether a host is all zeros in any form: `0.0.0.0`, `0`, `0x0`, `[::]`. The system would send the robot's traffic to
/// this computer.
fn is_unspecified(host: &str) -> bool {
    let is_zero = |part: &str| !part.is_empty() && part.trim_start_matches("0x").chars().all(|digit| digit == '0');
    host.parse::<Ipv6Addr>().is_ok_and(|address| address.to_canonical().is_unspecified())
        || host.split('.').all(is_zero)
}

/// Parses a port number.
pub fn port(name: &str, text: &str) -> Result<u16, String> {
    match text.parse() {
        Ok(port) if port > 0 => Ok(port),
        _ => Err(format!("{name} must be a number from 1 to 65535, not '{text}'")),
    }
}

/// Query of a URL.
pub struct Query {
    /// Options that were not taken yet.
    pairs: Vec<(String, String)>,
    /// Options that were looked for, which are the valid ones.
    known: Vec<String>,
}

impl fmt::Display for Query {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.pairs.iter().map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join("&"))
    }
}

impl Query {
    /// Parses a query.
    pub fn parse(text: &str) -> Result<Self, String> {
        let mut pairs: Vec<(String, String)> = Vec::new();
        for pair in text.split('&').filter(|pair| !pair.is_empty()) {
            let (key, value) = pair.split_once('=').ok_or_else(|| format!("'{pair}' has no value"))?;
            if pairs.iter().any(|(known, _)| known == key) {
                return Err(format!("'{key}' appears twice"));
            }
            pairs.push((key.to_owned(), percent_decoded(value)?));
        }
        Ok(Self { pairs, known: Vec::new() })
    }

    /// Removes an option and returns its value.
    pub fn take(&mut self, key: &str) -> Option<String> {
        self.known.push(key.to_owned());
        let index = self.pairs.iter().position(|(known, _)| known == key)?;
        Some(self.pairs.remove(index).1)
    }

    /// Rejects options that were not taken.
    pub fn finish(&self) -> Result<(), String> {
        let Some((key, _)) = self.pairs.first() else { return Ok(()) };
        Err(match nearest(key, self.known.iter().map(String::as_str)) {
            Some(near) => format!("unknown parameter '{key}'; did you mean '{near}'?"),
            None => format!("unknown parameter '{key}'; known: {}", self.known.join(", ")),
        })
    }
}

/// Decodes percent escapes.
pub fn percent_decoded(text: &str) -> Result<String, String> {
    let invalid = || format!("'{text}' has an invalid % escape");
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.bytes();
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let mut digit = || rest.next().and_then(|byte| char::from(byte).to_digit(16)).ok_or_else(invalid);
        let value = digit()? * 16 + digit()?;
        bytes.push(u8::try_from(value).map_err(|_| invalid())?);
    }
    String::from_utf8(bytes).map_err(|_| invalid())
}

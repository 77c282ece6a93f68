//! Durations as users type them: `500ms`, `3s`, `2m`, `1h`, or seconds without a unit.

use std::time::Duration;

/// Units. The longest suffix is first, so that `ms` is not parsed as `m`.
const UNITS: [(&str, u64); 4] = [("ms", 1), ("s", 1_000), ("m", 60_000), ("h", 3_600_000)];

/// Longest valid duration: one day. A longer duration is probably a typing error.
const MAX: Duration = Duration::from_secs(24 * 3600);

/// Parses a duration.
pub fn parse(text: &str) -> Result<Duration, String> {
    let wrong = || format!("'{text}' is not a valid duration; write 500ms, 3s, 2m or 1h");
    let (number, unit_ms) = UNITS
        .iter()
        .find_map(|(suffix, ms)| text.strip_suffix(suffix).map(|number| (number, *ms)))
        .unwrap_or((text, 1_000));
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if number.is_empty() || number == "." || !digits(whole) || !digits(fraction) || fraction.len() > 6 {
        return Err(wrong());
    }
    let whole: u64 = if whole.is_empty() { 0 } else { whole.parse().map_err(|_| wrong())? };
    let micros: u64 = format!("{fraction:0<6}").parse().map_err(|_| wrong())?;
    let ms = whole.checked_mul(unit_ms).ok_or_else(wrong)?;
    let duration = Duration::from_millis(ms) + Duration::from_micros(micros * unit_ms / 1_000);
    if duration > MAX {
        return Err(format!("'{text}' is longer than a day"));
    }
    Ok(duration)
}

/// Parses a duration that must not be 0.
pub fn parse_some(text: &str) -> Result<Duration, String> {
    match parse(text)? {
        Duration::ZERO => Err(format!("'{text}' is zero; write a longer time such as 500ms, 3s, 2m or 1h")),
        duration => Ok(duration),
    }
}

/// Formats a duration in its shortest exact form. [`parse`] parses this form.
pub fn display(duration: Duration) -> String {
    let ms = duration.as_millis();
    match ms {
        0 => "0s".to_owned(),
        ms if ms % 3_600_000 == 0 => format!("{}h", ms / 3_600_000),
        ms if ms % 60_000 == 0 => format!("{}m", ms / 60_000),
        ms if ms % 1_000 == 0 => format!("{}s", ms / 1_000),
        ms => format!("{ms}ms"),
    }
}

/// A duration in a TOML file: a string as described above. It must not be 0.
pub(super) mod field {
    use serde::{Deserialize, Deserializer, de::Error};

    use super::Duration;

    pub(in crate::settings) fn deserialize<'de, D: Deserializer<'de>>(source: D) -> Result<Option<Duration>, D::Error> {
        let text = String::deserialize(source)?;
        super::parse_some(&text).map(Some).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_and_fractions() {
        for (text, ms) in [("500ms", 500), ("3s", 3_000), ("0.25", 250), ("1.5m", 90_000), ("1h", 3_600_000), ("0", 0)]
        {
            assert_eq!(parse(text), Ok(Duration::from_millis(ms)), "{text}");
        }
    }

    #[test]
    fn names_invalid_text() {
        for text in ["", "s", "-1s", "3 s", "1d", "1e3", "25h", "99999999999999999999s"] {
            assert!(parse(text).is_err(), "{text}");
        }
        for text in ["0", "0ms", "0.0"] {
            assert!(parse_some(text).unwrap_err().contains("is zero"), "{text}");
        }
    }
}

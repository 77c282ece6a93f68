//! Tolerant comparison of positions: lines with positions in a file, and their distance.

use std::collections::HashMap;

use crate::backup::manifest::Entry;
use crate::prelude::basics::*;

/// Tolerance of positions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Tolerance {
    /// Millimeters; also degrees if a file does not identify rotary axes.
    mm: f64,
    /// Degrees.
    deg: f64,
    /// Encoder pulses.
    pulses: f64,
}

/// One limit, as typed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    unit: Option<Unit>,
    maximum: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Unit {
    Mm,
    Deg,
    Pulses,
}

/// Smallest step that controllers store.
const DEFAULT: Tolerance = Tolerance { mm: 0.001, deg: 0.001, pulses: 1.0 };
/// Rounding margin, because decimals are not exact in binary: 0.003 - 0.002 is more than 0.001.
const SLACK: f64 = 1e-7;

impl Limit {
    /// Parses `0.05` (mm and degrees), `0.1mm`, `0.05deg`, `5pulses`.
    pub fn parse(text: &str) -> Result<Self, String> {
        let units = [("mm", Unit::Mm), ("deg", Unit::Deg), ("pulses", Unit::Pulses), ("pulse", Unit::Pulses)];
        let found = units.into_iter().find_map(|(word, unit)| Some((text.strip_suffix(word)?, unit)));
        let (number, unit) = found.map_or((text, None), |(number, unit)| (number, Some(unit)));
        match number.trim().parse::<f64>() {
            Ok(most) if most.is_finite() && most >= 0.0 => Ok(Self { unit, maximum: most }),
            _ => Err(format!("'{text}' is not a valid tolerance, such as 0.05mm, 0.1deg or 5pulses")),
        }
    }
}

impl Tolerance {
    /// No tolerance.
    pub const NONE: Self = Self { mm: 0.0, deg: 0.0, pulses: 0.0 };

    /// Default tolerance, replaced by the given limits.
    pub fn of(limits: &[Limit]) -> Self {
        let mut tolerance = DEFAULT;
        for Limit { unit, maximum: most } in limits {
            match unit {
                None => (tolerance.mm, tolerance.deg) = (*most, *most),
                Some(Unit::Mm) => tolerance.mm = *most,
                Some(Unit::Deg) => tolerance.deg = *most,
                Some(Unit::Pulses) => tolerance.pulses = *most,
            }
        }
        tolerance
    }

    fn allows(self, unit: Unit, one: &str, other: &str) -> bool {
        let (Ok(one), Ok(other)) = (one.parse::<f64>(), other.parse::<f64>()) else { return false };
        let most = match unit {
            Unit::Mm => self.mm,
            Unit::Deg => self.deg,
            Unit::Pulses => self.pulses,
        };
        (one - other).abs() <= most + SLACK
    }

    /// Returns the new text, in which the old line replaces each line whose position is within the tolerance. Files
    /// without positions are unchanged.
    pub fn align(self, entry: &Entry, old: &[u8], new: &[u8]) -> Vec<u8> {
        let ending = entry.copy.as_ref().and_then(|copy| copy.file.rsplit_once('.'));
        let is_table = ending.is_some_and(|(_, ending)| ending == "csv");
        let kind = entry.holds.split(' ').next().unwrap_or_default();
        match (is_table, kind) {
            (true, "points" | "shifts" | "hands") => {
                let header: Vec<String> = first_line(old).split(',').map(ToOwned::to_owned).collect();
                aligned(old, new, |line| line.split(',').next(), |one, two| self.allows_row(&header, one, two))
            }
            (false, "jbi" | "dat" | "cnd") => {
                aligned(old, new, position_key, |one, two| self.allows_position(one, two))
            }
            _ => new.to_vec(),
        }
    }

    /// Whether two rows of a table are equal, apart from coordinates within the tolerance.
    fn allows_row(self, header: &[String], one: &str, other: &str) -> bool {
        let (one, other): (Vec<&str>, Vec<&str>) = (one.split(',').collect(), other.split(',').collect());
        let in_pulses = header.iter().zip(&one).any(|(name, cell)| name == "unit" && *cell == "pulse");
        let has_unit = header.iter().any(|name| name == "unit");
        let unit = |name: &str| match name {
            _ if name.ends_with("_mm") => Some(Unit::Mm),
            _ if has_unit && name.starts_with("axis_") => Some(if in_pulses { Unit::Pulses } else { Unit::Mm }),
            _ => None,
        };
        let is_near = |((name, one), other): ((&String, &&str), &&str)| {
            one == other || unit(name).is_some_and(|unit| self.allows(unit, one, other))
        };
        one.len() == other.len() && one.len() == header.len() && header.iter().zip(&one).zip(&other).all(is_near)
    }

    /// Whether two lines like `C00001=1,2,3` are equal, apart from numbers within the tolerance. Whole numbers are
    /// pulses. Of the decimal numbers, the first three are millimeters.
    pub fn allows_position(self, one: &str, other: &str) -> bool {
        let numbers = |line: &str| {
            let (_, numbers) = line.trim_end().split_once('=')?;
            Some(numbers.split(',').map(ToOwned::to_owned).collect::<Vec<_>>())
        };
        let (Some(one), Some(other)) = (numbers(one), numbers(other)) else { return false };
        let is_near = |(index, (one, other)): (usize, (&String, &String))| {
            let unit = match (one.contains('.'), index) {
                (false, _) => Unit::Pulses,
                (true, ..3) => Unit::Mm,
                (true, _) => Unit::Deg,
            };
            one == other || one.contains('.') == other.contains('.') && self.allows(unit, one, other)
        };
        one.len() == other.len() && one.iter().zip(&other).enumerate().all(is_near)
    }
}

/// Key of a position in a job or variable file, such as `C00001`, `BC00001`, `P001`.
fn position_key(line: &str) -> Option<&str> {
    let (name, _) = line.split_once('=')?;
    let digits = name.trim_start_matches(['B', 'E', 'C', 'P', 'X']);
    let is_position = !digits.is_empty() && digits.len() < name.len();
    (is_position && digits.bytes().all(|byte| byte.is_ascii_digit())).then_some(name)
}

/// Returns the new lines. A line whose position is within the tolerance is replaced by the old line with the same key.
fn aligned(
    old: &[u8],
    new: &[u8],
    key: impl Fn(&str) -> Option<&str>,
    is_near: impl Fn(&str, &str) -> bool,
) -> Vec<u8> {
    let known: HashMap<Position, &[u8]> =
        with_positions(old, &key).into_iter().filter_map(|(place, line)| Some((place?, line))).collect();
    let is_near = |old: &[u8], new: &[u8]| match (std::str::from_utf8(old), std::str::from_utf8(new)) {
        (Ok(old), Ok(new)) => is_near(old.trim_end(), new.trim_end()),
        _ => false,
    };
    let mut text = Vec::with_capacity(new.len());
    for (place, line) in with_positions(new, &key) {
        let same = place.and_then(|place| known.get(&place)).filter(|old| is_near(old, line));
        text.extend_from_slice(same.copied().unwrap_or(line));
    }
    text
}

/// Location of a position: section heading and key.
type Position = (String, String);

/// Lines of a text. A line with a robot position has its location: section heading and key.
fn with_positions(text: &[u8], key: impl Fn(&str) -> Option<&str>) -> Vec<(Option<Position>, &[u8])> {
    let mut headline = String::new();
    let mut lines = Vec::new();
    for line in text.split_inclusive(|byte| *byte == b'\n') {
        let shown = std::str::from_utf8(line).unwrap_or_default().trim_end();
        if shown.starts_with("//") {
            shown.clone_into(&mut headline);
        }
        lines.push((key(shown).map(|key| (headline.clone(), key.to_owned())), line));
    }
    lines
}

fn first_line(text: &[u8]) -> String {
    let line = text.split(|byte| *byte == b'\n').next().unwrap_or_default();
    String::from_utf8_lossy(line).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::backup::manifest::Saved;

    fn align(file: &str, holds: &str, limits: &[&str], old: &str, new: &str) -> String {
        let copy = Some(Saved { file: file.into(), ..Saved::default() });
        let entry = Entry { holds: holds.into(), copy, ..Entry::default() };
        let limits: Vec<Limit> = limits.iter().map(|text| Limit::parse(text).unwrap()).collect();
        String::from_utf8(Tolerance::of(&limits).align(&entry, old.as_bytes(), new.as_bytes())).unwrap()
    }

    #[test]
    fn limits_have_units() {
        let tolerance =
            |texts: &[&str]| Tolerance::of(&texts.iter().map(|text| Limit::parse(text).unwrap()).collect::<Vec<_>>());
        assert_eq!(tolerance(&[]), DEFAULT);
        assert_eq!(tolerance(&["0.05"]), Tolerance { mm: 0.05, deg: 0.05, ..DEFAULT });
        assert_eq!(tolerance(&["0.1mm", "2deg", "5pulses"]), Tolerance { mm: 0.1, deg: 2.0, pulses: 5.0 });
        for wrong in ["", "-1", "x", "1inch", "nan", "inf"] {
            assert!(Limit::parse(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn compares_points_of_a_table() {
        let head = "point,unit,axis_1,axis_2,hand_system\n";
        let table = |rows: &str| format!("{head}{rows}");
        let points = |limits: &[&str], old: &str, new: &str| {
            align("points-00000.csv", "points 0..9", limits, &table(old), &table(new))
        };
        let old = "1,mm,10.000,0.003,none\n2,pulse,100,5,\n";
        assert_eq!(points(&[], old, "1,mm,10.001,0.002,none\n2,pulse,101,5,\n"), table(old));
        let far = "1,mm,10.002,0.003,none\n2,pulse,102,5,\n";
        assert_eq!(points(&[], old, far), table(far));
        assert_eq!(points(&["0.01", "2pulses"], old, far), table(old));
        let other = "1,mm,10.000,0.003,left\n2,mm,100,5,\n3,mm,10.000,0.003,none\n";
        assert_eq!(points(&["9"], old, other), table(other), "another hand, unit or number is another point");
    }

    #[test]
    fn compares_positions_of_a_job() {
        let job = |first: &str, second: &str| {
            format!("/JOB\r\n///PULSE\r\nC00000={first}\r\n///RECTAN\r\nC00001={second}\r\n//INST\r\nMOVJ C00000\r\n")
        };
        let old = job("0,10,0", "1.000,2.000,3.000,90.0000");
        let near = job("1,9,0", "1.001,2.000,3.000,90.0010");
        let far = job("2,9,0", "1.001,2.000,3.000,90.0020");
        assert_eq!(align("A.JBI", "jbi", &[], &old, &near), old);
        assert_eq!(align("A.JBI", "jbi", &[], &old, &far), far);
        assert_eq!(align("A.JBI", "jbi", &["0.1deg", "5pulses"], &old, &far), old);
        assert_eq!(align("A.PRM", "prm", &["5pulses"], &old, &near), near, "parameters are no positions");
    }

    #[test]
    fn ignores_bytes_that_are_not_text() {
        let copy = Some(Saved { file: "A.JBI".into(), ..Saved::default() });
        let entry = Entry { holds: "jbi".into(), copy, ..Entry::default() };
        let odd = b"\x83\x5c=1\nC00000=1,2\n\xff";
        assert_eq!(Tolerance::of(&[]).align(&entry, b"\xff\nC00000=1,2\n", odd), odd);
    }
}

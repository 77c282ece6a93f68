//! The parts of a backup.

use std::fmt;
use std::str::FromStr;

use armctl_controller::similar_word::nearest;

/// A part of a backup. Each part has its own file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Parameters, and all tables except the points.
    Parameters,
    /// The easy programs.
    Easy,
    /// A palletizing program, 1 to 16.
    Palletizing(u8),
    /// The points of a task, 1 to 4.
    Points(u8),
    /// The sequential program of a task, 1 to 4.
    Program(u8),
}

impl Part {
    /// All parts that a controller with these tasks can have, in the order of reading and writing.
    pub fn all(points: &[u8], programs: &[u8]) -> Vec<Self> {
        let mut parts = vec![Self::Parameters, Self::Easy];
        parts.extend((1..=16).map(Self::Palletizing));
        for task in 1..=4 {
            parts.extend(points.contains(&task).then_some(Self::Points(task)));
            parts.extend(programs.contains(&task).then_some(Self::Program(task)));
        }
        parts
    }

    /// File of the part in the folder.
    pub fn file(self) -> String {
        let ending = match self {
            Self::Parameters | Self::Easy | Self::Palletizing(_) | Self::Points(_) => "csv",
            Self::Program(_) => "txt",
        };
        format!("{self}.{ending}")
    }

    /// Kind of the part.
    pub fn kind(self) -> &'static str {
        self.words().0
    }

    /// Names of the part: its name, the same name without a leading zero, and its kind.
    pub fn names(self) -> [String; 3] {
        [self.to_string(), self.plain_name(), self.kind().to_owned()]
    }

    fn plain_name(self) -> String {
        match self.words() {
            (word, None) => word.to_owned(),
            (word, Some(number)) => format!("{word}-{number}"),
        }
    }

    fn words(self) -> (&'static str, Option<u8>) {
        match self {
            Self::Parameters => ("parameters", None),
            Self::Easy => ("easy", None),
            Self::Palletizing(number) => ("palletizing", Some(number)),
            Self::Points(task) => ("points", Some(task)),
            Self::Program(task) => ("program", Some(task)),
        }
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.words() {
            (word, None) => f.write_str(word),
            ("palletizing", Some(number)) => write!(f, "palletizing-{number:02}"),
            (word, Some(number)) => write!(f, "{word}-{number}"),
        }
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let all = Self::all(&[1, 2, 3, 4], &[1, 2, 3, 4]);
        let exact = |part: &&Self| part.to_string() == name || part.plain_name() == name;
        if let Some(part) = all.iter().find(exact) {
            return Ok(*part);
        }
        let names: Vec<String> = all.iter().map(ToString::to_string).collect();
        Err(match nearest(name, names.iter().map(String::as_str)) {
            Some(near) => format!("unknown part '{name}'; did you mean {near}?"),
            None => format!("unknown part '{name}'"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_has_a_name() {
        let all = Part::all(&[1, 2], &[1, 3]);
        let names: Vec<String> = all.iter().map(ToString::to_string).collect();
        assert_eq!(names[..3], ["parameters", "easy", "palletizing-01"]);
        assert_eq!(names[18..], ["points-1", "program-1", "points-2", "program-3"]);
        for part in all {
            assert_eq!(part.to_string().parse(), Ok(part));
        }
        assert_eq!(Part::Program(2).file(), "program-2.txt");
    }

    #[test]
    fn parts_are_called_by_number_or_by_kind() {
        let part = |name: &str| name.parse::<Part>();
        assert_eq!((part("points-2"), part("palletizing-3")), (Ok(Part::Points(2)), Ok(Part::Palletizing(3))));
        assert_eq!(part("point-2").unwrap_err(), "unknown part 'point-2'; did you mean points-2?");
        assert_eq!(Part::Palletizing(3).names(), ["palletizing-03", "palletizing-3", "palletizing"]);
    }
}

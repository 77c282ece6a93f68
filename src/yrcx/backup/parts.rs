//! Parts of a controller backup. Each part is one file.

use std::fmt;
use std::str::FromStr;

use crate::data::{Hands, Pallets, PointSheet, Shifts};
use crate::link::Yrcx;
use crate::numbered_tables::Numbered;
use crate::param::Parameters;
use crate::robot_settings::Settings;
use crate::var::Variables;
use armctl_controller::findings::Finding;
use armctl_frame::backup::parts::Table;
use armctl_frame::store::{self, Writable};

/// Part of a backup.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Versions, option slots and robots; never written back.
    Info,
    /// Speeds, inching distance and hand system of a robot, 1 to 4.
    Settings(u8),
    /// Parameters of a robot and its axes, 1 to 4.
    Parameters(u8),
    /// Static variables.
    Variables,
    /// Pallets.
    Pallets,
    /// Shifts.
    Shifts,
    /// Hands.
    Hands,
    /// A thousand points with their comments; the value is 0 to 29.
    Points(u16),
}

/// Points per file.
pub const THOUSAND: u16 = 1000;

impl Part {
    /// Parts of a controller with these robots, without the points. They are in the order of reading: pallets before
    /// the points that they refer to.
    pub fn without_points(robots: impl Iterator<Item = u8> + Clone) -> impl Iterator<Item = Self> {
        let of_robots = robots.clone().map(Self::Settings).chain(robots.map(Self::Parameters));
        let of_controller = [Self::Variables, Self::Pallets, Self::Shifts, Self::Hands];
        std::iter::once(Self::Info).chain(of_robots).chain(of_controller)
    }

    /// All possible parts.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::without_points(1..=4).chain((0..30).map(Self::Points))
    }

    /// Returns the parts in the order of writing. Points come before the pallets that need them. Parts that change how
    /// the robot moves come last.
    pub fn in_order_of_writing() -> impl Iterator<Item = Self> {
        let place = |part: &Self| match part {
            Self::Variables | Self::Shifts | Self::Hands => 0,
            Self::Points(_) => 1,
            Self::Pallets => 2,
            Self::Parameters(_) | Self::Settings(_) | Self::Info => 3,
        };
        let mut parts: Vec<Self> = Self::all().collect();
        parts.sort_by_key(place);
        parts.into_iter()
    }

    /// Name of the file in the backup folder.
    pub fn file(self) -> String {
        let ending = if self == Self::Info { "toml" } else { "csv" };
        format!("{self}.{ending}")
    }

    /// Kind of the part.
    pub fn kind(self) -> &'static str {
        match self {
            Self::Info => "info",
            Self::Settings(_) => "settings",
            Self::Parameters(_) => "parameters",
            Self::Variables => "variables",
            Self::Pallets => "pallets",
            Self::Shifts => "shifts",
            Self::Hands => "hands",
            Self::Points(_) => "points",
        }
    }

    /// Names of the part for a selection: its own, and its kind.
    pub fn names(self) -> [String; 2] {
        [self.to_string(), self.kind().to_owned()]
    }

    /// Whether the part changes how the robot moves. Such a part is restored only with `--machine`.
    pub fn is_machine(self) -> bool {
        matches!(self, Self::Settings(_) | Self::Parameters(_))
    }

    /// The table of the part with the rows of its file; `None` for the information, which is not written.
    pub fn table(self, bytes: &[u8]) -> Result<Option<Table<Yrcx>>, Vec<Finding>> {
        match self {
            Self::Info => Ok(None),
            Self::Settings(robot) => rows(Settings { robot }, bytes),
            Self::Parameters(robot) => rows(Parameters { robot }, bytes),
            Self::Variables => rows(Numbered::<Variables>::default(), bytes),
            Self::Pallets => rows(Numbered::<Pallets>::default(), bytes),
            Self::Shifts => rows(Numbered::<Shifts>::default(), bytes),
            Self::Hands => rows(Numbered::<Hands>::default(), bytes),
            Self::Points(_) => rows(PointSheet::default(), bytes),
        }
    }
}

fn rows<S: Writable<Family = Yrcx>>(table: S, bytes: &[u8]) -> Result<Option<Table<Yrcx>>, Vec<Finding>> {
    Ok(Some(Box::new(store::Part::parse(table, bytes)?)))
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Points(thousand) => write!(f, "points-{:05}", thousand * THOUSAND),
            Self::Settings(robot) | Self::Parameters(robot) => write!(f, "{}-{robot}", self.kind()),
            _ => f.write_str(self.kind()),
        }
    }
}

impl FromStr for Part {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        Self::all().find(|part| part.to_string() == name).ok_or_else(|| format!("part '{name}' does not exist"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_part_has_a_name_and_a_file() {
        let names: Vec<String> = Part::all().map(|part| part.to_string()).collect();
        assert_eq!(names[..3], ["info", "settings-1", "settings-2"]);
        assert_eq!(names[9..15], ["variables", "pallets", "shifts", "hands", "points-00000", "points-01000"]);
        for part in Part::all() {
            assert_eq!(part.to_string().parse(), Ok(part));
        }
        assert_eq!(Part::Points(29).file(), "points-29000.csv");
        assert!("points".parse::<Part>().is_err());
    }

    #[test]
    fn pallets_are_written_after_points_and_machine_parts_last() {
        let names: Vec<String> = Part::in_order_of_writing().map(|part| part.to_string()).collect();
        assert_eq!(names[..4], ["variables", "shifts", "hands", "points-00000"]);
        assert_eq!(names[33..36], ["pallets", "info", "settings-1"]);
    }
}

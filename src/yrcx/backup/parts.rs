//! Parts of a controller backup, one file each.

use std::fmt;
use std::str::FromStr;

use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Key;

/// Part of a backup.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Versions, option slots and robots; read-only.
    Info,
    /// Speeds, inching distance and hand system of each robot.
    Settings,
    /// Parameters of robots and axes.
    Parameters,
    /// Numbered records.
    Records(&'static Records),
    /// A thousand points; the value is 0 to 29.
    Points(u16),
    /// Comments of these points.
    Comments(u16),
}

/// A kind of numbered record.
#[derive(Debug, PartialEq, Eq)]
pub struct Records {
    /// `pallets`.
    pub kind: &'static str,
    /// Read command.
    pub read: Command,
    /// Write command.
    pub write: Command,
    /// Valid numbers.
    pub numbers: &'static str,
    /// Columns of the file and their fields; the first is the number. `restore` of the table reads the same file.
    pub columns: &'static [(&'static str, Key)],
}

const AXES: [(&str, Key); 4] =
    [("axis_1", Key::Axis1), ("axis_2", Key::Axis2), ("axis_3", Key::Axis3), ("axis_4", Key::Axis4)];

/// Static variables (4.4.1).
pub static VARIABLES: Records = Records {
    kind: "variables",
    read: Command::VarGet,
    write: Command::VarSet,
    numbers: "SGI0..SGI31,SGR0..SGR31",
    columns: &[("name", Key::Variable), ("value", Key::Value)],
};
/// Pallets (4.3.3).
pub static PALLETS: Records = Records {
    kind: "pallets",
    read: Command::PalletGet,
    write: Command::PalletSet,
    numbers: "0..39",
    columns: &[
        ("name", Key::Pallet),
        ("nx", Key::CountX),
        ("ny", Key::CountY),
        ("nz", Key::CountZ),
        ("first_point", Key::FirstPoint),
    ],
};
/// Shifts (4.3.4).
pub static SHIFTS: Records = Records {
    kind: "shifts",
    read: Command::ShiftGet,
    write: Command::ShiftSet,
    numbers: "0..39",
    columns: &[
        ("name", Key::Shift),
        ("axis_1_mm", Key::Axis1),
        ("axis_2_mm", Key::Axis2),
        ("axis_3_mm", Key::Axis3),
        ("axis_4_mm", Key::Axis4),
    ],
};
/// Hands (4.3.5). A hand is written to the robot that it belongs to.
pub static HANDS: Records = Records {
    kind: "hands",
    read: Command::HandGet,
    write: Command::HandSet,
    numbers: "0..31",
    columns: &[
        ("name", Key::Hand),
        ("robot", Key::Owner),
        ("data_1", Key::Data1),
        ("data_2_mm", Key::Data2),
        ("data_3_mm", Key::Data3),
        ("data_4", Key::Data4),
    ],
};
/// Points (4.3.1); axes in the unit of each point.
pub static POINTS: Records = Records {
    kind: "points",
    read: Command::PointGet,
    write: Command::PointSet,
    numbers: "0..29999",
    columns: &[
        ("name", Key::Point),
        ("unit", Key::Unit),
        AXES[0],
        AXES[1],
        AXES[2],
        AXES[3],
        ("hand_system", Key::HandSystem),
    ],
};
/// Comments of points (4.3.2).
pub static COMMENTS: Records = Records {
    kind: "comments",
    read: Command::CommentGet,
    write: Command::CommentSet,
    numbers: "0..29999",
    columns: &[("name", Key::Point), ("comment", Key::Comment)],
};

/// Points per file.
pub const THOUSAND: u16 = 1000;

impl Part {
    /// Parts with one file, in the order of reading: pallets before the points that they refer to.
    pub fn single() -> [Self; 7] {
        let [variables, pallets, shifts, hands] = [&VARIABLES, &PALLETS, &SHIFTS, &HANDS].map(Self::Records);
        [Self::Info, Self::Settings, Self::Parameters, variables, pallets, shifts, hands]
    }

    /// All possible parts.
    pub fn all() -> impl Iterator<Item = Self> {
        let thousands = (0..30).flat_map(|thousand| [Self::Points(thousand), Self::Comments(thousand)]);
        Self::single().into_iter().chain(thousands)
    }

    /// Parts in the order of writing: points before the pallets that need them, and parts that change the motion of
    /// the robot last.
    pub fn in_order_of_writing() -> impl Iterator<Item = Self> {
        let place = |part: &Self| match part {
            Self::Records(records) if records.kind != PALLETS.kind => 0,
            Self::Points(_) | Self::Comments(_) => 1,
            Self::Records(_) => 2,
            Self::Parameters | Self::Settings | Self::Info => 3,
        };
        let mut parts: Vec<Self> = Self::all().collect();
        parts.sort_by_key(place);
        parts.into_iter()
    }

    /// File name in the folder.
    pub fn file(self) -> String {
        let ending = if self == Self::Info { "toml" } else { "csv" };
        format!("{self}.{ending}")
    }

    /// Record description, if the part consists of records.
    pub fn records(self) -> Option<&'static Records> {
        match self {
            Self::Records(records) => Some(records),
            Self::Points(_) => Some(&POINTS),
            Self::Comments(_) => Some(&COMMENTS),
            Self::Info | Self::Settings | Self::Parameters => None,
        }
    }

    /// Kind of the part.
    pub fn kind(self) -> &'static str {
        match (self, self.records()) {
            (_, Some(records)) => records.kind,
            (Self::Settings, _) => "settings",
            (Self::Parameters, _) => "parameters",
            _ => "info",
        }
    }

    /// Whether the part changes how the robot moves. It is restored only with `--machine`.
    pub fn is_machine(self) -> bool {
        matches!(self, Self::Settings | Self::Parameters)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Points(thousand) | Self::Comments(thousand) => {
                write!(f, "{}-{:05}", self.kind(), thousand * THOUSAND)
            }
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
        assert_eq!(names[..4], ["info", "settings", "parameters", "variables"]);
        assert_eq!(names[7..10], ["points-00000", "comments-00000", "points-01000"]);
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
        assert_eq!(names[names.len() - 4..], ["pallets", "info", "settings", "parameters"]);
    }
}

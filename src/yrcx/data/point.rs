//! `yrcx point` (4.3.1).

use clap::ArgGroup;

use super::path::PointPath;
use super::sheet::PointSheet;
use crate::number_arguments::single;
use crate::numbered_tables::{Kind, Numbered};
use crate::position::{Unit, mm, position, unit_of};
use crate::prelude::*;
use armctl_frame::path::Drawable;
use armctl_frame::robot::position::FourAxes;
use armctl_frame::store::{Copy, Dump, Get, List, Restore, TableWrite, Writable as _, WrittenOf, write};
use armctl_frame::teach::parse_printed_position;

commands! {
    /// Commands for points.
    pub enum Point {
        /// Read points, for example 100 or 0..29
        Get(Get<Numbered<Points>>),
        /// List the defined points of a range; with --path, draw them
        List(Drawable<List<Numbered<Points>>, PointPath>),
        /// Define a point, for example `100 --mm 10,-20,5,-18`
        Set(Set),
        /// Copy a point to other points, for example `5 6..8`
        Copy(Copy<Numbered<Points>>),
        /// Save points and their comments to a CSV file
        Dump(Dump<PointSheet>),
        /// Write points and their comments from a CSV file
        Restore(Restore<PointSheet>),
    }
}

/// The points of the controller.
#[derive(Debug)]
pub struct Points;

impl Kind for Points {
    type Value = FourAxes;
    const WORDS: TableWords = TableWords {
        nouns: ["point", "points"],
        placeholder: "POINT",
        range: "Points (0 to 29999), such as 100, 0..29 or 0..29,100",
        reading: Some(
            "The controller refuses a point that is not defined. The other points are still reported (exit code 9). \
             `-o csv` prints a table for a spreadsheet.",
        ),
        writing: None,
    };
    const IDS: Ids = ids!("yrcx.point");
    const READ: (table::Command, Key) = (table::Command::PointGet, Key::Point);
    const WRITE: table::Command = table::Command::PointSet;
    const NUMBERS: &'static [&'static str] = &["0..29999"];
    const FIELDS: &'static [(&'static str, Key, &'static str)] = &[
        ("unit", Key::Unit, "unit"),
        ("axis_1", Key::Axis1, "axis 1"),
        ("axis_2", Key::Axis2, "axis 2"),
        ("axis_3", Key::Axis3, "axis 3"),
        ("axis_4", Key::Axis4, "axis 4"),
        ("hand_system", Key::HandSystem, "hand"),
    ];
    const IS_SMALL: bool = false;

    fn line(values: &Values) -> Option<String> {
        let unit = unit_of(values);
        let axes = match unit {
            Unit::Mm => mm(values)?.map(|axis| format!("{axis:.3}")),
            Unit::Pulse => values.axes()?.map(|axis| axis.to_string()),
        };
        let hand = match values.int(Key::HandSystem) {
            Some(1) => ", right-handed",
            Some(2) => ", left-handed",
            _ => "",
        };
        Some(format!("{} {}{hand}", axes.join(", "), unit.symbol()))
    }

    fn value(values: &Values) -> Option<FourAxes> {
        position(values, unit_of(values)).map(FourAxes)
    }
}

/// Defines a point.
#[derive(Debug, clap::Args)]
#[command(group = ArgGroup::new("coordinates").required(true),
    after_help = "Type 0 for an axis that the robot does not have. `yrcx teach 19` (or `yrcx point set 19 here`) \
                  stores the current position. `yrcx point set 19 @FILE` stores the output of `yrcx position --json` \
                  from FILE; @- reads stdin.")]
pub struct Set {
    /// Point, 0 to 29999
    #[arg(value_name = "POINT", value_parser = |text: &str| single(table::Command::PointSet, Key::Point, text))]
    point: i32,
    /// Coordinates of axes 1 to 4 in mm, or degrees for rotary axes
    #[arg(long, value_name = "MM,…", group = "coordinates", allow_hyphen_values = true, value_parser = four)]
    mm: Option<Four>,
    /// Coordinates of axes 1 to 4 in pulses
    #[arg(long, value_name = "PULSES,…", group = "coordinates", allow_hyphen_values = true, value_parser = four)]
    pulse: Option<Four>,
    /// File with coordinates and hand system from `position --json`; - reads stdin
    #[arg(long, value_name = "FILE", group = "coordinates")]
    position: Option<PathBuf>,
    /// Hand system of coordinates in mm
    #[arg(long, value_name = "HAND", value_parser = ["right", "left"], conflicts_with_all = ["pulse", "position"])]
    hand: Option<String>,
}

impl Command for Set {
    type Family = Yrcx;
    type Report = WrittenOf<Numbered<Points>>;
    const ID: &'static str = "yrcx.point.set";
    const RISK: Risk = Risk::Destroy;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<WrittenOf<Numbered<Points>>> {
        let Context { robot, link, screen, confirmer, .. } = context;
        let Given { unit, four, hand } = self.given()?;
        let table = Numbered::<Points>::default();
        let [one, two, three, four] = four.each_ref().map(String::as_str);
        let texts = [unit, one, two, three, four, hand.as_deref().unwrap_or_default()].map(Some);
        let draft = table
            .draft(self.point, &texts)
            .map_err(|why| Failure::usage(format!("point {}: {why}", self.point)).hint("see `yrcx point set -h`"))?;
        write(TableWrite { table, robot, link, screen, confirmer }, vec![(self.point, draft)]).await?.or_only_failure()
    }
}

/// Coordinates of a new point.
struct Given {
    unit: &'static str,
    four: Four,
    hand: Option<String>,
}

impl Set {
    fn given(&self) -> Result<Given> {
        match (&self.mm, &self.pulse, &self.position) {
            (Some(mm), ..) => Ok(Given { unit: "mm", four: mm.clone(), hand: self.hand.clone() }),
            (None, Some(pulse), _) => Ok(Given { unit: "pulse", four: pulse.clone(), hand: None }),
            (None, None, file) => printed_point(file.as_deref().unwrap_or_else(|| Path::new("-"))),
        }
    }
}

/// A number for each of the four axes, as the user typed them.
type Four = [String; 4];

fn four(text: &str) -> Result<Four, String> {
    let numbers: Vec<String> = text.split(',').map(|number| number.trim().to_owned()).collect();
    let count = numbers.len();
    numbers.try_into().map_err(|_| format!("expected four numbers, one per axis, such as 10,-20,5,-18; {count} given"))
}

/// Reads a point from the output of `position --json` or `point get --json`.
fn printed_point(file: &Path) -> Result<Given> {
    let text = parse_printed_position(file)?;
    let words: Vec<&str> = text.split_whitespace().collect();
    let (unit, axes, hand) = match words[..] {
        ["--mm", axes] => ("mm", axes, None),
        ["--mm", axes, "--hand", hand] => ("mm", axes, Some(hand.to_owned())),
        ["--pulse", axes] => ("pulse", axes, None),
        _ => {
            return Err(Failure::usage(format!("{}: not a YRCX position: {text}", file.display()))
                .hint("write the file with `yrcx position --json` or `yrcx point get --json`"));
        }
    };
    let four = four(axes).map_err(|error| Failure::usage(error).hint("type four numbers separated by commas"))?;
    Ok(Given { unit, four, hand })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::{Reply, Scripted, report_on, run_on};
    use armctl_frame::failure::Kind;

    fn answer(point: u16) -> Reply {
        let mut words = [0; 16];
        (words[0], words[2]) = (0x0200, point);
        Reply::AddressPair(0, words)
    }

    fn refusal(group: u16, category: u16) -> Reply {
        let mut words = [0; 16];
        words[..3].copy_from_slice(&[0x4000, group, category]);
        Reply::AddressPair(0, words)
    }

    #[test]
    fn undefined_points_do_not_hide_others() {
        let line = ["point", "get", "3..5"];
        let (read, failure, _) = report_on(Scripted::new([refusal(2, 904), answer(4), refusal(2, 904)]), &line);
        let points = read["items"].as_array().unwrap();
        let numbers = points.iter().map(|point| (point["name"].as_str().unwrap(), point["ok"].as_bool().unwrap()));
        assert_eq!(numbers.collect::<Vec<_>>(), [("3", true), ("4", true), ("5", true)]);
        assert_eq!((&points[0]["value"], points[1]["value"].is_object(), failure), (&json!(null), true, None));
        let (_, failure, peer) = report_on(Scripted::new([refusal(2, 904), refusal(2, 904), refusal(2, 904)]), &line);
        assert_eq!((failure.unwrap().kind.exit(), peer.taken.len()), (3, 3));
        let (only, _) = run_on(Scripted::new([refusal(2, 904)]), &["point", "get", "3"]);
        assert!(only.unwrap_err().message.starts_with("point 3: the controller refused point-get: alarm 2.904"));
    }

    #[test]
    fn stops_asking_a_controller_that_refuses_commands() {
        let line = ["point", "get", "3..29999"];
        let (read, failure, peer) = report_on(Scripted::new([answer(3), refusal(12, 76)]), &line);
        let failure = failure.unwrap();
        assert_eq!((failure.kind.exit(), failure.code.as_deref(), peer.taken.len()), (9, Some("12.76"), 2));
        assert!(failure.message.ends_with("; 29995 were not read"), "{failure}");
        assert_eq!((&read["items"][0]["ok"], &read["items"][29_996]["ok"]), (&json!(true), &json!(false)));
        let (outcome, peer) = run_on(Scripted::new([refusal(12, 76)]), &line);
        assert_eq!((outcome.unwrap_err().kind, peer.taken.len()), (Kind::Refused, 1));
    }

    #[test]
    fn rejects_the_answer_for_another_point() {
        let (outcome, _) = run_on(Scripted::new([answer(4)]), &["point", "get", "3"]);
        assert_eq!(outcome.unwrap_err().kind, Kind::Malformed);
    }
}

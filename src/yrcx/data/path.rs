//! `yrcx point list --path`: points as a picture.

use super::{PointSheet, Points};
use crate::backup::Controller;
use crate::numbered_tables::{Kind as _, Numbered};
use crate::prelude::*;
use armctl_frame::backup::manifest::open_existing;
use armctl_frame::path::{Drawing, Interpolation, Motion, NotDrawn, PathOptions, PathReport, Recorder, Step};
use armctl_frame::robot::position::{FourAxes, Position};
use armctl_frame::store::List;

/// Draws points.
#[derive(Debug)]
pub struct PointPath {
    numbers: Vec<i32>,
    options: PathOptions,
}

impl From<(List<Numbered<Points>>, PathOptions)> for PointPath {
    fn from((list, options): (List<Numbered<Points>>, PathOptions)) -> Self {
        Self { numbers: list.keys(), options }
    }
}

impl Command for PointPath {
    type Family = Yrcx;
    type Report = PathReport;
    const ID: &'static str = "yrcx.point.path";
    const USES_FILES: bool = true;

    fn takes_robot(&self) -> bool {
        self.options.from.is_none()
    }

    fn run_alone(&self) -> Result<PathReport> {
        self.options.check(false)?;
        self.report(&self.points_of(self.options.from.as_deref().unwrap_or(Path::new(".")))?)
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<PathReport> {
        let Context { link, screen, several, .. } = context;
        self.options.check(several)?;
        let table = Numbered::<Points>::default();
        let mut points = Vec::new();
        for (number, row) in self.numbers.iter().zip(table.read(link, screen, &self.numbers).await?.rows) {
            match row {
                Ok(row) => points.extend(row.and_then(|row| Points::value(row.values())).map(|point| (*number, point))),
                Err(failure) if Numbered::<Points>::is_undefined(&failure) => {}
                Err(failure) => return Err(failure),
            }
        }
        self.report(&points)
    }
}

impl PointPath {
    /// The points of a backup that the user typed.
    fn points_of(&self, folder: &Path) -> Result<Vec<(i32, FourAxes)>> {
        let manifest = open_existing::<Controller>(folder)?;
        let copies = manifest.files.iter().filter_map(|entry| entry.copy.as_ref());
        let mut all = BTreeMap::new();
        for copy in copies.filter(|copy| copy.file.starts_with("points-")) {
            all.extend(PointSheet::points_in(&folder.join(&copy.file))?);
        }
        Ok(self.numbers.iter().filter_map(|number| Some((*number, all.remove(number)?))).collect())
    }

    fn report(&self, points: &[(i32, FourAxes)]) -> Result<PathReport> {
        let new = motion(points, None);
        let old = self.options.compare.as_deref().map(|folder| self.points_of(folder)).transpose()?;
        let old = old.map(|points| motion(&points, Some(new.unit)));
        self.options.report(Drawing::new(new, old))
    }
}

/// Points in the order of their numbers. Without a unit, the unit of most points is drawn.
fn motion(points: &[(i32, FourAxes)], unit: Option<&'static str>) -> Motion {
    let unit_of = |position: &Position| if position.x_mm.is_some() { "mm" } else { "pulses" };
    let count = points.iter().filter(|(_, point)| unit_of(&point.0) == "mm").count();
    let unit = unit.unwrap_or(if count * 2 >= points.len() { "mm" } else { "pulses" });
    let is_space = unit == "mm";
    let mut motion = Motion {
        program: "points".to_owned(),
        frame: if is_space { "base" } else { "joint" }.to_owned(),
        axes: if is_space { vec!["X", "Y", "Z", "4"] } else { vec!["1", "2", "3", "4"] },
        unit,
        is_points: true,
        notes: vec!["These are points, not a program: the fieldbus cannot read programs.".to_owned()],
        ..Motion::default()
    };
    let mut recorder = Recorder::default();
    for (number, FourAxes(position)) in points {
        let text = position.text.clone().unwrap_or_default();
        let line = usize::try_from(*number).unwrap_or_default();
        if unit_of(position) != unit {
            let reason = format!("the point is in {}, and the picture in {unit}", unit_of(position));
            motion.not_drawn.push(NotDrawn { line, text, reason });
            continue;
        }
        let value =
            |joint: &armctl_frame::robot::position::Joint| joint.mm.or(joint.pulses.map(f64::from)).unwrap_or_default();
        let target = position.joints.iter().map(value).collect();
        let step =
            Step { name: format!("P{number}"), line, text, interpolation: Interpolation::Order, track: Vec::new() };
        recorder.go(step, &[], target, |_| None);
    }
    (motion.steps, motion.is_timed) = recorder.finish();
    motion
}

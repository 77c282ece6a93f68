//! `yrcx teach` (4.2.9): stores the current position as a point. `point set 19 here` is an alias.

use super::confirmed_write::{self, confirmation, read_current};
use super::position::{Unit, group, position, unit_of};
use crate::prelude::*;
use armctl_frame::teach::{TeachReport, mismatch, unverified};

/// Stores the current position as a point, replaces the old point, and reads the point back.
#[derive(Debug, Args)]
#[command(
    after_help = "The controller stores its own position, with servos on or off. Without --in, the point keeps its \
                  unit; a new point gets mm. `yrcx point set 19 here` does the same."
)]
pub struct Teach {
    /// Point to write, 0 to 29999
    #[arg(value_name = "POINT", required_unless_present = "flag")]
    point: Option<String>,
    /// Point to write, as an option instead of an argument
    #[arg(id = "flag", long = "point", value_name = "POINT", conflicts_with = "point", hide = true)]
    flag: Option<String>,
    /// Unit of the point [default: unchanged]
    #[arg(long = "in", value_name = "UNIT")]
    unit_of_point: Option<Unit>,
}

/// Maximum difference between two readings of a robot at rest: 0.1 mm, or 100 pulses.
const NEAR: i32 = 100;

impl Command for Teach {
    type Family = Yrcx;
    type Report = TeachReport;
    const ID: &'static str = "yrcx.teach";

    fn risk(&self) -> Risk {
        table::Command::Teach.row().risk
    }

    fn intent(&self) -> String {
        format!("overwrite point {}", self.number())
    }

    fn confirmation(&self) -> Confirmation {
        confirmation(table::Command::Teach)
    }

    async fn run(&self, context: Context<'_, Yrcx>) -> Result<Self::Report> {
        let Context { link, confirmer, .. } = context;
        let read = table::Command::PointGet.order().with(Key::Point, self.number()).valid_order()?;
        let old = read_current(link, &read, "current point").await?;
        let unit = self.unit_of_point.or_else(|| old.as_ref().map(unit_of)).unwrap_or(Unit::Mm);
        let order = self.order(link, unit)?;
        // In a dry run, the unit of the point is unknown.
        let other = if self.unit_of_point.is_none() { self.order(link, Unit::Pulse)? } else { self.order(link, unit)? };
        confirmed_write::execute_with_alternative(link, &confirmer, &order, &other).await?;
        let row = if unit == Unit::Mm { table::Command::PositionMm } else { table::Command::PositionPulse };
        let here = link.draft(row)?.valid_order()?;
        if link.is_dry_run() {
            link.plan(&read, "the point after the write");
            link.plan(&here, "current position, for the comparison");
            return Err(unknown());
        }
        let name = self.number();
        let unread = |failure| unverified(&format!("point {name}"), failure, &format!("yrcx point get {name}"));
        let held = read_current(link, &read, "").await.map_err(unread)?;
        let held =
            held.ok_or_else(|| unread(Failure::new(Kind::Refused, "the point is not defined on the controller")))?;
        let here = link.ask(&here).await.map_err(unread)?.values;
        let place = position(&here, unit).unwrap_or_default().of_group(group(order.values().int(Key::Robot)));
        let point = |values: &Values| position(values, unit_of(values)).unwrap_or_default();
        let new = point(&held);
        if unit_of(&held) != unit || !is_near(&held, &here) {
            return Err(mismatch(&format!("point {name}"), &place.line(), &new.line()));
        }
        let taught = TeachReport::new(name, old.as_ref().map(point), new, place);
        Ok(taught.with("set", "point").with("point", held.int(Key::Point)))
    }
}

impl Teach {
    fn number(&self) -> &str {
        self.point.as_deref().or(self.flag.as_deref()).unwrap_or_default()
    }

    fn order(&self, link: &Link, unit: Unit) -> Result<Order> {
        let draft = link.draft(table::Command::Teach)?.with(Key::Point, self.number());
        draft.with(Key::Unit, i32::from(unit == Unit::Mm)).valid_order()
    }
}

fn is_near(held: &Values, here: &Values) -> bool {
    let axes = held.axes().zip(here.axes());
    axes.is_some_and(|(held, here)| {
        held.iter().zip(here).all(|(held, here)| held.abs_diff(here) <= NEAR.unsigned_abs())
    })
}

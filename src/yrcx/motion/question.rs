//! Confirmation of a motion. Before the question, armctl reads the current position and the target of each axis.

use crate::confirmed_write::mm;
use crate::position::Unit;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;
use armctl_frame::gate::data_changed;

/// Target of a motion.
#[derive(Debug, Clone, PartialEq)]
struct MotionTarget {
    unit: Unit,
    /// Values of axes 1 to 4; `None` for an axis without a target.
    axes: [Option<i32>; 4],
    /// Whether the values are distances from the current position.
    by_distance: bool,
}

/// Asks the user to confirm a motion. `intent` describes the motion in one line. Before an interactive question, armctl
/// reads the current position and the target point. After the user has answered, armctl reads the point again; if it
/// has changed, the robot does not move.
pub async fn confirm(link: &mut Link, confirmer: &Confirmer<'_>, order: &Order, intent: String) -> Result<()> {
    let change = Change::new(intent);
    if !confirmer.asks_user() {
        return confirmer.confirm(&change).await;
    }
    let Some(goal) = goal(link, order).await? else {
        let is_point = order.values().int(Key::Point).is_some();
        let change = if is_point { change.note("The point could not be read.") } else { change };
        let here = present(link, Unit::Mm).await?;
        return confirmer.confirm(&read_positions(change, order, here)).await;
    };
    let here = present(link, goal.unit).await?;
    confirmer.confirm(&goal.clone().from(here).describe(change, here)).await?;
    match self::goal(link, order).await? {
        Some(now) if now == goal => Ok(()),
        _ => Err(data_changed("the point changed after the confirmation; the robot did not move")),
    }
}

/// Reads the current position; `None` if the controller refuses to report it.
async fn present(link: &mut Link, unit: Unit) -> Result<Option<[i32; 4]>> {
    let command = match unit {
        Unit::Mm => Command::PositionMm,
        Unit::Pulse => Command::PositionPulse,
    };
    Ok(read(link, command, &[]).await?.and_then(|values| values.axes()))
}

/// Adds the current position of each selected axis, for a motion without numeric target.
fn read_positions(change: Change, order: &Order, here: Option<[i32; 4]>) -> Change {
    let is_meant = is_axis_moved(order);
    let here = here.into_iter().flatten().enumerate().filter(|(at, _)| is_meant(*at));
    here.fold(change, |change, (at, steps)| change.item(format!("axis {}: from {} mm", at + 1, mm(steps))))
}

/// Whether a command moves an axis: either the command names the axis, or it moves all axes.
fn is_axis_moved(order: &Order) -> impl Fn(usize) -> bool + use<> {
    let mask = order.values().int(Key::Axes).unwrap_or_default();
    move |at| mask == 0 || mask >> at & 1 == 1
}

/// Returns the target of a command, if the target is numeric. A distance stays a distance until the start position is
/// known. A pallet position has no numeric target: the intent describes it.
async fn goal(link: &mut Link, order: &Order) -> Result<Option<MotionTarget>> {
    let values = order.values();
    let is_meant = is_axis_moved(order);
    let by_distance = is_distance(order.command());
    let goal = |unit, of: &dyn Fn(Key) -> Option<i32>| {
        let axes = [0, 1, 2, 3].map(|at: usize| Key::AXES.get(at).filter(|_| is_meant(at)).and_then(|key| of(*key)));
        Some(MotionTarget { unit, axes, by_distance })
    };
    let point = match order.command() {
        Command::MoveMm | Command::MoveiMm => return Ok(goal(Unit::Mm, &|key| values.int(key))),
        Command::MovePulse | Command::MoveiPulse => return Ok(goal(Unit::Pulse, &|key| values.int(key))),
        Command::DriveMm | Command::PushMm => return Ok(goal(Unit::Mm, &|_| values.int(Key::Target))),
        Command::DrivePulse | Command::PushPulse => return Ok(goal(Unit::Pulse, &|_| values.int(Key::Target))),
        Command::DriveiMm => return Ok(goal(Unit::Mm, &|_| values.int(Key::Distance))),
        Command::DriveiPulse => return Ok(goal(Unit::Pulse, &|_| values.int(Key::Distance))),
        Command::MovePtp
        | Command::MoveLinear
        | Command::MoveArch
        | Command::DrivePoint
        | Command::PushPoint
        | Command::MoveiPtp
        | Command::MoveiLinear
        | Command::DriveiPoint => Key::Point,
        Command::MoveCircular => Key::Point2,
        _ => return Ok(None),
    };
    let number = values.int(point).unwrap_or_default();
    let point = read(link, Command::PointGet, &[(Key::Point, number)]).await?;
    Ok(point.and_then(|point| {
        let unit = if point.int(Key::Unit) == Some(1) { Unit::Mm } else { Unit::Pulse };
        goal(unit, &|key| point.int(key))
    }))
}

/// Whether the numbers of a command, or the numbers of its point, are distances.
const fn is_distance(command: Command) -> bool {
    matches!(
        command,
        Command::MoveiMm
            | Command::MoveiPulse
            | Command::MoveiPtp
            | Command::MoveiLinear
            | Command::DriveiMm
            | Command::DriveiPulse
            | Command::DriveiPoint
    )
}

/// Reads values; `None` if the controller refuses.
async fn read(link: &mut Link, command: Command, with: &[(Key, i32)]) -> Result<Option<Values>> {
    let draft = with.iter().fold(link.draft(command)?, |draft, (key, value)| draft.with(*key, *value));
    Ok(link.try_ask(&draft.valid_order()?).await?.ok().map(|done| done.values))
}

impl MotionTarget {
    /// Converts distances to positions, if the start position is known.
    fn from(self, here: Option<[i32; 4]>) -> Self {
        let Some(here) = here.filter(|_| self.by_distance) else { return self };
        let mut axes = self.axes;
        for (axis, here) in axes.iter_mut().zip(here) {
            *axis = axis.map(|by| here.saturating_add(by));
        }
        Self { axes, by_distance: false, ..self }
    }

    /// Adds a line for each axis with a target, and the straight distance to the target if known.
    fn describe(&self, change: Change, here: Option<[i32; 4]>) -> Change {
        let shown = |steps: i32| if self.unit == Unit::Mm { mm(steps) } else { steps.to_string() };
        let told = self.axes.iter().enumerate().filter_map(|(at, new)| Some((at, (*new)?)));
        let change = told.fold(change, |change, (at, new)| {
            let (what, new) = (format!("axis {}", at + 1), format!("{} {}", shown(new), self.unit.symbol()));
            match here.and_then(|here| here.get(at).copied()) {
                Some(old) => change.replaces(&what, &shown(old), &new),
                None if self.by_distance => change.item(format!("{what}: by {new}")),
                None => change.item(format!("{what}: to {new}")),
            }
        });
        match (self.unit, self.axes, here) {
            (Unit::Mm, [Some(x), Some(y), Some(z), _], Some(here)) => {
                let apart = [x, y, z].into_iter().zip(here).map(|(new, old)| f64::from(new) - f64::from(old));
                let way = apart.map(|steps| steps * steps).sum::<f64>().sqrt() / 1000.0;
                change.note(format!("The target is {way:.3} mm away."))
            }
            _ => change,
        }
    }
}

//! `toyo home`: return to the origin.

use super::position::{Coordinates, UNIT, titled};
use super::wait::{AcceptedWork, Work};
use crate::prelude::*;
use armctl_frame::robot::motion::Motion;
use armctl_frame::wait_arguments::MotionEnd;

/// Return all axes to the origin, and wait for the end (TO 2-7).
#[derive(Debug, Args)]
pub struct Home {
    #[command(flatten)]
    end: MotionEnd,
    /// Search the origin of synchronized axes instead, with this drive axis, 1 to 3 (KCA-20-M00 and -M01)
    #[arg(long, value_name = "AXIS", value_parser = clap::value_parser!(i32).range(1..=3))]
    sync: Option<i32>,
}

impl Home {
    fn order(&self) -> (Request, AcceptedWork) {
        let (work, doing) = (Work::Home, "the axes return to the origin");
        let done = "the return to the origin was accepted";
        match self.sync {
            None => {
                let order = table::Command::Home;
                (Request::bare(order), AcceptedWork { work, order, done, doing })
            }
            Some(axis) => {
                let (order, work, doing) = (table::Command::Sorg, Work::Search, "the axes search their origin");
                let done = "the search for the origin was accepted";
                (Request::of(order, [Value::Number(axis)]), AcceptedWork { work, order, done, doing })
            }
        }
    }
}

impl Command for Home {
    type Family = Toyo;
    type Report = HomeReport;
    const ID: &'static str = "toyo.home";
    const RISK: Risk = Risk::Motion;
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    fn intent(&self) -> String {
        match self.sync {
            None => "move all axes to their origin".to_owned(),
            Some(axis) => format!("move drive axis {axis} and the axis coupled to it to their origin"),
        }
    }

    async fn run(&self, context: Context<'_, Toyo>) -> Result<HomeReport> {
        let Context { link, screen, confirmer, .. } = context;
        let (order, accepted) = self.order();
        let letters = link.letters().await?;
        let change = Change::new(self.intent());
        let change = if confirmer.asks_user() { from_where(link, change, letters).await? } else { change };
        confirmer.confirm(&change).await?;
        link.ask(&order).await?;
        if self.end.no_wait() {
            return Ok(HomeReport { motion: Motion { accepted: true, ..Motion::default() } });
        }
        let end = accepted.wait(link, screen, letters).await?;
        let position = end.coordinates.map(|coordinates| coordinates.position().of_group(UNIT));
        let motion = Motion { accepted: true, group: Some(UNIT.to_owned()), ..Motion::default() };
        Ok(HomeReport { motion: Motion { position, reached: Some(true), elapsed_ms: end.elapsed_ms, ..motion } })
    }
}

/// Adds the current position of each axis to the change. A busy controller may refuse to report it.
async fn from_where(link: &mut Link, change: Change, letters: Letters) -> Result<Change> {
    let coordinates = match link.read_position().await {
        Ok(record) => Coordinates::of(&record, letters),
        Err(failure) if failure.kind == Kind::Refused => {
            return Ok(change.note("The controller did not report the position."));
        }
        Err(failure) => return Err(failure),
    };
    let axes = coordinates.mm().into_iter().enumerate();
    Ok(axes.fold(change, |change, (axis, mm)| {
        change.replaces(&titled(axis, letters.of(axis)), &format!("{mm:.2} mm"), "origin")
    }))
}

/// Result of a return to the origin.
#[derive(Debug, Serialize, JsonSchema)]
pub struct HomeReport {
    #[serde(flatten)]
    motion: Motion,
}

impl Report for HomeReport {
    fn view(&self) -> View {
        let Some(position) = &self.motion.position else { return View::fields([("origin", "moving".into())]) };
        View::fields([
            ("origin", Cell::from("done").tone(Tone::Good)),
            ("at", position.line().into()),
            ("elapsed (ms)", Cell::optional(self.motion.elapsed_ms)),
        ])
    }
}

#[cfg(test)]
mod tests {
    use crate::testing::{Bench, Fault};
    use armctl_frame::failure::Kind;

    #[test]
    fn home_ends_with_all_axes_at_their_origin() {
        let (mut bench, received) = Bench::with_faults("position = [50.0, 20.0, 0.0, 0.0]\n", |_, _| Fault::None);
        let data = bench.data(&["home"]);
        assert!(data["elapsed_ms"].as_u64().unwrap() > 1000, "{data}");
        assert_eq!(data["position"]["x_mm"], 0.0);
        let status = bench.data(&["status"]);
        assert_eq!((&status["homed"], &status["running"]), (&true.into(), &false.into()));
        assert_eq!(received.borrow().iter().filter(|block| *block == "@HOME").count(), 1);
    }

    #[test]
    fn a_stopped_return_to_origin_fails() {
        let state = "position = [300.0, 0.0, 0.0, 0.0]\n[[event]]\nat_ms = 1000\ndo = \"stop\"\n";
        let failure = Bench::with_faults(state, |_, _| Fault::None).0.run(&["home"]).unwrap_err();
        assert_eq!(failure.kind, Kind::ConditionNotMet);
        assert!(
            failure.message.contains("but the status shows no origin after the end of the command; the axes are at X "),
            "{}",
            failure.message
        );
    }

    #[test]
    fn no_wait_ends_while_the_axes_move() {
        let (mut bench, _) = Bench::with_faults("position = [300.0, 0.0, 0.0, 0.0]\n", |_, _| Fault::None);
        assert_eq!(bench.data(&["home", "--no-wait"])["position"], serde_json::Value::Null);
        assert_eq!(bench.data(&["status"])["homing"], true);
        let failure = bench.run(&["home"]).unwrap_err();
        assert_eq!(failure.message, "the controller refused HOME (@NG): the axes are returning to the origin");
    }
}

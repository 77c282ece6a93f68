//! `yrcx push` (4.2.23): move of one axis with limited force and time.

use super::drive::Destination;
use super::{FromMotion, Motion, MotionReport};
use crate::arguments::SpeedArguments;
use crate::prelude::*;
use armctl_controller::yrcx::table::Command;

/// Pushes with one axis.
#[derive(Debug, Args)]
#[command(after_help = "Without --force and --time, the parameters PSHFRC and PSHTIME apply.")]
pub struct Push {
    /// Axis to push with, 1 to 4
    #[arg(long, value_name = "AXIS")]
    axis: String,
    #[command(flatten)]
    destination: Destination,
    /// Force in percent of the rated torque, -1000 to 1000
    #[arg(long, value_name = "PERCENT", allow_hyphen_values = true)]
    force: Option<String>,
    /// Duration of the push, 1ms to 32767ms
    #[arg(long, value_name = "TIME", value_parser = milliseconds)]
    time: Option<i32>,
    #[command(flatten)]
    pace: SpeedArguments,
}

/// Parses a time in whole milliseconds.
fn milliseconds(text: &str) -> Result<i32, String> {
    let time = duration::parse(text)?;
    match i32::try_from(time.as_millis()) {
        Ok(ms @ 1..=32_767) if time.subsec_nanos() % 1_000_000 == 0 => Ok(ms),
        _ => Err(format!("the push time must be 1ms to 32767ms in whole milliseconds, not {}s", time.as_secs_f64())),
    }
}

impl Motion for Push {
    type Report = Pushed;
    const ID: &'static str = "yrcx.push";
    const VERB: [&'static str; 3] = ["push with", "pushing with", "pushed with"];

    fn command(&self) -> Command {
        self.destination.choose([Command::PushPoint, Command::PushMm, Command::PushPulse])
    }

    fn fill(&self, draft: Draft) -> Result<Draft> {
        let draft = self.destination.apply_to(draft.with(Key::Axes, self.axis.as_str()));
        self.pace.apply_to(draft.with_some(Key::PushForce, self.force.clone()).with_some(Key::PushTime, self.time))
    }

    fn axis(&self) -> Option<String> {
        Some(format!("axis {}", self.axis))
    }

    fn target(&self) -> String {
        format!("towards {}", self.destination.describe())
    }

    fn axes_and_speed(&self) -> String {
        let force = self.force.as_ref().map(|force| format!(", with {force} % of the rated torque"));
        let time =
            self.time.map(|ms| format!(", for {}", duration::display(Duration::from_millis(ms.unsigned_abs().into()))));
        format!("{}{}{}", self.pace.describe(), force.unwrap_or_default(), time.unwrap_or_default())
    }
}

/// Result of a push.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Pushed {
    #[serde(flatten)]
    moved: MotionReport,
    /// Whether the axis pushed for the whole time; null if the push has not ended.
    push_completed: Option<bool>,
    /// Result as the controller reports it: 1 or 0; null if the push has not ended.
    push_result: Option<i32>,
}

impl FromMotion for Pushed {
    fn from_motion(moved: MotionReport, values: Option<&Values>) -> Self {
        let push_result = values.and_then(|values| values.int(Key::PushResult));
        Self { moved, push_completed: push_result.map(|result| result == 1), push_result }
    }
}

impl Report for Pushed {
    fn view(&self) -> View {
        self.moved.view_with(match self.push_completed {
            Some(true) => "; the axis pushed for the whole push time",
            Some(false) => "; the push ended before the push time was over",
            None => "",
        })
    }
}

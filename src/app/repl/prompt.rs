//! Prompt text: the robot and its state.

use tokio::time::timeout;

use crate::command::fleet::status;
use armctl_frame::face::overview::{LeftOver, OverviewReport};
use armctl_frame::output::escape;
use armctl_frame::output::render::with_color;
use armctl_frame::prelude::*;
use armctl_frame::script_line::Line;

/// Time limit for reading the state of the robot.
const STATE_TIMEOUT: Duration = Duration::from_millis(500);

/// Reads the state of the robot over the open link.
pub async fn read_state(robot: &Robot, line: &Line, screen: &Screen) -> RobotState {
    let screen = screen.silenced();
    match timeout(STATE_TIMEOUT, status::look(robot, line, &screen)).await {
        Ok(Ok(state)) => RobotState::State(Box::new(state)),
        _ => RobotState::Silent,
    }
}

/// State of the robot.
#[derive(Debug)]
pub enum RobotState {
    /// The state.
    State(Box<OverviewReport>),
    /// The robot did not answer in time.
    Silent,
    /// The state was not requested.
    NotAsked,
}

impl RobotState {
    /// Active commands that earlier clients left.
    pub fn leftovers(&self) -> &[LeftOver] {
        match self {
            Self::State(state) => &state.left_over,
            Self::Silent | Self::NotAsked => &[],
        }
    }
}

/// A prompt without and with colors. Both texts have the same width.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Prompt {
    /// Without colors.
    pub plain: String,
    /// With colors.
    pub styled: String,
}

impl Prompt {
    /// Creates a prompt, for example `cell3 [servo on, ALARM] yerc> `.
    pub fn new(prefix: &[String], robot: Option<&Robot>, seen: &RobotState, colour: bool) -> Self {
        let shown = |colour: bool| {
            let mut parts = Vec::new();
            if let Some(robot) = robot {
                let states: Vec<String> = states(robot, seen).iter().map(|state| with_color(state, colour)).collect();
                parts.push(escape::line(&robot.name).into_owned());
                parts.extend((!states.is_empty()).then(|| format!("[{}]", states.join(", "))));
            }
            parts.push(if prefix.is_empty() { "armctl".to_owned() } else { prefix.join(" ") });
            parts.join(" ") + "> "
        };
        Self { plain: shown(false), styled: shown(colour) }
    }
}

/// States of the robot that the prompt shows.
fn states(robot: &Robot, seen: &RobotState) -> Vec<Cell> {
    let simulated = robot.target.value.is_simulated().then(|| Cell::from("simulated"));
    let seen = match seen {
        RobotState::State(seen) => &seen.state,
        RobotState::Silent => return simulated.into_iter().chain([Cell::from("no answer").tone(Tone::Bad)]).collect(),
        RobotState::NotAsked => return simulated.into_iter().chain(["dry run".into()]).collect(),
    };
    let servo = seen.servo_on.map(|on| if on { Cell::from("servo on").tone(Tone::Good) } else { "servo off".into() });
    let state = match (seen.held, seen.running) {
        (Some(true), _) => Some(Cell::from("hold").tone(Tone::Warning)),
        (_, Some(true)) => Some(Cell::from("running").tone(Tone::Good)),
        _ => None,
    };
    let alarm = (seen.fault.faulted == Some(true)).then(|| Cell::from("ALARM").tone(Tone::Bad));
    [simulated, servo, state, alarm].into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_frame::robot::state::{Fault, State};
    use armctl_frame::settings::{Selection, Sources};

    fn simulated() -> Robot {
        let selection = Selection { sim: true, ..Selection::default() };
        Sources { selection, ..Sources::default() }.robots(Some(Family::Yerc)).unwrap().remove(0)
    }

    #[test]
    fn prompt_shows_robot_and_state() {
        let yerc = ["yerc".to_owned()];
        let state = State { servo_on: Some(true), fault: Fault::new(true, None), ..State::default() };
        let seen = OverviewReport { state, ..OverviewReport::default() };
        let prompt = Prompt::new(&yerc, Some(&simulated()), &RobotState::State(Box::new(seen)), true);
        assert_eq!(prompt.plain, "sim [simulated, servo on, ALARM] yerc> ");
        assert_eq!(prompt.styled, "sim [simulated, \u{1b}[32mservo on\u{1b}[0m, \u{1b}[31mALARM\u{1b}[0m] yerc> ");
        assert_eq!(
            Prompt::new(&yerc, Some(&simulated()), &RobotState::Silent, false).styled,
            "sim [simulated, no answer] yerc> "
        );
        assert_eq!(Prompt::new(&[], None, &RobotState::NotAsked, true).plain, "armctl> ");
    }
}

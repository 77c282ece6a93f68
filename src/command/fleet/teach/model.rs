//! State of the teach panel: selection, motion in progress, past commands and their results. Its input is keys and
//! results. It has no terminal, no link and no clock.

use std::collections::VecDeque;

use serde_json::Value;

use super::keys::KeyAction;
use armctl_frame::face::teach_panel::{Panel, System};
use armctl_frame::failure::{Failure, Kind};

/// Number of past commands kept.
const MAX_HISTORY: usize = 20;
/// Text for a point that was never taught.
const EMPTY: &str = "empty";
/// Digits of a point number.
const DIGITS: usize = 5;

/// Next action of the panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PanelCommand {
    /// Move an axis.
    Step {
        /// Axis number.
        axis: usize,
        /// Distance in steps of the controller, or in units.
        by: f64,
    },
    /// Stop the robot.
    Stop,
    /// Release HOLD.
    Release,
    /// Read a point before it is stored or moved to.
    ReadPoint(u32),
    /// Store a point.
    Store(u32),
    /// Move to a point.
    Go(u32),
    /// Quit.
    Quit,
    /// Quit as with Ctrl-C.
    Interrupt,
    /// Redraw the screen.
    Refresh,
}

/// Use of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PointUse {
    /// Store the current position in the point.
    Store,
    /// Move to the point.
    Go,
}

/// Open question to the user.
#[derive(Debug, Clone, PartialEq)]
pub enum Prompt {
    /// Point number, as typed so far.
    PointNumber(PointUse, String),
    /// Confirmation with the current content of the point.
    Overwrite(PointUse, u32, String),
    /// Confirmation to release HOLD.
    Release,
}

/// A past command.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryEntry {
    number: u64,
    /// Command line without the family.
    pub words: String,
    /// Result; `None` while it is in progress.
    pub outcome: Option<Result<(), Failure>>,
}

/// State of the panel.
#[derive(Debug)]
pub struct Model {
    /// Panel of the family.
    pub panel: Panel,
    /// Largest step in mm or degrees.
    max_step: f64,
    max_speed: u32,
    system: usize,
    /// Selected axis.
    pub axis: usize,
    step: usize,
    speed: usize,
    /// Size of the controller's small step per axis, in the unit of the axis.
    scale: Vec<f64>,
    /// Open question.
    pub prompt: Option<Prompt>,
    /// Whether the help is open.
    pub has_help: bool,
    /// Past commands, newest last.
    pub history: VecDeque<HistoryEntry>,
    /// Whether a motion is in progress.
    pub is_moving: bool,
}

impl Model {
    /// Creates the state without a motion.
    pub fn new(panel: Panel, max_step: f64, max_speed: u32) -> Self {
        let mut model = Self {
            panel,
            max_step,
            max_speed,
            system: 0,
            axis: 0,
            step: 0,
            speed: 0,
            scale: Vec::new(),
            prompt: None,
            has_help: false,
            history: VecDeque::new(),
            is_moving: false,
        };
        model.reset_steps();
        model
    }

    /// Sets the sizes of the controller's small steps, in the units of the axes.
    pub fn scale_by(&mut self, scale: Vec<f64>) {
        self.scale = scale;
        self.reset_steps();
    }

    /// Selected coordinate system.
    pub fn system(&self) -> &'static System {
        &self.panel.systems[self.system]
    }

    /// Allowed steps of the selected axis, as on the command line.
    fn steps(&self) -> Vec<f64> {
        let size = self.size();
        let is_bounded = self.unit() != "pulses";
        let fits = |step: &f64| !is_bounded || *step * size <= self.max_step;
        self.system().steps.iter().copied().filter(fits).collect()
    }

    fn speeds(&self) -> Vec<u32> {
        self.system().speeds.iter().copied().filter(|speed| *speed <= self.max_speed).collect()
    }

    /// Distance of a step of 1 on the selected axis.
    fn size(&self) -> f64 {
        self.scale.get(self.axis).copied().unwrap_or(1.0)
    }

    /// Name of the selected axis.
    pub fn axis_name(&self) -> &'static str {
        self.system().axes.get(self.axis).map_or("", |(name, _)| name)
    }

    /// Unit of the selected axis.
    pub fn unit(&self) -> &'static str {
        self.system().axes.get(self.axis).map_or("", |(_, unit)| unit)
    }

    /// Selected step in the unit of the axis; `None` if even the smallest step is not allowed.
    pub fn step(&self) -> Option<f64> {
        self.steps().get(self.step).map(|step| step * self.size())
    }

    /// Selected speed; `None` if the controller has a fixed speed for small steps.
    pub fn speed(&self) -> Option<u32> {
        self.speeds().get(self.speed).copied()
    }

    /// Whether all speeds of the system are above the limit.
    fn is_too_fast(&self) -> bool {
        !self.system().speeds.is_empty() && self.speed().is_none()
    }

    fn reset_steps(&mut self) {
        self.axis = self.axis.min(self.system().axes.len().saturating_sub(1));
        self.step = 1.min(self.steps().len().saturating_sub(1));
        self.speed = 1.min(self.speeds().len().saturating_sub(1));
    }

    /// Handles a key. Returns the resulting action.
    pub fn handle_key(&mut self, action: KeyAction) -> Option<PanelCommand> {
        match action {
            KeyAction::Stop => {
                self.prompt = None;
                return Some(PanelCommand::Stop);
            }
            KeyAction::Interrupt => return Some(PanelCommand::Interrupt),
            KeyAction::Refresh => return Some(PanelCommand::Refresh),
            KeyAction::Quit => return Some(PanelCommand::Quit),
            KeyAction::Escape => {
                self.prompt = None;
                self.has_help = false;
            }
            KeyAction::Help => self.has_help = !self.has_help,
            KeyAction::Type(_) | KeyAction::Erase | KeyAction::Enter => return self.answer_prompt(action),
            KeyAction::Axis(by) => {
                self.axis = moved(self.axis, by, self.system().axes.len());
                self.step = self.step.min(self.steps().len().saturating_sub(1));
            }
            KeyAction::StepSize(by) => self.step = moved(self.step, by, self.steps().len()),
            KeyAction::Speed(by) => self.speed = moved(self.speed, by, self.speeds().len()),
            // During a motion, all other keys are ignored and not queued. A key that is held down must not fill a
            // queue.
            _ if self.is_moving => {}
            KeyAction::System => {
                self.system = (self.system + 1) % self.panel.systems.len();
                self.reset_steps();
            }
            KeyAction::Step(forwards) => {
                let step = self.steps().get(self.step).copied().filter(|_| !self.is_too_fast())?;
                return Some(PanelCommand::Step { axis: self.axis, by: if forwards { step } else { -step } });
            }
            KeyAction::Store => self.prompt = Some(Prompt::PointNumber(PointUse::Store, String::new())),
            KeyAction::Go if !self.is_too_fast() => {
                self.prompt = Some(Prompt::PointNumber(PointUse::Go, String::new()));
            }
            KeyAction::Release if self.panel.release.is_some() => self.prompt = Some(Prompt::Release),
            KeyAction::Go | KeyAction::Release => {}
        }
        None
    }

    /// Handles a key of an answer.
    fn answer_prompt(&mut self, action: KeyAction) -> Option<PanelCommand> {
        match (self.prompt.as_mut()?, action) {
            (Prompt::PointNumber(_, typed), KeyAction::Type(digit))
                if digit.is_ascii_digit() && typed.len() < DIGITS =>
            {
                typed.push(digit);
            }
            (Prompt::PointNumber(_, typed), KeyAction::Erase) => _ = typed.pop(),
            (Prompt::PointNumber(_, typed), KeyAction::Enter) => {
                return typed.parse().ok().map(PanelCommand::ReadPoint);
            }
            (Prompt::Overwrite(what, point, _), KeyAction::Type('y' | 'Y')) => {
                let wish = match what {
                    PointUse::Store => PanelCommand::Store(*point),
                    PointUse::Go => PanelCommand::Go(*point),
                };
                self.prompt = None;
                return Some(wish);
            }
            (Prompt::Release, KeyAction::Type('y' | 'Y')) => {
                self.prompt = None;
                return Some(PanelCommand::Release);
            }
            // Only "y" confirms.
            (Prompt::Overwrite(..) | Prompt::Release, KeyAction::Type(_) | KeyAction::Enter) => self.prompt = None,
            _ => {}
        }
        None
    }

    /// Handles the content of a point: asks for confirmation.
    pub fn point_read(&mut self, point: u32, content: Result<Value, Failure>) {
        // The user can have closed the question.
        let Some(Prompt::PointNumber(what, _)) = self.prompt else { return };
        match content {
            Ok(data) => self.prompt = Some(Prompt::Overwrite(what, point, content_of(&data))),
            // The point was never taught.
            Err(failure) if what == PointUse::Store && failure.kind == Kind::Refused => {
                self.prompt = Some(Prompt::Overwrite(what, point, EMPTY.to_owned()));
            }
            Err(failure) => {
                self.prompt = None;
                let number = self.begin(&(self.panel.stored)(point));
                self.end(number, Err(failure));
            }
        }
    }

    /// Adds a command in progress. Returns its number.
    pub fn begin(&mut self, words: &[String]) -> u64 {
        if self.history.len() == MAX_HISTORY {
            self.history.pop_front();
        }
        let number = self.history.back().map_or(0, |last| last.number + 1);
        self.history.push_back(HistoryEntry { number, words: words.join(" "), outcome: None });
        number
    }

    /// Replaces the text of a command by the actual command line.
    pub fn set_outcome(&mut self, number: u64, words: &[String]) {
        if let Some(typed) = self.history.iter_mut().find(|typed| typed.number == number) {
            typed.words = words.join(" ");
        }
    }

    /// Sets the result of a command.
    pub fn end(&mut self, number: u64, outcome: Result<(), Failure>) {
        if let Some(typed) = self.history.iter_mut().find(|typed| typed.number == number) {
            typed.outcome = Some(outcome);
        }
    }
}

/// Moves an index within its range.
fn moved(index: usize, by: isize, length: usize) -> usize {
    index.saturating_add_signed(by).min(length.saturating_sub(1))
}

/// One-line content of a point, from the data of its read command.
fn content_of(data: &Value) -> String {
    let list = data.as_object().and_then(|fields| fields.values().find_map(Value::as_array));
    let point = list.and_then(|list| list.first()).unwrap_or(&Value::Null);
    let label = point.get("label").and_then(Value::as_str).map(|label| format!("{label}: ")).unwrap_or_default();
    let value = point.get("value").unwrap_or(point);
    format!("{label}{}", place_of(value))
}

/// One-line position.
fn place_of(value: &Value) -> String {
    if let Some(text) = value.get("text").and_then(Value::as_str) {
        return text.to_owned();
    }
    let is_place = |name: &str| ["_mm", "_deg", "_pulses"].iter().any(|unit| name.ends_with(unit));
    let fields = value.as_object().into_iter().flatten().filter(|(name, value)| is_place(name) && !value.is_null());
    let fields: Vec<String> = fields.map(|(name, value)| format!("{name} {value}")).collect();
    if fields.is_empty() { EMPTY.to_owned() } else { fields.join(", ") }
}

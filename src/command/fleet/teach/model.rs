//! State of the teach panel: selection, motion in progress, past commands and their results. Its input is keys and
//! results. It knows no terminal, no link and no clock.

use std::collections::VecDeque;

use serde_json::Value;

use super::keys::KeyAction;
use crate::command::face::teach_panel::{Panel, System};
use crate::failure::{Failure, Kind};

/// Number of past commands kept.
const PAST: usize = 20;
/// Text for a point that was never taught.
const EMPTY: &str = "empty";
/// Digits of a point number.
const DIGITS: usize = 5;

/// Next action of the panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wish {
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
    Look(u32),
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
pub enum Use {
    /// Store the current position in the point.
    Store,
    /// Move to the point.
    Go,
}

/// Open question to the user.
#[derive(Debug, Clone, PartialEq)]
pub enum Asked {
    /// Point number, as typed so far.
    Point(Use, String),
    /// Confirmation with the current content of the point.
    Sure(Use, u32, String),
    /// Confirmation to release HOLD.
    Release,
}

/// A past command.
#[derive(Debug, Clone, PartialEq)]
pub struct Typed {
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
    pub asked: Option<Asked>,
    /// Whether the help is open.
    pub has_help: bool,
    /// Past commands, newest last.
    pub past: VecDeque<Typed>,
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
            asked: None,
            has_help: false,
            past: VecDeque::new(),
            is_moving: false,
        };
        model.begin_again();
        model
    }

    /// Sets the sizes of the controller's small steps, in the units of the axes.
    pub fn scale_by(&mut self, scale: Vec<f64>) {
        self.scale = scale;
        self.begin_again();
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

    fn begin_again(&mut self) {
        self.axis = self.axis.min(self.system().axes.len().saturating_sub(1));
        self.step = 1.min(self.steps().len().saturating_sub(1));
        self.speed = 1.min(self.speeds().len().saturating_sub(1));
    }

    /// Handles a key. Returns the resulting action.
    pub fn obey(&mut self, action: KeyAction) -> Option<Wish> {
        match action {
            KeyAction::Stop => {
                self.asked = None;
                return Some(Wish::Stop);
            }
            KeyAction::Interrupt => return Some(Wish::Interrupt),
            KeyAction::Refresh => return Some(Wish::Refresh),
            KeyAction::Quit => return Some(Wish::Quit),
            KeyAction::Escape => {
                self.asked = None;
                self.has_help = false;
            }
            KeyAction::Help => self.has_help = !self.has_help,
            KeyAction::Type(_) | KeyAction::Erase | KeyAction::Enter => return self.answer(action),
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
                self.begin_again();
            }
            KeyAction::Step(forwards) => {
                let step = self.steps().get(self.step).copied().filter(|_| !self.is_too_fast())?;
                return Some(Wish::Step { axis: self.axis, by: if forwards { step } else { -step } });
            }
            KeyAction::Store => self.asked = Some(Asked::Point(Use::Store, String::new())),
            KeyAction::Go if !self.is_too_fast() => self.asked = Some(Asked::Point(Use::Go, String::new())),
            KeyAction::Release if self.panel.release.is_some() => self.asked = Some(Asked::Release),
            KeyAction::Go | KeyAction::Release => {}
        }
        None
    }

    /// Handles a key of an answer.
    fn answer(&mut self, action: KeyAction) -> Option<Wish> {
        match (self.asked.as_mut()?, action) {
            (Asked::Point(_, typed), KeyAction::Type(digit)) if digit.is_ascii_digit() && typed.len() < DIGITS => {
                typed.push(digit);
            }
            (Asked::Point(_, typed), KeyAction::Erase) => _ = typed.pop(),
            (Asked::Point(_, typed), KeyAction::Enter) => return typed.parse().ok().map(Wish::Look),
            (Asked::Sure(what, point, _), KeyAction::Type('y' | 'Y')) => {
                let wish = match what {
                    Use::Store => Wish::Store(*point),
                    Use::Go => Wish::Go(*point),
                };
                self.asked = None;
                return Some(wish);
            }
            (Asked::Release, KeyAction::Type('y' | 'Y')) => {
                self.asked = None;
                return Some(Wish::Release);
            }
            // Only "y" confirms.
            (Asked::Sure(..) | Asked::Release, KeyAction::Type(_) | KeyAction::Enter) => self.asked = None,
            _ => {}
        }
        None
    }

    /// Handles the content of a point: asks for confirmation.
    pub fn found(&mut self, point: u32, content: Result<Value, Failure>) {
        // The user can have closed the question.
        let Some(Asked::Point(what, _)) = self.asked else { return };
        match content {
            Ok(data) => self.asked = Some(Asked::Sure(what, point, content_of(&data))),
            // The point was never taught.
            Err(failure) if what == Use::Store && failure.kind == Kind::Refused => {
                self.asked = Some(Asked::Sure(what, point, EMPTY.to_owned()));
            }
            Err(failure) => {
                self.asked = None;
                let number = self.begin(&(self.panel.stored)(point));
                self.end(number, Err(failure));
            }
        }
    }

    /// Adds a command in progress. Returns its number.
    pub fn begin(&mut self, words: &[String]) -> u64 {
        if self.past.len() == PAST {
            self.past.pop_front();
        }
        let number = self.past.back().map_or(0, |last| last.number + 1);
        self.past.push_back(Typed { number, words: words.join(" "), outcome: None });
        number
    }

    /// Replaces the text of a command by the actual command line.
    pub fn was(&mut self, number: u64, words: &[String]) {
        if let Some(typed) = self.past.iter_mut().find(|typed| typed.number == number) {
            typed.words = words.join(" ");
        }
    }

    /// Sets the result of a command.
    pub fn end(&mut self, number: u64, outcome: Result<(), Failure>) {
        if let Some(typed) = self.past.iter_mut().find(|typed| typed.number == number) {
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

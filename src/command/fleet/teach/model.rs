//! What the panel knows: what is chosen, what is under way, what was typed and what came of it. It is handed keys and
//! outcomes, and knows no terminal, no line and no clock.

use std::collections::VecDeque;

use serde_json::Value;

use super::keys::KeyAction;
use crate::command::face::panel::{Panel, System};
use crate::failure::{Failure, Kind};

/// Lines of the past that are kept.
const PAST: usize = 20;
/// What a point holds that was never taught.
const EMPTY: &str = "empty";
/// Digits of a point.
const DIGITS: usize = 5;

/// What the panel shall do next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Wish {
    /// Move an axis.
    Step {
        /// Its number.
        axis: usize,
        /// By so many steps of the controller, or units.
        by: f64,
    },
    /// Stop the robot.
    Stop,
    /// Let it go on.
    Release,
    /// Ask what is in a point, before it is stored, or gone to.
    Look(u32),
    /// Store a point.
    Store(u32),
    /// Go to a point.
    Go(u32),
    /// End.
    Quit,
    /// End as Ctrl-C does.
    Interrupt,
    /// Draw everything anew.
    Refresh,
}

/// What is done with a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Use {
    /// The place of the robot is stored in it.
    Store,
    /// The robot goes to it.
    Go,
}

/// What was asked of the person.
#[derive(Debug, Clone, PartialEq)]
pub enum Asked {
    /// Which point; as far as it is typed.
    Point(Use, String),
    /// Whether to do it, with what the point holds now.
    Sure(Use, u32, String),
    /// Whether to let a held robot go on.
    Release,
}

/// A line that was typed for a key.
#[derive(Debug, Clone, PartialEq)]
pub struct Typed {
    number: u64,
    /// As a person would type it, behind the word of the family.
    pub words: String,
    /// What came of it; nothing while it is under way.
    pub outcome: Option<Result<(), Failure>>,
}

/// Everything that a picture of the panel is made of.
#[derive(Debug)]
pub struct Model {
    /// The keys as command lines.
    pub panel: Panel,
    /// Most that a key may move, in mm or degrees.
    max_step: f64,
    max_speed: u32,
    system: usize,
    /// The chosen axis.
    pub axis: usize,
    step: usize,
    speed: usize,
    /// Size of the controller's own small step of each axis, in the unit of the axis.
    scale: Vec<f64>,
    /// What the person is asked.
    pub asked: Option<Asked>,
    /// Whether the keys are explained.
    pub has_help: bool,
    /// Lines that were typed, the latest at the end.
    pub past: VecDeque<Typed>,
    /// Whether a step or a motion is under way.
    pub is_moving: bool,
}

impl Model {
    /// Nothing moves yet.
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

    /// The sizes of the controller's own small steps, in the units of the axes.
    pub fn scale_by(&mut self, scale: Vec<f64>) {
        self.scale = scale;
        self.begin_again();
    }

    /// The way in which axes move.
    pub fn system(&self) -> &'static System {
        &self.panel.systems[self.system]
    }

    /// Steps that a key may move the chosen axis, as the command line has them.
    fn steps(&self) -> Vec<f64> {
        let size = self.size();
        let is_bounded = self.unit() != "pulses";
        let fits = |step: &f64| !is_bounded || *step * size <= self.max_step;
        self.system().steps.iter().copied().filter(fits).collect()
    }

    fn speeds(&self) -> Vec<u32> {
        self.system().speeds.iter().copied().filter(|speed| *speed <= self.max_speed).collect()
    }

    /// How much the chosen axis moves by a step of 1.
    fn size(&self) -> f64 {
        self.scale.get(self.axis).copied().unwrap_or(1.0)
    }

    /// The name of the chosen axis.
    pub fn axis_name(&self) -> &'static str {
        self.system().axes.get(self.axis).map_or("", |(name, _)| name)
    }

    /// The unit of the chosen axis.
    pub fn unit(&self) -> &'static str {
        self.system().axes.get(self.axis).map_or("", |(_, unit)| unit)
    }

    /// How far a key moves the chosen axis, in its unit; nothing where not even the least step is allowed.
    pub fn step(&self) -> Option<f64> {
        self.steps().get(self.step).map(|step| step * self.size())
    }

    /// How fast; nothing where the controller has its own speed for small steps.
    pub fn speed(&self) -> Option<u32> {
        self.speeds().get(self.speed).copied()
    }

    /// Whether no speed of this way is as low as is allowed.
    fn is_too_fast(&self) -> bool {
        !self.system().speeds.is_empty() && self.speed().is_none()
    }

    fn begin_again(&mut self) {
        self.axis = self.axis.min(self.system().axes.len().saturating_sub(1));
        self.step = 1.min(self.steps().len().saturating_sub(1));
        self.speed = 1.min(self.speeds().len().saturating_sub(1));
    }

    /// Takes a key, and says what is to be done.
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
            // Whatever else is wanted waits until what moves has ended, and is not remembered: a key that is held down
            // must not fill a queue.
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

    /// A key of an answer.
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
            // Only a y is a yes.
            (Asked::Sure(..) | Asked::Release, KeyAction::Type(_) | KeyAction::Enter) => self.asked = None,
            _ => {}
        }
        None
    }

    /// What a point holds now: the next question.
    pub fn found(&mut self, point: u32, content: Result<Value, Failure>) {
        // Meanwhile the question may have been put away.
        let Some(Asked::Point(what, _)) = self.asked else { return };
        match content {
            Ok(data) => self.asked = Some(Asked::Sure(what, point, content_of(&data))),
            // Nobody has taught it yet.
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

    /// A line is on its way: its number.
    pub fn begin(&mut self, words: &[String]) -> u64 {
        if self.past.len() == PAST {
            self.past.pop_front();
        }
        let number = self.past.back().map_or(0, |last| last.number + 1);
        self.past.push_back(Typed { number, words: words.join(" "), outcome: None });
        number
    }

    /// What a line turned out to be.
    pub fn was(&mut self, number: u64, words: &[String]) {
        if let Some(typed) = self.past.iter_mut().find(|typed| typed.number == number) {
            typed.words = words.join(" ");
        }
    }

    /// A line has ended.
    pub fn end(&mut self, number: u64, outcome: Result<(), Failure>) {
        if let Some(typed) = self.past.iter_mut().find(|typed| typed.number == number) {
            typed.outcome = Some(outcome);
        }
    }
}

/// An index moved within bounds.
fn moved(index: usize, by: isize, length: usize) -> usize {
    index.saturating_add_signed(by).min(length.saturating_sub(1))
}

/// What a point holds, in a line, of the data of a command that read it alone.
fn content_of(data: &Value) -> String {
    let list = data.as_object().and_then(|fields| fields.values().find_map(Value::as_array));
    let point = list.and_then(|list| list.first()).unwrap_or(&Value::Null);
    let label = point.get("label").and_then(Value::as_str).map(|label| format!("{label}: ")).unwrap_or_default();
    let value = point.get("value").unwrap_or(point);
    format!("{label}{}", place_of(value))
}

/// A place in a line.
fn place_of(value: &Value) -> String {
    if let Some(text) = value.get("text").and_then(Value::as_str) {
        return text.to_owned();
    }
    let is_place = |name: &str| ["_mm", "_deg", "_pulses"].iter().any(|unit| name.ends_with(unit));
    let fields = value.as_object().into_iter().flatten().filter(|(name, value)| is_place(name) && !value.is_null());
    let fields: Vec<String> = fields.map(|(name, value)| format!("{name} {value}")).collect();
    if fields.is_empty() { EMPTY.to_owned() } else { fields.join(", ") }
}

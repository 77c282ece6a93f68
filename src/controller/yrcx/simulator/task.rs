//! Tasks that run programs, one line per scan.

use super::alarms::{AlarmSource, CALLS, Fault, NO_TASK, RUNNING};
use super::geometry::FourValues;
use super::memory::PortRef;
use super::memory::calculate;
use super::motion::{End, Owner};
use super::moves::Speed;
use super::program::{Operand, Statement};
use super::world::World;
use crate::{Now, refuse_if};

const MAX_CALLS: usize = 16;
pub(super) const TASKS: u8 = 16;
/// The program whose subroutines every program can call (4.6.4).
const COMMON: &str = "COMMON";

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
pub(super) enum State {
    #[default]
    #[serde(rename = "stop")]
    Stopped,
    #[serde(rename = "run")]
    Running,
    #[serde(rename = "suspend")]
    Suspended,
}

/// Where a task stops.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum StopPoint {
    End,
    /// The task stops after one line.
    Line,
    /// The task stops after one line, including a subroutine that the line calls. The value is the call depth at the
    /// start of the line.
    Call(usize),
}

/// What the current line waits for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum LineWait {
    Nothing,
    Delay(Now),
    Moving(usize),
    Waiting,
}

/// A program line: number of the program, and index of the line from 0.
type LinePosition = (u8, usize);

#[derive(Debug, Clone)]
pub(super) struct Task {
    pub(super) number: u8,
    /// Number of the registered program.
    pub(super) program: u8,
    pub(super) priority: u8,
    pub(super) state: State,
    at: LinePosition,
    calls: Vec<LinePosition>,
    doing: LineWait,
    until: StopPoint,
    /// Line and target of an interrupted relative motion.
    kept: Option<(LinePosition, FourValues)>,
}

impl Task {
    /// A stopped task at the first line of its program.
    pub(super) fn new(number: u8, program: u8, priority: u8) -> Self {
        Self {
            number,
            program,
            priority,
            state: State::Stopped,
            at: (program, 0),
            calls: Vec::new(),
            doing: LineWait::Nothing,
            until: StopPoint::End,
            kept: None,
        }
    }

    /// Sets the current line, counted from 0.
    pub(super) fn set_line(&mut self, line: usize) {
        self.at.1 = line;
    }

    /// Time of the next action.
    pub(super) fn due(&self, now: Now) -> Option<Now> {
        match (self.state, self.doing) {
            (State::Running, LineWait::Nothing) => Some(now),
            (State::Running, LineWait::Delay(until)) => Some(until),
            // The end of a motion or the change of a signal causes a scan anyway.
            _ => None,
        }
    }

    /// Status code: 0 is stop, 1 is execution, 2 is suspend, 3 is standby (4.7.5).
    pub(super) fn status(&self) -> i32 {
        match (self.state, self.doing) {
            (State::Stopped, _) => 0,
            (State::Running, LineWait::Waiting) => 3,
            (State::Running, _) => 1,
            (State::Suspended, _) => 2,
        }
    }

    fn reset(&mut self) {
        *self = Self::new(self.number, self.program, self.priority);
    }

    fn stop(&mut self) {
        if self.state != State::Suspended {
            self.state = State::Stopped;
        }
        self.doing = LineWait::Nothing;
    }
}

/// How a task continues after it has executed a line.
enum Flow {
    Next,
    Stay,
    To(LinePosition),
    Over,
}

impl World {
    /// Whether any program runs: SO(13).
    pub(super) fn is_running(&self) -> bool {
        self.tasks.iter().any(|task| task.state == State::Running)
    }

    /// Current line of a task, from 1. For lines of the program COMMON, 10000 is added (4.6.4).
    pub(super) fn line_of(&self, task: &Task) -> i32 {
        let (program, line) = task.at;
        let common = self.programs.get(&program).is_some_and(|program| program.name == COMMON);
        let line = i32::try_from(line).unwrap_or(i32::MAX).saturating_add(1);
        if common { line.saturating_add(10_000) } else { line }
    }

    /// Stops all tasks at their lines.
    pub(super) fn stop_tasks(&mut self) {
        self.tasks.iter_mut().for_each(Task::stop);
    }

    /// Resets all tasks to the first line.
    pub(super) fn reset_programs(&mut self) -> Result<(), Fault> {
        self.none_runs()?;
        self.tasks.iter_mut().for_each(Task::reset);
        self.reset_done = true;
        Ok(())
    }

    /// Resets one task to the first line.
    pub(super) fn reset_task(&mut self, at: usize) -> Result<(), Fault> {
        let task = self.tasks.get_mut(at).ok_or_else(no_task)?;
        refuse_if(task.state == State::Running, running())?;
        task.reset();
        self.reset_done = self.tasks.iter().all(|task| task.at == (task.program, 0) && task.calls.is_empty());
        Ok(())
    }

    pub(super) fn start_all(&mut self) -> Result<(), Fault> {
        self.may_run()?;
        refuse_if(self.tasks.is_empty(), no_task())?;
        (0..self.tasks.len()).for_each(|at| self.start(at, StopPoint::End));
        Ok(())
    }

    pub(super) fn start_task(&mut self, at: usize) -> Result<(), Fault> {
        self.may_run()?;
        self.tasks.get(at).ok_or_else(no_task)?;
        self.start(at, StopPoint::End);
        Ok(())
    }

    /// Runs one line of a task. If `over` is true, a subroutine that the line calls runs to its end.
    pub(super) fn step_task(&mut self, at: usize, over: bool) -> Result<(), Fault> {
        self.may_run()?;
        self.none_runs()?;
        let task = self.tasks.get(at).ok_or_else(no_task)?;
        let until = if over { StopPoint::Call(task.calls.len()) } else { StopPoint::Line };
        self.start(at, until);
        Ok(())
    }

    pub(super) fn skip_line(&mut self, at: usize) -> Result<(), Fault> {
        self.may_run()?;
        self.none_runs()?;
        let (program, line) = self.tasks.get(at).ok_or_else(no_task)?.at;
        let lines = self.programs.get(&program).map_or(0, |program| program.lines.len());
        if let Some(task) = self.tasks.get_mut(at).filter(|_| line + 1 < lines) {
            task.at.1 = line + 1;
            self.reset_done = false;
        }
        Ok(())
    }

    /// Checks that no program runs.
    pub(super) fn none_runs(&self) -> Result<(), Fault> {
        if self.is_running() { Err(running()) } else { Ok(()) }
    }

    /// Runs all tasks for this scan, in the order of their priority.
    pub(super) fn run_tasks(&mut self) {
        let mut order: Vec<usize> = (0..self.tasks.len()).collect();
        order.sort_by_key(|at| self.tasks.get(*at).map(|task| (task.priority, task.number)));
        for at in order {
            if self.tasks.get(at).is_some_and(|task| task.state == State::Running) {
                self.run_task(at);
            }
        }
    }

    fn start(&mut self, at: usize, until: StopPoint) {
        self.reset_done = false;
        let Some(task) = self.tasks.get_mut(at).filter(|task| task.state != State::Running) else { return };
        task.state = State::Running;
        task.doing = LineWait::Nothing;
        task.until = until;
        let owner = Owner::Task(task.number);
        for robot in &mut self.robots {
            robot.ended.retain(|(other, _)| *other != owner);
        }
    }

    fn run_task(&mut self, at: usize) {
        let Some(task) = self.tasks.get(at) else { return };
        let (number, spot, doing) = (task.number, task.at, task.doing);
        let flow = match doing {
            LineWait::Delay(until) if self.now < until => Ok(Flow::Stay),
            LineWait::Delay(_) => Ok(Flow::Next),
            LineWait::Moving(robot) => match self.robot_mut(robot).map(|robot| robot.take_end(Owner::Task(number))) {
                Ok(None) => Ok(Flow::Stay),
                Ok(Some(End::Stopped(fault))) | Err(fault) => Err(fault),
                Ok(Some(End::Arrived | End::Pushed)) => Ok(Flow::Next),
            },
            LineWait::Nothing | LineWait::Waiting => self.execute(at, spot),
        };
        match flow {
            Ok(flow) => self.follow(at, &flow),
            Err(fault) => {
                // An error in one program stops all programs.
                self.stop_tasks();
                self.note(Fault { place: AlarmSource::Task(number), ..fault });
            }
        }
    }

    fn follow(&mut self, at: usize, flow: &Flow) {
        let programs = &self.programs;
        let Some(task) = self.tasks.get_mut(at) else { return };
        let to = match *flow {
            Flow::Stay => return,
            Flow::Next => Some((task.at.0, task.at.1 + 1)),
            Flow::To(spot) => Some(spot),
            Flow::Over => None,
        };
        task.kept = None;
        task.doing = LineWait::Nothing;
        match to.filter(|(program, line)| programs.get(program).is_some_and(|program| *line < program.lines.len())) {
            Some(spot) => {
                task.at = spot;
                let over = match task.until {
                    StopPoint::End => false,
                    StopPoint::Line => true,
                    StopPoint::Call(depth) => task.calls.len() <= depth,
                };
                if over {
                    task.state = State::Stopped;
                }
            }
            // A program that has executed its last line is at its first line again.
            None => task.reset(),
        }
        // Other tasks may wait for the end of this task, so one more scan is needed.
        self.restless = true;
    }

    fn execute(&mut self, at: usize, (program, line): LinePosition) -> Result<Flow, Fault> {
        let code = self.programs.get(&program).and_then(|program| program.lines.get(line)).cloned();
        let Some(code) = code else { return Ok(Flow::Over) };
        match code {
            Statement::Nothing => {}
            Statement::Halt => return Ok(Flow::Over),
            Statement::Delay(time) => {
                self.set_doing(at, LineWait::Delay(self.now.saturating_add(time)));
                return Ok(Flow::Stay);
            }
            Statement::Move { robot, linear, relative, point } => {
                return self.program_move(at, robot, linear, relative, point);
            }
            Statement::Output(port, value) => self.memory.set_output(port, value),
            Statement::Wait(port, value) => {
                if self.signal(port) != value {
                    self.set_doing(at, LineWait::Waiting);
                    return Ok(Flow::Stay);
                }
            }
            Statement::Assign { variable, first, then } => {
                let operand = |world: &Self, operand| match operand {
                    Operand::Number(number) => number,
                    Operand::Variable(number) => world.memory.variable(number),
                };
                let first = operand(self, first);
                let value = match then {
                    Some((operation, second)) => calculate(operation, first, operand(self, second))?,
                    None => first.wide(),
                };
                self.memory.assign(variable, value)?;
            }
            Statement::Goto(label) => return self.label(program, &label).map(Flow::To),
            Statement::Gosub(label) => {
                let spot = self.label(program, &label)?;
                let task = self.tasks.get_mut(at).ok_or_else(no_task)?;
                if task.calls.len() >= MAX_CALLS {
                    return Err(Fault::new(CALLS, AlarmSource::Controller, "too many nested calls"));
                }
                task.calls.push((program, line + 1));
                return Ok(Flow::To(spot));
            }
            Statement::Return => {
                let call = self.tasks.get_mut(at).and_then(|task| task.calls.pop());
                let none = || Fault::new(CALLS, AlarmSource::Controller, "RETURN without GOSUB");
                return call.map(Flow::To).ok_or_else(none);
            }
        }
        Ok(Flow::Next)
    }

    fn program_move(
        &mut self,
        at: usize,
        robot: usize,
        linear: bool,
        relative: bool,
        point: usize,
    ) -> Result<Flow, Fault> {
        if self.robot(robot)?.motion.is_some() {
            // The line is tried again in the next scan: the robot still decelerates after a stop, or another owner
            // moves it.
            self.restless = true;
            return Ok(Flow::Stay);
        }
        let task = self.tasks.get(at).ok_or_else(no_task)?;
        let (number, spot) = (task.number, task.at);
        let kept = task.kept.filter(|(kept, _)| relative && *kept == spot && self.switches.keep);
        let point = self.memory.point(point)?;
        let target = match kept {
            Some((_, target)) => target,
            None if relative => self.relative_target(robot, super::robot::ALL, &point)?,
            None => self.point_target(robot, super::robot::ALL, &point)?,
        };
        self.begin_program_move(robot, Owner::Task(number), &target, linear, Speed::default())?;
        if let Some(task) = self.tasks.get_mut(at) {
            task.kept = relative.then_some((spot, target));
        }
        self.set_doing(at, LineWait::Moving(robot));
        Ok(Flow::Stay)
    }

    fn set_doing(&mut self, at: usize, doing: LineWait) {
        if let Some(task) = self.tasks.get_mut(at) {
            task.doing = doing;
        }
    }

    fn label(&self, program: u8, label: &str) -> Result<LinePosition, Fault> {
        let own = self.programs.get(&program).and_then(|found| found.labels.get(label)).map(|line| (program, *line));
        let common = || {
            let (number, found) = self.programs.iter().find(|(_, program)| program.name == COMMON)?;
            found.labels.get(label).map(|line| (*number, *line))
        };
        let missing = || Fault::new(CALLS, AlarmSource::Controller, format!("no label *{label}"));
        own.or_else(common).ok_or_else(missing)
    }

    fn signal(&self, port: PortRef) -> u8 {
        let value = self.memory.port(port.kind, port.port);
        port.bit.map_or(value, |bit| value >> bit & 1)
    }
}

fn no_task() -> Fault {
    Fault::new(NO_TASK, AlarmSource::Controller, "no such program is registered in a task")
}

fn running() -> Fault {
    Fault::new(RUNNING, AlarmSource::Controller, "a program runs")
}

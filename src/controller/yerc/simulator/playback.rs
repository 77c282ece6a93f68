//! Job execution: selected job, next line, effects of the lines.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use super::job::{Arithmetic, Condition, Instruction, Move, MoveTarget, Operand, Program, Target};
use super::memory::Kind;
use super::motion::{AXES, Family, MAX_LINEAR_MM_S, Pose, Pulses, Speed, inverse};
use super::world::World;
use crate::yerc::payload::{CycleMode, JobInfo, Text};
use crate::{Now, refuse_if};

/// Duration of a line without a motion or a wait.
const LINE_TIME: Duration = Duration::from_millis(2);
const MAX_CALLS: usize = 12;
/// Signal number of general-purpose output 1.
const FIRST_OUTPUT: u32 = 10010;
/// Signal number of general-purpose input 1.
const FIRST_INPUT: u32 = 10;
/// A speed override of 100 %, in the unit of command 0x73 (read job).
const FULL_OVERRIDE: u32 = 10_000;

/// A job and its next line.
#[derive(Debug, Clone)]
struct Cursor {
    name: Vec<u8>,
    program: Arc<Program>,
    line: usize,
}

/// What the execution of the current job waits for.
#[derive(Debug, Clone, Default)]
enum State {
    #[default]
    Stopped,
    /// The next line runs at this time.
    Due(Now),
    /// A motion runs. The line ends with the motion.
    Moving,
    /// The line ends when the condition is true. If there is a time, the line ends at this time at the latest.
    Waiting(Condition, Option<Now>),
}

#[derive(Debug, Clone, Default)]
pub(super) struct Player {
    cursor: Option<Cursor>,
    callers: Vec<Cursor>,
    state: State,
    /// Master jobs by task. Instances 10 and above of command 0x87 select them.
    pub(super) masters: BTreeMap<u16, Vec<u8>>,
}

impl Player {
    pub(super) fn is_running(&self) -> bool {
        !matches!(self.state, State::Stopped)
    }

    pub(super) fn has_job(&self) -> bool {
        self.cursor.is_some()
    }

    pub(super) fn due(&self) -> Option<Now> {
        match &self.state {
            State::Due(at) => Some(*at),
            State::Waiting(_, until) => *until,
            State::Stopped | State::Moving => None,
        }
    }

    /// Stops the job at its current line. A later start continues at this line.
    pub(super) fn stop(&mut self) {
        self.state = State::Stopped;
    }

    /// Selects the job to execute. Returns `false` if the line does not exist.
    pub(super) fn select(&mut self, name: &[u8], program: Program, line: usize) -> bool {
        if line >= program.lines.len() {
            return false;
        }
        *self = Self { masters: std::mem::take(&mut self.masters), ..Self::default() };
        self.cursor = Some(Cursor { name: name.to_vec(), program: Arc::new(program), line });
        true
    }

    /// Removes a job from all selections, because its file was deleted.
    pub(super) fn forget(&mut self, name: &[u8]) {
        self.masters.retain(|_, master| master != name);
        if self.cursor.iter().chain(&self.callers).any(|cursor| cursor.name == name) {
            *self = Self { masters: std::mem::take(&mut self.masters), ..Self::default() };
        }
    }

    pub(super) fn start(&mut self, now: Now) {
        self.state = State::Due(now + LINE_TIME);
    }

    /// Answer to command 0x73 (read job) for the master task.
    pub(super) fn info(&self) -> JobInfo {
        let Some(cursor) = &self.cursor else {
            return JobInfo { speed_override: FULL_OVERRIDE, ..JobInfo::default() };
        };
        let number = |value: usize| u32::try_from(value).unwrap_or(u32::MAX);
        JobInfo {
            name: Text::cut(&cursor.name),
            line: number(cursor.line),
            step: number(cursor.program.step(cursor.line)),
            speed_override: FULL_OVERRIDE,
        }
    }

    /// Continues with the next line at this time.
    fn next_line(&mut self, at: Now) {
        if let Some(cursor) = &mut self.cursor {
            cursor.line += 1;
        }
        self.state = State::Due(at);
    }
}

/// Why a line cannot be executed: alarm number and sub-code.
struct Fault(u32, u32);

const UNDEFINED_POSITION: Fault = Fault(4448, 1);
const NO_LABEL_OR_JOB: Fault = Fault(4410, 1);
const TOO_MANY_CALLS: Fault = Fault(4417, 1);
const OUT_OF_RANGE: Fault = Fault(4446, 1);

impl World {
    /// Handles that the motion of the current line has reached its target.
    pub(super) fn motion_done(&mut self) {
        if matches!(self.player.state, State::Moving) {
            self.line_done(self.now);
        }
    }

    /// Executes the lines that are due.
    pub(super) fn play(&mut self) {
        match self.player.state {
            State::Due(at) if at <= self.now => self.execute_line(),
            State::Waiting(condition, until) => {
                if self.holds(&condition) || until.is_some_and(|until| until <= self.now) {
                    self.line_done(self.now + LINE_TIME);
                }
            }
            State::Stopped | State::Due(_) | State::Moving => {}
        }
    }

    /// Continues with the next line, unless the cycle mode is step mode.
    fn line_done(&mut self, at: Now) {
        self.player.next_line(at);
        if self.switches.cycle == CycleMode::Step {
            self.player.stop();
        }
    }

    fn execute_line(&mut self) {
        let Some(cursor) = &self.player.cursor else { return self.player.stop() };
        let program = Arc::clone(&cursor.program);
        let Some(instruction) = program.lines.get(cursor.line) else { return self.player.stop() };
        if let Err(Fault(code, data)) = self.execute_instruction(&program, instruction) {
            self.raise(code, data, 1, None);
        }
    }

    fn execute_instruction(&mut self, program: &Program, instruction: &Instruction) -> Result<(), Fault> {
        let soon = self.now + LINE_TIME;
        match instruction {
            Instruction::Pass | Instruction::Label(_) => self.line_done(soon),
            Instruction::End | Instruction::Ret => self.end_of_job(),
            Instruction::Pause => {
                self.player.next_line(soon);
                self.player.stop();
            }
            Instruction::Timer(time) => self.line_done(self.now + (*time).max(LINE_TIME)),
            Instruction::Output(number, on) => {
                self.memory.set_signal(signal(FIRST_OUTPUT, *number), *on);
                self.line_done(soon);
            }
            Instruction::ReadInput((kind, index), number) => {
                let value = self.value(Operand::Input(*number));
                self.memory.store_number(*kind, *index, value);
                self.line_done(soon);
            }
            Instruction::Arithmetic(operation, (kind, index), operand) => {
                let (left, right) = (self.memory.number(*kind, *index), self.value(*operand));
                let value = match operation {
                    Arithmetic::Set => right,
                    Arithmetic::Add => left + right,
                    Arithmetic::Sub => left - right,
                    Arithmetic::Mul => left * right,
                    Arithmetic::Div => left / right,
                };
                refuse_if(!value.is_finite() || !self.memory.store_number(*kind, *index, value), OUT_OF_RANGE)?;
                self.line_done(soon);
            }
            Instruction::Wait(condition, limit) => {
                self.player.state = State::Waiting(*condition, limit.map(|limit| self.now + limit));
            }
            Instruction::Jump(label, condition) => {
                if condition.is_some_and(|condition| !self.holds(&condition)) {
                    self.line_done(soon);
                } else {
                    let line = program.label(label).ok_or(NO_LABEL_OR_JOB)?;
                    self.go_to(line, soon);
                }
            }
            Instruction::Call(name, condition) => {
                if condition.is_some_and(|condition| !self.holds(&condition)) {
                    self.line_done(soon);
                } else {
                    self.call(name, soon)?;
                }
            }
            Instruction::Move(order) => self.order_move(program, *order)?,
        }
        Ok(())
    }

    fn go_to(&mut self, line: usize, at: Now) {
        if let Some(cursor) = &mut self.player.cursor {
            cursor.line = line;
        }
        self.player.state = State::Due(at);
        if self.switches.cycle == CycleMode::Step {
            self.player.stop();
        }
    }

    fn call(&mut self, name: &[u8], at: Now) -> Result<(), Fault> {
        let program = self.files.program(name).ok_or(NO_LABEL_OR_JOB)?;
        refuse_if(self.player.callers.len() >= MAX_CALLS, TOO_MANY_CALLS)?;
        let called = Cursor { name: name.to_vec(), program: Arc::new(program), line: 0 };
        if let Some(mut caller) = self.player.cursor.replace(called) {
            caller.line += 1;
            self.player.callers.push(caller);
        }
        self.go_to(0, at);
        Ok(())
    }

    /// Handles END and RET: returns to the caller. At the end of the master job, the cycle mode decides what follows.
    fn end_of_job(&mut self) {
        let soon = self.now + LINE_TIME;
        if let Some(caller) = self.player.callers.pop() {
            let line = caller.line;
            self.player.cursor = Some(caller);
            return self.go_to(line, soon);
        }
        self.go_to(0, soon);
        if self.switches.cycle != CycleMode::Continuous {
            self.player.stop();
        }
    }

    fn order_move(&mut self, program: &Program, order: Move) -> Result<(), Fault> {
        let robot = self.arm.find(Family::Robot, 1).ok_or(UNDEFINED_POSITION)?;
        let target = match order.to {
            MoveTarget::Taught(number) => program.positions.get(&number).copied().ok_or(UNDEFINED_POSITION)?,
            MoveTarget::Variable(index) => self.position_variable(index).ok_or(UNDEFINED_POSITION)?,
        };
        let near = self.arm.groups[robot].pulses;
        let pulses = match target {
            Target::Pulses(pulses) => pulses,
            Target::Base(mut pose) => {
                pose[0] -= self.arm.base_offset(1);
                inverse(&pose, &near)
            }
        };
        if order.straight {
            self.arm.straight(self.now, &[(robot, pulses)], Speed::Linear(order.speed.min(MAX_LINEAR_MM_S)));
        } else {
            self.arm.joint(self.now, &[(robot, pulses)], (order.speed / 100.0).min(1.0));
        }
        self.player.state = State::Moving;
        Ok(())
    }

    /// Converts a P variable to a target. Jobs in this simulator do not support user frames and tool frames.
    fn position_variable(&self, index: usize) -> Option<Target> {
        let words: Vec<i32> = self
            .memory
            .element(Kind::P, index)?
            .chunks_exact(4)
            .map(|word| i32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        let axes = words.get(5..5 + AXES)?;
        match words[0] {
            0 => {
                let pulses: Pulses = std::array::from_fn(|i| f64::from(axes[i]));
                Some(Target::Pulses(pulses))
            }
            kind @ (16 | 17) => {
                let mut pose: Pose =
                    std::array::from_fn(|i| f64::from(axes[i]) / if i < 3 { 1000.0 } else { 10_000.0 });
                if kind == 17 {
                    // The target is in robot coordinates, which move together with the base.
                    pose[0] += self.arm.base_offset(1);
                }
                Some(Target::Base(pose))
            }
            _ => None,
        }
    }

    fn holds(&self, condition: &Condition) -> bool {
        condition.comparison.holds(self.value(condition.left), self.value(condition.right))
    }

    fn value(&self, operand: Operand) -> f64 {
        let bit = |number| if self.memory.signal(number) { 1.0 } else { 0.0 };
        match operand {
            Operand::Number(value) => value,
            Operand::Variable(kind, index) => self.memory.number(kind, index),
            Operand::Input(number) => bit(signal(FIRST_INPUT, number)),
            Operand::Output(number) => bit(signal(FIRST_OUTPUT, number)),
        }
    }
}

/// Signal number of general-purpose input or output `number`, counted from 1. Of ten signal numbers, only eight exist.
fn signal(first: u32, number: u32) -> u32 {
    let place = number.saturating_sub(1);
    first.saturating_add((place / 8).saturating_mul(10)).saturating_add(place % 8)
}

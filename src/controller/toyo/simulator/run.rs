//! Interpreter of the instructions.

use super::action::{Action, Change, Choice, Target, TaskOrder, Test};
use super::errors::code;
use super::io::{OutputAt, Port};
use super::memory::{TASKS, TagLookup};
use super::task::{Flow, Wait};
use super::trace::What;
use super::world::World;
use crate::refuse_if;
use crate::toyo::field::Mask;

/// Maximum nesting of subroutines. The manual gives no limit.
pub(super) const DEPTH: usize = 16;
/// Maximum value of a counter.
const MAX_COUNTER: i32 = 9999;

impl World {
    /// Executes all steps that are due.
    pub(super) fn run_tasks(&mut self) {
        if !self.is_running() {
            return;
        }
        for index in self.machine.order {
            if self.is_held() || self.tasks[index].due().is_none_or(|at| at > self.now) {
                continue;
            }
            match self.tasks[index].wait {
                Wait::Until(_) | Wait::Pass(_) => self.end_wait(index),
                _ => self.execute(index),
            }
        }
    }

    /// Continues the tasks whose wait has ended.
    pub(super) fn end_waits(&mut self) {
        if self.is_held() {
            return;
        }
        for index in 0..TASKS {
            let task = &self.tasks[index];
            if !task.running || task.stopped {
                continue;
            }
            match task.wait {
                Wait::Test(test) => match self.is_met(test) {
                    Ok(true) => self.end_wait(index),
                    Ok(false) => {}
                    Err(code) => self.fail(code),
                },
                Wait::Host(order) if task.supplied.is_some() => {
                    let flow = self.begin_move(index, order, task.next);
                    self.apply(index, flow);
                }
                Wait::Motion if task.escape && self.ports.is_on(self.settings.escape) => {
                    self.tasks[index].escape = false;
                    self.arm.brake_owner(index, self.now);
                    self.arm.discard_interrupted(index);
                }
                _ => {}
            }
        }
    }

    pub(super) fn end_wait(&mut self, index: usize) {
        let now = self.now;
        let single = index == 0 && self.ports.is_on(self.settings.single);
        let task = &mut self.tasks[index];
        let moved = matches!(task.wait, Wait::Motion | Wait::Pass(_));
        if single && matches!(task.wait, Wait::Pass(_)) {
            // In single operation, every move ends at rest, even a move to a pass point.
            task.wait = Wait::Motion;
            return;
        }
        task.limited = None;
        task.escape = false;
        task.step = task.next;
        task.wait = Wait::Ready(now);
        if moved && single {
            self.stop();
        }
    }

    /// Stops programs once task 1 is at rest.
    fn stop_at_rest(&mut self) {
        if self.arm.is_busy(0, self.now) {
            self.tasks[0].next = self.tasks[0].step;
            self.tasks[0].wait = Wait::Motion;
        } else {
            self.stop();
        }
    }

    fn execute(&mut self, index: usize) {
        if self.tasks[index].routine.is_some() && !self.tasks[index].called {
            return self.follow_routine(index);
        }
        if index == 0 && self.allowance == Some(0) {
            return self.stop_at_rest();
        }
        let step = self.tasks[index].step;
        let Some(action) = self.memory.action(index, step) else { return self.fail(code::STEP) };
        self.record_event(What::Step { task: index + 1, step });
        if index == 0 {
            self.allowance = self.allowance.map(|left| left.saturating_sub(1));
        }
        let flow = self.perform(index, step, action);
        self.apply(index, flow);
    }

    pub(super) fn apply(&mut self, index: usize, flow: Result<Flow, u8>) {
        let at = self.now.saturating_add(self.tick);
        let task = &mut self.tasks[index];
        match flow {
            Ok(Flow::Next) => {
                task.step += 1;
                task.wait = Wait::Ready(at);
            }
            Ok(Flow::To(step)) => {
                task.step = step;
                task.wait = Wait::Ready(at);
            }
            Ok(Flow::Wait(wait, next)) => {
                task.next = next;
                task.wait = wait;
            }
            Ok(Flow::Stop) => {
                task.step += 1;
                task.wait = Wait::Ready(at);
                self.stop();
            }
            Ok(Flow::End) => self.end(index),
            Err(code) => self.fail(code),
        }
    }

    /// Ends the program of a task, or the part of the program that a routine called.
    pub(super) fn end(&mut self, index: usize) {
        let at = self.now.saturating_add(self.tick);
        let task = &mut self.tasks[index];
        if task.called {
            task.called = false;
            task.stack.clear();
            task.wait = Wait::Ready(at);
            return;
        }
        let again = index == 0 && task.routine.is_none() && self.ports.is_on(self.settings.continuous);
        task.reset();
        if again {
            task.start(1, at);
        }
        self.record_event(What::Ended(index + 1));
    }

    fn perform(&mut self, index: usize, step: usize, action: Action) -> Result<Flow, u8> {
        match action {
            Action::Nothing => {}
            Action::End => {
                return Ok(if self.arm.is_busy(index, self.now) { Flow::Wait(Wait::End, step) } else { Flow::End });
            }
            Action::Stop => return Ok(Flow::Stop),
            Action::Return => return self.return_from(index),
            Action::Select => return self.select(index, step),
            Action::Jump { tag, when } => {
                return if self.is_met(when)? { self.find(index, tag).map(Flow::To) } else { Ok(Flow::Next) };
            }
            Action::Call { tag, when } => {
                return if self.is_met(when)? { self.call(index, step, tag) } else { Ok(Flow::Next) };
            }
            Action::Branch { counter, offset } => {
                return self.find(index, usize::from(self.counters[counter]) + offset).map(Flow::To);
            }
            Action::Wait(test) => {
                return Ok(if self.is_met(test)? { Flow::Next } else { Flow::Wait(Wait::Test(test), step + 1) });
            }
            Action::Delay(time) => return Ok(Flow::Wait(Wait::Until(self.now.saturating_add(time)), step + 1)),
            Action::Home => {
                let axes = self.machine.tasks[index].axes.clone();
                self.check_motion_allowed(&axes)?;
                self.begin_homing(index, &axes);
                return Ok(Flow::Wait(Wait::Motion, step + 1));
            }
            Action::Move(order) => return self.begin_move(index, order, step + 1),
            Action::Arc(order) => return self.begin_arc(index, step, order),
            Action::Loop { group, more, done } => {
                let tag = if self.next_of_group(group) { more } else { done };
                return self.find(index, tag).map(Flow::To);
            }
            Action::Task { task, order } => return self.order_task(index, task, order),
            Action::BeginGroup { group } => self.begin_group(group),
            Action::Count { counter, change } => self.count(counter, change)?,
            Action::ClearCounters => self.counters.fill(0),
            Action::StartTimer { timer, tenths } => self.timers[timer] = Some((self.now, tenths)),
            Action::Choose(choice) => self.select_setting(index, choice),
            Action::Output { port, mask, time } => self.output(port, mask, time)?,
            Action::OutputCounter { port, counter } => {
                let bits = u8::try_from(self.counters[counter]).map_err(|_| code::CALCULATION)?;
                self.output(port, Mask::all(bits), None)?;
            }
            Action::InputCounter { port, counter } => {
                self.counters[counter] = self.ports.input(port).ok_or(code::PORT)?.into();
            }
            Action::Internal { port, mask } => {
                let internal = self.ports.internal.get_mut(port.wrapping_sub(1)).ok_or(code::PORT)?;
                *internal = mask.applied(*internal);
            }
            Action::OutputAt { task, port, mask, axis, at_least, place } => {
                let task = task.checked_sub(1).unwrap_or(index);
                refuse_if(!self.machine.tasks[task].axes.contains(&axis), code::TASK)?;
                self.output_at(OutputAt { task, axis, at_least, place, port, mask })?;
            }
            Action::CancelOutputs { task } => {
                let task = task.checked_sub(1).unwrap_or(index);
                self.outputs_at.retain(|output| output.task != task);
                self.arm.touch();
            }
            Action::Offset(target) => self.tasks[index].offset = self.target(index, target)?,
            Action::Servo { axis, on } => self.switch_servo(index, axis, on)?,
            Action::Torque(torque) => {
                refuse_if(!self.machine.tasks[index].axes.contains(&torque.axis), code::COMMAND)?;
                self.tasks[index].torque = Some(torque);
            }
        }
        Ok(Flow::Next)
    }

    /// Evaluates a condition. Returns an error if the port of the condition does not exist.
    pub(super) fn is_met(&self, test: Test) -> Result<bool, u8> {
        let matches = |bits: u8, mask: Mask, any: bool| {
            // With `any`, one matching bit is enough. A condition that uses no bits is true.
            if any && mask.care != 0 { !(bits ^ mask.bits) & mask.care != 0 } else { mask.matches(bits) }
        };
        match test {
            Test::Always => Ok(true),
            Test::Counter { counter, compare, count } => Ok(compare.holds(&self.counters[counter], &count)),
            Test::Timer { timer, compare, tenths } => Ok(compare.holds(&self.timer(timer), &tenths)),
            Test::Input { port, mask, any } => {
                self.ports.input(port).map(|bits| matches(bits, mask, any)).ok_or(code::PORT)
            }
            Test::Internal { port, mask, any } => {
                let bits = self.ports.internal.get(port.wrapping_sub(1)).ok_or(code::PORT)?;
                Ok(matches(*bits, mask, any))
            }
        }
    }

    /// Returns the step of a tag.
    pub(super) fn find(&self, index: usize, tag: usize) -> Result<usize, u8> {
        refuse_if(!(1..=999).contains(&tag), code::TAG_NUMBER)?;
        match self.memory.tag(index, tag) {
            TagLookup::Step(step) => Ok(step),
            TagLookup::Nowhere => Err(code::TAG_UNDEFINED),
            TagLookup::Twice => Err(code::TAG_TWICE),
        }
    }

    fn call(&mut self, index: usize, step: usize, tag: usize) -> Result<Flow, u8> {
        let to = self.find(index, tag)?;
        let stack = &mut self.tasks[index].stack;
        refuse_if(stack.len() >= DEPTH, code::STACK_FULL)?;
        stack.push(step + 1);
        Ok(Flow::To(to))
    }

    fn return_from(&mut self, index: usize) -> Result<Flow, u8> {
        let task = &mut self.tasks[index];
        match task.stack.pop() {
            Some(step) => Ok(Flow::To(step)),
            None if task.called => Ok(Flow::End),
            None => Err(code::STACK_EMPTY),
        }
    }

    /// Jumps to the tag whose number is at the selection inputs. With number 0, continues with the next step.
    fn select(&self, index: usize, step: usize) -> Result<Flow, u8> {
        match self.settings.selection.map_or(0, |bit| self.ports.number(bit)) {
            0 => Ok(Flow::To(step + 1)),
            tag => self.find(index, tag.into()).map(Flow::To),
        }
    }

    fn count(&mut self, counter: usize, change: Change) -> Result<(), u8> {
        let count = &mut self.counters[counter];
        *count = match change {
            Change::Set(count) => count,
            Change::Add(add) => {
                let sum = i32::from(*count) + add;
                u16::try_from(sum).ok().filter(|_| sum <= MAX_COUNTER).ok_or(code::CALCULATION)?
            }
        };
        Ok(())
    }

    fn select_setting(&mut self, index: usize, choice: Choice) {
        let task = &mut self.tasks[index];
        match choice {
            Choice::Speed(row) => task.speed = row,
            Choice::Ramps(row) => task.ramps = [row, row],
            Choice::LastRamp(row) => task.ramps[1] = row,
            Choice::Pass(share) => task.pass = share,
        }
    }

    fn output(&mut self, port: Port, mask: Mask, time: Option<std::time::Duration>) -> Result<(), u8> {
        refuse_if(!self.ports.set_output(port, mask), code::PORT)?;
        if let Some(time) = time {
            let back = Mask { care: mask.care, bits: !mask.bits & mask.care };
            // If the same pulse is already running, its time starts again.
            self.pulses.retain(|(_, other, mask)| (*other, mask.care) != (port, back.care));
            self.pulses.push((self.now.saturating_add(time), port, back));
        }
        Ok(())
    }

    fn switch_servo(&mut self, index: usize, axis: Option<usize>, on: bool) -> Result<(), u8> {
        let own = &self.machine.tasks[index].axes;
        let selected_axes = match axis {
            Some(axis) if own.contains(&axis) => vec![axis],
            None if !own.is_empty() => own.clone(),
            _ => return Err(code::COMMAND),
        };
        refuse_if(on && self.switches.estop, code::UNEXECUTABLE)?;
        if !on {
            self.arm.freeze_owner(index, self.now);
            self.arm.discard_interrupted(index);
        }
        for axis in selected_axes {
            self.switches.servo[axis] = on;
        }
        Ok(())
    }

    fn order_task(&mut self, index: usize, other: usize, order: TaskOrder) -> Result<Flow, u8> {
        match order {
            TaskOrder::Start => {
                refuse_if(self.tasks[other].running || self.memory.size(other) == 0, code::TASK_START)?;
                self.tasks[other].reset();
                self.tasks[other].start(1, self.now.saturating_add(self.tick));
            }
            TaskOrder::Stop => {
                self.tasks[other].stopped = self.tasks[other].running;
                if other != index {
                    self.arm.brake_owner(other, self.now);
                    self.abort_homing(other);
                }
            }
            TaskOrder::GoOn => {
                if std::mem::take(&mut self.tasks[other].stopped) {
                    self.resume_task(other);
                }
            }
            TaskOrder::Cancel => {
                self.arm.brake_owner(other, self.now);
                self.arm.discard_interrupted(other);
                self.abort_homing(other);
                if self.tasks[other].running && other != index {
                    self.record_event(What::Ended(other + 1));
                }
                self.tasks[other].reset();
            }
        }
        // A task that cancels itself has ended, so no step follows.
        Ok(if other == index && order == TaskOrder::Cancel { Flow::End } else { Flow::Next })
    }

    /// Coordinates of a target. An offset is also given as a target.
    pub(super) fn target(&self, index: usize, target: Target) -> Result<super::motion::Coordinates, u8> {
        match target {
            Target::Coordinates(place) => Ok(place),
            Target::Row { point, counter } => self.row(index, point, counter),
            Target::Back => Ok(self.tasks[index].from.unwrap_or(self.arm.goal)),
            Target::Group { group, approach } => self.place_of_group(index, group, approach),
            Target::Host => Err(code::COMMAND),
        }
    }
}

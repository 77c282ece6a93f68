//! Operations of host and operator: starts, stops, power, errors.
//!
//! Here a refusal has a reason. The protocol sends only `@NG`, without the reason.

use super::arm::HOST;
use super::errors::code;
use super::memory::{MAX_STEPS, TASKS};
use super::routine::Routine;
use super::settings::Special;
use super::world::{Kind, Mode, World};
use crate::refuse_if;

/// Reason of a refusal.
pub(super) type Refusal = &'static str;

impl World {
    /// Refuses while a program, a motion or a card transfer runs.
    pub(super) fn idle(&self) -> Result<(), Refusal> {
        refuse_if(self.is_executing(), "a program, motion or jog runs")?;
        if self.card.is_busy() { Err("the memory card is in use") } else { Ok(()) }
    }

    fn check_startable(&self) -> Result<(), Refusal> {
        self.idle()?;
        self.unchanged()?;
        if self.errors.current.is_some() { Err("an error is active: cancel it first") } else { Ok(()) }
    }

    /// Refuses execution if parameter 2 was changed: the controller then needs a power cycle.
    fn unchanged(&self) -> Result<(), Refusal> {
        if self.switches.machine_changed {
            Err("a machine parameter (parameter 2) was changed: switch the power off and on first")
        } else {
            Ok(())
        }
    }

    fn powered_axes(&self) -> Result<(), Refusal> {
        if self.has_servo() { Ok(()) } else { Err("servo power is off") }
    }

    fn of_kind(&self, kind: Kind, what: Refusal) -> Result<(), Refusal> {
        self.check_startable()?;
        refuse_if(self.switches.mode == Mode::Program, "programs do not run in program mode")?;
        if self.kind() == kind { Ok(()) } else { Err(what) }
    }

    /// Starts the sequential program of task 1 at this step. With step 0, continues a stopped program, or begins at the
    /// first step.
    pub(super) fn start_sequential(&mut self, step: usize) -> Result<(), Refusal> {
        self.of_kind(Kind::Sequential, "the controller is not in sequential mode")?;
        refuse_if(step > self.memory.size(0) || self.memory.size(0) == 0, "no such step")?;
        self.memory.index_tags();
        self.jog_ready = false;
        let allowance = (self.switches.mode == Mode::Step).then_some(1);
        if step > 0 {
            self.reset_program();
            self.tasks[0].start(step, self.now);
        } else if self.stopped {
            self.stopped = false;
            self.continue_programs();
        } else {
            let step = self.tasks[0].step;
            // An interrupted move is completed first.
            if self.arm.has_interrupted_moves(0) {
                self.tasks[0].running = true;
                self.resume_task(0);
            } else {
                self.tasks[0].start(step, self.now);
            }
        }
        self.allowance = allowance;
        Ok(())
    }

    /// Starts or continues the palletizing program.
    pub(super) fn start_palletizing(&mut self) -> Result<(), Refusal> {
        self.of_kind(Kind::Palletizing, "the controller is not in palletizing mode")?;
        self.powered_axes()?;
        if self.take_stopped() {
            return Ok(());
        }
        match self.chosen_pallet() {
            Ok(program) => {
                let routine = self.palletizing(program).ok_or("no such palletizing program")?;
                self.start_routine(0, Routine::Palletizing(Box::new(routine)));
            }
            Err(code) => self.fail(code),
        }
        Ok(())
    }

    /// Starts or continues the easy program.
    pub(super) fn start_easy(&mut self) -> Result<(), Refusal> {
        self.of_kind(Kind::Easy, "easy mode is not selected (M10)")?;
        self.powered_axes()?;
        if self.take_stopped() {
            return Ok(());
        }
        match Routine::easy(self.easy, self.memory.content.easy(self.easy)) {
            Some(routine) => self.start_routine(0, routine),
            None => self.fail(code::EASY),
        }
        Ok(())
    }

    /// Moves the axes of the current task to a row of its coordinate table.
    pub(super) fn start_point(&mut self, row: i32) -> Result<(), Refusal> {
        self.of_kind(Kind::Point, "external point mode is not selected (M10)")?;
        self.powered_axes()?;
        self.start_routine(self.current, Routine::Point { row, begun: false });
        Ok(())
    }

    fn take_stopped(&mut self) -> bool {
        let was_stopped = std::mem::take(&mut self.stopped);
        if was_stopped {
            self.continue_programs();
        }
        was_stopped
    }

    fn start_routine(&mut self, task: usize, routine: Routine) {
        self.memory.index_tags();
        self.reset_program();
        self.jog_ready = false;
        self.tasks[task].routine = Some(routine);
        self.tasks[task].start(1, self.now);
    }

    /// Starts the return to origin of all axes, and resets programs.
    pub(super) fn home(&mut self) -> Result<(), Refusal> {
        self.check_startable()?;
        self.powered_axes()?;
        self.reset_program();
        self.jog_ready = false;
        let axes: Vec<usize> = (0..self.axes).collect();
        self.begin_homing(HOST, &axes);
        Ok(())
    }

    /// Searches the origin of synchronized axes.
    pub(super) fn search_origin(&mut self, drive: usize) -> Result<(), Refusal> {
        self.check_startable()?;
        self.powered_axes()?;
        refuse_if(!self.machine.driver.contains(&Some(drive)), "this axis has no driven axis (E26)")?;
        self.reset_program();
        self.jog_ready = false;
        self.synchronize(drive);
        Ok(())
    }

    /// Executes JOG with one word per axis.
    pub(super) fn jog(&mut self, words: [&'static str; 4]) -> Result<(), Refusal> {
        let moving: Vec<_> = words.iter().enumerate().filter(|(_, word)| !matches!(**word, "RS" | "SP")).collect();
        if moving.is_empty() {
            self.end_jog();
            if words.contains(&"RS") {
                self.jog_ready = true;
            }
            return Ok(());
        }
        let [(axis, word)] = moving[..] else { return Err("only one axis at a time can jog") };
        refuse_if(words.contains(&"RS"), "all other axes must be stopped: send SP for them")?;
        // A second JOG with the same word changes nothing.
        if self.jog.is_some_and(|jog| jog.axis == axis && jog.word == *word && !word.ends_with('C')) {
            return Ok(());
        }
        self.check_startable()?;
        refuse_if(!self.jog_ready, "the JOG action of this axis was not reset: send RS first")?;
        refuse_if(axis >= self.axes, "this axis is not fitted")?;
        refuse_if(!self.switches.servo[axis], "servo power is off")?;
        if let Err(code) = self.begin_jog(axis, word) {
            self.fail(code);
        }
        Ok(())
    }

    /// Resets programs to the first step.
    pub(super) fn reset(&mut self) -> Result<(), Refusal> {
        self.idle()?;
        self.reset_program();
        if self.settings.clear_on_reset {
            self.pulses.clear();
            self.ports.clear_outputs();
        }
        Ok(())
    }

    pub(super) fn cancel_error(&mut self) -> Result<(), Refusal> {
        self.unchanged()?;
        refuse_if(self.switches.estop, "the emergency stop is pressed")?;
        self.errors.cancel();
        Ok(())
    }

    /// Switches servo power of all axes.
    pub(super) fn servo(&mut self, on: bool) -> Result<(), Refusal> {
        self.unchanged()?;
        self.idle()?;
        refuse_if(on && (self.switches.estop || self.errors.current.is_some()), "an error is active: cancel it first")?;
        self.switches.servo = std::array::from_fn(|axis| on && axis < self.axes);
        Ok(())
    }

    /// Switches host control, unless the pendant is ON.
    pub(super) fn host(&mut self, on: bool) -> Result<(), Refusal> {
        refuse_if(on && self.switches.pendant, "the teach pendant is on")?;
        if !on {
            self.end_jog();
        }
        self.jog_ready = false;
        self.switches.host = on;
        Ok(())
    }

    /// Switches the teach pendant ON or OFF. When the pendant is ON, it takes control from the host.
    pub(super) fn pendant(&mut self, on: bool) {
        self.switches.pendant = on;
        if on {
            self.end_jog();
            self.jog_ready = false;
            self.switches.host = false;
        }
    }

    pub(super) fn emergency_stop(&mut self, pressed: bool) {
        self.switches.estop = pressed;
        if pressed {
            self.fail(code::EMERGENCY_STOP);
        }
    }

    /// Selects sequential or palletizing mode, unless parameter M10 selects another mode.
    pub(super) fn select_program_kind(&mut self, palletizing: bool) -> Result<(), Refusal> {
        self.idle()?;
        refuse_if(self.settings.special != Special::None, "M10 selects easy or external point mode")?;
        if palletizing != self.switches.palletizing {
            self.reset_program();
        }
        self.switches.palletizing = palletizing;
        Ok(())
    }

    pub(super) fn select_run_mode(&mut self, mode: Mode) -> Result<(), Refusal> {
        self.idle()?;
        self.switches.mode = mode;
        Ok(())
    }

    /// Stores coordinates from the host for a move of a task. A task can store only one set of coordinates.
    pub(super) fn store_coordinates(&mut self, task: usize, place: [f64; 4], speed: i32) -> Result<(), Refusal> {
        let slot = &mut self.tasks[task].supplied;
        refuse_if(slot.is_some(), "earlier coordinates are still waiting")?;
        *slot = Some((place, speed));
        Ok(())
    }

    /// Sets the current step to a tag of the current task.
    pub(super) fn search_tag(&mut self, tag: usize) -> Result<(), Refusal> {
        self.idle()?;
        let task = self.current;
        let step = self.memory.search(task, tag).ok_or("no such tag")?;
        self.arm.discard_interrupted(task);
        let now = self.now;
        let task_state = &mut self.tasks[task];
        task_state.step = step;
        task_state.stack.clear();
        task_state.wait = super::task::Wait::Ready(now);
        Ok(())
    }

    /// Applies changes of the memory: updates settings, and ends programs that no longer fit.
    pub(super) fn apply_memory_changes(&mut self) {
        self.settings = super::settings::Settings::from_content(&self.memory.content);
        for index in 0..TASKS {
            debug_assert!(self.memory.size(index) <= MAX_STEPS);
            if self.tasks[index].step > self.memory.size(index).max(1) {
                self.arm.discard_interrupted(index);
                self.tasks[index].reset();
            }
        }
    }
}

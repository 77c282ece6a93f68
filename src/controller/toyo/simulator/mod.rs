//! Simulated Toyo controller: answers the host, moves, and runs programs, without a line and without a clock.
//!
//! The caller passes bytes and the time, and sends the answers. The simulator shares the tables with the client, but is
//! stricter: every character of a block must be exact, and the state must allow the command. `why` on the console shows
//! the reason for the last refusal.
//!
//! Modules:
//!
//! | module | content |
//! |---|---|
//! | `start`, `defaults` | start state from TOML; content of a new controller |
//! | `world` | switches, power, errors, time |
//! | `memory`, `settings`, `card` | memory, meaning of parameters, memory card |
//! | `io`, `watch` | ports; effects of axis positions |
//! | `motion`, `arm`, `moves`, `homing` | ramps and paths, axes, program moves, origin and JOG |
//! | `action`, `task`, `run` | steps, tasks, interpreter |
//! | `matrix`, `routine` | matrix positions; palletizing, easy programs, single points |
//! | `commands`, `edit`, `monitor`, `operate`, `reply` | host commands |
//! | `console`, `trace` | operator actions, and events |
//! | `replay` | state of a recorded controller |
//!
//! The manual specifies the protocol, but says little about the behavior of a controller. The simulator makes these
//! assumptions:
//!
//! - Coordinates X, Y, Z, R are axes 1 to 4, regardless of their letters (E01) and tasks.
//! - The speed of a move is the speed in T2, reduced by the override and limited by the maximum axis speed (E06). The
//!   ramp times are in T3. A short move has the same accelerations and does not reach this speed. With course S, the
//!   speed is the speed of the axis with the longest distance. With course T, it is the path speed in the plane or
//!   space of the task. All axes start and stop together. A move is in position when it ends, without lag.
//! - At a pass point, the next move begins during the deceleration of the last move. The value of the PASS instruction
//!   is the share of this deceleration. The pass area (P05) is not used.
//! - SPST starts task 1. TSTR starts the other tasks at their first step. A task ends at its END. Programs are in
//!   execution while any task runs. Each task has its own tags. Calls nest up to 16 levels. Every instruction takes
//!   `instruction_us`.
//! - The STOP command, the pause input and STOP instructions decelerate moves along their path. SPST 0000 then
//!   continues the programs. An error ends all tasks except task 1. SPST 0000 then continues task 1, and completes its
//!   interrupted move first. PPST and SESY also continue a stopped program.
//! - The simulator accepts a start without a known origin or without servo power. The first move then raises error 61
//!   (origin) or 62 (servo power). A target beyond a soft limit raises error C0 to C7 before any motion. If only the
//!   offset or a JOG leads beyond the limit, the error is 28 or 29 for axis 1, 38 or 39 for axis 2, and so on.
//! - MRSS sends the coordinates for one RSMV step of a task, before the step or while the step waits. V=00 means the
//!   speed row of the step.
//! - TLMV limits the torque of the next move of its axis. At an obstacle the torque is at its limit, and after the
//!   judgement time the axis is locked. If TE (end at the torque limit) or LE (end when locked) is on, the move ends
//!   when the axis is locked. The move ends on arrival if AE (end on arrival) is on, or if neither TE nor LE is on.
//! - An axis that pushes farther than E03 has an overflow. An axis that pushes for a second without torque limit has an
//!   overload.
//! - MVB returns to the start of the last move. An arc has two steps, and lies in the first two or three axes of the
//!   task.
//! - OUTP inverts its bits again after its time. Timers count up from the value of TIMP. A counter below 0 or above
//!   9999 raises error A7. PSEL reads the tag number from the bits of the port in M05, starting at the bit in M05.
//! - MVM counters count from 1. LOOP jumps to its THEN tag while positions are left.
//! - Palletizing moves above the position, moves down, runs the hand program, and moves up: first at the source, then
//!   at the destination. An easy program calls its START tag LOOP times, at least once, and then its END tag.
//! - After a return to origin, the coordinate of each axis is its origin offset (P06). HOME resets programs.
//! - JOG uses the first row of T3, without override.
//! - These parameters are stored without effect: M20, M22, M23, P03 to P05, P17, P18, E02, E04, and the parameters of
//!   cables and fieldbuses.
//! - Any write of parameter 2 counts as a change. A write of E22 (steps of each task) changes the memory at once.
//! - The bits of the input SY01 are origin, start, stop and reset. The bits of the output SY01 are error, positioned,
//!   origin and ready.
//! - Power off clears outputs, counters and timers. With incremental encoders, it also clears the origin.

mod action;
mod arm;
mod card;
mod commands;
mod console;
mod defaults;
mod edit;
mod errors;
mod homing;
mod io;
mod matrix;
mod memory;
mod monitor;
mod motion;
mod moves;
mod operate;
mod position_effects;
mod replay;
mod reply;
mod routine;
mod run;
mod settings;
mod start;
mod task;
mod trace;
mod world;

#[cfg(test)]
mod tests;

pub use memory::{Cell, Wear};
pub use start::{EXAMPLE, Start};
pub use trace::{Event, What};

use self::console::ConsoleLine;
use self::io::Port;
use self::world::World;
use super::layout::Record;
use super::request::MAX_BLOCK_LEN;
use crate::Now;
use crate::simulator::answers::{Busy, DelayedAnswers};
use crate::simulator::recording::Replay;
use crate::simulator::run_options::Speed;

/// Maximum number of answers that wait to be sent.
const MAX_WAITING: usize = 64;

/// A simulated controller.
#[derive(Debug, Clone)]
pub struct Simulator {
    world: World,
    busy: Busy,
    incoming: IncomingBlock,
    answers: DelayedAnswers<Vec<u8>>,
    replay: Replay,
    speed: Speed,
}

/// A partly received block.
#[derive(Debug, Clone, Default)]
struct IncomingBlock {
    /// Bytes of the block, from its `@` on. Empty before the `@` arrives.
    bytes: Vec<u8>,
    /// Whether a part of the block was damaged.
    damaged: bool,
}

/// Overview of the controller state.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is an independent state")]
pub struct State {
    /// Axis coordinates in mm.
    pub position: [f64; 4],
    /// Whether a command or program runs.
    pub executing: bool,
    /// Whether programs are stopped and can continue.
    pub paused: bool,
    /// Whether the origin of all axes is known.
    pub origin: bool,
    /// Current error (TO 4-1).
    pub error: Option<u8>,
    /// Whether the host is ON.
    pub host: bool,
    /// Whether servo power is on.
    pub servo: bool,
    /// State of each task: whether the task runs, and its step.
    pub tasks: [(bool, usize); 4],
}

impl Simulator {
    /// A controller in its start state.
    pub fn new(mut start: Start) -> Self {
        start.world.arm.motions = start.options.motions;
        Self {
            speed: start.options.speed,
            world: start.world,
            busy: Busy::new(start.busy, start.seed),
            incoming: IncomingBlock::default(),
            answers: DelayedAnswers::new(start.answer_delay, MAX_WAITING),
            replay: Replay::new(start.recording),
        }
    }

    /// Processes bytes from the host, in pieces of any size. CR ends a block; an LF after the CR is ignored.
    pub fn receive(&mut self, now: Now, bytes: &[u8]) {
        self.advance(now);
        for &byte in bytes {
            match byte {
                b'@' => self.incoming = IncomingBlock { bytes: vec![byte], damaged: false },
                b'\r' => self.take_block(),
                b'\n' if self.incoming.bytes.is_empty() => {}
                // Characters before a block are noise. Of a block that is too long, only the first characters are kept:
                // enough for a refusal.
                _ if self.incoming.bytes.is_empty() || self.incoming.bytes.len() > MAX_BLOCK_LEN => {}
                _ => self.incoming.bytes.push(byte),
            }
        }
        // The received blocks may have started actions that are due at once.
        self.advance(now);
    }

    /// Reports a parity or framing error. The current block then gets no answer.
    pub fn damaged(&mut self, now: Now) {
        self.advance(now);
        self.incoming.damaged = true;
    }

    /// Takes the next answer that is due at `now`, with its line end.
    pub fn transmit(&mut self, now: Now) -> Option<Vec<u8>> {
        self.advance(now);
        self.answers.take(self.speed.simulated(now))
    }

    /// Time of the next answer or internal event.
    pub fn wake(&self) -> Option<Now> {
        let due = [self.answers.due(), self.world.next(), self.replay.due()].into_iter().flatten().min();
        due.map(|due| self.speed.real(due))
    }

    /// Sets the share of requests that the simulator refuses with `@NG`, 0.0 to 1.0.
    pub fn set_busy(&mut self, share: f64) {
        self.busy.set_share(share);
    }

    /// Executes a console line, for example `input 0/01/3 on`, `start` or `state`. Returns its output, or an error.
    pub fn console(&mut self, now: Now, line: &str) -> Result<String, String> {
        self.advance(now);
        let line = ConsoleLine::parse(line)?;
        if line == ConsoleLine::PowerCycle {
            self.incoming = IncomingBlock::default();
            self.answers.clear();
        }
        let answer = line.execute(&mut self.world);
        self.advance(now);
        answer
    }

    /// Advances the time to `now`, which never runs backwards.
    pub fn advance(&mut self, now: Now) {
        let now = self.speed.simulated(now).max(self.world.now);
        self.world.advance(now);
        while let Some(changed) = self.replay.take(now) {
            replay::follow(&mut self.world, &changed);
        }
    }

    /// Switches the recording of events for [`Simulator::take_trace`] on or off.
    pub fn record_trace(&mut self, on: bool) {
        self.world.trace.watch(on);
    }

    /// Takes the events since the last call. The trace keeps only the last 65,536 events, so call this function at
    /// every [`Simulator::wake`].
    pub fn take_trace(&mut self) -> Vec<Event> {
        self.world.trace.take()
    }

    /// Current state.
    pub fn state(&self) -> State {
        let world = &self.world;
        State {
            position: world.arm.position(world.now),
            executing: world.is_executing(),
            paused: world.is_paused(),
            origin: world.knows_origin(),
            error: world.errors.current,
            host: world.switches.host,
            servo: world.has_servo(),
            tasks: std::array::from_fn(|index| (world.tasks[index].running, world.tasks[index].step)),
        }
    }

    /// Bits of an output port, if it exists.
    pub fn output(&self, station: usize, port: usize) -> Option<u8> {
        self.world.ports.output(Port { station, port })
    }

    /// Value of counter 1 to 99.
    pub fn counter(&self, number: usize) -> Option<u16> {
        self.world.counters.get(number).copied()
    }

    /// Value of timer 1 to 9, in 0.1 s.
    pub fn timer(&self, number: usize) -> u32 {
        self.world.timer(number)
    }

    /// A step of the program of a task. Tasks are numbered 1 to 4, and steps count from 1.
    pub fn step(&self, task: usize, step: usize) -> Option<&Record> {
        let task = task.checked_sub(1).filter(|task| *task < memory::TASKS)?;
        self.world.memory.step(task, step)
    }

    /// Write counts of the memory cells.
    pub const fn wear(&self) -> &Wear {
        &self.world.memory.wear
    }

    fn take_block(&mut self) {
        let IncomingBlock { bytes, damaged } = std::mem::take(&mut self.incoming);
        // Noise and damaged blocks get no answer (TO 1-3). A recorded controller may have been silent.
        if damaged || self.replay.is_silent || bytes.is_empty() || !bytes.iter().all(|byte| matches!(byte, b' '..=b'~'))
        {
            return;
        }
        let block = String::from_utf8_lossy(&bytes);
        let answer = if self.busy.refuses() {
            "@NG".to_owned()
        } else if let Some(recorded) = self.replay.answer(block.trim_end()) {
            recorded.to_owned()
        } else {
            commands::answer(&mut self.world, &block)
        };
        self.answers.push(self.world.now, format!("{answer}\r\n").into_bytes());
    }
}

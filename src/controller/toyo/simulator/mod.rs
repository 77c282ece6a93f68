//! A simulated Toyo controller: it answers the host, moves, and runs programs, without a line and without a clock.
//!
//! Whoever has a line hands it bytes and the time, and sends what it answers. It shares the tables with the client, but is
//! stricter: a block must be exact to the character, and nothing is done that the state does not allow. `why` on the
//! console tells what was wrong with the last block that was refused.
//!
//! | module | holds |
//! |---|---|
//! | `start`, `defaults` | the start state, from TOML; what a fresh controller has in it |
//! | `world` | switches, power, errors, the passing of time |
//! | `memory`, `settings`, `card` | what is stored, what parameters mean, the memory card |
//! | `io`, `watch` | ports; what follows from where the axes are |
//! | `motion`, `arm`, `moves`, `homing` | ramps and paths, axes, moves of programs, origin and JOG |
//! | `action`, `task`, `run` | steps, tasks, the interpreter |
//! | `matrix`, `routine` | places in rows; palletizing, easy programs, single points |
//! | `commands`, `edit`, `monitor`, `operate`, `reply` | the host's commands |
//! | `console`, `trace` | what somebody at the machine does, and sees |
//!
//! The manual tells what is sent, hardly what is done. Where it is silent, this was chosen:
//!
//! - Coordinates X, Y, Z, R are axes 1 to 4, whatever their letters (E01) and whichever task has them.
//! - A move takes the ramp times of T3 to the speed of T2, which override and E06 lower; a short move has the same
//!   accelerations. With S the axis with the longest way has the speed, with T the line in the plane or in space of the
//!   task; either way all axes start and stop together. There is no lag: a move is in position when it ends.
//! - At a pass point the next move begins while the last one slows down: PASS tells during how much of that ramp. P05 is
//!   not used.
//! - SPST starts task 1; TSTR starts the others at their first step. A task ends at its END; programs are executed while
//!   any task runs. Tags belong to their task. Calls go 16 deep. Every instruction takes `instruction_us`.
//! - STOP, the pause input and STOP instructions bring moves to rest along their path; SPST 0000 lets them go on. After an
//!   error the other tasks are over, and SPST 0000 goes on with task 1, first to where it was going. PPST and SESY go on
//!   with what was stopped.
//! - A start without origin is taken; its first move is error 61, without servo power 62. A target beyond a soft limit is
//!   C0 to C7 before anything moves; a place that only the offset takes there, and a JOG that gets there, is 28 and so on.
//! - MRSS supplies one move (RSMV) of a task, before or while it waits; V=00 is the row of the step.
//! - TLMV limits the next move of its axis. At an obstacle the torque is at its limit; after the judgement time the axis is
//!   locked. The move ends then, with TE or LE; on arrival with AE, or if neither TE nor LE is on.
//! - An axis that pushes farther than E03 has overflow; one that pushes for a second without torque limit has overload.
//! - MVB goes back to where the last move began. An arc is two steps; it turns in the first two axes of the task, or three.
//! - OUTP inverts its bits again after its time. Timers count up from the value of TIMP. A counter below 0 or above 9999
//!   is error A7. PSEL takes the bits of the port from that of M05 on as the number of a tag.
//! - MVM counters count from 1; LOOP jumps to THEN while there are places left.
//! - Palletizing goes above the place, down, runs the hand program, and up; source, then destination. An easy program
//!   calls its START tag LOOP times, at least once, then its END tag.
//! - After a return to origin the coordinate is that of P06. HOME puts programs back to their beginning.
//! - JOG takes the first row of T3, and no override. M20, M22, M23, P03 to P05, P17, P18, E02, E04 and what is about cables
//!   and fieldbuses is stored, and changes nothing.
//! - Writing any of parameter 2 counts as a change; E22 changes the memory at once.
//! - SY01 of the inputs: origin, start, stop, reset; of the outputs: error, positioned, origin, ready.
//! - Power off clears outputs, counters, timers, and with incremental encoders the origin.

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
mod reply;
mod routine;
mod run;
mod settings;
mod start;
mod task;
mod trace;
mod watch;
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
use super::request::MOST;
use crate::Now;
use crate::simulator::answers::{Answers, Busy};

/// Answers that wait to be fetched.
const MAX_WAITING: usize = 64;

/// A controller.
#[derive(Debug, Clone)]
pub struct Simulator {
    world: World,
    busy: Busy,
    incoming: IncomingBlock,
    answers: Answers<Vec<u8>>,
}

/// A block that is coming in.
#[derive(Debug, Clone, Default)]
struct IncomingBlock {
    /// From the `@` on; empty before it.
    bytes: Vec<u8>,
    /// Whether some of it was damaged.
    damaged: bool,
}

/// How the controller is, at a glance.
#[derive(Debug, Clone, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub struct State {
    /// Coordinates of the four axes, in mm.
    pub position: [f64; 4],
    /// Whether something is executed.
    pub executing: bool,
    /// Whether programs stand, and can go on.
    pub paused: bool,
    /// Whether all axes know their origin.
    pub origin: bool,
    /// The error there is (TO 4-1).
    pub error: Option<u8>,
    /// Whether the host is on.
    pub host: bool,
    /// Whether servo power is on.
    pub servo: bool,
    /// Of each task: whether it runs, and its step.
    pub tasks: [(bool, usize); 4],
}

impl Simulator {
    /// A controller in its start state.
    pub fn new(start: Start) -> Self {
        Self {
            world: start.world,
            busy: Busy::new(start.busy, start.seed),
            incoming: IncomingBlock::default(),
            answers: Answers::new(start.answer_delay, MAX_WAITING),
        }
    }

    /// Takes bytes from the host, in any pieces. CR ends a block; a LF after it does not matter.
    pub fn receive(&mut self, now: Now, bytes: &[u8]) {
        self.advance(now);
        for &byte in bytes {
            match byte {
                b'@' => self.incoming = IncomingBlock { bytes: vec![byte], damaged: false },
                b'\r' => self.take_block(),
                b'\n' if self.incoming.bytes.is_empty() => {}
                // What comes before a block is noise; of a block that is too long, enough is kept to refuse it.
                _ if self.incoming.bytes.is_empty() || self.incoming.bytes.len() > MOST => {}
                _ => self.incoming.bytes.push(byte),
            }
        }
        // What the blocks began may have something due at once.
        self.advance(now);
    }

    /// Tells of a parity or framing error: the block under way is not answered.
    pub fn damaged(&mut self, now: Now) {
        self.advance(now);
        self.incoming.damaged = true;
    }

    /// The next answer that is due at `now`, if any, with its line end.
    pub fn transmit(&mut self, now: Now) -> Option<Vec<u8>> {
        self.advance(now);
        self.answers.take(now)
    }

    /// When [`Simulator::transmit`] will have something, or something changes by itself.
    pub fn wake(&self) -> Option<Now> {
        [self.answers.due(), self.world.next()].into_iter().flatten().min()
    }

    /// Carries out one line of the console: `input 0/01/3 on`, `start`, `state`. What to print, or what is wrong.
    pub fn console(&mut self, now: Now, line: &str) -> Result<String, String> {
        self.advance(now);
        let line = ConsoleLine::parse(line)?;
        if line == ConsoleLine::PowerCycle {
            self.incoming = IncomingBlock::default();
            self.answers.clear();
        }
        let answer = line.carry_out(&mut self.world);
        self.advance(now);
        answer
    }

    /// Lets time pass until `now`, which never runs back.
    pub fn advance(&mut self, now: Now) {
        let now = now.max(self.world.now);
        self.world.advance(now);
    }

    /// Whether to keep what happens for [`Simulator::take_trace`].
    pub fn record_trace(&mut self, on: bool) {
        self.world.trace.watch(on);
    }

    /// What happened since the last time. Whoever watches takes it at every [`Simulator::wake`]; of what nobody takes, only
    /// the last 65,536 events are kept.
    pub fn take_trace(&mut self) -> Vec<Event> {
        self.world.trace.take()
    }

    /// How the controller is.
    pub fn state(&self) -> State {
        let world = &self.world;
        State {
            position: world.arm.position(world.now),
            executing: world.is_executing(),
            paused: world.is_paused(),
            origin: world.knows_origin(),
            error: world.errors.current(),
            host: world.switches.host,
            servo: world.has_servo(),
            tasks: std::array::from_fn(|index| (world.tasks[index].running, world.tasks[index].step)),
        }
    }

    /// The bits of an output port, if there is one.
    pub fn output(&self, station: usize, port: usize) -> Option<u8> {
        self.world.ports.output(Port { station, port })
    }

    /// A counter, 1 to 99.
    pub fn counter(&self, number: usize) -> Option<u16> {
        self.world.counters.get(number).copied()
    }

    /// A timer, 1 to 9, in 0.1 s.
    pub fn timer(&self, number: usize) -> u32 {
        self.world.timer(number)
    }

    /// A step of a task's program; tasks are 1 to 4, steps count from 1.
    pub fn step(&self, task: usize, step: usize) -> Option<&Record> {
        let task = task.checked_sub(1).filter(|task| *task < memory::TASKS)?;
        self.world.memory.step(task, step)
    }

    /// How often memory cells were written.
    pub const fn wear(&self) -> &Wear {
        &self.world.memory.wear
    }

    fn take_block(&mut self) {
        let IncomingBlock { bytes, damaged } = std::mem::take(&mut self.incoming);
        // Noise, and what a faulty line has made of a block, has no answer (TO 1-3).
        if damaged || bytes.is_empty() || !bytes.iter().all(|byte| matches!(byte, b' '..=b'~')) {
            return;
        }
        let block = String::from_utf8_lossy(&bytes);
        let answer = if self.busy.refuses() { "@NG".to_owned() } else { commands::answer(&mut self.world, &block) };
        self.answers.push(self.world.now, format!("{answer}\r\n").into_bytes());
    }
}

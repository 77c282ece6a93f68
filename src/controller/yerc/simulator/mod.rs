//! A simulated FS100, DX100, DX200 or YRC1000: a controller with a life, without sockets and without a clock.
//!
//! A server hands it datagrams and the time, and sends what it answers. It shares the table of commands and the payload
//! types with the client, but checks everything by itself and more strictly than a real controller is known to.
//!
//! | module | holds |
//! |---|---|
//! | `start` | the start state, from TOML |
//! | `defaults` | what a fresh controller has in it |
//! | `world` | switches, power, alarms, what may be done when, the passing of time |
//! | `memory`, `alarms`, `storage` | variables and I/O, alarm log, files |
//! | `variables` | the file of all variables |
//! | `motion`, `job`, `playback` | groups that move, job files, jobs that run |
//! | `robot`, `reads`, `operate`, `moves` | the robot server |
//! | `transfer` | the file server |
//! | `console` | what somebody at the machine does |

mod alarms;
mod console;
mod defaults;
mod job;
mod memory;
mod motion;
mod moves;
mod operate;
mod playback;
mod reads;
mod robot;
mod start;
mod storage;
mod transfer;
mod variables;
mod world;

#[cfg(test)]
mod tests;

pub use start::{EXAMPLE, Start};

use self::transfer::FileServer;
use self::world::{Refusal, World, code};
use super::wire::{ANSWER_BIT, AnswerFrame, Division, HEADER_LEN, LAST_BLOCK, RequestFrame, Status, WireError};
use crate::Now;
use crate::simulator::answers::{Answers, Busy};

/// Answers that wait to be fetched.
const MAX_WAITING: usize = 4096;
/// Places of the raw request that even a malformed one is answered by.
const ID_AT: usize = 11;
const SERVICE_AT: usize = 29;

/// A datagram of the controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outgoing {
    /// From which of the two ports.
    pub division: Division,
    /// To whom, by the token that came with the request.
    pub peer: u64,
    /// What.
    pub bytes: Vec<u8>,
}

/// The files in which it keeps names for signals, variables and registers at the start.
pub fn name_files() -> Vec<(&'static str, Vec<u8>)> {
    defaults::name_files()
}

/// A controller.
#[derive(Debug, Clone)]
pub struct Simulator {
    world: World,
    files: FileServer,
    busy: Busy,
    answers: Answers<Outgoing>,
}

impl Simulator {
    /// A controller in its start state.
    pub fn new(start: Start) -> Self {
        Self {
            files: FileServer::new(start.backup_time, start.backup_size, start.idle_limit),
            busy: Busy::new(start.busy, start.seed),
            answers: Answers::new(start.answer_delay, MAX_WAITING),
            world: start.world,
        }
    }

    /// Takes a datagram that arrived at `now` on the robot or the file port, from the client that the caller knows as
    /// `peer`.
    pub fn receive(&mut self, now: Now, division: Division, peer: u64, bytes: &[u8]) {
        self.advance(now);
        let now = self.world.now;
        let request = RequestFrame::parse(bytes)
            .map_err(|error| malformed(&error))
            .and_then(|request| if request.division == division { Ok(request) } else { Err(Some(code::DIVISION)) });
        let reply = match request {
            Ok(request) => match division {
                Division::Robot => Some((peer, self.answer_robot(&request))),
                Division::File => self.files.receive(&mut self.world, now, peer, &request),
            },
            Err(Some(code)) if bytes.len() >= HEADER_LEN => {
                let (id, service) = (bytes[ID_AT], bytes[SERVICE_AT]);
                Some((peer, answer_frame(division, service, id, LAST_BLOCK, Status::refused(code), &[])))
            }
            Err(_) => None,
        };
        self.post(division, reply);
        // What the request began may have something due at once.
        self.advance(now);
    }

    /// The next datagram that is due at `now`, if any.
    pub fn transmit(&mut self, now: Now) -> Option<Outgoing> {
        self.advance(now);
        self.answers.take(now)
    }

    /// When [`Simulator::transmit`] will have something, or the world changes by itself.
    pub fn wake(&self) -> Option<Now> {
        [self.answers.due(), self.world.wake(), self.files.wake()].into_iter().flatten().min()
    }

    /// Carries out one line of the console: `alarm 4315 3 1`, `remote off`, `state`. What to print, or what is wrong.
    pub fn console(&mut self, now: Now, line: &str) -> Result<String, String> {
        self.advance(now);
        let answer = console::execute(&mut self.world, line);
        self.advance(now);
        answer
    }

    /// Lets world and transfers reach `now`, which never runs back.
    fn advance(&mut self, now: Now) {
        let now = now.max(self.world.now);
        while let Some(at) = self.files.wake().filter(|&at| at <= now) {
            self.world.advance(at.max(self.world.now));
            let reply = self.files.advance(&mut self.world, at);
            self.post(Division::File, reply);
        }
        self.world.advance(now);
        let reply = self.files.advance(&mut self.world, now);
        self.post(Division::File, reply);
    }

    fn post(&mut self, division: Division, reply: transfer::Reply) {
        let Some((peer, bytes)) = reply else { return };
        self.answers.push(self.world.now, Outgoing { division, peer, bytes });
    }

    fn answer_robot(&mut self, request: &RequestFrame<'_>) -> Vec<u8> {
        let answer = if request.ack {
            Err(Refusal::Added(code::ACK))
        } else if request.block != 0 {
            Err(Refusal::Added(code::BLOCK))
        } else if self.busy.refuses() {
            Err(Refusal::Added(code::BUSY))
        } else {
            robot::answer(&mut self.world, request)
        };
        let (status, data) = match answer {
            Ok(data) => (Status::OK, data),
            Err(refused) => (refused.status(self.world.model), Vec::new()),
        };
        answer_frame(Division::Robot, request.service, request.id, LAST_BLOCK, status, &data)
    }
}

/// The code for a datagram that is no frame; none for one too short to be answered.
fn malformed(error: &WireError) -> Option<u16> {
    match error {
        WireError::Truncated { .. } => None,
        WireError::Oversized { .. } => Some(code::FRAME_TOO_LONG),
        WireError::Identifier { .. } => Some(code::IDENTIFIER),
        WireError::HeaderSize { .. } => Some(code::HEADER_SIZE),
        WireError::DataSize { .. } => Some(code::SIZE_DIFFERS),
        WireError::Division { .. } => Some(code::DIVISION),
        WireError::Ack { .. } => Some(code::ACK),
    }
}

/// A frame as a controller sends it.
fn answer_frame(division: Division, service: u8, id: u8, block: u32, status: Status, data: &[u8]) -> Vec<u8> {
    AnswerFrame { division, ack: true, id, block, service: service | ANSWER_BIT, status, data }.emit()
}

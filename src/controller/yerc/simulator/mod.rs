//! Simulated FS100, DX100, DX200 or YRC1000, without sockets and without a clock.
//!
//! A server passes datagrams and the time, and sends the answers. The simulator shares the command table and the
//! payload types with the client. It validates everything independently, and more strictly than real controllers are
//! known to do.
//!
//! | module | content |
//! |---|---|
//! | `start` | start state from TOML |
//! | `defaults` | content of a new controller |
//! | `world` | switches, power, alarms, permissions, time |
//! | `memory`, `alarms`, `storage` | variables and I/O, alarm log, files |
//! | `variables` | the file of all variables |
//! | `motion`, `job`, `playback` | moving groups, job files, running jobs |
//! | `robot`, `reads`, `operate`, `moves` | robot server |
//! | `transfer` | file server |
//! | `console` | operator actions |
//! | `replay` | state of a recorded controller |

mod alarms;
mod console;
mod control_commands;
mod defaults;
mod job;
mod memory;
mod motion;
mod moves;
mod name_lists;
mod playback;
mod read_commands;
mod replay;
mod robot;
mod start;
mod storage;
mod transfer;
mod variable_file;
mod world;

#[cfg(test)]
mod tests;

pub use start::{EXAMPLE, Start};

use self::transfer::FileServer;
use self::world::{Refusal, World, code};
use super::recording::{parse_answer, request_text};
use super::request::Request;
use super::wire::{ANSWER_BIT, AnswerFrame, Division, HEADER_LEN, LAST_BLOCK, RequestFrame, Status, WireError};
use crate::Now;
use crate::simulator::answers::{Busy, DelayedAnswers};
use crate::simulator::recording::Replay;
use crate::simulator::run_options::Speed;

/// Maximum number of pending answers.
const MAX_WAITING: usize = 4096;
/// Offset of the request id in a malformed request. The offset of the service follows. The answer to a malformed
/// request repeats both bytes.
const ID_AT: usize = 11;
const SERVICE_AT: usize = 29;

/// A datagram of the controller.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outgoing {
    /// Server whose port sends the datagram.
    pub division: Division,
    /// Receiver: the token of the client that sent the request.
    pub peer: u64,
    /// Content.
    pub bytes: Vec<u8>,
}

/// Default files with names of signals, variables and registers.
pub fn name_files() -> Vec<(&'static str, Vec<u8>)> {
    defaults::name_files()
}

/// A simulated controller.
#[derive(Debug, Clone)]
pub struct Simulator {
    world: World,
    files: FileServer,
    busy: Busy,
    answers: DelayedAnswers<Outgoing>,
    replay: Replay,
    speed: Speed,
}

impl Simulator {
    /// A controller in its start state.
    pub fn new(mut start: Start) -> Self {
        start.world.arm.motions = start.options.motions;
        Self {
            speed: start.options.speed,
            files: FileServer::new(start.backup_time, start.backup_size, start.idle_limit),
            busy: Busy::new(start.busy, start.seed),
            answers: DelayedAnswers::new(start.answer_delay, MAX_WAITING),
            replay: Replay::new(start.recording),
            world: start.world,
        }
    }

    /// Handles a datagram that arrived at `now` on the robot or file port. `peer` is a token by which the caller
    /// identifies the client.
    pub fn receive(&mut self, now: Now, division: Division, peer: u64, bytes: &[u8]) {
        let now = self.speed.simulated(now);
        self.advance(now);
        if self.replay.is_silent {
            return;
        }
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
        // The request may have started actions that are due at once.
        self.advance(now);
    }

    /// Takes the next datagram that is due at `now`.
    pub fn transmit(&mut self, now: Now) -> Option<Outgoing> {
        let now = self.speed.simulated(now);
        self.advance(now);
        self.answers.take(now)
    }

    /// Time of the next datagram or internal event.
    pub fn wake(&self) -> Option<Now> {
        let due = [self.answers.due(), self.world.wake(), self.files.wake(), self.replay.due()];
        let due = due.into_iter().flatten().min();
        due.map(|due| self.speed.real(due))
    }

    /// Sets the share of requests that the simulator refuses as busy (added status D8FA), 0.0 to 1.0.
    pub fn set_busy(&mut self, share: f64) {
        self.busy.set_share(share);
    }

    /// Executes a console line, for example `alarm 4315 3 1`, `remote off` or `state`. Returns its output, or an error.
    pub fn console(&mut self, now: Now, line: &str) -> Result<String, String> {
        let now = self.speed.simulated(now);
        self.advance(now);
        let answer = console::execute(&mut self.world, line);
        self.advance(now);
        answer
    }

    /// Advances world and transfers to `now`, which never runs backwards.
    fn advance(&mut self, now: Now) {
        let now = now.max(self.world.now);
        while let Some(changed) = self.replay.take(now) {
            replay::follow(&mut self.world, &mut self.replay, &changed);
        }
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
        } else if let Some((status, data)) = self.recorded(request) {
            return answer_frame(Division::Robot, request.service, request.id, LAST_BLOCK, status, &data);
        } else {
            robot::answer(&mut self.world, request)
        };
        let (status, data) = match answer {
            Ok(data) => (Status::OK, data),
            Err(refused) => (refused.status(self.world.model), Vec::new()),
        };
        answer_frame(Division::Robot, request.service, request.id, LAST_BLOCK, status, &data)
    }

    /// Recorded answer to a request.
    fn recorded(&self, request: &RequestFrame<'_>) -> Option<(Status, Vec<u8>)> {
        self.replay.answer(&request_text(&Request::from(*request))).and_then(parse_answer)
    }
}

/// The code for an invalid frame; `None` if the frame is too short to be answered.
fn malformed(error: &WireError) -> Option<u16> {
    match error {
        WireError::Truncated(_) => None,
        WireError::Oversized(_) => Some(code::FRAME_TOO_LONG),
        WireError::Identifier(_) => Some(code::IDENTIFIER),
        WireError::HeaderSize(_) => Some(code::HEADER_SIZE),
        WireError::DataSize { .. } => Some(code::SIZE_DIFFERS),
        WireError::Division(_) => Some(code::DIVISION),
        WireError::Ack(_) => Some(code::ACK),
    }
}

/// A frame in the format of a controller.
fn answer_frame(division: Division, service: u8, id: u8, block: u32, status: Status, data: &[u8]) -> Vec<u8> {
    AnswerFrame { division, ack: true, id, block, service: service | ANSWER_BIT, status, data }.emit()
}

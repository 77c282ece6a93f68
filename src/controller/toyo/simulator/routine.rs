//! Routines: palletizing, easy programs, moves to single points.
//!
//! A routine is a sequence of moves and of calls into the sequential program.

use super::action::{Move, Target};
use super::errors::code;
use super::io::PortBit;
use super::matrix::Matrix;
use super::memory::{Easy, index as to_index};
use super::motion::Coordinates;
use super::task::Flow;
use super::world::World;
use crate::toyo::layout::Record;
use crate::toyo::table::Pallet;

/// Routine that runs in a task.
#[derive(Debug, Clone)]
pub(super) enum Routine {
    // A move to a row of the coordinate table.
    Point { row: i32, begun: bool },
    // An easy program, with the number of the current repetition, from 1.
    Easy { program: usize, round: i32, part: EasyPart },
    Palletizing(Box<Palletizing>),
}

/// Current part of an easy program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EasyPart {
    Start,
    End,
}

/// A running palletizing program.
#[derive(Debug, Clone)]
pub(super) struct Palletizing {
    pub(super) program: usize,
    pub(super) mode: &'static str,
    /// Current phase: 0 is the start program. The phases of the source, the phases of the destination and the end
    /// program follow.
    phase: usize,
    begun: bool,
    start: i32,
    end: i32,
    pub(super) sides: [Side; 2],
    /// Tag of the current hand program.
    pub(super) hand: i32,
}

/// Source or destination of the pieces that a palletizing program moves.
#[derive(Debug, Clone)]
pub(super) struct Side {
    is_matrix: bool,
    matrix: Matrix,
    /// Number of the piece in each direction, from 1.
    pub(super) piece: [u16; 3],
    approach: Move,
    /// Z and R of the approach point. The field `approach` says whether these values are relative to the position.
    height: [f64; 2],
    turn: f64,
    tag: i32,
}

/// Phases of a side: move above the position, move down, run the hand program, move up. The constants name the phases
/// that the code needs.
const DOWN: usize = 1;
const HAND: usize = 2;
const LAST_OF_SOURCE: usize = 4;
const LAST: usize = 8;
const END: usize = 9;

/// Next action of a routine.
enum RoutineStep {
    Move(Move),
    Call(i32),
    Done,
}

impl EasyPart {
    /// Tag of the current part.
    pub(super) fn tag(self, easy: Easy) -> i32 {
        match self {
            Self::Start => easy.start,
            Self::End => easy.end,
        }
    }
}

impl Routine {
    /// An easy program; `None` if the program has no tags.
    pub(super) fn easy(program: usize, easy: Easy) -> Option<Self> {
        (easy.start != 0 || easy.end != 0).then_some(Self::Easy { program, round: 0, part: EasyPart::Start })
    }
}

impl World {
    /// Performs the next action of a routine.
    pub(super) fn follow_routine(&mut self, index: usize) {
        let at = self.now.saturating_add(self.tick);
        let Some(mut routine) = self.tasks[index].routine.take() else { return };
        let order = match &mut routine {
            Routine::Point { row, begun } => Ok(point(*row, begun)),
            Routine::Easy { program, round, part } => Ok(easy(self.memory.content.easy(*program), round, part)),
            Routine::Palletizing(palletizing) => palletizing.next(),
        };
        self.tasks[index].routine = Some(routine);
        let step = self.tasks[index].step;
        match order {
            Ok(RoutineStep::Done) => self.end(index),
            Ok(RoutineStep::Move(order)) => {
                let flow = self.begin_move(index, order, step);
                self.apply(index, flow);
            }
            Ok(RoutineStep::Call(tag)) => {
                let flow = self.find(index, to_index(tag)).map(Flow::To);
                self.tasks[index].called = flow.is_ok();
                self.apply(index, flow);
            }
            Err(code) => {
                self.tasks[index].wait = super::task::Wait::Ready(at);
                self.fail(code);
            }
        }
    }

    /// Number of the selected palletizing program. A number other than 0 at the inputs of M06 has priority.
    pub(super) fn chosen_pallet(&self) -> Result<usize, u8> {
        let number = |bit: PortBit| usize::from(self.ports.number(bit));
        match self.settings.palletizing.map_or(0, number) {
            0 => Ok(self.pallet),
            number @ 1..=16 => Ok(number),
            _ => Err(code::PALLET),
        }
    }

    /// A palletizing program in its initial state.
    pub(super) fn palletizing(&self, program: usize) -> Option<Palletizing> {
        let record = |number: i32| self.memory.content.pallet(program, Pallet::numbered(number)?);
        let start = record(1)?;
        let mode = start.word("mode")?;
        let side = |first: i32, is_matrix: bool| -> Option<Side> {
            let corner = |number: i32| record(first + number).map(|record| corner(&record));
            let (pieces, approach, hand) = (record(first + 4)?, record(first + 5)?, record(first + 6)?);
            let count = |name| u16::try_from(pieces.number(name).unwrap_or_default()).unwrap_or_default();
            Some(Side {
                is_matrix,
                matrix: Matrix {
                    origin: corner(0)?,
                    corners: [corner(1)?, corner(2)?, corner(3)?],
                    pieces: ["p1", "p2", "p3"].map(count),
                },
                piece: [1; 3],
                approach: Move {
                    to: Target::Back,
                    incremental: approach.word("aim") == Some("i"),
                    line: approach.word("course") == Some("T"),
                    speed: approach.number("speed")?,
                    pass: approach.word("arrival") == Some("PASS"),
                    escape: false,
                },
                height: ["approach", "r"].map(|name| millimetres(&approach, name)),
                turn: millimetres(&hand, "r"),
                tag: hand.number("tag")?,
            })
        };
        Some(Palletizing {
            program,
            mode,
            phase: 0,
            begun: false,
            start: start.number("tag")?,
            end: record(16)?.number("tag")?,
            sides: [side(2, mode != "1-M")?, side(9, mode != "M-1")?],
            hand: 0,
        })
    }
}

impl Palletizing {
    /// The side of the current phase. For the end program, the destination.
    pub(super) fn side(&self) -> &Side {
        &self.sides[usize::from(self.phase > LAST_OF_SOURCE)]
    }

    /// Name of the current phase in the protocol.
    pub(super) fn state(&self) -> &'static str {
        match self.phase {
            0 => "START",
            1..=LAST_OF_SOURCE => "SOURCE",
            5..=LAST => "DESTI",
            _ => "END",
        }
    }

    fn next(&mut self) -> Result<RoutineStep, u8> {
        loop {
            self.phase = if !std::mem::replace(&mut self.begun, true) {
                0
            } else if self.phase == LAST && self.count() {
                1
            } else {
                self.phase + 1
            };
            self.hand = match self.phase {
                0 => self.start,
                1..=LAST => {
                    let side = &self.sides[usize::from(self.phase > LAST_OF_SOURCE)];
                    match (self.phase - 1) % LAST_OF_SOURCE {
                        HAND => side.tag,
                        part => {
                            self.hand = 0;
                            return side.order(part == DOWN).map(RoutineStep::Move);
                        }
                    }
                }
                END => self.end,
                _ => return Ok(RoutineStep::Done),
            };
            if self.hand != 0 {
                return Ok(RoutineStep::Call(self.hand));
            }
        }
    }

    /// Counts a piece. Returns `false` after the last piece.
    fn count(&mut self) -> bool {
        let mut more = true;
        for side in self.sides.iter_mut().filter(|side| side.is_matrix) {
            match side.matrix.next(side.piece) {
                Some(piece) => side.piece = piece,
                None => more = false,
            }
        }
        more
    }
}

impl Side {
    /// Numbers of pieces in the three directions.
    pub(super) fn pieces(&self) -> [u16; 3] {
        self.matrix.pieces
    }

    /// A move to the position of the piece, or to the approach point above it.
    fn order(&self, down: bool) -> Result<Move, u8> {
        let piece = if self.is_matrix { self.piece } else { [1; 3] };
        let mut place = self.matrix.place(piece)?;
        place[3] = self.turn;
        if down {
            return Ok(Move { to: Target::Coordinates(place), incremental: false, pass: false, ..self.approach });
        }
        let [z, r] = self.height;
        let add = self.approach.incremental;
        place[2] = if add { place[2] + z } else { z };
        place[3] = if add { place[3] + r } else { r };
        Ok(Move { to: Target::Coordinates(place), incremental: false, ..self.approach })
    }
}

fn point(row: i32, begun: &mut bool) -> RoutineStep {
    if std::mem::replace(begun, true) {
        return RoutineStep::Done;
    }
    let to = Target::Row { point: row, counter: 0 };
    RoutineStep::Move(Move { to, incremental: false, line: false, speed: 0, pass: false, escape: false })
}

/// Runs the start program as often as the easy program requires, at least once. Then runs the end program.
fn easy(easy: Easy, round: &mut i32, part: &mut EasyPart) -> RoutineStep {
    if *part == EasyPart::Start {
        if easy.start != 0 && *round < easy.times.max(1) {
            *round += 1;
            return RoutineStep::Call(easy.start);
        }
        *part = EasyPart::End;
        if easy.end != 0 {
            return RoutineStep::Call(easy.end);
        }
    }
    RoutineStep::Done
}

fn corner(record: &Record) -> Coordinates {
    let [x, y, z] = ["x", "y", "z"].map(|name| millimetres(record, name));
    [x, y, z, 0.0]
}

fn millimetres(record: &Record, name: &str) -> f64 {
    f64::from(record.number(name).unwrap_or_default()) / 100.0
}

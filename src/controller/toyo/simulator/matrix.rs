//! Matrix positions: MVM groups, and the matrices of palletizing programs.

use super::errors::code;
use super::memory::index;
use super::motion::{Coordinates, minus};
use super::world::World;
use crate::refuse_if;
use crate::toyo::field::Value;

/// Number of linear axes of a matrix: axes 1 to 3. Axis 4 (`TURN`) rotates.
const SPACE: usize = 3;
const TURN: usize = 3;

/// A corner, the corners in the three directions, and the number of positions in each direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Matrix {
    pub(super) origin: Coordinates,
    pub(super) corners: [Coordinates; SPACE],
    pub(super) pieces: [u16; SPACE],
}

impl Matrix {
    /// Coordinates of a piece. Pieces are counted from 1 in each direction. A direction with at most one position has
    /// no effect.
    pub(super) fn place(&self, piece: [u16; SPACE]) -> Result<Coordinates, u8> {
        let mut place = self.origin;
        for direction in 0..SPACE {
            let (pieces, piece) = (self.pieces[direction], piece[direction]);
            if pieces <= 1 {
                continue;
            }
            refuse_if(!(1..=pieces).contains(&piece), code::CALCULATION)?;
            let share = f64::from(piece - 1) / f64::from(pieces - 1);
            let way = minus(&self.corners[direction], &self.origin);
            place.iter_mut().zip(way).take(SPACE).for_each(|(coordinate, way)| *coordinate += way * share);
        }
        Ok(place)
    }

    /// The next piece. The first direction changes fastest. Returns `None` after the last piece.
    pub(super) fn next(&self, mut piece: [u16; SPACE]) -> Option<[u16; SPACE]> {
        for direction in 0..SPACE {
            if piece[direction] < self.pieces[direction] {
                piece[direction] += 1;
                return Some(piece);
            }
            piece[direction] = 1;
        }
        None
    }
}

impl World {
    /// Position of an MVM group, selected by the counters of the group.
    pub(super) fn place_of_group(&self, task: usize, group: i32, approach: bool) -> Result<Coordinates, u8> {
        let counters = self.counters_of(group);
        let mut place = self.group(task, group)?.place(counters.map(|counter| self.counters[counter]))?;
        let [turn] = self.memory.content.numbers("T4.S5", group);
        place[TURN] = f64::from(turn) / 100.0;
        if approach {
            let [z, r] = self.memory.content.numbers("T4.S4", group).map(|value| f64::from(value) / 100.0);
            let incremental = self.memory.content.row("T4.S4", group).first() == Some(&Value::Word("i"));
            place[2] = if incremental { place[2] + z } else { z };
            place[TURN] = if incremental { place[TURN] + r } else { r };
        }
        Ok(place)
    }

    /// Sets the counters of a group to the first position.
    pub(super) fn begin_group(&mut self, group: i32) {
        for counter in self.counters_of(group) {
            self.counters[counter] = 1;
        }
    }

    /// Advances the counters of a group. After the last position, returns `false` and sets the counters to the first
    /// position.
    pub(super) fn next_of_group(&mut self, group: i32) -> bool {
        let counters = self.counters_of(group);
        let matrix = Matrix {
            origin: Coordinates::default(),
            corners: [Coordinates::default(); 3],
            pieces: self.pieces_of(group),
        };
        let next = matrix.next(counters.map(|counter| self.counters[counter]));
        for (counter, piece) in counters.into_iter().zip(next.unwrap_or([1; 3])) {
            self.counters[counter] = piece;
        }
        next.is_some()
    }

    /// An MVM group. Its corners are rows of the coordinate table of the task.
    fn group(&self, task: usize, group: i32) -> Result<Matrix, u8> {
        let pieces = self.pieces_of(group);
        let [origin, rows @ ..] = self.memory.content.numbers::<4>("T4.S1", group);
        let origin = self.row(task, origin, 0)?;
        let mut corners = [origin; SPACE];
        for (direction, row) in rows.into_iter().enumerate() {
            if pieces[direction] > 1 {
                corners[direction] = self.row(task, row, 0)?;
            }
        }
        Ok(Matrix { origin, corners, pieces })
    }

    fn pieces_of(&self, group: i32) -> [u16; SPACE] {
        self.memory.content.numbers("T4.S2", group).map(|pieces| u16::try_from(pieces).unwrap_or_default())
    }

    fn counters_of(&self, group: i32) -> [usize; SPACE] {
        self.memory.content.numbers("T4.S3", group).map(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MATRIX: Matrix = Matrix {
        origin: [10.0, 20.0, 5.0, 0.0],
        corners: [[30.0, 20.0, 5.0, 0.0], [10.0, 50.0, 5.0, 0.0], [10.0, 20.0, -5.0, 0.0]],
        pieces: [3, 2, 0],
    };

    #[test]
    fn positions_have_equal_distances() {
        assert_eq!(MATRIX.place([1, 1, 1]), Ok([10.0, 20.0, 5.0, 0.0]));
        assert_eq!(MATRIX.place([2, 2, 0]), Ok([20.0, 50.0, 5.0, 0.0]));
        assert_eq!(MATRIX.place([4, 1, 1]), Err(code::CALCULATION));
        assert_eq!(MATRIX.place([0, 1, 1]), Err(code::CALCULATION));
    }

    #[test]
    fn the_counter_of_the_first_direction_changes_fastest() {
        let mut piece = Some([1, 1, 1]);
        let mut all = Vec::new();
        while let Some(at) = piece {
            all.push(at);
            piece = MATRIX.next(at);
        }
        assert_eq!(all, [[1, 1, 1], [2, 1, 1], [3, 1, 1], [1, 2, 1], [2, 2, 1], [3, 2, 1]]);
    }
}

//! Memory of the controller: points, comments, pallets, shifts, hands, static variables, ports.

use std::collections::BTreeMap;

use super::alarms::{ARITHMETIC, AlarmSource, Fault, NO_AXIS, NO_PALLET, NO_POINT, POINT_UNIT};
use super::geometry::{FourValues, STEPS, whole};
use super::robot::AXES;
use crate::refuse_if;
use crate::simulator::with_defaults;

pub(super) const POINTS: u16 = 30_000;
/// Number of pallets, and of shifts.
pub(super) const SHIFTS: usize = 40;
pub(super) const HANDS: usize = 32;
/// Number of variables of each kind.
const VARIABLES: usize = 32;
/// Variable number of SGR0 (4.4.1).
const FIRST_REAL: usize = 256;
/// Maximum number of ports per type. The constant below is the number of types (4.5.1).
const PORTS: usize = 24;
const PORT_TYPES: usize = 7;
/// Index of port type SI. SI and SO are the port types that are in the image.
pub(super) const SI: usize = 5;
pub(super) const SO: usize = 6;
pub(super) const PORT_NAMES: [&str; PORT_TYPES] = ["DI", "DO", "MO", "LO", "TO", "SI", "SO"];

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PointUnit {
    Pulse,
    Mm,
}

impl PointUnit {
    pub(super) fn from_code(code: i32) -> Self {
        if code == 1 { Self::Mm } else { Self::Pulse }
    }

    pub(super) fn code(self) -> i32 {
        i32::from(self == Self::Mm)
    }
}

/// A defined point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Point {
    pub(super) unit: PointUnit,
    /// Hand system: 0 is none, 1 is right, 2 is left.
    pub(super) hand_system: i32,
    /// Values in pulses, or in steps of 0.001 mm or 0.001 degrees.
    pub(super) values: [i32; AXES],
}

impl Point {
    /// Converts the values to pulses, or to mm and degrees.
    pub(super) fn numbers(&self) -> FourValues {
        match self.unit {
            PointUnit::Pulse => self.values.map(f64::from),
            PointUnit::Mm => self.values.map(|value| f64::from(value) / STEPS),
        }
    }
}

/// A pallet. `first` is the number of the first of its five points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pallet {
    pub(super) counts: [i32; 3],
    pub(super) first: u16,
}

/// A hand, and the index of the robot that has it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Hand {
    pub(super) owner: usize,
    pub(super) data: [i32; 4],
}

/// Value of a variable.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    Whole(i32),
    Real(f32),
}

impl Number {
    pub(super) fn wide(self) -> f64 {
        match self {
            Self::Whole(number) => number.into(),
            Self::Real(number) => number.into(),
        }
    }
}

/// Arithmetic operations and assignment.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Operation {
    Assign,
    Add,
    Subtract,
    Multiply,
    Divide,
}

/// A port, or a bit of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct PortRef {
    pub(super) kind: usize,
    pub(super) port: usize,
    pub(super) bit: Option<u8>,
}

with_defaults! {
    #[derive(Debug, Clone)]
    pub(super) struct Memory {
        points: BTreeMap<u16, Point>,
        pub(super) comments: BTreeMap<u16, String>,
        pub(super) pallets: [Option<Pallet>; SHIFTS] = [None; SHIFTS],
        pub(super) shifts: [[i32; AXES]; SHIFTS] = [[0; AXES]; SHIFTS],
        pub(super) hands: [Option<Hand>; HANDS] = [None; HANDS],
        whole: [i32; VARIABLES] = [0; VARIABLES],
        real: [f32; VARIABLES] = [0.0; VARIABLES],
        ports: [[u8; PORTS]; PORT_TYPES] = [[0; PORTS]; PORT_TYPES],
    }
}

impl Memory {
    /// Returns a point. Fails if the point is not defined.
    pub(super) fn point(&self, number: usize) -> Result<Point, Fault> {
        let key = u16::try_from(number).ok();
        key.and_then(|key| self.points.get(&key)).copied().ok_or_else(|| no_point(number))
    }

    pub(super) fn set_point(&mut self, number: usize, point: Point) {
        if let Ok(number) = u16::try_from(number) {
            self.points.insert(number, point);
        }
    }

    /// Adds one point to another point, or subtracts it (4.4.3).
    pub(super) fn combine_points(&mut self, number: usize, other: usize, sign: i64) -> Result<(), Fault> {
        let (mut point, other) = (self.point(number)?, self.point(other)?);
        refuse_if(point.unit != other.unit, unit_differs("the two points"))?;
        for (value, added) in point.values.iter_mut().zip(other.values) {
            *value = i32::try_from(i64::from(*value) + sign * i64::from(added)).map_err(|_| too_large())?;
        }
        self.set_point(number, point);
        Ok(())
    }

    /// Sets an element of a point. Elements count from 0 (4.4.4).
    pub(super) fn set_element(&mut self, number: usize, unit: PointUnit, at: usize, value: i32) -> Result<(), Fault> {
        let mut point = self.point(number)?;
        refuse_if(point.unit != unit, unit_differs("the point"))?;
        let no_axis = || Fault::new(NO_AXIS, AlarmSource::Controller, format!("a point has no element {}", at + 1));
        *point.values.get_mut(at).ok_or_else(no_axis)? = value;
        self.set_point(number, point);
        Ok(())
    }

    /// Returns a pallet. Fails if the pallet is not defined.
    pub(super) fn pallet(&self, number: usize) -> Result<Pallet, Fault> {
        let pallet = self.pallets.get(number).copied().flatten();
        pallet.ok_or_else(|| Fault::new(NO_PALLET, AlarmSource::Controller, format!("pallet {number} is not defined")))
    }

    /// Coordinates of a position on a pallet. Positions count from 1. X changes fastest, then Y, then Z.
    pub(super) fn pallet_point(&self, number: usize, place: i32) -> Result<Point, Fault> {
        let pallet = self.pallet(number)?;
        let [nx, ny, nz] = pallet.counts;
        if i64::from(place) > i64::from(nx) * i64::from(ny) * i64::from(nz) {
            let why = format!("pallet {number} has {nx} x {ny} x {nz} positions, not {place}");
            return Err(Fault::new(NO_PALLET, AlarmSource::Controller, why));
        }
        let corner = |offset: u16| {
            let point = self.point(usize::from(pallet.first) + usize::from(offset))?;
            if point.unit == PointUnit::Mm { Ok(point) } else { Err(unit_differs("a corner of the pallet")) }
        };
        let (origin, along_x, along_y, opposite) = (corner(0)?, corner(1)?, corner(2)?, corner(3)?);
        let top = if nz > 1 { corner(4)? } else { origin };
        let share = |index: i32, count: i32| f64::from(index) / f64::from((count - 1).max(1));
        let index = place - 1;
        let (x, y, z) = (share(index % nx, nx), share(index / nx % ny, ny), share(index / nx / ny, nz));
        let values = std::array::from_fn(|axis| {
            let [origin, along_x, along_y, opposite, top] =
                [origin, along_x, along_y, opposite, top].map(|point| f64::from(point.values[axis]));
            let level = (1.0 - x) * (1.0 - y) * origin + x * (1.0 - y) * along_x + (1.0 - x) * y * along_y;
            whole(level + x * y * opposite + z * (top - origin))
        });
        Ok(Point { values, ..origin })
    }

    /// Value of a variable. Number 0 is SGI0, number 256 is SGR0.
    pub(super) fn variable(&self, number: usize) -> Number {
        match number.checked_sub(FIRST_REAL) {
            Some(real) => Number::Real(self.real.get(real).copied().unwrap_or_default()),
            None => Number::Whole(self.whole.get(number).copied().unwrap_or_default()),
        }
    }

    /// Applies an operation to a variable.
    pub(super) fn compute(&mut self, number: usize, operation: Operation, operand: Number) -> Result<(), Fault> {
        let result = calculate(operation, self.variable(number), operand)?;
        self.assign(number, result)
    }

    /// Assigns a value. An integer variable drops the decimals.
    pub(super) fn assign(&mut self, number: usize, value: f64) -> Result<(), Fault> {
        if let Some(real) = number.checked_sub(FIRST_REAL) {
            let value = single(value);
            let place = self.real.get_mut(real).filter(|_| value.is_finite());
            *place.ok_or_else(too_large)? = value;
        } else {
            let value = value.trunc();
            let fits = (f64::from(i32::MIN)..=f64::from(i32::MAX)).contains(&value);
            *self.whole.get_mut(number).filter(|_| fits).ok_or_else(too_large)? = whole(value);
        }
        Ok(())
    }

    /// Eight bits of a port. Port numbers are octal.
    pub(super) fn port(&self, kind: usize, number: usize) -> u8 {
        self.ports.get(kind).and_then(|ports| ports.get(index(number))).copied().unwrap_or_default()
    }

    pub(super) fn set_port(&mut self, kind: usize, number: usize, value: u8) {
        if let Some(port) = self.ports.get_mut(kind).and_then(|ports| ports.get_mut(index(number))) {
            *port = value;
        }
    }

    pub(super) fn set_bit(&mut self, kind: usize, number: usize, bit: u8, on: bool) {
        let mask = 1_u8.checked_shl(bit.into()).unwrap_or_default();
        let old = self.port(kind, number);
        self.set_port(kind, number, if on { old | mask } else { old & !mask });
    }

    /// Sets a port, or a bit of a port.
    pub(super) fn set_output(&mut self, port: PortRef, value: u8) {
        match port.bit {
            Some(bit) => self.set_bit(port.kind, port.port, bit, value == 1),
            None => self.set_port(port.kind, port.port, value),
        }
    }
}

pub(super) fn calculate(operation: Operation, first: Number, second: Number) -> Result<f64, Fault> {
    let (a, b) = (first.wide(), second.wide());
    match operation {
        Operation::Assign => Ok(b),
        Operation::Add => Ok(a + b),
        Operation::Subtract => Ok(a - b),
        Operation::Multiply => Ok(a * b),
        Operation::Divide if b == 0.0 => Err(Fault::new(ARITHMETIC, AlarmSource::Controller, "division by zero")),
        Operation::Divide => Ok(a / b),
    }
}

/// Index of a port. Port numbers are octal, so port 10 follows port 7.
fn index(number: usize) -> usize {
    number / 10 * 8 + number % 10
}

pub(super) fn port_kind(name: &str) -> Option<usize> {
    PORT_NAMES.iter().position(|known| *known == name)
}

/// Whether this port number exists for the type (4.5.1).
pub(super) fn is_port(kind: usize, number: usize) -> bool {
    match kind {
        3 => number <= 1,
        4 => number == 0,
        0..PORT_TYPES => number % 10 <= 7 && number / 10 <= 2,
        _ => false,
    }
}

fn no_point(number: usize) -> Fault {
    Fault::new(NO_POINT, AlarmSource::Controller, format!("point {number} is not defined"))
}

fn unit_differs(what: &str) -> Fault {
    Fault::new(POINT_UNIT, AlarmSource::Controller, format!("{what} must be in the unit of this command"))
}

fn too_large() -> Fault {
    Fault::new(ARITHMETIC, AlarmSource::Controller, "the result is out of range")
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "real variables have single precision; a value that is too large becomes infinite"
)]
fn single(number: f64) -> f32 {
    number as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mm(values: [i32; 4]) -> Point {
        Point { unit: PointUnit::Mm, hand_system: 0, values }
    }

    #[test]
    fn pallets_count_x_first() {
        let mut memory = Memory::default();
        memory.pallets[2] = Some(Pallet { counts: [3, 2, 2], first: 10 });
        let corners = [[0, 0, 0, 0], [200, 0, 0, 0], [0, 100, 0, 0], [200, 100, 0, 0], [0, 0, 50, 0]];
        for (number, values) in (10..).zip(corners) {
            assert!(memory.pallet_point(2, 1).is_err(), "not all of its points are defined");
            memory.set_point(number, mm(values));
        }
        let place = |number| memory.pallet_point(2, number).unwrap().values;
        assert_eq!((place(1), place(2), place(3)), ([0; 4], [100, 0, 0, 0], [200, 0, 0, 0]));
        assert_eq!((place(5), place(12)), ([100, 100, 0, 0], [200, 100, 50, 0]));
        assert_eq!(memory.pallet_point(2, 13).unwrap_err().alarm, NO_PALLET);
        assert_eq!(memory.pallet_point(1, 1).unwrap_err().alarm, NO_PALLET);
    }

    #[test]
    fn variables_keep_their_kind() {
        let mut memory = Memory::default();
        memory.compute(5, Operation::Assign, Number::Whole(7)).unwrap();
        memory.compute(5, Operation::Divide, Number::Whole(-2)).unwrap();
        assert_eq!(memory.variable(5), Number::Whole(-3));
        memory.compute(256, Operation::Assign, Number::Real(1.5)).unwrap();
        memory.compute(256, Operation::Multiply, Number::Whole(2)).unwrap();
        assert_eq!(memory.variable(256), Number::Real(3.0));
        memory.compute(5, Operation::Assign, Number::Whole(i32::MAX)).unwrap();
        for (operation, operand) in [(Operation::Add, Number::Whole(1)), (Operation::Divide, Number::Real(0.0))] {
            assert_eq!(memory.compute(5, operation, operand).unwrap_err().alarm, ARITHMETIC);
            assert_eq!(memory.variable(5), Number::Whole(i32::MAX));
        }
        assert!(memory.compute(287, Operation::Assign, Number::Real(f32::MAX)).is_ok());
        assert!(memory.compute(287, Operation::Multiply, Number::Whole(2)).is_err());
    }

    #[test]
    fn ports_have_octal_numbers() {
        let mut memory = Memory::default();
        memory.set_port(1, 7, 0x55);
        memory.set_bit(1, 10, 3, true);
        assert_eq!((memory.port(1, 7), memory.port(1, 10), memory.port(2, 10)), (0x55, 8, 0));
        assert!(is_port(0, 27) && !is_port(0, 8) && !is_port(0, 30) && is_port(4, 0) && !is_port(3, 2));
    }
}

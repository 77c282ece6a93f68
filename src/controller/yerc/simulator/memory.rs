//! Variables, I/O and registers, stored in protocol format.
//!
//! Protocol and memory are little-endian, so the bytes of an element are the same for single and plural commands.

use crate::yerc::Model;
use crate::yerc::table::{Row, Span};

/// Number of variables of each of these kinds: byte, integer, double, real and string (DX 3.3.11 to 3.3.15).
const SCALARS: usize = 100;
/// Number of position variables of each kind (DX 3.3.16 to 3.3.18).
const POSITIONS: usize = 128;
/// Number of registers: 0 to 999 (DX 3.3.10).
const REGISTERS: usize = 1000;
/// The command whose instances are the I/O classes.
const SINGLE_IO: u16 = 0x78;
/// One more than the highest I/O instance of any model.
const IO_END: usize = 8221;

/// Words of a robot position variable: type, form, tool, user frame, extended form, eight axes.
pub(super) const POSITION_WORDS: usize = 13;
/// Words of a base or station position variable: type, eight axes.
pub(super) const AXIS_WORDS: usize = 9;

/// Kinds of variables, in the order of their commands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) enum Kind {
    B,
    I,
    D,
    R,
    S,
    P,
    Bp,
    Ex,
}

impl Kind {
    /// All kinds, in the order of their commands.
    pub(super) const ALL: [Self; 8] = [Self::B, Self::I, Self::D, Self::R, Self::S, Self::P, Self::Bp, Self::Ex];
    /// All kinds. Longer names come first, so that a prefix search finds `BP` before `B`.
    pub(super) const BY_NAME: [(&'static str, Self); 8] = [
        ("BP", Self::Bp),
        ("EX", Self::Ex),
        ("B", Self::B),
        ("I", Self::I),
        ("D", Self::D),
        ("R", Self::R),
        ("S", Self::S),
        ("P", Self::P),
    ];

    /// Size of an element in bytes.
    const fn size(self) -> usize {
        match self {
            Self::B => 1,
            Self::I => 2,
            Self::D | Self::R => 4,
            Self::S => 32,
            Self::P => 4 * POSITION_WORDS,
            Self::Bp | Self::Ex => 4 * AXIS_WORDS,
        }
    }

    /// Whether variables of this kind are undefined until they are written. Position variables are.
    pub(super) const fn starts_undefined(self) -> bool {
        matches!(self, Self::P | Self::Bp | Self::Ex)
    }

    pub(super) const fn count(self) -> usize {
        if self.starts_undefined() { POSITIONS } else { SCALARS }
    }

    /// Parses a variable, for example `B12` or `BP3`.
    pub(super) fn parse(text: &str) -> Option<(Self, usize)> {
        let (kind, digits) =
            Self::BY_NAME.into_iter().find_map(|(name, kind)| Some((kind, text.strip_prefix(name)?)))?;
        if digits.is_empty() || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        let index = digits.parse().ok().filter(|&index| index < kind.count())?;
        Some((kind, index))
    }
}

/// All elements of one kind.
#[derive(Debug, Clone)]
struct Bank {
    size: usize,
    bytes: Vec<u8>,
    defined: Vec<bool>,
}

impl Bank {
    fn new(kind: Kind) -> Self {
        let (size, count) = (kind.size(), kind.count());
        Self { size, bytes: vec![0; size * count], defined: vec![!kind.starts_undefined(); count] }
    }
}

#[derive(Debug, Clone)]
pub(super) struct Memory {
    model: Model,
    banks: [Bank; 8],
    io: Vec<u8>,
    registers: Vec<u16>,
    /// Registers that the ladder program writes in each cycle. A client can write such a register, but the value does
    /// not last.
    pub(super) ladder: Vec<u16>,
}

impl Memory {
    pub(super) fn new(model: Model) -> Self {
        Self {
            model,
            banks: Kind::ALL.map(Bank::new),
            io: vec![0; IO_END],
            registers: vec![0; REGISTERS],
            ladder: Vec::new(),
        }
    }

    /// The bytes of an element; `None` while the element is undefined.
    ///
    /// # Panics
    /// If `index` is out of range. The callers check the range first.
    pub(super) fn element(&self, kind: Kind, index: usize) -> Option<&[u8]> {
        let bank = &self.banks[kind as usize];
        bank.defined[index].then(|| &bank.bytes[index * bank.size..][..bank.size])
    }

    /// Writes an element. If `value` is shorter than the element, the other bytes become 0 (a 16-byte text in a 32-byte
    /// variable).
    ///
    /// # Panics
    /// If `index` or the length is out of range. The callers check them first.
    pub(super) fn store(&mut self, kind: Kind, index: usize, value: &[u8]) {
        let bank = &mut self.banks[kind as usize];
        let place = &mut bank.bytes[index * bank.size..][..bank.size];
        place.fill(0);
        place[..value.len()].copy_from_slice(value);
        bank.defined[index] = true;
    }

    /// Makes a position variable undefined, as before its first write.
    ///
    /// # Panics
    /// If `index` is out of range. The callers check the range first.
    pub(super) fn forget(&mut self, kind: Kind, index: usize) {
        let bank = &mut self.banks[kind as usize];
        bank.defined[index] = !kind.starts_undefined();
    }

    /// A numeric variable as a number, for jobs.
    pub(super) fn number(&self, kind: Kind, index: usize) -> f64 {
        let Some(bytes) = self.element(kind, index) else { return 0.0 };
        match (kind, bytes) {
            (Kind::B, &[byte]) => f64::from(byte),
            (Kind::I, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
            (Kind::D, &[a, b, c, d]) => f64::from(i32::from_le_bytes([a, b, c, d])),
            (Kind::R, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            _ => 0.0,
        }
    }

    /// Writes a number to a numeric variable. Returns `false` if the number does not fit the kind of the variable.
    #[expect(clippy::cast_possible_truncation, reason = "the ranges are checked first; R holds single precision")]
    pub(super) fn store_number(&mut self, kind: Kind, index: usize, value: f64) -> bool {
        let whole = value.trunc() as i64;
        let bytes = match kind {
            Kind::B => u8::try_from(whole).ok().map(|value| vec![value]),
            Kind::I => i16::try_from(whole).ok().map(|value| value.to_le_bytes().to_vec()),
            Kind::D => i32::try_from(whole).ok().map(|value| value.to_le_bytes().to_vec()),
            Kind::R => Some((value as f32).to_le_bytes().to_vec()),
            Kind::S | Kind::P | Kind::Bp | Kind::Ex => None,
        };
        bytes.map(|bytes| self.store(kind, index, &bytes)).is_some()
    }

    /// Byte of an I/O instance that exists.
    pub(super) fn io(&self, instance: u16) -> u8 {
        self.io.get(usize::from(instance)).copied().unwrap_or(0)
    }

    pub(super) fn set_io(&mut self, instance: u16, value: u8) {
        if let Some(byte) = self.io.get_mut(usize::from(instance)) {
            *byte = value;
        }
    }

    /// Whether a signal is on. The last digit of a signal number cannot be 8 or 9.
    pub(super) fn signal(&self, number: u32) -> bool {
        signal_place(number).is_some_and(|(instance, bit)| self.io(instance) & bit != 0)
    }

    /// Switches a signal. Returns `false` if the signal does not exist on this model.
    pub(super) fn set_signal(&mut self, number: u32, on: bool) -> bool {
        let Some((instance, bit)) =
            signal_place(number).filter(|&(instance, _)| io_class(self.model, instance).is_some())
        else {
            return false;
        };
        let byte = self.io(instance);
        self.set_io(instance, if on { byte | bit } else { byte & !bit });
        true
    }

    pub(super) fn register(&self, number: u16) -> Option<u16> {
        self.registers.get(usize::from(number)).copied()
    }

    /// Writes a register for a client. Has no effect on a register of the ladder, because the ladder writes it again in
    /// each cycle.
    pub(super) fn write_register(&mut self, number: u16, value: u16) {
        if !self.ladder.contains(&number) {
            self.force_register(number, value);
        }
    }

    /// Writes a register for the ladder or the console. Returns `false` if the register does not exist.
    pub(super) fn force_register(&mut self, number: u16, value: u16) -> bool {
        self.registers.get_mut(usize::from(number)).map(|register| *register = value).is_some()
    }
}

/// The class of an I/O instance (DX and FS 3.3.9).
pub(super) fn io_class(model: Model, instance: u16) -> Option<&'static Span> {
    Row::from_number(SINGLE_IO)?.instances.find(model, instance)
}

fn signal_place(number: u32) -> Option<(u16, u8)> {
    let bit = number % 10;
    if bit > 7 {
        return None;
    }
    Some((u16::try_from(number / 10).ok()?, 1 << bit))
}

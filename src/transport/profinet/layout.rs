//! Module layout of a device, and the positions of its data in cyclic frames.

use std::fmt;
use std::str::FromStr;

use super::error::ModuleMismatch;
use super::wire::connect::{DataDescription, ExpectedModule, ExpectedSubmodule, ModuleDiff, Offset};

/// Minimum data length of a frame.
const MIN_FRAME_DATA: u16 = 40;
/// Maximum data length of a frame.
const MAX_FRAME_DATA: u16 = 1440;
/// Maximum number of submodules. Each submodule makes the Connect call longer.
const MAX_SUBMODULES: usize = 64;

/// A submodule and its data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Submodule {
    /// Slot.
    pub slot: u16,
    /// Subslot.
    pub subslot: u16,
    /// Ident number of the module in the slot.
    pub module: u32,
    /// Ident number of the submodule.
    pub ident: u32,
    /// Bytes of input data.
    pub input: u16,
    /// Bytes of output data.
    pub output: u16,
}

/// Submodules of a device, sorted by slot and subslot.
///
/// The text form is a comma-separated list of `SLOT[.SUBSLOT]:MODULE[/SUBMODULE][:iBYTES][oBYTES]`, for example
/// `0:1,0.0x8000:1/0x8000,1:0x101:i48,2:0x102:o48`. If the subslot or the submodule is missing, it is 1.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Default)]
pub struct Layout(pub(super) Vec<Submodule>);

/// Direction of data.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Direction {
    /// From the device.
    Input,
    /// To the device.
    Output,
}

/// Positions of the data in the frames of one direction.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct FrameLayout {
    /// Positions and lengths of the data objects. A provider status follows after each data object.
    pub objects: Vec<(Offset, u16)>,
    /// Positions of the consumer statuses.
    pub consumers: Vec<Offset>,
    /// Total length of the data in the frame, with padding.
    pub length: u16,
}

impl Layout {
    /// Creates a layout, and sorts the submodules.
    ///
    /// # Errors
    /// Two submodules have the same slot and subslot, a slot has two modules, or the data does not fit into a frame.
    pub fn new(mut submodules: Vec<Submodule>) -> Result<Self, String> {
        if submodules.is_empty() || submodules.len() > MAX_SUBMODULES {
            return Err(format!("a layout must have 1 to {MAX_SUBMODULES} submodules, not {}", submodules.len()));
        }
        submodules.sort_by_key(|submodule| (submodule.slot, submodule.subslot));
        for pair in submodules.windows(2) {
            let [one, two] = [pair[0], pair[1]];
            if (one.slot, one.subslot) == (two.slot, two.subslot) {
                return Err(format!("slot {}, subslot {:#x} appears twice", one.slot, one.subslot));
            }
            if one.slot == two.slot && one.module != two.module {
                return Err(format!("slot {} has two modules, {:#x} and {:#x}", one.slot, one.module, two.module));
            }
        }
        let layout = Self(submodules);
        for direction in [Direction::Input, Direction::Output] {
            if layout.data_position(direction).1 > usize::from(MAX_FRAME_DATA) {
                return Err(format!("the data is too long for a frame of {MAX_FRAME_DATA} bytes"));
            }
        }
        Ok(layout)
    }

    /// Returns the usual layout: an access point without data, 48 bytes of input in slot 1, 48 bytes of output in slot
    /// 2.
    pub fn two_modules(input: u32, output: u32) -> Self {
        let head = |subslot, ident| Submodule { slot: 0, subslot, module: 1, ident, input: 0, output: 0 };
        Self(vec![
            head(1, 1),
            head(0x8000, 0x8000),
            head(0x8001, 0x8001),
            Submodule { slot: 1, subslot: 1, module: input, ident: 1, input: 48, output: 0 },
            Submodule { slot: 2, subslot: 1, module: output, ident: 1, input: 0, output: 48 },
        ])
    }

    /// Size of the image in a direction, in bytes.
    pub fn size(&self, direction: Direction) -> usize {
        self.0.iter().map(|submodule| usize::from(submodule.length(direction))).sum()
    }

    /// Returns the positions in the frames of a direction. All data objects with their provider statuses come first,
    /// then all consumer statuses.
    pub fn frame(&self, direction: Direction) -> FrameLayout {
        let (mut frame, end) = self.data_position(direction);
        frame.length = u16::try_from(end).unwrap_or(MAX_FRAME_DATA).max(MIN_FRAME_DATA);
        frame
    }

    fn data_position(&self, direction: Direction) -> (FrameLayout, usize) {
        let mut frame = FrameLayout::default();
        let mut at = 0;
        // This cannot overflow, because `new` has checked the size.
        let offset = |submodule: &Submodule, at: usize| Offset {
            slot: submodule.slot,
            subslot: submodule.subslot,
            offset: u16::try_from(at).unwrap_or(u16::MAX),
        };
        for submodule in self.0.iter().filter(|submodule| submodule.has_data(direction)) {
            let length = submodule.length(direction);
            frame.objects.push((offset(submodule, at), length));
            at += usize::from(length) + 1;
        }
        for submodule in self.0.iter().filter(|submodule| submodule.has_data(direction.opposite())) {
            frame.consumers.push(offset(submodule, at));
            at += 1;
        }
        (frame, at)
    }

    /// Returns the expected modules for Connect, one block per slot.
    pub fn expected(&self) -> Vec<ExpectedModule> {
        let mut modules: Vec<ExpectedModule> = Vec::new();
        for submodule in &self.0 {
            if modules.last().is_none_or(|module| module.slot != submodule.slot) {
                let (slot, ident) = (submodule.slot, submodule.module);
                modules.push(ExpectedModule { api: 0, slot, ident, submodules: Vec::new() });
            }
            if let Some(module) = modules.last_mut() {
                module.submodules.push(submodule.expected());
            }
        }
        modules
    }

    /// Returns the differences between this layout and the answer of a device. A difference may also concern a module
    /// without data.
    pub fn mismatches(&self, modules: &[ModuleDiff]) -> Vec<ModuleMismatch> {
        let mut mismatches = Vec::new();
        for module in modules {
            let expected = self.0.iter().find(|submodule| submodule.slot == module.slot);
            let expected = expected.map(|submodule| submodule.module);
            // Only missing and wrong modules are reported here. A substitute module works like the expected module. A
            // correct module may still have wrong submodules.
            if module.state < 2 {
                let found = (module.state == 1).then_some(module.ident);
                mismatches.push(ModuleMismatch { slot: module.slot, subslot: None, found, expected });
                continue;
            }
            for submodule in module.submodules.iter().filter(|submodule| !submodule.is_usable()) {
                let expected = self.find(module.slot, submodule.subslot).map(|expected| expected.ident);
                let (slot, subslot) = (module.slot, Some(submodule.subslot));
                let found = (!submodule.is_missing()).then_some(submodule.ident);
                mismatches.push(ModuleMismatch { slot, subslot, found, expected });
            }
        }
        mismatches
    }

    /// The submodule in this slot and subslot.
    pub fn find(&self, slot: u16, subslot: u16) -> Option<&Submodule> {
        self.0.iter().find(|submodule| (submodule.slot, submodule.subslot) == (slot, subslot))
    }
}

impl Direction {
    /// The opposite direction.
    #[must_use]
    pub const fn opposite(self) -> Self {
        match self {
            Self::Input => Self::Output,
            Self::Output => Self::Input,
        }
    }
}

impl Submodule {
    /// Number of data bytes of the submodule in a direction.
    pub const fn length(&self, direction: Direction) -> u16 {
        match direction {
            Direction::Input => self.input,
            Direction::Output => self.output,
        }
    }

    /// Whether frames of this direction contain the data of this submodule. For a submodule without data, the input
    /// frames contain its status.
    pub const fn has_data(&self, direction: Direction) -> bool {
        match direction {
            Direction::Input => self.input > 0 || self.output == 0,
            Direction::Output => self.output > 0,
        }
    }

    fn expected(&self) -> ExpectedSubmodule {
        let describe = |direction, length| DataDescription { direction, length, consumer: 1, provider: 1 };
        let (properties, data) = match (self.input > 0, self.output > 0) {
            (false, false) => (0, vec![describe(1, 0)]),
            (true, false) => (1, vec![describe(1, self.input)]),
            (false, true) => (2, vec![describe(2, self.output)]),
            (true, true) => (3, vec![describe(1, self.input), describe(2, self.output)]),
        };
        ExpectedSubmodule { subslot: self.subslot, ident: self.ident, properties, data }
    }
}

/// Parses a decimal number, or a hexadecimal number with `0x`.
fn number(text: &str) -> Option<u32> {
    match text.strip_prefix("0x") {
        Some(digits) if !digits.starts_with('+') => u32::from_str_radix(digits, 16).ok(),
        None if text.starts_with(|c: char| c.is_ascii_digit()) => text.parse().ok(),
        _ => None,
    }
}

impl FromStr for Layout {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::new(text.split(',').map(str::parse).collect::<Result<_, _>>()?)
    }
}

impl FromStr for Submodule {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "'{text}' is not a submodule such as 1:0x101:i48 (SLOT[.SUBSLOT]:MODULE[/SUBMODULE][:iBYTES][oBYTES])"
            )
        };
        let small = |text: &str| number(text).and_then(|number| u16::try_from(number).ok());
        let mut parts = text.split(':');
        let place = parts.next().unwrap_or_default();
        let kind = parts.next().ok_or_else(wrong)?;
        let data = parts.next().unwrap_or_default();
        if parts.next().is_some() {
            return Err(wrong());
        }
        let (slot, subslot) = place.split_once('.').unwrap_or((place, "1"));
        let (module, ident) = kind.split_once('/').unwrap_or((kind, "1"));
        let (input, output) = match data.split_once('o') {
            Some((input, output)) => (input, Some(output)),
            None => (data, None),
        };
        let input = match input.strip_prefix('i') {
            Some(bytes) => Some(bytes),
            None if input.is_empty() => None,
            None => return Err(wrong()),
        };
        let bytes = |text: Option<&str>| match text {
            None => Ok(0),
            Some(text) => small(text).filter(|bytes| *bytes <= MAX_FRAME_DATA).ok_or_else(wrong),
        };
        Ok(Self {
            slot: small(slot).ok_or_else(wrong)?,
            subslot: small(subslot).ok_or_else(wrong)?,
            module: number(module).ok_or_else(wrong)?,
            ident: number(ident).ok_or_else(wrong)?,
            input: bytes(input)?,
            output: bytes(output)?,
        })
    }
}

impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, submodule) in self.0.iter().enumerate() {
            write!(f, "{}{submodule}", if at == 0 { "" } else { "," })?;
        }
        Ok(())
    }
}

impl fmt::Display for Submodule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { slot, subslot, module, ident, input, output } = self;
        write!(f, "{slot}")?;
        if *subslot != 1 {
            write!(f, ".{subslot:#x}")?;
        }
        write!(f, ":{module:#x}")?;
        if *ident != 1 {
            write!(f, "/{ident:#x}")?;
        }
        match (input, output) {
            (0, 0) => Ok(()),
            (_, 0) => write!(f, ":i{input}"),
            (0, _) => write!(f, ":o{output}"),
            _ => write!(f, ":i{input}o{output}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected positions in both data blocks are from the worked example in the notes.
    #[test]
    fn frame_offsets_match_the_example() {
        let layout = Layout::two_modules(0x101, 0x102);
        let places = |offsets: &[Offset]| offsets.iter().map(|at| (at.slot, at.subslot, at.offset)).collect::<Vec<_>>();
        let objects = |frame: &FrameLayout| places(&frame.objects.iter().map(|(at, _)| *at).collect::<Vec<_>>());
        let input = layout.frame(Direction::Input);
        assert_eq!(objects(&input), [(0, 1, 0), (0, 0x8000, 1), (0, 0x8001, 2), (1, 1, 3)]);
        assert_eq!((places(&input.consumers), input.length), (vec![(2, 1, 0x34)], 0x35));
        let output = layout.frame(Direction::Output);
        assert_eq!(objects(&output), [(2, 1, 0)]);
        let consumers = vec![(0, 1, 0x31), (0, 0x8000, 0x32), (0, 0x8001, 0x33), (1, 1, 0x34)];
        assert_eq!((places(&output.consumers), output.length), (consumers, 0x35));
        assert_eq!((layout.size(Direction::Input), layout.size(Direction::Output)), (48, 48));
        assert_eq!(layout.expected().iter().map(|module| module.submodules.len()).collect::<Vec<_>>(), [3, 1, 1]);
    }

    #[test]
    fn layouts_round_trip() {
        let text = "0:0x1,0.0x8000:0x1/0x8000,1:0x101:i48,2:0x102/0x2:o48,3:0x103:i2o4";
        let layout: Layout = text.parse().unwrap();
        assert_eq!(layout.to_string(), text);
        assert_eq!("2:1:o1,1:0x7:i1".parse::<Layout>().unwrap().to_string(), "1:0x7:i1,2:0x1:o1");
        assert_eq!(layout.frame(Direction::Input).length, 54 + 1 + 1);
    }

    #[test]
    fn rejects_invalid_layouts() {
        for text in ["", "1", "1:", "x:1", "1:1:48", "1:1:i", "1:1:i48:o2", "1:1:i9999", "70000:1", "1:0x+1", "1:-1"] {
            assert!(text.parse::<Layout>().is_err(), "{text}");
        }
        for (text, reason) in
            [("1:1:i1,1:1:o1", "appears twice"), ("1:1:i1,1.2:2:o1", "two modules"), ("1:1:i1400,2:1:i41", "too long")]
        {
            assert!(text.parse::<Layout>().unwrap_err().contains(reason), "{text}");
        }
    }
}

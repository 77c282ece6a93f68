//! Alarm sub-codes: 32-bit values whose meaning depends on the alarm type (FS and DX 3.3.1, 3.3.2, 3.3.37).
//!
//! The manuals specify the types and their display on the pendant, but not the layout of the bits. For this reason,
//! each rendered text has a trust level:
//!
//! | types | trust | reason |
//! |---|---|---|
//! | 0, 1, 2, 6, 9, 10 | [`Trust::Printed`] | numbers and bit patterns with width and sign in the manuals |
//! | 3, 4, 5 | [`Trust::Inferred`] | a set of named axes; bit 0 as the first name is inferred |
//! | 8, 11, 12 | [`Trust::Inferred`] | a set of groups; robots from bit 0 is inferred; the first bits of stations and bases are unknown, so these bits are numbered |
//! | 20-25, 27 | [`Trust::Raw`] | several fields in one word in an unknown order; a guess could send a technician to the wrong axis |
//! | others | [`Trust::Raw`] | not in the manuals (7, 13-19, 26) |
//!
//! A value that does not fit the format of its type is displayed raw. Controllers with 0x30A and 0x30B send the text of
//! the pendant for every type. That text is better than a text rendered here.

use std::fmt;

use super::Model;
use super::group::Group;
use super::table::ALARM_KINDS;

/// Format of a sub-code, by the number that the controller sends. Undefined numbers are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct AlarmKind(pub u32);

impl AlarmKind {
    /// Description of the format, if it is in the manuals.
    pub fn meaning(self) -> Option<&'static str> {
        ALARM_KINDS.iter().find(|(number, _)| *number == self.0).map(|(_, meaning)| *meaning)
    }
}

/// Trust level of a rendered text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Trust {
    /// Fully specified in the manuals.
    Printed,
    /// The format is specified; the positions of the bits are inferred.
    Inferred,
    /// Not interpreted.
    Raw,
}

impl Trust {
    /// Name in JSON.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Printed => "printed",
            Self::Inferred => "inferred",
            Self::Raw => "raw",
        }
    }
}

/// A readable sub-code. [`Display`](fmt::Display) adds the raw value if the text is not certain.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SubCode {
    /// Alarm type, as received.
    pub alarm_type: u32,
    /// Sub-code, as received.
    pub data: u32,
    /// Name of the type.
    pub type_name: &'static str,
    /// Text as on the pendant, for example `[1]` or `[SLU]`. If [`trust`](Self::trust) is raw, the text is the bytes in
    /// hexadecimal, lowest byte first. Empty without a sub-code.
    pub text: String,
    /// Trust level of the text.
    pub trust: Trust,
}

/// Renders the sub-code `data` of an alarm of type `kind`. The model limits the number of robots. Rendering never
/// fails: unknown types, and values that do not fit their type, are rendered raw.
pub fn render(kind: AlarmKind, data: u32, model: Model) -> SubCode {
    let alarm_type = kind.0;
    let form = TYPES.iter().find(|(number, _)| *number == alarm_type).map_or(Form::Unknown, |(_, form)| *form);
    let type_name = kind.meaning().unwrap_or("undocumented type");
    let (text, trust) = form.render(data, model).unwrap_or_else(|| (bytes(data), Trust::Raw));
    SubCode { alarm_type, data, type_name, text, trust }
}

/// Display format of an alarm type.
#[derive(Debug, Clone, Copy)]
enum Form {
    /// No sub-code.
    Empty,
    /// Unsigned 16-bit number.
    Unsigned16,
    /// Signed 16-bit number.
    Signed16,
    /// Bit pattern of this width, in groups of four.
    Bits(u32),
    /// A set of named axes. Bit 0 is the first axis.
    Axes(&'static [&'static str]),
    /// A set of control groups. The robots begin at bit 0.
    Groups,
    /// Fields in an unknown order.
    Unknown,
}

/// Axis names of a robot, in data order (DX 3.3.5). The eighth axis has no name.
const ROBOT_AXES: &[&str] = &["S", "L", "U", "R", "B", "T", "E"];
const SPACE_AXES: &[&str] = &["X", "Y", "Z"];
const POSE_AXES: &[&str] = &["X", "Y", "Z", "Rx", "Ry", "Rz"];

/// Formats of the types in FS and DX 3.3.1, in ascending order. The command table has the names of the types. FS has
/// the example `[R1: 1]` for type 27; DX repeats the example of type 25 for type 27.
const TYPES: [(u32, Form); 19] = [
    (0, Form::Empty),
    (1, Form::Unsigned16),
    (2, Form::Bits(8)),
    (3, Form::Axes(ROBOT_AXES)),
    (4, Form::Axes(SPACE_AXES)),
    (5, Form::Axes(POSE_AXES)),
    (6, Form::Unsigned16),
    (8, Form::Groups),
    (9, Form::Signed16),
    (10, Form::Bits(16)),
    (11, Form::Groups),
    (12, Form::Groups),
    (20, Form::Unknown),
    (21, Form::Unknown),
    (22, Form::Unknown),
    (23, Form::Unknown),
    (24, Form::Unknown),
    (25, Form::Unknown),
    (27, Form::Unknown),
];

impl Form {
    /// Text of a value; `None` if the value does not fit the format.
    fn render(self, data: u32, model: Model) -> Option<(String, Trust)> {
        match self {
            Self::Empty => (data == 0).then(|| (String::new(), Trust::Printed)),
            Self::Unsigned16 => {
                let number = u16::try_from(data).ok()?;
                Some((format!("[{number}]"), Trust::Printed))
            }
            Self::Signed16 => {
                // A controller may send -1 with 16 bits (0x0000FFFF) or extended to 32 bits (0xFFFFFFFF).
                let number = u16::try_from(data).map(u16::cast_signed);
                let number = number.or_else(|_| i16::try_from(data.cast_signed())).ok()?;
                Some((format!("[{number}]"), Trust::Printed))
            }
            Self::Bits(width) => (data >> width == 0).then(|| (pattern(data, width), Trust::Printed)),
            Self::Axes(names) => {
                let count = u32::try_from(names.len()).ok()?;
                let set: String =
                    names.iter().zip(0..).filter(|(_, bit)| is_set(data, *bit)).map(|(n, _)| *n).collect();
                (data >> count == 0).then(|| (bracketed(&set), Trust::Inferred))
            }
            Self::Groups => {
                let robots = u32::from(Group::counts(model).0);
                let name = |bit| if bit < robots { format!("R{}", bit + 1) } else { format!("(bit {bit})") };
                let set: String = (0..u32::BITS).filter(|bit| is_set(data, *bit)).map(name).collect();
                Some((bracketed(&set), Trust::Inferred))
            }
            Self::Unknown => (data == 0).then(|| (String::new(), Trust::Raw)),
        }
    }
}

impl fmt::Display for SubCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { data, text, trust, .. } = self;
        match trust {
            _ if text.is_empty() => Ok(()),
            Trust::Printed => f.write_str(text),
            Trust::Inferred => write!(f, "{text}? ({data} = {data:#x})"),
            Trust::Raw => write!(f, "{data} = {data:#x} (not decoded; bytes {text})"),
        }
    }
}

fn is_set(data: u32, bit: u32) -> bool {
    data >> bit & 1 == 1
}

/// Puts a set of names in brackets, as on the pendant. An empty set gives an empty text.
fn bracketed(set: &str) -> String {
    if set.is_empty() { String::new() } else { format!("[{set}]") }
}

/// Formats bits as on the pendant, highest bit first, for example `[0000_0001]`.
fn pattern(data: u32, width: u32) -> String {
    let mut text = String::from("[");
    for bit in (0..width).rev() {
        text.push(if is_set(data, bit) { '1' } else { '0' });
        if bit > 0 && bit % 4 == 0 {
            text.push('_');
        }
    }
    text.push(']');
    text
}

/// Bytes in the order of arrival, lowest byte first.
fn bytes(data: u32) -> String {
    let [a, b, c, d] = data.to_le_bytes();
    format!("{a:02x} {b:02x} {c:02x} {d:02x}")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn dx200(alarm_type: u32, data: u32) -> (String, Trust) {
        let found = render(AlarmKind(alarm_type), data, Model::Dx200);
        assert_eq!((found.alarm_type, found.data), (alarm_type, data));
        (found.text, found.trust)
    }

    #[test]
    fn the_examples_that_the_manuals_print() {
        for (alarm_type, data, text) in [
            (0, 0, ""),
            (1, 1, "[1]"),
            (2, 1, "[0000_0001]"),
            (6, 123, "[123]"),
            (9, 0xFFFF, "[-1]"),
            (9, 0xFFFF_FFFF, "[-1]"),
            (10, 1, "[0000_0000_0000_0001]"),
        ] {
            assert_eq!(dx200(alarm_type, data), (text.to_owned(), Trust::Printed), "type {alarm_type}");
        }
        for (alarm_type, data, text) in
            [(3, 0x3F, "[SLURBT]"), (4, 0x07, "[XYZ]"), (5, 0x3F, "[XYZRxRyRz]"), (11, 1, "[R1]")]
        {
            assert_eq!(dx200(alarm_type, data), (text.to_owned(), Trust::Inferred), "type {alarm_type}");
        }
    }

    #[test]
    fn subsets_list_their_members() {
        assert_eq!(dx200(3, 0b10_0101).0, "[SUT]");
        assert_eq!(dx200(3, 0x41).0, "[SE]");
        assert_eq!(dx200(5, 0b01_0010).0, "[YRy]");
        assert_eq!(dx200(2, 0xA5).0, "[1010_0101]");
        assert_eq!(dx200(3, 0).0, "");
    }

    #[test]
    fn other_groups_keep_their_bit_number() {
        assert_eq!(dx200(8, 0x0101).0, "[R1(bit 8)]");
        assert_eq!(render(AlarmKind(8), 0b111, Model::Fs100).text, "[R1R2(bit 2)]");
        assert_eq!(dx200(12, 0x8000_0000).0, "[(bit 31)]");
    }

    #[test]
    fn composed_types_stay_raw() {
        for alarm_type in [20, 21, 22, 23, 24, 25, 27] {
            assert_eq!(dx200(alarm_type, 0x0003_3F01), ("01 3f 03 00".to_owned(), Trust::Raw));
            assert_ne!(render(AlarmKind(alarm_type), 0, Model::Dx200).type_name, "undocumented type");
        }
    }

    #[test]
    fn shows_unsuitable_values_raw() {
        for (alarm_type, data) in [
            (0, 5),
            (1, 0x1_0000),
            (2, 0x100),
            (3, 0x100),
            (4, 8),
            (5, 0x40),
            (6, 0x1_0000),
            (9, 0x8000_0000),
            (10, 0x1_0000),
        ] {
            assert_eq!(dx200(alarm_type, data), (bytes(data), Trust::Raw), "type {alarm_type}");
        }
        assert_eq!(render(AlarmKind(26), 7, Model::Dx200).type_name, "undocumented type");
    }

    #[test]
    fn uncertain_text_includes_the_raw_value() {
        let shown = |alarm_type, data| render(AlarmKind(alarm_type), data, Model::Dx200).to_string();
        assert_eq!(shown(1, 3), "[3]");
        assert_eq!(shown(3, 3), "[SL]? (3 = 0x3)");
        assert_eq!(shown(20, 0x3F01), "16129 = 0x3f01 (not decoded; bytes 01 3f 00 00)");
        assert_eq!(shown(0, 0), "");
    }

    #[test]
    fn nineteen_types_ascending() {
        assert!(TYPES.is_sorted_by(|a, b| a.0 < b.0));
    }

    proptest! {
        #[test]
        fn any_value_is_shown(alarm_type in 0_u32..40, data: u32) {
            let found = render(AlarmKind(alarm_type), data, Model::Dx200);
            prop_assert!(found.text.is_ascii());
            prop_assert_eq!(found.text.is_empty(), found.to_string().is_empty());
            prop_assert!(data == 0 || !found.text.is_empty());
        }
    }
}

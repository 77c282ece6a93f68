//! The 104 error codes (TO 4-1) in the answers to STAS SNO=1 (status page 1) and EHTR (error history).
//!
//! The manual has only the names of the codes. The causes and remedies are those that are usual for machines of this
//! kind.

use std::borrow::Cow;

/// No error. The table of the manual does not contain this code, but sample session 3-1 does (ambiguity R26).
pub const NONE: u8 = 0x00;

/// Description of an error code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Explanation {
    /// The code.
    pub code: u8,
    /// Whether the error table of the manual contains this code.
    pub known: bool,
    /// Name of the error. It includes the axis of an axis error.
    pub name: Cow<'static, str>,
    /// Axis 1 to 4 of an axis error.
    pub axis: Option<u8>,
    /// Possible cause.
    pub cause: &'static str,
    /// What to do.
    pub remedy: &'static str,
}

impl Explanation {
    /// Formats the explanation as one line, for example `28: axis 1: beyond the plus soft limit while moving`.
    pub fn in_a_line(&self) -> String {
        format!("{:02X}: {}", self.code, self.name)
    }
}

/// Describes a code. Unknown codes also have a description.
pub fn explain(code: u8) -> Explanation {
    let (axis, row) = match code {
        0x20..=0x5F => {
            let row = AXIS.iter().find(|(low, ..)| *low == code & 0x0F);
            (Some(code / 0x10 - 1), row.map(|(_, name, cause, remedy)| (*name, *cause, *remedy)))
        }
        0xC0..=0xC7 => {
            let name =
                if code & 1 == 0 { "target beyond the plus soft limit" } else { "target beyond the minus soft limit" };
            (Some((code - 0xC0) / 2 + 1), Some((name, LIMIT_CAUSE, LIMIT_REMEDY)))
        }
        _ => {
            let row = WITHOUT_AXIS.iter().find(|(other, ..)| *other == code);
            (None, row.map(|(_, name, cause, remedy)| (*name, *cause, *remedy)))
        }
    };
    match (axis, row) {
        (Some(axis), Some((name, cause, remedy))) => Explanation {
            code,
            known: true,
            name: format!("axis {axis}: {name}").into(),
            axis: Some(axis),
            cause,
            remedy,
        },
        (None, Some((name, cause, remedy))) => {
            Explanation { code, known: true, name: name.into(), axis: None, cause, remedy }
        }
        (_, None) => Explanation {
            code,
            known: false,
            name: "not in the manual's table".into(),
            axis: None,
            cause: "the software of the controller may be newer than the manual",
            remedy: "look up the code in the manual of this controller",
        },
    }
}

/// All codes of the table, in ascending order.
pub fn all() -> impl Iterator<Item = Explanation> {
    (1..=u8::MAX).map(explain).filter(|explanation| explanation.known)
}

const LIMIT_CAUSE: &str = "the target position is outside the soft limits";
const LIMIT_REMEDY: &str =
    "correct the coordinates or the offset; `toyo param get soft-limit-plus soft-limit-minus` shows the limits";
const DRIVE: &str = "cancel the error and try at low speed; if the error comes again, check the driver, the motor and \
                     the cables";
const MEMORY: &str = "the stored data are damaged: restore the data from a backup. If the error comes again, replace \
                      the battery or the memory";
const PROGRAM: &str = "`toyo program get` and `toyo program check` show the step; correct the program";

type Text = &'static str;

/// Axis errors by their low digit; the high digit is the axis plus 1.
#[rustfmt::skip] // Six lines per row would hide the table.
const AXIS: [(u8, Text, Text, Text); 14] = [
    (0x0, "communication error", "the controller lost contact with the driver of the axis", DRIVE),
    (0x1, "overspeed", "the axis exceeded its speed limit", "lower the speed or the gains; check the encoder"),
    (0x2, "overcurrent", "the motor drew too much current", DRIVE),
    (0x3, "overload", "the load was too heavy for too long",
        "free the axis; lower the load, the speed or the acceleration"),
    (0x4, "overflow", "the following error of the axis is too large",
        "free the axis; lower the speed or the acceleration; check the brake"),
    (0x6, "encoder error", "the encoder sends no valid signal",
        "check the encoder cable; then switch the power off and on"),
    (0x7, "return to origin failed", "the origin was not found",
        "check the origin sensor, its logic and the path to it"),
    (0x8, "beyond the plus soft limit while moving", "the axis was about to leave its range", LIMIT_REMEDY),
    (0x9, "beyond the minus soft limit while moving", "the axis was about to leave its range", LIMIT_REMEDY),
    (0xA, "overvoltage", "braking returned more energy than can be absorbed",
        "lower the speed or the deceleration; check the regeneration resistor"),
    (0xB, "motor too hot", "the motor is overloaded or not cooled", "let the motor cool; lower the load or the duty"),
    (0xC, "encoder backup lost", "the absolute position was lost, usually because the battery is empty",
        "change the battery, then return to the origin"),
    (0xD, "encoder switching error", "the encoder could not be switched over",
        "switch the power off and on; check the encoder cable"),
    (0xF, "driver error", "the driver reports a fault", DRIVE),
];

/// Errors without an axis.
#[rustfmt::skip] // Six lines per row would hide the table.
const WITHOUT_AXIS: [(u8, Text, Text, Text); 40] = [
    (0x12, "watchdog timer", "the controller's software did not answer in time", "switch the power off and on"),
    (0x13, "emergency stop", "the emergency stop is or was pressed",
        "make sure that the area is safe, release the emergency stop, then run `toyo alarm reset`"),
    (0x60, "continuous run failed", "the program could not continue from its stop position",
        "start the program from a step: `toyo run sequential STEP`"),
    (0x61, "return to origin not done", "the position of the axes is unknown", "run `toyo home` first"),
    (0x62, "cannot be executed", "the mode or the state does not allow the command",
        "`toyo status` shows the mode, the servo state and the errors"),
    (0x63, "task cannot be started", "the task already runs or has no steps",
        "check the program and parameter E22 (task-steps)"),
    (0x64, "synchronized axes: origin not searched", "the position of the synchronized axes is unknown",
        "run `toyo home --sync AXIS` first"),
    (0x65, "synchronized axes: too far apart", "the distance between the axes is too large",
        "check the mechanics and parameter P18 (sync-error)"),
    (0x66, "synchronized axes: wrong parameter", "parameter E26 (sync-axes) is not consistent",
        "the driven axis must follow its drive axis"),
    (0x67, "synchronized axes: origin search failed", "the origin was not found", "check the origin sensors"),
    (0x90, "identification", "the stored identification is wrong", MEMORY),
    (0x91, "memory of sequential programs", "stored data are damaged", MEMORY),
    (0x92, "memory of palletizing programs", "stored data are damaged", MEMORY),
    (0x93, "memory of parameters", "stored data are damaged", MEMORY),
    (0x94, "memory of the coordinate table", "stored data are damaged", MEMORY),
    (0x95, "memory of the speed table", "stored data are damaged", MEMORY),
    (0x96, "memory of the acceleration table", "stored data are damaged", MEMORY),
    (0x97, "memory of the MVM table", "stored data are damaged", MEMORY),
    (0x98, "memory of easy programs", "stored data are damaged", MEMORY),
    (0x99, "identification of a slave", "a slave station does not match the setup",
        "check the I/O stations and their cables"),
    (0xA0, "instruction not possible", "this controller or this task does not support the instruction", PROGRAM),
    (0xA1, "tag undefined", "a jump or call uses a tag that does not exist", PROGRAM),
    (0xA2, "tag defined twice", "the same tag appears more than once", PROGRAM),
    (0xA3, "stack overflow", "calls are nested too deep", PROGRAM),
    (0xA4, "stack underflow", "a return without a call", PROGRAM),
    (0xA5, "too few points for an arc", "an arc needs three points", PROGRAM),
    (0xA6, "radius of an arc too large", "the three points are almost on a straight line", PROGRAM),
    (0xA7, "calculation error", "a value is out of range", PROGRAM),
    (0xA8, "parameter error", "a parameter has an invalid value", "`toyo param list` shows the parameters"),
    (0xB0, "step number", "there is no such step", PROGRAM),
    (0xB1, "tag number", "there is no such tag number", PROGRAM),
    (0xB2, "palletizing program number", "there is no such palletizing program", PROGRAM),
    (0xB3, "counter number", "there is no such counter", PROGRAM),
    (0xB4, "timer number", "there is no such timer", PROGRAM),
    (0xB5, "port number", "there is no such port", PROGRAM),
    (0xB6, "table number", "there is no such row of a table", PROGRAM),
    (0xB7, "group number", "there is no such MVM group", PROGRAM),
    (0xB9, "easy program number", "there is no such easy program", PROGRAM),
    (0xBA, "task number", "there is no such task", PROGRAM),
    (0xE0, "other error", "the controller reports no details", "read the display of the teach pendant"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_has_104_codes() {
        assert_eq!(all().count(), 104);
        for gap in [0x00, 0x25, 0x2E, 0x5E, 0xB8, 0xC8, 0xFF] {
            assert!(!explain(gap).known, "{gap:02X}");
        }
    }

    #[test]
    fn digits_of_an_axis_error_are_axis_and_kind() {
        let lines = [0x20, 0x28, 0x5D, 0xC3].map(|code| explain(code).in_a_line());
        assert_eq!(lines[0], "20: axis 1: communication error");
        assert_eq!(lines[1], "28: axis 1: beyond the plus soft limit while moving");
        assert!(lines[2].starts_with("5D: axis 4: "), "{}", lines[2]);
        assert_eq!(lines[3], "C3: axis 2: target beyond the minus soft limit");
    }

    #[test]
    fn codes_name_their_axis() {
        assert_eq!(explain(0x38).in_a_line(), "38: axis 2: beyond the plus soft limit while moving");
        // The manual prints "+" also for C3 (ambiguity R25).
        assert_eq!(explain(0xC3).in_a_line(), "C3: axis 2: target beyond the minus soft limit");
        assert_eq!(explain(0xC6).axis, Some(4));
        assert_eq!(explain(0x13).axis, None);
    }
}

//! Parameters that remote commands can read and write (4.4.2). The numbers 261 and 263 are not in the list of the
//! manual.

/// One parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Parameter {
    /// Number of the parameter.
    pub number: u16,
    /// Name in the robot language.
    pub name: &'static str,
    /// Description.
    pub meaning: &'static str,
    /// Unit; empty if the manual has none.
    pub unit: &'static str,
    /// Whether the parameter belongs to an axis. If not, it belongs to the robot.
    pub per_axis: bool,
    /// Valid range. For the payload, the real maximum depends on the robot, and only the controller checks it.
    pub span: (i32, i32),
}

impl Parameter {
    /// The parameter with this number.
    pub fn from_number(number: i32) -> Option<&'static Self> {
        PARAMETERS.iter().find(|parameter| i32::from(parameter.number) == number)
    }
}

const PAYLOAD: (i32, i32) = (0, i32::MAX);
const DISTANCE: (i32, i32) = (1, 9_999_999);
const RATIO: (i32, i32) = (1, 100);

/// All parameters.
pub const PARAMETERS: [Parameter; 14] = [
    robot(1, "WEIGHT", "payload of the robot", "kg"),
    robot(2, "WEIGHTG", "payload of the robot", "g"),
    axis(257, "ACCEL", "acceleration coefficient", "", RATIO),
    // The manual spells this name with two C.
    axis(258, "DECCEL", "deceleration ratio", "", RATIO),
    axis(259, "TOLE", "tolerance", "pulses", (1, 16_384)),
    axis(260, "OUTPOS", "OUT effective position", "pulses", DISTANCE),
    axis(262, "AXWGHT", "payload of the axis", "kg", PAYLOAD),
    axis(264, "ARCHP1", "arch start position", "pulses", DISTANCE),
    axis(265, "ARCHP2", "arch end position", "pulses", DISTANCE),
    axis(266, "PSHFRC", "push force", "", (-1000, 1000)),
    axis(267, "PSHTIME", "push time", "", (1, 32_767)),
    axis(268, "PSHMTD", "push method: 0 off, 1 on", "", (0, 1)),
    axis(269, "PSHJGSP", "push judgment speed ratio: 0 off", "", (0, 100)),
    axis(270, "PSHSPD", "push speed ratio", "", RATIO),
];

pub(super) const NAMES: [(u16, &str); PARAMETERS.len()] = {
    let mut names = [(0, ""); PARAMETERS.len()];
    let mut at = 0;
    while at < names.len() {
        names[at] = (PARAMETERS[at].number, PARAMETERS[at].name);
        at += 1;
    }
    names
};

type Text = &'static str;

const fn robot(number: u16, name: Text, meaning: Text, unit: Text) -> Parameter {
    Parameter { number, name, meaning, unit, per_axis: false, span: PAYLOAD }
}

const fn axis(number: u16, name: Text, meaning: Text, unit: Text, span: (i32, i32)) -> Parameter {
    Parameter { number, name, meaning, unit, per_axis: true, span }
}

//! Alarms: a group and a category, written as in `12.600` (chapter 2, section 1.2).
//!
//! The remote I/O manual names only a few alarms, and refers to the controller manual for the others. The names of
//! groups and fieldbus alarms are general knowledge about these controllers. Causes and remedies follow from the remote
//! I/O manual, or are hints.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// An alarm number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Alarm {
    /// Alarm group. A controller sends it in WO1 after an abnormal end.
    pub group: u16,
    /// Category within the group. A controller sends it in WO2 after an abnormal end.
    pub category: u16,
}

/// Description of an alarm.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Known {
    /// Number of the alarm.
    pub alarm: Alarm,
    /// Message text.
    pub text: &'static str,
    /// Usual causes; empty if no source has a cause.
    pub causes: &'static [&'static str],
    /// Remedies.
    pub remedies: &'static [&'static str],
}

/// An invalid alarm number.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("'{found}' is not a valid alarm number, for example 12.600")]
pub struct AlarmError {
    /// The invalid text.
    pub found: String,
}

/// Alarm after the stop input ended a motion (4.2.6).
pub const STOP_INPUT: Alarm = Alarm::new(12, 400);
/// Alarm if the words of the command are invalid (4.2.1).
pub const INPUT_FORMAT: Alarm = Alarm::new(4, 202);

impl Alarm {
    /// An alarm by group and category.
    pub const fn new(group: u16, category: u16) -> Self {
        Self { group, category }
    }

    /// Description of the group.
    pub fn group_text(self) -> Option<&'static str> {
        GROUPS.iter().find(|(group, _)| *group == self.group).map(|(_, text)| *text)
    }

    /// Description of this alarm; `None` if the alarm is unknown.
    pub fn known(self) -> Option<&'static Known> {
        KNOWN.iter().find(|known| known.alarm == self)
    }

    /// For the alarm of a lost link: the alarm that follows if the link stays lost for too long.
    #[must_use]
    pub const fn too_long(self) -> Self {
        Self::new(self.group, self.category + 1)
    }

    /// Text of the alarm, or of its group if the alarm is unknown.
    pub fn text(self) -> &'static str {
        self.known().map(|known| known.text).or_else(|| self.group_text()).unwrap_or("unknown alarm group")
    }
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.group, self.category)
    }
}

impl FromStr for Alarm {
    type Err = AlarmError;

    /// Parses `12.600` or `12:600`. The manual uses both forms (4.7.17).
    fn from_str(text: &str) -> Result<Self, AlarmError> {
        let number = |digits: &str| if digits.starts_with('+') { None } else { digits.parse().ok() };
        text.split_once(['.', ':'])
            .and_then(|(group, category)| Some(Self::new(number(group)?, number(category)?)))
            .ok_or_else(|| AlarmError { found: text.chars().take(40).collect() })
    }
}

/// Names of the alarm groups, by group number.
const GROUPS: [(u16, &str); 17] = [
    (0, "operation message"),
    (1, "system event"),
    (2, "robot operation"),
    (3, "program file"),
    (4, "data input"),
    (5, "program syntax"),
    (6, "program execution"),
    (9, "memory"),
    (10, "environment or hardware"),
    (12, "option board"),
    (14, "communication"),
    (17, "motor control"),
    (19, "YC-Link/E"),
    (21, "serious software fault"),
    (22, "serious hardware fault"),
    (26, "gripper"),
    (28, "driver interface"),
];

const LINK_CAUSES: &[&str] = &[
    "the master closed the connection or stopped sending",
    "a cable, a switch or the power supply of the network failed",
];
const LINK_REMEDIES: &[&str] =
    &["use a session to keep the connection open", "open the connection again, then reset the alarm"];
const UNIT_REMEDIES: &[&str] = &["switch the controller off and on", "check the option unit and its settings"];

/// Alarms that the sources name, with causes and remedies.
#[rustfmt::skip] // Eight lines per row would hide the table.
pub const KNOWN: [Known; 19] = [
    known(Alarm::new(2, 334), "over soft limit",
        &["the target or the path to it is outside the range of an axis"],
        &["check the point and the soft limits", "jog the axis back into its range"]),
    known(INPUT_FORMAT, "input format error",
        &["a word of the command has an invalid value, for example both position outputs at once"],
        &["compare the sent words with the manual section of the command; `armctl decode yrcx` shows the words"]),
    known(Alarm::new(12, 75), "illegal remote command",
        &["the code in WI0 does not exist"],
        &["check the code, and that words arrive in the correct order and byte order"]),
    known(Alarm::new(12, 76), "remote command not enabled",
        &["the programming box has control: the controller accepts only commands that read (references)",
            "a safety setting disables the dedicated inputs and all remote commands"],
        &["give control back at the programming box", "check mode and safety settings"]),
    known(STOP_INPUT, "stopped by the stop input",
        &["SI(06) was switched off: the motion was stopped"],
        &["switch SI(06) on again before the next motion"]),
    link(541, "DeviceNet link error"),
    link(542, "DeviceNet link error lasted too long"),
    link(551, "EtherNet/IP link error"),
    link(552, "EtherNet/IP link error lasted too long"),
    link(561, "PROFIBUS link error"),
    link(562, "PROFIBUS link error lasted too long"),
    link(571, "PROFINET link error"),
    link(572, "PROFINET link error lasted too long"),
    known(Alarm::new(12, 600), "emergency stop on",
        &["an emergency stop was pressed, or SI(00) is off", "a connection was opened with SI(00) off"],
        &["release the emergency stop, switch SI(00) on, reset the alarm, switch the servos on"]),
    unit(761),
    unit(762),
    unit(763),
    unit(764),
    unit(765),
];

type Texts = &'static [&'static str];

const fn known(alarm: Alarm, text: &'static str, causes: Texts, remedies: Texts) -> Known {
    Known { alarm, text, causes, remedies }
}

const fn link(category: u16, text: &'static str) -> Known {
    known(Alarm::new(12, category), text, LINK_CAUSES, LINK_REMEDIES)
}

const fn unit(category: u16) -> Known {
    known(Alarm::new(12, category), "network unit did not initialize", &[], UNIT_REMEDIES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alarm_numbers_round_trip() {
        assert_eq!("12.600".parse(), Ok(Alarm::new(0x000C, 0x0258)));
        assert_eq!("2:334".parse(), Ok(Alarm::new(0x0002, 0x014E)));
        assert_eq!(Alarm::new(12, 75).to_string(), "12.75");
        for junk in ["", "12", "12.", ".6", "a.b", "-1.2", "1.2.3", "70000.1", "12.+6"] {
            assert!(junk.parse::<Alarm>().is_err(), "{junk}");
        }
    }

    #[test]
    fn texts_fall_back_to_the_group() {
        assert_eq!(Alarm::new(12, 600).text(), "emergency stop on");
        assert_eq!(Alarm::new(17, 1).text(), "motor control");
        assert_eq!(Alarm::new(99, 1).text(), "unknown alarm group");
    }
}

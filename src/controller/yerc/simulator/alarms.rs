//! Alarms: up to four active alarms, and a history of five classes (DX 3.3.1, 3.3.2, 3.3.37, 3.3.38).

use std::collections::VecDeque;

use encoding_rs::SHIFT_JIS;

use crate::yerc::Model;
use crate::yerc::payload::{Alarm, AlarmKind, AlarmTexts, Text};

pub(super) const ACTIVE: usize = 4;
/// Number of entries in each class of the history.
const HISTORY: usize = 100;
/// Difference between the first instance numbers of two classes. Each class begins at a multiple of this number, plus
/// 1.
const CLASS_STEP: u16 = 1000;

/// Class of the history.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Class {
    Major,
    Monitor,
    System,
    User,
    Offline,
}

impl Class {
    /// Class of an alarm number. Alarms 0001 to 3999 stop the controller. Alarms from 8000 on come from jobs and from
    /// the ladder.
    pub(super) fn from_code(code: u32) -> Self {
        match code {
            0..=3999 => Self::Major,
            4000..=7999 => Self::Monitor,
            8000..=8999 => Self::System,
            _ => Self::User,
        }
    }
}

/// An alarm with the texts for its code, sub-code and type. `name` replaces the default name.
pub(super) fn alarm(code: u32, data: u32, kind: u32, time: &str, name: Option<&str>) -> Alarm {
    let alarm = Alarm {
        code,
        data,
        kind: AlarmKind(kind),
        time: Text::cut(time.as_bytes()),
        name: Text::cut(&sjis(name.unwrap_or_else(|| known_name(code)))),
        texts: None,
    };
    let (sub_code, reversed) = sub_code(&alarm);
    let source = if (4300..4400).contains(&code) { "[SV#1]" } else { "" };
    let texts = AlarmTexts {
        source: Text::cut(source.as_bytes()),
        sub_code: Text::cut(sub_code.as_bytes()),
        reversed: Text::cut(reversed.as_bytes()),
    };
    Alarm { texts: Some(texts), ..alarm }
}

/// Active alarms and history.
#[derive(Debug, Clone, Default)]
pub(super) struct AlarmLog {
    active: VecDeque<Alarm>,
    history: [VecDeque<Alarm>; 5],
}

impl AlarmLog {
    pub(super) fn raise(&mut self, alarm: Alarm) {
        self.record(Class::from_code(alarm.code), alarm.clone());
        self.active.push_front(alarm);
        self.active.truncate(ACTIVE);
    }

    /// Adds the newest entry of the history.
    pub(super) fn record(&mut self, class: Class, alarm: Alarm) {
        let history = &mut self.history[class as usize];
        history.push_front(alarm);
        history.truncate(HISTORY);
    }

    pub(super) fn is_active(&self) -> bool {
        !self.active.is_empty()
    }

    /// Whether an alarm is active that only a restart clears.
    pub(super) fn major_is_active(&self) -> bool {
        self.active.iter().any(|alarm| Class::from_code(alarm.code) == Class::Major)
    }

    pub(super) fn clear(&mut self) {
        self.active.clear();
    }

    pub(super) fn active(&self) -> impl Iterator<Item = &Alarm> {
        self.active.iter()
    }

    /// Data of an active alarm. Instance 1 is the newest alarm, and instance 4 the oldest; other instances do not
    /// exist. For an empty slot, all bytes are zero.
    pub(super) fn current(&self, instance: u16) -> Option<Vec<u8>> {
        let place = usize::from(instance).checked_sub(1).filter(|&place| place < ACTIVE)?;
        Some(bytes_or_zeros(self.active.get(place)))
    }

    /// Data of a past alarm, for the instances 1-100, 1001-1100, and so on up to 4001-4100.
    pub(super) fn past(&self, instance: u16) -> Option<Vec<u8>> {
        let class = self.history.get(usize::from(instance / CLASS_STEP))?;
        let place = usize::from(instance % CLASS_STEP).checked_sub(1).filter(|&place| place < HISTORY)?;
        Some(bytes_or_zeros(class.get(place)))
    }
}

fn bytes_or_zeros(alarm: Option<&Alarm>) -> Vec<u8> {
    alarm.map_or_else(|| vec![0; Alarm::SIZE_WITH_TEXTS], Alarm::emit)
}

/// Encodes a text for a Japanese controller.
pub(super) fn sjis(text: &str) -> Vec<u8> {
    SHIFT_JIS.encode(text).0.into_owned()
}

fn known_name(code: u32) -> &'static str {
    match code {
        1300 => "SERVO CPU SYNCHRONIZING ERROR",
        4107 => "OUT OF RANGE (ABSO DATA)",
        4315 => "COLLISION DETECT",
        4328 => "SERVO TRACKING ERROR",
        4416 => "PULSE LIMIT (MIN./MAX.)",
        4446 => "OVER VARIABLE LIMIT",
        4448 => "UNDEFINED POSITION VARIABLE",
        4511 => "OUT OF RANGE (DROP-VALUE)",
        8000..=8999 => "USER ALARM (SYSTEM)",
        9000..=9999 => "USER ALARM (USER)",
        _ => "SIMULATED ALARM",
    }
}

/// Text of a sub-code by alarm type, and the characters that are displayed in reverse video (DX 3.3.1). The assignment
/// of bits to axes is specific to this simulator.
fn sub_code(alarm: &Alarm) -> (String, String) {
    const ROBOT: &[&str] = &["S", "L", "U", "R", "B", "T"];
    let names = match alarm.kind.0 {
        3 => ROBOT,
        21 => {
            let [min, max, robot, _] = alarm.data.to_le_bytes();
            let (low, low_reversed) = axes(ROBOT, min.into());
            let (high, high_reversed) = axes(ROBOT, max.into());
            let bare = |text: &str| text.trim_matches(['[', ']']).to_owned();
            let inner = |map: &str| map[1..map.len() - 1].to_owned();
            let head = format!("[R{robot}: MIN ");
            let reversed = "0".repeat(head.len()) + &inner(&low_reversed) + "000000" + &inner(&high_reversed) + "0";
            return (format!("{head}{}, MAX {}]", bare(&low), bare(&high)), reversed);
        }
        4 => &["X", "Y", "Z"],
        5 => &["X", "Y", "Z", "Rx", "Ry", "Rz"],
        8 => &["R1", "R2", "S1", "S2"],
        11 => &["R1"],
        12 => &["R1", "S1", "B1"],
        _ => {
            let text = alarm.sub_code(Model::Dx200).to_string();
            let reversed = "0".repeat(text.len());
            return (text, reversed);
        }
    };
    axes(names, alarm.data)
}

/// Sub-code of type 21 in the layout of this simulator: axes at the lower limit, axes at the upper limit, and the robot
/// number.
pub(super) fn limit_data(robot: u16, axis: usize, upper: bool) -> u32 {
    let bit = 1u32 << axis.min(7);
    u32::from(robot) << 16 | if upper { bit << 8 } else { bit }
}

/// Formats names in brackets. The pendant displays a name in reverse video if its bit is set.
fn axes(names: &[&str], bits: u32) -> (String, String) {
    let (mut text, mut reverse) = (String::from("["), String::from("0"));
    for (bit, name) in names.iter().enumerate() {
        text.push_str(name);
        reverse.push_str(&(if bits >> bit & 1 == 1 { "1" } else { "0" }).repeat(name.len()));
    }
    text.push(']');
    reverse.push('0');
    (text, reverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(kind: u32, data: u32) -> (String, String) {
        sub_code(&alarm(4315, data, kind, "", None))
    }

    #[test]
    fn the_alarm_of_vector_a01() {
        let alarm = alarm(4315, 3, 1, "2011/10/10 15:49", None);
        let bytes = alarm.emit();
        assert_eq!(bytes[..12], [0xDB, 0x10, 0, 0, 3, 0, 0, 0, 1, 0, 0, 0]);
        assert_eq!(&bytes[12..28], b"2011/10/10 15:49");
        assert_eq!(&bytes[28..44], b"COLLISION DETECT");
        assert_eq!(bytes.len(), 268);
    }

    #[test]
    fn decodes_sub_codes_by_alarm_type() {
        assert_eq!(texts(1, 3).0, "[3]");
        assert_eq!(texts(3, 0b10), ("[SLURBT]".into(), "00100000".into()));
        assert_eq!(texts(5, 0b1000).1, "00001100000");
        let (text, reversed) = texts(21, limit_data(1, 1, true));
        assert_eq!(text, "[R1: MIN SLURBT, MAX SLURBT]");
        assert_eq!(reversed.find('1'), text.rfind('L'));
        assert_eq!(reversed.len(), text.len());
    }

    #[test]
    fn the_fifth_alarm_pushes_out_the_first() {
        let mut log = AlarmLog::default();
        for code in 4001..=4005 {
            log.raise(alarm(code, 0, 0, "", None));
        }
        assert_eq!(log.current(1).unwrap()[..2], 4005u16.to_le_bytes());
        assert_eq!(log.current(4).unwrap()[..2], 4002u16.to_le_bytes());
        assert_eq!(log.current(5), None);
        assert_eq!(log.past(1005).unwrap()[..2], 4001u16.to_le_bytes());
    }
}

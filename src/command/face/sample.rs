//! What one look at a robot of any family finds, for a live view. Only reads make it.

use std::time::Duration;

use tokio::time::Instant;

use crate::command::face::overview::OverviewReport;
use crate::command::robot::alarm::Alarm;
use crate::output::view::Tone;

/// How much is asked, the least first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// What a line of a list shows.
    Summary,
    /// The same, with the axes and their torque: [`Sample::whole`] without signals, limits and errors of position that
    /// would have to be asked for.
    Axes,
    /// What a screen of its own shows.
    Full,
}

/// What was counted on a link since it was opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Frames, blocks or images that left.
    pub sent: u64,
    /// Those that came.
    pub received: u64,
    /// How often something went otherwise than it should: was late, doubled, garbled, lost or sent again.
    pub disturbances: u64,
}

impl Traffic {
    /// What was counted since that.
    #[must_use]
    pub fn since(self, before: Self) -> Self {
        Self {
            sent: self.sent.saturating_sub(before.sent),
            received: self.received.saturating_sub(before.received),
            disturbances: self.disturbances.saturating_sub(before.disturbances),
        }
    }

    /// With what was counted besides.
    pub fn add(&mut self, more: Self) {
        self.sent += more.sent;
        self.received += more.received;
        self.disturbances += more.disturbances;
    }
}

/// What was counted, in words, without what was not; nothing if that is all of it.
pub fn counted(counts: &[(u64, &str)]) -> Option<String> {
    let counted = counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}"));
    Some(counted.collect::<Vec<_>>().join(", ")).filter(|counted| !counted.is_empty())
}

/// What a look found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// The state in a line.
    pub line: OverviewReport,
    /// How long the first answer took; `None` where a look asks nothing, because the controller shows itself.
    pub answered_in: Option<Duration>,
    /// The alarms and errors that are present, the latest first, as far as they can be asked for.
    pub alarms: Vec<Alarm>,
    /// What [`Detail::Full`] asks for, and [`Detail::Axes`] in part.
    pub whole: Option<Whole>,
}

/// All that a screen has room for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Whole {
    /// States that are so or not so.
    pub indicators: Vec<Indicator>,
    /// Axes and coordinates.
    pub axes: Vec<Axis>,
    /// The unit of torques; `None` where the protocol has none.
    pub torque_unit: Option<&'static str>,
    /// Signals, by kind.
    pub banks: Vec<Bank>,
    /// What could not be asked, and why.
    pub not_asked: Option<&'static str>,
}

/// A state that is so or not so.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Indicator {
    /// In a word or two.
    pub name: &'static str,
    /// Whether it is so.
    pub is_on: bool,
    /// Whether that is as it should be.
    pub tone: Tone,
}

impl Indicator {
    /// An indicator that means this while it is on, and nothing while it is off.
    pub fn new(name: &'static str, is_on: bool, tone: Tone) -> Self {
        Self { name, is_on, tone: if is_on { tone } else { Tone::Plain } }
    }

    /// An indicator that is on in good times, and means this while it is off.
    pub fn should(name: &'static str, is_on: bool, off: Tone) -> Self {
        Self { name, is_on, tone: if is_on { Tone::Good } else { off } }
    }
}

/// An axis, or a coordinate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// `S`, `X`, `Rz`, `1`.
    pub name: String,
    /// Where it is.
    pub position: f64,
    /// What that is measured in.
    pub unit: &'static str,
    /// Digits behind the point.
    pub decimals: u8,
    /// Its soft limits, where they can be asked for.
    pub limits: Option<(f64, f64)>,
    /// Its torque, where there is one.
    pub torque: Option<f64>,
    /// How far it is from where it should be, in the same unit.
    pub error: Option<f64>,
}

/// Signals of a kind.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Bank {
    /// `inputs`, `outputs`.
    pub name: &'static str,
    /// Eight at a time.
    pub groups: Vec<SignalByte>,
}

/// Eight signals that stand together.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SignalByte {
    /// The number of the first one shown, or the name of all.
    pub label: String,
    /// From left to right, in the order of the manual.
    pub signals: [bool; 8],
}

impl SignalByte {
    /// The bits of a byte, the lowest first.
    pub fn rising(label: String, byte: u8) -> Self {
        Self { label, signals: [0, 1, 2, 3, 4, 5, 6, 7].map(|bit| byte >> bit & 1 == 1) }
    }

    /// The bits of a byte, the highest first.
    pub fn falling(label: String, byte: u8) -> Self {
        Self { label, signals: [7, 6, 5, 4, 3, 2, 1, 0].map(|bit| byte >> bit & 1 == 1) }
    }
}

/// Says what `asked` came to, and how long that took.
pub async fn clocked<T>(asked: impl Future<Output = T>) -> (T, Option<Duration>) {
    let began = Instant::now();
    let answer = asked.await;
    (answer, Some(began.elapsed()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lamp_has_its_tone_where_it_means_something() {
        assert_eq!(Indicator::new("alarm", true, Tone::Bad).tone, Tone::Bad);
        assert_eq!(Indicator::new("alarm", false, Tone::Bad).tone, Tone::Plain);
        assert_eq!(Indicator::should("CPU OK", true, Tone::Bad).tone, Tone::Good);
        assert_eq!(Indicator::should("CPU OK", false, Tone::Bad).tone, Tone::Bad);
    }

    #[test]
    fn eight_signals_stand_as_the_manual_has_them() {
        let first = |eight: SignalByte| eight.signals.iter().position(|on| *on);
        assert_eq!(first(SignalByte::rising("#10".to_owned(), 1)), Some(0));
        assert_eq!(first(SignalByte::falling("PN01".to_owned(), 1)), Some(7));
    }
}

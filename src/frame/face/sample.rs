//! Result of one poll of a robot of any family, for a live view. The poll only reads.

use std::time::Duration;

use tokio::time::Instant;

use crate::face::overview::OverviewReport;
use crate::output::view::Tone;
use crate::robot::alarm::Alarm;

/// Level of detail, the lowest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// Data for a line of a list.
    Summary,
    /// Also axes and torque: [`Sample::full`] without signals, limits and position errors that would need additional
    /// requests.
    Axes,
    /// Data for a full screen.
    Full,
}

/// Traffic counted on a link since it was opened.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Traffic {
    /// Frames, blocks or images sent.
    pub sent: u64,
    /// Frames, blocks or images received.
    pub received: u64,
    /// Number of disturbances: late, duplicate, corrupt, lost or repeated data.
    pub disturbances: u64,
}

impl Traffic {
    /// Difference to an earlier count.
    #[must_use]
    pub fn since(self, before: Self) -> Self {
        Self {
            sent: self.sent.saturating_sub(before.sent),
            received: self.received.saturating_sub(before.received),
            disturbances: self.disturbances.saturating_sub(before.disturbances),
        }
    }

    /// Adds another count.
    pub fn add(&mut self, more: Self) {
        self.sent += more.sent;
        self.received += more.received;
        self.disturbances += more.disturbances;
    }
}

/// Text of the non-zero counts; `None` if all counts are zero.
pub fn counter(counts: &[(u64, &str)]) -> Option<String> {
    let counted = counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}"));
    Some(counted.collect::<Vec<_>>().join(", ")).filter(|counted| !counted.is_empty())
}

/// Result of a poll.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sample {
    /// State in one line.
    pub line: OverviewReport,
    /// Response time of the first answer; `None` if nothing is requested, because the controller sends its state on
    /// its own.
    pub answered_in: Option<Duration>,
    /// Active alarms and errors, the latest first, as far as they can be read.
    pub alarms: Vec<Alarm>,
    /// Data of [`Detail::Full`], and part of it for [`Detail::Axes`].
    pub full: Option<Whole>,
}

/// Data for a full screen.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Whole {
    /// On/off states.
    pub indicators: Vec<Indicator>,
    /// Axes and coordinates.
    pub axes: Vec<Axis>,
    /// Unit of torques; `None` if the protocol has none.
    pub torque_unit: Option<&'static str>,
    /// Signals, by kind.
    pub banks: Vec<Bank>,
    /// Reason for missing data.
    pub not_asked: Option<&'static str>,
}

/// An on/off state.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Indicator {
    /// Short name.
    pub name: &'static str,
    /// Whether it is on.
    pub is_on: bool,
    /// Tone of this state.
    pub tone: Tone,
}

impl Indicator {
    /// Indicator with this tone while it is on, and no tone while it is off.
    pub fn new(name: &'static str, is_on: bool, tone: Tone) -> Self {
        Self { name, is_on, tone: if is_on { tone } else { Tone::Plain } }
    }

    /// Indicator that should be on, and has this tone while it is off.
    pub fn expected(name: &'static str, is_on: bool, off: Tone) -> Self {
        Self { name, is_on, tone: if is_on { Tone::Good } else { off } }
    }
}

/// An axis, or a coordinate.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Axis {
    /// `S`, `X`, `Rz`, `1`.
    pub name: String,
    /// Position.
    pub position: f64,
    /// Unit of the position.
    pub unit: &'static str,
    /// Number of decimals.
    pub decimals: u8,
    /// Soft limits, if they can be read.
    pub limits: Option<(f64, f64)>,
    /// Torque, if available.
    pub torque: Option<f64>,
    /// Position error (deviation), in the same unit.
    pub error: Option<f64>,
}

/// Signals of a kind.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Bank {
    /// `inputs`, `outputs`.
    pub name: &'static str,
    /// Groups of eight.
    pub groups: Vec<SignalByte>,
}

/// A group of eight signals.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SignalByte {
    /// Number of the first signal, or name of the group.
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

/// Returns the result of a request and its duration.
pub async fn clocked<T>(asked: impl Future<Output = T>) -> (T, Option<Duration>) {
    let start = Instant::now();
    let answer = asked.await;
    (answer, Some(start.elapsed()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indicator_tones_depend_on_the_expected_state() {
        assert_eq!(Indicator::new("alarm", true, Tone::Bad).tone, Tone::Bad);
        assert_eq!(Indicator::new("alarm", false, Tone::Bad).tone, Tone::Plain);
        assert_eq!(Indicator::expected("CPU OK", true, Tone::Bad).tone, Tone::Good);
        assert_eq!(Indicator::expected("CPU OK", false, Tone::Bad).tone, Tone::Bad);
    }

    #[test]
    fn orders_eight_signals_as_in_the_manual() {
        let first = |eight: SignalByte| eight.signals.iter().position(|on| *on);
        assert_eq!(first(SignalByte::rising("#10".to_owned(), 1)), Some(0));
        assert_eq!(first(SignalByte::falling("PN01".to_owned(), 1)), Some(7));
    }
}

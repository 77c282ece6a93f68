//! Options of a running simulator: the speed of its time, and a log of its motions.

use std::fmt;
use std::str::FromStr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use crate::Now;

/// Options of a running simulator. By default, its time is the real time, and it keeps no log.
#[derive(Debug, Clone, Default)]
pub struct RunOptions {
    /// Speed of the simulated time.
    pub speed: Speed,
    /// Log of the motions.
    pub motions: Option<MotionLog>,
}

/// Speed of the simulated time, in thousandths of the real time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Speed(u32);

/// Thousandths for the real time.
const REAL: u32 = 1000;
/// Highest speed, in thousandths.
const MAX_SPEED: f64 = 1_000_000.0;

impl Default for Speed {
    fn default() -> Self {
        Self(REAL)
    }
}

impl Speed {
    /// Simulated seconds in a second.
    pub fn factor(self) -> f64 {
        f64::from(self.0) / f64::from(REAL)
    }

    /// Simulated time at a real time after the start.
    pub(crate) fn simulated(self, real: Now) -> Now {
        nanoseconds(real.as_nanos().saturating_mul(self.0.into()) / u128::from(REAL))
    }

    /// Earliest real time at which the simulator reaches a simulated time.
    pub(crate) fn real(self, simulated: Now) -> Now {
        nanoseconds(simulated.as_nanos().saturating_mul(REAL.into()).div_ceil(self.0.into()))
    }
}

fn nanoseconds(count: u128) -> Now {
    u64::try_from(count).map_or(Now::MAX, Now::from_nanos)
}

impl fmt::Display for Speed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x", self.factor())
    }
}

/// Parses a factor such as `10x` or `0.5`.
impl FromStr for Speed {
    type Err = String;

    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the range is checked before the cast")]
    fn from_str(text: &str) -> Result<Self, String> {
        let factor = text.strip_suffix('x').unwrap_or(text).parse::<f64>().map(|factor| (factor * 1000.0).round());
        match factor {
            Ok(thousandths) if (1.0..=MAX_SPEED).contains(&thousandths) => Ok(Self(thousandths as u32)),
            _ => Err(format!("'{text}' is not a speed from 0.001x to 1000x, such as 10x")),
        }
    }
}

/// A motion that has ended.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Axes that moved: `R1` (yerc), robot `1` (yrcx), or empty for the axes of a toyo controller.
    pub group: String,
    /// Axis positions at the start.
    pub from: Vec<f64>,
    /// Axis positions at the end.
    pub to: Vec<f64>,
    /// Unit of the positions.
    pub unit: &'static str,
    /// Length of the path of the tool in mm, with the kinematics of the simulator; `None` for an external axis.
    pub distance_mm: Option<f64>,
    /// Simulated time at the start.
    pub began: Now,
    /// Simulated duration.
    pub took: Duration,
    /// Whether the motion reached its target.
    pub reached: bool,
}

/// Log of the motions of a simulator. The simulator may be in another thread.
#[derive(Debug, Clone, Default)]
pub struct MotionLog(Arc<Mutex<Vec<Motion>>>);

impl MotionLog {
    /// Maximum number of motions. Later motions are not recorded.
    const CAPACITY: usize = 100_000;

    /// Adds a motion. A command to the current position is no motion.
    pub(crate) fn push(&self, motion: Motion) {
        if motion.took.is_zero() && motion.from == motion.to {
            return;
        }
        let mut motions = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if motions.len() < Self::CAPACITY {
            motions.push(motion);
        }
    }

    /// Removes and returns the motions since the last call.
    pub fn take(&self) -> Vec<Motion> {
        std::mem::take(&mut *self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Two logs are equal if they are the same log.
impl PartialEq for MotionLog {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// Length of a path that `at` describes by the completed share, from 0 to 1.
pub(crate) fn path_length(at: impl Fn(f64) -> [f64; 3]) -> f64 {
    const PIECES: u32 = 64;
    let point = |piece: u32| at(f64::from(piece) / f64::from(PIECES));
    let piece = |number: u32| point(number).iter().zip(point(number + 1)).map(|(a, b)| (b - a).powi(2)).sum::<f64>();
    (0..PIECES).map(|number| piece(number).sqrt()).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simulated_time_reaches_the_wake_time() {
        for (text, factor) in [("10x", 10.0), ("0.3", 0.3), ("1x", 1.0), ("7x", 7.0)] {
            let speed: Speed = text.parse().unwrap();
            for at in [Now::ZERO, Now::from_nanos(1), Now::from_millis(333), Now::from_secs(86_401)] {
                let real = speed.real(at);
                assert!(speed.simulated(real) >= at, "{text} {at:?}");
                assert!((real.as_secs_f64() * factor - at.as_secs_f64()).abs() < 1e-6, "{text} {at:?}");
            }
        }
        assert_eq!(Speed::default().simulated(Now::from_nanos(7)), Now::from_nanos(7));
        for wrong in ["", "x", "0", "-1x", "1001x", "NaN", "inf"] {
            assert!(wrong.parse::<Speed>().is_err(), "{wrong}");
        }
        assert_eq!("2.5x".parse::<Speed>().unwrap().to_string(), "2.5x");
    }
}

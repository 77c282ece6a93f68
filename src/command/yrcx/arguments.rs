//! Arguments that motions share. Numbers are handed on as they were typed: the codec reads them in the unit of their
//! field and checks their range.

use clap::Args;

use super::position::Unit;
use crate::controller::yrcx::order::Draft;
use crate::controller::yrcx::value::Key;

/// How fast.
#[derive(Debug, Args)]
pub struct Pace {
    /// 50 or 50% of the program speed, or 200mm/s along a line or an arc
    #[arg(long, value_name = "SPEED", value_parser = speed)]
    pub speed: Option<Speed>,
    /// Percent of the robot's maximum, in steps of 0.01
    #[arg(long, value_name = "PERCENT", conflicts_with = "speed")]
    pub speed_of_max: Option<String>,
}

/// A speed as typed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Speed {
    /// Of the program speed.
    Percent(String),
    /// Of the tool.
    MmS(String),
}

fn speed(text: &str) -> Result<Speed, String> {
    let number = |text: &str| {
        let is_number = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        if is_number { Ok(text.to_owned()) } else { Err("a speed is whole percent as in 50 or 50%, or 200mm/s") }
    };
    let speed = match text.strip_suffix("mm/s") {
        Some(text) => number(text).map(Speed::MmS),
        None => number(text.strip_suffix('%').unwrap_or(text)).map(Speed::Percent),
    };
    speed.map_err(str::to_owned)
}

impl Pace {
    /// Fills it in.
    pub fn put(&self, draft: Draft) -> Draft {
        let draft = draft.with_some(Key::SpeedOfMax, self.speed_of_max.clone());
        match self.speed.clone() {
            None => draft,
            Some(Speed::Percent(text)) => draft.with(Key::SpeedPercent, text),
            Some(Speed::MmS(text)) => draft.with(Key::SpeedMmS, text),
        }
    }

    /// ` at 50 %`; empty unless given.
    pub fn told(&self) -> String {
        match (&self.speed, &self.speed_of_max) {
            (Some(Speed::Percent(percent)), _) => format!(" at {percent} %"),
            (Some(Speed::MmS(mm_s)), _) => format!(" at {mm_s} mm/s"),
            (None, Some(percent)) => format!(" at {percent} % of the maximum"),
            (None, None) => String::new(),
        }
    }
}

/// How quickly it gets going.
#[derive(Debug, Args)]
pub struct Ramps {
    /// Acceleration in percent
    #[arg(long, value_name = "PERCENT")]
    accel: Option<String>,
    /// Deceleration in percent
    #[arg(long, value_name = "PERCENT")]
    decel: Option<String>,
}

impl Ramps {
    /// Fills it in.
    pub fn put(&self, draft: Draft) -> Draft {
        draft.with_some(Key::Accel, self.accel.clone()).with_some(Key::Decel, self.decel.clone())
    }
}

/// What to tell at the end.
#[derive(Debug, Args)]
pub struct Ending {
    /// Report the position at the end, in this unit
    #[arg(long, value_name = "UNIT")]
    pub report: Option<Unit>,
    /// Do not wait for the end
    #[arg(long)]
    pub no_wait: bool,
}

impl Ending {
    /// Fills it in.
    pub fn put(&self, draft: Draft) -> Draft {
        draft.with_some(Key::Report, self.report.map(Unit::report))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_say_what_they_are_of() {
        assert_eq!(speed("50"), Ok(Speed::Percent("50".to_owned())));
        assert_eq!(speed("50%"), Ok(Speed::Percent("50".to_owned())));
        assert_eq!(speed("200mm/s"), Ok(Speed::MmS("200".to_owned())));
        for wrong in ["", "%", "mm/s", "-5", "5.5", "fast", "5 %"] {
            assert!(speed(wrong).is_err(), "{wrong}");
        }
    }
}

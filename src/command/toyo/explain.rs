//! `armctl explain toyo`: error codes in words.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::ValueKind;
use crate::command::face::explain::{self as face, Codes, Known};
use crate::command::robot::alarm::{Alarm, Besides, Kind, Source};
use crate::controller::toyo::errors;
use crate::controller::typed;
use crate::failure::Failure;
use crate::settings::alarms::{Alarms, Origin};
use crate::settings::target::Family;

/// Error code of a Toyo controller
#[derive(Debug, Args)]
pub struct Explain {
    /// The code in hexadecimal, as in 28 or 0xA1
    #[arg(value_parser = code, add = ValueKind::Code(Family::Toyo))]
    code: u8,
}

/// Two hexadecimal digits.
fn code(text: &str) -> Result<u8, String> {
    typed::code(text).ok_or_else(|| "a code is two hexadecimal digits, as in 28; `toyo status` shows it".to_owned())
}

impl face::Explain for Explain {
    type Report = Codes<Axis>;
    const ID: &'static str = "explain.toyo";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<Codes<Axis>, Failure> {
        let found = errors::explain(self.code);
        let none = Alarm { text: Some("no error".to_owned()), ..told(errors::NONE) };
        let (known, alarm, [cause, remedy]) = match self.code {
            errors::NONE => (true, none, ["nothing is wrong", "nothing is to be done"]),
            code => (found.known, told(code), [found.cause, found.remedy]),
        };
        let site = alarms.find(origin, alarm.code.as_deref().unwrap_or_default())?;
        Ok(Codes { codes: vec![Known::new(known, alarm, [&[cause], &[remedy]], site, Axis { axis: found.axis })] })
    }

    fn alarm(&self) -> Option<String> {
        (self.code != errors::NONE).then(|| format!("{:02X}", self.code))
    }
}

/// The axis that a code is about.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Axis {
    /// Null where it is about none.
    axis: Option<u8>,
}

impl Besides for Axis {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        // The text names it.
        Vec::new()
    }
}

/// An error in this program's words.
pub fn told(code: u8) -> Alarm {
    let errors::Explanation { name, cause, remedy, .. } = errors::explain(code);
    Alarm {
        code: Some(format!("{code:02X}")),
        text: Some(name.into_owned()),
        kind: Some(Kind::Error),
        cause: Some(cause.to_owned()),
        remedy: Some(remedy.to_owned()),
        source: Source::Armctl,
        ..Alarm::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_two_digits() {
        assert_eq!((code("28"), code("0xa1"), code("5")), (Ok(0x28), Ok(0xA1), Ok(5)));
        for wrong in ["", "0x", "100", "+5", "G1", "2060"] {
            assert!(code(wrong).is_err(), "{wrong}");
        }
    }
}

//! `armctl explain toyo`: error codes in words.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::face::explain as face;
use crate::command::{Report, ValueKind};
use crate::controller::toyo::errors;
use crate::controller::typed;
use crate::failure::Failure;
use crate::output::view::{Section, View};
use crate::settings::alarms::{Alarms, Explanation, Origin};
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
    type Report = ToyoCode;
    const ID: &'static str = "explain.toyo";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<ToyoCode, Failure> {
        let code = ToyoCode::from(self.code);
        let explained = alarms.find(origin, &code.code)?;
        Ok(ToyoCode { explained, ..code })
    }

    fn alarm(&self) -> Option<String> {
        (self.code != errors::NONE).then(|| format!("{:02X}", self.code))
    }
}

/// An error code of a Toyo controller in words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ToyoCode {
    /// `28`.
    code: String,
    /// Whether it is in the manual's table.
    known: bool,
    /// What it is called.
    name: String,
    /// The axis it is about, if it is about one.
    axis: Option<u8>,
    /// What may have happened.
    cause: &'static str,
    /// What to do.
    remedy: &'static str,
    /// What `alarms.toml` says of it; null where it says nothing.
    explained: Option<Explanation>,
}

impl From<u8> for ToyoCode {
    fn from(code: u8) -> Self {
        if code == errors::NONE {
            let (name, cause, remedy) = ("no error".to_owned(), "nothing is wrong", "nothing is to be done");
            return Self { code: "00".to_owned(), known: true, name, axis: None, cause, remedy, explained: None };
        }
        let found = errors::explain(code);
        let (cause, remedy) = (found.cause, found.remedy);
        Self {
            code: format!("{code:02X}"),
            known: found.known,
            name: found.name.into(),
            axis: found.axis,
            cause,
            remedy,
            explained: None,
        }
    }
}

impl Report for ToyoCode {
    fn view(&self) -> View {
        let mut fields = vec![
            ("code", self.code.as_str().into()),
            ("meaning", self.name.as_str().into()),
            ("cause", self.cause.into()),
            ("what to do", self.remedy.into()),
        ];
        fields.extend(Explanation::field(self.explained.as_ref()));
        View::default().and(Section::Fields(fields))
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

//! `armctl explain FAMILY CODE`.

use clap::Subcommand;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::Report;
use crate::command::ValueKind;
use crate::command::run::{Run, Stopped};
use crate::controller::toyo::errors;
use crate::controller::typed;
use crate::controller::yerc::status;
use crate::controller::yrcx::alarm::Alarm;
use crate::failure::Failure;
use crate::output::view::{Section, View};
use crate::settings::target::Family;

/// Families whose codes are known.
#[derive(Debug, Subcommand)]
pub enum Explain {
    /// A status code (one byte) or added status code (two bytes) of an FS100 or DX200
    Yerc {
        /// The code in hexadecimal, as in 0x2060, 2060 or 1F
        #[arg(add = ValueKind::Code(Family::Yerc))]
        code: String,
    },
    /// An alarm of a YRCX
    Yrcx {
        /// Group and category, as in 12.600
        #[arg(value_parser = alarm, add = ValueKind::Code(Family::Yrcx))]
        code: Alarm,
    },
    /// An error code of a Toyo controller
    Toyo {
        /// The code in hexadecimal, as in 28 or 0xA1
        #[arg(value_parser = toyo_code, add = ValueKind::Code(Family::Toyo))]
        code: u8,
    },
}

impl Explain {
    pub(super) fn run(self, run: &Run) -> Result<(), Stopped> {
        match self {
            Self::Yerc { code } => {
                let found = status::lookup(&code).map_err(|error| {
                    Failure::usage(error.to_string()).hint("error messages and `alarm list` show the code to look up")
                })?;
                let codes = found.into_iter().map(Code::from).collect();
                run.local("explain.yerc", &Codes { codes })
            }
            Self::Yrcx { code } => run.local("explain.yrcx", &YrcxAlarm::of(code)),
            Self::Toyo { code } => run.local("explain.toyo", &ToyoCode::of(code)),
        }
    }
}

/// Two hexadecimal digits.
fn toyo_code(text: &str) -> Result<u8, String> {
    typed::code(text).ok_or_else(|| "a code is two hexadecimal digits, as in 28; `toyo status` shows it".to_owned())
}

/// Group and category.
fn alarm(text: &str) -> Result<Alarm, String> {
    text.parse().map_err(|error| format!("{error}"))
}

/// One or, for a short code that is in two tables, several explanations.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Codes {
    codes: Vec<Code>,
}

/// A code in words.
#[derive(Debug, Serialize, JsonSchema)]
struct Code {
    /// `0x2060`.
    code: String,
    /// Whether it is in the manuals' tables.
    known: bool,
    /// What it is called.
    name: String,
    /// What happened.
    cause: String,
    /// What to do.
    remedy: String,
    /// Models whose manual lists it.
    models: Vec<String>,
}

impl From<status::Explanation> for Code {
    fn from(found: status::Explanation) -> Self {
        Self {
            code: found.code_text,
            known: found.known,
            name: found.name.into_owned(),
            cause: found.cause.into_owned(),
            remedy: found.remedy.into_owned(),
            models: found.models.iter().map(ToString::to_string).collect(),
        }
    }
}

impl Report for Codes {
    fn view(&self) -> View {
        let sections = self.codes.iter().map(|code| {
            let models = if code.models.is_empty() { "-".to_owned() } else { code.models.join(", ") };
            Section::Fields(vec![
                ("code", code.code.as_str().into()),
                ("meaning", code.name.as_str().into()),
                ("cause", code.cause.as_str().into()),
                ("what to do", code.remedy.as_str().into()),
                ("listed for", models.into()),
            ])
        });
        View { sections: sections.collect() }
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
}

impl ToyoCode {
    fn of(code: u8) -> Self {
        if code == errors::NONE {
            let (name, cause, remedy) = ("no error".to_owned(), "nothing is wrong", "nothing is to be done");
            return Self { code: "00".to_owned(), known: true, name, axis: None, cause, remedy };
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
        }
    }
}

impl Report for ToyoCode {
    fn view(&self) -> View {
        View::fields([
            ("code", self.code.as_str().into()),
            ("meaning", self.name.as_str().into()),
            ("cause", self.cause.into()),
            ("what to do", self.remedy.into()),
        ])
    }
}

/// An alarm of a YRCX in words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct YrcxAlarm {
    /// `12.600`.
    code: String,
    /// Whether anything is known beyond its group.
    known: bool,
    /// What it says.
    name: &'static str,
    /// What its group is about; null for an unknown group.
    group: Option<&'static str>,
    /// What usually causes it.
    causes: &'static [&'static str],
    /// What to do.
    remedies: &'static [&'static str],
}

impl YrcxAlarm {
    fn of(alarm: Alarm) -> Self {
        let known = alarm.known();
        Self {
            code: alarm.to_string(),
            known: known.is_some(),
            name: alarm.text(),
            group: alarm.group_text(),
            causes: known.map_or(&[], |known| known.causes),
            remedies: known.map_or(
                &["look it up in the controller's manual: `yrcx info alarm` tells where it came up"],
                |known| known.remedies,
            ),
        }
    }
}

impl Report for YrcxAlarm {
    fn view(&self) -> View {
        let listed = |lines: &[&str]| if lines.is_empty() { "-".to_owned() } else { lines.join("; ") };
        View::fields([
            ("alarm", self.code.as_str().into()),
            ("meaning", self.name.into()),
            ("group", self.group.unwrap_or("-").into()),
            ("cause", listed(self.causes).into()),
            ("what to do", listed(self.remedies).into()),
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_toyo_code_is_two_digits() {
        assert_eq!((toyo_code("28"), toyo_code("0xa1"), toyo_code("5")), (Ok(0x28), Ok(0xA1), Ok(5)));
        for wrong in ["", "0x", "100", "+5", "G1", "2060"] {
            assert!(toyo_code(wrong).is_err(), "{wrong}");
        }
    }
}

//! `armctl explain yerc`: status codes in words.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::face::explain as face;
use crate::command::{Report, ValueKind};
use crate::controller::yerc::status;
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, View};
use crate::settings::alarms::{Alarms, Explanation, Origin};
use crate::settings::target::Family;

/// Status code (1 byte) or added status code (2 bytes) of an FS100, DX100, DX200 or YRC1000
#[derive(Debug, Args)]
pub struct Explain {
    /// The code in hexadecimal, as in 0x2060, 2060 or 1F
    #[arg(add = ValueKind::Code(Family::Yerc))]
    code: String,
}

impl face::Explain for Explain {
    type Report = Codes;
    const ID: &'static str = "explain.yerc";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<Codes, Failure> {
        let mut found = status::lookup(&self.code).map_err(|error| {
            Failure::usage(error.to_string()).hint("error messages and `alarm list` show the code to look up")
        })?;
        let number = alarm_number(&self.code);
        if number.is_some() {
            // What is no status code of the manuals is an alarm number, as people read it on the pendant.
            found.retain(|explanation| explanation.known);
        }
        let mut codes: Vec<Code> = found.into_iter().map(Code::from).collect();
        if let Some(number) = number {
            codes.push(Code::of_alarm(number, alarms, origin)?);
        }
        Ok(Codes { codes })
    }

    fn alarm(&self) -> Option<String> {
        alarm_number(&self.code).map(|number| number.to_string())
    }
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

/// The number of an alarm, 1 to 9999 in decimal.
fn alarm_number(text: &str) -> Option<u32> {
    let is_number = (3..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|number| is_number && *number > 0)
}

impl Code {
    /// An alarm number: what `alarms.toml` says of it, or where to look.
    fn of_alarm(number: u32, alarms: &Alarms, origin: Origin<'_>) -> Result<Self, Failure> {
        let code = number.to_string();
        let found = alarms.find(origin, &code)?;
        let known = found.is_some();
        let (name, cause, remedy) = match found {
            Some(Explanation { text, cause, remedy }) => (text, cause, remedy),
            None => ("an alarm number".to_owned(), None, None),
        };
        let look = "the controller's maintenance manual has it, and the controller its text: `armctl yerc alarm list`";
        Ok(Self {
            code,
            known,
            name,
            cause: cause.unwrap_or_default(),
            remedy: remedy.unwrap_or_else(|| look.to_owned()),
            models: Vec::new(),
        })
    }
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
                ("cause", Cell::maybe(Some(code.cause.as_str()).filter(|cause| !cause.is_empty()))),
                ("what to do", code.remedy.as_str().into()),
                ("listed for", models.into()),
            ])
        });
        View { sections: sections.collect() }
    }

    fn rows(&self) -> RowsOf {
        RowsOf::List("codes")
    }
}

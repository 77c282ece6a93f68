//! `armctl explain yerc`: status codes in words.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::{OfflineCommand, Report, ValueKind};
use crate::controller::yerc::status;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::{Section, View};
use crate::settings::target::Family;

/// Status code (1 byte) or added status code (2 bytes) of an FS100 or DX200
#[derive(Debug, Args)]
pub struct Explain {
    /// The code in hexadecimal, as in 0x2060, 2060 or 1F
    #[arg(add = ValueKind::Code(Family::Yerc))]
    code: String,
}

impl OfflineCommand for Explain {
    type Report = Codes;
    const ID: &'static str = "explain.yerc";

    fn run(&self, _screen: &Screen) -> Result<Codes, Failure> {
        let found = status::lookup(&self.code).map_err(|error| {
            Failure::usage(error.to_string()).hint("error messages and `alarm list` show the code to look up")
        })?;
        Ok(Codes { codes: found.into_iter().map(Code::from).collect() })
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

//! `armctl explain yrcx`: alarms, and what devices of a fieldbus say no with, in words.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::buses::BUSES;
use super::fieldbus::Explained;
use crate::command::face::explain as face;
use crate::command::{Report, ValueKind};
use crate::controller::yrcx::alarm::Alarm;
use crate::failure::Failure;
use crate::output::view::{Section, View};
use crate::settings::alarms::{Alarms, Explanation, Origin};
use crate::settings::target::Family;

/// Alarm number of a YRCX, or error of a PROFINET device
#[derive(Debug, Args)]
pub struct Explain {
    /// Group and category, as in 12.600; or four bytes of PROFINET, as in 0xDB810209 or 'CF 81 FD 05'
    #[arg(value_parser = code, add = ValueKind::Code(Family::Yrcx))]
    code: Code,
}

/// What is explained.
#[derive(Debug, Clone)]
enum Code {
    Alarm(Alarm),
    Bus(Explained),
}

/// Group and category, or what a fieldbus knows.
fn code(text: &str) -> Result<Code, String> {
    if let Some(explained) = BUSES.iter().find_map(|bus| (bus.explain)(text)) {
        return Ok(Code::Bus(explained));
    }
    text.parse().map(Code::Alarm).map_err(|error| format!("{error}"))
}

impl face::Explain for Explain {
    type Report = YrcxAlarm;
    const ID: &'static str = "explain.yrcx";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<YrcxAlarm, Failure> {
        Ok(match self.code.clone() {
            Code::Alarm(alarm) => {
                let explained = alarms.find(origin, &alarm.to_string())?;
                YrcxAlarm { explained, ..alarm.into() }
            }
            Code::Bus(explained) => explained.into(),
        })
    }

    fn alarm(&self) -> Option<String> {
        if let Code::Alarm(alarm) = &self.code { Some(alarm.to_string()) } else { None }
    }
}

/// An alarm of a YRCX, or an error of a PROFINET device, in words.
#[derive(Debug, Serialize, JsonSchema)]
pub struct YrcxAlarm {
    /// `12.600`, `0xdb810209`.
    code: String,
    /// Whether anything is known beyond its group.
    known: bool,
    /// What it says.
    name: String,
    /// What its group is about, or what was refused; null for an unknown group.
    group: Option<&'static str>,
    /// What usually causes it.
    causes: &'static [&'static str],
    /// What to do.
    remedies: &'static [&'static str],
    /// What `alarms.toml` says of it; null where it says nothing.
    explained: Option<Explanation>,
}

impl From<Alarm> for YrcxAlarm {
    fn from(alarm: Alarm) -> Self {
        let known = alarm.known();
        Self {
            code: alarm.to_string(),
            known: known.is_some(),
            name: alarm.text().to_owned(),
            group: alarm.group_text(),
            causes: known.map_or(&[], |known| known.causes),
            remedies: known.map_or(
                &["look it up in the controller's manual: `yrcx info alarm` tells where it came up"],
                |known| known.remedies,
            ),
            explained: None,
        }
    }
}

impl From<Explained> for YrcxAlarm {
    fn from(explained: Explained) -> Self {
        let Explained { code, meaning, refused, remedies } = explained;
        Self {
            code,
            known: meaning.is_some(),
            name: meaning.unwrap_or_else(|| "an error without words".to_owned()),
            group: Some(refused),
            causes: &[],
            remedies,
            explained: None,
        }
    }
}

impl Report for YrcxAlarm {
    fn view(&self) -> View {
        let listed = |lines: &[&str]| if lines.is_empty() { "-".to_owned() } else { lines.join("; ") };
        let mut fields = vec![
            (if self.code.starts_with("0x") { "error" } else { "alarm" }, self.code.as_str().into()),
            ("meaning", self.name.as_str().into()),
            ("group", self.group.unwrap_or("-").into()),
            ("cause", listed(self.causes).into()),
            ("what to do", listed(self.remedies).into()),
        ];
        fields.extend(Explanation::field(self.explained.as_ref()));
        View::default().and(Section::Fields(fields))
    }
}

//! `armctl explain yrcx`: alarms in words.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use crate::command::{OfflineCommand, Report, ValueKind};
use crate::controller::yrcx::alarm::Alarm;
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::View;
use crate::settings::target::Family;

/// Alarm number of a YRCX
#[derive(Debug, Args)]
pub struct Explain {
    /// Group and category, as in 12.600
    #[arg(value_parser = alarm, add = ValueKind::Code(Family::Yrcx))]
    code: Alarm,
}

/// Group and category.
fn alarm(text: &str) -> Result<Alarm, String> {
    text.parse().map_err(|error| format!("{error}"))
}

impl OfflineCommand for Explain {
    type Report = YrcxAlarm;
    const ID: &'static str = "explain.yrcx";

    fn run(&self, _screen: &Screen) -> Result<YrcxAlarm, Failure> {
        Ok(YrcxAlarm::from(self.code))
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

impl From<Alarm> for YrcxAlarm {
    fn from(alarm: Alarm) -> Self {
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

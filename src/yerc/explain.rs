//! `armctl explain yerc`: meaning of status codes.

use crate::prelude::*;
use armctl_controller::yerc::status;
use armctl_frame::face::explain::{self as face, Codes, Known};
use armctl_frame::robot::alarm::{Alarm, ExtraColumns, Kind, Source};
use armctl_frame::settings::alarms::{Alarms, Origin};

/// Status code (1 byte) or added status code (2 bytes) of an FS100, DX100, DX200 or YRC1000
#[derive(Debug, Args)]
pub struct Explain {
    /// Code in hexadecimal, for example 0x2060, 2060 or 1F
    #[arg(add = ValueKind::Code(Family::Yerc))]
    code: String,
}

impl face::Explain for Explain {
    type Report = Codes<Listed>;
    const ID: &'static str = "explain.yerc";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<Codes<Listed>> {
        let mut found = status::lookup(&self.code).map_err(|error| {
            Failure::usage(error.to_string()).hint("look up a code that an error message or `alarm list` shows")
        })?;
        let number = alarm_number(&self.code);
        if number.is_some() {
            // A number that is not a status code in the manuals is treated as an alarm number, in the form that the
            // pendant shows.
            found.retain(|explanation| explanation.known);
        }
        let mut codes: Vec<_> = found.iter().map(status_code).collect();
        if let Some(number) = number {
            codes.push(alarm(number, alarms, origin)?);
        }
        Ok(Codes { codes })
    }

    fn alarm(&self) -> Option<String> {
        alarm_number(&self.code).map(|number| number.to_string())
    }
}

/// Models whose manual lists a code.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Listed {
    /// Models whose manual lists the code; empty for an alarm number.
    models: Vec<String>,
}

impl ExtraColumns for Listed {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        vec![("listed for", Some(self.models.join(", ")).filter(|models| !models.is_empty()))]
    }
}

/// Parses an alarm number, 1 to 9999 in decimal.
fn alarm_number(text: &str) -> Option<u32> {
    let is_number = (3..=4).contains(&text.len()) && text.bytes().all(|byte| byte.is_ascii_digit());
    text.parse().ok().filter(|number| is_number && *number > 0)
}

/// Meaning of an alarm number from `alarms.toml`, or where the user can find it.
fn alarm(number: u32, alarms: &Alarms, origin: Origin<'_>) -> Result<Known<Listed>> {
    let code = number.to_string();
    let site = alarms.find(origin, &code)?;
    let lookup_hint = "look up the number in the controller's maintenance manual, or read the alarm text with `armctl \
                       yerc alarm list`";
    let text = site.is_none().then(|| "an alarm number".to_owned());
    let remedies: &[&str] = if site.as_ref().is_some_and(|site| site.remedy.is_some()) { &[] } else { &[lookup_hint] };
    let alarm = Alarm { code: Some(code), text, kind: Some(Kind::Alarm), source: Source::Armctl, ..Alarm::default() };
    Ok(Known::new(false, alarm, [&[], remedies], site, Listed { models: Vec::new() }))
}

/// Meaning of a status code in the manuals.
fn status_code(found: &status::Explanation) -> Known<Listed> {
    let alarm = Alarm {
        code: Some(found.code_text.clone()),
        text: Some(found.name.clone().into_owned()),
        kind: Some(Kind::Error),
        source: Source::Armctl,
        ..Alarm::default()
    };
    let [cause, remedy] = [found.cause.as_ref(), found.remedy.as_ref()];
    let causes: &[&str] = if cause.is_empty() { &[] } else { &[cause] };
    let own = Listed { models: found.models.iter().map(ToString::to_string).collect() };
    Known::new(found.known, alarm, [causes, &[remedy]], None, own)
}

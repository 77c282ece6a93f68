//! `armctl explain yrcx`: meaning of alarms and of fieldbus error codes.

use super::buses::BUSES;
use super::fieldbus::ErrorMeaning;
use super::info::describe_alarm;
use crate::prelude::*;
use armctl_frame::face::explain::{self as face, Codes, Known};
use armctl_frame::robot::alarm::{Alarm as CommandResults, ExtraColumns, Kind, Source};
use armctl_frame::settings::alarms::{Alarms, Origin};

/// Alarm number of a YRCX, or error of a PROFINET device
#[derive(Debug, Args)]
pub struct Explain {
    /// Group and category of the alarm, for example 12.600; or four bytes of PROFINET, for example 0xDB810209 or 'CF 81
    /// FD 05'
    #[arg(value_parser = code, add = ValueKind::Code(Family::Yrcx))]
    code: Code,
}

/// Code to explain.
#[derive(Debug, Clone)]
enum Code {
    Alarm(Alarm),
    Bus(ErrorMeaning),
}

/// Parses an alarm number or a fieldbus error code.
fn code(text: &str) -> Result<Code, String> {
    if let Some(explained) = BUSES.iter().find_map(|bus| (bus.explain)(text)) {
        return Ok(Code::Bus(explained));
    }
    text.parse().map(Code::Alarm).map_err(|error| format!("{error}"))
}

impl face::Explain for Explain {
    type Report = Codes<Group>;
    const ID: &'static str = "explain.yrcx";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<Codes<Group>> {
        let known = match &self.code {
            Code::Alarm(alarm) => {
                let site = alarms.find(origin, &alarm.to_string())?;
                let known = alarm.known();
                let (causes, remedies) = known.map_or((&[][..], SEE_MANUAL), |known| (known.causes, known.remedies));
                Known::new(
                    known.is_some(),
                    describe_alarm(*alarm),
                    [causes, remedies],
                    site,
                    Group { group: alarm.group_text() },
                )
            }
            Code::Bus(ErrorMeaning { code, meaning, refused, remedies }) => {
                let text = meaning.clone().unwrap_or_else(|| "unknown error".to_owned());
                let alarm = CommandResults {
                    code: Some(code.clone()),
                    text: Some(text),
                    kind: Some(Kind::Error),
                    source: Source::Armctl,
                    ..CommandResults::default()
                };
                Known::new(meaning.is_some(), alarm, [&[], remedies], None, Group { group: Some(refused) })
            }
        };
        Ok(Codes { codes: vec![known] })
    }

    fn alarm(&self) -> Option<String> {
        if let Code::Alarm(alarm) = &self.code { Some(alarm.to_string()) } else { None }
    }
}

/// Remedy for an alarm whose remedy is only in the controller's manual.
const SEE_MANUAL: &[&str] = &["look up the alarm in the controller's manual; use `yrcx info alarm` to see the source"];

/// Group of a code.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Group {
    /// Group of the alarm, or the operation that the device refused; null if the group is unknown.
    group: Option<&'static str>,
}

impl ExtraColumns for Group {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        vec![("group", self.group.map(ToOwned::to_owned))]
    }
}

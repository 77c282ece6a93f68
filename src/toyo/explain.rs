//! `armctl explain toyo`: explanation of error codes and program instructions.

use super::instructions::InstructionHelp;
use crate::prelude::basics::*;
use armctl_controller::toyo::errors;
use armctl_controller::toyo::table::Instruction;
use armctl_controller::toyo::table::instructions::INSTRUCTIONS;
use armctl_frame::face::explain::{self as face, Codes, Known};
use armctl_frame::robot::alarm::{Alarm, ExtraColumns, Kind, Source};
use armctl_frame::settings::alarms::{Alarms, Origin};

/// Error code of a Toyo controller, or an instruction of its programs
#[derive(Debug, Args)]
pub struct Explain {
    /// Hexadecimal code, for example 28 or 0xA1; or an instruction, for example MOVP
    #[arg(value_name = "CODE|INSTRUCTION", value_parser = subject, add = ValueKind::Code(Family::Toyo))]
    subject: Subject,
}

/// What to explain.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    Code(u8),
    Instruction(&'static Instruction),
}

/// Parses two hexadecimal digits or the word of an instruction.
fn subject(text: &str) -> Result<Subject, String> {
    let instruction = || INSTRUCTIONS.iter().find(|row| row.word.eq_ignore_ascii_case(text)).map(Subject::Instruction);
    user_input::code(text).map(Subject::Code).or_else(instruction).ok_or_else(|| {
        let near = nearest(text, INSTRUCTIONS.iter().map(|row| row.word));
        let near = near.map(|near| format!("; did you mean {near}?")).unwrap_or_default();
        format!(
            "type two hexadecimal digits such as 28 (`toyo status` shows the code), or an instruction such as \
             MOVP{near}"
        )
    })
}

/// Explanation of a code or an instruction.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Explanation {
    #[serde(flatten)]
    codes: Codes<Axis>,
    /// The instruction; absent for a code.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    instructions: Vec<InstructionHelp>,
}

impl Report for Explanation {
    fn view(&self) -> View {
        let instructions = self.instructions.iter().flat_map(InstructionHelp::sections);
        instructions.fold(self.codes.view(), View::append)
    }

    fn rows(&self) -> RowsOf {
        if self.instructions.is_empty() { self.codes.rows() } else { RowsOf::List("instructions") }
    }
}

impl face::Explain for Explain {
    type Report = Explanation;
    const ID: &'static str = "explain.toyo";

    fn explain(&self, alarms: &Alarms, origin: Origin<'_>) -> Result<Explanation> {
        let code = match self.subject {
            Subject::Code(code) => code,
            Subject::Instruction(row) => {
                let codes = Codes { codes: Vec::new() };
                return Ok(Explanation { codes, instructions: vec![InstructionHelp::new(row)] });
            }
        };
        let explanation = errors::explain(code);
        let no_error = Alarm { text: Some("no error".to_owned()), ..alarm_from_code(errors::NONE) };
        let (known, alarm, [cause, remedy]) = match code {
            errors::NONE => (true, no_error, ["no error is present", "no action is necessary"]),
            code => (explanation.known, alarm_from_code(code), [explanation.cause, explanation.remedy]),
        };
        let site = alarms.find(origin, alarm.code.as_deref().unwrap_or_default())?;
        let known = Known::new(known, alarm, [&[cause], &[remedy]], site, Axis { axis: explanation.axis });
        Ok(Explanation { codes: Codes { codes: vec![known] }, instructions: Vec::new() })
    }

    fn alarm(&self) -> Option<String> {
        match self.subject {
            Subject::Code(errors::NONE) | Subject::Instruction(_) => None,
            Subject::Code(code) => Some(format!("{code:02X}")),
        }
    }
}

/// Axis of a code.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Axis {
    /// Axis of the code; null if the code does not concern an axis.
    #[serde(rename = "axis_number")]
    axis: Option<u8>,
}

impl ExtraColumns for Axis {
    fn cells(&self) -> Vec<(&'static str, Option<String>)> {
        // The text already contains the cause.
        Vec::new()
    }
}

/// Returns the alarm for a code, with the texts of armctl.
pub fn alarm_from_code(code: u8) -> Alarm {
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
    fn explain_accepts_a_code_or_an_instruction() {
        for (text, code) in [("28", 0x28), ("0xa1", 0xA1), ("5", 5)] {
            assert_eq!(subject(text), Ok(Subject::Code(code)));
        }
        for wrong in ["", "0x", "100", "+5", "G1", "2060", "MOVE"] {
            assert!(subject(wrong).is_err(), "{wrong}");
        }
        assert!(matches!(subject("movp"), Ok(Subject::Instruction(row)) if row.word == "MOVP"));
        assert!(subject("MOVQ").unwrap_err().contains("did you mean MOV"));
    }
}

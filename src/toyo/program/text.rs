//! Text of the findings in program files.

use crate::files;
use crate::prelude::*;
use armctl_controller::names::Name;
use armctl_controller::toyo::program::{Checked, Finding, Program, Severity};
use armctl_frame::settings::inventory;
use armctl_frame::settings::target::Family;

/// Parses a name with its address on a command line, for example `pick=PT1`.
pub fn name(text: &str) -> Result<Name, String> {
    let (name, address) = text.split_once('=').ok_or("type a name with its address, such as pick=PT1")?;
    inventory::named(Family::Toyo, name, address).map_err(|failure| failure.message)
}

/// Program of a text that was checked. Warnings are printed on stderr. If there are errors, fails.
pub fn program(name: &str, checked: Checked, screen: &Screen) -> Result<Program, Failure> {
    let Some(program) = checked.program else {
        let errors: Vec<Finding> = checked.errors().cloned().collect();
        return Err(files::file_failure(name, &errors));
    };
    for finding in checked.findings.iter().filter(|finding| finding.severity == Severity::Warning) {
        screen.note(&in_a_line(name, finding));
    }
    Ok(program)
}

/// Formats a finding, for example `pick.txt:3:9: error: there is no label 'pikc' (did you mean pick?)`.
fn in_a_line(name: &str, finding: &Finding) -> String {
    let Finding { severity, line, column, message, hint } = finding;
    let hint = hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
    format!("{name}:{line}:{column}: {}: {message}{hint}", severity.name())
}

/// A finding, with its place in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Remark {
    /// Severity: `error`, `warning` or `note`. A file with an error is not a valid program.
    pub severity: &'static str,
    /// Line number, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What is wrong, and the input that is expected.
    pub message: String,
    /// Remedy or suggestion, if any.
    pub hint: Option<String>,
    /// Text of the line.
    pub source: String,
}

impl Remark {
    /// Creates a finding with the text of its line.
    pub fn new(finding: &Finding, lines: &[&str]) -> Self {
        let Finding { severity, line, column, message, hint } = finding;
        let source = line.checked_sub(1).and_then(|index| lines.get(index)).copied().unwrap_or_default();
        Self {
            severity: severity.name(),
            line: *line,
            column: *column,
            message: message.clone(),
            hint: hint.clone(),
            source: source.to_owned(),
        }
    }

    /// Formats the finding as compilers do: message, location, source line with a mark.
    pub fn lines(&self, name: &str) -> Vec<Cell> {
        let Self { severity, line, column, message, hint, source } = self;
        let tone = match *severity {
            "error" => Tone::Bad,
            "warning" => Tone::Warning,
            _ => Tone::Plain,
        };
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        // Each tab becomes one blank, so that the mark is below its column.
        let source = source.replace('\t', " ");
        let mut lines = vec![
            Cell::from(format!("{severity}: {message}")).tone(tone),
            Cell::from(format!("{margin}--> {name}:{line}:{column}")),
        ];
        if !source.trim().is_empty() {
            let before: String = source.chars().take(column.saturating_sub(1)).collect();
            let pad = " ".repeat(dialoguer::console::measure_text_width(&before));
            lines.push(format!("{margin} |").into());
            lines.push(format!("{number} | {source}").into());
            lines.push(Cell::from(format!("{margin} | {pad}^")).tone(tone));
        }
        lines.extend(hint.as_ref().map(|hint| Cell::from(format!("{margin} = {hint}"))));
        lines.push(Cell::default());
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::toyo::program::{MAX_STEPS, check};
    use armctl_frame::failure::Kind;

    fn screen() -> Screen {
        Screen::new(armctl_frame::output::Format::Json, armctl_frame::output::ColorChoice::Never, true, 0)
    }

    #[test]
    fn a_faulty_file_fails_with_all_its_errors() {
        let checked = check(b"EMD\nJMP TAG=no\nSPD V=1\n", MAX_STEPS);
        let failed = program("pick.txt", checked, &screen()).unwrap_err();
        assert_eq!(failed.kind, Kind::Usage);
        assert_eq!(
            failed.message,
            "pick.txt:1:1: unknown instruction 'EMD' (did you mean END?)\npick.txt:2:9: unknown label 'no'"
        );
    }

    #[test]
    fn remark_has_its_position() {
        let text = "ラベル: NOP\n\tJMP TAG=ラベル X\nEND";
        let checked = check(text.as_bytes(), MAX_STEPS);
        let lines: Vec<&str> = text.lines().collect();
        let shown: Vec<String> =
            Remark::new(&checked.findings[0], &lines).lines("a.txt").into_iter().map(|cell| cell.text).collect();
        assert_eq!(
            shown,
            [
                "error: unexpected text 'X'",
                " --> a.txt:2:14",
                "  |",
                "2 |  JMP TAG=ラベル X",
                "  |                 ^",
                "  = write JMP TAG=<tag>",
                "",
            ]
        );
    }
}

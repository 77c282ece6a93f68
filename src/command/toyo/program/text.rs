//! Program files: reading them, and what is wrong with them in words.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

use crate::controller::toyo::program::{Checked, Finding, Program, Severity};
use crate::failure::Failure;
use crate::output::Screen;
use crate::output::view::{Cell, Tone};

/// Most that is read of a file: 5,000 steps with a page of comments each.
const MOST: u64 = 16 << 20;

/// The bytes of a file, or of stdin for `-`.
pub fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let failed = |error| Failure::io(shown(path), &error);
    if path == Path::new("-") {
        std::io::stdin().lock().take(MOST).read_to_end(&mut bytes).map_err(failed)?;
    } else {
        File::open(path).map_err(failed)?.take(MOST).read_to_end(&mut bytes).map_err(failed)?;
    }
    if bytes.len() as u64 == MOST {
        return Err(Failure::usage(format!("{} is too large for a program", shown(path))));
    }
    Ok(bytes)
}

/// How a file is called in reports.
pub fn shown(path: &Path) -> String {
    if path == Path::new("-") { "stdin".to_owned() } else { path.display().to_string() }
}

/// The program in a text that was checked; warnings go to stderr, errors are a failure.
pub fn program(name: &str, checked: Checked, screen: &Screen) -> Result<Program, Failure> {
    let Some(program) = checked.program else {
        let errors: Vec<Finding> = checked.errors().cloned().collect();
        return Err(faulty(name, &errors).hint(format!("`toyo program check {name}` shows what is wrong and where")));
    };
    for finding in checked.findings.iter().filter(|finding| finding.severity == Severity::Warning) {
        screen.note(&in_a_line(name, finding));
    }
    Ok(program)
}

/// The first mistake of a file, and how many more there are.
pub fn faulty(name: &str, errors: &[Finding]) -> Failure {
    let first = errors.first().map(|finding| in_a_line(name, finding)).unwrap_or_default();
    let more = match errors.len() {
        0 | 1 => String::new(),
        2 => "; there is 1 more error".to_owned(),
        all => format!("; there are {} more errors", all - 1),
    };
    Failure::usage(format!("{first}{more}"))
}

/// `pick.txt:3:9: error: there is no label 'pikc' (did you mean pick?)`.
fn in_a_line(name: &str, finding: &Finding) -> String {
    let Finding { severity, line, column, message, hint } = finding;
    let hint = hint.as_ref().map(|hint| format!(" ({hint})")).unwrap_or_default();
    format!("{name}:{line}:{column}: {}: {message}{hint}", severity.name())
}

/// Something to say about a place of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Remark {
    /// `error`, `warning` or `note`; only errors keep a file from being a program.
    pub severity: &'static str,
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What is wrong, and what is expected.
    pub message: String,
    /// What to do, or what may have been meant.
    pub hint: Option<String>,
    /// The line itself.
    pub source: String,
}

impl Remark {
    /// A finding with its line.
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

    /// As compilers show it: the message, the place, the line with a mark under it.
    pub fn lines(&self, name: &str) -> Vec<Cell> {
        let Self { severity, line, column, message, hint, source } = self;
        let tone = match *severity {
            "error" => Tone::Bad,
            "warning" => Tone::Warning,
            _ => Tone::Plain,
        };
        let number = line.to_string();
        let margin = " ".repeat(number.len());
        // A blank for each tab, so that the mark stands where it should.
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
    use crate::controller::toyo::program::{MOST_STEPS, check};
    use crate::failure::Kind;

    fn screen() -> Screen {
        Screen::new(crate::output::Format::Json, crate::output::ColorChoice::Never, true, 0)
    }

    #[test]
    fn a_faulty_file_fails_with_its_first_error_and_their_number() {
        let failure = |text: &str| program("pick.txt", check(text.as_bytes(), MOST_STEPS), &screen()).unwrap_err();
        let failed = failure("EMD\nJMP TAG=no\nEND");
        assert_eq!(failed.kind, Kind::Usage);
        assert_eq!(
            failed.message,
            "pick.txt:1:1: error: there is no instruction 'EMD' (did you mean END?); there is 1 more error"
        );
        assert!(failure("EMD").message.ends_with("(did you mean END?)"));
    }

    #[test]
    fn a_remark_points_at_its_place() {
        let text = "ラベル: NOP\n\tJMP TAG=ラベル X\nEND";
        let checked = check(text.as_bytes(), MOST_STEPS);
        let lines: Vec<&str> = text.lines().collect();
        let shown: Vec<String> =
            Remark::new(&checked.findings[0], &lines).lines("a.txt").into_iter().map(|cell| cell.text).collect();
        assert_eq!(
            shown,
            [
                "error: 'X' is too much",
                " --> a.txt:2:14",
                "  |",
                "2 |  JMP TAG=ラベル X",
                "  |                 ^",
                "  = it is written JMP TAG=<tag>",
                "",
            ]
        );
    }
}

//! Verdict of a check: the findings of each file, and the exit code.

use super::Program;
use super::settings::FILE;
use crate::items::{self, ItemError};
use crate::prelude::basics::*;
use armctl_controller::findings::{Finding, Rule};

/// Result for all files. `M` is what the family adds to a file. Its name is the name of the schema.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "{M}")]
pub struct Verdict<M> {
    files: Vec<FileVerdict<M>>,
    /// Programs that could not be read.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    unread: Vec<ItemError>,
    #[serde(skip)]
    strict: bool,
}

/// Result for a file.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FileVerdict<M> {
    file: String,
    /// Whether the file has no errors.
    ok: bool,
    #[serde(flatten)]
    more: M,
    errors: usize,
    warnings: usize,
    /// Findings in the order of the text.
    findings: Vec<Remark>,
}

/// What a family adds to the result for a file.
pub trait Summary: Serialize + JsonSchema {
    /// Counts, for example `[(12, "step"), (2, "label")]`.
    fn counts(&self) -> Vec<(usize, &'static str)>;
}

impl<M: Summary> FileVerdict<M> {
    /// Result for a program.
    pub fn new(program: &Program, more: M) -> Self {
        let Program { file, lines, findings, .. } = program;
        let lines: Vec<&str> = lines.iter().map(|line| line.text.as_str()).collect();
        let findings: Vec<Remark> = findings.iter().map(|finding| Remark::new(finding, &lines)).collect();
        let count = |severity| findings.iter().filter(|remark| remark.severity == severity).count();
        let (errors, warnings) = (count("error"), count("warning"));
        Self { file: file.clone(), ok: errors == 0, more, errors, warnings, findings }
    }

    /// Describes the result, for example `pick.txt: 12 steps, 2 labels, 1 warning`.
    fn in_a_line(&self) -> Cell {
        let counted = |(count, what): (usize, &str)| match count {
            0 => None,
            1 => Some(format!("1 {what}")),
            _ => Some(format!("{count} {what}s")),
        };
        let counts = self.more.counts().into_iter().chain([(self.errors, "error"), (self.warnings, "warning")]);
        let text = format!("{}: {}", self.file, counts.filter_map(counted).collect::<Vec<_>>().join(", "));
        Cell::from(text).tone(match self {
            Self { ok: false, .. } => Tone::Bad,
            Self { warnings: 0, .. } => Tone::Good,
            _ => Tone::Warning,
        })
    }
}

impl<M: Summary> Verdict<M> {
    /// Result for all files. With `strict`, a warning is an error.
    pub fn new(files: Vec<FileVerdict<M>>, unread: Vec<ItemError>, strict: bool) -> Self {
        Self { files, unread, strict }
    }

    /// Results of the files.
    pub fn files(&self) -> &[FileVerdict<M>] {
        &self.files
    }
}

impl<M: Summary> Report for Verdict<M> {
    fn view(&self) -> View {
        let remarks = |file: &FileVerdict<M>| {
            let mut lines: Vec<Cell> = file.findings.iter().flat_map(|remark| remark.lines(&file.file)).collect();
            lines.push(file.in_a_line());
            lines
        };
        let mut lines: Vec<Cell> = self.files.iter().flat_map(remarks).collect();
        let mut rules = self.files.iter().flat_map(|file| &file.findings).map(|remark| remark.rule);
        if let Some(rule) = rules.find(|rule| *rule != Rule::Syntax.name()) {
            lines.push(format!("to switch a rule off, write it in {FILE}: [rules] {rule} = false").into());
        }
        View { sections: vec![Section::Lines(lines)] }
    }

    fn failure(&self) -> Option<Failure> {
        let bad = |file: &&FileVerdict<M>| !file.ok || (self.strict && file.warnings > 0);
        let bad: Vec<&str> = self.files.iter().filter(bad).map(|file| file.file.as_str()).collect();
        let what = match (&bad[..], self.strict) {
            ([], _) => return items::verdict(self.files.len() + self.unread.len(), &self.unread),
            ([one], false) => format!("{one} has errors"),
            ([one], true) => format!("{one} has warnings"),
            (many, _) => format!("{} of {} files have errors: {}", many.len(), self.files.len(), many.join(", ")),
        };
        Some(Failure::new(Kind::ConditionNotMet, what))
    }
}

/// A finding, with its place in a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Remark {
    /// Severity: `error`, `warning` or `note`.
    pub severity: &'static str,
    /// Name of the rule, such as `missing-label`.
    pub rule: &'static str,
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
    fn new(finding: &Finding, lines: &[&str]) -> Self {
        let Finding { rule, severity, line, column, message, hint } = finding;
        let source = line.checked_sub(1).and_then(|index| lines.get(index)).copied().unwrap_or_default();
        Self {
            severity: severity.name(),
            rule: rule.name(),
            line: *line,
            column: *column,
            message: message.clone(),
            hint: hint.clone(),
            source: source.to_owned(),
        }
    }

    /// Formats the finding as compilers do: rule, message, location, source line with a mark.
    fn lines(&self, name: &str) -> Vec<Cell> {
        let Self { severity, rule, line, column, message, hint, source } = self;
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
            Cell::from(format!("{severity}[{rule}]: {message}")).tone(tone),
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
    use armctl_controller::findings::Severity;

    #[test]
    fn remark_has_its_position() {
        let text = "ラベル: NOP\n\tJMP TAG=ラベル X\nEND";
        let hint = Some("write JMP TAG=<tag>".to_owned());
        let message = "unexpected text 'X'".to_owned();
        let (rule, severity) = (Rule::Syntax, Severity::Error);
        let finding = Finding { rule, severity, line: 2, column: 14, message, hint };
        let lines: Vec<&str> = text.lines().collect();
        let shown: Vec<String> =
            Remark::new(&finding, &lines).lines("a.txt").into_iter().map(|cell| cell.text).collect();
        assert_eq!(
            shown,
            [
                "error[syntax]: unexpected text 'X'",
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

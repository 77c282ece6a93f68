//! Findings (errors, warnings, notes) of a user-written text: a program, a table of points, a parameter file.

use std::fmt;

/// Maximum number of stored errors. A file with more errors is probably of another type.
const MAX_ERRORS: usize = 100;

/// A finding at a position of the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// Rule that the finding belongs to.
    pub rule: Rule,
    /// Severity of the finding.
    pub severity: Severity,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The problem, and what the parser expected.
    pub message: String,
    /// What to do, or a suggestion.
    pub hint: Option<String>,
}

/// Severity of a finding.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The text cannot be used.
    Error,
    /// Probably a mistake.
    Warning,
    /// Information.
    Note,
}

impl Severity {
    /// Name in messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
            Self::Note => "note",
        }
    }
}

/// Rule of a check. The settings of a check switch rules on and off by their names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rule {
    /// The text cannot be read.
    Syntax,
    /// A jump has no target.
    MissingLabel,
    /// A call has no target.
    MissingJob,
    /// A move has no position.
    MissingPosition,
    /// A program calls itself.
    Recursion,
    /// The program stops at an instruction.
    Stops,
    /// An instruction is never executed.
    Unreachable,
    /// No program calls the program.
    UnusedJob,
    /// No jump goes to the label.
    UnusedLabel,
    /// No move uses the position.
    UnusedPosition,
    /// The value of a variable is never used.
    NeverRead,
    /// A motion is faster than the limit.
    SpeedLimit,
    /// A position is not the position of another backup.
    MovedPosition,
    /// Lines do not end as the controller needs.
    LineEndings,
    /// Something that a check cannot prove, or that depends on the controller.
    Unchecked,
}

/// Names of the rules, with what they report.
const RULES: [(Rule, &str, &str); 15] = [
    (Rule::Syntax, "syntax", "a text that is not a valid program"),
    (Rule::MissingLabel, "missing-label", "a jump to a label that does not exist"),
    (Rule::MissingJob, "missing-job", "a call of a job or a program that does not exist"),
    (Rule::MissingPosition, "missing-position", "a move to a position that does not exist"),
    (Rule::Recursion, "recursion", "a job or a subroutine that calls itself"),
    (Rule::Stops, "stops", "an instruction at which a controller stops with an error"),
    (Rule::Unreachable, "unreachable", "instructions that are never executed, or a program without an end"),
    (
        Rule::UnusedJob,
        "unused-job",
        "a job that no job calls; only if master names the jobs that are started otherwise",
    ),
    (Rule::UnusedLabel, "unused-label", "a label without a jump (toyo)"),
    (Rule::UnusedPosition, "unused-position", "a taught position that no move uses"),
    (Rule::NeverRead, "never-read", "a variable that is written and never read"),
    (Rule::SpeedLimit, "speed-limit", "a motion above the limit of --max-speed"),
    (Rule::MovedPosition, "moved-position", "a position that differs from the one in --compare"),
    (Rule::LineEndings, "line-endings", "lines that do not end in CR LF (yerc)"),
    (Rule::Unchecked, "unchecked", "notes about what is not checked, or depends on the controller"),
];

impl Rule {
    /// All rules with their names, and with what they report.
    pub fn all() -> impl Iterator<Item = (Self, &'static str, &'static str)> {
        RULES.into_iter()
    }

    /// Name in settings and reports.
    pub fn name(self) -> &'static str {
        RULES[self as usize].1
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { severity, line, column, message, hint, .. } = self;
        write!(f, "line {line}, column {column}: {}: {message}", severity.name())?;
        hint.as_ref().map_or(Ok(()), |hint| write!(f, " ({hint})"))
    }
}

/// Line and column in a text, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SourceLocation {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

/// Collection of findings, in any order.
#[derive(Debug, Default)]
pub struct Findings {
    list: Vec<Finding>,
    errors: usize,
}

impl Findings {
    /// Adds an error: the text cannot be read.
    pub fn error(&mut self, at: SourceLocation, message: impl Into<String>, hint: Option<String>) {
        self.error_of(Rule::Syntax, at, message, hint);
    }

    /// Adds an error of a rule.
    pub fn error_of(&mut self, rule: Rule, at: SourceLocation, message: impl Into<String>, hint: Option<String>) {
        self.errors += 1;
        if self.errors == MAX_ERRORS {
            let message = "more errors follow; they are not shown".to_owned();
            self.add(Rule::Syntax, Severity::Error, at, message, None);
        } else if self.errors < MAX_ERRORS {
            self.add(rule, Severity::Error, at, message.into(), hint);
        }
    }

    /// Adds a warning.
    pub fn warning(&mut self, rule: Rule, at: SourceLocation, message: impl Into<String>, hint: Option<String>) {
        self.add(rule, Severity::Warning, at, message.into(), hint);
    }

    /// Adds a note.
    pub fn note(&mut self, at: SourceLocation, message: impl Into<String>) {
        self.add(Rule::Unchecked, Severity::Note, at, message.into(), None);
    }

    /// Number of errors, including the errors beyond the limit, which are not stored.
    pub const fn errors(&self) -> usize {
        self.errors
    }

    /// Whether the limit of stored errors is reached.
    pub const fn is_full(&self) -> bool {
        self.errors >= MAX_ERRORS
    }

    /// Returns only the errors, in text order.
    pub fn into_errors(self) -> Vec<Finding> {
        let mut errors = self.sorted();
        errors.retain(|finding| finding.severity == Severity::Error);
        errors
    }

    /// Returns all findings, in text order.
    pub fn sorted(mut self) -> Vec<Finding> {
        self.list.sort_by_key(|finding| (finding.line, finding.column, finding.severity));
        self.list
    }

    fn add(&mut self, rule: Rule, severity: Severity, at: SourceLocation, message: String, hint: Option<String>) {
        self.list.push(Finding { rule, severity, line: at.line, column: at.column, message, hint });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_of_rules_has_the_order_of_the_rules() {
        assert!(Rule::all().enumerate().all(|(index, (rule, name, _))| rule as usize == index && rule.name() == name));
    }
}

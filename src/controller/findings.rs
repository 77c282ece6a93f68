//! Findings (errors, warnings, notes) of a user-written text: a program, a table of points, a parameter file.

use std::fmt;

/// Maximum number of stored errors. A file with more errors is probably of another type.
const MAX_ERRORS: usize = 100;

/// A finding at a position of the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
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

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { severity, line, column, message, hint } = self;
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
    /// Adds an error.
    pub fn error(&mut self, at: SourceLocation, message: impl Into<String>, hint: Option<String>) {
        self.errors += 1;
        if self.errors == MAX_ERRORS {
            self.add(Severity::Error, at, "more errors follow; they are not shown".to_owned(), None);
        } else if self.errors < MAX_ERRORS {
            self.add(Severity::Error, at, message.into(), hint);
        }
    }

    /// Adds a warning.
    pub fn warning(&mut self, at: SourceLocation, message: impl Into<String>, hint: Option<String>) {
        self.add(Severity::Warning, at, message.into(), hint);
    }

    /// Adds a note.
    pub fn note(&mut self, at: SourceLocation, message: impl Into<String>) {
        self.add(Severity::Note, at, message.into(), None);
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

    fn add(&mut self, severity: Severity, at: SourceLocation, message: String, hint: Option<String>) {
        self.list.push(Finding { severity, line: at.line, column: at.column, message, hint });
    }
}

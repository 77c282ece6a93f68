//! What there is to say about a text that somebody wrote: a program, a table of points, a file of parameters.

use std::fmt;

/// Errors that are kept; a file with more is something else altogether.
const MOST: usize = 100;

/// Something to say about a place of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// From 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What is wrong, and what is expected.
    pub message: String,
    /// What to do, or what may have been meant.
    pub hint: Option<String>,
}

/// How bad a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The text cannot be used.
    Error,
    /// Probably not what was meant.
    Warning,
    /// Worth to know.
    Note,
}

impl Severity {
    /// In words.
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

/// A place in a text: line and column, both from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SourceLocation {
    /// Line.
    pub line: usize,
    /// Column, in characters.
    pub column: usize,
}

/// Findings, gathered in any order.
#[derive(Debug, Default)]
pub struct Findings {
    list: Vec<Finding>,
    errors: usize,
}

impl Findings {
    /// Adds an error.
    pub fn error(&mut self, at: SourceLocation, message: impl Into<String>, hint: Option<String>) {
        self.errors += 1;
        if self.errors == MOST {
            self.add(Severity::Error, at, "there are more errors; they are not shown".to_owned(), None);
        } else if self.errors < MOST {
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

    /// How many errors there are, those that are not shown included.
    pub const fn errors(&self) -> usize {
        self.errors
    }

    /// Whether more errors would not be shown.
    pub const fn is_full(&self) -> bool {
        self.errors >= MOST
    }

    /// The errors alone, in the order of the text.
    pub fn into_errors(self) -> Vec<Finding> {
        let mut errors = self.sorted();
        errors.retain(|finding| finding.severity == Severity::Error);
        errors
    }

    /// In the order of the text.
    pub fn sorted(mut self) -> Vec<Finding> {
        self.list.sort_by_key(|finding| (finding.line, finding.column, finding.severity));
        self.list
    }

    fn add(&mut self, severity: Severity, at: SourceLocation, message: String, hint: Option<String>) {
        self.list.push(Finding { severity, line: at.line, column: at.column, message, hint });
    }
}

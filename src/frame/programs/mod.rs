//! Programs of a robot or of a folder, whatever the family: search, call tree, and checks.

pub mod calls;
pub mod check;
pub mod search;
pub mod settings;
pub mod source;
pub mod verdict;

use armctl_controller::findings::Finding;
use armctl_controller::references::{ProgrammedSpeed, Reference, Role};

/// A parsed program.
#[derive(Debug, Clone, Default)]
pub struct Program {
    /// Name of the program in calls, such as `COUNT`, or of its part, such as `program-1`.
    pub name: String,
    /// File in messages.
    pub file: String,
    /// Lines of the file.
    pub lines: Vec<Line>,
    /// Positions that belong to the program.
    pub positions: Vec<Position>,
    /// What the parser of the family found.
    pub findings: Vec<Finding>,
}

/// A line of a program.
#[derive(Debug, Clone, Default)]
pub struct Line {
    /// Line of the file, from 1.
    pub number: usize,
    /// Text of the line.
    pub text: String,
    /// What the line refers to.
    pub references: Vec<Reference>,
    /// Speeds in the line.
    pub speeds: Vec<ProgrammedSpeed>,
}

impl Line {
    /// Lines of a text, without references.
    pub fn all(text: &str) -> Vec<Self> {
        let line = |(number, text): (usize, &str)| Self { number, text: text.to_owned(), ..Self::default() };
        (1..).zip(text.lines()).map(line).collect()
    }
}

/// A position that belongs to a program.
#[derive(Debug, Clone)]
pub struct Position {
    /// Line of the file, from 1.
    pub line: usize,
    /// Name in the notation of the references.
    pub name: String,
    /// Text of the position in the file.
    pub text: String,
}

impl Program {
    /// References of all lines, with their lines.
    pub fn references(&self) -> impl Iterator<Item = (&Line, &Reference)> {
        self.lines.iter().flat_map(|line| line.references.iter().map(move |reference| (line, reference)))
    }

    /// Calls and starts of programs, with their lines. `is_program` is true for the names of programs, which can be instructions.
    pub fn calls<'p>(
        &'p self,
        is_program: impl Fn(&str) -> bool + 'p,
    ) -> impl Iterator<Item = (&'p Line, &'p Reference)> {
        self.references().filter(move |(_, reference)| match reference.role {
            Role::Call | Role::Start => true,
            Role::Word => is_program(&reference.name),
            _ => false,
        })
    }
}

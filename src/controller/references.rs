//! What a line of a program refers to: labels, other programs, positions, variables, signals. The names have one notation
//! per family, in which two spellings of one object are equal.

/// A reference in a line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Reference {
    /// What the line does with the object.
    pub role: Role,
    /// Name of the object, for example `B5`, `OT#3`, `C1`, `COUNT`.
    pub name: String,
    /// Column in characters, from 1.
    pub column: usize,
}

/// What a line does with an object.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Role {
    /// Defines a label.
    Label,
    /// Jumps to a label.
    Jump,
    /// Calls a program or a subroutine, which returns.
    Call,
    /// Starts a program in another task, or continues with it without a return.
    Start,
    /// Calls or starts a program that is known only at run time.
    ComputedCall,
    /// Moves to a position of the program.
    Position,
    /// Uses a value.
    Read,
    /// Replaces a value.
    Write,
    /// Replaces a value by a value that depends on it, such as a count.
    Update,
    /// First word of the line. On some controllers, the name of a job is an instruction.
    Word,
}

/// A programmed speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProgrammedSpeed {
    /// Speed.
    pub value: f64,
    /// `%`, `mm/s` or `deg/s`.
    pub unit: &'static str,
    /// Column in characters, from 1.
    pub column: usize,
}

//! Programs in a subset of the robot language: moves, waits, outputs, variables, jumps.

use std::collections::BTreeMap;
use std::time::Duration;

use super::memory::{Number, Operation, POINTS, PortRef, is_port, port_kind};
use super::request::ROBOTS;

/// Maximum number of lines of a program. In answers, 10000 is added to the line numbers of the program COMMON (4.6.4).
const MAX_LINES: usize = 9999;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    Number(Number),
    /// A variable. Number 0 is SGI0, number 256 is SGR0.
    Variable(usize),
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Statement {
    // Empty line, comment or label.
    Nothing,
    // The index of the robot begins at 0.
    Move { robot: usize, linear: bool, relative: bool, point: usize },
    Delay(Duration),
    Output(PortRef, u8),
    Wait(PortRef, u8),
    Assign { variable: usize, first: Operand, then: Option<(Operation, Operand)> },
    Goto(String),
    Gosub(String),
    Return,
    Halt,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Program {
    pub(super) name: String,
    pub(super) lines: Vec<Statement>,
    pub(super) labels: BTreeMap<String, usize>,
}

impl Program {
    /// Parses a program. An error message gives the problem and the line.
    pub(super) fn parse(name: &str, text: &str) -> Result<Self, String> {
        let named = |byte: u8| byte.is_ascii_uppercase() || byte.is_ascii_digit() || byte == b'_';
        if name.is_empty() || name.len() > 32 || !name.bytes().all(named) {
            return Err(format!("'{name}' is not a valid program name (A-Z, 0-9 and _)"));
        }
        let mut program = Self { name: name.to_owned(), lines: Vec::new(), labels: BTreeMap::new() };
        for (number, line) in text.lines().enumerate() {
            let line = line.split('\'').next().unwrap_or_default().trim();
            if let Some(label) = line.strip_prefix('*').and_then(|label| label.strip_suffix(':')) {
                program.labels.insert(label.to_owned(), number);
                program.lines.push(Statement::Nothing);
                continue;
            }
            let parsed = statement(line).ok_or_else(|| format!("line {} of {name}: '{line}'", number + 1))?;
            program.lines.push(parsed);
        }
        if program.lines.is_empty() || program.lines.len() > MAX_LINES {
            return Err(format!("{name} has {} lines; it must have 1 to {MAX_LINES}", program.lines.len()));
        }
        Ok(program)
    }

    /// The first 16 characters of the name. Commands contain only these characters.
    pub(super) fn short_name(&self) -> &str {
        self.name.get(..16).unwrap_or(&self.name)
    }
}

fn statement(line: &str) -> Option<Statement> {
    let (word, rest) = line.split_once(' ').map_or((line, ""), |(word, rest)| (word, rest.trim()));
    let label = || rest.strip_prefix('*').map(str::to_owned);
    match word {
        "" | "REM" => Some(Statement::Nothing),
        "DELAY" => Some(Statement::Delay(Duration::from_millis(rest.parse().ok()?))),
        "WAIT" => assigned(rest).map(|(port, value)| Statement::Wait(port, value)),
        "GOTO" => label().map(Statement::Goto),
        "GOSUB" => label().map(Statement::Gosub),
        "RETURN" => Some(Statement::Return),
        "HALT" => Some(Statement::Halt),
        _ if word.starts_with("MOVE") => motion(word, rest),
        _ if word.starts_with("SG") => assignment(line),
        _ => assigned(line)
            .filter(|(port, _)| !matches!(port.kind, 0 | super::memory::SI))
            .map(|(port, value)| Statement::Output(port, value)),
    }
}

/// Parses a move, for example `MOVE P,P19`, `MOVE[2] L,P20` or `MOVEI P,P3`.
fn motion(word: &str, rest: &str) -> Option<Statement> {
    let (word, robot) = match word.split_once('[') {
        Some((word, robot)) => (word, robot.strip_suffix(']')?.parse::<usize>().ok()?),
        None => (word, 1),
    };
    let (kind, point) = rest.split_once(',')?;
    let point = point.trim().strip_prefix('P')?.parse::<u16>().ok().filter(|point| *point < POINTS)?;
    let linear = match kind.trim() {
        "P" => false,
        "L" => true,
        _ => return None,
    };
    let relative = match word {
        "MOVE" => false,
        "MOVEI" => true,
        _ => return None,
    };
    let robot = robot.checked_sub(1).filter(|robot| *robot < ROBOTS)?;
    Some(Statement::Move { robot, linear, relative, point: point.into() })
}

/// Parses an output assignment, for example `DO(20)=1` (a bit) or `DO2()=255` (a port).
pub(super) fn assigned(text: &str) -> Option<(PortRef, u8)> {
    let (port, value) = text.split_once('=')?;
    let value = value.trim().parse::<u8>().ok()?;
    let (name, bit) = port.trim().split_once('(')?;
    let bit = bit.strip_suffix(')')?;
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let (port, bit) = if bit.is_empty() {
        (name[letters.len()..].parse().ok()?, None)
    } else {
        let number = bit.parse::<usize>().ok().filter(|_| letters == name)?;
        (number / 10, u8::try_from(number % 10).ok())
    };
    let found = PortRef { kind: port_kind(letters)?, port, bit };
    let fits = is_port(found.kind, port) && bit.is_none_or(|bit| bit <= 7 && value <= 1);
    fits.then_some((found, value))
}

/// Parses an assignment to a variable, for example `SGI1=5`, `SGI1=SGI1+1` or `SGR0=SGI2/2.5`.
fn assignment(line: &str) -> Option<Statement> {
    let (variable, value) = line.split_once('=')?;
    let Operand::Variable(variable) = operand(variable.trim())? else { return None };
    let value = value.trim();
    let operations =
        [('+', Operation::Add), ('*', Operation::Multiply), ('/', Operation::Divide), ('-', Operation::Subtract)];
    let split = operations.iter().find_map(|&(sign, operation)| {
        let at = value.get(1..)?.find(sign)? + 1;
        Some((operation, operand(value[..at].trim())?, operand(value[at + 1..].trim())?))
    });
    Some(match split {
        Some((operation, first, second)) => Statement::Assign { variable, first, then: Some((operation, second)) },
        None => Statement::Assign { variable, first: operand(value)?, then: None },
    })
}

fn operand(text: &str) -> Option<Operand> {
    let variable = |prefix: &str, first: usize| {
        let index = text.strip_prefix(prefix)?.parse::<usize>().ok().filter(|index| *index < 32)?;
        Some(Operand::Variable(first + index))
    };
    let whole = || text.parse().ok().map(|number| Operand::Number(Number::Whole(number)));
    let real = || text.parse::<f32>().ok().filter(|number| number.is_finite());
    variable("SGI", 0)
        .or_else(|| variable("SGR", 256))
        .or_else(whole)
        .or_else(|| real().map(|number| Operand::Number(Number::Real(number))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parses_program_lines() {
        let text = "*START:\nMOVE P,P19 'there\nMOVEI[2] L,P3\nDELAY 500\nDO(127)=1\nMO3()=255\nWAIT SI(20)=0\n\
                    SGI1=SGI1+1\nSGR0=SGI2/2.5\nSGI3=-5\nGOSUB *SUB\nGOTO *START\nRETURN\nHALT\n";
        let program = Program::parse("PG1", text).unwrap();
        assert_eq!(program.labels.get("START"), Some(&0));
        assert_eq!(program.lines[1], Statement::Move { robot: 0, linear: false, relative: false, point: 19 });
        assert_eq!(program.lines[2], Statement::Move { robot: 1, linear: true, relative: true, point: 3 });
        assert_eq!(program.lines[4], Statement::Output(PortRef { kind: 1, port: 12, bit: Some(7) }, 1));
        assert_eq!(program.lines[5], Statement::Output(PortRef { kind: 2, port: 3, bit: None }, 255));
        assert_eq!(program.lines[6], Statement::Wait(PortRef { kind: 5, port: 2, bit: Some(0) }, 0));
        let half = (Operation::Divide, Operand::Number(Number::Real(2.5)));
        let first = Operand::Variable(2);
        assert_eq!(program.lines[8], Statement::Assign { variable: 256, first, then: Some(half) });
        let first = Operand::Number(Number::Whole(-5));
        assert_eq!(program.lines[9], Statement::Assign { variable: 3, first, then: None });
    }

    #[test]
    fn error_names_an_unsupported_statement() {
        for line in ["MOVE X,P1", "MOVE P,P30000", "MOVE[5] P,P1", "SI(20)=1", "DO(28)=1", "DO(20)=2", "SGI32=1", "X"] {
            let error = Program::parse("A", &format!("HALT\n{line}")).unwrap_err();
            assert!(error.starts_with("line 2 of A"), "{error}");
        }
        assert!(Program::parse("a", "HALT").is_err());
    }
}

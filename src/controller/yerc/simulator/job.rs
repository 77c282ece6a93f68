//! Job files (JBI): checks when a file is loaded, and the program in the file.

use std::collections::BTreeMap;
use std::time::Duration;

use super::memory::Kind;
use super::motion::{AXES, Pulses};
use crate::refuse_if;

/// Added status: NOP is missing at the start, END is missing at the end, or lines do not end in CR LF.
const NOP_OR_END_MISSING: u16 = 0x5130;
/// Added status: the file does not start as a job.
const FORMAT: u16 = 0x5170;
/// Added status: the job name in the file is not the name of the file.
const JOB_RECORD: u16 = 0x5390;
/// Added status: a known instruction with wrong syntax.
const SYNTAX: u16 = 0x5110;

/// A parsed job.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Program {
    /// Instructions by line number; line 0 is NOP.
    pub(super) lines: Vec<Instruction>,
    /// Positions of the file, by number.
    pub(super) positions: BTreeMap<u32, Target>,
}

impl Program {
    /// Parses a job file. An error is the added status with which a controller refuses the file.
    ///
    /// `stem` is the file name without `.JBI`. It must be equal to the job name in the file.
    pub(super) fn parse(stem: &[u8], text: &[u8]) -> Result<Self, u16> {
        let lines = lines(text)?;
        refuse_if(lines.first() != Some(&b"/JOB".as_slice()), FORMAT)?;
        let name = lines.iter().find_map(|line| line.strip_prefix(b"//NAME ")).ok_or(FORMAT)?;
        refuse_if(name.trim_ascii() != stem, JOB_RECORD)?;
        let head = lines.iter().position(|line| *line == b"NOP").ok_or(NOP_OR_END_MISSING)?;
        let Some((&b"END", body)) = lines[head..].split_last() else { return Err(NOP_OR_END_MISSING) };
        let instructions: Result<Vec<_>, u16> =
            body.iter().map(|line| Instruction::parse(line)).chain([Ok(Instruction::End)]).collect();
        Ok(Self { lines: instructions?, positions: positions(&lines[..head]) })
    }

    pub(super) fn label(&self, name: &[u8]) -> Option<usize> {
        self.lines.iter().position(|line| matches!(line, Instruction::Label(label) if label == name))
    }

    /// Step number of a line: the number of motions up to this line, including it.
    pub(super) fn step(&self, line: usize) -> usize {
        self.lines.iter().take(line + 1).filter(|line| matches!(line, Instruction::Move(_))).count()
    }
}

/// Lines of the file. Each line must end in CR LF, except the last.
fn lines(text: &[u8]) -> Result<Vec<&[u8]>, u16> {
    let mut lines = Vec::new();
    let mut rest = text;
    while let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
        let line = rest[..end].strip_suffix(b"\r").ok_or(NOP_OR_END_MISSING)?;
        lines.push(line.trim_ascii());
        rest = &rest[end + 1..];
    }
    lines.push(rest.trim_ascii());
    while lines.last().is_some_and(|line| line.is_empty()) {
        lines.pop();
    }
    Ok(lines)
}

/// Target of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    Pulses(Pulses),
    /// X, Y, Z in mm, then the angles in degrees, in base coordinates.
    Base([f64; 7]),
}

/// Reads the `C00000=…` lines, in the format of the `///POSTYPE` line before them.
fn positions(lines: &[&[u8]]) -> BTreeMap<u32, Target> {
    let mut base = false;
    let mut found = BTreeMap::new();
    for line in lines.iter().filter_map(|line| std::str::from_utf8(line).ok()) {
        if let Some(kind) = line.strip_prefix("///POSTYPE ") {
            base = kind.trim() != "PULSE";
        }
        let Some((number, values)) = line.strip_prefix('C').and_then(|rest| rest.split_once('=')) else { continue };
        let Ok(number) = number.parse() else { continue };
        let values: Vec<f64> = values.split(',').filter_map(|value| value.trim().parse().ok()).collect();
        let target = if base {
            Target::Base(std::array::from_fn(|i| values.get(i).copied().unwrap_or(0.0)))
        } else {
            let mut pulses = [0.0; AXES];
            pulses.iter_mut().zip(values).for_each(|(pulse, value)| *pulse = value);
            Target::Pulses(pulses)
        };
        found.insert(number, target);
    }
    found
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Operand {
    Number(f64),
    Variable(Kind, usize),
    /// A general-purpose input or output by its number, from 1.
    Input(u32),
    Output(u32),
}

/// A condition, for example `B000=5` or `IN#(1)=ON`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Condition {
    pub(super) left: Operand,
    pub(super) comparison: Comparison,
    pub(super) right: Operand,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Comparison {
    Equal,
    NotEqual,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
}

impl Comparison {
    /// Comparison operators with their texts. Longer texts come first, so that a prefix search finds `<=` before `<`.
    const SIGNS: [(&str, Self); 6] = [
        ("<>", Self::NotEqual),
        ("<=", Self::LessOrEqual),
        (">=", Self::GreaterOrEqual),
        ("=", Self::Equal),
        ("<", Self::Less),
        (">", Self::Greater),
    ];

    #[expect(clippy::float_cmp, reason = "job variables compare exactly")]
    pub(super) fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Equal => left == right,
            Self::NotEqual => left != right,
            Self::Less => left < right,
            Self::LessOrEqual => left <= right,
            Self::Greater => left > right,
            Self::GreaterOrEqual => left >= right,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Arithmetic {
    Set,
    Add,
    Sub,
    Mul,
    Div,
}

/// Target of a motion instruction.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MoveTarget {
    /// A position of the job file.
    Taught(u32),
    /// A position variable.
    Variable(usize),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Move {
    pub(super) straight: bool,
    pub(super) to: MoveTarget,
    /// Percent for a joint motion, mm/s for a straight motion.
    pub(super) speed: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Instruction {
    End,
    Ret,
    Pause,
    Move(Move),
    Timer(Duration),
    Arithmetic(Arithmetic, (Kind, usize), Operand),
    Output(u32, bool),
    ReadInput((Kind, usize), u32),
    Wait(Condition, Option<Duration>),
    Jump(Vec<u8>, Option<Condition>),
    Call(Vec<u8>, Option<Condition>),
    Label(Vec<u8>),
    /// A comment, a NOP, or an instruction that has no effect in this simulator.
    Pass,
}

impl Instruction {
    /// Parses one line. An unknown instruction has no effect. A known instruction that is malformed is a syntax error.
    fn parse(line: &[u8]) -> Result<Self, u16> {
        if let Some(label) = line.strip_prefix(b"*") {
            return Ok(Self::Label(label.to_vec()));
        }
        let (word, rest) = match line.iter().position(u8::is_ascii_whitespace) {
            Some(at) => (&line[..at], line[at..].trim_ascii()),
            None => (line, &[][..]),
        };
        let parsed = match word {
            b"END" => return Err(NOP_OR_END_MISSING),
            b"RET" => Some(Self::Ret),
            b"PAUSE" => Some(Self::Pause),
            b"JUMP" => jump(rest, b"*").map(|(name, condition)| Self::Jump(name, condition)),
            b"CALL" => jump(rest, b"JOB:").map(|(name, condition)| Self::Call(name, condition)),
            _ => match std::str::from_utf8(rest) {
                Ok(rest) => Self::operands(word, rest),
                Err(_) => Some(Self::Pass),
            },
        };
        parsed.ok_or(SYNTAX)
    }

    fn operands(word: &[u8], rest: &str) -> Option<Self> {
        let arithmetic = |operation| {
            let (target, value) = rest.split_once(char::is_whitespace)?;
            Some(Self::Arithmetic(operation, variable(target)?, operand(value)?))
        };
        let one = |operation| Some(Self::Arithmetic(operation, variable(rest)?, Operand::Number(1.0)));
        match word {
            b"MOVJ" => motion(rest, false, "VJ="),
            b"MOVL" => motion(rest, true, "V="),
            b"TIMER" => Some(Self::Timer(duration(rest)?)),
            b"SET" => arithmetic(Arithmetic::Set),
            b"ADD" => arithmetic(Arithmetic::Add),
            b"SUB" => arithmetic(Arithmetic::Sub),
            b"MUL" => arithmetic(Arithmetic::Mul),
            b"DIV" => arithmetic(Arithmetic::Div),
            b"INC" => one(Arithmetic::Add),
            b"DEC" => one(Arithmetic::Sub),
            b"DOUT" => {
                let (output, state) = rest.split_once(' ')?;
                let Operand::Output(number) = operand(output)? else { return None };
                Some(Self::Output(number, on_off(state)?))
            }
            b"DIN" => {
                let (target, input) = rest.split_once(' ')?;
                let Operand::Input(number) = operand(input)? else { return None };
                Some(Self::ReadInput(variable(target)?, number))
            }
            b"WAIT" => {
                let (text, limit) = rest.split_once(" T=").map_or((rest, None), |(text, limit)| (text, Some(limit)));
                let limit = match limit {
                    Some(limit) => Some(duration(&format!("T={limit}"))?),
                    None => None,
                };
                Some(Self::Wait(condition(text)?, limit))
            }
            _ => Some(Self::Pass),
        }
    }
}

/// Parses the operands of a motion, for example `P003 VJ=10.00` or `C00001 V=100.0 PL=1`.
fn motion(rest: &str, straight: bool, speed_tag: &str) -> Option<Instruction> {
    let mut words = rest.split_whitespace();
    let place = words.next()?;
    let to = match Kind::parse(place) {
        Some((Kind::P, index)) => MoveTarget::Variable(index),
        _ => MoveTarget::Taught(place.strip_prefix('C')?.parse().ok()?),
    };
    let speed = words.find_map(|word| word.strip_prefix(speed_tag))?.parse().ok().filter(|speed| *speed > 0.0)?;
    Some(Instruction::Move(Move { straight, to, speed }))
}

fn duration(text: &str) -> Option<Duration> {
    let seconds: f64 = text.trim().strip_prefix("T=")?.trim().parse().ok()?;
    (0.0..=655.35).contains(&seconds).then(|| Duration::from_secs_f64(seconds))
}

/// Parses a jump target with an optional condition, for example `*LABEL IF B000=1` or `JOB:NAME IF …`. A name may
/// contain any bytes except blanks.
fn jump(rest: &[u8], mark: &[u8]) -> Option<(Vec<u8>, Option<Condition>)> {
    let rest = rest.strip_prefix(mark)?;
    let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
    let (name, tail) = (rest[..end].to_vec(), std::str::from_utf8(rest[end..].trim_ascii()).ok()?);
    let condition = match tail.strip_prefix("IF ") {
        Some(text) => Some(condition(text)?),
        None if tail.is_empty() => None,
        None => return None,
    };
    Some((name, condition))
}

fn condition(text: &str) -> Option<Condition> {
    let (at, sign, comparison) =
        Comparison::SIGNS.into_iter().find_map(|(sign, comparison)| Some((text.find(sign)?, sign, comparison)))?;
    let (left, right) = (operand(&text[..at])?, operand(&text[at + sign.len()..])?);
    Some(Condition { left, comparison, right })
}

fn operand(text: &str) -> Option<Operand> {
    let text = text.trim();
    let signal = |mark: &str| text.strip_prefix(mark)?.strip_suffix(')')?.parse().ok().filter(|&number| number > 0);
    if let Some(on) = on_off(text) {
        return Some(Operand::Number(if on { 1.0 } else { 0.0 }));
    }
    if let Some((kind, index)) = variable(text) {
        return Some(Operand::Variable(kind, index));
    }
    signal("IN#(")
        .map(Operand::Input)
        .or_else(|| signal("OT#(").map(Operand::Output))
        .or_else(|| text.parse().ok().map(Operand::Number))
}

fn variable(text: &str) -> Option<(Kind, usize)> {
    Kind::parse(text.trim()).filter(|(kind, _)| matches!(kind, Kind::B | Kind::I | Kind::D | Kind::R))
}

fn on_off(text: &str) -> Option<bool> {
    match text.trim() {
        "ON" => Some(true),
        "OFF" => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const JOB: &[u8] = b"/JOB\r\n//NAME A\r\n//POS\r\n///NPOS 1,0,0,0,0,0\r\n///POSTYPE PULSE\r\nC00000=1,2,3,4,5,6\r\n\
//INST\r\nNOP\r\n*TOP\r\nMOVJ C00000 VJ=10.00\r\nINC B000\r\nWAIT IN#(3)=ON T=1.50\r\nJUMP *TOP IF B000<5\r\nARCON\r\nEND\r\n";

    #[test]
    fn reads_a_job() {
        let program = Program::parse(b"A", JOB).unwrap();
        assert_eq!(program.lines.len(), 8);
        assert_eq!(program.label(b"TOP"), Some(1));
        assert_eq!((program.step(1), program.step(2), program.step(7)), (0, 1, 1));
        assert_eq!(program.positions[&0], Target::Pulses([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0, 0.0]));
        assert_eq!(program.lines[6], Instruction::Pass);
        let Instruction::Wait(condition, limit) = &program.lines[4] else { panic!("{:?}", program.lines[4]) };
        assert_eq!((condition.left, *limit), (Operand::Input(3), Some(Duration::from_millis(1500))));
    }

    #[test]
    fn rejects_invalid_jobs() {
        let bare: Vec<u8> = JOB.iter().copied().filter(|&byte| byte != b'\r').collect();
        assert_eq!(Program::parse(b"A", &bare), Err(NOP_OR_END_MISSING));
        assert_eq!(Program::parse(b"B", JOB), Err(JOB_RECORD));
        assert_eq!(Program::parse(b"A", &JOB[..JOB.len() - 5]), Err(NOP_OR_END_MISSING));
        assert_eq!(Program::parse(b"A", b"hello"), Err(FORMAT));
        assert_eq!(Program::parse(b"A", b"/JOB\r\n//NAME A\r\nNOP\r\nMOVJ nowhere\r\nEND\r\n"), Err(SYNTAX));
    }

    #[test]
    fn unset_in_the_middle_of_a_sign_is_read_as_the_longer_one() {
        assert_eq!(condition("B001<>2").unwrap().comparison, Comparison::NotEqual);
        assert_eq!(condition("B001>=2").unwrap().comparison, Comparison::GreaterOrEqual);
        assert_eq!(condition("B001>2").unwrap().comparison, Comparison::Greater);
    }
}

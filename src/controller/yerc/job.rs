//! Text of a job file (JBI): its name, its positions, and what its instructions refer to.
//!
//! The parser accepts every instruction, also of newer controllers: it finds references by their form. Only the
//! simulator interprets instructions.

use super::signal::Signal;
use crate::references::{ProgrammedSpeed, Reference, Role};

/// A job in parts.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct JobText<'t> {
    /// Name in the line `//NAME`.
    pub name: Option<&'t str>,
    /// Lines with positions, such as `C00001=0,0,0,0,0,0`.
    pub positions: Vec<PositionLine<'t>>,
    /// Lines from NOP on, each with its line number in the file, from 1.
    pub instructions: Vec<(usize, &'t str)>,
}

/// A position of a job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PositionLine<'t> {
    /// Line of the file, from 1.
    pub line: usize,
    /// Name as in the file, such as `C00001` or `BC00001`.
    pub key: &'t str,
    /// Whole line, without blanks at its ends.
    pub text: &'t str,
}

impl<'t> JobText<'t> {
    /// Splits the decoded text of a job.
    pub fn new(text: &'t str) -> Self {
        let mut job = Self::default();
        for (number, line) in (1..).zip(text.lines()) {
            let line = line.trim_end();
            if !job.instructions.is_empty() || line.trim() == "NOP" {
                job.instructions.push((number, line));
            } else if let Some(name) = line.strip_prefix("//NAME ") {
                job.name = job.name.or(Some(name.trim()));
            } else if let Some((key, _)) = line.split_once('=')
                && position(key).is_some()
            {
                job.positions.push(PositionLine { line: number, key, text: line });
            }
        }
        job
    }
}

/// Notation of a position of a job without leading zeros: `C1` for `C00001`. `None` for other words.
pub fn position(word: &str) -> Option<String> {
    let (letters, number) = numbered(word)?;
    ["C", "BC", "EC"].contains(&letters).then(|| format!("{letters}{number}"))
}

/// Instructions whose first operand gets a new value.
const WRITERS: [&str; 16] = [
    "SET", "DIN", "DOUT", "AOUT", "PULSE", "GETS", "GETE", "GETPOS", "GETARG", "CNVRT", "MFRAME", "SQRT", "SIN", "COS",
    "ATAN", "NOT",
];
/// Instructions whose first operand gets a new value that depends on its old value.
const UPDATERS: [&str; 11] = ["ADD", "SUB", "MUL", "DIV", "INC", "DEC", "AND", "OR", "XOR", "SETE", "CLEAR"];
/// Instructions that call a job, start it in another task, or continue with it.
const CALLERS: [&str; 3] = ["CALL", "PSTART", "JUMP"];
/// Variables, also as local variables of a job with an `L`: `LB000`.
const VARIABLES: [&str; 8] = ["B", "I", "D", "R", "S", "P", "BP", "EX"];
/// Speeds with their units. The unit of `V=` depends on a parameter of the controller; it is mm/s in the factory state.
const SPEEDS: [(&str, &str); 4] = [("VJ", "%"), ("V", "mm/s"), ("VR", "deg/s"), ("VE", "%")];

/// Returns what an instruction refers to, and its speeds.
pub fn scan(line: &str) -> (Vec<Reference>, Vec<ProgrammedSpeed>) {
    let text = line.trim_start();
    let mut scanner = Scanner { line, at: line.len() - text.len(), references: Vec::new(), speeds: Vec::new() };
    // A comment, or a line that is switched off. A controller keeps the positions of such a line.
    let is_off = text.starts_with("//");
    if !text.starts_with('\'') {
        scanner.scan();
    }
    if is_off {
        scanner.references.retain(|reference| reference.role == Role::Position);
        scanner.speeds.clear();
    }
    (scanner.references, scanner.speeds)
}

struct Scanner<'t> {
    line: &'t str,
    at: usize,
    references: Vec<Reference>,
    speeds: Vec<ProgrammedSpeed>,
}

impl<'t> Scanner<'t> {
    fn scan(&mut self) {
        let start = self.at;
        let word = self.word();
        if word.is_empty() && self.rest().starts_with('*') {
            return self.label(Role::Label);
        }
        if !word.is_empty() {
            self.add(Role::Word, word.to_owned(), start);
        }
        let first = self.references.len();
        while let Some(next) = self.rest().chars().next() {
            let is_start = self.line[..self.at].ends_with(char::is_whitespace);
            match next {
                '"' => self.at += 1 + self.rest()[1..].find('"').map_or(self.rest().len() - 1, |end| end + 1),
                '*' if is_start && word == "JUMP" => self.label(Role::Jump),
                _ if next.is_ascii_alphabetic() => self.operand(),
                _ => self.at += next.len_utf8(),
            }
        }
        let is_target = |reference: &Reference| matches!(reference.role, Role::Call | Role::Jump);
        if CALLERS.contains(&word) && !self.references.iter().any(is_target) {
            self.add(Role::ComputedCall, String::new(), start);
        }
        if matches!(word, "JUMP" | "PSTART") {
            let calls = self.references.iter_mut().filter(|reference| reference.role == Role::Call);
            calls.for_each(|reference| reference.role = Role::Start);
        }
        let role = match word {
            _ if WRITERS.contains(&word) => Role::Write,
            _ if UPDATERS.contains(&word) => Role::Update,
            _ => return,
        };
        if let Some(target) = self.references.get_mut(first).filter(|target| target.role == Role::Read) {
            target.role = role;
        }
    }

    /// Takes an operand that begins with letters.
    fn operand(&mut self) {
        let start = self.at;
        let word = self.word();
        let rest = self.rest();
        if let Some(name) = rest.strip_prefix(':').filter(|_| word == "JOB") {
            let name = &name[..name.find(char::is_whitespace).unwrap_or(name.len())];
            self.at += 1 + name.len();
            return self.add(Role::Call, name.to_owned(), start);
        }
        if let Some(rest) = rest.strip_prefix('=') {
            let number = &rest[..rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len())];
            let speed = SPEEDS.iter().find(|(tag, _)| *tag == word);
            if let (Some((_, unit)), Ok(value)) = (speed, number.parse()) {
                self.speeds.push(ProgrammedSpeed { value, unit, column: self.column(start) });
            }
        }
        if let Some(inner) = rest.strip_prefix('#') {
            let digits = inner.trim_start_matches('(');
            let digits = &digits[..digits.find(|c: char| !c.is_ascii_digit()).unwrap_or(digits.len())];
            // The number of an indirect signal is in a variable, which the scan finds next.
            let number = digits.parse::<u32>().map_or("*".to_owned(), |number| number.to_string());
            return self.add(Role::Read, format!("{word}#{number}"), start);
        }
        let letters = word.strip_prefix('L').filter(|_| word.len() > 1).unwrap_or(word);
        if let Some(inner) = rest.strip_prefix('[').filter(|_| VARIABLES.contains(&letters)) {
            let digits = &inner[..inner.find(|c: char| !c.is_ascii_digit()).unwrap_or(inner.len())];
            let number = digits.parse::<u32>().map_or("*".to_owned(), |number| number.to_string());
            return self.add(Role::Read, format!("{word}{number}"), start);
        }
        if let Some(name) = position(word) {
            self.add(Role::Position, name, start);
        } else if let Some(name) = variable(word) {
            self.add(Role::Read, name, start);
        }
    }

    /// Takes a label up to the next blank.
    fn label(&mut self, role: Role) {
        let start = self.at;
        let text = &self.rest()[1..];
        let name = &text[..text.find(char::is_whitespace).unwrap_or(text.len())];
        self.at += 1 + name.len();
        if !name.is_empty() {
            self.add(role, name.to_owned(), start);
        }
    }

    /// Takes letters, digits and `_`.
    fn word(&mut self) -> &'t str {
        let rest = self.rest();
        let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    fn rest(&self) -> &'t str {
        &self.line[self.at..]
    }

    fn column(&self, at: usize) -> usize {
        self.line[..at].chars().count() + 1
    }

    fn add(&mut self, role: Role, name: String, at: usize) {
        let column = self.column(at);
        self.references.push(Reference { role, name, column });
    }
}

/// Notation of a variable without leading zeros: `B5` for `B005`, `LB0` for `LB000`. `None` for other words.
fn variable(word: &str) -> Option<String> {
    let (letters, number) = numbered(word)?;
    let kind = letters.strip_prefix('L').filter(|kind| !kind.is_empty()).unwrap_or(letters);
    VARIABLES.contains(&kind).then(|| format!("{letters}{number}"))
}

/// Splits a word such as `BC00001` into its letters and its number.
fn numbered(word: &str) -> Option<(&str, u32)> {
    let at = word.find(|c: char| c.is_ascii_digit())?;
    let (letters, digits) = word.split_at(at);
    digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| Some((letters, digits.parse().ok()?)))?
}

/// Names under which the instructions refer to an object that a user typed: a variable (`B5`), a position of a job
/// (`C1`), a signal (`OUT3`, `OT#(3)`, `#10012`), or another numbered object (`UF#(1)`). The groups of a signal are
/// included. Empty for other texts.
pub fn names_of(text: &str) -> Vec<String> {
    let text = text.trim().to_ascii_uppercase();
    if let Some(name) = variable(&text).or_else(|| position(&text)) {
        return vec![name];
    }
    let plain: String = text.chars().filter(|c| !"#()".contains(*c)).collect();
    let signal = if text.starts_with('#') { text.parse::<Signal>().ok().and_then(general_signal) } else { None };
    let Some((letters, number)) = signal.or_else(|| numbered(&plain).map(|(word, number)| (word.to_owned(), number)))
    else {
        return Vec::new();
    };
    let groups: &[(&str, u32)] = match letters.as_str() {
        "IN" => &[("IN", 1), ("IGH", 4), ("IG", 8)],
        "OUT" | "OT" => &[("OT", 1), ("OGH", 4), ("OG", 8)],
        _ if text.contains('#') && !letters.is_empty() => return vec![format!("{letters}#{number}")],
        _ => return Vec::new(),
    };
    let Some(index) = number.checked_sub(1) else { return Vec::new() };
    groups.iter().map(|(word, size)| format!("{word}#{}", index / size + 1)).collect()
}

/// Word and number of a general-purpose signal in instructions: `OT` and 1 for #10010.
fn general_signal(signal: Signal) -> Option<(String, u32)> {
    let (word, first) = match signal.group() {
        group @ 1..=1000 => ("IN", group - 1),
        group @ 1001..=2000 => ("OT", group - 1001),
        _ => return None,
    };
    Some((word.to_owned(), u32::from(first) * 8 + u32::from(signal.bit()) + 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: &str) -> String {
        let (references, speeds) = scan(line);
        let references = references.iter().filter(|reference| reference.role != Role::Word);
        let words = references.map(|reference| format!("{:?} {}@{}", reference.role, reference.name, reference.column));
        words.chain(speeds.iter().map(|speed| format!("{}{}", speed.value, speed.unit))).collect::<Vec<_>>().join(", ")
    }

    #[test]
    fn a_line_without_an_instruction_has_no_word() {
        for line in ["", "  "] {
            assert_eq!(scan(line).0, [], "{line}");
        }
    }

    #[test]
    fn finds_references_by_their_form() {
        for (line, expected) in [
            ("*AGAIN", "Label AGAIN@1"),
            ("JUMP *AGAIN IF B000<3", "Jump AGAIN@6, Read B0@16"),
            ("CALL JOB:COUNT IF IN#(12)=ON", "Call COUNT@6, Read IN#12@19"),
            ("PSTART JOB:部品-1 SUB1", "Start 部品-1@8"),
            ("JUMP JOB:MAIN", "Start MAIN@6"),
            ("CALL IG#(1)", "Read IG#1@6, ComputedCall @1"),
            ("JUMP IG#(1)", "Read IG#1@6, ComputedCall @1"),
            ("   MOVL C00001 BC00002 V=200.0 PL=1", "Position C1@9, Position BC2@16, 200mm/s"),
            ("MOVJ P003 VJ=0.78", "Read P3@6, 0.78%"),
            ("MOVL P[I000] V=D000", "Read P*@6, Read I0@8, Read D0@16"),
            ("SET B000 EXPRESS B001 * LB002", "Write B0@5, Read B1@18, Read LB2@25"),
            ("SET D[10] 5", "Write D10@5"),
            ("INC I012", "Update I12@5"),
            ("DOUT OT#(3) ON", "Write OT#3@6"),
            ("DOUT OG#(B003) 5", "Write OG#*@6, Read B3@10"),
            ("DIN B001 IGH#(2)", "Write B1@5, Read IGH#2@10"),
            ("WAIT IN#(1)=ON T=B003", "Read IN#1@6, Read B3@18"),
            ("MSG \"SET B001\"", ""),
            ("'SET B001 5", ""),
            ("//MOVJ C00004 VJ=5.00", "Position C4@8"),
            ("REFP 1 C00005", "Position C5@8"),
            ("FRAME UF#(2) P001", "Read UF#2@7, Read P1@14"),
            ("SET S000 \"B1", "Write S0@5"),
        ] {
            assert_eq!(found(line), expected, "{line}");
        }
    }

    proptest::proptest! {
        #[test]
        fn accepts_every_line(line in "(JUMP |SET |\"|\\*|B\\[|OT#\\(|JOB:|V=|[ \\PC]){0,12}") {
            let columns = 1..=line.chars().count() + 1;
            proptest::prop_assert!(scan(&line).0.iter().all(|reference| columns.contains(&reference.column)));
        }
    }

    #[test]
    fn splits_a_job() {
        let text = "/JOB\r\n//NAME A\r\n//POS\r\n///NPOS 1,0,0,0,0,0\r\nC00000=1,2\r\n//INST\r\nNOP\r\nEND\r\n";
        let job = JobText::new(text);
        assert_eq!((job.name, job.positions[0].key, job.positions[0].line), (Some("A"), "C00000", 5));
        assert_eq!(job.instructions, [(7, "NOP"), (8, "END")]);
    }

    #[test]
    fn typed_objects_have_the_names_of_instructions() {
        for (text, names) in [
            ("b005", &["B5"][..]),
            ("OUT3", &["OT#3", "OGH#1", "OG#1"]),
            ("ot#(17)", &["OT#17", "OGH#5", "OG#3"]),
            ("#10030", &["OT#17", "OGH#5", "OG#3"]),
            ("#00011", &["IN#2", "IGH#1", "IG#1"]),
            ("UF#(1)", &["UF#1"]),
            ("c00001", &["C1"]),
            ("clamp", &[]),
            ("OT0", &[]),
        ] {
            assert_eq!(names_of(text), names, "{text}");
        }
    }
}

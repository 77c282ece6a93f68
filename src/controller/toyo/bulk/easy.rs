//! Easy programs in TOML, one per line: `1 = { start = 10, loop = 5, end = 20 }`.

use std::collections::HashMap;
use std::fmt::Write as _;

use super::reading::{self, Reading};
use crate::findings::Finding;
use crate::toyo::field::{Field, Value};
use crate::toyo::table::Command;

/// Number and values of an easy program.
pub type Filled = (i32, Vec<Value>);

/// The fields of a program, without its number and the constant 0.
pub fn fields() -> &'static [Field] {
    Command::Wesy.row().requests[0].fields.get(2..).unwrap_or_default()
}

/// Formats programs as TOML.
pub fn write(programs: &[Filled]) -> String {
    let mut text = "# Easy programs: start tag, end tag and number of runs\n".to_owned();
    for (program, values) in programs {
        let _ = writeln!(text, "{program} = {}", reading::toml(fields(), values));
    }
    text
}

/// Parses programs from TOML, in their order. Each must be unique, complete and in range.
pub fn read(bytes: &[u8]) -> Result<Vec<Filled>, Vec<Finding>> {
    reading::read(bytes, programs)
}

fn programs(reading: &mut Reading<'_>, document: &toml_edit::Table) -> Vec<Filled> {
    let number = &Command::Wesy.row().requests[0].fields[0];
    let mut programs: Vec<Filled> = Vec::new();
    let mut line_of_program: HashMap<i32, usize> = HashMap::new();
    for (name, item) in document {
        let at = reading.key(document, name);
        let program = match number.read(name) {
            Ok(Value::Number(program)) => program,
            Ok(_) => continue,
            Err(error) => {
                reading.findings.error(at, error.to_string(), None);
                continue;
            }
        };
        if let Some(other) = line_of_program.insert(program, at.line) {
            reading.findings.error(at, format!("program {program} already exists in line {other}"), None);
        }
        programs.push((program, reading.values(name, fields(), item, at)));
    }
    programs.sort_by_key(|(program, _)| *program);
    programs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_written_file_reads_back_unchanged() {
        let text = "# Easy programs: start tag, end tag and number of runs\n1 = { start = 10, loop = 5, end = 20 \
                    }\n8 = { start = 0, loop = 9999, end = 999 }\n";
        assert_eq!(write(&read(text.as_bytes()).unwrap()), text);
    }

    #[test]
    fn errors_have_line_and_column() {
        let errors = |text: &str| -> Vec<String> {
            read(text.as_bytes()).unwrap_err().iter().map(ToString::to_string).collect()
        };
        let values = "{ start = 1, loop = 1, end = 1 }";
        assert_eq!(
            errors(&format!("9 = {values}")),
            ["line 1, column 1: error: program: 9 is out of range (a number, 1 to 8)"]
        );
        assert_eq!(
            errors(&format!("1 = {values}\n01 = {values}")),
            ["line 2, column 1: error: program 1 already exists in line 1"]
        );
        assert_eq!(
            errors("1 = { start = 1, loop = 1 }"),
            ["line 1, column 1: error: end is missing: a number, 0 to 999"]
        );
    }
}

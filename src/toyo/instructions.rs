//! Descriptions of the instructions of sequential programs, for `explain` and as a topic of `help`.

use std::fmt::Write as _;

use crate::prelude::basics::*;
use armctl_controller::toyo::field::{Field, Form, Number};
use armctl_controller::toyo::table::Instruction;
use armctl_controller::toyo::table::instructions::{INSTRUCTIONS, SECTION};

/// An instruction of sequential programs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct InstructionHelp {
    /// Word that the instruction begins with.
    instruction: &'static str,
    /// What the instruction does.
    about: &'static str,
    /// Form of the instruction in a program.
    form: String,
    /// Example line of a program.
    example: &'static str,
    /// Section of the manual.
    section: &'static str,
    /// Controllers that have the instruction; empty for all controllers.
    only_on: Vec<&'static str>,
    /// Operands in order.
    operands: Vec<Operand>,
}

/// An operand of an instruction.
#[derive(Debug, Serialize, JsonSchema)]
struct Operand {
    /// Name of the operand in the form.
    name: &'static str,
    /// Meaning of the operand.
    about: &'static str,
    /// Minimum; null if the operand is not a number.
    least: Option<f64>,
    /// Maximum; null if the operand is not a number.
    most: Option<f64>,
    /// Unit of the number; null if it has no unit.
    unit: Option<&'static str>,
    /// Valid words; empty if the operand is not a word.
    words: Vec<OperandWord>,
    /// Description of the valid values.
    #[serde(skip)]
    values: String,
}

/// A valid word of an operand.
#[derive(Debug, Serialize, JsonSchema)]
struct OperandWord {
    word: &'static str,
    meaning: &'static str,
}

impl InstructionHelp {
    /// Creates the description from a row of the instruction table.
    pub fn new(row: &'static Instruction) -> Self {
        Self {
            instruction: row.word,
            about: row.about,
            form: row.form(),
            example: row.example,
            section: SECTION,
            only_on: row.only_on.to_vec(),
            operands: row.layout.fields.iter().map(Operand::new).collect(),
        }
    }

    /// Sections for a terminal.
    pub fn sections(&self) -> Vec<Section> {
        let Self { instruction, about, form, example, section, only_on, operands } = self;
        let mut fields: Vec<(&'static str, Cell)> = vec![
            ("instruction", (*instruction).into()),
            ("does", (*about).into()),
            ("form", form.as_str().into()),
            ("example", (*example).into()),
            ("manual", format!("section {section}").into()),
        ];
        if !only_on.is_empty() {
            fields.push(("only on", only_on.join(", ").into()));
        }
        let mut table = Table::new(&["operand", "values", "meaning"], "");
        for Operand { name, values, about, .. } in operands {
            table.row([(*name).into(), values.as_str().into(), (*about).into()]);
        }
        let table = (!operands.is_empty()).then_some(Section::Table(table));
        std::iter::once(Section::Fields(fields)).chain(table).collect()
    }
}

impl Operand {
    fn new(field: &Field) -> Self {
        let number = if let Form::Number(number) = field.form { Some(number) } else { None };
        let of = |number: Number, value: i32| number.plain(value).parse().ok();
        let words = if let Form::Word(words) = field.form { words } else { &[] };
        let words = words.iter().map(|word| OperandWord { word: word.text.trim_end(), meaning: word.about });
        let words: Vec<OperandWord> = words.collect();
        let meanings =
            words.iter().map(
                |OperandWord { word, meaning }| {
                    if word == meaning { (*word).to_owned() } else { format!("{word} ({meaning})") }
                },
            );
        let meanings = meanings.collect::<Vec<_>>().join(", ");
        Self {
            name: field.name,
            about: field.about,
            least: number.and_then(|number| of(number, number.least)),
            most: number.and_then(|number| of(number, number.most)),
            unit: Some(field.unit).filter(|unit| !unit.is_empty()),
            values: if words.is_empty() { field.expected().replace("a number, ", "") } else { meanings },
            words,
        }
    }
}

/// The `help` topic with all instructions.
pub fn topic() -> (&'static str, &'static str, String) {
    let mut text = HEAD.to_owned();
    for row in &INSTRUCTIONS {
        let only = if row.only_on.is_empty() { "" } else { " (KCA-25)" };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:<5} {}{only}", row.word, row.about);
        if !row.layout.fields.is_empty() {
            let _ = writeln!(text, "      {}\n      {}", row.form(), row.example);
        }
    }
    ("toyo-instructions", "the 55 instructions of Toyo programs", text)
}

const HEAD: &str = "Instructions of Toyo programs (section 2-5 of the manual)

A file has one step per line. # and ; begin a comment. A label replaces a tag
number. Numbers can be short. A name of a point, counter or timer (robots.toml)
replaces its number: PT=pick, JMPC TAG=next parts>=5. `MOVP pick` alone is
MOVP a PT=pick CN=0 S V=0 POST.

      SPD V=5
next: MOVP a PT=1 CN=0 S V=0 POST
      JMPI TAG=next STN=0 PN1=.......1   ; while the gripper is full
      END

`armctl explain toyo MOVP` shows the operands with their ranges and units.
Below: the instruction, what it does, its form, an example.

";

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_controller::toyo::program::check;
    use armctl_frame::output::render;

    #[test]
    fn every_example_is_an_instruction_of_its_row() {
        for row in &INSTRUCTIONS {
            let text = format!("{}\nNOP\nTAG TAG=2\nTAG TAG=20\nEND\n", row.example);
            let text = if row.word == "TAG" { text } else { format!("TAG TAG=1\n{text}") };
            let program = check(text.as_bytes(), 100).program.unwrap_or_else(|| panic!("{}", row.example));
            assert!(program.steps.iter().any(|step| step.instruction.word == row.word), "{}", row.example);
        }
    }

    #[test]
    fn the_help_topic_has_all_instructions_and_fits_80_columns() {
        let (_, _, text) = topic();
        let wide: Vec<&str> = text.lines().filter(|line| line.chars().count() > 80).collect();
        assert!(wide.is_empty(), "{wide:?}");
        assert!(INSTRUCTIONS.iter().all(|row| text.contains(&format!("\n{:<5} {}", row.word, row.about))));
    }

    #[test]
    fn an_instruction_is_explained_with_ranges_and_units() {
        let row = Instruction::named("OUTP").unwrap();
        let help = InstructionHelp::new(row);
        let text = render::text(&View { sections: help.sections() }, 80, false);
        assert!(text.contains("form         OUTP STN=<station> PN<port>=<data> TM=<time>"), "{text}");
        assert!(text.contains("0.0 to 99.9 s"), "{text}");
        assert!(text.contains("manual       section 2-5"), "{text}");
        let operand = help.operands.last().unwrap();
        assert_eq!((operand.least, operand.most, operand.unit), (Some(0.0), Some(99.9), Some("s")));
    }
}

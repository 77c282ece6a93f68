//! `yerc var set`.

use std::str::FromStr;

use super::cells::LAST_TOOL;
use super::position_word::Word;
use super::table::{Draft, StringForm, Variables};
use crate::prelude::*;
use armctl_controller::names::Kind;
use armctl_controller::user_input::{self, integer};
use armctl_controller::yerc::variables::{Reference, Value, VariableKind};
use armctl_frame::store::{Row, TableWrite, WrittenOf, write};
use armctl_frame::teach::parse_printed_position;

/// Writes variables.
#[derive(Debug, Args)]
#[command(
    after_help = "armctl checks all values before it sends the first value. It sends consecutive numbers in one \
                  request, and does not write equal values. A position is pulse:s=0,l=0,u=0,r=0,b=0,t=0 or \
                  base:x=…,y=…,z=…,rx=…,ry=…,rz=… in mm and degrees, with tool=, user=, form=back+lower+noflip. @FILE \
                  reads the output of `var get P1 --json` or `position --json` (the pulses, if the output has pulses \
                  and coordinates; @- is stdin). P1=here is the same as `teach P1`. BP accepts base: or pulse:, EX \
                  accepts pulse:1=…. P1.tool=2, P1.user=1 and BP5.axis1=-1 change only that part: armctl reads the \
                  variable, changes the part and writes the whole variable back. Axis parts are in protocol steps \
                  (pulses, or 0.001 mm and 0.0001 degree)."
)]
pub struct Set {
    /// Variables with their new values, for example B0=255, I5=-2, R3=1.5, S7=HELLO, P1=base:x=…, P1=@FILE, or NAME=255
    #[arg(required = true, value_name = "REF=VALUE", add = complete::VARIABLE_VALUE)]
    assignments: Vec<Assignment>,
    #[command(flatten)]
    form: StringForm,
}

/// An assignment such as `B0=255`. It is checked as far as possible without the settings of the robot.
#[derive(Debug, Clone, PartialEq)]
struct Assignment {
    reference: Reference,
    input: Input,
}

#[derive(Debug, Clone, PartialEq)]
enum Input {
    Ready(Value),
    /// A string. Its encoding is not known yet.
    Text(String),
    /// A position in a JSON file.
    File(PathBuf),
    /// One word of a position.
    Word(Word),
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = user_input::split_setting(text, "a variable", "a value", "B0=255")?;
        let (reference, field) = reference_of(name)?;
        let Some(reference) = reference else {
            // The values that are valid depend on the variable of the name, which is not known yet.
            return Ok(Self { reference: ANY, input: Input::Text(value.to_owned()) });
        };
        if let Some(field) = field {
            return Ok(Self { reference, input: Input::Word(word(reference, field, value)?) });
        }
        let kind = reference.kind;
        let input = match value.strip_prefix('@') {
            Some(path) if kind.is_position() => Input::File(path.into()),
            _ if matches!(kind, VariableKind::S16 | VariableKind::S32) => Input::Text(value.to_owned()),
            _ => {
                let value = Value::from_text(kind, value.as_bytes()).map_err(message)?;
                if let Value::Position(position) = &value {
                    in_range("tool", position.tool)?;
                }
                Input::Ready(value)
            }
        };
        Ok(Self { reference, input })
    }
}

/// Variable that takes the place of a name that is not resolved yet.
const ANY: Reference = Reference::new(VariableKind::B, 0);

/// Parses a variable or its name, and the part after it. For a name, the variable is not known yet.
fn reference_of(text: &str) -> Result<(Option<Reference>, Option<&str>), String> {
    let parts = text.rsplit_once('.').map(|(name, field)| (name, Some(field)));
    let address = |name: &str| name.parse::<Reference>().map_err(message);
    // A name may contain a dot, so the part is after the last dot.
    let (name, field) = match parts {
        Some((name, field)) if is_part(field.unwrap_or_default()) || address(name).is_ok() => (name, field),
        _ => (text, None),
    };
    let (reference, is_open) = names::parse_or_name_marked(&[Kind::Variable], "B0", name, address)?;
    Ok(((!is_open).then_some(reference), field))
}

/// Whether a word names a part of a position.
fn is_part(field: &str) -> bool {
    matches!(field, "tool" | "user") || field.strip_prefix("axis").is_some_and(|number| number.parse::<u8>().is_ok())
}

fn in_range(what: &str, number: u32) -> Result<u32, String> {
    if number <= LAST_TOOL {
        Ok(number)
    } else {
        Err(format!("{what}: {number} is not a number from 0 to {LAST_TOOL}"))
    }
}

/// Parses a value for a single word of a position (3.3.16 to 3.3.18).
fn word(reference: Reference, field: &str, value: &str) -> Result<Word, String> {
    let kind = reference.kind;
    if !kind.is_position() {
        return Err(format!("{reference} has no parts; only positions (P, BP, EX) have parts"));
    }
    let is_robot = kind == VariableKind::P;
    let number = integer(value);
    let axis = field.strip_prefix("axis").and_then(|number| number.parse::<u8>().ok());
    match (field, axis.filter(|axis| matches!(axis, 1..=8))) {
        ("tool" | "user", _) if is_robot => {
            let number = number.and_then(|number| u32::try_from(number).ok());
            let number = number.ok_or_else(|| format!("'{value}' is not a number from 0 to {LAST_TOOL}"))?;
            let number = in_range(field, number)?;
            Ok(if field == "tool" { Word::Tool(number) } else { Word::User(number) })
        }
        (_, Some(axis)) => {
            let steps = number.and_then(|number| i32::try_from(number).ok()).ok_or_else(|| {
                format!("'{value}' is not a number from {} to {} (protocol steps)", i32::MIN, i32::MAX)
            })?;
            Ok(Word::Axis(axis - 1, steps))
        }
        _ if is_robot => {
            Err(format!("'{field}' is not a valid part to write; the parts are tool, user, axis1 to axis8"))
        }
        _ => Err(format!("'{field}' is not a valid part to write; the parts are axis1 to axis8")),
    }
}

#[expect(clippy::needless_pass_by_value, reason = "made for map_err")]
fn message(error: impl ToString) -> String {
    error.to_string()
}

impl Command for Set {
    type Family = Yerc;
    type Report = WrittenOf<Variables>;
    const ID: &'static str = Variables::IDS.set;
    const INTENT: &'static str = "overwrite taught positions";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    /// Only positions contain taught data.
    fn risk(&self) -> Risk {
        let is_position = self.assignments.iter().any(|assignment| assignment.reference.kind.is_position());
        if is_position { Risk::Destroy } else { Risk::Write }
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<WrittenOf<Variables>> {
        let Context { link, screen, robot, confirmer, .. } = context;
        let mut table = Variables::open(link, &self.form).await?;
        let keys: Vec<Reference> = self.assignments.iter().map(|assignment| assignment.reference).collect();
        table.prepare(link, &keys).await?;
        let rows = self.rows(&table)?;
        write(TableWrite { table, robot, link, screen, confirmer }, rows).await?.or_only_failure()
    }
}

impl Set {
    /// New content of each variable. If a position is written completely, single words for it are merged into the
    /// position.
    fn rows(&self, table: &Variables) -> Result<Vec<Row<Variables>>> {
        let mut rows: Vec<Row<Variables>> = Vec::new();
        let repeated = |key| Failure::usage(format!("{key} appears twice")).hint("type one value for each variable");
        for Assignment { reference, input } in &self.assignments {
            let row = rows.iter_mut().find(|(key, _)| key == reference).map(|(_, draft)| draft);
            match (input, row) {
                (Input::Word(word), None) => rows.push((*reference, Draft::Words(vec![*word]))),
                (Input::Word(word), Some(Draft::Words(words))) if words.iter().all(|it| it.name() != word.name()) => {
                    words.push(*word);
                }
                (Input::Word(word), Some(Draft::Whole(value))) => word.set(value),
                (input, None) => rows.push((*reference, Draft::Whole(value_of(table, *reference, input)?))),
                (input, Some(draft)) => {
                    let (Draft::Words(words), false) = (&*draft, matches!(input, Input::Word(_))) else {
                        return Err(repeated(reference));
                    };
                    let mut value = value_of(table, *reference, input)?;
                    for word in words {
                        word.set(&mut value);
                    }
                    *draft = Draft::Whole(value);
                }
            }
        }
        Ok(rows)
    }
}

fn value_of(table: &Variables, reference: Reference, input: &Input) -> Result<Value> {
    let wrong = |error: String| Failure::usage(format!("{reference}: {error}"));
    match input {
        Input::Ready(value) => Ok(value.clone()),
        Input::Text(text) => table.parse(reference, text).map_err(|error| {
            wrong(error).hint(
                "check the length: full-width characters take two bytes each; use --encoding to set the encoding of \
                 the robot",
            )
        }),
        Input::File(path) => table.parse(reference, &parse_printed_position(path)?).map_err(|error| {
            Failure::usage(format!("{}: {error}", path.display()))
                .hint(format!("use a file with a position of {}", reference.kind.letters()))
        }),
        Input::Word(_) => Err(wrong("a part is not a value".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        text.parse::<Assignment>().unwrap_err()
    }

    #[test]
    fn checks_values_before_sending() {
        assert_eq!(error("B0=256"), "'256' is not a number from 0 to 255");
        assert_eq!(error("B0"), "write a variable, '=' and a value, for example B0=255");
        assert_eq!(
            error("X0=1"),
            "'X0' is not a variable; use B, I, D, R, S, P, BP or EX with a number, for example B0 or B0..B99"
        );
        assert!(error("P1=base:x=1").starts_with("axis 'y' is missing"));
        assert_eq!(error("P1=pulse:s=0,l=0,u=0,r=0,b=0,t=0,tool=64"), "tool: 64 is not a number from 0 to 63");
        assert!(error("B0.tool=1").starts_with("B0 has no parts"));
        assert!(error("P1.form=1").contains("tool, user, axis1 to axis8"));
        assert!(error("BP1.tool=1").ends_with("the parts are axis1 to axis8"));
        assert!(error("EX1.axis9=1").contains("axis1 to axis8"));
        let tool = "P1.tool=0x2".parse::<Assignment>().map(|it| it.input);
        assert_eq!(tool, Ok(Input::Word(Word::Tool(2))));
        assert!("S0=".parse::<Assignment>().is_ok());
        assert!("S0=@home".parse::<Assignment>().is_ok_and(|it| it.input == Input::Text("@home".to_owned())));
    }
}

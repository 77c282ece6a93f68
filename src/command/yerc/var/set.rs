//! `yerc var set`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::super::orders::usage;
use super::super::writes::{WriteOrder, before, write_all};
use super::entry::Entry;
use super::overwrite::{overwritten, read_taught, with_field};
use super::part::{self, Word, Words};
use super::position::as_position;
use super::read::once;
use super::{in_form, listed, model_of};
use crate::command::frame::dry_run::unknown;
use crate::command::frame::orders::Old;
use crate::command::frame::teach::printed_position;
use crate::command::frame::{names, orders};
use crate::command::yerc::complete;
use crate::command::yerc::link::Link;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context, Report};
use crate::controller::Risk;
use crate::controller::names::Kind;
use crate::controller::typed::{self, integer};
use crate::controller::yerc::payload::{PayloadError, Position};
use crate::controller::yerc::query::{Query, WriteField, WriteVariable};
use crate::controller::yerc::request::Request;
use crate::controller::yerc::variables::{Reference, Value, VariableKind, WriteStep, plan_reads, plan_writes};
use crate::failure::Failure;
use crate::gate::{self, Confirmation};
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Table, View};

/// Writes variables.
#[derive(Debug, Args)]
#[command(
    after_help = "All values are checked before the first is sent; consecutive numbers are sent in one request. A \
                  position is pulse:s=0,l=0,u=0,r=0,b=0,t=0 or base:x=…,y=…,z=…,rx=…,ry=…,rz=… in mm and degrees, with \
                  tool=, user=, form=back+lower+noflip. @FILE reads the output of `var get P1 --json` or `position \
                  --json` (its pulses, if it has both; @- is stdin). P1=here is the same as `teach P1`. BP accepts \
                  base: or pulse:, EX pulse:1=…. P1.tool=2, P1.user=1 and BP5.axis1=-1 change only that word (a P is \
                  read, changed and written back completely). Axis words are in protocol steps (pulses, or 0.001 mm \
                  and 0.0001 degree)."
)]
pub struct Set {
    /// B0=255, I5=-2, R3=1.5, S7=HELLO, P1=base:x=…, P1=@FILE, or NAME=255
    #[arg(required = true, value_name = "REF=VALUE", add = complete::VARIABLE_VALUE)]
    assignments: Vec<Assignment>,
    /// Write strings with the 16-byte commands, even on a DX200
    #[arg(long)]
    s16: bool,
}

/// An assignment such as `B0=255`, checked as far as possible without the robot's settings.
#[derive(Debug, Clone, PartialEq)]
struct Assignment {
    reference: Reference,
    input: Input,
}

#[derive(Debug, Clone, PartialEq)]
enum Input {
    Ready(Value),
    /// String, with an encoding that is not known yet.
    Text(String),
    /// Position in a JSON file.
    File(PathBuf),
    /// One word of a BP or EX.
    Field(WriteField),
    /// One word of a P.
    Word(Word),
}

impl FromStr for Assignment {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, value) = typed::setting(text, "a variable", "a value", "B0=255")?;
        let (reference, field) = reference_of(name)?;
        let Some(reference) = reference else {
            // The variable of a name decides which values are valid.
            return Ok(Self { reference: ANY, input: Input::Text(value.to_owned()) });
        };
        if let Some(field) = field {
            return Ok(Self { reference, input: field_of(reference, field, value)? });
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

/// Placeholder for a name that is not resolved yet.
const ANY: Reference = Reference::new(VariableKind::B, 0);

/// Parses a variable or its name, and the part after it; no variable yet for a name.
fn reference_of(text: &str) -> Result<(Option<Reference>, Option<&str>), String> {
    let parts = text.rsplit_once('.').map(|(name, field)| (name, Some(field)));
    let address = |name: &str| name.parse::<Reference>().map_err(message);
    // A name may contain a dot; the part is after the last dot.
    let (name, field) = match parts {
        Some((name, field)) if is_part(field.unwrap_or_default()) || address(name).is_ok() => (name, field),
        _ => (text, None),
    };
    let (reference, is_open) = names::read_marked(&[Kind::Variable], "B0", name, address)?;
    Ok(((!is_open).then_some(reference), field))
}

/// Whether a word is a part of a position.
fn is_part(field: &str) -> bool {
    matches!(field, "tool" | "user") || field.strip_prefix("axis").is_some_and(|number| number.parse::<u8>().is_ok())
}

/// Tools are 0 to 63 (3.3.16).
const LAST_TOOL: u32 = 63;

fn in_range(what: &str, number: u32) -> Result<u32, String> {
    if number <= LAST_TOOL {
        Ok(number)
    } else {
        Err(format!("{what}: {number} is not a number from 0 to {LAST_TOOL}"))
    }
}

/// Parses a single word (3.3.16 to 3.3.18).
fn field_of(reference: Reference, field: &str, value: &str) -> Result<Input, String> {
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
            Ok(Input::Word(if field == "tool" { Word::Tool(number) } else { Word::User(number) }))
        }
        (_, Some(axis)) => {
            let steps = number.and_then(|number| i32::try_from(number).ok()).ok_or_else(|| {
                format!("'{value}' is not a number from {} to {} (protocol steps)", i32::MIN, i32::MAX)
            })?;
            if is_robot {
                return Ok(Input::Word(Word::Axis(usize::from(axis) - 1, steps)));
            }
            // The type precedes the axes.
            let field = WriteField::new(kind, reference.number, 1 + axis, steps.to_le_bytes()).map_err(message)?;
            Ok(Input::Field(field))
        }
        _ if is_robot => Err(format!("'{field}' is not a valid part to write; there are tool, user, axis1 to axis8")),
        _ => Err(format!("'{field}' is not a valid part to write; there are axis1 to axis8")),
    }
}

#[expect(clippy::needless_pass_by_value, reason = "made for map_err")]
fn message(error: impl ToString) -> String {
    error.to_string()
}

impl Command for Set {
    type Family = Yerc;
    type Report = Written;
    const ID: &'static str = "yerc.var.set";
    const INTENT: &'static str = "overwrite taught positions";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    /// Only positions are taught.
    fn risk(&self) -> Risk {
        let is_position = self.assignments.iter().any(|assignment| assignment.reference.kind.is_position());
        if is_position { Risk::Destroy } else { Risk::Write }
    }

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Written, Failure> {
        let Context { link, screen, robot, authority, .. } = context;
        let names = names::of(robot, screen);
        let mut values = Vec::new();
        let mut fields = Vec::new();
        let mut words = Words::new();
        let mut given: Vec<(Reference, u8)> = Vec::new();
        let references = self.assignments.iter().map(|assignment| &assignment.reference);
        let model = model_of(link, references, self.s16).await?;
        for assignment in &self.assignments {
            let reference = in_form(assignment.reference, model, self.s16);
            let part = match &assignment.input {
                Input::Field(field) => {
                    fields.push(Change::Field(reference, field.clone()));
                    field.request().attribute
                }
                Input::Word(word) => {
                    words.entry(reference).or_default().push(*word);
                    word.attribute()
                }
                input => {
                    values.push((reference, value_of(reference, input, link)?));
                    0
                }
            };
            if given.contains(&(reference, part)) {
                return Err(Failure::usage(format!("{reference} is given twice")).hint("give each variable one value"));
            }
            given.push((reference, part));
        }
        let mut whole_words = Vec::new();
        for (reference, value) in &mut values {
            // Words of a position that is written completely are merged into it.
            let Value::Position(position) = value else { continue };
            for word in words.remove(reference).unwrap_or_default() {
                word.set(position);
                whole_words.push((*reference, word));
            }
        }
        let plain: Vec<(u16, Value)> =
            values.iter().map(|(reference, value)| (reference.number, value.clone())).collect();
        let steps = plan_writes(&plain).map_err(usage)?;
        let replaced = values.iter().map(|(reference, _)| *reference).chain(changed_in_part(&fields));
        let (positions, others): (Vec<_>, Vec<_>) = replaced.partition(|reference| reference.kind.is_position());
        let plain_old = before(link, &plan_reads(&others)).await?;
        let taught = read_taught(link, &once(positions)).await?;
        let old = |reference: &Reference| plain_old.get(reference).or_else(|| taught.get(reference)?.as_ref().ok());
        let position = |reference: &Reference| old(reference).map(as_position);
        let mut parts: Vec<Part> = self.assignments.iter().filter_map(|it| it.part(position(&it.reference))).collect();
        parts.extend(
            whole_words
                .into_iter()
                .map(|(reference, word)| Part::new(reference, word, position(&reference).map(|old| word.old(&old)))),
        );
        let mut changes: Vec<Change> = steps.into_iter().map(Change::Values).chain(fields).collect();
        if link.is_dry() && !words.is_empty() {
            part::plan_reads(link, &words);
            authority.confirm(&gate::Change::nothing()).await?;
            for change in &changes {
                link.plan(&change.request(), &format!("writes {}", Change::listed(change.items())));
            }
            part::plan_writes(link, &words)?;
            return Err(unknown());
        }
        let mut known = taught.clone();
        let mut differing = values.clone();
        for change in &changes {
            let Change::Field(reference, field) = change else { continue };
            let new = old(reference).and_then(|old| with_field(old, &field.request()));
            differing.extend(new.map(|new| (*reference, new)));
        }
        for (reference, old, new) in part::changed(link, &words).await? {
            let words = words.get(&reference).into_iter().flatten();
            parts.extend(words.map(|word| Part::new(reference, *word, Some(word.old(&old)))));
            known.insert(reference, Ok(Value::Position(old)));
            differing.push((reference, Value::Position(new)));
            let write = WriteVariable::new(reference.number, Value::Position(new)).map_err(usage)?;
            changes.push(Change::Position(reference, write));
        }
        authority.confirm(&overwritten(&known, &differing, link.encoding)).await?;
        write_all(link, screen, &changes).await?;
        let entry = |reference, value| Entry::new(reference, &Ok(value), link.encoding).labelled(names);
        let written = values.into_iter().map(|(reference, value)| {
            let old = old(&reference).map(|old| entry(reference, old.clone()).data());
            let item = entry(reference, value);
            let new = item.data();
            orders::Written::new(item, Old::read(old), new)
        });
        Ok(Written { items: written.collect(), parts })
    }
}

/// Positions of which single words are written.
fn changed_in_part(fields: &[Change]) -> impl Iterator<Item = Reference> {
    fields.iter().flat_map(WriteOrder::items)
}

impl Assignment {
    fn part(&self, old: Option<Position>) -> Option<Part> {
        let Input::Field(field) = &self.input else { return None };
        let request = field.request();
        let word = request.data.first_chunk().map_or(0, |word| i32::from_le_bytes(*word));
        Some(Part {
            name: self.reference.to_string(),
            part: format!("axis{}", request.attribute.saturating_sub(1)),
            attribute: request.attribute,
            old: old
                .and_then(|old| old.axes.padded().get(usize::from(request.attribute).checked_sub(2)?).copied())
                .map(Into::into),
            new: word.into(),
            value: word.into(),
        })
    }
}

fn value_of(reference: Reference, input: &Input, link: &Link) -> Result<Value, Failure> {
    let wrong = |error: String| {
        let hint = "see `armctl yerc var set --help` for the notation of values";
        Failure::usage(format!("{reference}: {error}")).hint(hint)
    };
    match input {
        Input::Ready(value) => Ok(value.clone()),
        Input::Text(text) => {
            let bytes = link.encode(&reference.to_string(), text)?;
            Value::from_text(reference.kind, &bytes).map_err(|error| {
                wrong(error.to_string()).hint("shorten the text; full-width characters take two bytes each")
            })
        }
        Input::File(path) => {
            let wrong = |error: String| {
                let hint = "use a file from `yerc var get P1 --json` or `yerc position --json`";
                Failure::usage(format!("{}: {error}", path.display())).hint(hint)
            };
            let text = printed_position(path)?;
            Value::from_text(reference.kind, text.as_bytes()).map_err(|error| {
                wrong(error.to_string()).hint(format!("it must be a position of {}", reference.kind.letters()))
            })
        }
        Input::Field(_) | Input::Word(_) => Err(wrong("a part is not a value".to_owned())),
    }
}

/// A request of `var set`.
#[derive(Debug, Clone, PartialEq)]
enum Change {
    Values(WriteStep),
    Field(Reference, WriteField),
    Position(Reference, WriteVariable),
}

impl Query for Change {
    type Answer = ();

    fn request(&self) -> Request {
        match self {
            Self::Values(step) => step.request(),
            Self::Field(_, field) => field.request(),
            Self::Position(_, position) => position.request(),
        }
    }

    fn decode(&self, _: &[u8]) -> Result<(), PayloadError> {
        Ok(())
    }
}

impl WriteOrder for Change {
    type Item = Reference;

    fn items(&self) -> Vec<Reference> {
        match self {
            Self::Values(step) => step.written().to_vec(),
            Self::Field(reference, _) | Self::Position(reference, _) => vec![*reference],
        }
    }

    fn listed(items: Vec<Reference>) -> String {
        listed(items)
    }
}

/// Confirmed writes.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Written {
    /// Complete variables.
    items: Vec<orders::Written<Entry>>,
    /// Single words of positions.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    parts: Vec<Part>,
}

/// A word of a position.
#[derive(Debug, Serialize, JsonSchema)]
struct Part {
    /// `P1`.
    name: String,
    /// `tool`, `user` or `axis1`.
    part: String,
    /// Attribute: its index starting with 1, the type.
    attribute: u8,
    /// Old value; null if it was not read.
    old: Option<i64>,
    /// New value.
    new: i64,
    /// New value (same as `new`).
    value: i64,
}

impl Part {
    fn new(reference: Reference, word: Word, old: Option<i64>) -> Self {
        let (name, part) = (reference.to_string(), word.name());
        Self { name, part, attribute: word.attribute(), old, new: word.value(), value: word.value() }
    }
}

impl Report for Written {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        let mut table = Table::new(&["written", "label", "value"], "nothing to write");
        let entries = || self.items.iter().map(|written| &written.item);
        let numbers = entries().all(Entry::is_number);
        for entry in entries() {
            let value = if numbers { Cell::number(entry.shown()) } else { entry.shown().into() };
            table.row([entry.name().into(), Cell::maybe(entry.label()), value]);
        }
        for part in &self.parts {
            table.row([format!("{}.{}", part.name, part.part).into(), Cell::maybe(None::<&str>), part.value.into()]);
        }
        View::table(table.without_blank("label"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(text: &str) -> String {
        text.parse::<Assignment>().unwrap_err()
    }

    #[test]
    fn values_are_checked_before_anything_is_sent() {
        assert_eq!(error("B0=256"), "'256' is not a number from 0 to 255");
        assert_eq!(error("B0"), "write a variable, '=' and a value, as in B0=255");
        assert_eq!(
            error("X0=1"),
            "'X0' is not a variable; use B, I, D, R, S, P, BP or EX with a number, e.g. B0 or B0..B99"
        );
        assert!(error("P1=base:x=1").starts_with("axis 'y' is missing"));
        assert_eq!(error("P1=pulse:s=0,l=0,u=0,r=0,b=0,t=0,tool=64"), "tool: 64 is not a number from 0 to 63");
        assert!(error("B0.tool=1").starts_with("B0 has no parts"));
        assert!(error("P1.form=1").contains("tool, user, axis1 to axis8"));
        assert!(error("BP1.tool=1").ends_with("there are axis1 to axis8"));
        assert!(error("EX1.axis9=1").contains("axis1 to axis8"));
        let tool = "P1.tool=0x2".parse::<Assignment>().map(|it| it.input);
        assert_eq!(tool, Ok(Input::Word(Word::Tool(2))));
        assert!("S0=".parse::<Assignment>().is_ok());
        assert!("S0=@home".parse::<Assignment>().is_ok_and(|it| it.input == Input::Text("@home".to_owned())));
    }
}

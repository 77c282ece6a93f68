//! The variables of a controller as a table: how they are named, read, written and displayed.

use std::convert::Infallible;
use std::fmt::Debug;

use super::cells::{self, Cells};
use super::position_word::{Word, different_words};
use super::value::Data;
use crate::batch_split::{BatchSplit, read_in_batches};
use crate::item_requests::ReadError;
use crate::prelude::*;
use crate::var::position::stored_position;
use armctl_controller::names::Kind;
use armctl_controller::yerc::payload::Axes;
use armctl_controller::yerc::query::{Query as _, WriteVariable};
use armctl_controller::yerc::status;
use armctl_controller::yerc::variables::{
    Reference, Value, VariableKind, WriteStep, parse_references, plan_reads, plan_writes,
};
use armctl_frame::failure::Kind as FailureKind;
use armctl_frame::settings_report::{IF_DIFFERENT, OLD_VALUE};
use armctl_frame::store::Row;

/// Table of the variables. Its keys have the 32-byte form of strings, for any model.
#[derive(Debug)]
pub struct Variables {
    encoding: Encoding,
    /// Model, when it is known. It is needed only for strings.
    model: Model,
    is_short: bool,
}

/// Options of commands for variables.
#[derive(Debug, Clone, Copy, Args)]
pub struct StringForm {
    /// Read and write strings with the 16-byte commands, even on a DX200
    #[arg(long = "s16")]
    is_short: bool,
}

/// Fields that yerc adds to an item.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct More {
    number: u16,
    /// Raw bytes, if the value cannot be converted back to these bytes.
    #[serde(skip_serializing_if = "Option::is_none")]
    value_hex: Option<String>,
}

/// New content of a variable.
#[derive(Debug, Clone, PartialEq)]
pub enum Draft {
    /// A complete value.
    Whole(Value),
    /// Some fields of a position, by their column. If there is no field, the value is unknown, because this is a dry
    /// run.
    Fields(Cells),
    /// Single words of a position.
    Words(Vec<Word>),
}

/// Maximum number of variables in a range. A larger range is probably a typing error. If it is refused, the read in
/// parts takes a long time.
const MAX_BATCH: usize = 10_000;

/// Added status codes for a variable without a value. The manuals give 0xB001 a second meaning, which cannot occur when
/// one variable is read (3.3.16; DX chapter 5).
const UNDEFINED: [u32; 2] = [0xB005, 0xB001];

/// Whether a refusal to read one variable means that the variable is undefined.
pub fn is_undefined(denied: &ReadError) -> bool {
    matches!(denied, ReadError::Refused(refusal) if UNDEFINED.contains(&refusal.status.added))
}

impl Variables {
    /// Creates the table for values in this encoding.
    pub fn with_encoding(encoding: Encoding) -> Self {
        Self { encoding, model: Model::Dx200, is_short: false }
    }

    /// The variable, with the string form that the model uses.
    fn in_form(&self, key: Reference) -> Reference {
        Reference::new(key.kind.string_form(self.model, self.is_short), key.number)
    }

    /// Value of a variable, from its text in the notation of `var set`.
    ///
    /// # Errors
    /// If the variable cannot have this value. The error gives the reason.
    pub fn parse(&self, key: Reference, text: &str) -> Result<Value, String> {
        let kind = self.in_form(key).kind;
        let is_string = matches!(kind, VariableKind::S16 | VariableKind::S32);
        let encoded = if is_string { self.encoding.encode(text) } else { Ok(text.as_bytes().to_vec()) };
        Value::from_text(kind, &encoded.map_err(|error| error.to_string())?).map_err(|error| error.to_string())
    }

    /// Requests that write these values.
    fn steps(values: impl Iterator<Item = (Reference, Value)>) -> Result<Vec<WriteStep>> {
        plan_writes(&values.map(|(key, value)| (key.number, value)).collect::<Vec<_>>()).map_err(usage)
    }

    /// In a dry run, records a write that depends on the content of the variable.
    fn plan_merged(&self, link: &mut Link, key: Reference, draft: &Draft) -> Result<()> {
        let reference = self.in_form(key);
        let (both, about) = match draft {
            Draft::Whole(_) => return Ok(()),
            Draft::Words(words) => {
                let merged = |mut value: Value| {
                    for word in words {
                        word.set(&mut value);
                    }
                    value
                };
                let given: Vec<String> = words.iter().map(|word| format!("{}={}", word.name(), word.value())).collect();
                (Some(different_words().map(|old| merged(stored_position(Group::R1, old)))), given.join(", "))
            }
            Draft::Fields(cells) => {
                let given: Vec<String> = cells.iter().map(|(name, text)| format!("{name}={text}")).collect();
                (cells::zero_bytes(cells, reference.kind), given.join(", "))
            }
        };
        let Some([one, other]) = both else {
            return Err(Failure::usage(format!("{key}: the values {about} do not belong to one type of position"))
                .hint("fill in column `type` and the columns of the axes"));
        };
        let about = match about.as_str() {
            "" => format!("writes {key}"),
            about => format!("writes {key} with {about}; the other values stay as they were read"),
        };
        let write = |value| WriteVariable::new(key.number, value).map_err(usage);
        let reason = Reason::about(&about).depending_on("the values that were read");
        link.plan_depending(&write(one)?.request(), &write(other)?.request(), reason);
        Ok(())
    }
}

impl Store for Variables {
    type Family = Yerc;
    type Key = Reference;
    type Wire = Value;
    type Value = Data;
    type More = More;
    type Options = StringForm;

    const WORDS: TableWords = TableWords {
        nouns: ["variable", "variables"],
        placeholder: "REF",
        range: "Variables, such as B0, I1..I20, D5, R3, S2, P10, BP1 or EX1, a kind such as P, or a name",
        reading: Some(
            "In JSON, a position that was never taught is null. Each variable has its own result. The exit code is 9 \
             if the controller refused some variables. The exit code is 3 if the controller refused all variables, or \
             if no variable has a value. armctl reads many variables with few requests. The standard numbers are 0-99 \
             (positions 0-127); the controller's parameters can define more.",
        ),
        writing: None,
    };
    const IDS: Ids = ids!("yerc.var");
    const LABELS: Option<Kind> = Some(Kind::Variable);
    const COMPLETE: ValueKind = complete::VARIABLE;
    const SAVES_BLANK: bool = true;
    const UNDEFINED_IS_NULL: bool = true;

    fn keys(text: &str) -> Result<Vec<Reference>, String> {
        let of_kind = VariableKind::all().find(|kind| kind.letters().eq_ignore_ascii_case(text));
        let keys = match of_kind {
            Some(kind) => standard(kind).collect(),
            None => parse_references(text).map_err(|error| error.to_string())?,
        };
        if keys.len() > MAX_BATCH {
            return Err(format!("{text} has {} variables; the maximum is {MAX_BATCH}", keys.len()));
        }
        Ok(keys.into_iter().map(|key| Reference::new(key.kind.string_form(Model::Dx200, false), key.number)).collect())
    }

    fn all() -> Vec<Reference> {
        VariableKind::all().filter(|kind| *kind != VariableKind::S16).flat_map(standard).collect()
    }

    fn any() -> String {
        "B0".to_owned()
    }

    fn name(key: Reference) -> String {
        key.to_string()
    }

    async fn open(link: &mut Link, options: &StringForm) -> Result<Self> {
        Ok(Self { is_short: options.is_short, ..Self::with_encoding(link.encoding) })
    }

    /// The model is read from the controller only if there are strings.
    async fn prepare(&mut self, link: &mut Link, keys: &[Reference]) -> Result<()> {
        let forms = |model| Self { model, ..*self }.forms(keys);
        link.model_for(|model| Ok::<_, Infallible>(forms(model))).await.map(|model| self.model = model)
    }

    fn fields(&self) -> Vec<Field> {
        cells::fields()
    }

    fn texts(&self, value: &Value) -> Vec<String> {
        let mut cells = cells::of(value, self.encoding);
        cells::fields().iter().map(|field| cells.remove(&*field.name).unwrap_or_default()).collect()
    }

    fn headings(&self) -> Vec<&'static str> {
        vec!["value"]
    }

    fn cells(&self, _key: Reference, value: &Value) -> Vec<Cell> {
        let (data, _) = Data::of(value, self.encoding);
        vec![if data.is_number() { Cell::number(data.to_string()) } else { data.to_string().into() }]
    }

    fn difference(&self, old: &Value, new: &Value) -> [String; 2] {
        [old, new].map(|value| Data::of(value, self.encoding).0.to_string())
    }

    fn value(&self, value: &Value) -> Option<Data> {
        Some(Data::of(value, self.encoding).0)
    }

    fn more(&self, key: Reference, value: Option<&Value>) -> More {
        More { number: key.number, value_hex: value.and_then(|value| Data::of(value, self.encoding).1) }
    }

    /// Axes that were not reported count as 0. Positive and negative zero differ, and NaN is equal to itself.
    fn is_equal(old: &Value, new: &Value) -> bool {
        match (old, new) {
            (Value::Position(old), Value::Position(new)) => {
                let full = |position: &Position| Position { axes: Axes::full(position.axes.padded()), ..*position };
                full(old) == full(new)
            }
            (Value::Real(old), Value::Real(new)) => old.to_bits() == new.to_bits(),
            (old, new) => old == new,
        }
    }

    fn is_blank(&self, value: &Value) -> bool {
        Data::of(value, self.encoding).0.is_blank()
    }

    fn is_undefined(failure: &Failure) -> bool {
        failure.kind == FailureKind::Refused
            && UNDEFINED.iter().any(|code| failure.code.as_deref() == Some(&status::added_text(*code)))
    }

    async fn read(&self, link: &mut Link, screen: &Screen, keys: &[Reference]) -> Result<Answers<Value>> {
        let wanted = self.forms(keys);
        let progress = (keys.len() > 1).then(|| screen.spinner("reading variables"));
        // Each position can be undefined. For other kinds, the valid numbers end somewhere in the range.
        let parts = |run: &[Reference]| {
            let is_position = run.first().is_some_and(|reference| reference.kind.is_position());
            if is_position { BatchSplit::Single } else { BatchSplit::Halves }
        };
        let reported = |_: &[Reference], known: usize| {
            if let Some(progress) = &progress {
                progress.print_line(&format!("reading variables ({known} of {})", keys.len()));
            }
        };
        let answers = read_in_batches(link, |references| Ok(plan_reads(references)), &wanted, parts, reported).await?;
        let missing = || Failure::new(FailureKind::Malformed, "the answer does not have this variable");
        let row = |reference: &Reference| match answers.get(reference) {
            Some(Ok(value)) => Ok(value.clone()),
            Some(Err(denied)) => Err(read_failure(denied.clone())),
            None => Err(missing()),
        };
        Ok(Answers::of(wanted.iter().map(row).collect()))
    }
}

impl Variables {
    /// The same variables, with the string form of the model.
    fn forms(&self, keys: &[Reference]) -> Vec<Reference> {
        keys.iter().map(|key| self.in_form(*key)).collect()
    }
}

/// Standard numbers of a kind, as variables.
fn standard(kind: VariableKind) -> impl Iterator<Item = Reference> {
    (0..=kind.last_standard()).map(move |number| Reference::new(kind, number))
}

impl Writable for Variables {
    type Draft = Draft;

    const RISK: Risk = Risk::Destroy;

    /// Only positions contain taught data.
    fn risk(key: Reference) -> Risk {
        if key.kind.is_position() { Risk::Destroy } else { Risk::Write }
    }

    fn draft(&self, key: Reference, texts: &[Option<&str>]) -> Result<Draft, String> {
        let given = cells::fields().into_iter().zip(texts);
        let given =
            given.filter_map(|(field, text)| Some((field.name.into_owned(), text.filter(|it| !it.is_empty())?)));
        let given: Cells = given.map(|(name, text)| (name, text.to_owned())).collect();
        let kind = self.in_form(key).kind;
        let named = |why| format!("{key}: {why}");
        if given.is_empty() {
            Ok(Draft::Fields(given))
        } else if kind.is_position() {
            cells::check_position(&given).map_err(named).map(|()| Draft::Fields(given))
        } else {
            cells::plain(kind, &given, self.encoding).map_err(named).map(Draft::Whole)
        }
    }

    fn complete_draft(&self, key: Reference, draft: &Draft, old: Option<&Value>) -> Result<Value> {
        let wrong =
            |why: String| Failure::usage(format!("{key}: {why}")).hint("correct the value; nothing was written");
        match (draft, old) {
            (Draft::Whole(value), _) => Ok(value.clone()),
            (Draft::Fields(cells), old) => cells::merge_over(cells, key.kind, old).map_err(wrong),
            (Draft::Words(words), Some(old)) => {
                let mut new = old.clone();
                for word in words {
                    word.set(&mut new);
                }
                Ok(new)
            }
            (Draft::Words(_), None) => {
                let message = format!("{key}: the position is undefined; nothing was written");
                Err(Failure::new(FailureKind::Refused, message)
                    .hint(format!("write the whole position: {key}=pulse:…")))
            }
        }
    }

    async fn read_old(&self, link: &mut Link, screen: &Screen, rows: &[Row<Self>]) -> Result<Answers<Value>> {
        let keys: Vec<Reference> = rows.iter().map(|(key, _)| *key).collect();
        self.read(link.for_purpose(OLD_VALUE), screen, &keys).await
    }

    /// Consecutive variables of a kind are written with one request. A BP or an EX of which only one axis changes has
    /// its own request.
    fn blocks(&self, rows: &[RowDifference<'_, Self>]) -> Vec<Vec<usize>> {
        let (alone, together): (Vec<usize>, Vec<usize>) =
            (0..rows.len()).partition(|index| single_word(&rows[*index]).is_some());
        let values = together.iter().map(|index| &rows[*index]).map(|(key, _, new)| (*key, (*new).clone()));
        let Ok(steps) = Self::steps(values) else { return (0..rows.len()).map(|index| vec![index]).collect() };
        let index_of =
            |written: &Reference| together.iter().copied().find(|index| self.in_form(rows[*index].0) == *written);
        let blocks = steps.iter().map(|step| step.written().iter().filter_map(index_of).collect());
        alone.iter().map(|index| vec![*index]).chain(blocks).collect()
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        let whole = rows.iter().filter_map(|(key, draft)| match draft {
            Draft::Whole(value) => Some((*key, value.clone())),
            Draft::Fields(_) | Draft::Words(_) => None,
        });
        for step in Self::steps(whole)? {
            let names: Vec<String> = step.written().iter().map(ToString::to_string).collect();
            link.plan_if(
                &step.request(),
                Reason::about(&format!("writes {}", names.join(", "))).depending_on(IF_DIFFERENT),
            );
        }
        for (key, draft) in rows {
            match draft {
                Draft::Words(words) if key.kind != VariableKind::P => {
                    for field in words.iter().filter_map(|word| word.field(*key)) {
                        let about = format!("writes {key}");
                        link.plan_if(
                            &field.map_err(usage)?.request(),
                            Reason::about(&about).depending_on(IF_DIFFERENT),
                        );
                    }
                }
                draft => self.plan_merged(link, *key, draft)?,
            }
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        if let [row] = rows
            && let Some(field) = single_word(row).and_then(|word| word.field(row.0))
        {
            return link.ask(&field.map_err(usage)?).await;
        }
        for step in Self::steps(rows.iter().map(|(key, _, new)| (*key, (*new).clone())))? {
            link.ask(&step).await?;
        }
        Ok(())
    }
}

/// The axis of a BP or an EX that changes, if it is the only change.
fn single_word((key, old, new): &RowDifference<'_, Variables>) -> Option<Word> {
    Word::only_difference(*key, (*old)?, new)
}

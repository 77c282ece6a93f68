//! Numbered data of the controller (4.3, 4.4.1) as tables: one declaration ([`Kind`]) each. The row access is common
//! to all.

use std::fmt::Debug;
use std::marker::PhantomData;

use schemars::JsonSchema;
use serde::Serialize;

use super::backup::Records;
use super::link::{Link, Yrcx};
use super::numbers::{Numbers, named, runs};
use super::several::{ask_each, is_undefined};
use crate::command::ValueKind;
use crate::command::frame::dry_run::Reason;
use crate::command::frame::store::{self, Answers, Differing, Field, Ids, Single, Store, TableWords, Writable};
use crate::command::robot::item::Plain;
use crate::controller::Risk;
use crate::controller::names::Kind as Label;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::Failure;
use crate::output::Screen;

/// Declaration of a table and its reports.
pub trait Kind: Debug + Send + Sync + 'static {
    /// Value of a row in reports.
    type Value: Debug + Clone + Serialize + JsonSchema;
    /// Texts of the table.
    const WORDS: TableWords;
    /// Names of the reports.
    const IDS: Ids;
    /// Commands and fields of a row, shared with backups.
    const RECORDS: &'static Records;
    /// Headings of the fields.
    const HEADINGS: &'static [&'static str];
    /// Risk of an overwrite: whether the old data is the work of a person.
    const RISK: Risk = Risk::Destroy;
    /// Whether the table is small enough to read completely by default.
    const IS_SMALL: bool = true;
    /// Whether a row is a text.
    const IS_TEXT: bool = false;
    /// Type of the names that users assign to rows.
    const LABELS: Option<Label> = None;
    /// Completion of row numbers.
    const COMPLETE: ValueKind = ValueKind::Listed(Vec::new);

    /// Value of a row.
    fn value(values: &Values) -> Option<Self::Value>;

    /// A row in questions, if its fields are not enough.
    fn line(_values: &Values) -> Option<String> {
        None
    }

    /// Whether a row contains no user data.
    fn is_blank(_values: &Values) -> bool {
        false
    }
}

/// A table of `kind` as a store.
#[derive(Debug)]
pub struct Numbered<K>(PhantomData<K>);

impl<K> Default for Numbered<K> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

/// Content of a row.
#[derive(Debug, Clone)]
pub struct Row {
    values: Values,
    /// Texts of the columns after the number.
    texts: Vec<String>,
    /// Request that stores it; none if it was read.
    order: Option<Order>,
}

/// Rows are equal if their texts are equal.
impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        self.texts == other.texts
    }
}

impl Row {
    /// The values of its fields.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// Row with these values.
    pub fn new<K: Kind>(number: i32, values: Values) -> Self {
        let mut texts = K::RECORDS.row(number, &values);
        texts.remove(0);
        Self { values, texts, order: None }
    }
}

fn key<K: Kind>() -> Key {
    K::RECORDS.columns[0].1
}

impl<K: Kind> Store for Numbered<K> {
    type Family = Yrcx;
    type Key = i32;
    type Wire = Row;
    type Value = K::Value;
    type More = Plain;
    type Options = Single;

    const WORDS: TableWords = K::WORDS;
    const IDS: Ids = K::IDS;
    const LABELS: Option<Label> = K::LABELS;
    const COMPLETE: ValueKind = K::COMPLETE;
    const IS_TEXT: bool = K::IS_TEXT;
    const UNDEFINED_IS_NULL: bool = true;

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Ok(Numbers::of(&[K::RECORDS.parse(text)?]))
    }

    fn all() -> Vec<i32> {
        if K::IS_SMALL { K::RECORDS.all().expect("the numbers of every table are numbers") } else { Vec::new() }
    }

    fn any() -> String {
        named(K::RECORDS.read, key::<K>(), 0)
    }

    fn name(number: i32) -> String {
        named(K::RECORDS.read, key::<K>(), number)
    }

    fn names(numbers: &[i32]) -> String {
        runs(numbers)
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self, Failure> {
        Ok(Self::default())
    }

    fn fields(&self) -> Vec<Field> {
        let fields = K::RECORDS.columns[1..].iter().zip(K::HEADINGS);
        let field = |((name, key), heading): (&(&'static str, Key), &&'static str)| {
            if is_number(*key) { Field::number(name, heading) } else { Field::text(name, heading) }
        };
        fields.map(field).collect()
    }

    fn texts(&self, row: &Row) -> Vec<String> {
        row.texts.clone()
    }

    fn difference(&self, old: &Row, new: &Row) -> [String; 2] {
        match (K::line(&old.values), K::line(&new.values)) {
            (Some(old), Some(new)) => [old, new],
            _ => store::difference(self, old, new),
        }
    }

    fn value(&self, row: &Row) -> Option<K::Value> {
        K::value(&row.values)
    }

    fn more(&self, _number: i32, _row: Option<&Row>) -> Plain {
        Plain {}
    }

    fn is_blank(&self, row: &Row) -> bool {
        K::is_blank(&row.values)
    }

    fn is_undefined(failure: &Failure) -> bool {
        is_undefined(failure)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, numbers: &[i32]) -> Result<Answers<Row>, Failure> {
        let order = |number: &i32| Ok(link.draft(K::RECORDS.read)?.with(key::<K>(), *number).build()?);
        let orders = numbers.iter().map(order).collect::<Result<Vec<Order>, Failure>>()?;
        let answers = ask_each(link, screen, &format!("reading {}", K::WORDS.nouns[1]), &orders).await?;
        let rows = numbers.iter().zip(answers.outcomes);
        let rows = rows.map(|(number, outcome)| outcome.map(|values| Some(Row::new::<K>(*number, values))));
        Ok(Answers { rows: rows.collect(), asked: answers.asked })
    }
}

/// Whether a field is a number.
pub fn is_number(key: Key) -> bool {
    !matches!(key, Key::Unit | Key::HandSystem | Key::Comment)
}

/// New content of a row: the text of each field, if given.
pub type Draft = Vec<Option<String>>;

impl<K: Kind> Writable for Numbered<K> {
    type Draft = Draft;

    const RISK: Risk = K::RISK;

    fn draft(&self, number: i32, texts: &[Option<&str>]) -> Result<Draft, String> {
        let draft: Draft = texts.iter().map(|text| text.map(ToOwned::to_owned)).collect();
        if let Some(texts) = draft.iter().cloned().collect::<Option<Vec<String>>>() {
            stored::<K>(number, texts).map_err(|failure| failure.message)?;
        }
        Ok(draft)
    }

    fn complete_draft(&self, number: i32, draft: &Draft, old: Option<&Row>) -> Result<Row, Failure> {
        // Axes in another unit are not kept.
        let unit = K::RECORDS.columns[1..].iter().position(|(_, key)| *key == Key::Unit);
        let has_unit = |old: &&Row| unit.is_none_or(|at| draft[at].as_ref().is_none_or(|unit| *unit == old.texts[at]));
        let old = old.filter(has_unit);
        let kept = |(at, text): (usize, &Option<String>)| match (text, old) {
            (Some(text), _) => Ok(text.clone()),
            (None, Some(old)) => Ok(old.texts[at].clone()),
            (None, None) if K::RECORDS.columns[at + 1].1 == Key::HandSystem => Ok(String::new()),
            (None, None) => {
                let (one, field) = (Self::WORDS.nouns[0], K::RECORDS.columns[at + 1].0);
                let unit =
                    unit.and_then(|at| draft[at].as_ref()).map_or_else(String::new, |unit| format!(" in {unit}"));
                let message = format!("{one} {number} is not defined{unit}, so it has no {field} to keep");
                Err(Failure::usage(message).hint("type all values; nothing was written"))
            }
        };
        let texts = draft.iter().enumerate().map(kept).collect::<Result<Vec<String>, Failure>>()?;
        let (order, values) = stored::<K>(number, texts)?;
        Ok(Row { order: Some(order), ..Row::new::<K>(number, values) })
    }

    async fn plan(&self, link: &mut Link, rows: &[store::Row<Self>]) -> Result<(), Failure> {
        for (number, draft) in rows {
            let reason = Reason::default().depending_on("the current data: written if different");
            let is_pulse = draft.iter().flatten().any(|text| text == "pulse");
            let sample = |key: Key, which: usize| match key {
                Key::HandSystem if is_pulse => "",
                key => samples(key, *number)[which],
            };
            // Two rows that agree only in the given fields.
            let filled = |which: usize| {
                let columns = draft.iter().zip(&K::RECORDS.columns[1..]);
                columns.map(|(text, (_, key))| text.clone().unwrap_or_else(|| sample(*key, which).into())).collect()
            };
            match (stored::<K>(*number, filled(0)), stored::<K>(*number, filled(1))) {
                (Ok((one, _)), Ok((other, _))) => link.plan_depending(&one, &other, reason),
                _ => link.then(&format!("{} {number} is written", Self::WORDS.nouns[0])),
            }
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[Differing<'_, Self>]) -> Result<(), Failure> {
        for order in rows.iter().filter_map(|(_, _, new)| new.order.as_ref()) {
            link.ask(order).await?;
        }
        Ok(())
    }
}

/// Two different texts of a field, for a dry run.
fn samples(key: Key, number: i32) -> [&'static str; 2] {
    match key {
        Key::Unit => ["mm", "pulse"],
        // Only a point in millimetres has a hand system.
        Key::HandSystem => ["left", ""],
        Key::Comment => ["", "AAAAAAAAAAAAAAAA"],
        // The robot number is part of the command word in a plan; the first robot is shown.
        Key::Owner => ["1", "1"],
        Key::CountX | Key::CountY | Key::CountZ | Key::FirstPoint => ["1", "2"],
        Key::Data4 => ["0", "1"],
        // Real variables begin at 256.
        Key::Value if number >= 256 => ["0", "-1.1"],
        _ => ["0", "-1"],
    }
}

/// Command that stores a row, and the answer expected when it is read.
fn stored<K: Kind>(number: i32, texts: Vec<String>) -> Result<(Order, Values), Failure> {
    let name = named(K::RECORDS.read, key::<K>(), number);
    let store = K::RECORDS.store(&std::iter::once(name).chain(texts).collect())?;
    Ok((store.write, store.wanted))
}

/// Whole number in an answer.
pub fn int(values: &Values, key: Key) -> i32 {
    values.int(key).unwrap_or_default()
}

/// Millimetres, from thousandths in an answer.
pub fn mm(values: &Values, key: Key) -> f64 {
    f64::from(int(values, key)) / 1000.0
}

/// Whether all of these fields are zero.
pub fn all_zero(values: &Values, keys: &[Key]) -> bool {
    keys.iter().all(|key| values.value(*key).is_none_or(|value| *value == Value::Int(0)))
}

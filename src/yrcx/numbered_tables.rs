//! Numbered data of the controller (4.3, 4.4.1) as tables. Each table has a declaration ([`Kind`]). All tables read and
//! write rows in the same way.

use std::fmt::Debug;
use std::marker::PhantomData;

use super::number_arguments::{Numbers, named, runs};
use super::read_requests::{ask_each, is_undefined};
use crate::prelude::*;
use armctl_controller::names::Kind as Label;
use armctl_controller::yrcx::table::Command;
use armctl_controller::yrcx::value::Value;
use armctl_frame::robot::item::Plain;
use armctl_frame::store;

/// Declaration of a table and its reports.
pub trait Kind: Debug + Send + Sync + 'static {
    /// Value of a row in reports.
    type Value: Debug + Clone + Serialize + JsonSchema;
    /// Texts of the table.
    const WORDS: TableWords;
    /// Names of the reports.
    const IDS: Ids;
    /// Command that reads a row, and the field of its number.
    const READ: (Command, Key);
    /// Command that stores a row.
    const WRITE: Command;
    /// Ranges of valid numbers.
    const NUMBERS: &'static [&'static str];
    /// Fields of a row: column of a file, field of the commands, and heading.
    const FIELDS: &'static [(&'static str, Key, &'static str)];
    /// Risk of overwriting a row; [`Risk::Destroy`] if the old data is the work of a person.
    const RISK: Risk = Risk::Destroy;
    /// Whether the table is small enough to read completely by default.
    const IS_SMALL: bool = true;
    /// Whether a row is a text.
    const IS_TEXT: bool = false;
    /// Kind of the names that users assign to rows; `None` if rows have no names.
    const LABELS: Option<Label> = None;
    /// Completion of row numbers.
    const COMPLETE: ValueKind = ValueKind::Listed(Vec::new);

    /// Converts the fields of a row to its value in reports.
    fn value(values: &Values) -> Option<Self::Value>;

    /// Describes a row for confirmation questions, if the fields alone are not clear enough.
    fn line(_values: &Values) -> Option<String> {
        None
    }

    /// Whether a row contains no user data.
    fn is_blank(_values: &Values) -> bool {
        false
    }
}

/// The table of kind `K` as a store.
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
    /// Request that stores the row; `None` if the row was read from the controller.
    order: Option<Order>,
}

/// Rows are equal if their texts are equal.
impl PartialEq for Row {
    fn eq(&self, other: &Self) -> bool {
        self.texts == other.texts
    }
}

impl Row {
    /// Values of the fields.
    pub fn values(&self) -> &Values {
        &self.values
    }

    /// Row with these values.
    pub fn new<K: Kind>(values: Values) -> Self {
        // A layout can have several fields with the same key.
        let counts = |field: &&'static table::Field| {
            field.when.is_none_or(|when| (when.least..=when.most).contains(&int(&values, when.key)))
        };
        let text = |key: Key| {
            let mut fields = K::READ.0.row().answer().filter(|field| field.key == key);
            Some(fields.find(counts)?.show(values.value(key)?))
        };
        let texts = K::FIELDS.iter().map(|(_, key, _)| text(*key).unwrap_or_default()).collect();
        Self { values, texts, order: None }
    }
}

impl<K: Kind> Numbered<K> {
    /// Request that reads a row.
    pub fn read_order(number: i32) -> Result<Order> {
        K::READ.0.order().with(K::READ.1, number).valid_order()
    }

    /// Request that stores a row with these texts.
    fn write_order(number: i32, texts: &[String]) -> Result<Order> {
        let fields = K::FIELDS.iter().zip(texts);
        // In the request that writes a hand, the robot is the field `Robot`. In the answer to a read, the robot is the
        // field `Owner`. An empty text means that the hand system is not sent.
        let draft = fields.fold(K::WRITE.order().with(K::READ.1, number), |draft, ((_, key, _), text)| match key {
            Key::Owner => draft.with(Key::Robot, text.as_str()),
            Key::HandSystem if text.is_empty() => draft,
            key => draft.with(*key, text.as_str()),
        });
        draft.valid_order()
    }

    /// Values that are read after a request with `values` stored them.
    pub fn stored(values: &Values) -> Values {
        let stored = |(_, key, _): &(_, Key, _)| match *key {
            // Robot 0 is the first.
            Key::Owner => (Key::Owner, Value::Int(values.int(Key::Robot).unwrap_or_default().max(1))),
            key => (key, values.value(key).cloned().unwrap_or(Value::Int(0))),
        };
        K::FIELDS.iter().map(stored).collect()
    }
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
        Ok(Numbers::of(&[Numbers::parse(K::READ.0, K::READ.1, text)?]))
    }

    fn all() -> Vec<i32> {
        let numbers = K::NUMBERS.iter().filter(|_| K::IS_SMALL);
        numbers.flat_map(|range| Self::keys(range).expect("the numbers of every table are numbers")).collect()
    }

    fn any() -> String {
        Self::name(0)
    }

    fn name(number: i32) -> String {
        named(K::READ.0, K::READ.1, number)
    }

    fn names(numbers: &[i32]) -> String {
        runs(numbers)
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self::default())
    }

    fn fields(&self) -> Vec<Field> {
        let field = |(name, key, heading): &(&'static str, Key, &'static str)| {
            if is_number(*key) { Field::number(name, heading) } else { Field::text(name, heading) }
        };
        K::FIELDS.iter().map(field).collect()
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

    async fn read(&self, link: &mut Link, screen: &Screen, numbers: &[i32]) -> Result<Answers<Row>> {
        let order = |number: &i32| link.draft(K::READ.0)?.with(K::READ.1, *number).valid_order();
        let orders = numbers.iter().map(order).collect::<Result<Vec<Order>>>()?;
        let answers = ask_each(link, screen, &format!("reading {}", K::WORDS.nouns[1]), &orders).await?;
        let rows = answers.outcomes.into_iter().map(|outcome| outcome.map(|values| Some(Row::new::<K>(values))));
        Ok(Answers { rows: rows.collect(), asked: answers.asked })
    }
}

/// Whether a field is a number.
pub fn is_number(key: Key) -> bool {
    !matches!(key, Key::Unit | Key::HandSystem | Key::Comment)
}

/// New content of a row: a text for each field that the user gave.
pub type Draft = Vec<Option<String>>;

impl<K: Kind> Writable for Numbered<K> {
    type Draft = Draft;

    const RISK: Risk = K::RISK;

    fn draft(&self, number: i32, texts: &[Option<&str>]) -> Result<Draft, String> {
        let draft: Draft = texts.iter().map(|text| text.map(ToOwned::to_owned)).collect();
        if let Some(texts) = draft.iter().cloned().collect::<Option<Vec<String>>>() {
            Self::write_order(number, &texts).map_err(|failure| failure.message)?;
        }
        Ok(draft)
    }

    fn complete_draft(&self, number: i32, draft: &Draft, old: Option<&Row>) -> Result<Row> {
        // If the unit changes, the old values of the axes are not kept.
        let unit = K::FIELDS.iter().position(|(_, key, _)| *key == Key::Unit);
        let has_unit = |old: &&Row| unit.is_none_or(|at| draft[at].as_ref().is_none_or(|unit| *unit == old.texts[at]));
        let old = old.filter(has_unit);
        let kept = |(at, text): (usize, &Option<String>)| match (text, old) {
            (Some(text), _) => Ok(text.clone()),
            (None, Some(old)) => Ok(old.texts[at].clone()),
            (None, None) if K::FIELDS[at].1 == Key::HandSystem => Ok(String::new()),
            (None, None) => {
                let (one, field) = (Self::WORDS.nouns[0], K::FIELDS[at].0);
                let unit =
                    unit.and_then(|at| draft[at].as_ref()).map_or_else(String::new, |unit| format!(" in {unit}"));
                let message = format!("{one} {number} is not defined{unit}, so it has no {field} to keep");
                Err(Failure::usage(message).hint("type all values; nothing was written"))
            }
        };
        let texts = draft.iter().enumerate().map(kept).collect::<Result<Vec<String>>>()?;
        let order = Self::write_order(number, &texts)?;
        Ok(Row { order: Some(order.clone()), ..Row::new::<K>(Self::stored(order.values())) })
    }

    async fn plan(&self, link: &mut Link, rows: &[store::Row<Self>]) -> Result<()> {
        for (number, draft) in rows {
            let about = Self::asked(*number);
            let reason = Reason::about(&about).depending_on("the current data: written if different");
            let is_pulse = draft.iter().flatten().any(|text| text == "pulse");
            let sample = |key: Key, which: usize| match key {
                Key::HandSystem if is_pulse => "",
                key => samples(key, *number)[which],
            };
            // Make two rows that are equal only in the given fields.
            let filled = |which: usize| {
                let fields = draft.iter().zip(K::FIELDS);
                let text = |(text, (_, key, _)): (&Option<String>, &(_, Key, _))| {
                    text.clone().unwrap_or_else(|| sample(*key, which).into())
                };
                Self::write_order(*number, &fields.map(text).collect::<Vec<_>>())
            };
            match (filled(0), filled(1)) {
                (Ok(one), Ok(other)) => link.plan_depending(&one, &other, reason),
                _ => link.then(&format!("{} {number} is written", Self::WORDS.nouns[0])),
            }
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for order in rows.iter().filter_map(|(_, _, new)| new.order.as_ref()) {
            link.ask(order).await?;
        }
        Ok(())
    }
}

/// Returns two different texts of a field, so that a dry run can mark the field as unknown.
fn samples(key: Key, number: i32) -> [&'static str; 2] {
    match key {
        Key::Unit => ["mm", "pulse"],
        // Only points in millimeters have a hand system.
        Key::HandSystem => ["left", ""],
        Key::Comment => ["", "AAAAAAAAAAAAAAAA"],
        // In a plan, the robot number is part of the command word. The plan shows the first robot.
        Key::Owner => ["1", "1"],
        Key::CountX | Key::CountY | Key::CountZ | Key::FirstPoint => ["1", "2"],
        Key::Data4 => ["0", "1"],
        // The numbers of real variables start at 256.
        Key::Value if number >= 256 => ["0", "-1.1"],
        _ => ["0", "-1"],
    }
}

/// Takes a whole number from an answer.
pub fn int(values: &Values, key: Key) -> i32 {
    values.int(key).unwrap_or_default()
}

/// Takes millimeters from an answer, which has thousandths of a millimeter.
pub fn mm(values: &Values, key: Key) -> f64 {
    f64::from(int(values, key)) / 1000.0
}

/// Whether all of these fields are zero or missing.
pub fn all_zero(values: &Values, keys: &[Key]) -> bool {
    keys.iter().all(|key| values.value(*key).is_none_or(|value| *value == Value::Int(0)))
}

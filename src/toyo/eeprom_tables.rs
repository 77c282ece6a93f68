//! Tables in the EEPROM of the controller: speeds, acceleration times, torque limits, easy programs. Each table has a
//! declaration ([`Kind`]). All tables read and write rows in the same way.

use std::fmt::Debug;
use std::marker::PhantomData;

use super::eeprom::{Cell, Cells, parameter_cell, parameter_sketch};
use super::field_values::{Changes, NOT_IN_MANUAL, word};
use super::item_reads::read_each;
use super::number_arguments::Numbers;
use crate::prelude::*;
use armctl_controller::toyo::field::{self, Form};
use armctl_controller::toyo::layout::{Layout, UNLISTED};
use armctl_frame::robot::item::as_requested;
use armctl_frame::store::Row;

table_commands! {
    /// Commands for the speed table. Programs name a speed by its row.
    SpeedTable of Rows<Speed> {}
}

table_commands! {
    /// Commands for the acceleration table. Programs name an acceleration time by its row.
    AccelTable of Rows<Accel> {}
}

table_commands! {
    /// Commands for the torque table. Programs name a torque limit by its row.
    TorqueTable of Rows<Torque> {}
}

/// Declaration of a table and its reports.
pub trait Kind: Debug + Send + Sync + 'static {
    /// Values of one row in a report.
    type Value: Debug + Clone + Serialize + JsonSchema;
    /// Names in help and messages.
    const WORDS: TableWords;
    /// Report names.
    const IDS: Ids;
    /// Fields of a row, in the order of the protocol.
    const FIELDS: &'static [Field];
    /// Whether a row of zeros counts as empty.
    const ZERO_IS_BLANK: bool = false;
    /// Id of the parameter whose rows the table has. A table of another command implements the functions that use it.
    const TABLE: &'static str = "";

    /// Field of the row number.
    fn key() -> &'static field::Field {
        &parameter(Self::TABLE).key.fields[0]
    }

    /// Layout of the fields after the row number.
    fn body() -> Layout {
        parameter(Self::TABLE).body()
    }

    /// Request that reads a row.
    fn read(row: i32) -> Result<Request> {
        Request::read_parameter(parameter(Self::TABLE), Some(row)).map_err(|error| wrong(&error))
    }

    /// EEPROM cell of a row with these values.
    fn cell(row: i32, values: Vec<Value>) -> Result<Cell> {
        row_cell(parameter(Self::TABLE), row, values)
    }

    /// Block that writes a row. `?` stands for values that are kept.
    fn sketch(row: i32, values: &[Option<Value>]) -> String {
        parameter_sketch(parameter(Self::TABLE), Some(row), values)
    }

    /// Converts a record to the values of a row.
    fn value(record: &Record) -> Self::Value;
}

fn parameter(id: &str) -> &'static Parameter {
    Parameter::named(id).expect("every table is in the table of parameters")
}

/// EEPROM cell of a row of a parameter that is a table.
pub fn row_cell(table: &'static Parameter, row: i32, values: Vec<Value>) -> Result<Cell> {
    let values = std::iter::once(Value::Number(row)).chain(values).collect();
    parameter_cell(table, values).map_err(|error| wrong(&error))
}

/// Help of commands that write to the EEPROM.
pub const WRITING: &str = "armctl does not write equal values, because an EEPROM cell wears out after about a million \
                           writes.";

const fn words(nouns: [&'static str; 2], placeholder: &'static str, range: &'static str) -> TableWords {
    TableWords { nouns, placeholder, range, reading: None, writing: Some(WRITING) }
}

/// The table of kind `K` as a store.
#[derive(Debug)]
pub struct Rows<K>(PhantomData<K>);

/// Fields that toyo adds to an item.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Listed {
    /// Whether the manual lists the value; null if the value was not read.
    pub in_manual: Option<bool>,
    /// Stored text, if the manual does not list it. Such a text is not written back.
    pub raw: Option<String>,
}

impl Listed {
    /// Creates the fields for a record that was read.
    pub fn of(record: Option<&Record>) -> Self {
        let is_listed = record.map(Record::is_listed);
        Self { in_manual: is_listed, raw: record.filter(|record| !record.is_listed()).map(Record::written) }
    }
}

impl<K: Kind> Default for Rows<K> {
    fn default() -> Self {
        Self(PhantomData)
    }
}

impl<K: Kind> Store for Rows<K> {
    type Family = Toyo;
    type Key = i32;
    type Wire = Record;
    type Value = K::Value;
    type More = Listed;
    type Options = Single;

    const WORDS: TableWords = K::WORDS;
    const IDS: Ids = K::IDS;

    fn keys(text: &str) -> Result<Vec<i32>, String> {
        Ok(Numbers::of(&[Numbers::parse(K::key(), text)?], K::key()))
    }

    fn all() -> Vec<i32> {
        Numbers::of(&[], K::key())
    }

    fn name(row: i32) -> String {
        row.to_string()
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self::default())
    }

    fn fields(&self) -> Vec<Field> {
        K::FIELDS.to_vec()
    }

    fn texts(&self, record: &Record) -> Vec<String> {
        texts(record, K::body().fields.len())
    }

    fn value(&self, record: &Record) -> Option<K::Value> {
        record.is_listed().then(|| K::value(record))
    }

    fn more(&self, _row: i32, record: Option<&Record>) -> Listed {
        Listed::of(record)
    }

    fn is_blank(&self, record: &Record) -> bool {
        K::ZERO_IS_BLANK && is_zero(record, K::body().fields.len())
    }

    fn unsaved(&self, _row: i32, record: Option<&Record>) -> Option<String> {
        unlisted(record)
    }

    async fn read(&self, link: &mut Link, screen: &Screen, rows: &[i32]) -> Result<Answers<Record>> {
        let requests = rows.iter().copied().map(K::read).collect::<Result<Vec<Request>>>()?;
        let what = format!("reading {}", K::WORDS.nouns[1]);
        Ok(Answers::of(read_each(link, screen, &what, &requests).await?))
    }
}

impl<K: Kind> EepromRow for Rows<K> {
    fn body(&self, _row: i32) -> Layout {
        K::body()
    }

    fn request(&self, row: i32) -> Result<Request> {
        K::read(row)
    }

    fn cell(&self, row: i32, values: Vec<Value>) -> Result<Cell> {
        K::cell(row, values)
    }

    fn sketch(&self, row: i32, values: &[Option<Value>]) -> String {
        K::sketch(row, values)
    }
}

/// A table whose rows are records in the EEPROM.
pub trait EepromRow: Store<Family = Toyo, Wire = Record> {
    /// Whether the rows have different fields. In that case, a file has one column for all fields: `ax1=100 ax2=0`.
    const IS_MIXED: bool = false;

    /// Returns the letters of the axes, for rows with coordinates.
    fn letters(&self) -> Letters {
        Letters::USUAL
    }

    /// Expands words of a command line. For example, the name of a file is replaced by the values in the file.
    fn words(&self, words: &[String]) -> Result<Vec<String>> {
        Ok(words.to_vec())
    }

    /// Layout of the fields after the key.
    fn body(&self, key: Self::Key) -> Layout;

    /// Request that reads a row.
    fn request(&self, key: Self::Key) -> Result<Request>;

    /// EEPROM cell of a row with these values.
    fn cell(&self, key: Self::Key, values: Vec<Value>) -> Result<Cell>;

    /// Block that writes a row. `?` stands for values that are kept.
    fn sketch(&self, key: Self::Key, values: &[Option<Value>]) -> String;

    /// Checks that the values of a row are consistent.
    fn check(&self, _key: Self::Key, _values: &[Value]) -> Result<()> {
        Ok(())
    }

    /// Returns the rank of a row in the order of the writes.
    fn rank(_key: Self::Key) -> usize {
        0
    }
}

/// Makes tables of EEPROM records writable. A blanket implementation is not possible: the trait belongs to another
/// crate.
macro_rules! writable {
    ($($table:ty $(, $kind:ident: $bound:path)?;)*) => {
        $(
        impl$(<$kind: $bound>)? Writable for $table {
    type Draft = Changes;

    const RISK: Risk = Risk::Destroy;

    fn draft(&self, key: Self::Key, texts: &[Option<&str>]) -> Result<Changes, String> {
        if Self::IS_MIXED {
            let words: Vec<String> =
                texts.iter().flatten().flat_map(|text| text.split_whitespace()).map(ToOwned::to_owned).collect();
            return self.typed(key, &words).map_err(|failure| failure.message);
        }
        let fields = self.body(key).fields;
        let values = fields.iter().zip(texts).map(|(field, text)| text.map(|text| word(field, text)).transpose());
        values.collect::<Result<_, _>>().map(Changes::of)
    }

    fn typed(&self, key: Self::Key, words: &[String]) -> Result<Changes> {
        let what = as_requested(Self::WORDS.nouns[0], &Self::name(key));
        let changes = Changes::read(&what, &self.body(key), &self.letters(), &self.words(words)?)?;
        if let Some(values) = changes.whole() {
            self.check(key, &values)?;
        }
        Ok(changes)
    }

    fn complete_draft(&self, key: Self::Key, changes: &Changes, old: Option<&Record>) -> Result<Record> {
        let values = match (changes.whole(), old) {
            (Some(values), _) => values,
            (None, Some(old)) => changes.merged_with(old)?,
            (None, None) => {
                let message = format!(
                    "{} could not be read, so the values that are not typed are unknown",
                    as_requested(Self::WORDS.nouns[0], &Self::name(key))
                );
                return Err(Failure::usage(message).hint("type all values; nothing was written"));
            }
        };
        self.check(key, &values)?;
        Ok(self.cell(key, values)?.wanted)
    }

    fn blocks(&self, rows: &[RowDifference<'_, Self>]) -> Vec<Vec<usize>> {
        let mut order: Vec<usize> = (0..rows.len()).collect();
        order.sort_by_key(|index| Self::rank(rows[*index].0));
        order.into_iter().map(|index| vec![index]).collect()
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        let mut rows: Vec<&Row<Self>> = rows.iter().collect();
        rows.sort_by_key(|(key, _)| Self::rank(*key));
        for (key, changes) in rows {
            link.plan_overwriting(&self.request(*key)?, &self.sketch(*key, changes.values())).await?;
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for (key, _, new) in rows {
            let fields = self.body(*key).fields.len();
            let values = new.values()[new.values().len().saturating_sub(fields)..].to_vec();
            link.overwrite(screen, &self.cell(*key, values)?, &mut Cells::default()).await?;
        }
        Ok(())
    }
        }
        )*
    };
}

writable! {
    super::point::Points;
    super::param::Parameters;
    super::palletizing::Records;
    Rows<K>, K: Kind;
}

/// Values of a record as typed. If the manual does not list a value, its text in the protocol is unchanged.
pub fn texts(record: &Record, fields: usize) -> Vec<String> {
    if record.layout() == UNLISTED {
        return vec![format!("{} ({NOT_IN_MANUAL})", record.written())];
    }
    let keys = record.values().len().saturating_sub(fields);
    record.pairs().skip(keys).map(|(field, value)| plain(field, value)).collect()
}

/// Reason why a record is not saved. If the manual does not list the record, it cannot be written back.
pub fn unlisted(record: Option<&Record>) -> Option<String> {
    record.filter(|record| !record.is_listed()).map(|record| format!("'{}' is {NOT_IN_MANUAL}", record.written()))
}

/// Whether all values of a record, without its keys, are zero.
pub fn is_zero(record: &Record, fields: usize) -> bool {
    let keys = record.values().len().saturating_sub(fields);
    record.is_listed() && record.pairs().skip(keys).all(|(_, value)| *value == Value::Number(0))
}

/// Formats a value as a user types it.
fn plain(field: &field::Field, value: &Value) -> String {
    match (field.form, value) {
        (Form::Number(number), Value::Number(units)) => number.plain(*units),
        _ => field.written(value).trim_end().to_owned(),
    }
}

/// Table T2, the speed table.
#[derive(Debug)]
pub struct Speed;

/// Table T3, the acceleration table.
#[derive(Debug)]
pub struct Accel;

/// Table T5, the torque limit table.
#[derive(Debug)]
pub struct Torque;

/// A row of the torque limit table; the manual gives no unit.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct TorqueRow {
    limit: f64,
    /// Torque at which the load output switches on.
    load: f64,
}

impl Kind for Speed {
    type Value = f64;
    const TABLE: &'static str = "T2";
    const IDS: Ids = ids!("toyo.speed-table");
    const WORDS: TableWords =
        words(["speed-table row", "speed-table rows"], "ROW", "Rows of the speed table (1 to 20), such as 5 or 1-5,20");
    const FIELDS: &'static [Field] = &[Field::number("speed_mm_s", "speed (mm/s)")];

    fn value(record: &Record) -> f64 {
        decimal(record, "speed")
    }
}

impl Kind for Accel {
    type Value = f64;
    const TABLE: &'static str = "T3";
    const IDS: Ids = ids!("toyo.accel-table");
    const WORDS: TableWords = words(
        ["accel-table row", "accel-table rows"],
        "ROW",
        "Rows of the acceleration table (1 to 20), such as 5 or \
                                                               1-5,20",
    );
    const FIELDS: &'static [Field] = &[Field::number("time_s", "time (s)")];

    fn value(record: &Record) -> f64 {
        decimal(record, "time")
    }
}

impl Kind for Torque {
    type Value = TorqueRow;
    const TABLE: &'static str = "T5";
    const IDS: Ids = ids!("toyo.torque-table");
    const WORDS: TableWords = words(
        ["torque-table row", "torque-table rows"],
        "ROW",
        "Rows of the torque limit table (1 to 8), such as 5 \
                                                                 or 1-3",
    );
    const FIELDS: &'static [Field] = &[Field::number("limit", "limit"), Field::number("load", "load")];

    fn value(record: &Record) -> TorqueRow {
        TorqueRow { limit: decimal(record, "limit"), load: decimal(record, "load") }
    }
}

/// Number in the unit of its field; 0 if the record has no such field.
fn decimal(record: &Record, name: &str) -> f64 {
    let mut pairs = record.pairs();
    let found = pairs.find_map(|(field, value)| match (field.form, value) {
        (Form::Number(form), Value::Number(units)) if field.name == name => {
            Some(f64::from(*units) / f64::from(form.scale()))
        }
        _ => None,
    });
    found.unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use crate::testing::Bench;

    #[test]
    fn row_keeps_unnamed_values() {
        let mut bench = Bench::new("sim:");
        bench.data(&["torque-table", "set", "2", "1.5", "1.25"]);
        let stored = bench.data(&["torque-table", "set", "2", "load=1"]);
        let item = &stored["items"][0];
        assert_eq!((&item["old"], &item["written"]), (&json!({"limit": 1.5, "load": 1.25}), &true.into()), "{stored}");
        assert_eq!(bench.data(&["torque-table", "set", "2", "load=1"])["items"][0]["written"], false);
        let read = bench.data(&["torque-table", "get", "2"]);
        let item = json!({
            "name": "2", "label": null, "kind": "torque-table row", "in_manual": true, "raw": null, "ok": true,
            "value": { "limit": 1.5, "load": 1.0 },
        });
        assert_eq!(read, json!({ "items": [item] }));
    }

    #[test]
    fn rows_are_copied_saved_and_written_back() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("torque.csv");
        let file = file.to_str().unwrap();
        let mut bench = Bench::new("sim:");
        bench.data(&["torque-table", "set", "2", "1.5", "1.25"]);
        let copied = bench.data(&["torque-table", "copy", "2", "3-4"]);
        assert_eq!((&copied["items"][1]["name"], &copied["items"][1]["value"]["load"]), (&"4".into(), &1.25.into()));
        bench.data(&["torque-table", "dump", file, "2-4"]);
        let text = std::fs::read_to_string(file).unwrap();
        assert_eq!(text, "name,limit,load\n2,1.50,1.25\n3,1.50,1.25\n4,1.50,1.25\n");
        std::fs::write(file, "name,load\n3,2\n4,1.25\n").unwrap();
        let restored = bench.data(&["torque-table", "restore", file]);
        let written: Vec<_> = restored["items"].as_array().unwrap().iter().map(|item| &item["written"]).collect();
        assert_eq!(written, [true, false]);
        assert_eq!(bench.data(&["torque-table", "get", "3"])["items"][0]["value"], json!({"limit": 1.5, "load": 2.0}));
        std::fs::write(file, "name,load\n3,200\n9,1\n").unwrap();
        let failure = bench.run(&["torque-table", "restore", file]).unwrap_err();
        assert!(failure.message.contains("2:") && failure.message.contains("9 is out of range"), "{failure}");
        assert_eq!(bench.run(&["torque-table", "copy", "2", "2"]).unwrap_err().kind.exit(), 2);
    }
}

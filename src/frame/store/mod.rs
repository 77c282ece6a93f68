//! Tables of a controller. A family declares a table ([`Store`], [`Writable`]). The commands `get`, `list`, `watch`,
//! `set`, `copy`, `dump` and `restore` are generic, so that they are the same for every table in every family.

mod change;
mod copy;
mod file;
mod get;
mod part;
mod set;

use std::borrow::Cow;
use std::fmt::Debug;
use std::hash::Hash;

pub use self::change::{ComparedRow, Row, TableWrite, describe_change, overwriting, write, write_rows};
pub use self::copy::Copy;
pub use self::file::{Dump, LeftOut, Restore, keys_of, rows_of_file};
pub use self::get::{Get, List};
pub use self::part::{Part, PartResult, TablePart, Text, part_text};
pub use self::set::{Set, comma_hint};
use super::connection::Family;
use super::names as labels;
use super::value_kind::ValueKind;
use crate::prelude::basics::*;
use crate::robot::item::{Columns, Item, Items, WrittenItems, as_requested};
use armctl_controller::names::{Kind, Names};
use armctl_controller::sheet::Column;

/// A field of a row, in tables and files.
#[derive(Debug, Clone)]
pub struct Field {
    /// Column name in a file, such as `speed_mm_s`.
    pub name: Cow<'static, str>,
    /// Alternative column name, for example `ax1_mm` for `x_mm`.
    pub alias: Option<&'static str>,
    /// Heading in a table, such as `speed (mm/s)`.
    pub heading: &'static str,
    /// Whether the field is a number.
    pub is_number: bool,
    /// Whether only some rows have the field. If so, an empty cell means no value, and a file has the column only if a
    /// row has a value.
    pub is_optional: bool,
}

impl Field {
    /// Field with a number.
    pub const fn number(name: &'static str, heading: &'static str) -> Self {
        Self { name: Cow::Borrowed(name), alias: None, heading, is_number: true, is_optional: false }
    }

    /// Field with a text.
    pub const fn text(name: &'static str, heading: &'static str) -> Self {
        Self { name: Cow::Borrowed(name), alias: None, heading, is_number: false, is_optional: false }
    }

    /// Marks the field as a field that only some rows have.
    #[must_use]
    pub fn optional(self) -> Self {
        Self { is_optional: true, ..self }
    }
}

/// Texts with the names of a table and its rows.
#[derive(Debug, Clone, Copy)]
pub struct TableWords {
    /// Singular and plural of the name of a row, such as `counter`, `counters`. The singular is `kind` in reports.
    pub nouns: [&'static str; 2],
    /// Placeholder for a row on the command line: `N`, `POINT`.
    pub placeholder: &'static str,
    /// Description of valid rows for the help, for example `1 to 99: 5, CN05 or 1-10, or a name`.
    pub range: &'static str,
    /// Additional help for commands that read.
    pub reading: Option<&'static str>,
    /// Additional help for `set`.
    pub writing: Option<&'static str>,
}

/// Report names of the commands of a table.
#[derive(Debug, Clone, Copy)]
pub struct Ids {
    /// Report name of `get`, such as `toyo.counter.get`.
    pub get: &'static str,
    /// Report name of `list`.
    pub list: &'static str,
    /// Report name of `watch`.
    pub watch: &'static str,
    /// Report name of `set`.
    pub set: &'static str,
    /// Report name of `copy`.
    pub copy: &'static str,
    /// Report name of `dump`.
    pub dump: &'static str,
    /// Report name of `restore`.
    pub restore: &'static str,
}

/// Report names for the commands of a noun, for example `ids!("toyo.counter")`.
#[macro_export]
macro_rules! ids {
    ($noun:literal) => {
        $crate::store::Ids {
            get: concat!($noun, ".get"),
            list: concat!($noun, ".list"),
            watch: concat!($noun, ".watch"),
            set: concat!($noun, ".set"),
            copy: concat!($noun, ".copy"),
            dump: concat!($noun, ".dump"),
            restore: concat!($noun, ".restore"),
        }
    };
}
pub use ids;

/// Declares the commands of a table: the generic commands, and then additional commands.
#[macro_export]
macro_rules! table_commands {
    ($(#[$meta:meta])* $name:ident of $store:ty { $($(#[$doc:meta])* $variant:ident($arguments:ty),)* }) => {
        $crate::commands! {
            $(#[$meta])*
            pub enum $name {
                /// Read rows by number or range
                Get($crate::store::Get<$store>),
                /// List all rows that are not empty
                List($crate::store::List<$store>),
                /// Print rows, then each change of a row
                Watch($crate::watch::Watch<$crate::store::Get<$store>>),
                /// Write a row: type its number, then its values
                Set($crate::store::Set<$store>),
                /// Copy a row to other rows, for example `5 6-8`
                Copy($crate::store::Copy<$store>),
                /// Save rows to a CSV file
                Dump($crate::store::Dump<$store>),
                /// Write rows from a CSV file
                Restore($crate::store::Restore<$store>),
                $($(#[$doc])* $variant($arguments),)*
            }
        }
    };
}
pub use table_commands;

/// Connection to the controller of a table.
pub type LinkOf<S> = <<S as Store>::Family as Family>::Link;

/// Results of rows. Each result is the content, `None` if the row is not defined, or the reason why the row was not
/// read.
#[derive(Debug)]
pub struct Answers<W> {
    /// One result for each row, in the requested order.
    pub rows: Vec<Result<Option<W>>>,
    /// Number of rows that were requested. The other rows were not requested, because they would fail in the same way.
    pub asked: usize,
}

impl<W> Answers<W> {
    /// Creates the results of rows that were all requested. A row that was read is defined.
    pub fn of(rows: Vec<Result<W>>) -> Self {
        Self { asked: rows.len(), rows: rows.into_iter().map(|row| row.map(Some)).collect() }
    }
}

/// Options of a table that exists only once per controller.
#[derive(Debug, Clone, Copy, Args)]
pub struct Single {}

/// A table of a controller that can be read.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Store: Debug + Send + Sync + Sized + 'static {
    /// Family of the controller.
    type Family: Family;
    /// Key of a row.
    type Key: Debug + Clone + std::marker::Copy + PartialEq + Eq + Hash + Send + Sync;
    /// Content of a row in the protocol.
    type Wire: Debug + Clone + PartialEq;
    /// Content of a row in reports.
    type Value: Debug + Clone + Serialize + JsonSchema;
    /// Additional fields of an item. [`Plain`](crate::robot::item::Plain) if there are none.
    type More: Debug + Clone + Serialize + JsonSchema;
    /// Options that select the table, if there are several; otherwise [`Single`].
    type Options: Args + Debug + Clone + Send + Sync;

    /// Words for messages and help.
    const WORDS: TableWords;
    /// Names of the reports.
    const IDS: Ids;
    /// Kind of the names that a user can give to rows, if any.
    const LABELS: Option<Kind> = None;
    /// Completion of the row argument.
    const COMPLETE: ValueKind = ValueKind::Listed(Vec::new);
    /// Whether `dump` also saves blank rows.
    const SAVES_BLANK: bool = false;
    /// Whether a row is a text. `set` accepts it as one word, which may begin with any sign.
    const IS_TEXT: bool = false;
    /// Whether `get` reports an undefined row as null if other rows are defined, and fails only if none is defined.
    const UNDEFINED_IS_NULL: bool = false;

    /// Why `restore` skips certain rows unless the user types them.
    const NOT_RESTORED: &'static str = "to write these rows, type them in the command";

    /// Help text of `get` and `set` that is not a constant.
    fn help() -> Option<&'static str> {
        None
    }

    /// Parses rows as typed: one row, or a range.
    ///
    /// # Errors
    /// If the text is not a row.
    fn keys(text: &str) -> Result<Vec<Self::Key>, String>;

    /// All rows, if they are few enough to be read without a selection; otherwise an empty list.
    fn all() -> Vec<Self::Key> {
        Vec::new()
    }

    /// Rows that `dump` saves if the user types none.
    fn saved() -> Vec<Self::Key> {
        Self::all()
    }

    /// A row that always exists. It stands for a name that is not resolved yet.
    fn any() -> String {
        Self::all().first().map_or_else(String::new, |key| Self::name(*key))
    }

    /// Name of a row as the user types it.
    fn name(key: Self::Key) -> String;

    /// Names of several rows as the user types them.
    fn names(keys: &[Self::Key]) -> String {
        keys.iter().map(|key| Self::name(*key)).collect::<Vec<_>>().join(", ")
    }

    /// Name of a row in questions.
    fn asked(key: Self::Key) -> String {
        as_requested(Self::WORDS.nouns[0], &Self::name(key))
    }

    /// Address to which the user-defined name of the row belongs.
    fn address(key: Self::Key) -> String {
        Self::name(key)
    }

    /// Reads the information that is needed before a row is read or written, such as the axis letters. It changes
    /// nothing.
    async fn open(link: &mut LinkOf<Self>, options: &Self::Options) -> Result<Self>;

    /// Reads the information that is needed before these rows are read, or parsed from a file.
    async fn prepare(&mut self, _link: &mut LinkOf<Self>, _keys: &[Self::Key]) -> Result<()> {
        Ok(())
    }

    /// Risk of a read. It is Write if another table must be selected on the controller before the read.
    fn risk_of_reading(_options: &Self::Options) -> Risk {
        Risk::Read
    }

    /// Selects this table, if the controller has several tables.
    async fn select(&mut self, _link: &mut LinkOf<Self>) -> Result<()> {
        Ok(())
    }

    /// Restores the table that was selected before [`select`](Self::select), also after a failure.
    async fn deselect<T>(&self, _link: &mut LinkOf<Self>, outcome: Result<T>) -> Result<T> {
        outcome
    }

    /// Text that names one of several tables in questions, such as ` of task 2`.
    fn table_suffix(&self) -> String {
        String::new()
    }

    /// Fields that a row of this table can have.
    fn fields(&self) -> Vec<Field>;

    /// Text of each field, in the order of [`fields`](Self::fields).
    fn texts(&self, wire: &Self::Wire) -> Vec<String>;

    /// Headings of a table. By default, these are the headings of the fields.
    fn headings(&self) -> Vec<&'static str> {
        self.fields().iter().map(|field| field.heading).collect()
    }

    /// Cells of a row in the table output.
    fn cells(&self, _key: Self::Key, wire: &Self::Wire) -> Vec<Cell> {
        let cell = |(field, text): (Field, String)| if field.is_number { Cell::number(text) } else { text.into() };
        self.fields().into_iter().zip(self.texts(wire)).map(cell).collect()
    }

    /// Differences between two rows: one line for the old row, one line for the new row.
    fn difference(&self, old: &Self::Wire, new: &Self::Wire) -> [String; 2] {
        difference(self, old, new)
    }

    /// Content of a row for reports; `None` if the content cannot be reported.
    fn value(&self, wire: &Self::Wire) -> Option<Self::Value>;

    /// Additional fields for the item of a row. `wire` is `None` if the row was not read or is not defined.
    fn more(&self, key: Self::Key, wire: Option<&Self::Wire>) -> Self::More;

    /// Whether two rows have the same content.
    fn is_equal(old: &Self::Wire, new: &Self::Wire) -> bool {
        old == new
    }

    /// Whether a row contains no user data.
    fn is_blank(&self, _wire: &Self::Wire) -> bool {
        false
    }

    /// Reason why a row is not in a file although it was read. `wire` is `None` if the row is not defined.
    fn unsaved(&self, _key: Self::Key, _wire: Option<&Self::Wire>) -> Option<String> {
        None
    }

    /// Whether a refusal to report a row means that the row is not defined.
    fn is_undefined(_failure: &Failure) -> bool {
        false
    }

    /// Whether `restore` writes this row if the user types no rows.
    fn is_restored(_key: Self::Key) -> bool {
        true
    }

    /// Whether a row that was not read does not exist on this controller. A backup without such a row is complete.
    fn is_absent(_key: Self::Key) -> bool {
        false
    }

    /// Consequences of the write, for the question to the user.
    fn consequences(&self, _rows: &[RowDifference<'_, Self>]) -> Vec<String> {
        Vec::new()
    }

    /// Note about what the user must do after these rows were written.
    fn follow_up_note(&self, _written: &[Self::Key]) -> Option<String> {
        None
    }

    /// Reads rows, each with its own result. A dry run notes the requests and fails with
    /// [`unknown`](super::dry_run::unknown).
    ///
    /// # Errors
    /// If a failure occurs before any row was read.
    async fn read(&self, link: &mut LinkOf<Self>, screen: &Screen, keys: &[Self::Key]) -> Result<Answers<Self::Wire>>;
}

/// A row to write: its key, its old content if known, and its new content.
pub type RowDifference<'r, S> = (<S as Store>::Key, Option<&'r <S as Store>::Wire>, &'r <S as Store>::Wire);

/// A table that can be written.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Writable: Store {
    /// New content of a row. It can be incomplete.
    type Draft: Debug + Clone;

    /// Highest risk of all rows: Destroy if user data can be overwritten, otherwise Write.
    const RISK: Risk;

    /// Risk of writing this row.
    fn risk(_key: Self::Key) -> Risk {
        Self::RISK
    }

    /// Creates the new content of a row from the text of each field. A field without a text keeps its old value.
    ///
    /// # Errors
    /// If the content is not valid.
    fn draft(&self, key: Self::Key, texts: &[Option<&str>]) -> Result<Self::Draft, String>;

    /// New content, from words of a command line: all values in their order, or some values as `NAME=VALUE`.
    ///
    /// # Errors
    /// If the content is not valid.
    fn typed(&self, key: Self::Key, words: &[String]) -> Result<Self::Draft> {
        set::typed(self, key, words)
    }

    /// Completes the new content with the old content.
    ///
    /// # Errors
    /// If an old value is needed, but is unknown or cannot be written.
    fn complete_draft(&self, key: Self::Key, draft: &Self::Draft, old: Option<&Self::Wire>) -> Result<Self::Wire>;

    /// Reads rows before a write. An implementation can override this function, so that a dry run shows its own purpose
    /// for these requests.
    ///
    /// # Errors
    /// As [`read`](Store::read).
    async fn read_old(
        &self,
        link: &mut LinkOf<Self>,
        screen: &Screen,
        rows: &[Row<Self>],
    ) -> Result<Answers<Self::Wire>> {
        let keys: Vec<Self::Key> = rows.iter().map(|(key, _)| *key).collect();
        self.read(link, screen, &keys).await
    }

    /// Groups of row indices that one request can write. By default, each request writes one row.
    fn blocks(&self, rows: &[RowDifference<'_, Self>]) -> Vec<Vec<usize>> {
        (0..rows.len()).map(|index| vec![index]).collect()
    }

    /// In a dry run, records the requests that write rows and read them back.
    async fn plan(&self, link: &mut LinkOf<Self>, rows: &[Row<Self>]) -> Result<()>;

    /// Writes the rows of a [block](Self::blocks).
    async fn write(&self, link: &mut LinkOf<Self>, screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()>;
}

/// Report of commands that read rows.
type ItemsOf<S> = Items<<S as Store>::Value, <S as Store>::More>;
/// Report of commands that write rows.
pub type WrittenOf<S> = WrittenItems<<S as Store>::Value, <S as Store>::More>;

/// Report item for a row.
fn item<S: Store>(table: &S, names: &Names, key: S::Key, outcome: Result<Option<S::Wire>>) -> Item<S::Value, S::More> {
    let name = S::name(key);
    let label = S::LABELS.and_then(|kind| labels::label(names, kind, &S::address(key)));
    let wire = outcome.as_ref().ok().and_then(Option::as_ref);
    let (cells, more) = (wire.map(|wire| table.cells(key, wire)).unwrap_or_default(), table.more(key, wire));
    // The row was read, and has no value.
    let cells = if matches!(outcome, Ok(None)) { vec!["undefined".into()] } else { cells };
    let value = outcome.map(|wire| wire.as_ref().and_then(|wire| table.value(wire)));
    Item { cells, ..Item::with(S::WORDS.nouns[0], name, more, value) }.labelled(label)
}

/// Columns of the table output.
fn columns<S: Store>(table: &S) -> Columns {
    Columns { name: S::WORDS.nouns[0], values: table.headings(), empty: "nothing stored" }
}

/// Columns of a file: the row, its fields, and its user-defined name.
fn sheet<S: Store>(table: &S) -> Vec<Column> {
    let column = |field: Field| {
        let name = field.name.into_owned();
        if field.is_number { Column::number(name) } else { Column::text(name) }
    };
    std::iter::once(Column::text("name")).chain(table.fields().into_iter().map(column)).collect()
}

/// Content of a row in one line, such as `250.0 mm/s`, or `limit=2.50 load=1.00`.
fn line<S: Store>(table: &S, wire: &S::Wire) -> String {
    let (fields, texts) = (table.fields(), table.texts(wire));
    if let ([field], [text]) = (&fields[..], &texts[..]) {
        let unit = field.heading.split_once('(').and_then(|(_, unit)| unit.strip_suffix(')'));
        return unit.map_or_else(|| text.clone(), |unit| format!("{text} {unit}"));
    }
    let pairs = fields.iter().zip(&texts).map(|(field, text)| format!("{}={text}", field.name));
    pairs.collect::<Vec<_>>().join(" ")
}

/// Differences between two rows, in one line for each row.
pub fn difference<S: Store>(table: &S, old: &S::Wire, new: &S::Wire) -> [String; 2] {
    let (fields, old_texts, new_texts) = (table.fields(), table.texts(old), table.texts(new));
    if fields.len() < 2 || old_texts.len() != fields.len() {
        return [line(table, old), line(table, new)];
    }
    let differ = |texts: &[String]| {
        let rows = fields.iter().zip(texts).zip(old_texts.iter().zip(&new_texts));
        let rows = rows.filter(|(_, (old, new))| old != new);
        rows.map(|((field, text), _)| format!("{}={text}", field.name)).collect::<Vec<_>>().join(" ")
    };
    [differ(&old_texts), differ(&new_texts)]
}

/// Selects the table, reads rows, and selects the previous table again.
async fn read<S: Store>(
    table: &mut S,
    link: &mut LinkOf<S>,
    screen: &Screen,
    keys: &[S::Key],
) -> Result<Answers<S::Wire>> {
    table.select(link).await?;
    let read = table.read(link, screen, keys).await;
    table.deselect(link, read).await
}

/// Parses the rows that the user typed: keys or user-defined names.
fn read_keys<S: Store>(text: &str) -> Result<Vec<S::Key>, String> {
    let Some(kind) = S::LABELS else { return S::keys(text) };
    labels::parse_or_name(&[kind], &S::any(), text, S::keys)
}

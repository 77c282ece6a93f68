//! `toyo param`: parameters.

mod machine;

pub use machine::{POWER_CYCLE, consequence_of};

use std::hash::{Hash, Hasher};

use super::eeprom::{Cell, parameter_cell, parameter_sketch};
use super::eeprom_tables::{EepromRow, Listed, unlisted};
use super::field_values::{self, NamedValue};
use super::item_reads::{Answers as Records, read_each_with_retry};
use super::number_arguments::Numbers;
use crate::prelude::*;
use armctl_controller::toyo::layout::Layout;
use armctl_controller::toyo::table::Group;
use armctl_controller::toyo::table::parameters::PARAMETERS;
use armctl_frame::output::view;
use armctl_frame::store::{Dump, Get, List, Restore, Set};

commands! {
    /// Commands for parameters.
    pub enum Param {
        /// Read parameters by name, id or group, for example soft-limit-plus, P01 or axis
        Get(Get<Parameters>),
        /// Read all parameters, or a group of them
        List(List<Parameters>),
        /// Print each change of parameters
        Watch(Watch<Get<Parameters>>),
        /// Change a parameter, for example `soft-limit-plus 100 200 0 0`
        Set(Set<Parameters>),
        /// Save all parameters and tables to a CSV file
        Dump(Dump<Parameters>),
        /// Write parameters and tables from a CSV file
        Restore(Restore<Parameters>),
    }
}

/// The table of all parameters. A parameter that is itself a table is present with its rows.
#[derive(Debug)]
pub struct Parameters;

/// A parameter, or a row of a parameter that is a table.
#[derive(Debug, Clone, Copy)]
pub struct Key {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// Row, for a parameter that is a table.
    pub row: Option<i32>,
}

impl PartialEq for Key {
    fn eq(&self, other: &Self) -> bool {
        (self.parameter.id, self.row) == (other.parameter.id, other.row)
    }
}

impl Eq for Key {}

impl Hash for Key {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.parameter.id, self.row).hash(state);
    }
}

impl Key {
    const fn single(parameter: &'static Parameter) -> Self {
        Self { parameter, row: None }
    }
}

/// Fields that toyo adds to a parameter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct About {
    /// Id of the parameter, such as `P01`.
    pub id: &'static str,
    /// Group of the parameter: `mode`, `axis`, `machine`, `special` or `table`.
    pub group: &'static str,
    /// Description of the content.
    pub about: &'static str,
    /// Controllers that have the parameter; empty for all controllers.
    pub only_on: &'static [&'static str],
    #[serde(flatten)]
    listed: Listed,
}

/// Groups in the order of the writes. After a machine parameter, a controller may refuse all other parameters, so the
/// machine group is last.
const GROUPS: [Group; 5] = [Group::Mode, Group::Axis, Group::Table, Group::Special, Group::Machine];

/// The table of points. It has its own commands (`point`).
const POINTS: &str = "T1";

/// Rows of all tables except the points.
fn rows() -> impl Iterator<Item = Key> {
    let tables = PARAMETERS.iter().filter(|parameter| parameter.id != POINTS);
    tables.filter_map(|table| Some((table, table.row()?))).flat_map(|(table, field)| {
        Numbers::of(&[], field).into_iter().map(move |row| Key { parameter: table, row: Some(row) })
    })
}

/// Whether a parameter describes the machine itself (E), or is not for normal use (U).
pub fn is_machine(key: Key) -> bool {
    matches!(key.parameter.group(), Group::Machine | Group::Special)
}

/// Returns the parameters that are not tables.
fn singles() -> impl Iterator<Item = &'static Parameter> {
    PARAMETERS.iter().filter(|parameter| parameter.row().is_none())
}

/// Parses the name or id of a parameter, a row of a table such as `T2.5`, or a group.
fn parse(name: &str) -> Result<Vec<Key>, String> {
    if let Some(group) = GROUPS.iter().find(|group| group.name().eq_ignore_ascii_case(name)) {
        if *group == Group::Table {
            return Ok(rows().collect());
        }
        return Ok(singles().filter(|parameter| parameter.group() == *group).map(Key::single).collect());
    }
    if let Some(row) = rows().find(|row| key_text(*row).eq_ignore_ascii_case(name)) {
        return Ok(vec![row]);
    }
    match Parameter::named(name) {
        Some(parameter) if parameter.row().is_some() => {
            Err(format!("{} is a table; use `toyo {} get` to read its rows", parameter.name, command_of(parameter)))
        }
        Some(parameter) => Ok(vec![Key::single(parameter)]),
        None => {
            let known = singles().flat_map(|parameter| [parameter.name, parameter.id]);
            let known = known.chain(GROUPS.iter().map(|group| group.name()));
            let near = nearest(name, known).map_or(String::new(), |near| format!("; did you mean {near}?"));
            Err(format!("unknown parameter{near}"))
        }
    }
}

/// Text for a key: `P01`, or `T2.5` for a row.
pub fn key_text(Key { parameter, row }: Key) -> String {
    match row {
        Some(row) => format!("{}.{row}", parameter.id),
        None => parameter.id.to_owned(),
    }
}

/// Values of a parameter, without the number of a row.
fn values_of(record: &Record) -> Vec<NamedValue> {
    let table = PARAMETERS.iter().find(|parameter| parameter.row().is_some() && parameter.layout == record.layout());
    let body = table.and_then(|table| {
        let values = record.values()[table.key.fields.len()..].to_vec();
        table.body().record(values).ok()
    });
    field_values::named_values(body.as_ref().unwrap_or(record))
}

/// Returns the name of the command that reads the rows of a table.
fn command_of(table: &Parameter) -> &'static str {
    match &table.id[..2] {
        "T1" => "point",
        "T2" => "speed-table",
        "T3" => "accel-table",
        "T4" => "mvm",
        _ => "torque-table",
    }
}

/// Reads parameters and rows. Each has its own result. A refused read is repeated once, because a busy controller also
/// refuses.
pub async fn read(link: &mut Link, screen: &Screen, keys: &[Key]) -> Result<Records> {
    let request = |key: &Key| Request::read_parameter(key.parameter, key.row);
    let requests = keys.iter().map(request).collect::<Result<Vec<Request>, _>>().map_err(|error| wrong(&error))?;
    let rare = |key: &Key, failure: Failure| match &failure.hint {
        Some(hint) if failure.kind == Kind::Refused && !key.parameter.only_on.is_empty() => {
            let (id, models) = (key.parameter.id, key.parameter.only_on.join(", "));
            let hint = format!("check the model, because only these controllers have {id}: {models}; {hint}");
            failure.hint(hint)
        }
        _ => failure,
    };
    let answers = read_each_with_retry(link, screen, "reading parameters", &requests).await;
    match (answers, keys) {
        (Ok(answers), _) => {
            Ok(keys.iter().zip(answers).map(|(key, answer)| answer.map_err(|failure| rare(key, failure))).collect())
        }
        (Err(failure), [key, ..]) => Err(rare(key, failure)),
        (Err(failure), []) => Err(failure),
    }
}

impl Store for Parameters {
    type Family = Toyo;
    type Key = Key;
    type Wire = Record;
    type Value = Vec<NamedValue>;
    type More = About;
    type Options = Single;

    const WORDS: TableWords = TableWords {
        nouns: ["parameter", "parameters"],
        placeholder: "NAME",
        range: "Names or ids, such as soft-limit-plus or P01, or a group: mode, axis, table, machine, special",
        reading: Some(
            "`param list` shows the names of the parameters of this controller. In JSON, each parameter has the unit, \
             the protocol text and the meaning of its value.",
        ),
        writing: Some(
            "Type all values in order, or only some values by name; the other values do not \
             change. For example: `param set soft-limit-plus 100 200 0 0`, `param set P01 ax2=150`. A value is the \
             word of the protocol or its meaning: `param set pendant-language english`. A bit of a port is STATION/PORT/BIT: 0/01/3.\n\narmctl does not write equal \
             values, because an EEPROM cell wears out after about a million writes. After a change of machine \
             parameters (E), the controller executes no command until a restart.",
        ),
    };
    const IDS: Ids = ids!("toyo.param");
    const COMPLETE: ValueKind = complete::PARAMETER;
    const NOT_RESTORED: &'static str = "to write machine and special parameters, type their groups, such as `param \
                                        restore FILE machine special`";

    fn keys(text: &str) -> Result<Vec<Key>, String> {
        parse(text)
    }

    fn all() -> Vec<Key> {
        singles().map(Key::single).collect()
    }

    fn saved() -> Vec<Key> {
        let mut keys: Vec<Key> = singles().map(Key::single).chain(rows()).collect();
        keys.sort_by_key(|key| Self::rank(*key));
        keys
    }

    fn name(key: Key) -> String {
        if key.row.is_some() { key_text(key) } else { key.parameter.name.to_owned() }
    }

    fn asked(key: Key) -> String {
        if key.row.is_some() { key_text(key) } else { format!("{} ({})", key.parameter.id, key.parameter.name) }
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self)
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::text("value", "value")]
    }

    fn texts(&self, record: &Record) -> Vec<String> {
        vec![field_values::as_typed(&values_of(record))]
    }

    fn headings(&self) -> Vec<&'static str> {
        vec!["id", "value"]
    }

    fn cells(&self, key: Key, record: &Record) -> Vec<view::Cell> {
        let body = values_of(record);
        vec![view::Cell::from(key.parameter.id).whole(), field_values::in_a_line(&body).into()]
    }

    fn difference(&self, old: &Record, new: &Record) -> [String; 2] {
        field_values::difference(old, new, &Letters::USUAL)
    }

    fn value(&self, record: &Record) -> Option<Vec<NamedValue>> {
        Some(values_of(record))
    }

    fn more(&self, key: Key, record: Option<&Record>) -> About {
        let Parameter { id, about, only_on, .. } = key.parameter;
        About { id, group: key.parameter.group().name(), about, only_on, listed: Listed::of(record) }
    }

    fn is_undefined(failure: &Failure) -> bool {
        failure.kind == Kind::Refused
    }

    fn unsaved(&self, key: Key, record: Option<&Record>) -> Option<String> {
        let Some(record) = record else { return Some("the controller refused to report the parameter".to_owned()) };
        let values = &record.values()[key.parameter.key.fields.len()..];
        let unwritable = || {
            let error = self.cell(key, values.to_vec()).err()?;
            let value = field_values::in_a_line(&values_of(record));
            Some(format!("the value {value} cannot be written back: {}", error.message))
        };
        unlisted(Some(record)).or_else(unwritable)
    }

    fn is_restored(key: Key) -> bool {
        !is_machine(key)
    }

    fn is_absent(key: Key) -> bool {
        !key.parameter.only_on.is_empty()
    }

    fn consequences(&self, rows: &[RowDifference<'_, Self>]) -> Vec<String> {
        let is_machine = |key: &Key| key.parameter.group() == Group::Machine;
        let changed: Vec<&Parameter> =
            rows.iter().filter(|(key, ..)| is_machine(key)).map(|(key, ..)| key.parameter).collect();
        let machine = (!changed.is_empty()).then(|| consequence_of(&changed));
        let warnings = rows.iter().flat_map(|(key, old, new)| machine::warnings(key.parameter, *old, new.values()));
        warnings.chain(machine).collect()
    }

    fn follow_up_note(&self, written: &[Key]) -> Option<String> {
        written.iter().any(|key| key.parameter.group() == Group::Machine).then(|| POWER_CYCLE.to_owned())
    }

    async fn read(&self, link: &mut Link, screen: &Screen, keys: &[Key]) -> Result<Answers<Record>> {
        Ok(Answers::of(read(link, screen, keys).await?))
    }
}

impl EepromRow for Parameters {
    const IS_MIXED: bool = true;

    fn rank(key: Key) -> usize {
        GROUPS.iter().position(|group| *group == key.parameter.group()).unwrap_or_default()
    }

    fn body(&self, key: Key) -> Layout {
        key.parameter.body()
    }

    fn request(&self, key: Key) -> Result<Request> {
        Request::read_parameter(key.parameter, key.row).map_err(|error| wrong(&error))
    }

    fn cell(&self, key: Key, values: Vec<Value>) -> Result<Cell> {
        let values = key.row.map(Value::Number).into_iter().chain(values).collect();
        parameter_cell(key.parameter, values).map_err(|error| {
            Failure::usage(format!("{}: {error}", key.parameter.name))
                .hint("type all values; the stored value cannot be written back")
        })
    }

    fn sketch(&self, key: Key, values: &[Option<Value>]) -> String {
        parameter_sketch(key.parameter, key.row, values)
    }

    fn check(&self, key: Key, values: &[Value]) -> Result<()> {
        machine::check(key.parameter, values)
    }
}

#[cfg(test)]
mod tests;

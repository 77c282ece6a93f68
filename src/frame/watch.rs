//! `io watch`, `var watch`, `alarm watch` and so on: the initial values of a read command, and then each change.

use std::cell::RefCell;
use std::marker::PhantomData;

use jiff::Timestamp;
use jiff::tz::TimeZone;
use schemars::{Schema, SchemaGenerator};
use serde_json::Map;

use super::command::{Command, Context};
use super::connection::{ConnectMode, Family};
use super::report::AnyReport as _;
use crate::prelude::basics::*;

/// Read interval for families without change notifications.
const POLL_INTERVAL: Duration = Duration::from_millis(100);

/// If there are more items than this, only the items that have a name or are on are printed at the start.
const MANY_ITEMS: usize = 24;

/// Field of the user name, and heading of its column.
const LABEL: &str = "label";
/// Heading of the errors of items.
const ERROR: &str = "error";
/// Field for the user-defined names of bits.
const LABEL_KEYS: &str = "labels";

/// Where the watched items are in the data of a read: the list and its fields.
#[derive(Debug, Clone, Copy)]
pub struct Watched {
    /// Name of the list, such as `signals`.
    pub list: &'static str,
    /// Field that identifies an item.
    pub name: &'static str,
    /// Text before the name, if the name is only a number: `alarm `.
    pub prefix: &'static str,
    /// Field for the description.
    pub label: &'static str,
    /// Field for the value; `None` if only the existence of the item matters. A list of bits is watched bit by bit.
    pub value: Option<&'static str>,
    /// Text that is printed at the start if there are no items.
    pub empty: &'static str,
}

impl Watched {
    /// Items as every family reports them.
    pub const ITEMS: Self =
        Self { list: "items", name: "name", prefix: "", label: "", value: Some("value"), empty: "nothing to watch" };
}

/// A read command whose changes can be watched.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Watchable: Command {
    /// Value of an item. The values of a list are watched one by one.
    type Value: Serialize + JsonSchema + 'static;
    /// Name of the watch command in envelopes and schemas, such as `yerc.io.watch`.
    const WATCH: &'static str;
    /// Where the watched items are in the data of the command.
    const WATCHED: Watched;

    /// Waits until a new read can give new values.
    async fn changed(&self, _link: &mut <Self::Family as Family>::Link) -> Result<()> {
        tokio::time::sleep(POLL_INTERVAL).await;
        Ok(())
    }
}

/// Prints the current values, then each change on its own line, until Ctrl-C. With --for, it ends after this time. With
/// --count, it ends after this number of reports.
#[derive(Debug, Args)]
pub struct Watch<C: Args> {
    #[command(flatten)]
    what: C,
    /// Time after which the watch ends
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
    /// Items of the read before the current read.
    #[arg(skip)]
    before: RefCell<Option<Vec<WatchedItem>>>,
}

impl<C: Watchable + Args> Command for Watch<C> {
    type Family = C::Family;
    type Report = Changes<C::Value>;
    const ID: &'static str = C::WATCH;
    const CONNECT_MODE: ConnectMode = C::CONNECT_MODE;

    fn is_endless(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, C::Family>) -> Result<Changes<C::Value>> {
        let Context { robot, link, screen, several, confirmer } = context;
        loop {
            if self.before.borrow().is_some() {
                self.what.changed(link).await?;
            }
            let confirmer = confirmer.clone();
            let report = self.what.run(Context { robot, link: &mut *link, screen, several, confirmer }).await?;
            let view = Report::view(&report);
            let now = C::WATCHED.watched_items(&report.data()?, view.as_table());
            let before = self.before.replace(Some(now.clone()));
            let is_first = before.is_none();
            let changes = match before {
                None => describe_start(&now),
                Some(before) => differences(&before, &now),
            };
            if is_first || !changes.is_empty() {
                let headings = view.as_table().map(value_headings).unwrap_or_default();
                return Ok(Changes { headings, is_first, ..Changes::new(C::WATCHED, changes) });
            }
        }
    }
}

/// A watched item.
#[derive(Debug, Clone, PartialEq)]
struct WatchedItem {
    name: String,
    label: Option<String>,
    value: Value,
    /// Item with all fields that were read.
    item: Value,
    /// Table cells of a value that consists of several values.
    cells: Vec<Cell>,
}

impl Watched {
    /// Items in the data of a read. `table` has one row for each item.
    fn watched_items(self, data: &Value, table: Option<&Table>) -> Vec<WatchedItem> {
        let items = data[self.list].as_array().map(Vec::as_slice).unwrap_or_default();
        let cells = |at: usize| table.map(|table| value_cells(table, at)).unwrap_or_default();
        items.iter().enumerate().flat_map(|(at, item)| self.items_of_list(item, || cells(at))).collect()
    }

    fn items_of_list(self, item: &Value, cells: impl Fn() -> Vec<Cell>) -> Vec<WatchedItem> {
        let name = format!("{}{}", self.prefix, plain(&item[self.name]));
        // The user-defined name is more informative than the description.
        let label = item[LABEL].as_str().or_else(|| item[self.label].as_str()).map(ToOwned::to_owned);
        let thing = |name: String, value: &Value| WatchedItem {
            name,
            label: label.clone(),
            value: value.clone(),
            item: item.clone(),
            cells: if value.is_object() { cells() } else { Vec::new() },
        };
        if let Some(message) = item["error"]["message"].as_str() {
            let name = if item[self.name].is_null() { plain(&item["error"]["asked"]) } else { name };
            return vec![WatchedItem { label: Some(message.to_owned()), ..thing(name, &Value::Null) }];
        }
        match self.value.map(|field| &item[field]) {
            None => vec![thing(name, &Value::Bool(true))],
            Some(Value::Array(values)) => {
                let named = |at: usize| item[LABEL_KEYS].get(at)?.as_str().map(ToOwned::to_owned);
                let things = values.iter().enumerate().map(|(at, value)| {
                    // The values of a parameter have names, the bits of a port have numbers.
                    let value = match (value["name"].as_str(), value.get("value")) {
                        (Some(part), Some(value)) => thing(format!("{name}.{part}"), value),
                        _ => thing(format!("{name}.{}", at + 1), value),
                    };
                    WatchedItem { label: named(at).or_else(|| value.label.clone()), ..value }
                });
                things.collect()
            }
            Some(value) => vec![thing(name, value)],
        }
    }
}

/// Places of the columns that have values.
fn value_columns(table: &Table) -> impl Iterator<Item = usize> {
    (1..table.columns.len()).filter(|at| ![LABEL, ERROR].contains(&table.columns[*at]))
}

fn value_headings(table: &Table) -> Vec<&'static str> {
    table.columns.first().copied().into_iter().chain(value_columns(table).map(|at| table.columns[at])).collect()
}

fn value_cells(table: &Table, row: usize) -> Vec<Cell> {
    let row = table.rows.get(row).map(Vec::as_slice).unwrap_or_default();
    value_columns(table).filter_map(|at| row.get(at).cloned()).collect()
}

/// Changes to print at the start: the current values.
fn describe_start<V>(now: &[WatchedItem]) -> Vec<Change<V>> {
    let is_off = |value: &Value| *value == false || *value == 0;
    let is_told = |thing: &&WatchedItem| now.len() <= MANY_ITEMS || thing.label.is_some() || !is_off(&thing.value);
    now.iter().filter(is_told).map(|thing| Change::new(thing, None, Some(thing))).collect()
}

/// Items that changed, were added, or were removed.
fn differences<V>(before: &[WatchedItem], now: &[WatchedItem]) -> Vec<Change<V>> {
    let find = |things: &[WatchedItem], name: &str| things.iter().find(|thing| thing.name == name).cloned();
    let changed = now.iter().filter_map(|thing| {
        let old = find(before, &thing.name);
        (old.as_ref().map(|old| &old.value) != Some(&thing.value))
            .then(|| Change::new(thing, old.as_ref(), Some(thing)))
    });
    let is_gone = before.iter().filter(|old| find(now, &old.name).is_none());
    changed.chain(is_gone.map(|old| Change::new(old, Some(old), None))).collect()
}

/// Changes at one time. The first report contains the current values.
#[derive(Debug, Serialize, JsonSchema)]
#[schemars(rename = "Changes", bound = "V: JsonSchema")]
pub struct Changes<V> {
    /// One entry for each item that changed.
    changes: Vec<Change<V>>,
    /// The same items with all fields of the read, under the name of their list.
    #[serde(flatten)]
    items: Map<String, Value>,
    #[serde(skip)]
    watched: Watched,
    /// Headings of the names and of the values.
    #[serde(skip)]
    headings: Vec<&'static str>,
    /// Whether the headings are printed.
    #[serde(skip)]
    is_first: bool,
}

/// Change of one item.
#[derive(Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "Change", bound = "V: JsonSchema")]
struct Change<V> {
    /// Time of the read.
    #[schemars(with = "String", extend("format" = "date-time"))]
    time: Timestamp,
    /// Name of the item, such as `#27010`, `B0`, `SO(02)`.
    name: String,
    /// User-defined name or description, if there is one.
    label: Option<String>,
    /// Old value; null at the start and for a new item.
    #[schemars(schema_with = "value_schema::<V>")]
    old: Value,
    /// New value; null for a removed item, and if the value could not be read.
    #[schemars(schema_with = "value_schema::<V>")]
    new: Value,
    #[serde(skip)]
    item: Option<Value>,
    /// Table cells of the old and the new value, if they consist of several values.
    #[serde(skip)]
    cells: [Vec<Cell>; 2],
    #[serde(skip)]
    of: PhantomData<V>,
}

fn value_schema<V: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let is_list = V::json_schema(generator).get("type").is_some_and(|name| name == "array");
    if is_list { true.into() } else { generator.subschema_for::<Option<V>>() }
}

/// Width of the times.
const TIME_WIDTH: usize = 23;
/// Smallest width of a column, so that later lines have the same columns.
const MIN_WIDTH: usize = 9;

impl<V> Change<V> {
    fn new(thing: &WatchedItem, old: Option<&WatchedItem>, new: Option<&WatchedItem>) -> Self {
        let value = |thing: Option<&WatchedItem>| thing.map_or(Value::Null, |thing| thing.value.clone());
        let cells = [old, new].map(|thing| thing.map(|thing| thing.cells.clone()).unwrap_or_default());
        Self {
            time: Timestamp::UNIX_EPOCH,
            name: thing.name.clone(),
            label: thing.label.clone(),
            old: value(old),
            new: value(new),
            item: new.map(|thing| thing.item.clone()),
            cells,
            of: PhantomData,
        }
    }

    fn line(&self, time: &str, headings: &[&str], is_presence: bool) -> String {
        let label = self.label.as_ref().map(|label| format!(" ({label})")).unwrap_or_default();
        let [old_cells, new_cells] = &self.cells;
        if new_cells.len() > 1 {
            let name = Cell::from(self.name.as_str());
            let cells = std::iter::once(&name).chain(new_cells).zip(headings);
            let cells: Vec<String> = cells.map(|(cell, heading)| padded(&cell.text, cell.is_number, heading)).collect();
            return format!("{time}  {}{label}", cells.join("  ")).trim_end().to_owned();
        }
        let text = |cells: &[Cell], value: &Value| cells.first().map_or_else(|| shown(value), |cell| cell.text.clone());
        let what = match (&self.old, &self.new) {
            (Value::Null, _) if is_presence => "present".to_owned(),
            (_, Value::Null) if is_presence => "gone".to_owned(),
            (Value::Null, new) => text(new_cells, new),
            (old, new) => format!("{} -> {}", text(old_cells, old), text(new_cells, new)),
        };
        format!("{time}  {}{label}  {what}", self.name)
    }
}

/// Text in a column below its heading.
fn padded(text: &str, is_number: bool, heading: &str) -> String {
    let width = heading.len().max(MIN_WIDTH);
    if is_number { format!("{text:>width$}") } else { format!("{text:width$}") }
}

/// Value as text.
fn shown(value: &Value) -> String {
    match value {
        Value::Null => "-".to_owned(),
        Value::Bool(on) => if *on { "on" } else { "off" }.to_owned(),
        value => plain(value),
    }
}

fn plain(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned)
}

impl<V> Changes<V> {
    fn new(watched: Watched, mut changes: Vec<Change<V>>) -> Self {
        let now = Timestamp::now();
        for change in &mut changes {
            change.time = now;
        }
        let mut items: Vec<Value> = changes.iter_mut().filter_map(|change| change.item.take()).collect();
        // Several bits of one port refer to the same item.
        items.dedup();
        let items = Map::from_iter([(watched.list.to_owned(), Value::Array(items))]);
        Self { changes, items, watched, headings: Vec::new(), is_first: false }
    }
}

impl<V> Changes<V> {
    /// Line above the first values, if they have columns.
    fn header(&self) -> Option<Cell> {
        let row = self.changes.iter().map(|change| &change.cells[1]).find(|cells| cells.len() > 1)?;
        let are_numbers = std::iter::once(false).chain(row.iter().map(|cell| cell.is_number));
        let columns = self.headings.iter().zip(are_numbers);
        let columns: Vec<String> =
            columns.map(|(heading, is_number)| padded(&heading.to_uppercase(), is_number, heading)).collect();
        self.is_first.then(|| format!("{:TIME_WIDTH$}  {}", "TIME", columns.join("  ").trim_end()).into())
    }
}

impl<V: Serialize + JsonSchema> Report for Changes<V> {
    const ROWS: RowsOf = RowsOf::List("changes");

    fn view(&self) -> View {
        if self.changes.is_empty() {
            return View::text(self.watched.empty);
        }
        let zone = TimeZone::system();
        let lines = self.changes.iter().map(|change| {
            let time = change.time.to_zoned(zone.clone()).strftime("%Y-%m-%d %H:%M:%S%.3f").to_string();
            Cell::from(change.line(&time, &self.headings, self.watched.value.is_none()))
        });
        View::default().append(Section::Lines(self.header().into_iter().chain(lines).collect()))
    }
}

#[cfg(test)]
mod tests {

    use super::*;
    use crate::report::sheet_of;

    const SIGNALS: Watched =
        Watched { list: "signals", name: "name", prefix: "", label: "class", value: Some("on"), empty: "no signals" };

    fn lines(changes: &[Change<bool>], is_presence: bool) -> Vec<String> {
        changes.iter().map(|change| change.line("T", &[], is_presence)).collect()
    }

    #[test]
    fn reports_a_change_with_old_and_new() {
        let data = |first: bool, second: bool| {
            SIGNALS.watched_items(
                &json!({"signals": [
                    {"name": "#27010", "class": "network input", "ok": true, "on": first},
                    {"name": "#27011", "class": "network input", "ok": true, "on": second},
                ]}),
                None,
            )
        };
        let (before, now) = (data(false, true), data(true, true));
        assert_eq!(
            lines(&describe_start(&before), false),
            ["T  #27010 (network input)  off", "T  #27011 (network input)  on"]
        );
        let changes = differences(&before, &now);
        assert_eq!(lines(&changes, false), ["T  #27010 (network input)  off -> on"]);
        assert_eq!(differences::<bool>(&now, &now), []);
        let data = serde_json::to_value(Changes::new(SIGNALS, changes)).unwrap();
        assert_eq!(
            (&data["changes"][0]["old"], &data["changes"][0]["new"], &data["signals"][0]["name"]),
            (&json!(false), &json!(true), &json!("#27010"))
        );
    }

    #[test]
    fn reports_appearing_and_disappearing_items() {
        let alarms = Watched { list: "alarms", name: "code", prefix: "alarm ", label: "name", value: None, ..SIGNALS };
        let one = alarms.watched_items(&json!({"alarms": [{"code": 4315, "name": "COLLISION"}]}), None);
        assert_eq!(lines(&differences(&[], &one), true), ["T  alarm 4315 (COLLISION)  present"]);
        assert_eq!(lines(&differences(&one, &[]), true), ["T  alarm 4315 (COLLISION)  gone"]);
    }

    #[test]
    fn watches_bits_separately_and_reports_failures() {
        let ports = Watched { list: "ports", value: Some("bits"), ..SIGNALS };
        let data = |bit: bool| ports.watched_items(&json!({"ports": [{"name": "PN01", "bits": [true, bit]}]}), None);
        assert_eq!(lines(&differences(&data(false), &data(true)), false), ["T  PN01.2  off -> on"]);
        let failed =
            SIGNALS.watched_items(&json!({"signals": [{"name": "#1", "error": {"message": "refused"}}]}), None);
        assert_eq!(lines(&describe_start(&failed), false), ["T  #1 (refused)  -"]);
    }

    #[test]
    fn starts_with_named_or_active_items_only() {
        let things = |count: u16| -> Vec<WatchedItem> {
            let thing = |number| WatchedItem {
                name: format!("B{number}"),
                label: None,
                value: u16::from(number == 3).into(),
                item: Value::Null,
                cells: Vec::new(),
            };
            (0..count).map(thing).collect()
        };
        assert_eq!(describe_start::<u16>(&things(24)).len(), 24);
        assert_eq!(describe_start::<u16>(&things(25)).len(), 1);
    }

    #[test]
    fn rows_with_several_values_are_columns() {
        #[derive(Serialize, JsonSchema)]
        struct Row {
            limit: f64,
            load: f64,
        }
        let read = |limit: f64| {
            let data = json!({"items": [{"name": "1", "label": "GRIP", "value": {"limit": limit, "load": 1.0}}]});
            let cells = ["1".into(), "GRIP".into(), Cell::number(format!("{limit:.2}")), Cell::number("1.00")];
            let mut table = Table::new(&["row", "label", "limit", "load"], "");
            table.row(cells);
            (Watched::ITEMS.watched_items(&data, Some(&table)), value_headings(&table))
        };
        let ((before, headings), (now, _)) = (read(2.5), read(30.0));
        let first =
            Changes::<Row> { headings, is_first: true, ..Changes::new(Watched::ITEMS, describe_start(&before)) };
        assert_eq!(first.header().unwrap().text, format!("{:23}  ROW            LIMIT       LOAD", "TIME"));
        let changes: Vec<Change<Row>> = differences(&before, &now);
        let line = changes[0].line("T", &first.headings, false);
        assert_eq!(line, "T  1              30.00       1.00 (GRIP)");
        let header = sheet_of::<Changes<Row>>().header(&[]);
        assert_eq!(header, "time,name,label,old_limit,old_load,new_limit,new_load\n");
    }

    #[test]
    fn named_values_are_watched_one_by_one() {
        let data =
            json!({"items": [{"name": "P01", "value": [{"name": "ax1", "value": 5}, {"name": "ax2", "value": 7}]}]});
        let now = Watched::ITEMS.watched_items(&data, None);
        assert_eq!(lines(&describe_start(&now), false), ["T  P01.ax1  5", "T  P01.ax2  7"]);
    }
}

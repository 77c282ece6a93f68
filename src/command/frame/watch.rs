//! `io watch`, `var watch`, `alarm watch` and the like: what a read command reads, and then each change of it as it comes.

use std::cell::RefCell;
use std::time::Duration;

use clap::Args;
use jiff::Timestamp;
use jiff::tz::TimeZone;
use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

use super::command::{Command, Context};
use super::connection::{ConnectMode, Family};
use super::report::{AnyReport as _, Report};
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Section, View};
use crate::settings::duration;

/// Pause between two looks, where nothing tells that something has changed.
const PAUSE: Duration = Duration::from_millis(100);

/// More things than these are told at the beginning only if they have a name of their own, or are on.
const MANY: usize = 24;

/// The field for what people call a thing.
const LABEL: &str = "label";
/// The same for the bits of one.
const LABELS: &str = "labels";

/// What is watched in the data of a read: a list, and of each thing in it which fields are what.
#[derive(Debug, Clone, Copy)]
pub struct Watched {
    /// `signals`.
    pub list: &'static str,
    /// The field that tells them apart.
    pub name: &'static str,
    /// Before the name, where that is a mere number: `alarm `.
    pub prefix: &'static str,
    /// The field that says what it is.
    pub label: &'static str,
    /// The field that changes; none where it is there or not. A list of bits is watched bit by bit.
    pub value: Option<&'static str>,
    /// Said at the beginning where there is nothing.
    pub empty: &'static str,
}

impl Watched {
    /// Items, as every family reports them.
    pub const ITEMS: Self =
        Self { list: "items", name: "name", prefix: "", label: "", value: Some("value"), empty: "nothing to watch" };
}

/// A read whose changes can be watched.
#[expect(async_fn_in_trait, reason = "everything runs on one thread")]
pub trait Watchable: Command {
    /// `yerc.io.watch`.
    const WATCH: &'static str;
    /// Where its data has what is watched.
    const WATCHED: Watched;

    /// Waits until it is worth to look again.
    async fn changed(&self, _link: &mut <Self::Family as Family>::Link) -> Result<(), Failure> {
        tokio::time::sleep(PAUSE).await;
        Ok(())
    }
}

/// Prints how things are, and then each change on a line, until Ctrl-C, --for, or --count reports.
#[derive(Debug, Args)]
pub struct Watch<C: Args> {
    #[command(flatten)]
    what: C,
    /// How long to go on
    #[arg(long = "for", value_name = "TIME", value_parser = duration::parse_some)]
    within: Option<Duration>,
    /// What was there last.
    #[arg(skip)]
    before: RefCell<Option<Vec<Thing>>>,
}

impl<C: Watchable + Args> Command for Watch<C> {
    type Family = C::Family;
    type Report = Changes;
    const ID: &'static str = C::WATCH;
    const CONNECT_MODE: ConnectMode = C::CONNECT_MODE;

    fn is_endless(&self) -> bool {
        true
    }

    async fn run(&self, context: Context<'_, C::Family>) -> Result<Changes, Failure> {
        let Context { robot, link, screen, several, authority } = context;
        loop {
            if self.before.borrow().is_some() {
                self.what.changed(link).await?;
            }
            let authority = authority.clone();
            let report = self.what.run(Context { robot, link: &mut *link, screen, several, authority }).await?;
            let now = C::WATCHED.things(&report.data()?);
            let before = self.before.replace(Some(now.clone()));
            let is_first = before.is_none();
            let changes = match before {
                None => began(&now),
                Some(before) => differences(&before, &now),
            };
            if is_first || !changes.is_empty() {
                return Ok(Changes::new(C::WATCHED, changes));
            }
        }
    }
}

/// One thing that is watched.
#[derive(Debug, Clone, PartialEq)]
struct Thing {
    name: String,
    label: Option<String>,
    value: Value,
    /// As the read tells it, with all its fields.
    item: Value,
}

impl Watched {
    fn things(self, data: &Value) -> Vec<Thing> {
        let items = data[self.list].as_array().map(Vec::as_slice).unwrap_or_default();
        items.iter().flat_map(|item| self.things_of(item)).collect()
    }

    fn things_of(self, item: &Value) -> Vec<Thing> {
        let name = format!("{}{}", self.prefix, plain(&item[self.name]));
        // What people call it says more than what it is.
        let label = item[LABEL].as_str().or_else(|| item[self.label].as_str()).map(ToOwned::to_owned);
        let thing = |name: String, value: &Value| Thing {
            name,
            label: label.clone(),
            value: value.clone(),
            item: item.clone(),
        };
        if let Some(message) = item["error"]["message"].as_str() {
            let name = if item[self.name].is_null() { plain(&item["error"]["asked"]) } else { name };
            return vec![Thing { label: Some(message.to_owned()), ..thing(name, &Value::Null) }];
        }
        match self.value.map(|field| &item[field]) {
            None => vec![thing(name, &Value::Bool(true))],
            Some(Value::Array(bits)) => {
                let named = |at: usize| item[LABELS].get(at)?.as_str().map(ToOwned::to_owned);
                let things = bits.iter().enumerate().map(|(at, bit)| {
                    let bit = thing(format!("{name}.{}", at + 1), bit);
                    Thing { label: named(at).or_else(|| bit.label.clone()), ..bit }
                });
                things.collect()
            }
            Some(value) => vec![thing(name, value)],
        }
    }
}

/// How things are at the beginning.
fn began(now: &[Thing]) -> Vec<Change> {
    let is_off = |value: &Value| *value == false || *value == 0;
    let is_told = |thing: &&Thing| now.len() <= MANY || thing.label.is_some() || !is_off(&thing.value);
    now.iter().filter(is_told).map(|thing| Change::new(thing, None, Some(thing))).collect()
}

/// What is not as it was, what is new, and what is gone.
fn differences(before: &[Thing], now: &[Thing]) -> Vec<Change> {
    let find = |things: &[Thing], name: &str| things.iter().find(|thing| thing.name == name).cloned();
    let changed = now.iter().filter_map(|thing| {
        let old = find(before, &thing.name);
        (old.as_ref().map(|old| &old.value) != Some(&thing.value))
            .then(|| Change::new(thing, old.as_ref(), Some(thing)))
    });
    let gone = before.iter().filter(|old| find(now, &old.name).is_none());
    changed.chain(gone.map(|old| Change::new(old, Some(old), None))).collect()
}

/// What changed at one moment; at first, how things are.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Changes {
    /// One for each thing that changed.
    changes: Vec<Change>,
    /// The same things with all that the read tells of them, under the name that it has for them.
    #[serde(flatten)]
    items: Map<String, Value>,
    #[serde(skip)]
    watched: Watched,
}

/// A change.
#[derive(Debug, PartialEq, Serialize, JsonSchema)]
struct Change {
    /// When it was seen.
    #[schemars(with = "String", extend("format" = "date-time"))]
    time: Timestamp,
    /// `#27010`, `B0`, `SO(02)`.
    name: String,
    /// What it is, where that is known.
    label: Option<String>,
    /// Null at the beginning, and of what was not there.
    old: Value,
    /// Null of what is gone, and of what could not be read.
    new: Value,
    #[serde(skip)]
    item: Option<Value>,
}

impl Change {
    fn new(thing: &Thing, old: Option<&Thing>, new: Option<&Thing>) -> Self {
        let value = |thing: Option<&Thing>| thing.map_or(Value::Null, |thing| thing.value.clone());
        let item = new.map(|thing| thing.item.clone());
        let time = Timestamp::UNIX_EPOCH;
        Self { time, name: thing.name.clone(), label: thing.label.clone(), old: value(old), new: value(new), item }
    }

    fn line(&self, time: &str, is_presence: bool) -> String {
        let label = self.label.as_ref().map(|label| format!(" ({label})")).unwrap_or_default();
        let what = match (&self.old, &self.new) {
            (Value::Null, _) if is_presence => "present".to_owned(),
            (_, Value::Null) if is_presence => "gone".to_owned(),
            (Value::Null, new) => shown(new),
            (old, new) => format!("{} -> {}", shown(old), shown(new)),
        };
        format!("{time}  {}{label}  {what}", self.name)
    }
}

/// A value as people read it.
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

impl Changes {
    fn new(watched: Watched, mut changes: Vec<Change>) -> Self {
        let now = Timestamp::now();
        for change in &mut changes {
            change.time = now;
        }
        let mut items: Vec<Value> = changes.iter_mut().filter_map(|change| change.item.take()).collect();
        // Bits of one port come with the same port.
        items.dedup();
        let items = Map::from_iter([(watched.list.to_owned(), Value::Array(items))]);
        Self { changes, items, watched }
    }
}

impl Report for Changes {
    fn view(&self) -> View {
        if self.changes.is_empty() {
            return View::text(self.watched.empty);
        }
        let zone = TimeZone::system();
        let lines = self.changes.iter().map(|change| {
            let time = change.time.to_zoned(zone.clone()).strftime("%Y-%m-%d %H:%M:%S%.3f").to_string();
            Cell::from(change.line(&time, self.watched.value.is_none()))
        });
        View::default().and(Section::Lines(lines.collect()))
    }

    fn rows(&self) -> RowsOf {
        RowsOf::List("changes")
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    const SIGNALS: Watched =
        Watched { list: "signals", name: "name", prefix: "", label: "class", value: Some("on"), empty: "no signals" };

    fn lines(changes: &[Change], is_presence: bool) -> Vec<String> {
        changes.iter().map(|change| change.line("T", is_presence)).collect()
    }

    #[test]
    fn a_change_is_told_with_old_and_new() {
        let data = |first: bool, second: bool| {
            SIGNALS.things(&json!({"signals": [
                {"name": "#27010", "class": "network input", "ok": true, "on": first},
                {"name": "#27011", "class": "network input", "ok": true, "on": second},
            ]}))
        };
        let (before, now) = (data(false, true), data(true, true));
        assert_eq!(lines(&began(&before), false), ["T  #27010 (network input)  off", "T  #27011 (network input)  on"]);
        let changes = differences(&before, &now);
        assert_eq!(lines(&changes, false), ["T  #27010 (network input)  off -> on"]);
        assert_eq!(differences(&now, &now), []);
        let data = serde_json::to_value(Changes::new(SIGNALS, changes)).unwrap();
        assert_eq!(
            (&data["changes"][0]["old"], &data["changes"][0]["new"], &data["signals"][0]["name"]),
            (&json!(false), &json!(true), &json!("#27010"))
        );
    }

    #[test]
    fn what_is_there_or_not_comes_and_goes() {
        let alarms = Watched { list: "alarms", name: "code", prefix: "alarm ", label: "name", value: None, ..SIGNALS };
        let one = alarms.things(&json!({"alarms": [{"code": 4315, "name": "COLLISION"}]}));
        assert_eq!(lines(&differences(&[], &one), true), ["T  alarm 4315 (COLLISION)  present"]);
        assert_eq!(lines(&differences(&one, &[]), true), ["T  alarm 4315 (COLLISION)  gone"]);
    }

    #[test]
    fn bits_are_watched_one_by_one_and_what_fails_says_why() {
        let ports = Watched { list: "ports", value: Some("bits"), ..SIGNALS };
        let data = |bit: bool| ports.things(&json!({"ports": [{"name": "PN01", "bits": [true, bit]}]}));
        assert_eq!(lines(&differences(&data(false), &data(true)), false), ["T  PN01.2  off -> on"]);
        let failed = SIGNALS.things(&json!({"signals": [{"name": "#1", "error": {"message": "refused"}}]}));
        assert_eq!(lines(&began(&failed), false), ["T  #1 (refused)  -"]);
    }

    #[test]
    fn of_many_only_what_is_named_or_on_is_told_at_first() {
        let things = |count: u16| -> Vec<Thing> {
            let thing = |number| Thing {
                name: format!("B{number}"),
                label: None,
                value: u16::from(number == 3).into(),
                item: Value::Null,
            };
            (0..count).map(thing).collect()
        };
        assert_eq!(began(&things(24)).len(), 24);
        assert_eq!(began(&things(25)).len(), 1);
    }
}

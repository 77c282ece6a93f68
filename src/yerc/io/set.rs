//! `yerc io set`.

use std::str::FromStr;

use super::super::batch_split::{BatchSplit, read_in_batches};
use super::{group_item, item, signal};
use crate::prelude::*;
use armctl_controller::yerc::query::Query as _;
use armctl_controller::yerc::signal::Signal;
use armctl_controller::yerc::variables::{WriteIoStep, parse_numbers, plan_io_reads, plan_io_writes};
use armctl_frame::robot::io::{IoItem, IoValue, WrittenSignal, WrittenSignals};
use armctl_frame::robot::item::Plain;
use armctl_frame::settings_report::{IF_DIFFERENT, OLD_VALUE};
use armctl_frame::store::{ComparedRow, Row, write_rows};

/// Switches network inputs.
#[derive(Debug, Args)]
#[command(
    after_help = "A PC can write only network inputs: #27010 to #29567 on a DX200, #25010 to #26287 on an FS100. The \
                  protocol writes eight signals at a time. armctl reads the group, changes the signals that you type, \
                  and writes the other signals back unchanged. If another signal of the group changes between the \
                  read and the write, that change is lost. --group writes all eight signals without a read."
)]
pub struct Set {
    /// Signals with their new states, for example 27010=on or #27011=off, or clamp=on for a name
    #[arg(required_unless_present = "groups", value_name = "NUMBER=on|off", add = complete::SIGNAL_STATE)]
    signals: Vec<Switch>,
    /// Groups of eight signals with their new values, such as 2701=0xA5. The first signal is the lowest bit
    /// (repeatable)
    #[arg(long = "group", value_name = "GROUP=VALUE")]
    groups: Vec<GroupValue>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Switch {
    signal: Signal,
    on: bool,
}

impl FromStr for Switch {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (signal, state) = user_input::split_setting(text, "a signal", "a state", "27010=on")?;
        let on = user_input::state(state)?;
        Ok(Self { signal: signal::parse_single(signal)?, on })
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct GroupValue {
    group: u16,
    value: u8,
}

impl FromStr for GroupValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (group, value) = user_input::split_setting(text, "a group", "a value", "2701=0xA5")?;
        let group = user_input::unsigned(group)
            .ok_or_else(|| format!("'{group}' is not a valid group; #27010 to #27017 are group 2701"))?;
        let value = user_input::unsigned(value)
            .ok_or_else(|| format!("'{value}' is not a number from 0 to 255 (0x00 to 0xFF)"))?;
        Ok(Self { group, value })
    }
}

/// Change of a group. Bits in the mask get the bits of the value; the other bits stay unchanged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
struct Change {
    mask: u8,
    value: u8,
}

impl Change {
    const fn apply(self, byte: u8) -> u8 {
        byte & !self.mask | self.value & self.mask
    }
}

impl Command for Set {
    type Family = Yerc;
    type Report = WrittenSignals;
    const ID: &'static str = "yerc.io.set";
    const RISK: Risk = Risk::Write;

    async fn run(&self, context: Context<'_, Yerc>) -> Result<WrittenSignals> {
        let Context { link, screen, robot, confirmer, .. } = context;
        let names = names::of_robot(robot, screen);
        let changes: Vec<Row<Groups>> = self.changes()?.into_iter().collect();
        let groups: Vec<u16> = changes.iter().map(|(group, _)| *group).collect();
        let model = link.model_for(|model| signal::is_readable(model, &groups, true)).await?;
        signal::is_readable(model, &groups, true)?;
        let rows = write_rows(&Groups { model }, link, screen, confirmer, changes).await?;
        let row = |group: u16| rows.iter().find(move |row| row.key == group);
        let signals = self.signals.iter().filter_map(|Switch { signal, .. }| {
            let row = row(signal.group())?;
            Some(item(model, *signal, names).map(|item| written(item, row, |byte| IoValue::State(signal.is_on(byte)))))
        });
        let groups = self.groups.iter().filter_map(|GroupValue { group, .. }| {
            let row = row(*group)?;
            Some(group_item(model, *group).map(|item| written(item, row, |byte| IoValue::Number(byte.into()))))
        });
        WrittenSignals::new(signals.chain(groups).collect::<Result<_>>()?).unless_all_failed()
    }
}

fn written(item: IoItem, row: &ComparedRow<Groups>, value: impl Fn(u8) -> IoValue) -> WrittenSignal {
    WrittenSignal::with_outcome(item, row.old.map(&value), value(row.new), row.outcome.clone())
}

impl Set {
    /// Change of each group. It is an error if a signal occurs twice.
    fn changes(&self) -> Result<BTreeMap<u16, Change>> {
        let mut changes: BTreeMap<u16, Change> = BTreeMap::new();
        let wholes = self.groups.iter().map(|whole| (whole.group, Change { mask: u8::MAX, value: whole.value }));
        let switches = self.signals.iter().map(|Switch { signal, on }| {
            (signal.group(), Change { mask: 1 << signal.bit(), value: u8::from(*on) << signal.bit() })
        });
        for (group, change) in wholes.chain(switches) {
            let known = changes.entry(group).or_default();
            if known.mask & change.mask != 0 {
                let bit = u8::try_from((known.mask & change.mask).trailing_zeros()).unwrap_or_default();
                return Err(Failure::usage(format!("{} appears twice", signal::name(group, bit)))
                    .hint("type one state for each signal"));
            }
            *known = Change { mask: known.mask | change.mask, value: known.value | change.value };
        }
        Ok(changes)
    }
}

/// The groups of eight signals as a table.
#[derive(Debug)]
struct Groups {
    model: Model,
}

impl Store for Groups {
    type Family = Yerc;
    type Key = u16;
    type Wire = u8;
    type Value = u8;
    type More = Plain;
    type Options = Single;

    const WORDS: TableWords =
        TableWords { nouns: ["group", "groups"], placeholder: "GROUP", range: "", reading: None, writing: None };
    const IDS: Ids = ids!("yerc.io");

    fn keys(text: &str) -> Result<Vec<u16>, String> {
        parse_numbers(text).map_err(|error| error.to_string())
    }

    fn name(group: u16) -> String {
        group.to_string()
    }

    async fn open(_link: &mut Link, _options: &Single) -> Result<Self> {
        Ok(Self { model: Model::Dx200 })
    }

    fn fields(&self) -> Vec<Field> {
        vec![Field::number("value", "value")]
    }

    fn texts(&self, byte: &u8) -> Vec<String> {
        vec![byte.to_string()]
    }

    fn value(&self, byte: &u8) -> Option<u8> {
        Some(*byte)
    }

    fn more(&self, _group: u16, _byte: Option<&u8>) -> Plain {
        Plain {}
    }

    async fn read(&self, link: &mut Link, _screen: &Screen, groups: &[u16]) -> Result<Answers<u8>> {
        let plan = |groups: &[u16]| plan_io_reads(self.model, groups).map_err(usage);
        let answers = read_in_batches(link, plan, groups, |_| BatchSplit::Halves, |_, _| {}).await?;
        let row = |group: &u16| match answers.get(group) {
            Some(outcome) => outcome.clone().map_err(read_failure),
            None => Err(Failure::new(Kind::Malformed, "the answer does not have this group")),
        };
        Ok(Answers::of(groups.iter().map(row).collect()))
    }
}

impl Writable for Groups {
    type Draft = Change;

    const RISK: Risk = Risk::Write;

    fn draft(&self, group: u16, _texts: &[Option<&str>]) -> Result<Change, String> {
        Err(format!("group {group}: signals are not in files"))
    }

    fn complete_draft(&self, group: u16, change: &Change, old: Option<&u8>) -> Result<u8> {
        match old {
            Some(byte) => Ok(change.apply(*byte)),
            None if change.mask == u8::MAX => Ok(change.value),
            None => {
                let failure = Failure::usage(format!("group {group}: the other signals are unknown"));
                Err(failure.hint("repeat the command; armctl reads the group before it writes one of its signals"))
            }
        }
    }

    async fn read_old(&self, link: &mut Link, screen: &Screen, rows: &[Row<Self>]) -> Result<Answers<u8>> {
        let groups: Vec<u16> = rows.iter().map(|(group, _)| *group).collect();
        self.read(link.for_purpose(OLD_VALUE), screen, &groups).await
    }

    /// Consecutive groups are written with one request.
    fn blocks(&self, rows: &[RowDifference<'_, Self>]) -> Vec<Vec<usize>> {
        let index_of = |group: &u16| rows.iter().position(|(key, ..)| key == group);
        match self.steps(rows.iter().map(|(group, _, new)| (*group, **new))) {
            Ok(steps) => steps.iter().map(|step| step.written().iter().filter_map(index_of).collect()).collect(),
            Err(_) => (0..rows.len()).map(|index| vec![index]).collect(),
        }
    }

    async fn plan(&self, link: &mut Link, rows: &[Row<Self>]) -> Result<()> {
        let steps = |old: u8| self.steps(rows.iter().map(|(group, change)| (*group, change.apply(old))));
        for (one, other) in steps(0)?.iter().zip(steps(u8::MAX)?) {
            let groups = user_input::format_ranges(one.written(), "..");
            let (one, other) = (one.request(), other.request());
            let (about, depends_on) = if one == other {
                (format!("writes group {groups}"), IF_DIFFERENT)
            } else {
                let about = format!("writes group {groups}; the other signals keep the values that were read");
                (about, "the signals that were read")
            };
            link.plan_depending(&one, &other, Reason::about(&about).depending_on(depends_on));
        }
        Ok(())
    }

    async fn write(&self, link: &mut Link, _screen: &Screen, rows: &[RowDifference<'_, Self>]) -> Result<()> {
        for step in self.steps(rows.iter().map(|(group, _, new)| (*group, **new)))? {
            link.ask(&step).await?;
        }
        Ok(())
    }
}

impl Groups {
    fn steps(&self, values: impl Iterator<Item = (u16, u8)>) -> Result<Vec<WriteIoStep>> {
        plan_io_writes(self.model, &values.collect::<Vec<_>>()).map_err(usage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(signals: &[&str], groups: &[&str]) -> Result<BTreeMap<u16, Change>> {
        Set {
            signals: signals.iter().map(|text| text.parse().unwrap()).collect(),
            groups: groups.iter().map(|text| text.parse().unwrap()).collect(),
        }
        .changes()
    }

    #[test]
    fn combines_signals_of_a_group_and_keeps_the_others() {
        let changes = set(&["27010=on", "#27017=off", "27020=1"], &["2703=0xA5"]).unwrap();
        assert_eq!(changes[&2701], Change { mask: 0x81, value: 0x01 });
        assert_eq!(changes[&2701].apply(0xF0), 0x71);
        assert_eq!(changes[&2703].apply(0xFF), 0xA5);
    }

    #[test]
    fn rejects_repeated_signals() {
        assert_eq!(set(&["27013=on", "27013=off"], &[]).unwrap_err().message, "#27013 appears twice");
        assert!(set(&["27013=on"], &["2701=0"]).is_err());
        assert!("27018=on".parse::<Switch>().is_err());
        assert!("27010=yes".parse::<Switch>().unwrap_err().contains("on or off"));
        assert!("2701=256".parse::<GroupValue>().unwrap_err().contains("0 to 255"));
    }
}

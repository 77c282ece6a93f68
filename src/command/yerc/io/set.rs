//! `yerc io set`.

use std::collections::BTreeMap;
use std::str::FromStr;

use clap::Args;

use super::super::batch_split::{BatchSplit, plan_in_batches, read_in_batches};
use super::super::switch_commands::usage;
use super::super::write_all::{WriteOrder, old_value, write_all};
use super::{group_item, item, signal};
use crate::command::frame::dry_run::{Reason, unknown};
use crate::command::frame::names;
use crate::command::robot::io::{IoValue, WrittenSignal, WrittenSignals};
use crate::command::yerc::complete;
use crate::command::yerc::link::Link;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::typed;
use crate::controller::yerc::Model;
use crate::controller::yerc::query::Query as _;
use crate::controller::yerc::signal::Signal;
use crate::controller::yerc::variables::{WriteIoStep, plan_io_reads, plan_io_writes};
use crate::failure::Failure;

/// Switches network inputs.
#[derive(Debug, Args)]
#[command(
    after_help = "A PC can write only network inputs: #27010 to #29567 on a DX200, #25010 to #26287 on an FS100. The \
                  protocol writes eight signals at a time. armctl reads the group, changes the signals that you type, \
                  and writes the other signals back unchanged. If another signal of the group changes between the \
                  read and the write, that change is lost. --group writes all eight signals without a read."
)]
pub struct Set {
    /// 27010=on, #27011=off, or clamp=on for a name
    #[arg(required_unless_present = "groups", value_name = "NUMBER=on|off", add = complete::SIGNAL_STATE)]
    signals: Vec<Switch>,
    /// Eight signals of a group, such as 2701=0xA5; the first signal is the lowest bit (repeatable)
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
        let (signal, state) = typed::setting(text, "a signal", "a state", "27010=on")?;
        let on = typed::state(state)?;
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
        let (group, value) = typed::setting(text, "a group", "a value", "2701=0xA5")?;
        let group = typed::unsigned(group)
            .ok_or_else(|| format!("'{group}' is not a valid group; #27010 to #27017 are group 2701"))?;
        let value =
            typed::unsigned(value).ok_or_else(|| format!("'{value}' is not a number from 0 to 255 (0x00 to 0xFF)"))?;
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

    async fn run(&self, context: Context<'_, Yerc>) -> Result<WrittenSignals, Failure> {
        let Context { link, screen, robot, .. } = context;
        let names = names::of_robot(robot, screen);
        let changes = self.changes()?;
        let groups: Vec<u16> = changes.keys().copied().collect();
        let model = link.model_for(|model| signal::is_readable(model, &groups, true)).await?;
        signal::is_readable(model, &groups, true)?;
        let (whole, partial): (Vec<u16>, Vec<u16>) =
            changes.keys().partition(|group| changes.get(group).is_some_and(|change| change.mask == u8::MAX));
        let mut found = old_value(link, &plan_io_reads(model, &whole).map_err(usage)?).await?;
        if link.is_dry() && !partial.is_empty() {
            return Err(plan(link, model, &partial, &changes)?);
        }
        let plan = |groups: &[u16]| plan_io_reads(model, groups).map_err(usage);
        for (group, outcome) in read_in_batches(link, plan, &partial, |_| BatchSplit::Halves, |_, _| {}).await? {
            let byte = outcome.map_err(|denied| {
                let failure = Failure::from(denied);
                Failure { message: format!("group {group}: {}; nothing was written", failure.message), ..failure }
            })?;
            found.insert(group, byte);
        }
        let values: Vec<(u16, u8)> = changes
            .iter()
            .map(|(group, change)| (*group, change.apply(found.get(group).copied().unwrap_or_default())))
            .collect();
        let steps = plan_io_writes(model, &values).map_err(usage)?;
        write_all(link, screen, &steps).await?;
        let old = |group: u16| found.get(&group).copied();
        let signals = self.signals.iter().map(|Switch { signal, on }| {
            let old = old(signal.group()).map(|byte| IoValue::State(signal.is_on(byte)));
            Ok(WrittenSignal::new(item(model, *signal, names)?, old, IoValue::State(*on)))
        });
        let groups = self.groups.iter().map(|GroupValue { group, value }| {
            let old = old(*group).map(|byte| IoValue::Number(byte.into()));
            Ok(WrittenSignal::new(group_item(model, *group)?, old, IoValue::Number((*value).into())))
        });
        Ok(WrittenSignals::new(signals.chain(groups).collect::<Result<_, Failure>>()?))
    }
}

impl Set {
    /// Change of each group. It is an error if a signal occurs twice.
    fn changes(&self) -> Result<BTreeMap<u16, Change>, Failure> {
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

/// In a dry run, records a change that depends on values that must be read first.
fn plan(link: &mut Link, model: Model, partial: &[u16], changes: &BTreeMap<u16, Change>) -> Result<Failure, Failure> {
    let reads = |groups: &[u16]| plan_io_reads(model, groups).map_err(usage);
    let about = |groups: &[u16]| Some(format!("reads group {}", typed::runs(groups, "..")));
    plan_in_batches(link, reads, partial, |_| BatchSplit::Halves, about)?;
    let writes = |byte: u8| {
        let values: Vec<(u16, u8)> = changes.iter().map(|(group, change)| (*group, change.apply(byte))).collect();
        plan_io_writes(model, &values).map_err(usage)
    };
    let steps: Vec<(WriteIoStep, WriteIoStep)> = writes(0)?.into_iter().zip(writes(u8::MAX)?).collect();
    for (one, other) in steps {
        let (one, other, groups) = (one.request(), other.request(), typed::runs(one.written(), ".."));
        if one == other {
            link.plan(&one, &format!("writes group {groups}"));
        } else {
            let about = format!("writes group {groups}; the other signals keep the values that were read");
            link.plan_depending(&one, &other, Reason::about(&about).depending_on("the signals that were read"));
        }
    }
    Ok(unknown())
}

impl WriteOrder for WriteIoStep {
    type Item = u16;

    fn items(&self) -> Vec<u16> {
        self.written().to_vec()
    }

    fn listed(items: Vec<u16>) -> String {
        format!("group {}", typed::runs(&items, ".."))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(signals: &[&str], groups: &[&str]) -> Result<BTreeMap<u16, Change>, Failure> {
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

//! `yerc io get`.

use std::collections::HashSet;

use super::super::batch_split::{BatchSplit, read_in_batches};
use super::{group_item, item, signal};
use crate::prelude::*;
use armctl_controller::yerc::signal::Signal;
use armctl_controller::yerc::variables::{parse_numbers, plan_io_reads};
use armctl_frame::robot::io::{IoRow, IoValue, Signals, WATCHED};

/// Reads signals.
#[derive(Debug, Args)]
#[command(
    after_help = "The signals have the numbers of the manuals and the pendant: #20010 to #20017 are the eight signals \
                  of group 2001. Numbers that end in 8 or 9 do not exist; a range skips them. `armctl names list` \
                  shows the names of signals."
)]
pub struct Get {
    /// Signals, for example 20010, #20010 or 20010..20027, or a name
    #[arg(required_unless_present = "groups", value_name = "NUMBER", value_delimiter = ',', value_parser = signal::Signals::parse,
        add = complete::SIGNAL)]
    signals: Vec<signal::Signals>,
    /// Groups of eight signals, for example 2001 or 2001..2010 (repeatable)
    #[arg(long = "group", value_name = "GROUP", value_delimiter = ',', value_parser = Groups::parse)]
    groups: Vec<Groups>,
}

#[derive(Debug, Clone)]
struct Groups(Vec<u16>);

impl Groups {
    fn parse(text: &str) -> Result<Self, String> {
        parse_numbers(text).map(Self).map_err(|error| error.to_string())
    }
}

impl Command for Get {
    type Family = Yerc;
    type Report = Signals;
    const ID: &'static str = "yerc.io.get";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Signals> {
        let Context { link, robot, screen, .. } = context;
        let names = names::of_robot(robot, screen);
        let signals: Vec<Signal> =
            read_each_group_once(self.signals.iter().flat_map(|signals| signals.0.iter().copied()));
        let groups: Vec<u16> = read_each_group_once(self.groups.iter().flat_map(|groups| groups.0.iter().copied()));
        let wanted: Vec<u16> = signals.iter().map(|signal| signal.group()).chain(groups.iter().copied()).collect();
        let model = link.model_for(|model| signal::is_readable(model, &wanted, false)).await?;
        signal::is_readable(model, &wanted, false)?;
        let plan = |groups: &[u16]| plan_io_reads(model, groups).map_err(usage);
        let bytes =
            read_in_batches(link, plan, &read_each_group_once(wanted.into_iter()), |_| BatchSplit::Halves, |_, _| {})
                .await?;
        let byte = |group| Some(bytes.get(&group)?.clone().map_err(read_failure));
        let signals = signals.into_iter().filter_map(|signal| {
            let on = byte(signal.group())?.map(|byte| signal.is_on(byte));
            Some(item(model, signal, names).map(|item| IoRow::state(item, on)))
        });
        let groups = groups.into_iter().filter_map(|group| {
            let value = byte(group)?.map(|byte| IoValue::Number(byte.into()));
            Some(group_item(model, group).map(|item| IoRow::new(item, value)))
        });
        Signals::new(signals.chain(groups).collect::<Result<_, _>>()?)
    }
}

impl Watchable for Get {
    type Value = IoValue;

    const WATCH: &'static str = "yerc.io.watch";
    const WATCHED: Watched = WATCHED;
}

fn read_each_group_once<T: Copy + Eq + std::hash::Hash>(items: impl Iterator<Item = T>) -> Vec<T> {
    let mut by_group = HashSet::new();
    items.filter(|item| by_group.insert(*item)).collect()
}

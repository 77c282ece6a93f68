//! `yerc io list`.

use super::super::batch_split::{BatchSplit, read_in_batches};
use super::{item, kind, signal};
use crate::prelude::*;
use armctl_controller::yerc::signal::Signal;
use armctl_controller::yerc::variables::plan_io_reads;
use armctl_frame::robot::io::{Filter, IoRow, Signals};

/// Reads the signals of all classes of the model.
#[derive(Debug, Args)]
#[command(after_help = "Groups that the controller does not have are omitted.")]
pub struct List {
    #[command(flatten)]
    filter: Filter,
}

impl Command for List {
    type Family = Yerc;
    type Report = Signals;
    const ID: &'static str = "yerc.io.list";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Signals> {
        let Context { link, robot, screen, .. } = context;
        let names = names::of_robot(robot, screen);
        let groups = |model| -> Vec<u16> {
            let all = signal::groups(model).filter(|(_, span)| self.filter.has(kind(span.meaning)));
            all.map(|(group, _)| group).collect()
        };
        let model = link.model_for(|model| signal::is_readable(model, &groups(model), false)).await?;
        let wanted = groups(model);
        let progress = screen.spinner("reading signals");
        let plan = |groups: &[u16]| plan_io_reads(model, groups).map_err(usage);
        let say = |_: &[u16], known: usize| {
            progress.print_line(&format!("reading signals: {known} of {} groups", wanted.len()));
        };
        let bytes = read_in_batches(link, plan, &wanted, |_| BatchSplit::Halves, say).await?;
        if let Some(Err(denied)) = bytes.values().find(|_| bytes.values().all(Result::is_err)) {
            return Err(read_failure(denied.clone()));
        }
        let mut rows = Vec::new();
        for group in &wanted {
            let Some(Ok(byte)) = bytes.get(group) else { continue };
            let bits = (0..8).filter_map(|bit| Signal::new(u32::from(*group) * 10 + bit).ok());
            for signal in bits {
                let row = IoRow::state(item(model, signal, names)?, Ok(signal.is_on(*byte)));
                rows.extend(Some(row).filter(|row| self.filter.lists(row)));
            }
        }
        Signals::new(rows)
    }
}

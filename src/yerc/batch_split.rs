//! Reads many items with few requests. If a run of items is refused, it is read again in parts, to find the items that
//! were refused.

use std::collections::{HashMap, VecDeque};

use super::item_requests::{Batch, Outcome, ReadError};
use super::link::Link;
use crate::prelude::basics::*;
use armctl_controller::yerc::variables::PlannedRead;

/// How a refused run is divided.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BatchSplit {
    /// Into halves, because the valid numbers end somewhere in the run.
    Halves,
    /// Into single items, because each item can be refused, or because the controller has no request for several items.
    Single,
}

/// Sends the requests of a plan. A refused run is planned and read again in parts, down to the refused items. `parts`
/// defines how a run is divided. `progress` receives the current items and the number of items known so far. A dry run
/// records the plan.
pub async fn read_in_batches<S: PlannedRead>(
    link: &mut Link,
    mut plan: impl FnMut(&[S::Item]) -> Result<Vec<S>>,
    wanted: &[S::Item],
    parts: impl Fn(&[S::Item]) -> BatchSplit,
    mut progress: impl FnMut(&[S::Item], usize),
) -> Result<HashMap<S::Item, Outcome<S::Value>>> {
    if wanted.is_empty() {
        return Ok(HashMap::new());
    }
    if link.is_dry_run() {
        let purpose = link.take_purpose();
        plan_in_batches(link, plan, wanted, parts, |_| purpose.map(ToOwned::to_owned))?;
        return Err(unknown());
    }
    let mut steps: VecDeque<S> = plan(wanted)?.into();
    let mut batch = Batch::default();
    let mut known: HashMap<S::Item, Outcome<S::Value>> = HashMap::with_capacity(wanted.len());
    while let Some(step) = steps.pop_front() {
        let asked = step.wanted();
        progress(asked, known.len());
        let refused = match link.ask_in_batch(&mut batch, &step).await? {
            Ok(values) => {
                known.extend(values.into_iter().map(|(item, value)| (item, Ok(value))));
                continue;
            }
            Err(denied) => denied,
        };
        let retry = if is_alone(&step, &mut plan)? { None } else { describe_reason(&refused, parts(asked)) };
        let Some(parts) = retry else {
            known.extend(asked.iter().map(|item| (*item, Err(refused.clone()))));
            continue;
        };
        let size = if parts == BatchSplit::Single { 1 } else { asked.len().div_ceil(2) };
        for part in asked.chunks(size).rev() {
            for step in plan(part)?.into_iter().rev() {
                steps.push_front(step);
            }
        }
    }
    Ok(known)
}

/// Whether a request is for only one item. The request may include other items that are not needed.
fn is_alone<S: PlannedRead>(step: &S, plan: &mut impl FnMut(&[S::Item]) -> Result<Vec<S>>) -> Result<bool> {
    let asked = step.wanted();
    Ok(asked.len() == 1 && plan(asked)?.iter().all(|alone| alone.request() == step.request()))
}

/// In a dry run, records the requests of [`read_in_batches`]. Each run is followed by the requests that a refusal would
/// cause. For a long run, these are its halves, which are divided again, and one request for a single item as an
/// example. `about` is the purpose of a run.
pub fn plan_in_batches<S: PlannedRead>(
    link: &mut Link,
    mut plan: impl FnMut(&[S::Item]) -> Result<Vec<S>>,
    wanted: &[S::Item],
    parts: impl Fn(&[S::Item]) -> BatchSplit,
    about: impl Fn(&[S::Item]) -> Option<String>,
) -> Result<()> {
    for step in plan(wanted)? {
        let asked = step.wanted();
        let purpose = about(asked);
        link.plan_if(&step.request(), Reason { about: purpose.as_deref(), depends_on: None });
        if is_alone(&step, &mut plan)? {
            continue;
        }
        let singles = asked.iter().map(|item| plan(&[*item]));
        let singles = singles.collect::<Result<Vec<_>, _>>()?.into_iter().flatten();
        let singles: Vec<Request> = singles.map(|single| single.request()).collect();
        match (parts(asked), &singles[..]) {
            (BatchSplit::Halves, [first, _, .., last]) => {
                let (one, other) = asked.split_at(asked.len().div_ceil(2));
                for (half, which) in [(one, "first"), (other, "second")] {
                    let about = format!("the {which} half of the refused items, divided again down to single items");
                    for step in plan(half)? {
                        link.plan_if(&step.request(), Reason::about(&about).depending_on(REFUSED));
                    }
                }
                let about = "each item alone, if the controller has no request for several items";
                link.plan_depending(first, last, Reason::about(about).depending_on(REFUSED));
            }
            _ => {
                for single in &singles {
                    link.plan_if(
                        single,
                        Reason::about("each item alone, if the controller refuses the request for several items")
                            .depending_on(REFUSED),
                    );
                }
            }
        }
    }
    Ok(())
}

/// Condition for the requests after a run.
const REFUSED: &str = "whether the controller refuses the request for several items";

/// How a run is divided after this refusal; `None` if another read would not help.
fn describe_reason(denied: &ReadError, usual: BatchSplit) -> Option<BatchSplit> {
    /// Added status codes: "command error", "undefined command".
    const UNKNOWN: [u32; 2] = [0x1010, 0xA000];
    match denied {
        ReadError::Refused(refusal) if refusal.status.code == 0x08 || UNKNOWN.contains(&refusal.status.added) => {
            Some(BatchSplit::Single)
        }
        ReadError::Refused(_) => Some(usual),
        ReadError::Failed(failure) => (failure.kind == Kind::Malformed).then_some(BatchSplit::Single),
        ReadError::NotSent(_) => None,
    }
}

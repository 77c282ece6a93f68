//! Several writes in a row, with an exact report if one of them fails.

use std::collections::HashMap;

use super::link::Link;
use crate::command::frame::interrupt::interruptible;
use crate::controller::yerc::query::Query;
use crate::controller::yerc::variables::PlannedRead;
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// A write request and the names of its items.
pub trait WriteOrder: Query<Answer = ()> {
    /// Item type: a variable, a register, a group of signals.
    type Item: Clone;

    /// All items that the request writes.
    fn items(&self) -> Vec<Self::Item>;

    /// Short list of names.
    fn listed(items: Vec<Self::Item>) -> String;
}

/// Reads the values that requests replace, with one request per run of items. Values that the controller refuses are
/// missing. A dry run records the requests.
pub async fn old_value<S: PlannedRead>(link: &mut Link, reads: &[S]) -> Result<HashMap<S::Item, S::Value>, Failure> {
    let mut found = HashMap::new();
    for read in reads {
        found.extend(link.before(read).await?.into_iter().flatten());
    }
    Ok(found)
}

/// Sends the requests one after another. The first failure or Ctrl-C ends the sequence. The failure lists which items
/// were written, which may have been written, and which were not written.
pub async fn write_all<O: WriteOrder>(link: &mut Link, screen: &Screen, orders: &[O]) -> Result<(), Failure> {
    link.plan_all(orders)?;
    let mut done = 0;
    let progress = (orders.len() > 1).then(|| screen.spinner("writing"));
    // Ctrl-C ends the work here, before the caller handles it, so that the failure can list the result.
    let outcome = interruptible(async {
        for order in orders {
            if let Some(progress) = &progress {
                progress.print_line(&format!(
                    "writing {} ({} of {})",
                    O::listed(order.items()),
                    done + 1,
                    orders.len()
                ));
            }
            link.ask(order).await?;
            done += 1;
        }
        Ok(())
    })
    .await;
    let failure = match outcome {
        Ok(Ok(())) => return Ok(()),
        Ok(Err(failure)) | Err(failure) => failure,
    };
    Err(summarize_failure(failure, orders, done))
}

/// Failure with the result of each request. The first `done` requests were confirmed, and the next request failed.
fn summarize_failure<O: WriteOrder>(failure: Failure, orders: &[O], done: usize) -> Failure {
    // If its answer was lost or damaged, or after Ctrl-C, the outcome of the failed request is unknown. After any other
    // failure, the request was refused or was not sent.
    let is_unknown = matches!(failure.kind, Kind::OutcomeUnknown | Kind::Malformed | Kind::Interrupted);
    if !is_unknown && orders.len() == 1 {
        return failure;
    }
    let (written, rest) = orders.split_at(done.min(orders.len()));
    let unknown = if is_unknown { 1.min(rest.len()) } else { 0 };
    let (unknown, rest) = rest.split_at(unknown);
    let names = |orders: &[O]| O::listed(orders.iter().flat_map(WriteOrder::items).collect());
    let mut parts = vec![failure.message.trim_end_matches('.').to_owned()];
    if written.is_empty() && unknown.is_empty() {
        parts.push("nothing was written".to_owned());
    }
    for (words, orders) in [("written", written), ("possibly written", unknown), ("not written", rest)] {
        if !orders.is_empty() {
            parts.push(format!("{words}: {}", names(orders)));
        }
    }
    let message = parts.join("; ");
    let hint = failure.hint.clone().unwrap_or_else(|| "read the values back before you repeat the command".to_owned());
    let kind = if failure.kind == Kind::Refused && !written.is_empty() { Kind::Mixed } else { failure.kind };
    Failure { kind, message, ..failure }.hint(hint)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::yerc::Model;
    use crate::controller::yerc::variables::{WriteRegisterStep, plan_register_writes};

    fn orders() -> Vec<WriteRegisterStep> {
        let values: Vec<(u16, u16)> = [0, 1, 2, 10, 20, 21].map(|number| (number, 0)).into();
        plan_register_writes(Model::Dx200, &values).unwrap()
    }

    #[test]
    fn failure_lists_the_result_of_each_write() {
        let refused = Failure::new(Kind::Refused, "the controller refused: no. Because.").hint("x");
        let message = |failure: &Failure, done| summarize_failure(failure.clone(), &orders(), done).message;
        assert_eq!(
            message(&refused, 1),
            "the controller refused: no. Because; written: register 0..2; not written: register 10, 20..21"
        );
        assert_eq!(
            message(&refused, 0),
            "the controller refused: no. Because; nothing was written; not written: register 0..2, 10, 20..21"
        );
        assert_eq!([0, 1].map(|done| summarize_failure(refused.clone(), &orders(), done).kind.exit()), [3, 9]);
        let closed = Failure::new(Kind::NoAnswer, "nothing listens");
        assert_eq!(message(&closed, 1), "nothing listens; written: register 0..2; not written: register 10, 20..21");
        let lost = Failure::new(Kind::OutcomeUnknown, "no answer");
        assert_eq!(
            message(&lost, 1),
            "no answer; written: register 0..2; possibly written: register 10; not written: register 20..21"
        );
        let read_only = Failure::new(Kind::Rejected, "cell3 is read-only").hint("x");
        assert_eq!(
            message(&read_only, 0),
            "cell3 is read-only; nothing was written; not written: register 0..2, 10, 20..21"
        );
        for failure in [refused, read_only] {
            assert_eq!(summarize_failure(failure.clone(), &orders()[..1], 0), failure);
        }
        assert!(summarize_failure(Failure::new(Kind::Interrupted, "Ctrl-C"), &orders(), 2).hint.is_some());
    }
}

//! Several writes of signals in a row, with an exact report if one of them fails.

use super::link::Link;
use crate::command::frame::interrupt::interruptible;
use crate::controller::typed;
use crate::controller::yerc::variables::WriteIoStep;
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// Sends the requests one after the other. The first failure or Ctrl-C ends the sequence. The failure lists what was
/// written, what may have been written, and what was not.
pub async fn write_all(link: &mut Link, screen: &Screen, orders: &[WriteIoStep]) -> Result<(), Failure> {
    link.plan_all(orders)?;
    let mut done = 0;
    let progress = (orders.len() > 1).then(|| screen.spinner("writing"));
    // Ctrl-C ends the work here, before the caller handles it, so that the result is reported.
    let outcome = interruptible(async {
        for order in orders {
            if let Some(progress) = &progress {
                progress.print_line(&format!("writing {} ({} of {})", listed([order]), done + 1, orders.len()));
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

/// Failure with the result of each request; the first `done` were confirmed, the next one failed.
fn summarize_failure(failure: Failure, orders: &[WriteIoStep], done: usize) -> Failure {
    // The outcome of the failed request is unknown if its answer was lost or damaged, or after Ctrl-C. After every other
    // failure, it was refused or not sent.
    let is_unknown = matches!(failure.kind, Kind::OutcomeUnknown | Kind::Malformed | Kind::Interrupted);
    if !is_unknown && orders.len() == 1 {
        return failure;
    }
    let (written, rest) = orders.split_at(done.min(orders.len()));
    let unknown = if is_unknown { 1.min(rest.len()) } else { 0 };
    let (unknown, rest) = rest.split_at(unknown);
    let mut parts = vec![failure.message.trim_end_matches('.').to_owned()];
    if written.is_empty() && unknown.is_empty() {
        parts.push("nothing was written".to_owned());
    }
    for (words, orders) in [("written", written), ("written or not", unknown), ("not written", rest)] {
        if !orders.is_empty() {
            parts.push(format!("{words}: {}", listed(orders)));
        }
    }
    let message = parts.join("; ");
    let hint = failure.hint.clone().unwrap_or_else(|| "read the values back before you repeat the command".to_owned());
    let kind = if failure.kind == Kind::Refused && !written.is_empty() { Kind::Mixed } else { failure.kind };
    Failure { kind, message, ..failure }.hint(hint)
}

/// The groups that requests write.
fn listed<'a>(orders: impl IntoIterator<Item = &'a WriteIoStep>) -> String {
    let groups: Vec<u16> = orders.into_iter().flat_map(|order| order.written().iter().copied()).collect();
    format!("group {}", typed::runs(&groups, ".."))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::controller::yerc::Model;
    use crate::controller::yerc::variables::plan_io_writes;

    fn orders() -> Vec<WriteIoStep> {
        let values: Vec<(u16, u8)> = [2701, 2702, 2710, 2720, 2721].map(|group| (group, 0)).into();
        plan_io_writes(Model::Dx200, &values).unwrap()
    }

    #[test]
    fn failure_lists_the_result_of_each_write() {
        let refused = Failure::new(Kind::Refused, "the controller refused: no. Because.").hint("x");
        let message = |failure: &Failure, done| summarize_failure(failure.clone(), &orders(), done).message;
        assert_eq!(
            message(&refused, 1),
            "the controller refused: no. Because; written: group 2701..2702; not written: group 2710, 2720..2721"
        );
        assert_eq!(
            message(&refused, 0),
            "the controller refused: no. Because; nothing was written; not written: group 2701..2702, 2710, 2720..2721"
        );
        assert_eq!([0, 1].map(|done| summarize_failure(refused.clone(), &orders(), done).kind.exit()), [3, 9]);
        let closed = Failure::new(Kind::NoAnswer, "nothing listens");
        assert_eq!(
            message(&closed, 1),
            "nothing listens; written: group 2701..2702; not written: group 2710, 2720..2721"
        );
        let lost = Failure::new(Kind::OutcomeUnknown, "no answer");
        assert_eq!(
            message(&lost, 1),
            "no answer; written: group 2701..2702; written or not: group 2710; not written: group 2720..2721"
        );
        let read_only = Failure::new(Kind::Rejected, "cell3 is read-only").hint("x");
        assert_eq!(
            message(&read_only, 0),
            "cell3 is read-only; nothing was written; not written: group 2701..2702, 2710, 2720..2721"
        );
        for failure in [refused, read_only] {
            assert_eq!(summarize_failure(failure.clone(), &orders()[..1], 0), failure);
        }
        assert!(summarize_failure(Failure::new(Kind::Interrupted, "Ctrl-C"), &orders(), 2).hint.is_some());
    }
}

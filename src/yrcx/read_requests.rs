//! Several read requests, sent one after the other, because a controller executes one remote command at a time. Each
//! request has its own result.

use super::refusal::{object, refused};
use crate::prelude::*;
use armctl_controller::yrcx::alarm::STOP_INPUT;
use armctl_controller::yrcx::value::Value;

/// Results of several requests, in the order of the requests.
#[derive(Debug)]
pub struct RequestResults {
    /// Values or failure of each request.
    pub outcomes: Vec<Result<Values>>,
    /// Number of requests that were sent. The other requests were not sent, because they would fail for the same
    /// reason.
    pub asked: usize,
}

/// Sends all requests. A refusal is the result of its own request only. A link failure, or a refusal that the next
/// request would get too, ends the loop. If this happens at the first request, the function returns the failure. In a
/// dry run, notes all requests and ends.
pub async fn ask_each(link: &mut Link, screen: &Screen, what: &str, orders: &[Order]) -> Result<RequestResults> {
    plan_each(link, orders)?;
    let mut progress = (orders.len() > 1).then(|| screen.items_progress(what, orders.len() as u64));
    let mut outcomes = Vec::with_capacity(orders.len());
    for (done, order) in orders.iter().enumerate() {
        let (outcome, goes_on) = ask(link, order).await;
        if let (Err(failure), false) = (&outcome, goes_on) {
            if done == 0 {
                return outcome.map(|_| RequestResults { outcomes: Vec::new(), asked: 0 });
            }
            let not_asked = Failure { message: format!("not read: {}", failure.message), ..failure.clone() };
            outcomes.push(outcome);
            outcomes.resize(orders.len(), Err(not_asked));
            return Ok(RequestResults { outcomes, asked: done + 1 });
        }
        outcomes.push(outcome);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    Ok(RequestResults { outcomes, asked: orders.len() })
}

/// Notes read requests in a dry run, each with its object. The dry run ends there.
pub fn plan_each(link: &mut Link, orders: &[Order]) -> Result<()> {
    if !link.is_dry_run() || orders.is_empty() {
        return Ok(());
    }
    for order in orders {
        let object = object(order);
        link.plan(order, if object.is_empty() { order.row().name } else { &object });
    }
    Err(unknown())
}

/// Sends one of several requests. The flag is `true` if the next request can succeed.
async fn ask(link: &mut Link, order: &Order) -> (Result<Values>, bool) {
    match link.try_ask(order).await {
        Ok(Err(refusal)) => (Err(refused(order.row(), refusal.alarm)), !refuses_all_commands(refusal.alarm)),
        Ok(Ok(done)) => (check_echo(order, &done.values).map(|()| done.values), true),
        Err(failure) => (Err(failure), false),
    }
}

/// Whether the controller refuses remote commands in general, so that it would refuse the next command too.
pub fn refuses_all_commands(alarm: Alarm) -> bool {
    alarm.group == STOP_INPUT.group
}

/// Whether a refusal means that the item is not defined.
pub fn is_undefined(failure: &Failure) -> bool {
    let alarm = failure.code.as_deref().and_then(|code| code.parse().ok());
    failure.kind == Kind::Refused && alarm.is_some_and(|alarm| !refuses_all_commands(alarm))
}

/// Checks that the fields that an answer repeats are equal to the fields of the request.
pub fn check_echo(order: &Order, values: &Values) -> Result<()> {
    let differs = |(key, asked): &(Key, &Value)| values.value(*key).is_some_and(|told| told != *asked);
    match order.values().iter().find(differs) {
        Some((key, _)) => {
            let message = format!("{}: the answer is for another {key}", order.row().id);
            Err(Failure::new(Kind::Malformed, message).hint("use `-vvv` to see the words"))
        }
        None => Ok(()),
    }
}

//! Several read requests, one after the other, because a controller executes one remote command at a time. Each has
//! its own result.

use super::link::Link;
use super::link::Yrcx;
use super::numbers::Numbers;
use super::refusal::refused;
use crate::command::Context;
use crate::command::frame::items::ItemOutcome;
use crate::controller::yrcx::alarm::{Alarm, STOP_INPUT};
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// Results of several requests, in their order.
#[derive(Debug)]
pub struct Answers {
    /// Values or failure of each request.
    pub outcomes: Vec<Result<Values, Failure>>,
    /// Number of requests sent. The others were not sent, because they would fail alike.
    pub asked: usize,
}

/// Sends all requests. A refusal is the result of its request. A link failure, or a refusal that would repeat, ends
/// the loop and is the only failure of the whole. A dry run notes all requests and ends.
pub async fn ask_each(link: &mut Link, screen: &Screen, what: &str, orders: &[Order]) -> Result<Answers, Failure> {
    link.plan_all(orders)?;
    let mut progress = (orders.len() > 1).then(|| screen.items_progress(what, orders.len() as u64));
    let mut outcomes = Vec::with_capacity(orders.len());
    for (done, order) in orders.iter().enumerate() {
        let (outcome, goes_on) = ask(link, order).await;
        if let (Err(failure), false) = (&outcome, goes_on) {
            if done == 0 {
                return outcome.map(|_| Answers { outcomes: Vec::new(), asked: 0 });
            }
            let not_asked = Failure { message: format!("not read: {}", failure.message), ..failure.clone() };
            outcomes.push(outcome);
            outcomes.resize(orders.len(), Err(not_asked));
            return Ok(Answers { outcomes, asked: done + 1 });
        }
        outcomes.push(outcome);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    Ok(Answers { outcomes, asked: orders.len() })
}

/// Sends one of several requests, and returns whether the next one can succeed.
async fn ask(link: &mut Link, order: &Order) -> (Result<Values, Failure>, bool) {
    match link.try_ask(order).await {
        Ok(Err(refusal)) => (Err(refused(order.row(), refusal.alarm)), !is_about_commands(refusal.alarm)),
        Ok(Ok(done)) => (check_echo(order, &done.values).map(|()| done.values), true),
        Err(failure) => (Err(failure), false),
    }
}

/// Reads items by number; `key` is the field of the number, `nouns` the singular and plural name of the items.
///
/// # Errors
/// What ends the whole, or the failure of the only item.
pub async fn read_numbers<V>(
    context: Context<'_, Yrcx>,
    [noun, nouns]: [&str; 2],
    (command, key): (Command, Key),
    numbers: &[Numbers],
    of: impl Fn(&Values) -> V,
) -> Result<Vec<(i32, ItemOutcome<V>)>, Failure> {
    let Context { link, screen, .. } = context;
    let numbers = Numbers::of(numbers);
    let orders = numbers.iter().map(|number| Ok(link.draft(command)?.with(key, *number).build()?));
    let orders = orders.collect::<Result<Vec<Order>, Failure>>()?;
    let answers = ask_each(link, screen, &format!("reading {nouns}"), &orders).await?;
    let outcomes = numbers.into_iter().zip(answers.outcomes);
    let outcomes = outcomes.map(|(number, outcome)| {
        (number, ItemOutcome::new(format!("{noun} {number}"), outcome.map(|values| of(&values))))
    });
    let outcomes: Vec<_> = outcomes.collect();
    if let [(_, only)] = &outcomes[..]
        && let Some(error) = only.error()
    {
        return Err(error.failure());
    }
    Ok(outcomes)
}

/// Whether a refusal concerns remote commands in general, so that the next command would be refused as well.
pub fn is_about_commands(alarm: Alarm) -> bool {
    alarm.group == STOP_INPUT.group
}

/// Whether a refusal means that the item is not defined.
pub fn is_undefined(failure: &Failure) -> bool {
    let alarm = failure.code.as_deref().and_then(|code| code.parse().ok());
    failure.kind == Kind::Refused && alarm.is_some_and(|alarm| !is_about_commands(alarm))
}

/// Checks the fields that an answer repeats from its request.
pub fn check_echo(order: &Order, values: &Values) -> Result<(), Failure> {
    let differs = |(key, asked): &(Key, &Value)| values.value(*key).is_some_and(|told| told != *asked);
    match order.values().iter().find(differs) {
        Some((key, _)) => {
            let message = format!("{}: the answer is for another {key}", order.row().id);
            Err(Failure::new(Kind::Malformed, message).hint("use `-vvv` to see the words"))
        }
        None => Ok(()),
    }
}

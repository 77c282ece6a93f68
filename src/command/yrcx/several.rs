//! Several read requests, one after the other, because a controller executes one remote command at a time. Each has
//! its own result.

use schemars::JsonSchema;
use serde::Serialize;

use super::link::Link;
use super::link::Yrcx;
use super::numbers::Numbers;
use super::refusal::refused;
use crate::command::Context;
use crate::command::frame::items::{ItemError, ItemOutcome, verdict};
use crate::controller::yrcx::alarm::{Alarm, STOP_INPUT};
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::{Cell, Table, Tone};

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
pub async fn read_numbers<V>(
    context: Context<'_, Yrcx>,
    [noun, nouns]: [&str; 2],
    (command, key): (Command, Key),
    numbers: &[Numbers],
    mut of: impl FnMut(&Values) -> V,
) -> Result<(Vec<i32>, Several<V>), Failure> {
    let Context { link, screen, .. } = context;
    let numbers = Numbers::of(numbers);
    let orders = numbers.iter().map(|number| Ok(link.draft(command)?.with(key, *number).build()?));
    let orders = orders.collect::<Result<Vec<Order>, Failure>>()?;
    let answers = ask_each(link, screen, &format!("reading {nouns}"), &orders).await?;
    let names = numbers.iter().map(|number| format!("{noun} {number}"));
    let several = Several::of(names, answers, |_, values| of(values))?;
    Ok((numbers, several))
}

/// Results of several items, in the order requested.
#[derive(Debug)]
pub struct Several<V> {
    /// One result per item.
    pub outcomes: Vec<ItemOutcome<V>>,
    asked: usize,
}

impl<V> Several<V> {
    /// Collects the results with their names; `of` converts an answer to the reported value, by its index.
    ///
    /// # Errors
    /// The failure, if only one item was requested and failed.
    pub fn of(
        names: impl IntoIterator<Item = String>,
        Answers { outcomes, asked }: Answers,
        mut of: impl FnMut(usize, &Values) -> V,
    ) -> Result<Self, Failure> {
        let pairs = names.into_iter().zip(outcomes).enumerate();
        let outcomes = pairs.map(|(at, (name, outcome))| ItemOutcome::new(name, outcome.map(|values| of(at, &values))));
        let outcomes: Vec<_> = outcomes.collect();
        if let [only] = &outcomes[..]
            && let Some(error) = only.error()
        {
            return Err(error.failure());
        }
        Ok(Self { outcomes, asked })
    }

    /// The results as rows that start with the name of the item.
    pub fn rows<N>(self, names: impl IntoIterator<Item = N>) -> Rows<N, V> {
        let Self { outcomes, asked } = self;
        let rows = names.into_iter().zip(outcomes).map(|(name, outcome)| Row { name, outcome });
        Rows { rows: rows.collect(), asked }
    }
}

/// Named results.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Rows<N, V> {
    rows: Vec<Row<N, V>>,
    /// Number of items that were requested.
    #[serde(skip)]
    asked: usize,
}

/// Result of one item.
#[derive(Debug, Serialize, JsonSchema)]
struct Row<N, V> {
    #[serde(flatten)]
    name: N,
    #[serde(flatten)]
    outcome: ItemOutcome<V>,
}

impl<N, V> Rows<N, V> {
    /// Removes results that `is_worth` rejects.
    pub fn retain(&mut self, mut is_worth: impl FnMut(&N, &V) -> bool) {
        let mut at = 0;
        let asked = self.asked;
        self.rows.retain(|Row { name, outcome }| {
            let stays = outcome.data().is_none_or(|value| is_worth(name, value));
            self.asked -= usize::from(!stays && at < asked);
            at += 1;
            stays
        });
    }

    /// Table with one row per item: cells of the name, then of the value. A failed item has empty cells and the
    /// reason in an extra column.
    pub fn table<const A: usize, const B: usize>(
        &self,
        names: [&'static str; A],
        values: [&'static str; B],
        empty: &'static str,
        name: impl Fn(&N) -> [Cell; A],
        value: impl Fn(&V) -> [Cell; B],
    ) -> Table {
        let asked = &self.rows[..self.asked.min(self.rows.len())];
        let has_errors = asked.iter().any(|row| row.outcome.error().is_some());
        let columns = names.into_iter().chain(values).chain(has_errors.then_some("error"));
        let rows = asked.iter().map(|row| {
            let cells = row.outcome.data().map_or_else(|| values.map(|_| "-".into()), &value);
            let error = has_errors.then(|| row.outcome.error().map_or_else(|| "-".into(), brief));
            name(&row.name).into_iter().chain(cells).chain(error).collect()
        });
        Table { columns: columns.collect(), rows: rows.collect(), empty }
    }

    /// Failure of the report; none if all items were read.
    pub fn failure(&self) -> Option<Failure> {
        let failure = verdict(self.rows.len(), self.rows.iter().filter_map(|row| row.outcome.error()))?;
        Some(match self.rows.len() - self.asked.min(self.rows.len()) {
            0 => failure,
            rest => Failure { message: format!("{}; {rest} were not read", failure.message), ..failure },
        })
    }
}

/// Short error for a column; the row already names the item.
fn brief(error: &ItemError) -> Cell {
    let message = error.failure().message;
    let why = message.rsplit_once(": ").map_or(message.as_str(), |(_, why)| why);
    Cell::from(why).tone(Tone::Bad)
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
            Err(Failure::new(Kind::Malformed, message).hint("`-vvv` shows the words"))
        }
        None => Ok(()),
    }
}

//! References one after the other: a controller carries out one remote command at a time. Each answers for itself.

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

/// What came of several orders, in their order.
#[derive(Debug)]
pub struct Answers {
    /// Of each, what its answer holds, or why there is none.
    pub outcomes: Vec<Result<Values, Failure>>,
    /// How many were given to the controller; those behind were not, as they would fail alike.
    pub asked: usize,
}

/// Asks all of it. What is refused stands in its place; what ends the link, or would be refused whatever is asked, ends
/// the asking. Nothing but that is a failure of all. A dry run notes all orders and ends.
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
            let not_asked = Failure { message: format!("not asked any more: {}", failure.message), ..failure.clone() };
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

/// Asks one of several, and says whether the next one is worth asking.
async fn ask(link: &mut Link, order: &Order) -> (Result<Values, Failure>, bool) {
    match link.try_ask(order).await {
        Ok(Err(refusal)) => (Err(refused(order.row(), refusal.alarm)), !is_about_commands(refusal.alarm)),
        Ok(Ok(done)) => (check_echo(order, &done.values).map(|()| done.values), true),
        Err(failure) => (Err(failure), false),
    }
}

/// Reads what has these numbers, which stand in the field `key` of the command; `nouns` names what it is, one and many.
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

/// What each of several things came to, in the order asked for.
#[derive(Debug)]
pub struct Several<V> {
    /// One a thing.
    pub outcomes: Vec<ItemOutcome<V>>,
    asked: usize,
}

impl<V> Several<V> {
    /// With their names as errors tell them; `of` makes of an answer what is reported, by its place.
    ///
    /// # Errors
    /// The failure of a thing that was asked for alone.
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

    /// The same as rows that begin with what each is the outcome of.
    pub fn rows<N>(self, names: impl IntoIterator<Item = N>) -> Rows<N, V> {
        let Self { outcomes, asked } = self;
        let rows = names.into_iter().zip(outcomes).map(|(name, outcome)| Row { name, outcome });
        Rows { rows: rows.collect(), asked }
    }
}

/// Several things with what each came to.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(transparent)]
pub struct Rows<N, V> {
    rows: Vec<Row<N, V>>,
    /// How many of them were asked for.
    #[serde(skip)]
    asked: usize,
}

/// What one thing came to.
#[derive(Debug, Serialize, JsonSchema)]
struct Row<N, V> {
    #[serde(flatten)]
    name: N,
    #[serde(flatten)]
    outcome: ItemOutcome<V>,
}

impl<N, V> Rows<N, V> {
    /// Drops what was answered and is not worth telling.
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

    /// A table of what was asked, a row each: cells of the name, then those of the value. What failed has blanks in their
    /// place, and says why in a column of its own.
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

    /// Why this is not a success; nothing where all was answered.
    pub fn failure(&self) -> Option<Failure> {
        let failure = verdict(self.rows.len(), self.rows.iter().filter_map(|row| row.outcome.error()))?;
        Some(match self.rows.len() - self.asked.min(self.rows.len()) {
            0 => failure,
            rest => Failure { message: format!("{}; {rest} were not asked for", failure.message), ..failure },
        })
    }
}

/// Why one thing failed, as it fits a column: the row names the thing already.
fn brief(error: &ItemError) -> Cell {
    let message = error.failure().message;
    let why = message.rsplit_once(": ").map_or(message.as_str(), |(_, why)| why);
    Cell::from(why).tone(Tone::Bad)
}

/// Whether a refusal is about remote commands as such: the next one would be refused as well.
pub fn is_about_commands(alarm: Alarm) -> bool {
    alarm.group == STOP_INPUT.group
}

/// Whether a refusal to read something says that it is not defined.
pub fn is_undefined(failure: &Failure) -> bool {
    let alarm = failure.code.as_deref().and_then(|code| code.parse().ok());
    failure.kind == Kind::Refused && alarm.is_some_and(|alarm| !is_about_commands(alarm))
}

/// Answers repeat what was asked for, as far as they have it.
pub fn check_echo(order: &Order, values: &Values) -> Result<(), Failure> {
    let differs = |(key, asked): &(Key, &Value)| values.value(*key).is_some_and(|told| told != *asked);
    match order.values().iter().find(differs) {
        Some((key, _)) => {
            let message = format!("{}: the controller answers for another {key} than was asked for", order.row().id);
            Err(Failure::new(Kind::Malformed, message).hint("`-vvv` shows the words"))
        }
        None => Ok(()),
    }
}

//! References one after the other: a controller carries out one remote command at a time.

use schemars::JsonSchema;
use serde::Serialize;

use super::Family;
use super::link::Link;
use super::numbers::{Numbers, runs};
use super::refusal::refused;
use crate::command::Context;
use crate::controller::yrcx::alarm::{Alarm, STOP_INPUT};
use crate::controller::yrcx::answer::Answer;
use crate::controller::yrcx::order::Order;
use crate::controller::yrcx::table::Command;
use crate::controller::yrcx::value::{Key, Value, Values};
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// Asks all of it; the first refusal or failure ends it. A dry run notes all of it and ends.
pub async fn ask_all(link: &mut Link, screen: &Screen, what: &str, orders: &[Order]) -> Result<Vec<Values>, Failure> {
    link.rehearse(orders)?;
    let mut progress = (orders.len() > 1).then(|| screen.items_progress(what, orders.len() as u64));
    let mut answers = Vec::with_capacity(orders.len());
    for (done, order) in orders.iter().enumerate() {
        let values = link.run(order).await.map_err(|failure| cut_off(failure, done, orders.len()))?.values;
        check_echo(order, &values)?;
        answers.push(values);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    Ok(answers)
}

/// What was read by its numbers.
#[derive(Debug)]
pub struct Found {
    /// What is there, in the order asked for.
    pub entries: Vec<(i32, Values)>,
    /// What the controller refused to tell.
    pub refused: Vec<Refused>,
}

/// A number that the controller has nothing for.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Refused {
    number: i32,
    /// The alarm: group and category, as in `2.904`.
    code: String,
    /// What is known about it.
    meaning: &'static str,
}

/// Reads what has these numbers, which stand in the field `key` of the command. Of several, those that the controller
/// refuses, since they are not defined, are told beside the others. `noun` names what it is, as in `points`.
pub async fn read_numbers(
    context: Context<'_, Family>,
    noun: &str,
    (command, key): (Command, Key),
    numbers: &[Numbers],
) -> Result<Found, Failure> {
    let Context { link, screen, .. } = context;
    let numbers = Numbers::of(numbers);
    let orders = numbers.iter().map(|number| Ok(link.draft(command)?.with(key, *number).build()?));
    let orders = orders.collect::<Result<Vec<Order>, Failure>>()?;
    link.rehearse(&orders)?;
    let mut progress =
        (orders.len() > 1).then(|| screen.items_progress(&format!("reading {noun}"), orders.len() as u64));
    let mut found = Found { entries: Vec::with_capacity(orders.len()), refused: Vec::new() };
    let mut first = None;
    for (done, (&number, order)) in numbers.iter().zip(&orders).enumerate() {
        let given = link.try_run(order).await.map_err(|failure| cut_off(failure, done, orders.len()))?;
        match given.answer {
            Answer::Done(values) | Answer::Running(values) => {
                check_echo(order, &values)?;
                found.entries.push((number, values));
            }
            Answer::Refused { alarm, .. } => {
                let failure = refused(order.row(), alarm);
                if orders.len() == 1 || is_about_commands(alarm) {
                    return Err(cut_off(failure, done, orders.len()));
                }
                first.get_or_insert(failure);
                found.refused.push(Refused { number, code: alarm.to_string(), meaning: alarm.text() });
            }
        }
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    match first {
        Some(failure) if found.entries.is_empty() => Err(failure),
        _ => {
            tell_refused(screen, noun, &found.refused);
            Ok(found)
        }
    }
}

/// A failure that ends it in the middle.
fn cut_off(failure: Failure, done: usize, all: usize) -> Failure {
    match done {
        0 => failure,
        _ => Failure { message: format!("{}; it was number {} of {all}", failure.message, done + 1), ..failure },
    }
}

/// Whether a refusal is about remote commands as such: the next one would be refused as well.
pub fn is_about_commands(alarm: Alarm) -> bool {
    alarm.group == STOP_INPUT.group
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

/// Beside the data: which numbers were refused and why, a line for each alarm.
fn tell_refused(screen: &Screen, noun: &str, refused: &[Refused]) {
    let mut told: Vec<&str> = Vec::new();
    for Refused { code, meaning, .. } in refused {
        if !told.contains(&code.as_str()) {
            told.push(code);
            let numbers = refused.iter().filter(|other| other.code == *code).map(|other| other.number);
            let numbers = runs(&numbers.collect::<Vec<_>>());
            screen.note(&format!("{noun} refused with alarm {code}, {meaning}: {numbers}"));
        }
    }
}

//! Confirmation of overwritten variables, for every command that writes variables.

use std::collections::HashMap;

use super::entry::{Entry, is_undefined};
use super::read::Answers;
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::Known as _;
use crate::command::frame::orders::{BEFORE, unwritten};
use crate::command::yerc::each::ReadError;
use crate::command::yerc::link::Link;
use crate::controller::text::Encoding;
use crate::controller::yerc::payload::{Axes, Position};
use crate::controller::yerc::query::ReadVariable;
use crate::controller::yerc::request::Request;
use crate::controller::yerc::table::service;
use crate::controller::yerc::variables::{Reference, Value, VariableKind};
use crate::failure::Failure;
use crate::gate::Change;

/// Reads positions before a write, one by one, because each can be undefined. A dry run notes the requests.
pub async fn read_taught(link: &mut Link, positions: &[Reference]) -> Result<Answers, Failure> {
    let mut answers = HashMap::new();
    for reference in positions {
        let question = ReadVariable::new(reference.kind, reference.number);
        let answer = link.for_purpose(BEFORE).try_ask(&question).await.known().map_err(unwritten)?;
        answers.extend(answer.map(|outcome| (*reference, outcome.map_err(ReadError::Refused))));
    }
    Ok(answers)
}

/// Overwritten values. An undefined variable is not overwritten.
pub fn overwritten(known: &Answers, differing: &[(Reference, Value)], encoding: Encoding) -> Change {
    let mut overwritten = Vec::new();
    for (reference, value) in differing {
        let old = match known.get(reference) {
            Some(Err(denied)) if is_undefined(denied) => continue,
            Some(Ok(old)) if same(old, value) => continue,
            Some(old @ Ok(_)) => Entry::new(*reference, old, encoding).shown(),
            Some(Err(_)) => "not read".to_owned(),
            None => continue,
        };
        overwritten.push((reference.to_string(), old, Entry::new(*reference, &Ok(value.clone()), encoding).shown()));
    }
    if overwritten.is_empty() {
        return Change::nothing();
    }
    let plural = if overwritten.len() == 1 { "" } else { "s" };
    let change = Change::new(format!("overwrite {} variable{plural}", overwritten.len()));
    overwritten.iter().fold(change, |change, (name, old, new)| change.replaces(name, old, new))
}

/// Whether the controller would have the same value after the write; axes that are not reported are 0.
pub fn same(old: &Value, new: &Value) -> bool {
    match (old, new) {
        (Value::Position(old), Value::Position(new)) => {
            let full = |position: &Position| Position { axes: Axes::full(position.axes.padded()), ..*position };
            full(old) == full(new)
        }
        // Positive and negative zero are equal; NaN never is.
        (Value::Real(old), Value::Real(new)) => old.to_bits() == new.to_bits(),
        (old, new) => old == new,
    }
}

/// Position after a write of one field; none if there is no such field.
pub fn with_field(old: &Value, request: &Request) -> Option<Value> {
    let mut bytes = old.emit();
    let at = usize::from(request.attribute).checked_sub(1)? * 4;
    bytes.get_mut(at..at + 4)?.copy_from_slice(request.data.get(..4)?);
    Value::parse(old.kind(), &bytes).ok()
}

/// Confirms a raw request that writes positions (3.3.16 to 3.3.18, 3.3.34 to 3.3.36). `intent` describes a request
/// that armctl cannot decode.
pub async fn confirm_raw(
    link: &mut Link,
    authority: &Authority<'_>,
    request: &Request,
    intent: String,
) -> Result<(), Failure> {
    let change = match references(request) {
        Some(references) => {
            let known = read_taught(link, &references).await?;
            let new = |(at, reference): (usize, &Reference)| {
                Some((*reference, value_at(request, at, known.get(reference)?.as_ref().ok()?)?))
            };
            let new: Vec<_> = references.iter().enumerate().filter_map(new).collect();
            let is_clear = known.values().filter(|old| !old.as_ref().is_err_and(is_undefined)).count() == new.len();
            if is_clear { overwritten(&known, &new, link.encoding) } else { Change::new(intent) }
        }
        None => Change::new(intent),
    };
    authority.confirm(&change).await
}

/// Positions that a request writes; none if it writes no positions or does not match the manual.
fn references(request: &Request) -> Option<Vec<Reference>> {
    let kind = |number: fn(VariableKind) -> u16| {
        VariableKind::all().find(|kind| kind.is_position() && number(*kind) == request.command)
    };
    if request.service != service::WRITE_PLURAL {
        return kind(VariableKind::command).map(|kind| vec![Reference::new(kind, request.instance)]);
    }
    let kind = kind(VariableKind::plural_command)?;
    let count = u16::try_from(u32::from_le_bytes(*request.data.first_chunk()?)).ok()?;
    let last = request.instance.checked_add(count.checked_sub(1)?)?;
    (request.data.len() == 4 + usize::from(count) * kind.size())
        .then(|| (request.instance..=last).map(|number| Reference::new(kind, number)).collect())
}

/// Value that a request writes to its position at this index, which currently has `old`.
fn value_at(request: &Request, at: usize, old: &Value) -> Option<Value> {
    let kind = old.kind();
    match request.service {
        service::SET_SINGLE => with_field(old, request),
        service::SET_ALL => Value::parse(kind, &request.data).ok(),
        _ => Value::parse(kind, request.data.get(4 + at * kind.size()..)?.get(..kind.size())?).ok(),
    }
}

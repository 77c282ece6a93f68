//! Confirmation of raw requests that write positions (3.3.16 to 3.3.18, 3.3.34 to 3.3.36).

use std::collections::HashMap;

use super::position_word::with_field;
use super::table::{Variables, is_undefined};
use crate::item_requests::ReadError;
use crate::prelude::*;
use armctl_controller::yerc::query::ReadVariable;
use armctl_controller::yerc::table::service;
use armctl_controller::yerc::variables::{Reference, Value, VariableKind};
use armctl_frame::settings_report::{OLD_VALUE, nothing_written};
use armctl_frame::store::describe_change;

/// Asks the user to confirm a raw request that writes positions. `intent` is the text for a request that armctl cannot
/// decode.
pub async fn confirm_raw(link: &mut Link, confirmer: &Confirmer<'_>, request: &Request, intent: String) -> Result<()> {
    let Some(references) = references(request) else { return confirmer.confirm(&Change::new(intent)).await };
    let TaughtPositions { positions, has_unread } = read_taught(link, &references).await?;
    let new: Vec<Option<(Reference, Value)>> = references
        .iter()
        .enumerate()
        .map(|(at, reference)| Some((*reference, value_at(request, at, positions.get(reference)?)?)))
        .collect();
    let new: Vec<(Reference, Value)> = new.into_iter().flatten().collect();
    let differing: Vec<RowDifference<'_, Variables>> =
        new.iter().map(|(reference, value)| (*reference, positions.get(reference), value)).collect();
    let is_clear = !has_unread && new.len() == positions.len();
    let table = Variables::with_encoding(link.encoding);
    confirmer.confirm(&if is_clear { describe_change(&table, &differing) } else { Change::new(intent) }).await
}

/// Content of positions before a write.
struct TaughtPositions {
    /// Positions that are defined, and their content.
    positions: HashMap<Reference, Value>,
    /// Whether the controller refused to report the content of other positions.
    has_unread: bool,
}

/// Reads positions one by one, because each can be undefined. A dry run records the requests.
async fn read_taught(link: &mut Link, references: &[Reference]) -> Result<TaughtPositions> {
    let mut taught = TaughtPositions { positions: HashMap::new(), has_unread: false };
    for reference in references {
        let question = ReadVariable::new(reference.kind, reference.number);
        match link.for_purpose(OLD_VALUE).ask_optional(&question).await.known().map_err(nothing_written)? {
            Some(Ok(value)) => drop(taught.positions.insert(*reference, value)),
            Some(Err(refusal)) => taught.has_unread |= !is_undefined(&ReadError::Refused(refusal)),
            None => {}
        }
    }
    Ok(taught)
}

/// Positions that a request writes; `None` if it writes no positions, or is not as in the manual.
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

/// New value that a request writes to one of its position variables. `at` is the index of the variable in the request,
/// and `old` is the current value of the variable.
fn value_at(request: &Request, at: usize, old: &Value) -> Option<Value> {
    let kind = old.kind();
    match request.service {
        service::SET_SINGLE => with_field(old, request),
        service::SET_ALL => Value::parse(kind, &request.data).ok(),
        _ => Value::parse(kind, request.data.get(4 + at * kind.size()..)?.get(..kind.size())?).ok(),
    }
}

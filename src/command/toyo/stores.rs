//! Writes of many EEPROM cells, with an exact account of the cells after a failure.

use schemars::JsonSchema;
use serde::Serialize;

use super::eeprom::{Cell, Cells};
use super::items::plan_twice;
use super::link::Link;
use super::values;
use crate::client::toyo::Letters;
use crate::command::frame::interrupt::interruptible;
use crate::command::frame::settings_report::nothing_written;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::{LayoutProblem, Record};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::{self, Parameter};
use crate::failure::{Failure, Kind};
use crate::gate::Change;
use crate::output::Screen;

/// Terms for a write of many cells.
#[derive(Debug, Clone, Copy)]
pub struct StoreTask {
    /// Progress text: `storing points`.
    pub doing: &'static str,
    /// Noun before a key in messages, with an s for several keys: `point`; empty if the key is clear.
    pub noun: &'static str,
    /// Singular with its article, and plural.
    pub things: [&'static str; 2],
}

/// A cell among others.
#[derive(Debug, Clone)]
pub struct Store {
    /// Key among the others: `P01`, `17`.
    pub key: String,
    /// Cell with its new value.
    pub cell: Cell,
    /// Whether only some controllers have the cell. Their refusal does not stop the work.
    pub is_optional: bool,
    /// Present content.
    pub found: CellState,
    /// Letters of the axes for coordinates in messages.
    pub letters: Letters,
}

/// Present content of a cell.
#[derive(Debug, Clone)]
pub enum CellState {
    /// Not read yet.
    NotAsked,
    /// Unknown in a dry run.
    DryRun,
    /// The controller does not have the cell.
    NotThere,
    /// The content that was just read.
    This(Record),
}

impl From<Option<Record>> for CellState {
    fn from(found: Option<Record>) -> Self {
        found.map_or(Self::DryRun, Self::This)
    }
}

/// A replaced value: name, old value, new value.
pub type Replaced = [String; 3];

impl Store {
    /// A cell that every controller has.
    pub fn new(key: impl Into<String>, cell: Cell) -> Self {
        Self { key: key.into(), cell, is_optional: false, found: CellState::NotAsked, letters: Letters::USUAL }
    }

    /// Sets the letters of the axes for coordinates in messages.
    #[must_use]
    pub fn by(self, letters: Letters) -> Self {
        Self { letters, ..self }
    }

    /// Whether the present content is known and different.
    pub fn differs(&self) -> bool {
        matches!(&self.found, CellState::This(found) if !self.cell.is(found))
    }

    /// The replaced value, if the cell has other content that is not empty.
    fn replaced(&self, work: StoreTask) -> Option<Replaced> {
        let Self { key, cell, found: CellState::This(found), letters, .. } = self else { return None };
        if cell.is(found) || cell.is_blank(found) {
            return None;
        }
        let what = match (cell.read.parameter().filter(|parameter| parameter.row().is_none()), work.noun) {
            (Some(parameter), _) => format!("{} ({})", parameter.id, parameter.name),
            (None, "") => key.clone(),
            (None, noun) => format!("{noun} {key}"),
        };
        let [old, new] = difference(cell, found, letters);
        Some([what, old, new])
    }
}

/// Old and new values that differ, as text.
fn difference(cell: &Cell, found: &Record, letters: &Letters) -> [String; 2] {
    if cell.read.command() == table::Command::Rstx {
        return [found.written(), cell.wanted.written()];
    }
    values::difference(found, &cell.wanted, letters)
}

/// Replaced values that are not empty.
pub fn replaced(work: StoreTask, stores: &[Store]) -> Vec<Replaced> {
    stores.iter().filter_map(|store| store.replaced(work)).collect()
}

/// Change to confirm; `of` names the place: ` of task 1`.
pub fn overwriting([one, several]: [&str; 2], replaced: &[Replaced], of: &str) -> Change {
    let change = match replaced.len() {
        0 => return Change::none(),
        1 => Change::new(format!("overwrite {one}{of}")),
        many => Change::new(format!("overwrite {many} {several}{of}")),
    };
    replaced.iter().fold(change, |change, [what, old, new]| change.replaces(what, old, new))
}

/// Reads cells that were not read yet. A failure states that nothing was written.
pub async fn look(link: &mut Link, screen: &Screen, stores: &mut [Store]) -> Result<(), Failure> {
    let count = stores.iter().filter(|store| matches!(store.found, CellState::NotAsked)).count();
    let mut progress = (count > 1).then(|| screen.items_progress("reading the stored values", count as u64));
    let looked = interruptible(async {
        for store in stores.iter_mut().filter(|store| matches!(store.found, CellState::NotAsked)) {
            store.found = found(link, store).await?;
            if let Some(progress) = &mut progress {
                progress.advance(1);
            }
        }
        Ok(())
    });
    looked.await.and_then(|looked| looked).map_err(nothing_written)
}

async fn found(link: &mut Link, store: &Store) -> Result<CellState, Failure> {
    if link.is_dry() {
        plan_twice(link, &store.cell.read);
        return Ok(CellState::DryRun);
    }
    if store.is_optional {
        return Ok(link.read_if_there(&store.cell.read).await?.map_or(CellState::NotThere, CellState::This));
    }
    Ok(CellState::This(link.ask(&store.cell.read).await?))
}

/// Block that writes a parameter or a row of a table; `?` stands for kept values.
pub fn parameter_sketch(parameter: &Parameter, row: Option<i32>, values: &[Option<Value>]) -> String {
    let values: Vec<_> = row.map(|row| Some(Value::Number(row))).into_iter().chain(values.iter().cloned()).collect();
    format!("@WPAR {}", parameter.layout.sketch(&values).unwrap_or_default())
}

/// Result of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StoreResult {
    /// Written and read back.
    Written,
    /// The value was already equal.
    Unchanged,
    /// Refused by a controller without this cell.
    NotThere,
}

/// Cell of a parameter or of a row of a table, with all fields of its layout.
pub fn parameter_cell(parameter: &'static Parameter, values: Vec<Value>) -> Result<Cell, LayoutProblem> {
    let row = parameter
        .row()
        .and(values.first())
        .and_then(|row| if let Value::Number(row) = row { Some(*row) } else { None });
    Ok(Cell {
        read: Request::read_parameter(parameter, row)?,
        write: Request::write_parameter(parameter, &values)?,
        wanted: parameter.layout.record(values)?,
    })
}

impl Link {
    /// Reads something that only some controllers have; `None` if it is refused twice, because a busy controller also
    /// refuses.
    pub async fn read_if_there(&mut self, request: &Request) -> Result<Option<Record>, Failure> {
        for _ in 0..2 {
            if let Ok(content) = self.try_ask(request).await? {
                return Ok(Some(content));
            }
        }
        Ok(None)
    }
}

/// Writes cells in order and skips equal ones. The first failure or Ctrl-C ends the work, with an account of the cells.
/// A dry run records all requests.
pub async fn store_all(
    link: &mut Link,
    screen: &Screen,
    work: StoreTask,
    stores: &[Store],
) -> Result<Vec<StoreResult>, Failure> {
    let mut fates = Vec::with_capacity(stores.len());
    if link.is_dry() || stores.len() == 1 {
        for store in stores {
            fates.push(one(link, screen, store).await?);
        }
        return Ok(fates);
    }
    let mut progress = screen.items_progress(work.doing, stores.len() as u64);
    // The caller also waits for Ctrl-C, but polls this work first. It therefore ends here, with the account.
    let outcome = interruptible(async {
        for store in stores {
            fates.push(one(link, screen, store).await?);
            progress.advance(1);
        }
        Ok(())
    })
    .await;
    drop(progress);
    match outcome {
        Ok(Ok(())) => Ok(fates),
        Ok(Err(failure)) | Err(failure) => Err(account(failure, work, stores, &fates)),
    }
}

/// Counts the results.
pub fn sum(fates: &[StoreResult]) -> Cells {
    let count = |fate| u32::try_from(fates.iter().filter(|other| **other == fate).count()).unwrap_or(u32::MAX);
    Cells { cells_written: count(StoreResult::Written), cells_unchanged: count(StoreResult::Unchanged) }
}

async fn one(link: &mut Link, screen: &Screen, store: &Store) -> Result<StoreResult, Failure> {
    let Store { cell, .. } = store;
    let found = if let CellState::NotAsked = store.found { found(link, store).await? } else { store.found.clone() };
    Ok(match found {
        CellState::NotThere => StoreResult::NotThere,
        CellState::This(found) if cell.is(&found) => StoreResult::Unchanged,
        CellState::DryRun => {
            link.plan_overwriting(&cell.read, &cell.write.text()).await?;
            StoreResult::Written
        }
        CellState::This(_) | CellState::NotAsked => {
            link.overwrite(screen, cell, &mut Cells::default()).await?;
            StoreResult::Written
        }
    })
}

/// Failure with the result of each cell; it occurred at the cell after the last result.
fn account(failure: Failure, work: StoreTask, stores: &[Store], fates: &[StoreResult]) -> Failure {
    let (done, rest) = stores.split_at(fates.len().min(stores.len()));
    // Only these failures prove that nothing changed.
    let is_known = matches!(failure.kind, Kind::Refused | Kind::NoAnswer | Kind::Usage);
    let (unknown, rest) = rest.split_at(if is_known { 0 } else { 1.min(rest.len()) });
    let mut parts = vec![failure.message.trim_end_matches('.').to_owned()];
    let counted = sum(fates);
    if !done.is_empty() {
        let Cells { cells_written: written, cells_unchanged: unchanged } = counted;
        parts.push(format!("done: {} ({written} written, {unchanged} unchanged)", span(work, done)));
    } else if is_known {
        parts.push("nothing was written".to_owned());
    }
    for (words, stores) in [("unknown", unknown), ("not written", rest)] {
        // One sentence describes all cells.
        if !(stores.is_empty() || is_known && done.is_empty()) {
            parts.push(format!("{words}: {}", span(work, stores)));
        }
    }
    let again = "repeat the command: it continues and skips stored values".to_owned();
    let hint = failure.hint.as_ref().map_or(again.clone(), |hint| format!("{hint}; then {again}"));
    Failure { message: parts.join("; "), ..failure }.hint(hint)
}

/// First and last key of some cells.
fn span(work: StoreTask, stores: &[Store]) -> String {
    let named = |plural: &str, keys: String| match work.noun {
        "" => keys,
        noun => format!("{noun}{plural} {keys}"),
    };
    match stores {
        [one] => named("", one.key.clone()),
        [first, .., last] => named("s", format!("{} to {}", first.key, last.key)),
        [] => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WORK: StoreTask = StoreTask { doing: "storing points", noun: "point", things: ["a point", "points"] };

    fn stores() -> Vec<Store> {
        let parameter = Parameter::named("T1").unwrap();
        let store = |row: i32| {
            let values = [row, 0, 0, 0, 0].map(Value::Number).into();
            Store::new(row.to_string(), parameter_cell(parameter, values).unwrap())
        };
        (1..=5).map(store).collect()
    }

    #[test]
    fn a_failure_says_what_became_of_each() {
        let told = |kind, fates: &[StoreResult]| {
            let Failure { message, hint, .. } = account(Failure::new(kind, "no."), WORK, &stores(), fates);
            format!("{message} | {}", hint.unwrap_or_default())
        };
        assert_eq!(
            told(Kind::Refused, &[StoreResult::Written, StoreResult::Unchanged]),
            "no; done: points 1 to 2 (1 written, 1 unchanged); not written: points 3 to 5 | \
             repeat the command: it continues and skips stored values"
        );
        assert_eq!(
            told(Kind::OutcomeUnknown, &[StoreResult::Written]),
            "no; done: point 1 (1 written, 0 unchanged); unknown: point 2; not written: points 3 to 5 | \
             repeat the command: it continues and skips stored values"
        );
        assert_eq!(
            told(Kind::NoAnswer, &[]),
            "no; nothing was written | repeat the command: it continues and skips stored values"
        );
    }
}

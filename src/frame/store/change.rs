//! Write of rows: reads the old rows, confirms the changes, and writes the rows that differ. Each row has its own
//! result.

use super::{Answers, LinkOf, RowDifference, Store, Writable, WrittenOf, columns, item};
use crate::confirmation::Confirmer;
use crate::dry_run::{Known as _, unknown};
use crate::interrupt::interruptible;
use crate::items::describe_request;
use crate::names;
use crate::prelude::basics::*;
use crate::robot::item::{Written, WrittenItems};
use crate::settings_report::nothing_written;

/// Kind of confirmation for a write.
pub const fn confirmation<S: Writable>() -> Confirmation {
    match S::RISK {
        Risk::Destroy => Confirmation::WhenKnown,
        Risk::Read | Risk::Write | Risk::Motion => Confirmation::Question,
    }
}

/// Text that completes "This will …".
pub fn intent<S: Writable>() -> String {
    format!("overwrite {}", S::WORDS.nouns[1])
}

/// Key and new content of a row.
pub type Row<S> = (<S as Store>::Key, <S as Writable>::Draft);

/// Context of a write.
pub struct TableWrite<'a, S: Store> {
    /// Table.
    pub table: S,
    /// Robot.
    pub robot: &'a Robot,
    /// Connection to the robot.
    pub link: &'a mut LinkOf<S>,
    /// Screen for progress and notes.
    pub screen: &'a Screen,
    /// Authority that confirms the overwriting of user data.
    pub confirmer: Confirmer<'a>,
}

/// A row, and its comparison with the controller.
#[derive(Debug)]
pub struct ComparedRow<S: Store> {
    /// Key of the row.
    pub key: S::Key,
    /// Content on the controller; `None` if it is unknown.
    pub old: Option<S::Wire>,
    /// New content.
    pub new: S::Wire,
    /// Whether the row was written, or why it was not written.
    pub outcome: Result<bool>,
    /// Whether the row was not tried, because an earlier failure ended the write.
    pub is_skipped: bool,
}

impl<S: Store> ComparedRow<S> {
    /// Whether the controller refused to report the row, because the row is not defined yet.
    pub fn is_undefined(&self) -> bool {
        self.old.is_none()
    }

    /// Whether the controller has another content.
    pub fn is_different(&self) -> bool {
        self.old.as_ref().is_none_or(|old| !S::is_equal(old, &self.new))
    }
}

/// Writes the rows that differ. Stops at the first failure of the link. Each row has its own result.
pub async fn write<S: Writable>(work: TableWrite<'_, S>, rows: Vec<Row<S>>) -> Result<WrittenOf<S>> {
    let TableWrite { mut table, robot, link, screen, confirmer } = work;
    table.select(link).await.map_err(nothing_written)?;
    let compared = write_rows(&table, link, screen, confirmer, rows).await;
    // After Ctrl-C, no more requests are sent. When the link is closed, the selected table is restored.
    let is_interrupted = |rows: &Vec<ComparedRow<S>>| {
        rows.iter().any(|row| row.outcome.as_ref().is_err_and(|failure| failure.kind == Kind::Interrupted))
    };
    let compared = match compared {
        Ok(rows) if is_interrupted(&rows) => rows,
        compared => table.deselect(link, compared).await?,
    };
    let written: Vec<S::Key> =
        compared.iter().filter(|row| matches!(row.outcome, Ok(true))).map(|row| row.key).collect();
    if let Some(words) = table.follow_up_note(&written).filter(|_| !written.is_empty()) {
        screen.note(&words);
    }
    let names = names::of_robot(robot, screen);
    let items: Vec<_> = compared
        .into_iter()
        .map(|ComparedRow { key, old, new, outcome, .. }| {
            let (is_written, outcome) = match outcome {
                Ok(is_written) => (is_written, Ok(Some(new))),
                Err(failure) => (false, Err(failure)),
            };
            let old_cells = old.as_ref().map(|old| table.cells(key, old)).unwrap_or_default();
            let old = old.as_ref().and_then(|old| table.value(old));
            Written::new(item(&table, names, key, outcome), old, is_written).with_old_cells(old_cells)
        })
        .collect();
    Ok(WrittenItems::new(columns(&table), items))
}

/// Compares rows with the controller, asks the user to confirm, and writes the rows that differ.
pub async fn write_rows<S: Writable>(
    table: &S,
    link: &mut LinkOf<S>,
    screen: &Screen,
    confirmer: Confirmer<'_>,
    rows: Vec<Row<S>>,
) -> Result<Vec<ComparedRow<S>>> {
    let Some(mut compared) = compare(table, link, screen, &rows).await? else {
        table.plan(link, &rows).await?;
        return Err(unknown());
    };
    confirmer.confirm(&describe_change(table, &differing(&compared))).await?;
    write_each(table, link, screen, &mut compared).await;
    Ok(compared)
}

/// Reads rows and compares them with their new content. Returns `None` in a dry run, in which the old content is
/// unknown.
///
/// # Errors
/// If a read fails. The failure states that nothing was written.
pub async fn compare<S: Writable>(
    table: &S,
    link: &mut LinkOf<S>,
    screen: &Screen,
    rows: &[Row<S>],
) -> Result<Option<Vec<ComparedRow<S>>>> {
    let read = match table.read_old(link, screen, rows).await {
        // The controller refused all rows at once. This refusal is the answer for each row below.
        Err(failure) if failure.kind == Kind::Refused => {
            let refused = rows.iter().map(|_| Err(failure.clone()));
            Ok(Answers { rows: refused.collect(), asked: rows.len() })
        }
        read => read,
    };
    let Some(answers) = read.known().map_err(nothing_written)? else { return Ok(None) };
    let mut compared = Vec::with_capacity(rows.len());
    for ((key, draft), old) in rows.iter().zip(answers.rows) {
        let old = match old {
            Ok(old) => old,
            Err(failure) if S::risk(*key) < Risk::Destroy && failure.kind == Kind::Refused => {
                // Without the old row, only a complete new row can be written.
                if table.complete_draft(*key, draft, None).is_err() {
                    return Err(nothing_written(describe_request(&S::asked(*key), failure)));
                }
                None
            }
            Err(failure) if S::is_undefined(&failure) => None,
            Err(failure) => return Err(nothing_written(failure)),
        };
        let new = table.complete_draft(*key, draft, old.as_ref())?;
        compared.push(ComparedRow::<S> { key: *key, old, new, outcome: Ok(false), is_skipped: false });
    }
    Ok(Some(compared))
}

/// Rows that will be written.
pub fn differing<S: Writable>(rows: &[ComparedRow<S>]) -> Vec<RowDifference<'_, S>> {
    rows.iter().filter(|row| row.is_different()).map(|row| (row.key, row.old.as_ref(), &row.new)).collect()
}

/// Values that a person wrote and that will be replaced: name, old value, new value.
pub fn replaced<S: Writable>(table: &S, rows: &[RowDifference<'_, S>]) -> Vec<[String; 3]> {
    let lost = rows.iter().filter_map(|(key, old, new)| {
        let is_lost = |old: &&S::Wire| S::risk(*key) == S::RISK && !S::is_equal(old, new) && !table.is_blank(old);
        let old = old.filter(is_lost)?;
        let [old, new] = table.difference(old, new);
        Some([S::asked(*key), old, new])
    });
    lost.collect()
}

/// Question about the data that a person wrote and that will be overwritten.
pub fn describe_change<S: Writable>(table: &S, rows: &[RowDifference<'_, S>]) -> Change {
    table.consequences(rows).into_iter().fold(overwriting(table, &replaced(table, rows)), Change::note)
}

/// Question about rows that will be overwritten: the name, the old value and the new value of each row.
pub fn overwriting<S: Writable>(table: &S, lost: &[[String; 3]]) -> Change {
    let [one, many] = S::WORDS.nouns;
    let (article, place) = (if one.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" }, table.table_suffix());
    let change = match lost.len() {
        0 => return Change::none(),
        1 => Change::new(format!("overwrite {article} {one}{place}")),
        count => Change::new(format!("overwrite {count} {many}{place}")),
    };
    lost.iter().fold(change, |change, [name, old, new]| change.replaces(name, old, new))
}

/// Writes the rows that differ, and records the result of each row.
pub async fn write_each<S: Writable>(table: &S, link: &mut LinkOf<S>, screen: &Screen, rows: &mut [ComparedRow<S>]) {
    let differing: Vec<usize> = (0..rows.len()).filter(|index| rows[*index].is_different()).collect();
    let blocks = table.blocks(&changes(rows, &differing));
    let mut progress = (differing.len() > 1)
        .then(|| screen.items_progress(&format!("writing {}", S::WORDS.nouns[1]), differing.len() as u64));
    let mut end: Option<Failure> = None;
    for block in blocks {
        let block: Vec<usize> = block.into_iter().map(|index| differing[index]).collect();
        let is_skipped = end.is_some();
        let outcome = match &end {
            Some(failure) => Err(unwritten_rows(failure)),
            // After Ctrl-C, the report still lists the rows that were written.
            None => match interruptible(table.write(link, screen, &changes(rows, &block))).await {
                Ok(outcome) => outcome.map(|()| true),
                Err(interrupted) => Err(interrupted),
            },
        };
        if let Err(failure) = &outcome
            && failure.kind != Kind::Refused
            && end.is_none()
        {
            end = Some(failure.clone());
        }
        if let Some(progress) = &mut progress {
            progress.advance(block.len() as u64);
        }
        for index in block {
            rows[index].outcome.clone_from(&outcome);
            rows[index].is_skipped = is_skipped;
        }
    }
}

/// The rows with these indices, each with its old and new content.
fn changes<'r, S: Writable>(rows: &'r [ComparedRow<S>], indices: &[usize]) -> Vec<RowDifference<'r, S>> {
    indices.iter().map(|index| &rows[*index]).map(|row| (row.key, row.old.as_ref(), &row.new)).collect()
}

/// Failure of the rows that were not tried, because an earlier failure ended the work.
fn unwritten_rows(failure: &Failure) -> Failure {
    let kind = if failure.kind == Kind::OutcomeUnknown { Kind::NoAnswer } else { failure.kind };
    Failure { kind, message: format!("not written: {}", failure.message), ..failure.clone() }
        .hint("repeat the same command: armctl does not write values that are already stored")
}

//! Restore of the parts that are tables: comparison with the controller, question, and writes.

use super::manifest::LeftOut;
use crate::Family;
use crate::interrupt::interruptible;
use crate::prelude::basics::*;
use crate::robot::file::{FileItem, State};
use crate::settings_report::nothing_written;
use crate::store::{self, PartResult, TablePart};

/// A table, whatever the type of its rows.
pub type Table<F> = Box<dyn TablePart<F>>;

/// Rows that a table leaves out, as the manifest lists them.
impl From<store::LeftOut> for LeftOut {
    fn from(store::LeftOut { name, why }: store::LeftOut) -> Self {
        Self { key: name, why }
    }
}

/// Compares all parts with the controller. A part that cannot be read fails alone; nothing of it is written.
pub async fn compare_all<'p, F: Family>(
    link: &mut F::Link,
    screen: &Screen,
    parts: impl ExactSizeIterator<Item = (&'p mut Table<F>, &'p mut FileItem)>,
) -> Result<()> {
    let mut read = screen.parts_progress("parts read", parts.len());
    let mut lost = None;
    for (table, result) in parts {
        if let Some(failure) = &lost {
            result.fail(Failure::clone(failure));
            continue;
        }
        match interruptible(table.compare(link, screen)).await.and_then(|compared| compared) {
            Ok(()) => {}
            Err(failure) if failure.kind == Kind::Interrupted => return Err(nothing_written(failure)),
            Err(failure) => {
                if !result.fail(failure.clone()) {
                    lost = Some(failure);
                }
            }
        }
        read.advance(1);
    }
    Ok(())
}

/// Writes the rows that differ, of the parts that were compared.
pub async fn write_all<'p, F: Family>(
    link: &mut F::Link,
    screen: &Screen,
    parts: impl ExactSizeIterator<Item = (&'p mut Table<F>, &'p mut FileItem)>,
) {
    let mut written = screen.parts_progress("parts written", parts.len());
    for (table, result) in parts.filter(|(_, result)| result.error.is_none()) {
        if !settle(result, table.write(link, screen).await) {
            break;
        }
        written.advance(1);
    }
}

/// Records the result of a part. Returns whether the next part can be tried.
pub fn settle(result: &mut FileItem, outcome: Result<PartResult>) -> bool {
    let PartResult { written, unchanged, left_out, failure } = match outcome {
        Ok(outcome) => outcome,
        Err(failure) => return result.fail(failure),
    };
    (result.more.written, result.more.unchanged) = (Some(written), Some(unchanged));
    result.more.left_out = left_out.into_iter().map(LeftOut::from).collect();
    if let Some(failure) = failure {
        return result.fail(failure);
    }
    result.succeed(State::Done);
    true
}

/// Values of a part that a restore replaces.
#[derive(Debug)]
pub struct ReplacedValues {
    /// Name of the part.
    pub part: String,
    /// Singular and plural of a value.
    pub nouns: [&'static str; 2],
    /// Name, old value, new value.
    pub values: Vec<[String; 3]>,
    /// Consequences of the writes.
    pub notes: Vec<String>,
}

impl ReplacedValues {
    /// Values of a table that was compared.
    pub fn of<F: Family>(part: &dyn fmt::Display, table: &Table<F>) -> Self {
        let (values, notes) = (table.replaced(), table.consequences());
        Self { part: part.to_string(), nouns: table.nouns(), values, notes }
    }
}

/// Maximum number of values that a question shows one by one. If there are more, the question shows their number per
/// part.
const SHOWN: usize = 10;

/// Change to confirm. It shows a few values one by one, but of many values only their number per part.
pub fn overwriting(folder: &Path, replaced: &[ReplacedValues]) -> Change {
    let (total, folder) = (replaced.iter().map(|part| part.values.len()).sum::<usize>(), folder.display());
    let change = match total {
        0 => return Change::none(),
        1 => Change::new(format!("overwrite a value with the value in {folder}")),
        _ => Change::new(format!("overwrite {total} values with the values in {folder}")),
    };
    let change = replaced.iter().flat_map(|part| part.notes.iter().cloned()).fold(change, Change::note);
    replaced.iter().filter(|part| !part.values.is_empty()).fold(
        change,
        |change, ReplacedValues { part, nouns, values, .. }| {
            if total > SHOWN {
                let [one, many] = nouns;
                let count = values.len();
                return change.item(format!("{part}: {count} {}", if count == 1 { one } else { many }));
            }
            values.iter().fold(change, |change, [what, old, new]| change.replaces(&format!("{part}, {what}"), old, new))
        },
    )
}

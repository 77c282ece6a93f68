//! Many cells of the EEPROM in a row, with an exact account of what was done when one of them fails.

use super::cells::{Cell, Cells};
use super::link::Link;
use crate::command::interrupt::interruptible;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::{Misfit, Record};
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Parameter;
use crate::failure::{Failure, Kind};
use crate::output::Screen;

/// Work on many cells, in words.
#[derive(Debug, Clone, Copy)]
pub struct Work {
    /// As progress tells it: `storing points`.
    pub doing: &'static str,
    /// What stands before a key in messages, for several with an s: `point`; nothing where a key says enough.
    pub noun: &'static str,
    /// Whether the command takes `--resume=KEY`.
    pub resumes: bool,
}

/// A cell in a row of them.
#[derive(Debug, Clone)]
pub struct Store {
    /// What tells it from the others: `P01`, `17`.
    pub key: String,
    /// What it shall hold.
    pub cell: Cell,
    /// Only some controllers have it: that another one refuses it stops nothing.
    pub is_optional: bool,
    /// What it holds, where that was read a moment ago.
    pub found: Option<Record>,
}

/// What became of one cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, schemars::JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Fate {
    /// Written and read back.
    Written,
    /// Held that value already.
    Unchanged,
    /// Refused by a controller that does not have it.
    NotThere,
    /// Left out by `--resume`.
    LeftOut,
}

/// The cell of a parameter, or of a row of a table, with all fields of its layout.
pub fn parameter_cell(parameter: &'static Parameter, values: Vec<Value>) -> Result<Cell, Misfit> {
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

/// How many are left out by `--resume=KEY`: those before it. Without a key, none is.
pub fn left_out(stores: &[Store], resume: Option<&str>) -> Result<usize, Failure> {
    let Some(key) = resume.filter(|key| !key.is_empty()) else { return Ok(0) };
    stores.iter().position(|store| store.key.eq_ignore_ascii_case(key)).ok_or_else(|| {
        Failure::usage(format!("--resume={key}: the file does not have it"))
            .hint("--resume alone compares everything, and writes what differs")
    })
}

impl Link {
    /// Reads the content of something that not every controller has; `None` if it is refused, and so again: one that
    /// is busy refuses, too.
    pub async fn read_if_there(&mut self, request: &Request) -> Result<Option<Record>, Failure> {
        for _ in 0..2 {
            if let Ok(content) = self.try_read_content(request).await? {
                return Ok(Some(content));
            }
        }
        Ok(None)
    }
}

/// Stores one after the other, each unless it holds that already; the first ones are left out. The first failure ends
/// it, and tells what was stored, what may have been, and what was not; so does Ctrl-C. In a dry run all is noted.
pub async fn store_all(
    link: &mut Link,
    screen: &Screen,
    work: Work,
    stores: &[Store],
    left_out: usize,
) -> Result<Vec<Fate>, Failure> {
    let mut fates = vec![Fate::LeftOut; left_out.min(stores.len())];
    let rest = &stores[fates.len()..];
    if link.is_dry() || rest.len() == 1 {
        for store in rest {
            fates.push(one(link, screen, store).await?);
        }
        return Ok(fates);
    }
    let mut progress = screen.items_progress(work.doing, rest.len() as u64);
    // The caller waits for Ctrl-C too, but asks this work first; so it ends here, with the account.
    let outcome = interruptible(async {
        for store in rest {
            fates.push(one(link, screen, store).await?);
            progress.advance(1);
        }
        Ok(())
    })
    .await;
    drop(progress);
    match outcome {
        Ok(Ok(())) => Ok(fates),
        Ok(Err(failure)) | Err(failure) => Err(account(failure, work, rest, &fates[stores.len() - rest.len()..])),
    }
}

/// What fates come to.
pub fn sum(fates: &[Fate]) -> Cells {
    let count = |fate| u32::try_from(fates.iter().filter(|other| **other == fate).count()).unwrap_or(u32::MAX);
    Cells { cells_written: count(Fate::Written), cells_unchanged: count(Fate::Unchanged) }
}

async fn one(link: &mut Link, screen: &Screen, store: &Store) -> Result<Fate, Failure> {
    if store.is_optional && !link.is_dry() && link.read_if_there(&store.cell.read).await?.is_none() {
        return Ok(Fate::NotThere);
    }
    let mut cells = Cells::default();
    link.store_over(screen, &store.cell, store.found.as_ref(), &mut cells).await?;
    Ok(if cells.cells_written > 0 { Fate::Written } else { Fate::Unchanged })
}

/// The failure, and what became of each cell; it came up at the one behind the last fate.
fn account(failure: Failure, work: Work, stores: &[Store], fates: &[Fate]) -> Failure {
    let (done, rest) = stores.split_at(fates.len().min(stores.len()));
    let next = rest.first();
    // Only these are known to have changed nothing.
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
    for (words, stores) in [("written or not", unknown), ("not written", rest)] {
        // One sentence says it of all of them.
        if !(stores.is_empty() || is_known && done.is_empty()) {
            parts.push(format!("{words}: {}", span(work, stores)));
        }
    }
    let again = match next {
        Some(next) if work.resumes => format!("--resume={} goes on there", next.key),
        _ => "the same command goes on: what is stored already is not written again".to_owned(),
    };
    let hint = failure.hint.as_ref().map_or(again.clone(), |hint| format!("{hint}; then {again}"));
    Failure { message: parts.join("; "), ..failure }.hint(hint)
}

/// The first and the last of some.
fn span(work: Work, stores: &[Store]) -> String {
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

    const WORK: Work = Work { doing: "storing points", noun: "point", resumes: true };

    fn stores() -> Vec<Store> {
        let parameter = Parameter::named("T1").unwrap();
        let store = |row: i32| {
            let values = [row, 0, 0, 0, 0].map(Value::Number).into();
            Store {
                key: row.to_string(),
                cell: parameter_cell(parameter, values).unwrap(),
                is_optional: false,
                found: None,
            }
        };
        (1..=5).map(store).collect()
    }

    #[test]
    fn a_failure_says_what_became_of_each() {
        let told = |kind, fates: &[Fate]| {
            let Failure { message, hint, .. } = account(Failure::new(kind, "no."), WORK, &stores(), fates);
            format!("{message} | {}", hint.unwrap_or_default())
        };
        assert_eq!(
            told(Kind::Refused, &[Fate::Written, Fate::Unchanged]),
            "no; done: points 1 to 2 (1 written, 1 unchanged); not written: points 3 to 5 | --resume=3 goes on there"
        );
        assert_eq!(
            told(Kind::OutcomeUnknown, &[Fate::Written]),
            "no; done: point 1 (1 written, 0 unchanged); written or not: point 2; not written: points 3 to 5 | \
             --resume=2 goes on there"
        );
        assert_eq!(told(Kind::NoAnswer, &[]), "no; nothing was written | --resume=1 goes on there");
    }

    #[test]
    fn resuming_leaves_out_what_is_before() {
        assert_eq!(left_out(&stores(), None).unwrap(), 0);
        assert_eq!(left_out(&stores(), Some("3")).unwrap(), 2);
        assert_eq!(left_out(&stores(), Some("9")).unwrap_err().kind, Kind::Usage);
    }
}

//! Copies of programs that the controller makes by itself.

use super::eeprom::{Cells, is_blank};
use super::field_values::{NamedValue, in_a_line, named_values_with};
use super::number_arguments::ask_all;
use super::refusal;
use crate::prelude::*;
use armctl_controller::toyo::table::palletizing::RECORDS;

/// A program copy, and the requests that read source and target.
#[derive(Debug)]
pub struct Copy {
    /// Type of program, such as `easy program`.
    pub what: &'static str,
    /// Number of the source.
    pub from: i32,
    /// Number of the target.
    pub to: i32,
    /// Request that copies the program.
    pub order: Request,
    /// Requests that read the source and the target.
    pub reads: [Vec<Request>; 2],
}

impl Copy {
    /// Copies the program after a confirmation, if source and target differ. Then reads the target back.
    pub async fn make(self, link: &mut Link, screen: &Screen, confirmer: &Confirmer<'_>) -> Result<Copied> {
        let Self { what, from, to, order, reads: [source, target] } = self;
        if from == to {
            return Err(
                Failure::usage(format!("{what} {from} cannot be copied to itself")).hint("type two different numbers")
            );
        }
        let letters = link.letters().await?;
        if link.is_dry_run() {
            for (reads, about) in [(&source, "the source of the copy"), (&target, "the target of the copy")] {
                for read in reads {
                    link.plan(read, about);
                }
            }
            link.plan_order(&order.text(), DIFFER).await?;
            for read in &target {
                link.plan_if(read, DIFFER);
            }
            return Err(unknown());
        }
        let wanted = ask_all(link, screen, "reading the source", &source).await?;
        let found = ask_all(link, screen, "reading the target", &target).await?;
        let differing = differences(&wanted, &found);
        let all = u32::try_from(wanted.len()).unwrap_or(u32::MAX);
        if differing == 0 {
            return Ok(Copied { what, from, to, cells: Cells { cells_written: 0, cells_unchanged: all } });
        }
        confirmer.confirm(&replacing(what, (from, to), letters, &target, (&wanted, &found))).await?;
        link.ask(&order).await?;
        let found = ask_all(link, screen, "reading the target again", &target).await.map_err(|failure| {
            let message = format!(
                "the controller accepted {}, but the value could not be read back: {}",
                order.text(),
                failure.message
            );
            Failure::new(Kind::OutcomeUnknown, message).hint(refusal::verification_hint(order.command()))
        })?;
        if differences(&wanted, &found) > 0 {
            return Err(Failure::new(
                Kind::Malformed,
                format!("the controller accepted {}, but the stored value differs", order.text()),
            )
            .hint("check for a second client that writes the same program, and for a worn EEPROM"));
        }
        Ok(Copied { what, from, to, cells: Cells { cells_written: differing, cells_unchanged: all - differing } })
    }
}

/// Condition for the copy.
const DIFFER: &str = "whether source and target differ";

/// Builds the change that the user must confirm.
fn replacing(
    what: &str,
    (from, to): (i32, i32),
    letters: Letters,
    reads: &[Request],
    (wanted, found): (&[Record], &[Record]),
) -> Change {
    let lost = reads
        .iter()
        .zip(wanted.iter().zip(found))
        .filter(|(read, (wanted, found))| content(wanted) != content(found) && !is_blank(read, found));
    let lost: Vec<(usize, [String; 2])> = lost
        .map(|(read, (wanted, found))| {
            let record = read.record().number("record").unwrap_or_default();
            let text = |record: &Record| {
                let shown: Vec<NamedValue> = named_values_with(record, &letters)
                    .into_iter()
                    .filter(|shown| !KEYS.contains(&&shown.name[..]))
                    .collect();
                in_a_line(&shown)
            };
            (usize::try_from(record).unwrap_or_default(), [text(found), text(wanted)])
        })
        .collect();
    if lost.is_empty() {
        return Change::none();
    }
    let change = Change::new(format!("overwrite {what} {to} with {what} {from}"));
    lost.iter().fold(change, |change, (record, [old, new])| {
        let what = record.checked_sub(1).and_then(|index| RECORDS.get(index)).map_or(what, |record| record.name);
        change.replaces(what, old, new)
    })
}

/// Fields that identify a program. They are not content.
const KEYS: [&str; 2] = ["program", "st"];

fn content(record: &Record) -> Vec<Value> {
    record.pairs().filter(|(field, _)| !KEYS.contains(&field.name)).map(|(_, value)| value.clone()).collect()
}

/// Number of records whose content differs.
fn differences(one: &[Record], other: &[Record]) -> u32 {
    let differing = one.iter().zip(other).filter(|(one, other)| content(one) != content(other)).count();
    u32::try_from(differing).unwrap_or(u32::MAX)
}

/// Result of a program copy.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Copied {
    #[serde(skip)]
    what: &'static str,
    from: i32,
    to: i32,
    #[serde(flatten)]
    cells: Cells,
}

impl Report for Copied {
    fn view(&self) -> View {
        let Self { what, from, to, cells } = self;
        View::text(format!("{what} {to} is now equal to {what} {from}\n{}", cells.in_words()))
    }
}

//! Copies of programs from one place to another, which the controller makes itself.

use schemars::JsonSchema;
use serde::Serialize;

use super::eeprom::{Cells, is_blank};
use super::link::Link;
use super::numbers::ask_all;
use super::refusal;
use super::values::{Shown, in_a_line, shown_by};
use crate::client::toyo::Letters;
use crate::command::Report;
use crate::command::frame::authority::Authority;
use crate::command::frame::dry_run::unknown;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::palletizing::RECORDS;
use crate::failure::{Failure, Kind};
use crate::gate::Change;
use crate::output::Screen;
use crate::output::view::View;

/// A copy: what makes it, and what reads its two places.
#[derive(Debug)]
pub struct Copy {
    /// `easy program`.
    pub what: &'static str,
    /// From there.
    pub from: i32,
    /// To there.
    pub to: i32,
    /// Makes it.
    pub order: Request,
    /// Read what is copied, and what is there.
    pub reads: [Vec<Request>; 2],
}

impl Copy {
    /// Copies, unless both places are the same already, once it is confirmed that something is replaced. What is there
    /// afterwards is read back.
    pub async fn make(self, link: &mut Link, screen: &Screen, authority: &Authority<'_>) -> Result<Copied, Failure> {
        let Self { what, from, to, order, reads: [source, target] } = self;
        if from == to {
            return Err(
                Failure::usage(format!("{what} {from} cannot be copied to itself")).hint("name two different ones")
            );
        }
        let letters = link.letters().await?;
        if link.is_dry() {
            for (reads, about) in [(&source, "what is copied"), (&target, "what it replaces")] {
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
        let wanted = ask_all(link, screen, "reading what is copied", &source).await?;
        let found = ask_all(link, screen, "reading what it replaces", &target).await?;
        let differing = differences(&wanted, &found);
        let all = u32::try_from(wanted.len()).unwrap_or(u32::MAX);
        if differing == 0 {
            return Ok(Copied { what, from, to, cells: Cells { cells_written: 0, cells_unchanged: all } });
        }
        authority.confirm(&replacing(what, (from, to), letters, &target, (&wanted, &found))).await?;
        link.ask(&order).await?;
        let found = ask_all(link, screen, "reading it back", &target).await.map_err(|failure| {
            let message = format!("{} was accepted, but not read back: {}", order.text(), failure.message);
            Failure::new(Kind::OutcomeUnknown, message).hint(refusal::verification_hint(order.command()))
        })?;
        if differences(&wanted, &found) > 0 {
            return Err(Failure::new(
                Kind::Malformed,
                format!("the controller accepted {} and holds something else", order.text()),
            )
            .hint("the EEPROM may be worn out, or somebody else writes it at the same time"));
        }
        Ok(Copied { what, from, to, cells: Cells { cells_written: differing, cells_unchanged: all - differing } })
    }
}

/// What decides whether it is made.
const DIFFER: &str = "whether they differ";

/// What a copy replaces, for a person to confirm.
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
                let shown: Vec<Shown> =
                    shown_by(record, &letters).into_iter().filter(|shown| !KEYS.contains(&&shown.name[..])).collect();
                in_a_line(&shown)
            };
            (usize::try_from(record).unwrap_or_default(), [text(found), text(wanted)])
        })
        .collect();
    if lost.is_empty() {
        return Change::nothing();
    }
    let change = Change::new(format!("overwrite {what} {to} by {what} {from}"));
    lost.iter().fold(change, |change, (record, [old, new])| {
        let what = record.checked_sub(1).and_then(|index| RECORDS.get(index)).map_or(what, |record| record.name);
        change.replaces(what, old, new)
    })
}

/// What tells a program from the others, and no content of it.
const KEYS: [&str; 2] = ["program", "st"];

fn content(record: &Record) -> Vec<Value> {
    record.pairs().filter(|(field, _)| !KEYS.contains(&field.name)).map(|(_, value)| value.clone()).collect()
}

/// How many of two rows of records differ by more than their program.
fn differences(one: &[Record], other: &[Record]) -> u32 {
    let differing = one.iter().zip(other).filter(|(one, other)| content(one) != content(other)).count();
    u32::try_from(differing).unwrap_or(u32::MAX)
}

/// What was copied.
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
        View::text(format!("{what} {to} is as {what} {from}\n{}", cells.in_words()))
    }
}

//! Copies of programs from one place to another, which the controller makes itself.

use schemars::JsonSchema;
use serde::Serialize;

use super::cells::Cells;
use super::link::Link;
use super::numbers::read_contents;
use super::refusal;
use crate::command::Report;
use crate::command::dry_run::unknown;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::failure::{Failure, Kind};
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
    /// Copies, unless both places are the same already. What is there afterwards is read back.
    pub async fn make(self, link: &mut Link, screen: &Screen) -> Result<Copied, Failure> {
        let Self { what, from, to, order, reads: [source, target] } = self;
        if from == to {
            return Err(
                Failure::usage(format!("{what} {from} cannot be copied to itself")).hint("name two different ones")
            );
        }
        if link.is_dry() {
            for (reads, about) in [(&source, "what is copied"), (&target, "what it replaces")] {
                for read in reads {
                    link.foresee(read, about);
                }
            }
            link.take_host().await?;
            link.foresee(&order, "if they differ");
            return Err(unknown());
        }
        let wanted = read_contents(link, screen, "reading what is copied", &source).await?;
        let found = read_contents(link, screen, "reading what it replaces", &target).await?;
        let differing = differences(&wanted, &found);
        let all = u32::try_from(wanted.len()).unwrap_or(u32::MAX);
        if differing == 0 {
            return Ok(Copied { what, from, to, cells: Cells { cells_written: 0, cells_unchanged: all } });
        }
        link.order(&order).await?;
        let found = read_contents(link, screen, "reading it back", &target).await.map_err(|failure| {
            let message = format!("{} was accepted, but not read back: {}", order.text(), failure.message);
            Failure::new(Kind::OutcomeUnknown, message).hint(refusal::telltale(order.command()))
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

/// How many of two rows of records differ by more than their program.
fn differences(one: &[Record], other: &[Record]) -> u32 {
    let content = |record: &Record| {
        record.pairs().filter(|(field, _)| field.name != "program").map(|(_, value)| value.clone()).collect::<Vec<_>>()
    };
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

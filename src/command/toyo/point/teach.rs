//! `toyo teach`: stores where the axes are in a point. `point set 5 here` and `point teach 5` are this.

use clap::Args;

use super::set::{WORK, store};
use super::{OTHER_TASK, parse_point};
use crate::command::frame::dry_run::{Known as _, unknown};
use crate::command::frame::teach::Taught;
use crate::command::toyo::complete;
use crate::command::toyo::link::{self, Link, Toyo};
use crate::command::toyo::position::{Coordinates, UNIT};
use crate::command::toyo::stores::{self, StoreResult, parameter_sketch};
use crate::command::toyo::tasks;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::toyo::bulk::points::table;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Command as Word;
use crate::failure::{Failure, Kind};
use crate::gate::{Confirmation, outdated};

/// Stores where the axes are in a point, and reads it back.
#[derive(Debug, Args)]
#[command(
    after_help = format!(
        "What is stored is what `toyo position` tells at that moment, with servo power on or off; before a return to the \
         origin that means nothing, and is refused. `toyo point set 5 here` and `toyo point teach 5` are the same.\n\n\
         {OTHER_TASK}"
    )
)]
pub struct Teach {
    /// Row of the coordinate table, 1 to 999, or a name
    #[arg(value_name = "POINT", value_parser = parse_point, add = complete::POINT)]
    point: i32,
    /// Task, 1 to 4, instead of the current one
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    task: Option<u8>,
}

/// How a position reads in words.
fn shown(place: &Coordinates) -> String {
    format!("{} (mm)", place.in_a_line())
}

impl Command for Teach {
    type Family = Toyo;
    type Report = Taught;
    const ID: &'static str = "toyo.teach";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a point";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Self::Report, Failure> {
        if context.link.status_of(&[0]).await.known()?.is_some_and(|status| !status.homed()) {
            return Err(Failure::new(
                Kind::ConditionNotMet,
                "the return to origin is not complete: no position is known",
            )
            .hint("`toyo home` returns to the origin; nothing was stored"));
        }
        let task = tasks::choose(context.link, self.task).await?;
        let link = &mut *context.link;
        let taught = self.teach(Context { link, ..context }, task).await;
        tasks::done(context.link, taught).await
    }
}

impl Teach {
    async fn teach(&self, context: Context<'_, Toyo>, task: u8) -> Result<Taught, Failure> {
        let Context { link, screen, authority, .. } = context;
        let name = self.point.to_string();
        let read = Request::read_parameter(table(), Some(self.point)).map_err(|error| link::wrong(&error))?;
        let letters = link.letters().await?;
        let here = stands(link).await.known()?;
        let found = link.ask(&read).await.known()?;
        let Some((here, found)) = here.zip(found) else {
            let sketch = parameter_sketch(table(), Some(self.point), &[None, None, None, None]);
            link.plan_overwriting(&read, &sketch).await?;
            return Err(unknown());
        };
        let place = Coordinates::of(&here, letters);
        let old = Coordinates::of(&found, letters);
        let axes = ["x", "y", "z", "r"].map(|axis| Value::Number(here.number(axis).unwrap_or_default()));
        let values = std::iter::once(Value::Number(self.point)).chain(axes).collect();
        let stores = [store(values, letters)?.over(Some(found))];
        let is_asked = authority.asks();
        authority.confirm(&stores::replacing(WORK, &stores, &format!(" of task {task}"))).await?;
        if is_asked {
            let now = Coordinates::of(&stands(link).await?, letters);
            if now != place {
                let message = format!("the axes have moved since the question, to {}", shown(&now));
                return Err(outdated(format!("{message}; nothing was stored")));
            }
        }
        let fates = stores::store_all(link, screen, WORK, &stores, 0).await?;
        // What was written has been read back and is that.
        let taught = Taught::new(name, Some(old.position()), place.position(), place.position().of_group(UNIT))
            .unchanged(fates == [StoreResult::Unchanged]);
        Ok(taught.with("point", self.point).with("task", task))
    }
}

/// Where the axes are.
async fn stands(link: &mut Link) -> Result<Record, Failure> {
    link.ask(&Request::bare(Word::Mpst)).await
}

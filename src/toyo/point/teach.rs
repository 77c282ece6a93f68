//! Command `toyo teach`: stores the current position as a point. `point set 5 here` and `point teach 5` are aliases.

use super::{AXES, Points, TaskOptions, parse_point};
use crate::eeprom_tables::EepromRow as _;
use crate::field_values::Changes;
use crate::position::{Coordinates, UNIT};
use crate::prelude::*;
use armctl_controller::toyo::table::Command as Word;
use armctl_frame::gate::data_changed;
use armctl_frame::store::{Store as _, Writable as _, describe_change};
use armctl_frame::teach::TeachReport;

/// Store the current position as a point, and read it back.
#[derive(Debug, Args)]
#[command(
    after_help = "The command stores the position of `toyo position`, with servo power on or off. The axes must have \
                  returned to the origin before. `toyo point set 5 here` and `toyo point teach 5` are the same."
)]
pub struct Teach {
    /// Row of the coordinate table, 1 to 999, or the name of a point
    #[arg(value_name = "POINT", value_parser = parse_point, add = complete::POINT)]
    point: i32,
    #[command(flatten)]
    options: TaskOptions,
}

/// Formats a position for messages.
fn position_text(coordinates: &Coordinates) -> String {
    format!("{} (mm)", coordinates.in_a_line())
}

impl Command for Teach {
    type Family = Toyo;
    type Report = TeachReport;
    const ID: &'static str = "toyo.teach";
    const RISK: Risk = Risk::Destroy;
    const INTENT: &'static str = "overwrite a point";
    const CONFIRMATION: Confirmation = Confirmation::WhenKnown;

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Self::Report> {
        if context.link.status_of(&[0]).await.known()?.is_some_and(|status| !status.homed()) {
            return Err(Failure::new(
                Kind::ConditionNotMet,
                "the return to origin is not complete, so the position is unknown",
            )
            .hint("use `toyo home` first; nothing was stored"));
        }
        let mut points = Points::of_task(context.link, self.options.task).await?;
        points.select(context.link).await?;
        let link = &mut *context.link;
        let taught = self.teach(Context { link, ..context }, &points).await;
        points.deselect(context.link, taught).await
    }
}

impl Teach {
    async fn teach(&self, context: Context<'_, Toyo>, points: &Points) -> Result<TeachReport> {
        let Context { link, screen, confirmer, .. } = context;
        let point = self.point;
        let current = read_position(link).await.known()?;
        let stored = link.ask(&points.request(point)?).await.known()?;
        let Some((current, stored)) = current.zip(stored) else {
            points.plan(link, &[(point, Changes::of(vec![None; AXES]))]).await?;
            return Err(unknown());
        };
        let coordinates = Coordinates::of(&current, points.letters);
        let old = Coordinates::of(&stored, points.letters);
        let axes = ["x", "y", "z", "r"].map(|axis| Value::Number(current.number(axis).unwrap_or_default()));
        let new = points.cell(point, axes.into())?.wanted;
        let needs_confirmation = confirmer.asks_user();
        let change = describe_change(points, &[(point, Some(&stored), &new)]);
        confirmer.confirm(&change).await?;
        if needs_confirmation {
            let moved_to = Coordinates::of(&read_position(link).await?, points.letters);
            if moved_to != coordinates {
                let message = format!("the axes moved after the confirmation, to {}", position_text(&moved_to));
                return Err(data_changed(format!("{message}; nothing was stored")));
            }
        }
        let is_stored = stored == new;
        if !is_stored {
            points.write(link, screen, &[(point, Some(&stored), &new)]).await?;
        }
        // The position was written and read back.
        let name = point.to_string();
        let taught =
            TeachReport::new(name, Some(old.position()), coordinates.position(), coordinates.position().of_group(UNIT));
        Ok(taught.unchanged(is_stored).with("point", point).with("task", points.task))
    }
}

/// Reads the position of the axes.
async fn read_position(link: &mut Link) -> Result<Record> {
    link.ask(&Request::bare(Word::Mpst)).await
}

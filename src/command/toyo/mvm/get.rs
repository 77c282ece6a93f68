//! `toyo mvm get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Group, SHEETS, field, reads};
use crate::command::toyo::items::{self, Item, read_each};
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::Numbers;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::failure::Failure;
use crate::output::view::View;

/// Which groups.
#[derive(Debug, Args)]
pub struct Get {
    /// Groups and ranges of them, 1 to 32; without any, all
    #[arg(value_name = "GROUP", value_delimiter = ',', value_parser = |text: &str| Numbers::parse(&field(), text))]
    groups: Vec<Numbers>,
}

impl Command for Get {
    type Family = Toyo;
    type Report = Groups;
    const ID: &'static str = "toyo.mvm.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Groups, Failure> {
        let groups = Numbers::of(&self.groups, &field());
        let requests = groups.iter().copied().map(reads).collect::<Result<Vec<Vec<Request>>, Failure>>()?.concat();
        let sheets = read_each(context.link, context.screen, "reading sheets", &requests).await?;
        let items = groups.iter().zip(sheets.chunks(SHEETS.len())).map(|(group, sheets)| item(*group, sheets));
        Ok(Groups { groups: items.collect() })
    }
}

/// A group by its sheets; the first that was refused, or holds what the manual does not list, tells of the whole.
fn item(group: i32, sheets: &[Result<Record, Failure>]) -> Item<Group> {
    let odd = sheets.iter().find(|sheet| sheet.is_err());
    let odd = odd.or_else(|| sheets.iter().find(|sheet| sheet.as_ref().is_ok_and(|sheet| !sheet.is_listed())));
    let all: Vec<Record> = sheets.iter().flatten().cloned().collect();
    match odd.or(sheets.first()) {
        Some(answer) => Item::of("group", group, answer, |_| Group::of(&all)),
        None => Item::Answered { ok: true, value: Group::of(&all) },
    }
}

/// Groups of the MVM table.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Groups {
    groups: Vec<Item<Group>>,
}

impl Report for Groups {
    fn view(&self) -> View {
        match &self.groups[..] {
            [Item::Answered { value, .. }] => View { sections: vec![value.fields()] },
            groups => Group::table(groups),
        }
    }

    fn failure(&self) -> Option<Failure> {
        items::failure_of(&self.groups)
    }
}

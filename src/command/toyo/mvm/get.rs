//! `toyo mvm get`.

use clap::Args;

use super::{Group, SHEETS, columns, field, item, reads};
use crate::command::robot::item::Items;
use crate::command::toyo::items::read_each;
use crate::command::toyo::link::Toyo;
use crate::command::toyo::numbers::Numbers;
use crate::command::toyo::rows::Listed;
use crate::command::{Command, Context};
use crate::controller::toyo::request::Request;
use crate::failure::Failure;

/// Which groups.
#[derive(Debug, Args)]
pub struct Get {
    /// Groups and ranges of them, 1 to 32; without any, all
    #[arg(value_name = "GROUP", value_delimiter = ',', value_parser = |text: &str| Numbers::parse(&field(), text))]
    groups: Vec<Numbers>,
}

impl Command for Get {
    type Family = Toyo;
    type Report = Items<Group, Listed>;
    const ID: &'static str = "toyo.mvm.get";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Items<Group, Listed>, Failure> {
        let groups = Numbers::of(&self.groups, &field());
        let requests = groups.iter().copied().map(reads).collect::<Result<Vec<Vec<Request>>, Failure>>()?.concat();
        let sheets = read_each(context.link, context.screen, "reading sheets", &requests).await?;
        let items = groups.iter().zip(sheets.chunks(SHEETS.len())).map(|(group, sheets)| item(*group, sheets));
        Ok(Items::new(columns(), items.collect()))
    }
}

//! `toyo mvm get`.

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::{Group, SHEETS, field, reads};
use crate::command::toyo::Family;
use crate::command::toyo::numbers::{Numbers, read_contents};
use crate::command::{Command, Context, Report};
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
    type Family = Family;
    type Report = Groups;
    const ID: &'static str = "toyo.mvm.get";

    async fn run(&self, context: Context<'_, Family>) -> Result<Groups, Failure> {
        let groups = Numbers::of(&self.groups, &field());
        let requests = groups.into_iter().map(reads).collect::<Result<Vec<Vec<Request>>, Failure>>()?.concat();
        let sheets = read_contents(context.link, context.screen, "reading sheets", &requests).await?;
        Ok(Groups { groups: sheets.chunks(SHEETS.len()).map(Group::of).collect() })
    }
}

/// Groups of the MVM table.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Groups {
    groups: Vec<Group>,
}

impl Report for Groups {
    fn view(&self) -> View {
        match &self.groups[..] {
            [group] => View { sections: vec![group.fields()] },
            groups => Group::table(groups),
        }
    }
}

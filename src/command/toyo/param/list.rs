//! `toyo param list`.

use clap::{Args, ValueEnum};
use schemars::JsonSchema;
use serde::Serialize;

use super::entry::{self, Entry};
use super::singles;
use crate::command::toyo::items;
use crate::command::toyo::link::Toyo;
use crate::command::{Command, Context, Report};
use crate::controller::toyo::table::{Group, Parameter};
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::View;

/// Which groups.
#[derive(Debug, Args)]
pub struct List {
    /// Only these
    #[arg(long, value_name = "GROUP")]
    group: Option<GroupArg>,
}

/// A group of parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum GroupArg {
    /// M: how the controller is used
    Mode,
    /// P, parameter 1: axes
    Axis,
    /// E, parameter 2: the machine
    Machine,
    /// U, parameter 3: not for normal use
    Special,
}

impl GroupArg {
    /// The group that it names.
    pub fn group(self) -> Group {
        match self {
            Self::Mode => Group::Mode,
            Self::Axis => Group::Axis,
            Self::Machine => Group::Machine,
            Self::Special => Group::Special,
        }
    }
}

impl Command for List {
    type Family = Toyo;
    type Report = Listing;
    const ID: &'static str = "toyo.param.list";

    async fn run(&self, context: Context<'_, Toyo>) -> Result<Listing, Failure> {
        let is_wanted = |parameter: &&Parameter| self.group.is_none_or(|group| group.group() == parameter.group());
        let wanted: Vec<&'static Parameter> = singles().filter(is_wanted).collect();
        let parameters = entry::read_all(context.link, context.screen, &wanted).await?;
        let refused = parameters.iter().filter(|entry| entry.refused).count();
        Ok(Listing { items: parameters, refused })
    }
}

/// All parameters of a controller.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Listing {
    items: Vec<Entry>,
    /// How many of them the controller refuses.
    refused: usize,
}

impl Report for Listing {
    fn rows(&self) -> RowsOf {
        RowsOf::List("items")
    }

    fn view(&self) -> View {
        View::table(Entry::table(&self.items))
    }

    /// That a controller does not have all parameters there are is no failure.
    fn failure(&self) -> Option<Failure> {
        let errors = self.items.iter().map(|entry| entry.error.as_ref().filter(|_| !entry.refused));
        items::failure(self.items.len(), errors)
    }
}

//! `yerc file list` (FS and DX 3.4.4).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::name::{Shown, TypeArg, type_word, word_of};
use super::transfer;
use crate::command::backup;
use crate::command::frame::items;
use crate::command::frame::items::ItemError;
use crate::command::yerc::link::Yerc;
use crate::command::{Command, Context, Report};
use crate::controller::yerc::files;
use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::{Cell, Table, View};

/// Lists the files on the controller.
#[derive(Debug, Args)]
pub struct List {
    /// File types, such as jbi,dat
    #[arg(long = "type", value_name = "TYPE", value_delimiter = ',', ignore_case = true, default_value = "jbi")]
    types: Vec<TypeArg>,
    /// Raw filter to send instead, such as '', '*.*' or '*.JBI'
    #[arg(long, value_name = "FILTER", conflicts_with = "types", value_parser = filter)]
    filter: Option<String>,
}

fn filter(text: &str) -> Result<String, String> {
    files::list_by(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

impl Command for List {
    type Family = Yerc;
    type Report = Listing;
    const ID: &'static str = "yerc.file.list";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Listing, Failure> {
        let Context { link, screen, .. } = context;
        let filters = match &self.filter {
            Some(filter) => vec![(filter.clone(), None)],
            None => TypeArg::chosen(&self.types).into_iter().map(|kind| (kind.filter(), Some(kind))).collect(),
        };
        let requests = filters.iter().map(|(filter, _)| files::list_by(filter));
        let requests: Vec<_> = requests.collect::<Result<_, _>>().map_err(|error| {
            Failure::usage(error.to_string()).hint("a filter looks like *.JBI; remove --filter to list jobs")
        })?;
        if link.is_dry() {
            transfer::plan_all(link, transfer::LISTS, requests)?;
            return Ok(Listing::default());
        }
        let mut listing = Listing { asked: filters.len(), ..Listing::default() };
        // The file service may still be busy with an aborted transfer of another client.
        let _looking = screen.spinner("looking for files");
        for ((filter, kind), request) in filters.iter().zip(&requests) {
            match transfer::list_by(link, request).await {
                Ok(names) => listing.files.extend(names.iter().map(|name| Listed {
                    name: Shown::new(link.encoding, name),
                    file_type: word_of(name).or(kind.map(type_word)),
                })),
                // A controller may list jobs but refuse to list parameters.
                Err(failure) if backup::goes_on(&failure) && listing.asked > 1 => {
                    let error = ItemError::new(filter.as_str(), failure);
                    listing.refused.push(RefusedList { file_type: kind.map(type_word), error });
                }
                Err(failure) => return Err(transfer::about(&shown(filter), failure)),
            }
        }
        Ok(listing)
    }
}

/// Text of a filter.
fn shown(filter: &str) -> String {
    if filter.is_empty() { "the empty filter".to_owned() } else { filter.to_owned() }
}

/// Files on the controller.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Listing {
    /// In the order of the controller, one type after the other.
    files: Vec<Listed>,
    /// Types that could not be listed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    refused: Vec<RefusedList>,
    #[serde(skip)]
    asked: usize,
}

/// A file.
#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    #[serde(flatten)]
    name: Shown,
    /// `jbi`, `dat`, `cnd`, `prm`, `sys` or `lst`; null for any other extension.
    #[serde(rename = "type")]
    file_type: Option<&'static str>,
}

/// A type that could not be listed.
#[derive(Debug, Serialize, JsonSchema)]
struct RefusedList {
    #[serde(rename = "type")]
    file_type: Option<&'static str>,
    error: ItemError,
}

impl Report for Listing {
    fn rows(&self) -> RowsOf {
        RowsOf::List("files")
    }

    fn view(&self) -> View {
        let mut table = Table::new(&["name", "type"], "no files of this type");
        for file in &self.files {
            table.row([file.name.name.as_str().into(), Cell::maybe(file.file_type)]);
        }
        for list in &self.refused {
            table.row([list.error.cell(), Cell::maybe(list.file_type)]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        items::verdict(self.asked, self.refused.iter().map(|list| &list.error))
    }
}

//! `yerc file list` (FS and DX 3.4.4).

use clap::Args;
use schemars::JsonSchema;
use serde::Serialize;

use super::name::{Shown, TypeArg, type_word};
use super::transfer;
use crate::command::yerc::Family;
use crate::command::{Command, Context, Report};
use crate::controller::yerc::files::{self, FileType};
use crate::failure::{Failure, Kind};
use crate::output::view::{Cell, Table, Tone, View};

/// Lists the files on the controller.
#[derive(Debug, Args)]
pub struct List {
    /// Which types, such as jbi,dat
    #[arg(long = "type", value_name = "TYPE", value_delimiter = ',', ignore_case = true, default_value = "jbi")]
    types: Vec<TypeArg>,
}

impl Command for List {
    type Family = Family;
    type Report = Listing;
    const ID: &'static str = "yerc.file.list";

    async fn run(&self, context: Context<'_, Family>) -> Result<Listing, Failure> {
        let Context { link, screen, .. } = context;
        let types = TypeArg::chosen(&self.types);
        if link.is_dry() {
            transfer::foresee_all(link, types.iter().map(|kind| files::list(*kind)));
            return Ok(Listing::default());
        }
        let mut listing = Listing::default();
        // The file service may be busy with what somebody else broke off.
        let _looking = screen.spinner("looking for files");
        for kind in &types {
            let listed = transfer::list(link, *kind).await;
            match listed.map_err(|failure| transfer::about(&kind.filter(), failure)) {
                Ok(names) => listing.files.extend(names.iter().map(|name| Listed {
                    name: Shown::new(link.encoding, name),
                    file_type: type_word(FileType::of(name).unwrap_or(*kind)),
                })),
                // A controller may show jobs to everybody and parameters to nobody.
                Err(failure) if failure.kind == Kind::Refused && types.len() > 1 => {
                    listing.refused.push(RefusedList { file_type: type_word(*kind), error: failure });
                }
                Err(failure) => return Err(failure),
            }
        }
        Ok(listing)
    }
}

/// Files on the controller.
#[derive(Debug, Default, Serialize, JsonSchema)]
pub struct Listing {
    /// In the order of the controller, type by type.
    files: Vec<Listed>,
    /// Types that the controller refused to list.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    refused: Vec<RefusedList>,
}

/// One file.
#[derive(Debug, Serialize, JsonSchema)]
struct Listed {
    #[serde(flatten)]
    name: Shown,
    /// `jbi`, `dat`, `cnd`, `prm`, `sys` or `lst`.
    #[serde(rename = "type")]
    file_type: &'static str,
}

/// One type that could not be listed.
#[derive(Debug, Serialize, JsonSchema)]
struct RefusedList {
    #[serde(rename = "type")]
    file_type: &'static str,
    error: Failure,
}

impl Report for Listing {
    fn view(&self) -> View {
        let mut table = Table::new(&["name", "type"], "no files of this type");
        for file in &self.files {
            table.row([file.name.name.as_str().into(), file.file_type.into()]);
        }
        for list in &self.refused {
            table.row([Cell::from("(refused)").tone(Tone::Bad), list.file_type.into()]);
        }
        View::table(table)
    }

    fn failure(&self) -> Option<Failure> {
        let first = &self.refused.first()?.error;
        let message = match self.refused.len() {
            1 => first.message.clone(),
            more => format!("{more} types were refused: {}", first.message),
        };
        Some(Failure { message, ..first.clone() })
    }
}

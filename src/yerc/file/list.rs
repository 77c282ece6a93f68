//! `yerc file list` (FS and DX 3.4.4).

use super::name::{ReportedName, TypeArg, name_of_type, type_word};
use super::transfer;
use crate::prelude::*;
use armctl_controller::yerc::files;
use armctl_frame::backup;
use armctl_frame::items::ItemError;
use armctl_frame::robot::file::{FileItem, Files};

/// Lists the files on the controller.
#[derive(Debug, Args)]
pub struct List {
    /// File types, for example jbi,dat
    #[arg(long = "type", value_name = "TYPE", value_delimiter = ',', ignore_case = true, default_value = "jbi")]
    types: Vec<TypeArg>,
    /// Raw filter to send instead of the types, such as '', '*.*' or '*.JBI'
    #[arg(long, value_name = "FILTER", conflicts_with = "types", value_parser = filter)]
    filter: Option<String>,
}

fn filter(text: &str) -> Result<String, String> {
    files::list_by(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

impl Command for List {
    type Family = Yerc;
    type Report = Files<Listed>;
    const ID: &'static str = "yerc.file.list";

    async fn run(&self, context: Context<'_, Yerc>) -> Result<Files<Listed>> {
        let Context { link, screen, .. } = context;
        let filters = match &self.filter {
            Some(filter) => vec![(filter.clone(), None)],
            None => TypeArg::selected_types(&self.types).into_iter().map(|kind| (kind.filter(), Some(kind))).collect(),
        };
        let requests = filters.iter().map(|(filter, _)| files::list_by(filter));
        let requests: Vec<_> = requests.collect::<Result<_, _>>().map_err(|error| {
            Failure::usage(error.to_string()).hint("type a filter such as *.JBI, or remove --filter to list jobs")
        })?;
        if link.is_dry_run() {
            transfer::plan_all(link, transfer::LISTS, requests)?;
            return Ok(Files::new(Vec::new(), table));
        }
        let mut listed = Vec::new();
        // The file service may still be busy with a transfer that another client aborted.
        let _looking = screen.spinner("looking for files");
        for ((filter, kind), request) in filters.iter().zip(&requests) {
            match transfer::list_by(link, request).await {
                Ok(names) => listed.extend(names.iter().map(|bytes| {
                    let ReportedName { name, name_hex } = ReportedName::new(link.encoding, bytes);
                    let file_type = name_of_type(bytes).or(kind.map(type_word));
                    FileItem::new(name, Listed { name_hex, file_type }, Ok(()))
                })),
                // A controller may list its jobs, but refuse to list its parameters.
                Err(failure) if backup::continues_after(&failure) && filters.len() > 1 => {
                    let more = Listed { name_hex: None, file_type: kind.map(type_word) };
                    listed.push(FileItem::new(filter, more, Err(failure)));
                }
                Err(failure) => return Err(transfer::describe_request(&shown(filter), failure)),
            }
        }
        Ok(Files::new(listed, table).asked(filters.len()))
    }
}

/// Filter as displayed text.
fn shown(filter: &str) -> String {
    if filter.is_empty() { "the empty filter".to_owned() } else { filter.to_owned() }
}

/// Fields of a listed file, or of a type that could not be listed. The name of such a type is its filter.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Listed {
    /// Bytes of the name, if the text cannot be converted back to these bytes. To use them as an argument, add the
    /// prefix `hex:`.
    name_hex: Option<String>,
    /// Type: `jbi`, `dat`, `cnd`, `prm`, `sys` or `lst`; null for any other extension.
    #[serde(rename = "type")]
    file_type: Option<&'static str>,
}

fn table(files: &[FileItem<Listed>]) -> View {
    let mut table = Table::new(&["name", "type", "error"], "no files of this type");
    for file in files {
        let error = file.error.as_ref().map(ItemError::cell);
        table.row([file.name.as_str().into(), Cell::optional(file.more.file_type), Cell::optional(error)]);
    }
    View::table(table.without_blank("error"))
}

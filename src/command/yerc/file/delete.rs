//! `yerc file delete` (FS and DX 3.4.1).

use clap::Args;

use super::name::{self, Shown};
use super::results::{FileResult, Results, Shape};
use super::transfer;
use crate::command::ValueKind;
use crate::command::yerc::Family;
use crate::command::{Command, Context};
use crate::controller::Risk;
use crate::controller::yerc::files::FileName;
use crate::failure::Failure;

/// Deletes files on the controller.
#[derive(Debug, Args)]
pub struct Delete {
    /// Names in full, such as TESTJOB.JBI
    #[arg(required = true, value_name = "NAME", add = ValueKind::YercFile)]
    names: Vec<String>,
}

const SHAPE: Shape = Shape { done: "deleted", has_paths: false, has_bytes: false };

impl Command for Delete {
    type Family = Family;
    type Report = Results;
    const ID: &'static str = "yerc.file.delete";

    fn risk(&self) -> Risk {
        Risk::Destroy
    }

    fn intent(&self) -> String {
        "delete files".to_owned()
    }

    async fn run(&self, context: Context<'_, Family>) -> Result<Results, Failure> {
        let Context { link, .. } = context;
        let files = name::all_typed(link.encoding, &self.names)?;
        let pending = |file: &FileName| FileResult::pending(Shown::new(link.encoding, file.as_bytes()), None);
        let mut results: Vec<FileResult> = files.iter().map(pending).collect();
        if link.is_dry() {
            transfer::foresee_all(link, files.iter().map(FileName::delete));
            return Ok(Results::new(results, SHAPE));
        }
        for (file, result) in files.iter().zip(&mut results) {
            let outcome = transfer::remove(link, file).await;
            if !result.settle(outcome.map(|()| None)) {
                break;
            }
        }
        Results::new(results, SHAPE).report()
    }
}

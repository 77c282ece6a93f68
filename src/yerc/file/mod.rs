//! `yerc file`: jobs and data files of the controller.

mod backup;
mod cmos;
mod compare;
mod content;
mod delete;
mod diff;
mod edit;
mod existence;
mod get;
mod list;
mod manifest;
mod name;
mod pattern;
mod put;
mod read;
mod restore;
mod transfer;
pub mod twin;
mod upload;

pub use backup::back_up;
pub(super) use content::job_form;
pub use edit::Edit;
pub(super) use manifest::Manifest;
pub(super) use name::{ReportedName, exact};
pub(super) use read::{FileReading, read_files};
pub use restore::Restore;
pub(super) use transfer::{LISTS, fetch, fetch_listed, list, name_taken as download_failed, plan_all};

use armctl_frame::commands;

commands! {
    /// Commands for files.
    pub enum File {
        /// List the files on the controller
        List(list::List),
        /// Download files from the controller
        Get(get::Get),
        /// Upload files to the controller
        Put(put::Put),
        /// Delete files on the controller
        Delete(delete::Delete),
        /// Compare a file on the controller with a local file
        Diff(diff::Diff),
        /// Create the batch backup CMOSBK.BIN on the controller and download it
        Cmos(cmos::Cmos),
    }
}

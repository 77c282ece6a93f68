//! `toyo program`: sequential programs as files and step by step.

mod calls;
mod check;
mod copy;
mod delete;
mod diff;
mod edit;
mod folder;
mod get;
mod insert;
mod list;
mod path;
mod put;
mod robot_data;
mod search;
mod show;
pub mod source_texts;
pub mod steps;
pub mod table;
#[cfg(test)]
mod tests;
pub mod text;

use armctl_frame::commands;
use armctl_frame::path::Drawable;

commands! {
    /// Commands for sequential programs.
    pub enum Program {
        /// List the tasks, with their used and available steps
        List(list::List),
        /// Read a program as text
        Get(get::Get),
        /// Check a program file and write the program
        Put(put::Put),
        /// Compare a program in the controller with a file
        Diff(diff::Diff),
        /// Edit a program in your editor, and write it back
        Edit(edit::Edit),
        /// Insert a step; later steps move down by one step
        Insert(insert::Insert),
        /// Delete steps; later steps move up
        Delete(delete::Delete),
        /// Copy steps, also between tasks
        Copy(copy::Copy),
        /// Find lines of programs, or the step of a tag
        Search(search::Search),
        /// Show the subroutines and tasks that programs call
        Calls(calls::Calls),
        /// Show the current step of the program; with --path, the motion of a program
        Show(Drawable<show::Show, path::ProgramPath>),
        /// Check programs of files, a folder or the controller
        Check(check::Check),
    }
}

/// Adds to a help text that a command selects program mode temporarily to write steps.
fn and_mode(text: &str) -> String {
    format!("{text}\n\n{MODE}")
}

const MODE: &str = "armctl writes steps in program mode, as in the sample session of the manual (TO 3-1). If the \
                    controller is in automatic or step mode, armctl selects program mode for the write, and the \
                    earlier mode afterwards. While a program runs or is paused, armctl writes nothing. armctl does \
                    not write a step that is already stored, because an EEPROM cell wears out after about a million \
                    writes.";

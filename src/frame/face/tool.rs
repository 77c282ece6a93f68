//! Family tools: `armctl decode FAMILY`, `explain FAMILY`, `sim FAMILY`.

use clap::{ArgMatches, Args, Command, FromArgMatches as _};
use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::explain::{CodeExplanation, Explain, explain};
use super::registration::Declaration;
use crate::SchemaEntry;
use crate::decode::{self, Decode};
use crate::run::{Run, RunError};
use crate::serve::{self, Serve};

/// Kinds of tools.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ToolKind {
    /// `armctl decode`.
    Decode,
    /// `armctl explain`.
    Explain,
    /// `armctl sim`.
    Simulate,
}

impl ToolKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::Decode, Self::Explain, Self::Simulate];
}

/// A tool of a family with its arguments.
#[derive(Clone, Copy)]
pub struct Tool {
    /// Arguments.
    pub augment: fn(Command) -> Command,
    /// Parser of the arguments.
    pub read: fn(&mut ArgMatches) -> Result<ToolTask, clap::Error>,
    /// Schemas of the tool's reports.
    pub schemas: fn() -> Vec<SchemaEntry>,
}

/// A tool with its parsed arguments.
pub type ToolTask = Box<dyn FnOnce(&Run) -> LocalBoxFuture<'_, Result<(), RunError>>>;

impl Tool {
    /// Decodes bytes or a capture file.
    pub fn decode<D: Decode + Args + 'static>() -> Self {
        Self {
            augment: D::augment_args,
            read: |matches| {
                let arguments = D::from_arg_matches_mut(matches)?;
                Ok(Box::new(move |run| async move { decode::run(&arguments, run) }.boxed_local()))
            },
            schemas: || decode::schemas::<D>().into(),
        }
    }

    /// Explains a code.
    pub fn explain<F: Declaration>() -> Self {
        Self {
            augment: F::Explain::augment_args,
            read: |matches| {
                let code = F::Explain::from_arg_matches_mut(matches)?;
                Ok(Box::new(move |run| explain::<F>(code, run).boxed_local()))
            },
            schemas: || vec![SchemaEntry::of::<CodeExplanation<<F::Explain as Explain>::Report>>(F::Explain::ID)],
        }
    }

    /// Serves a simulator.
    pub fn simulate<S: Serve + Args + 'static>() -> Self {
        Self {
            augment: S::augment_args,
            read: |matches| {
                let arguments = S::from_arg_matches_mut(matches)?;
                Ok(Box::new(move |run| serve::run(arguments, run).boxed_local()))
            },
            schemas: || vec![serve::schema::<S>()],
        }
    }
}

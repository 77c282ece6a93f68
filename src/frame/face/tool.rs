//! Family tools: `armctl decode FAMILY`, `explain FAMILY`, `sim FAMILY`.

use clap::{ArgMatches, Args, Command, FromArgMatches as _};
use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::explain::{CodeExplanation, Explain, Explaining};
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
    pub read: fn(&mut ArgMatches) -> Result<Box<dyn ToolTask>, clap::Error>,
    /// Schemas of the tool's reports.
    pub schemas: fn() -> Vec<SchemaEntry>,
}

/// Parsed arguments of a tool.
pub trait ToolTask: 'static {
    /// Runs the tool.
    fn run(self: Box<Self>, run: &Run) -> LocalBoxFuture<'_, Result<(), RunError>>;
}

impl Tool {
    /// Decodes bytes or a capture file.
    pub fn decode<D: Decode + Args + 'static>() -> Self {
        Self {
            augment: D::augment_args,
            read: |matches| Ok(Box::new(Decoding(D::from_arg_matches_mut(matches)?))),
            schemas: || decode::schemas::<D>().into(),
        }
    }

    /// Explains a code.
    pub fn explain<F: Declaration>() -> Self {
        Self {
            augment: F::Explain::augment_args,
            read: |matches| Ok(Box::new(Explaining::<F>(F::Explain::from_arg_matches_mut(matches)?))),
            schemas: || vec![SchemaEntry::of::<CodeExplanation<<F::Explain as Explain>::Report>>(F::Explain::ID)],
        }
    }

    /// Serves a simulator.
    pub fn simulate<S: Serve + Args + 'static>() -> Self {
        Self {
            augment: S::augment_args,
            read: |matches| Ok(Box::new(Serving(S::from_arg_matches_mut(matches)?))),
            schemas: || vec![serve::schema::<S>()],
        }
    }
}

struct Decoding<D>(D);
struct Serving<S>(S);

impl<D: Decode + 'static> ToolTask for Decoding<D> {
    fn run(self: Box<Self>, run: &Run) -> LocalBoxFuture<'_, Result<(), RunError>> {
        async move { decode::run(&self.0, run) }.boxed_local()
    }
}

impl<S: Serve + 'static> ToolTask for Serving<S> {
    fn run(self: Box<Self>, run: &Run) -> LocalBoxFuture<'_, Result<(), RunError>> {
        async move { serve::run(self.0, run).await }.boxed_local()
    }
}

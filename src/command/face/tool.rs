//! What a family does behind a common word: `armctl decode FAMILY`, `explain FAMILY`, `sim FAMILY`.

use clap::{ArgMatches, Args, Command, FromArgMatches as _};
use futures_util::FutureExt as _;
use futures_util::future::LocalBoxFuture;

use super::declared::Declaration;
use super::explain::{Explain, Explained, Explaining};
use crate::command::SchemaEntry;
use crate::command::decode::{self, Decode};
use crate::command::frame::run::{Run, RunError};
use crate::command::serve::{self, Serve};

/// Which of them.
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
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Decode, Self::Explain, Self::Simulate];
}

/// What a family does behind such a word, and with which arguments.
#[derive(Clone, Copy)]
pub struct Tool {
    /// The arguments.
    pub augment: fn(Command) -> Command,
    /// What was typed.
    pub read: fn(&mut ArgMatches) -> Result<Box<dyn ToolTask>, clap::Error>,
    /// The schemas of what it reports.
    pub schemas: fn() -> Vec<SchemaEntry>,
}

/// What was typed behind such a word.
pub trait ToolTask: 'static {
    /// Does it.
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
            schemas: || vec![SchemaEntry::of::<Explained<<F::Explain as Explain>::Report>>(F::Explain::ID)],
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

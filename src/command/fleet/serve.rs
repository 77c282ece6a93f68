//! `armctl serve`: robot data for other programs.

use clap::Subcommand;

use super::metrics::Metrics;
use armctl_frame::run::{Run, RunError};

/// Servers.
#[derive(Debug, Subcommand)]
pub enum Serve {
    /// Metrics for Prometheus, over HTTP
    Metrics(Metrics),
}

impl Serve {
    /// Runs the command.
    pub async fn run(self, run: &Run) -> Result<(), RunError> {
        match self {
            Self::Metrics(metrics) => metrics.run(run).await,
        }
    }
}

//! Names that most modules above the settings and the output use.

pub use std::collections::{BTreeMap, BTreeSet};
pub use std::fmt;
pub use std::path::{Path, PathBuf};
pub use std::sync::Arc;
pub use std::time::Duration;

pub use anyhow::Context as _;
pub use clap::{Args, ValueEnum};
pub use futures_util::FutureExt as _;
pub use futures_util::future::LocalBoxFuture;
pub use schemars::JsonSchema;
pub use serde::Serialize;
pub use serde_json::{Value, json};

pub use crate::failure::{Failure, Kind, Result};
pub use crate::gate::{Change, Confirmation};
pub use crate::output::Screen;
pub use crate::output::csv::RowsOf;
pub use crate::output::view::{Cell, Section, Table, Tone, View};
pub use crate::report::Report;
pub use crate::settings::target::Family;
pub use crate::settings::{Robot, duration};
pub use armctl_controller::similar_word::nearest;
pub use armctl_controller::{Risk, user_input};
pub use armctl_files as files;

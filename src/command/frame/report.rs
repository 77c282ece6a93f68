//! What a command found out or did.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde::Serialize;
use serde_json::Value;

use crate::failure::Failure;
use crate::output::csv::RowsOf;
use crate::output::view::View;

/// What a command found out or did.
pub trait Report: Serialize + JsonSchema {
    /// As a person reads it.
    fn view(&self) -> View;

    /// Why the report is not a success although it is whole: a difference, a condition not met, a file that failed.
    fn failure(&self) -> Option<Failure> {
        None
    }

    /// What the rows of a spreadsheet are.
    fn rows(&self) -> RowsOf {
        RowsOf::Lists
    }
}

/// A report, or why there is none.
pub type Outcome = Result<Box<dyn AnyReport>, Failure>;

/// [`Report`] without its type.
pub trait AnyReport {
    /// The `data` of the envelope.
    fn data(&self) -> Result<Value, Failure>;
    /// See [`Report::view`].
    fn view(&self) -> View;
    /// See [`Report::failure`].
    fn failure(&self) -> Option<Failure>;
    /// See [`Report::rows`].
    fn rows(&self) -> RowsOf;
    /// The schema of [`AnyReport::data`].
    fn schema(&self) -> Schema;
}

impl<R: Report> AnyReport for R {
    fn data(&self) -> Result<Value, Failure> {
        serde_json::to_value(self).map_err(|error| Failure::local(format!("report as JSON: {error}")))
    }

    fn view(&self) -> View {
        Report::view(self)
    }

    fn failure(&self) -> Option<Failure> {
        Report::failure(self)
    }

    fn rows(&self) -> RowsOf {
        Report::rows(self)
    }

    fn schema(&self) -> Schema {
        schema_of::<R>()
    }
}

/// The schema of a report as it is written.
pub fn schema_of<R: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<R>()
}

/// The schema of a report, by command.
#[derive(Debug, Clone, Copy)]
pub struct SchemaEntry {
    /// `yerc.status`.
    pub id: &'static str,
    /// Makes the schema of `data`.
    pub schema: fn() -> Schema,
}

impl SchemaEntry {
    /// The schema of a report as it is written: what may be left out is not required.
    pub fn of<R: JsonSchema>(id: &'static str) -> Self {
        Self { id, schema: schema_of::<R> }
    }
}

//! Command reports.

use schemars::Schema;
use schemars::generate::SchemaSettings;

use crate::output::csv::Sheet;
use crate::prelude::basics::*;

/// Report of a command.
pub trait Report: Serialize + JsonSchema {
    /// Which rows of the report a spreadsheet contains.
    const ROWS: RowsOf = RowsOf::Lists;

    /// View for people.
    fn view(&self) -> View;

    /// Failure that a complete report states: a difference, a condition that is not met, a failed file.
    fn failure(&self) -> Option<Failure> {
        None
    }

    /// Which rows this report has in a spreadsheet. The default is [`ROWS`](Self::ROWS).
    fn rows(&self) -> RowsOf {
        Self::ROWS
    }
}

/// A report, or a failure.
pub type Outcome = Result<Box<dyn AnyReport>>;

/// [`Report`] without its concrete type.
pub trait AnyReport {
    /// Value for `data` in the envelope.
    fn data(&self) -> Result<Value>;
    /// See [`Report::view`].
    fn view(&self) -> View;
    /// See [`Report::failure`].
    fn failure(&self) -> Option<Failure>;
    /// See [`Report::rows`].
    fn rows(&self) -> RowsOf;
    /// Schema of [`AnyReport::data`].
    fn schema(&self) -> Schema;
}

impl<R: Report> AnyReport for R {
    fn data(&self) -> Result<Value> {
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

/// Schema of a report.
pub fn schema_of<R: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12().for_serialize().into_generator().into_root_schema_for::<R>()
}

/// Spreadsheet columns of a report.
pub fn sheet_of<R: Report>() -> Sheet {
    Sheet::from_schema(&schema_of::<R>().to_value(), R::ROWS)
}

/// Schema of a report, with the name of its command.
#[derive(Debug, Clone, Copy)]
pub struct SchemaEntry {
    /// Name of the report, such as `yerc.status`.
    pub id: &'static str,
    /// Creates the schema of `data`.
    pub schema: fn() -> Schema,
}

impl SchemaEntry {
    /// Schema of a serialized report. Fields that may be omitted are not required in it.
    pub fn of<R: JsonSchema>(id: &'static str) -> Self {
        Self { id, schema: schema_of::<R> }
    }
}

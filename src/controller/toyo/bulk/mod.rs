//! Text formats of points, parameters and palletizing programs. No file access.

pub mod easy;
pub mod pallets;
pub mod parameters;
pub mod points;
mod reading;

use super::field::{Field, Form, Value};
use super::layout::LayoutProblem;
use super::request::Request;
use super::table::Parameter;

/// A value to write: a parameter, or a row of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// The parameter.
    pub parameter: &'static Parameter,
    /// All fields of [`Parameter::layout`], including the row number.
    pub values: Vec<Value>,
}

/// A setting and its line in the file, from 1.
pub type Placed = (Setting, usize);

impl Setting {
    /// Row number, for tables.
    pub fn row(&self) -> Option<i32> {
        self.parameter.row()?;
        if let Some(Value::Number(row)) = self.values.first() { Some(*row) } else { None }
    }

    /// The request that reads it.
    pub fn read(&self) -> Result<Request, LayoutProblem> {
        Request::read_parameter(self.parameter, self.row())
    }

    /// The request that writes it.
    pub fn write(&self) -> Result<Request, LayoutProblem> {
        Request::write_parameter(self.parameter, &self.values)
    }
}

/// A value without its unit.
fn plain(field: &Field, value: &Value) -> String {
    match (field.form, value) {
        (Form::Number(number), Value::Number(units)) => number.plain(*units),
        _ => field.written(value).trim_end().to_owned(),
    }
}

//! Points, parameters and palletizing programs as files: text to values and back, without files.

pub mod easy;
pub mod pallets;
pub mod parameters;
pub mod points;
mod reading;

use super::field::{Field, Form, Value};
use super::layout::LayoutProblem;
use super::request::Request;
use super::table::Parameter;

/// What a controller is to hold: a parameter, or a row of a table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Setting {
    /// Which.
    pub parameter: &'static Parameter,
    /// All fields of [`Parameter::layout`], the number of the row included.
    pub values: Vec<Value>,
}

/// A setting with the line of the file that it stands in, from 1.
pub type Placed = (Setting, usize);

impl Setting {
    /// The number of the row, for tables.
    pub fn row(&self) -> Option<i32> {
        self.parameter.row()?;
        if let Some(Value::Number(row)) = self.values.first() { Some(*row) } else { None }
    }

    /// What reads it.
    pub fn read(&self) -> Result<Request, LayoutProblem> {
        Request::read_parameter(self.parameter, self.row())
    }

    /// What writes it.
    pub fn write(&self) -> Result<Request, LayoutProblem> {
        Request::write_parameter(self.parameter, &self.values)
    }
}

/// A value as people write it, without unit.
fn plain(field: &Field, value: &Value) -> String {
    match (field.form, value) {
        (Form::Number(number), Value::Number(units)) => number.plain(*units),
        _ => field.written(value).trim_end().to_owned(),
    }
}

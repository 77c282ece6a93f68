//! Data types that are common to all families: one type per concept. JSON, schemas, CSV and tables are derived from
//! them.

pub mod alarm;
pub mod file;
pub mod io;
pub mod item;
pub mod motion;
pub mod position;
pub mod program;
pub mod state;

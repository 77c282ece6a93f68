//! What every robot has, whatever its family: one type a concept. JSON, schemas, CSV and tables of all families follow.

pub mod alarm;
pub mod io;
pub mod item;
pub mod motion;
pub mod position;
pub mod program;
pub mod state;

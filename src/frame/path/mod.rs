//! The motion of a program as a picture: on the terminal, as SVG, and as a page.
//!
//! A family converts its program or its points to a [`Motion`]. Everything else is common.

mod arguments;
mod html;
mod layout;
mod model;
mod report;
mod svg;
mod terminal;
#[cfg(test)]
mod tests;

pub use arguments::{Drawable, PathOptions, Plane};
pub use model::{Difference, Drawing, Interpolation, Moment, Motion, NotDrawn, Recorder, Step, arc, length, simplify};
pub use report::PathReport;

//! The only writer to stdout and stderr, and what makes text fit to be written there.

pub mod escape;

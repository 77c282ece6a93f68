//! Commands that are not of one family.
//!
//! | module | contents |
//! |---|---|
//! | [`families`] | the list of families |
//! | [`fleet`] | commands for robots of any family: status, top, backup, robots, session |
//! | [`about`] | commands about this program: help, man pages, schemas, completions |
//! | [`common`] | the list of these commands |

pub mod about;
pub mod common;
pub mod example_lines;
pub mod families;
pub mod fleet;
pub mod missing_verbs;

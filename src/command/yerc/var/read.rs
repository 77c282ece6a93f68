//! Reads many variables in few requests, and finds the refused variables of a refused run.

use std::collections::{HashMap, HashSet};

use crate::command::yerc::each::Outcome;
use crate::command::yerc::link::Link;
use crate::command::yerc::parts::{Parts, read_in_parts};
use crate::controller::yerc::variables::{Reference, Value, plan_reads};
use crate::failure::Failure;

/// Outcome of each variable.
pub type Answers = HashMap<Reference, Outcome<Value>>;

/// Maximum number of variables: a larger range is probably a typing error, and a refused range takes long to read in
/// parts.
const MOST: usize = 10_000;

/// Reads each of `references` once. A refused run is read again in parts, down to the refused variables: positions
/// one by one, because each can be undefined; others in halves, because valid numbers end somewhere. `progress`
/// receives the current variables and the number of variables known so far.
pub async fn read_all(
    link: &mut Link,
    references: &[Reference],
    progress: impl FnMut(&[Reference], usize),
) -> Result<Answers, Failure> {
    if references.len() > MOST {
        return Err(Failure::usage(format!("{} variables requested; the maximum is {MOST}", references.len()))
            .hint("a controller has 100 of each kind (128 positions), unless its parameters define more"));
    }
    read_whatever_told(link, references, progress).await
}

/// Like [`read_all`], without the limit, for the variables of a file.
pub async fn read_whatever(link: &mut Link, references: &[Reference]) -> Result<Answers, Failure> {
    read_whatever_told(link, references, |_, _| {}).await
}

async fn read_whatever_told(
    link: &mut Link,
    references: &[Reference],
    progress: impl FnMut(&[Reference], usize),
) -> Result<Answers, Failure> {
    let parts = |run: &[Reference]| {
        let is_position = run.first().is_some_and(|reference| reference.kind.is_position());
        if is_position { Parts::Single } else { Parts::Halves }
    };
    read_in_parts(link, |references| Ok(plan_reads(references)), references, parts, progress).await
}

/// References without duplicates, in the order of their first occurrence.
pub fn once(references: impl IntoIterator<Item = Reference>) -> Vec<Reference> {
    let mut seen = HashSet::new();
    references.into_iter().filter(|reference| seen.insert(*reference)).collect()
}

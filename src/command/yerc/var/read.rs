//! Reads many variables in few requests, and finds out which of a refused run are to blame.

use std::collections::{HashMap, HashSet};

use crate::command::yerc::each::Outcome;
use crate::command::yerc::link::Link;
use crate::command::yerc::parts::{Parts, read_in_parts};
use crate::controller::yerc::variables::{Reference, Value, plan_reads};
use crate::failure::Failure;

/// What each variable answered.
pub type Answers = HashMap<Reference, Outcome<Value>>;

/// More would be a slip of the finger: a refused range is searched for what exists, and that takes its time.
const MOST: usize = 10_000;

/// Reads each of `references` once. A run that the controller refuses is read again in parts, down to the variables
/// that are refused: positions one by one, since each may be undefined; others by halves, since numbers end somewhere.
/// `progress` is told what is asked for, and how many variables are known by then.
pub async fn read_all(
    link: &mut Link,
    references: &[Reference],
    progress: impl FnMut(&[Reference], usize),
) -> Result<Answers, Failure> {
    if references.len() > MOST {
        return Err(Failure::usage(format!(
            "these are {} variables; at most {MOST} are read at a time",
            references.len()
        ))
        .hint("a controller has 100 of a kind (128 positions) unless its parameters say more"));
    }
    read_whatever_told(link, references, progress).await
}

/// As [`read_all`], of as many as a file names.
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

/// The same references, each where it comes first.
pub fn once(references: impl IntoIterator<Item = Reference>) -> Vec<Reference> {
    let mut seen = HashSet::new();
    references.into_iter().filter(|reference| seen.insert(*reference)).collect()
}

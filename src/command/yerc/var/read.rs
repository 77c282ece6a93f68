//! Reads many variables in few requests, and finds out which of a refused run are to blame.

use std::collections::{HashMap, HashSet, VecDeque};

use crate::command::yerc::link::{Link, Refusal};
use crate::controller::yerc::variables::{Reference, Value, plan_reads};
use crate::failure::Failure;

/// What each variable answered.
pub type Answers = HashMap<Reference, Result<Value, Refusal>>;

/// More would be a slip of the finger: a refused range is searched for what exists, and that takes its time.
const MOST: usize = 10_000;

/// Reads each of `references` once. A run that the controller refuses is read again in parts, down to the variables
/// that are refused: positions one by one, since each may be undefined; others by halves, since numbers end somewhere.
/// `progress` is told what is asked for, and how many variables are known by then.
pub async fn read_all(
    link: &mut Link,
    references: &[Reference],
    mut progress: impl FnMut(&[Reference], usize),
) -> Result<Answers, Failure> {
    if references.len() > MOST {
        return Err(Failure::usage(format!(
            "these are {} variables; at most {MOST} are read at a time",
            references.len()
        ))
        .hint("a controller has 100 of a kind (128 positions) unless its parameters say more"));
    }
    let mut steps: VecDeque<_> = plan_reads(references).into();
    if link.is_dry() {
        link.ask_all(steps.make_contiguous()).await?;
    }
    let mut answers = Answers::with_capacity(references.len());
    while let Some(step) = steps.pop_front() {
        progress(step.wanted(), answers.len());
        match (link.try_ask(&step).await?, step.wanted()) {
            (Ok(values), _) => answers.extend(values.into_iter().map(|(reference, value)| (reference, Ok(value)))),
            (Err(refusal), [only]) => {
                answers.insert(*only, Err(refusal));
            }
            (Err(_), wanted) => {
                let is_position = wanted.first().is_some_and(|reference| reference.kind.is_position());
                let part = if is_position { 1 } else { wanted.len().div_ceil(2) };
                for part in wanted.chunks(part).rev() {
                    for step in plan_reads(part).into_iter().rev() {
                        steps.push_front(step);
                    }
                }
            }
        }
    }
    Ok(answers)
}

/// The same references, each where it comes first.
pub fn once(references: impl IntoIterator<Item = Reference>) -> Vec<Reference> {
    let mut seen = HashSet::new();
    references.into_iter().filter(|reference| seen.insert(*reference)).collect()
}

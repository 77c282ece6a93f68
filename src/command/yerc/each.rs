//! Several questions of one command, each with its own outcome: one refusal hides nothing that was answered.

use super::link::{Link, Refusal};
use crate::controller::yerc::query::Query;
use crate::controller::yerc::status::is_absent;
use crate::failure::{Failure, Kind};

/// Why one of several questions has no answer.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Denied {
    /// The controller said no.
    Refused(Refusal),
    /// The answer made no sense, or contact was lost.
    Failed(Failure),
}

impl Denied {
    /// Whether the controller says that there is no such thing.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::Refused(refusal) if is_absent(refusal.status))
    }
}

impl From<Denied> for Failure {
    fn from(denied: Denied) -> Self {
        match denied {
            Denied::Refused(refusal) => refusal.into(),
            Denied::Failed(failure) => failure,
        }
    }
}

/// A question's outcome.
pub type Outcome<T> = Result<T, Denied>;

/// The questions of one command, asked one after the other.
#[derive(Debug, Default)]
pub struct Round {
    /// Whether the controller has answered anything, a refusal included.
    is_heard: bool,
    /// Answers that made no sense before any did.
    nonsense: u32,
    /// Why nothing more is asked.
    lost: Option<Failure>,
}

/// So many senseless answers and no other, and it is no controller that answers.
const MOST_NONSENSE: u32 = 2;

impl Round {
    /// Asks one question. It fails as a whole only while there is nothing to show; once contact is lost, the rest is not
    /// asked.
    pub async fn ask<Q: Query>(&mut self, link: &mut Link, query: &Q) -> Result<Outcome<Q::Answer>, Failure> {
        if let Some(lost) = &self.lost {
            let message = format!("not asked: {}", lost.message);
            return Ok(Err(Denied::Failed(Failure { message, ..lost.clone() })));
        }
        match link.try_ask(query).await {
            Ok(answer) => {
                self.is_heard = true;
                Ok(answer.map_err(Denied::Refused))
            }
            Err(failure) if failure.kind == Kind::Malformed && (self.is_heard || self.nonsense + 1 < MOST_NONSENSE) => {
                self.nonsense = self.nonsense.saturating_add(1);
                Ok(Err(Denied::Failed(failure)))
            }
            Err(failure) if failure.kind == Kind::NoAnswer && self.is_heard => {
                self.lost = Some(failure.clone());
                Ok(Err(Denied::Failed(failure)))
            }
            Err(failure) => Err(failure),
        }
    }
}

impl Link {
    /// Asks several questions; each has its own outcome. A dry run notes them all.
    pub async fn ask_each<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Outcome<Q::Answer>>, Failure> {
        self.dry_run(queries)?;
        let mut round = Round::default();
        let mut outcomes = Vec::with_capacity(queries.len());
        for query in queries {
            outcomes.push(round.ask(self, query).await?);
        }
        Ok(outcomes)
    }
}

/// Asks about things that may not exist and leaves out those that do not; what was refused for another reason stays. If
/// all are refused alike, it is not about existence: the first refusal is the failure.
pub async fn existing<K, Q: Query + Copy>(
    link: &mut Link,
    questions: Vec<(K, Q)>,
) -> Result<Vec<(K, Outcome<Q::Answer>)>, Failure> {
    let (keys, queries): (Vec<K>, Vec<Q>) = questions.into_iter().unzip();
    let outcomes = link.ask_each(&queries).await?;
    of_existing(keys.into_iter().zip(outcomes)).map_err(Failure::from)
}

fn of_existing<K, A>(outcomes: impl Iterator<Item = (K, Outcome<A>)>) -> Result<Vec<(K, Outcome<A>)>, Denied> {
    let mut found = Vec::new();
    let mut denied = None;
    let mut is_any = false;
    for (key, outcome) in outcomes {
        is_any |= outcome.is_ok();
        match outcome {
            Err(why) if why.is_absent() => denied = denied.or(Some(why)),
            outcome => found.push((key, outcome)),
        }
    }
    if is_any {
        return Ok(found);
    }
    let refused = found.into_iter().find_map(|(_, outcome)| outcome.err());
    refused.or(denied).map_or(Ok(Vec::new()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::yerc::link::Asked;
    use crate::controller::yerc::wire::Status;

    #[test]
    fn what_is_absent_is_left_out_unless_everything_is_refused() {
        let no = |code| {
            let to = Asked::Robot { command: 0x74, instance: 2 };
            Err(Denied::Refused(Refusal { status: Status::refused(code), to }))
        };
        let found = of_existing([(1, no(0xA001)), (2, Ok("x")), (3, no(0x2150)), (4, no(0xA001))].into_iter());
        assert_eq!(found, Ok(vec![(2, Ok("x")), (3, no(0x2150))]));
        let none = of_existing::<i32, &str>([(1, no(0xA001)), (2, no(0x2100))].into_iter());
        assert_eq!(none.map_err(Err), Err(no(0x2100)));
    }
}

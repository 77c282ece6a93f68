//! Several questions, each with its own outcome: one refusal hides nothing that was answered.

use armctl_controller::yerc::query::Query;
use armctl_controller::yerc::status::is_absent;

use super::{Client, Error, Refusal};

/// Why one of several questions has no answer. `E` is how errors are told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Denied<E = Error> {
    /// The controller said no.
    Refused(Refusal),
    /// The answer made no sense, or contact was lost.
    Failed(E),
    /// Contact was lost before, by this.
    NotAsked(E),
}

/// A question's outcome.
pub type Outcome<T, E = Error> = Result<T, Denied<E>>;

impl<E> Denied<E> {
    /// Whether the controller says that there is no such thing.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::Refused(refusal) if is_absent(refusal.status))
    }

    /// The same with the error told in another way.
    pub fn map<F>(self, tell: impl FnOnce(E) -> F) -> Denied<F> {
        match self {
            Self::Refused(refusal) => Denied::Refused(refusal),
            Self::Failed(error) => Denied::Failed(tell(error)),
            Self::NotAsked(error) => Denied::NotAsked(tell(error)),
        }
    }
}

/// Several questions, asked one after the other ([`Client::ask_in`]).
#[derive(Debug, Default)]
pub struct Round {
    /// Whether the controller has answered anything, a refusal included.
    is_heard: bool,
    /// Answers that made no sense before any did.
    nonsense: u32,
    /// Why nothing more is asked.
    lost: Option<Error>,
}

/// So many senseless answers and no other, and it is no controller that answers.
const MOST_NONSENSE: u32 = 2;

impl Client {
    /// Asks one question of several. It fails as a whole only while there is nothing to show; once contact is lost, the
    /// rest is not asked.
    pub async fn ask_in<Q: Query>(&mut self, round: &mut Round, query: &Q) -> Result<Outcome<Q::Answer>, Error> {
        if let Some(lost) = &round.lost {
            return Ok(Err(Denied::NotAsked(lost.clone())));
        }
        match self.try_ask(query).await {
            Ok(answer) => {
                round.is_heard = true;
                Ok(answer.map_err(Denied::Refused))
            }
            Err(error) if error.is_malformed() && (round.is_heard || round.nonsense + 1 < MOST_NONSENSE) => {
                round.nonsense = round.nonsense.saturating_add(1);
                Ok(Err(Denied::Failed(error)))
            }
            Err(error) if error.is_silence() && round.is_heard => {
                round.lost = Some(error.clone());
                Ok(Err(Denied::Failed(error)))
            }
            Err(error) => Err(error),
        }
    }

    /// Asks several questions; each has its own outcome. A dry run notes them all.
    pub async fn ask_each<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Outcome<Q::Answer>>, Error> {
        self.plan_all(queries)?;
        let mut round = Round::default();
        let mut outcomes = Vec::with_capacity(queries.len());
        for query in queries {
            outcomes.push(self.ask_in(&mut round, query).await?);
        }
        Ok(outcomes)
    }
}

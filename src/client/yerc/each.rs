//! Batch of reads with one result each: a refusal of one read does not hide the others.

use armctl_controller::yerc::query::Query;
use armctl_controller::yerc::status::is_absent;

use super::{Client, Error, Refusal};

/// Why one read of a batch has no answer. `E` is the error type.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Denied<E = Error> {
    /// The controller refused.
    Refused(Refusal),
    /// The answer was invalid, or the connection was lost.
    Failed(E),
    /// Not sent, because the connection was lost before, with this error.
    NotAsked(E),
}

/// Result of one read.
pub type Outcome<T, E = Error> = Result<T, Denied<E>>;

impl<E> Denied<E> {
    /// Whether the controller reports that the object does not exist.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::Refused(refusal) if is_absent(refusal.status))
    }

    /// Converts the error.
    pub fn map<F>(self, tell: impl FnOnce(E) -> F) -> Denied<F> {
        match self {
            Self::Refused(refusal) => Denied::Refused(refusal),
            Self::Failed(error) => Denied::Failed(tell(error)),
            Self::NotAsked(error) => Denied::NotAsked(tell(error)),
        }
    }
}

/// State of a batch of reads ([`Client::ask_in`]).
#[derive(Debug, Default)]
pub struct Round {
    /// Whether the controller has answered a request, also with a refusal.
    is_heard: bool,
    nonsense: u32,
    /// The error that ended the batch.
    lost: Option<Error>,
}

/// Number of invalid answers, without a valid one, after which the peer counts as no controller.
const MOST_NONSENSE: u32 = 2;

impl Client {
    /// Sends one read of a batch. Before the first answer, silence or repeated garbage ends the batch with an error.
    /// After the connection is lost, the remaining reads are not sent.
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

    /// Sends several reads, each with its own result. A dry run plans them all.
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

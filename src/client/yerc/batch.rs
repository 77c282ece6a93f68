//! Batch of reads. Each read has its own result: a refusal of one read does not hide the results of the others.

use armctl_controller::yerc::query::Query;
use armctl_controller::yerc::status::is_absent;

use super::{Client, Error, Refusal};

/// Why one read of a batch has no answer. `E` is the error type.
///
/// Example: [`Batch`]
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum ReadError<E = Error> {
    /// The controller refused.
    Refused(Refusal),
    /// The answer was invalid, or the connection was lost.
    Failed(E),
    /// The read was not sent, because the connection had already been lost with this error.
    NotSent(E),
}

/// Result of one read.
///
/// Example: [`Batch`]
pub type Outcome<T, E = Error> = Result<T, ReadError<E>>;

impl<E> ReadError<E> {
    /// Whether the controller reports that the object does not exist.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::Refused(refusal) if is_absent(refusal.status))
    }

    /// Converts the error of the read to another type.
    pub fn map<F>(self, convert: impl FnOnce(E) -> F) -> ReadError<F> {
        match self {
            Self::Refused(refusal) => ReadError::Refused(refusal),
            Self::Failed(error) => ReadError::Failed(convert(error)),
            Self::NotSent(error) => ReadError::NotSent(convert(error)),
        }
    }
}

/// State of a batch of reads ([`Client::ask_in_batch`]).
///
/// ```
/// use armctl_client::yerc::{Batch, Client, Endpoint, Model, Options, Outcome, ReadError, ReadVariable, Value, VariableKind};
///
/// # #[tokio::main(flavor = "current_thread", start_paused = true)]
/// # async fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mut robot = Client::connect(Endpoint::simulator(Model::Dx200), Options::auto()).await?;
/// let mut batch = Batch::default();
/// for number in [0, 5_000] {
///     let read = ReadVariable::new(VariableKind::B, number);
///     let outcome: Outcome<Value> = robot.ask_in_batch(&mut batch, &read).await?;
///     match outcome {
///         Ok(value) => println!("B{number} is {value:?}"),
///         Err(error @ ReadError::Refused(_)) => assert!(number == 5_000 && error.is_absent()),
///         Err(error) => panic!("{error:?}"),
///     }
/// }
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Default)]
pub struct Batch {
    /// Whether the controller has answered a request. A refusal is also an answer.
    has_answer: bool,
    malformed: u32,
    /// The error that ended the batch.
    lost: Option<Error>,
}

/// Maximum number of invalid answers before the first valid one. After this number, the batch fails: the peer is
/// probably not a controller.
const MAX_MALFORMED: u32 = 2;

impl Client {
    /// Sends one read of a batch. Before the first answer, a timeout or repeated invalid data ends the batch with an
    /// error. After the connection is lost, the remaining reads are not sent.
    pub async fn ask_in_batch<Q: Query>(&mut self, batch: &mut Batch, query: &Q) -> Result<Outcome<Q::Answer>, Error> {
        if let Some(lost) = &batch.lost {
            return Ok(Err(ReadError::NotSent(lost.clone())));
        }
        match self.try_ask(query).await {
            Ok(answer) => {
                batch.has_answer = true;
                Ok(answer.map_err(ReadError::Refused))
            }
            Err(error) if error.is_malformed() && (batch.has_answer || batch.malformed + 1 < MAX_MALFORMED) => {
                batch.malformed = batch.malformed.saturating_add(1);
                Ok(Err(ReadError::Failed(error)))
            }
            Err(error) if error.is_silence() && batch.has_answer => {
                batch.lost = Some(error.clone());
                Ok(Err(ReadError::Failed(error)))
            }
            Err(error) => Err(error),
        }
    }

    /// Sends several reads and returns a result for each. A dry run plans all of them.
    pub async fn ask_each<Q: Query>(&mut self, queries: &[Q]) -> Result<Vec<Outcome<Q::Answer>>, Error> {
        self.plan_all(queries)?;
        let mut batch = Batch::default();
        let mut outcomes = Vec::with_capacity(queries.len());
        for query in queries {
            outcomes.push(self.ask_in_batch(&mut batch, query).await?);
        }
        Ok(outcomes)
    }
}

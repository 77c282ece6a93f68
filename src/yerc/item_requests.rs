//! Several requests of one command, each with its own outcome. If a request is refused, the other answers are still
//! reported.

use super::failure::refusal_failure;
use super::link::Link;
use armctl_client::yerc;
pub use armctl_client::yerc::Batch;
use armctl_controller::yerc::query::Query;
use armctl_frame::failure::Failure;

/// Reason why a request has no answer.
pub type ReadError = yerc::ReadError<Failure>;

/// Outcome of a request.
pub type Outcome<T> = yerc::Outcome<T, Failure>;

/// Failure of a request without an answer.
pub fn read_failure(error: ReadError) -> Failure {
    match error {
        ReadError::Refused(refusal) => refusal_failure(refusal),
        ReadError::Failed(failure) => failure,
        ReadError::NotSent(failure) => Failure { message: format!("not read: {}", failure.message), ..failure },
    }
}

/// Reads items that may not exist, and omits the items that do not exist. Other refusals are kept. If all requests are
/// refused with the same code, the cause is not a missing item. In that case, the first refusal is the failure.
pub async fn ask_existing<K, Q: Query + Copy>(
    link: &mut Link,
    questions: Vec<(K, Q)>,
) -> Result<Vec<(K, Outcome<Q::Answer>)>, Failure> {
    let (keys, queries): (Vec<K>, Vec<Q>) = questions.into_iter().unzip();
    let outcomes = link.ask_each(&queries).await?;
    existing_outcomes(keys.into_iter().zip(outcomes)).map_err(read_failure)
}

fn existing_outcomes<K, A>(outcomes: impl Iterator<Item = (K, Outcome<A>)>) -> Result<Vec<(K, Outcome<A>)>, ReadError> {
    let mut found = Vec::new();
    let mut absent = None;
    let mut is_any = false;
    for (key, outcome) in outcomes {
        is_any |= outcome.is_ok();
        match outcome {
            Err(why) if why.is_absent() => absent = absent.or(Some(why)),
            outcome => found.push((key, outcome)),
        }
    }
    if is_any {
        return Ok(found);
    }
    let refusal = found.into_iter().find_map(|(_, outcome)| outcome.err());
    refusal.or(absent).map_or(Ok(Vec::new()), Err)
}

#[cfg(test)]
mod tests {
    use super::*;
    use armctl_client::yerc::{Refusal, RefusedRequest};
    use armctl_controller::yerc::wire::Status;

    #[test]
    fn omits_absent_items_unless_all_are_refused() {
        let no = |code| {
            let to = RefusedRequest::Robot { command: 0x74, instance: 2 };
            Err(ReadError::Refused(Refusal { status: Status::refused(code), to }))
        };
        let found = existing_outcomes([(1, no(0xA001)), (2, Ok("x")), (3, no(0x2150)), (4, no(0xA001))].into_iter());
        assert_eq!(found, Ok(vec![(2, Ok("x")), (3, no(0x2150))]));
        let none = existing_outcomes::<i32, &str>([(1, no(0xA001)), (2, no(0x2100))].into_iter());
        assert_eq!(none.map_err(Err), Err(no(0x2100)));
    }
}

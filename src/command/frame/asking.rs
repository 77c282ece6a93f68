//! Questions to a person, asked on a thread of their own so that Ctrl-C and other requests to end are heard meanwhile.

use super::interrupt::interruptible;
use crate::failure::Failure;
use crate::output::Screen;

/// The answer to a question. One that is broken off leaves the terminal as it was.
pub async fn answered<T: Send + 'static>(
    screen: Screen,
    question: impl FnOnce() -> Result<T, Failure> + Send + 'static,
) -> Result<T, Failure> {
    let answer = match interruptible(tokio::task::spawn_blocking(question)).await {
        Ok(answer) => answer.unwrap_or_else(|error| Err(Failure::local(format!("the question failed: {error}")))),
        Err(failure) => Err(failure),
    };
    answer.inspect_err(|_| screen.give_back())
}

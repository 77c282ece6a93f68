//! Interactive questions in a separate thread, so that Ctrl-C and other termination requests are handled during a
//! question.

use super::interrupt::interruptible;
use crate::prelude::basics::*;

/// Asks a question and returns the answer. If the question is aborted, the terminal is restored.
pub async fn ask<T: Send + 'static>(
    screen: Screen,
    question: impl FnOnce() -> Result<T> + Send + 'static,
) -> Result<T> {
    let answer = match interruptible(tokio::task::spawn_blocking(question)).await {
        Ok(answer) => {
            answer.unwrap_or_else(|error| Err(Failure::local(format!("confirmation prompt failed: {error}"))))
        }
        Err(failure) => Err(failure),
    };
    answer.inspect_err(|_| screen.give_back())
}

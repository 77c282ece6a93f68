//! Temporary selection of another task during a command.

use crate::prelude::*;
use armctl_controller::toyo::table::Command;

/// Reads the current task, and selects `task` temporarily if another task is current. Returns the task that is current
/// after this.
pub async fn select_task(link: &mut Link, task: Option<u8>) -> Result<u8> {
    if link.is_dry_run() {
        link.plan(&Request::bare(Command::Mtsk), "the current task");
        if let Some(task) = task {
            let back = format!("@{} TASK=?", Command::Ctsk.row().word);
            link.plan_to_borrow(&select_request(task), &back, "whether the task differs from the current task").await?;
        }
        return Ok(task.unwrap_or(1));
    }
    let answer = link.ask(&Request::bare(Command::Mtsk)).await?;
    let current = answer.number("task").and_then(|task| u8::try_from(task).ok()).filter(|task| (1..=4).contains(task));
    let current = current.ok_or_else(|| link.malformed(&answer.written(), "the task must be 1 to 4"))?;
    match task.filter(|task| *task != current) {
        Some(task) => {
            link.borrow(&select_request(task), select_request(current)).await?;
            Ok(task)
        }
        None => Ok(current),
    }
}

/// Restores temporary changes, after success or failure. After Ctrl-C, they are restored when the link is closed.
pub async fn restore_task<T>(link: &mut Link, outcome: Result<T>) -> Result<T> {
    if outcome.as_ref().is_err_and(|failure| failure.kind == Kind::Interrupted) {
        return outcome;
    }
    let put_back = link.put_back().await;
    let value = outcome?;
    put_back
        .map_err(|failure| Failure { message: format!("the command succeeded, but {}", failure.message), ..failure })?;
    Ok(value)
}

fn select_request(task: u8) -> Request {
    Request::of(Command::Ctsk, [Value::Number(task.into())])
}

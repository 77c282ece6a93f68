//! The task that commands are about, which may be another one for a while.

use super::link::Link;
use crate::controller::toyo::field::Value;
use crate::controller::toyo::request::Request;
use crate::controller::toyo::table::Command;
use crate::failure::{Failure, Kind};

/// Asks which task is the current one, and makes another one that for a while; says which is the current one then.
pub async fn choose(link: &mut Link, wanted: Option<u8>) -> Result<u8, Failure> {
    if link.is_dry() {
        link.plan(&Request::bare(Command::Mtsk), "which task is the current one");
        if let Some(task) = wanted {
            let back = format!("@{} TASK=?", Command::Ctsk.row().word);
            link.plan_to_borrow(&choice(task), &back, "whether it is another one").await?;
        }
        return Ok(wanted.unwrap_or(1));
    }
    let answer = link.ask(&Request::bare(Command::Mtsk)).await?;
    let found = answer.number("task").and_then(|task| u8::try_from(task).ok()).filter(|task| (1..=4).contains(task));
    let found = found.ok_or_else(|| link.malformed(&answer.written(), "there are tasks 1 to 4"))?;
    match wanted.filter(|wanted| *wanted != found) {
        Some(wanted) => {
            link.borrow(&choice(wanted), choice(found)).await?;
            Ok(wanted)
        }
        None => Ok(found),
    }
}

/// Puts back what was changed for a while, whatever became of the work. After Ctrl-C that is left to the end of the link.
pub async fn done<T>(link: &mut Link, outcome: Result<T, Failure>) -> Result<T, Failure> {
    if outcome.as_ref().is_err_and(|failure| failure.kind == Kind::Interrupted) {
        return outcome;
    }
    let put_back = link.put_back().await;
    let value = outcome?;
    put_back.map_err(|failure| Failure { message: format!("it was done, but {}", failure.message), ..failure })?;
    Ok(value)
}

fn choice(task: u8) -> Request {
    Request::of(Command::Ctsk, [Value::Number(task.into())])
}

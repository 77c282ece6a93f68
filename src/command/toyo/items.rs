//! Several questions in one command: each item has its own outcome, and one refusal hides nothing.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::link::{Link, Refusal};
use super::refusal;
use super::values::NOT_IN_MANUAL;
use crate::controller::toyo::layout::Record;
use crate::controller::toyo::request::Request;
use crate::failure::{Failure, Kind};
use crate::output::Screen;
use crate::output::view::{Cell, Table, Tone};

/// What became of one question of several.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Item<T> {
    /// It was answered.
    Answered {
        /// True.
        ok: bool,
        #[serde(flatten)]
        value: T,
    },
    /// The answer holds something that the manual does not list.
    Unlisted {
        /// True.
        ok: bool,
        /// Which it is: `counter`, `row`, `point`.
        #[serde(flatten)]
        key: Key,
        /// False.
        in_manual: bool,
        /// As the controller holds it.
        raw: String,
    },
    /// It was not answered.
    Failed {
        /// False.
        ok: bool,
        /// Which it is.
        #[serde(flatten)]
        key: Key,
        /// Why, with the block that was refused.
        error: Failure,
    },
}

/// What tells an item from the others: `counter` 5.
pub type Key = BTreeMap<&'static str, i32>;

/// What was answered to each question.
pub type Answers = Vec<Result<Record, Failure>>;

impl<T> Item<T> {
    /// From an answer.
    pub fn of(name: &'static str, number: i32, answer: &Result<Record, Failure>, make: impl Fn(&Record) -> T) -> Self {
        let key = Key::from([(name, number)]);
        match answer {
            Ok(record) if record.is_listed() => Self::Answered { ok: true, value: make(record) },
            Ok(record) => Self::Unlisted { ok: true, key, in_manual: false, raw: record.written() },
            Err(failure) => Self::Failed { ok: false, key, error: failure.clone() },
        }
    }

    /// The value, if there is one.
    pub fn value(&self) -> Option<&T> {
        if let Self::Answered { value, .. } = self { Some(value) } else { None }
    }

    /// Why there is none.
    pub fn error(&self) -> Option<&Failure> {
        if let Self::Failed { error, .. } = self { Some(error) } else { None }
    }

    /// Puts it into a table: its cells, or what is there in place of them.
    pub fn show(&self, table: &mut Table, cells: impl Fn(&T) -> Vec<Cell>) {
        let (key, text, tone) = match self {
            Self::Answered { value, .. } => return table.rows.push(cells(value)),
            Self::Unlisted { key, raw, .. } => (key, format!("{raw} ({NOT_IN_MANUAL})"), Tone::Warning),
            Self::Failed { key, error, .. } => (key, in_a_word(error.kind).to_owned(), Tone::Bad),
        };
        let mut row: Vec<Cell> = key.values().map(|number| Cell::from(*number)).collect();
        row.push(Cell::from(text).tone(tone));
        row.resize_with(table.columns.len(), Cell::default);
        table.rows.push(row);
    }
}

/// A failure where there is room for a word.
pub fn in_a_word(kind: Kind) -> &'static str {
    match kind {
        Kind::Refused => "refused",
        Kind::NoAnswer => "no answer",
        _ => "no sense",
    }
}

/// Why a report is no success: all that failed, with the first of them in words.
pub fn failure<'f>(all: usize, errors: impl Iterator<Item = Option<&'f Failure>>) -> Option<Failure> {
    let failed: Vec<&Failure> = errors.flatten().collect();
    let first = *failed.first()?;
    if failed.len() == all {
        return Some(first.clone());
    }
    let message = format!("{} of {all} failed: {}", failed.len(), first.message);
    Some(Failure { kind: Kind::Mixed, message, ..first.clone() })
}

/// The same of items.
pub fn failure_of<T>(items: &[Item<T>]) -> Option<Failure> {
    failure(items.len(), items.iter().map(Item::error))
}

/// Asks for what is stored, one after the other; each answer counts for itself. When the line falls silent, the rest is not
/// asked. A dry run notes all questions and ends.
///
/// # Errors
/// The first failure, if nothing was answered at all.
pub async fn read_each(link: &mut Link, screen: &Screen, what: &str, requests: &[Request]) -> Result<Answers, Failure> {
    read(link, screen, what, requests, 1).await
}

/// As [`read_each`]; what is refused is asked for once more, as a controller that is busy refuses, too.
///
/// # Errors
/// As those of [`read_each`].
pub async fn read_each_twice(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    requests: &[Request],
) -> Result<Answers, Failure> {
    read(link, screen, what, requests, 2).await
}

async fn read(
    link: &mut Link,
    screen: &Screen,
    what: &str,
    requests: &[Request],
    times: u8,
) -> Result<Answers, Failure> {
    link.rehearse(requests).await;
    let mut progress = (requests.len() > 1).then(|| screen.items_progress(what, requests.len() as u64));
    let mut answers = Answers::with_capacity(requests.len());
    let mut silence: Option<Failure> = None;
    for request in requests {
        let answer = match &silence {
            Some(silence) => Err(not_asked(request, silence)),
            None => outcome(link, request, times).await?,
        };
        if let Err(failure) = &answer
            && failure.kind == Kind::NoAnswer
            && silence.is_none()
        {
            silence = Some(failure.clone());
            if !answers.iter().any(Result::is_ok) {
                return Err(failure.clone());
            }
        }
        answers.push(answer);
        if let Some(progress) = &mut progress {
            progress.advance(1);
        }
    }
    match answers.first() {
        Some(Err(first)) if answers.iter().all(Result::is_err) => Err(first.clone()),
        _ => Ok(answers),
    }
}

/// The answer to one question, or why there is none. What ends all the work is a failure.
async fn outcome(link: &mut Link, request: &Request, times: u8) -> Result<Result<Record, Failure>, Failure> {
    for _ in 1..times {
        match link.try_read_content(request).await {
            Ok(Err(_)) => {}
            Ok(Ok(record)) => return Ok(Ok(record)),
            Err(failure) => return of_one(failure),
        }
    }
    match link.try_read_content(request).await {
        Ok(Ok(record)) => Ok(Ok(record)),
        Ok(Err(Refusal(request))) => Ok(Err(refusal::of_question(&request))),
        Err(failure) => of_one(failure),
    }
}

/// Whether a failure is of one question only.
fn of_one(failure: Failure) -> Result<Result<Record, Failure>, Failure> {
    if matches!(failure.kind, Kind::NoAnswer | Kind::Malformed) { Ok(Err(failure)) } else { Err(failure) }
}

fn not_asked(request: &Request, silence: &Failure) -> Failure {
    let message = format!("{} was not asked, as the line fell silent before: {}", request.text(), silence.message);
    Failure { message, ..silence.clone() }
}

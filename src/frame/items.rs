//! Results of several items of one command, and the common exit code.
//!
//! If some items failed, the exit code is 9. If all items failed with the same exit code, this is the exit code of the
//! command. If their exit codes differ, the exit code of the most severe failure is used.

use crate::backup::severity;
use crate::prelude::basics::*;

/// Failure of one item, for example `{"asked":"B300","kind":"refused","code":"0xA001","message":…}`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct ItemError {
    /// Item as the user would type it, or as the report names it.
    asked: String,
    #[serde(flatten)]
    failure: Failure,
}

impl ItemError {
    /// Failure of one item. Its message need not name the item.
    pub fn new(asked: impl Into<String>, failure: Failure) -> Self {
        Self { asked: asked.into(), failure }
    }

    /// Name of the item.
    pub fn asked(&self) -> &str {
        &self.asked
    }

    /// Failure of a command that has only this item.
    pub fn failure(&self) -> Failure {
        describe_request(&self.asked, self.failure.clone())
    }

    /// Short text for a column.
    pub fn cell(&self) -> Cell {
        Cell::from(shorten(&self.failure)).tone(Tone::Bad)
    }
}

/// Failure whose message starts with the name of the item.
pub fn describe_request(name: &str, failure: Failure) -> Failure {
    // Messages about a local file with the same name already contain the name.
    if failure.message.strip_prefix(name).is_some_and(|rest| rest.starts_with([':', ' '])) {
        return failure;
    }
    Failure { message: format!("{name}: {}", failure.message), ..failure }
}

/// Short text for a column: the first sentence and the code.
pub fn shorten(failure: &Failure) -> String {
    let sentence = failure.message.split(". ").next().unwrap_or_default();
    match &failure.code {
        Some(code) => format!("{sentence} [{code}]"),
        None => sentence.to_owned(),
    }
}

/// Result of one item, next to the name of the item in a report: `{"ok":true, …}` with its data, or
/// `{"ok":false,"error":{…}}`.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct ItemOutcome<T> {
    /// Whether the item was read or written.
    ok: bool,
    #[serde(flatten)]
    data: Option<T>,
    /// Why the item was not read or written.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "ItemError")]
    error: Option<ItemError>,
}

impl<T> ItemOutcome<T> {
    /// Result of a requested item.
    pub fn new(asked: impl Into<String>, outcome: Result<T>) -> Self {
        match outcome {
            Ok(data) => Self { ok: true, data: Some(data), error: None },
            Err(failure) => Self { ok: false, data: None, error: Some(ItemError::new(asked, failure)) },
        }
    }

    /// Converts the data of the result.
    pub fn map<U>(&self, make: impl FnOnce(&T) -> U) -> ItemOutcome<U> {
        ItemOutcome { ok: self.ok, data: self.data.as_ref().map(make), error: self.error.clone() }
    }

    /// Data, if the item succeeded.
    pub fn data(&self) -> Option<&T> {
        self.data.as_ref()
    }

    /// Mutable data, if any.
    pub fn data_mut(&mut self) -> Option<&mut T> {
        self.data.as_mut()
    }

    /// Error, if any.
    pub fn error(&self) -> Option<&ItemError> {
        self.error.as_ref()
    }
}

impl<T> ItemOutcome<Option<T>> {
    /// Removes the `Option` around the data. Returns `None` if the result is a success without data.
    pub fn with_defaults(self) -> Option<ItemOutcome<T>> {
        let Self { ok, data, error } = self;
        let data = match data {
            Some(None) => return None,
            data => data.flatten(),
        };
        Some(ItemOutcome { ok, data, error })
    }
}

/// Failure of a report of `total` items; `None` if no item failed.
pub fn verdict<'a>(total: usize, errors: impl IntoIterator<Item = &'a ItemError>) -> Option<Failure> {
    let errors: Vec<&ItemError> = errors.into_iter().collect();
    let first = *errors.first()?;
    if total <= 1 {
        return Some(first.failure());
    }
    let kinds = || errors.iter().map(|error| error.failure.kind);
    let (kind, how_many) = if errors.len() < total {
        // An interruption determines the exit code, because the user requested it.
        let is_interrupted = kinds().any(|kind| kind == Kind::Interrupted);
        let kind = if is_interrupted { Kind::Interrupted } else { Kind::Mixed };
        (kind, format!("{} of {total} failed", errors.len()))
    } else {
        // Of several kinds with equal severity, the first is used.
        (kinds().rev().max_by_key(|kind| severity(*kind))?, format!("all {total} failed"))
    };
    let representative = errors.iter().find(|error| error.failure.kind == kind).copied().unwrap_or(first);
    let has_same_code = errors.iter().all(|error| error.failure.code == representative.failure.code);
    let failure = representative.failure();
    let code = failure.code.filter(|_| has_same_code);
    Some(Failure { kind, code, message: format!("{how_many}: {}", failure.message), ..failure })
}

/// Fails if all items failed for the same reason. In that case there is no report. If the reasons differ, the report
/// lists them.
pub fn all_failed<'a>(total: usize, errors: impl IntoIterator<Item = &'a ItemError>) -> Result<()> {
    let errors: Vec<&ItemError> = errors.into_iter().collect();
    let reason = |error: &ItemError| (error.failure.kind, error.failure.code.clone());
    let is_one = errors.windows(2).all(|pair| reason(pair[0]) == reason(pair[1]));
    if errors.len() < total || !is_one {
        return Ok(());
    }
    verdict(total, errors).map_or(Ok(()), Err)
}

#[cfg(test)]
mod tests {

    use super::*;

    fn refused(asked: &str, code: &str) -> ItemError {
        ItemError::new(asked, Failure::new(Kind::Refused, "the controller refused. Because").code(code).hint("x"))
    }

    #[test]
    fn outcome_serializes_data_or_error() {
        #[derive(Serialize)]
        struct Value {
            value: u8,
        }
        let json = |outcome: &ItemOutcome<Value>| serde_json::to_value(outcome).unwrap();
        assert_eq!(json(&ItemOutcome::new("B0", Ok(Value { value: 1 }))), json!({"ok": true, "value": 1}));
        let failed = ItemOutcome::new("B300", Err(Failure::new(Kind::Refused, "no").code("0xA001")));
        let error = json!({"asked": "B300", "kind": "refused", "code": "0xA001", "message": "no"});
        assert_eq!(json(&failed), json!({"ok": false, "error": error}));
    }

    #[test]
    fn partial_failure_exits_9_and_total_failure_exits_with_the_common_code() {
        let of = |total, errors: &[ItemError]| verdict(total, errors).unwrap();
        assert_eq!(verdict(3, &[]), None);
        let some = of(3, &[refused("B300", "0xA001")]);
        assert_eq!((some.kind.exit(), some.code.as_deref()), (9, Some("0xA001")));
        assert_eq!(some.message, "1 of 3 failed: B300: the controller refused. Because");
        let all = of(2, &[refused("B300", "0xA001"), refused("B301", "0x2010")]);
        assert_eq!((all.kind, all.code), (Kind::Refused, None));
        let silent = ItemError::new("B301", Failure::new(Kind::NoAnswer, "silence"));
        let most_severe = of(2, &[refused("B300", "0xA001"), silent]);
        assert_eq!((most_severe.kind, most_severe.message.as_str()), (Kind::NoAnswer, "all 2 failed: B301: silence"));
        assert_eq!(of(1, &[refused("B300", "0xA001")]).message, "B300: the controller refused. Because");
    }

    #[test]
    fn one_common_reason_fails_as_a_command() {
        let one = refused("B300", "0xA001");
        assert_eq!(all_failed(1, [&one]).unwrap_err().message, "B300: the controller refused. Because");
        assert_eq!(all_failed(2, [&one, &one]).unwrap_err().kind, Kind::Refused);
        assert!(all_failed(2, [&one]).is_ok() && all_failed(1, []).is_ok());
        assert!(all_failed(2, [&one, &refused("B301", "0x2010")]).is_ok(), "the report has both reasons");
    }
}

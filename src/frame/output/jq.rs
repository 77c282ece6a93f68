//! jq filters for `--jq` and `--until`. They are applied to envelopes.

mod program;
pub mod worker;

use serde_json::Value;

use super::busy_work;
use crate::failure::{Failure, Kind};

use self::worker::FilterError;

/// A compiled filter.
#[derive(Debug)]
pub struct Filter {
    text: String,
}

impl Filter {
    /// Compiles a filter. A syntax error in the filter is a usage failure.
    pub fn new(text: &str) -> Result<Self, Failure> {
        let filter = Self { text: text.to_owned() };
        filter.ask(None, |_| Ok(())).map(|()| filter)
    }

    /// Passes each output of the filter to `take`.
    pub fn apply(&self, input: &Value, take: impl FnMut(Value) -> Result<(), Failure>) -> Result<(), Failure> {
        self.ask(Some(input), take)
    }

    /// Whether the last output of the filter is neither `false` nor `null`.
    pub fn is_true(&self, input: &Value) -> Result<bool, Failure> {
        let mut last = Value::Null;
        self.apply(input, |value| {
            last = value;
            Ok(())
        })?;
        Ok(!matches!(last, Value::Null | Value::Bool(false)))
    }

    fn ask(&self, input: Option<&Value>, mut take: impl FnMut(Value) -> Result<(), Failure>) -> Result<(), Failure> {
        let _busy = busy_work::register();
        let mut taken_count = Ok(());
        let result = ask(&self.text, input, |value| {
            taken_count = take(value);
            taken_count.is_ok()
        });
        taken_count?;
        result.map_err(|message| match message {
            FilterError::Mistake(why) => Failure::usage(format!("jq filter '{}': {why}", self.text))
                .hint("a filter gets the whole envelope: try '.data', or remove --jq to see the envelope"),
            FilterError::Failed(why) => Failure::new(Kind::Malformed, format!("jq filter '{}': {why}", self.text))
                .hint("use --json to see the input of the filter"),
            FilterError::Halted { exit, text } => Failure::new(Kind::Halted(exit), text),
        })
    }
}

/// Filters run in the worker process.
#[cfg(not(test))]
use worker::ask;

/// In tests, filters run in this process, because the test binary is not armctl.
#[cfg(test)]
fn ask(filter: &str, input: Option<&Value>, take: impl FnMut(Value) -> bool) -> Result<(), FilterError> {
    let program = program::Program::new(filter).map_err(FilterError::Mistake)?;
    let Some(input) = input else { return Ok(()) };
    let input = serde_json::from_value(input.clone()).map_err(|error| FilterError::Failed(error.to_string()))?;
    program.run(input, take).map_err(FilterError::from)
}

/// Where the worker process writes its output.
fn answers() -> std::io::Stdout {
    std::io::stdout()
}

/// Marks a report failure that occurred after a change. The user must not correct the command line and repeat the
/// change.
#[must_use]
pub fn failure_after_change(failure: Failure) -> Failure {
    if failure.kind == Kind::PipeClosed {
        return failure;
    }
    let message = format!("succeeded, but the report could not be written: {}", failure.message);
    Failure { kind: Kind::Local, message, ..failure }.hint("check the result before you repeat the command")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn outputs(filter: &str, input: &Value) -> Result<Vec<Value>, Failure> {
        let mut values = Vec::new();
        Filter::new(filter)?.apply(input, |value| {
            values.push(value);
            Ok(())
        })?;
        Ok(values)
    }

    #[test]
    fn outputs_match_jq() {
        let made = outputs(".data | .axes[] | select(. > 1)", &json!({"data": {"axes": [1, 2, 3.5]}}));
        assert_eq!(made.unwrap(), [json!(2), json!(3.5)]);
    }

    #[test]
    fn syntax_errors_are_usage_failures() {
        assert!(Filter::new(".data[").unwrap_err().message.contains("cannot be parsed"));
        assert!(Filter::new("nonsense").unwrap_err().message.contains("'nonsense' is not defined"));
        assert!(outputs(".a.b", &json!({"a": 1})).is_err());
    }

    #[test]
    fn writes_rows_like_jq() {
        let rows = json!([[1, 2.5, null, "say \"hi\"", true], ["tab\tand\nline \\"]]);
        let made = |filter: &str| outputs(filter, &rows);
        assert_eq!(made(".[0] | @csv").unwrap(), [json!("1,2.5,,\"say \"\"hi\"\"\",true")]);
        assert_eq!(made(".[1] | @tsv").unwrap(), [json!("tab\\tand\\nline \\\\")]);
        assert!(made("@csv").unwrap_err().message.contains("array cannot be a cell"));
        assert!(made("{} | @tsv").unwrap_err().message.contains("object is not a row"));
    }

    #[test]
    fn only_false_and_null_are_false() {
        for (filter, expected) in [(".ok", true), (".no", false), ("0", true), ("false", false), ("empty", false)] {
            assert_eq!(Filter::new(filter).unwrap().is_true(&json!({"ok": true})).unwrap(), expected, "{filter}");
        }
    }

    #[test]
    fn streams_only_the_taken_outputs() {
        let mut count = 0;
        let stopped = Filter::new("repeat(1)").unwrap().apply(&Value::Null, |_| {
            count += 1;
            if count < 3 { Ok(()) } else { Err(Failure::local("enough")) }
        });
        assert_eq!((stopped.unwrap_err().message.as_str(), count), ("enough", 3));
    }
}

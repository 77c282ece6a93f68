//! `--jq` and `--until`: jq filters over the envelope.

use jaq_core::load::{Arena, File, Loader, parse};
use jaq_core::{Compiler, Ctx, Vars, data, unwrap_valr};
use jaq_json::Val;
use serde_json::Value;

use crate::failure::Failure;

/// What jq has and the library has not.
const DEFS: &str = r#"
def row(f): if isarray then . else error("\(type) is no row: an array is expected") end
  | map(if . == null then "" elif isstring then f elif isarray or isobject then error("\(type) is no cell of a row")
        else tostring end);
def @csv: row("\"" + gsub("\""; "\"\"") + "\"") | join(",");
def @tsv: row(gsub("\\\\"; "\\\\") | gsub("\t"; "\\t") | gsub("\n"; "\\n") | gsub("\r"; "\\r")) | join("\t");
"#;

/// A compiled filter.
pub struct Filter {
    text: String,
    program: jaq_core::Filter<data::JustLut<Val>>,
}

impl std::fmt::Debug for Filter {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Filter").field(&self.text).finish()
    }
}

impl Filter {
    /// Compiles a filter; a mistake in it is a usage failure.
    pub fn new(text: &str) -> Result<Self, Failure> {
        let wrong = |what: &str| {
            Failure::usage(format!("jq filter '{text}': {what}"))
                .hint("filters see the whole envelope: try '.data', or leave --jq away to see it")
        };
        let ours = parse(DEFS, |parser| parser.defs()).ok_or_else(|| wrong("the definitions do not parse"))?;
        let defs = jaq_core::defs().chain(jaq_std::defs()).chain(jaq_json::defs()).chain(ours);
        let funs = jaq_core::funs().chain(jaq_std::funs()).chain(jaq_json::funs());
        let arena = Arena::default();
        let modules =
            Loader::new(defs).load(&arena, File { code: text, path: () }).map_err(|_| wrong("it does not parse"))?;
        let program = Compiler::default().with_funs(funs).compile(modules).map_err(|errors| {
            let name = errors.iter().flat_map(|(_, errors)| errors).map(|(name, _)| *name).next();
            wrong(&format!("'{}' is not defined", name.unwrap_or("something")))
        })?;
        Ok(Self { text: text.to_owned(), program })
    }

    /// Every value that the filter makes of `input`.
    pub fn apply(&self, input: &Value) -> Result<Vec<Value>, Failure> {
        let wrong = |what: String| {
            Failure::usage(format!("jq filter '{}': {what}", self.text)).hint("--json shows what the filter is given")
        };
        let input: Val = serde_json::from_value(input.clone()).map_err(|error| wrong(error.to_string()))?;
        let context = Ctx::<data::JustLut<Val>>::new(&self.program.lut, Vars::new([]));
        let results = self.program.id.run((context, input)).map(unwrap_valr);
        results
            .map(|result| {
                let value = result.map_err(|error| wrong(error.to_string()))?;
                serde_json::from_str(&value.to_string()).map_err(|error| wrong(error.to_string()))
            })
            .collect()
    }

    /// Whether the last value the filter makes is neither `false` nor `null`.
    pub fn is_true(&self, input: &Value) -> Result<bool, Failure> {
        Ok(self.apply(input)?.last().is_some_and(|value| !matches!(value, Value::Null | Value::Bool(false))))
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn values_come_out_as_jq_makes_them() {
        let filter = Filter::new(".data | .axes[] | select(. > 1)").unwrap();
        assert_eq!(filter.apply(&json!({"data": {"axes": [1, 2, 3.5]}})).unwrap(), [json!(2), json!(3.5)]);
    }

    #[test]
    fn mistakes_are_usage_failures() {
        assert!(Filter::new(".data[").unwrap_err().message.contains("does not parse"));
        assert!(Filter::new("nonsense").unwrap_err().message.contains("'nonsense' is not defined"));
        assert!(Filter::new(".a.b").unwrap().apply(&json!({"a": 1})).is_err());
    }

    #[test]
    fn rows_are_written_as_jq_writes_them() {
        let rows = json!([[1, 2.5, null, "say \"hi\"", true], ["tab\tand\nline \\"]]);
        let made = |filter: &str| Filter::new(filter).unwrap().apply(&rows);
        assert_eq!(made(".[0] | @csv").unwrap(), [json!("1,2.5,,\"say \"\"hi\"\"\",true")]);
        assert_eq!(made(".[1] | @tsv").unwrap(), [json!("tab\\tand\\nline \\\\")]);
        assert!(made("@csv").unwrap_err().message.contains("array is no cell"));
        assert!(made("{} | @tsv").unwrap_err().message.contains("object is no row"));
    }

    #[test]
    fn only_false_and_null_are_untrue() {
        for (filter, expected) in [(".ok", true), (".no", false), ("0", true), ("false", false), ("empty", false)] {
            assert_eq!(Filter::new(filter).unwrap().is_true(&json!({"ok": true})).unwrap(), expected, "{filter}");
        }
    }
}

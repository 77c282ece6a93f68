//! Conditions of `wait` and `--until`: a state, `NAME=VALUE`, or a jq filter.

use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::jq::Filter;

/// Names of states, and their filters over an envelope.
const STATES: [(&str, &str); 6] = [
    ("idle", ".data.running == false and .data.held != true"),
    ("running", ".data.running == true"),
    ("held", ".data.held == true"),
    ("faulted", ".data.faulted == true"),
    ("homed", ".data.homed == true"),
    ("servo-on", ".data.servo_on == true"),
];

/// Comparison operators. Longer operators come first, so that a prefix search finds them.
const COMPARISONS: [&str; 7] = [">=", "<=", "!=", "==", "=", ">", "<"];

/// Condition to wait for.
#[derive(Debug)]
pub struct Condition {
    /// Condition as the user typed it.
    text: String,
    filter: Filter,
    /// Whether the filter begins with a key, such as `.data.held`, so that it is for one envelope.
    is_for_one: bool,
    /// Keys that the condition uses, each as a path from the top of the envelope.
    keys: Vec<Vec<String>>,
    /// `NAME` in `NAME=VALUE`: a key of the report, or an item in the report.
    name: Option<String>,
}

/// `NAME=VALUE`, or a comparison with another operator.
#[derive(Debug)]
pub struct Comparison<'a> {
    /// Name as the user typed it.
    pub name: &'a str,
    sign: &'static str,
    value: Value,
}

impl Condition {
    /// Parses a condition.
    ///
    /// # Errors
    /// If the filter is not valid.
    pub fn new(text: &str) -> Result<Self, Failure> {
        let text = text.trim();
        if serde_json::from_str::<Value>(text).is_ok() {
            // A plain value is also a valid filter, and its result would be true at once.
            return Err(Failure::usage(format!("'{text}' is not a condition"))
                .hint(format!("write the value to wait for, such as {text}=on")));
        }
        let comparison = Comparison::parse(text);
        let (filter, keys) = match (STATES.iter().find(|(state, _)| *state == text), &comparison) {
            (Some((_, filter)), _) => (each(filter), paths(filter)),
            (None, Some(comparison)) => (each(&comparison.filter()), Vec::new()),
            (None, None) => (text.to_owned(), paths(text)),
        };
        let name = comparison.map(|comparison| comparison.name.to_owned());
        Self::with_filter(text, &filter, keys, name)
    }

    /// Condition for a report that has only the item of this comparison. The report may spell the name of the item
    /// differently.
    ///
    /// # Errors
    /// If the filter is not valid.
    pub fn item_of_noun(text: &str, comparison: &Comparison<'_>) -> Result<Self, Failure> {
        let compared = comparison.comparison_filter();
        let filter = each(&format!("(.data.items | length) > 0 and all(.data.items[]; .ok and (.value | {compared}))"));
        Self::with_filter(text, &filter, Vec::new(), None)
    }

    fn with_filter(text: &str, filter: &str, keys: Vec<Vec<String>>, name: Option<String>) -> Result<Self, Failure> {
        let filter = Filter::new(filter).map_err(|failure| {
            failure.hint(
                "use idle, running, held, faulted, homed or servo-on; or NAME=VALUE; or a jq filter such as \
                 .data.held",
            )
        })?;
        let is_for_one = text.strip_prefix('.').is_some_and(|rest| rest.starts_with(|c: char| c.is_alphabetic()));
        Ok(Self { text: text.to_owned(), filter, is_for_one, keys, name })
    }

    /// Whether the condition is about the connection itself. In that case, a robot that does not answer is not a
    /// failure.
    pub fn is_about_connection(&self) -> bool {
        self.text.contains("reachable")
    }

    /// Whether the condition is true. With several robots, it must be true for all of them.
    ///
    /// # Errors
    /// If the filter fails.
    pub fn is_met(&self, envelopes: &Value) -> Result<bool, Failure> {
        let Value::Array(all) = envelopes else { return self.filter.is_true(envelopes) };
        if !self.is_for_one {
            return self.filter.is_true(envelopes);
        }
        let met: Vec<bool> = all.iter().map(|envelope| self.filter.is_true(envelope)).collect::<Result<_, _>>()?;
        Ok(!met.is_empty() && met.iter().all(|is_met| *is_met))
    }

    /// Message if the condition can never be true, because a report does not have a key of the condition.
    pub fn check_keys(&self, envelopes: &Value) -> Option<String> {
        let first = envelopes.as_array().and_then(|all| all.first()).unwrap_or(envelopes);
        let data = first["data"].as_object()?;
        if let Some(name) = &self.name {
            let is_known = data.contains_key(name) || has_item(&first["data"], name);
            return (!is_known).then(|| {
                let text = &self.text;
                let keys: Vec<&str> = data.keys().map(String::as_str).collect();
                format!(
                    "'{text}': this report has no key and no item {name}, so this condition may never be true; keys: {}. \
                     `armctl wait '{text}'` reads a signal or value of this name",
                    keys.join(", ")
                )
            });
        }
        let missing = self.keys.iter().find(|path| !has(first, path))?;
        let found = path_of(first, missing).map(|keys| keys.join(", ")).unwrap_or_default();
        let place = missing.join(".");
        Some(format!(
            "'{}': the key .{place} does not exist, so this condition may never be true; available keys: {found}",
            self.text
        ))
    }
}

impl std::fmt::Display for Condition {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl<'a> Comparison<'a> {
    /// Parses `NAME=VALUE`; `None` for other text.
    pub fn parse(text: &'a str) -> Option<Self> {
        let (at, sign) =
            COMPARISONS.iter().filter_map(|sign| Some((text.find(sign)?, *sign))).min_by_key(|(at, _)| *at)?;
        let (name, value) = (text[..at].trim(), text[at + sign.len()..].trim());
        let is_name = name.starts_with(|first: char| first.is_alphanumeric() || first == '#')
            && name.chars().all(|one| one.is_alphanumeric() || "_-()#. ".contains(one));
        if !is_name || value.is_empty() {
            return None;
        }
        let value = match value {
            "on" | "true" => json!(true),
            "off" | "false" => json!(false),
            "null" => Value::Null,
            text => text
                .parse::<f64>()
                .ok()
                .and_then(|number| serde_json::from_str(text).ok().or(Some(json!(number))))
                .unwrap_or_else(|| json!(text.trim_matches(['"', '\'']))),
        };
        Some(Self { name, sign: if sign == "=" { "==" } else { sign }, value })
    }

    /// Filter over a value. A signal can also be compared with the numbers 0 and 1.
    fn comparison_filter(&self) -> String {
        let Self { sign, value, .. } = self;
        let bit = "if . == true then 1 elif . == false then 0 else . end";
        if value.is_number() { format!("({bit}) {sign} {value}") } else { format!(". {sign} {value}") }
    }

    /// Filter over an envelope. It uses the key of the report with this name, or otherwise the item with this name.
    fn filter(&self) -> String {
        let (name, compared) = (json!(self.name), self.comparison_filter());
        let described = format!(
            "(.data | if type == \"object\" and has({name}) then [.[{name}]] else \
             [.. | objects | select([.[] | strings] | index({name})) | if has(\"value\") then .value elif has(\"on\") then .on else empty end] end)"
        );
        format!("{described} as $told | ($told | length) > 0 and all($told[]; {compared})")
    }
}

/// Whether a report has an item with this name or label.
fn has_item(value: &Value, name: &str) -> bool {
    match value {
        Value::Object(fields) => fields.values().any(|field| field == name || has_item(field, name)),
        Value::Array(items) => items.iter().any(|item| has_item(item, name)),
        _ => false,
    }
}

/// Applies a filter to one envelope, or to each of several envelopes.
fn each(filter: &str) -> String {
    format!("if type == \"array\" then length > 0 and all(.[]; {filter}) else ({filter}) end")
}

/// Plain paths in a filter that begin with `.data`, such as `.data.servo_on`.
fn paths(filter: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for (at, _) in filter.match_indices(".data.") {
        let is_whole =
            filter[..at].chars().next_back().is_none_or(|before| !before.is_alphanumeric() && !"_]?".contains(before));
        let path: String =
            filter[at + 1..].chars().take_while(|one| one.is_alphanumeric() || "_.".contains(*one)).collect();
        let words: Vec<String> = path.split('.').filter(|word| !word.is_empty()).map(ToOwned::to_owned).collect();
        if is_whole && !filter[at + 1 + path.len()..].starts_with(['?', '(']) {
            found.push(words);
        }
    }
    found
}

/// Whether a value has this path. A null value counts as a value with any keys.
fn has(value: &Value, path: &[String]) -> bool {
    let mut value = value;
    for key in path {
        match value {
            Value::Object(fields) => match fields.get(key) {
                Some(field) => value = field,
                None => return false,
            },
            _ => return true,
        }
    }
    true
}

/// Keys that exist at the place where the first missing part of a path is expected.
fn path_of<'a>(value: &'a Value, path: &[String]) -> Option<Vec<&'a str>> {
    let mut value = value;
    for key in path {
        match value.get(key) {
            Some(field) => value = field,
            None => break,
        }
    }
    Some(value.as_object()?.keys().map(String::as_str).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn holds(condition: &str, envelope: &Value) -> bool {
        Condition::new(condition).unwrap().is_met(envelope).unwrap()
    }

    #[test]
    fn parses_states_of_every_family() {
        let of = |running: Option<bool>, held: bool| json!({ "data": { "running": running, "held": held, "servo_on": true } });
        assert!(holds("idle", &of(Some(false), false)) && !holds("idle", &of(Some(false), true)));
        assert!(!holds("idle", &of(None, false)), "an unknown state is not true");
        assert!(holds("servo-on", &of(None, false)) && holds("held", &of(None, true)));
        assert!(holds("idle", &json!([of(Some(false), false), of(Some(false), false)])));
        assert!(!holds("idle", &json!([of(Some(false), false), of(Some(true), false)])), "all of them");
        assert!(!holds("idle", &json!([])));
    }

    #[test]
    fn parses_names_of_keys_signals_and_variables() {
        let status = json!({ "data": { "servo_on": true, "fault_code": "4315", "speed": 5 } });
        assert!(holds("servo_on=on", &status) && holds("servo_on=true", &status) && !holds("servo_on=off", &status));
        assert!(holds("fault_code=\"4315\"", &status) && holds("speed>=5", &status) && holds("speed != 4", &status));
        let signals = json!({ "data": { "signals": [
            { "signal": "SI(20)", "label": "clamp", "on": true }, { "signal": "SI(21)", "label": null, "on": false },
        ] } });
        assert!(holds("clamp=on", &signals) && holds("SI(21)=off", &signals) && !holds("SI(21)=on", &signals));
        assert!(!holds("gripper=on", &signals), "what is not there");
        let variables = json!({ "data": { "variables": [{ "variable": "B5", "value": 3 }] } });
        assert!(holds("B5>=3", &variables) && !holds("B5>3", &variables) && holds("B5<4", &variables));
    }

    #[test]
    fn leaves_filters_unchanged() {
        let status = json!({ "data": { "servo_on": true, "alarms": [] } });
        assert!(holds(".data.servo_on", &status) && holds(".data.alarms == []", &status));
        assert!(holds(".data.servo_on and (.data.alarms | length) <= 0", &status));
        // With several robots, a filter for one envelope must be true for all of them.
        let off = json!({ "data": { "servo_on": false } });
        assert!(holds(".data.servo_on", &json!([status, status])) && !holds(".data.servo_on", &json!([status, off])));
        assert!(holds("any(.[]; .data.servo_on)", &json!([status, off])) && !holds(".data.servo_on", &json!([])));
        assert!(Condition::new(".[").is_err() && Condition::new("idel").is_err());
        assert!(Condition::new("27010").is_err() && Condition::new("true").is_err(), "always true");
    }

    #[test]
    fn reports_an_unknown_key() {
        let status = json!({ "data": { "running": false, "position": null } });
        let never = |condition: &str| Condition::new(condition).unwrap().check_keys(&status);
        let message = never(".data.executing == false").unwrap();
        assert!(message.contains(".data.executing") && message.contains("running"), "{message}");
        assert_eq!(never(".data.running == false"), None);
        assert_eq!(never(".data.position.x_mm > 5"), None, "it may come");
        assert_eq!(
            never(".data.alarms[0].code?"),
            Some(never(".data.alarms").unwrap().replace(".data.alarms'", ".data.alarms[0].code?'"))
        );
        assert_eq!(
            never("idle"),
            Some(
                "'idle': the key .data.held does not exist, so this condition may never be true; available keys: \
                 running, position"
                    .to_owned()
            )
        );
        let told = never("servo_on=true").unwrap();
        assert!(told.contains("keys: running, position. `armctl wait 'servo_on=true'`"), "{told}");
        assert_eq!(never("running=true"), None);
        let items = json!({ "data": { "items": [{ "name": "#27010", "label": "clamp", "value": false }] } });
        assert_eq!(Condition::new("clamp=on").unwrap().check_keys(&items), None, "an item");
    }

    #[test]
    fn compares_items_in_every_spelling() {
        let report =
            |ok: bool, value: Value| json!({ "data": { "items": [{ "name": "CN05", "ok": ok, "value": value }] } });
        let holds = |text: &str, report: &Value| {
            Condition::item_of_noun(text, &Comparison::parse(text).unwrap()).unwrap().is_met(report).unwrap()
        };
        assert!(holds("cn5=0", &report(true, json!(0))) && !holds("cn5=0", &report(true, json!(1))));
        assert!(holds("IN1.3=off", &report(true, json!(false))) && holds("IN1.3=0", &report(true, json!(false))));
        assert!(!holds("cn5<4", &report(false, Value::Null)), "not read");
        assert!(!holds("cn5<4", &json!({ "data": { "items": [] } })));
        assert!(Comparison::parse(".data.x=1").is_none() && Comparison::parse("idle").is_none());
        for name in ["#27010", "27010"] {
            assert_eq!(Comparison::parse(&format!("{name}=on")).map(|it| it.name.to_owned()).as_deref(), Some(name));
        }
    }
}

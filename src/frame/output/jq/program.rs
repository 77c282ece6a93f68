//! Compiler and interpreter for filters. They adapt the library `jaq` where it differs from jq.

use std::cell::RefCell;

use jaq_core::load::lex::StrPart;
use jaq_core::load::parse::{BinaryOp, Def, Pattern, Term};
use jaq_core::load::{Arena, File, Loader, parse};
use jaq_core::native::v;
use jaq_core::path::{Opt, Part, Path};
use jaq_core::{Compiler, Ctx, Cv, Exn, Native, ValXs, Vars, data};
use jaq_json::{Num, Val};
use serde_json::{Map, Number, Value};

/// Definitions of jq functions that the library does not have.
const DEFS: &str = r#"
def row(f): if isarray then . else error("\(type) is not a row: use an array") end
  | map(if . == null then "" elif isstring then f elif isarray or isobject then error("\(type) cannot be a cell of a row")
        else tostring end);
def @csv: row("\"" + gsub("\""; "\"\"") + "\"") | join(",");
def @tsv: row(gsub("\\\\"; "\\\\") | gsub("\t"; "\\t") | gsub("\n"; "\\n") | gsub("\r"; "\\r")) | join("\t");
def halt_error($exit_code): __told, halt($exit_code);
def halt_error: halt_error(5);
def __at($key): if isobject and ($key | isstring | not) then error("cannot index object with \($key | type)")
  else .[$key] end;
"#;
/// Names of three definitions: the filter, the input of the filter within paths, and the function for keys that may not
/// be text.
const FILTER: &str = "__filter";
const INPUT: &str = "$__input";
const AT: &str = "__at";
/// Maximum nesting depth of outputs. JSON parsers have such limits.
const MAX_DEPTH: usize = 120;
/// Maximum length of error texts, because some error texts contain the whole input.
const MAX_ERROR_LENGTH: usize = 400;

thread_local! {
    /// Input that `halt_error` received.
    static HALT_MESSAGE: RefCell<Option<Val>> = const { RefCell::new(None) };
}

/// Stores the input of `halt_error`. The function has no output.
fn set_halt_message(cv: Cv<'_, data::JustLut<Val>>) -> ValXs<'_, Val> {
    HALT_MESSAGE.set(Some(cv.1));
    Box::new(std::iter::empty())
}

/// Reason why a filter ended early.
#[derive(Debug, PartialEq, Eq)]
pub enum Stop {
    /// The filter failed with this error.
    Failed(String),
    /// The filter called `halt` or `halt_error`.
    Halted {
        /// Exit code. The default is 5.
        exit: u8,
        /// Text to print.
        text: String,
    },
}

impl From<String> for Stop {
    fn from(why: String) -> Self {
        Self::Failed(why)
    }
}

/// A compiled filter.
pub struct Program(jaq_core::Filter<data::JustLut<Val>>);

impl Program {
    /// Compiles a filter. The error is a text for the user.
    pub fn new(text: &str) -> Result<Self, String> {
        let definitions = parse(DEFS, |parser| parser.defs()).ok_or("the definitions cannot be parsed")?;
        let body = parse(text, |parser| parser.term()).ok_or("it cannot be parsed")?;
        let filter = Def { name: FILTER, args: Vec::new(), body: format_like_jq(body) };
        let known = jaq_core::defs().chain(jaq_std::defs()).chain(jaq_json::defs()).chain(definitions);
        let defs = known.map(shorten_to).chain([filter]);
        let funs = jaq_core::funs().chain(jaq_std::funs()).chain(jaq_json::funs());
        let funs = funs.chain([("__told", v(0), Native::<data::JustLut<Val>>::new(set_halt_message))]);
        let arena = Arena::default();
        let modules = Loader::new(defs).load(&arena, File { code: FILTER, path: () });
        let modules = modules.map_err(|_| "it cannot be parsed")?;
        let program = Compiler::default().with_funs(funs).compile(modules).map_err(|errors| {
            let name = errors.iter().flat_map(|(_, errors)| errors).map(|(name, _)| *name).next();
            format!("'{}' is not defined", name.unwrap_or("something"))
        })?;
        Ok(Self(program))
    }

    /// Runs the filter. Passes every output to `take` until `take` returns `false` or an error occurs.
    pub fn run(&self, input: Val, mut take: impl FnMut(Value) -> bool) -> Result<(), Stop> {
        HALT_MESSAGE.set(None);
        let context = Ctx::<data::JustLut<Val>>::new(&self.0.lut, Vars::new([]));
        for result in self.0.id.run((context, input)) {
            let value = match result {
                Ok(value) => value,
                Err(error) => {
                    return match error.get_err() {
                        Ok(error) => Err(Stop::Failed(shorten(&error_text(error)))),
                        // Only `halt` and `halt_error` produce this result.
                        Err(halt) => halted(halt),
                    };
                }
            };
            if !take(json(&value, 0)?) {
                break;
            }
        }
        Ok(())
    }
}

/// Result of `halt` and `halt_error`.
fn halted(halt: Exn<'_, Val>) -> Result<(), Stop> {
    let code = halt.get_halt().unwrap_or(5);
    let text = match HALT_MESSAGE.take() {
        None if code == 0 => return Ok(()),
        None | Some(Val::Null) => String::new(),
        Some(Val::TStr(text)) => String::from_utf8_lossy(&text).into_owned(),
        Some(other) => format!("{}\n", json(&other, 0).map_err(Stop::Failed)?),
    };
    // The operating system uses only the lowest eight bits of an exit code.
    Err(Stop::Halted { exit: code.to_le_bytes()[0], text })
}

/// Shortens the lifetime of a definition.
fn shorten_to<'s>(def: Def<&'static str>) -> Def<&'s str> {
    def
}

/// Returns the text of an error as jq would print it. An error that the filter raises can be any value.
fn error_text(error: jaq_core::Error<Val>) -> String {
    match error.into_val() {
        Val::TStr(text) => jq_error_text(&String::from_utf8_lossy(&text)),
        other => format!("(not a string): {other}"),
    }
}

/// Converts the most common error texts of the library to the error texts of jq.
fn jq_error_text(text: &str) -> String {
    let kind = |value: &str| match value.as_bytes().first() {
        Some(b'{') => "object",
        Some(b'[') => "array",
        Some(b'"') => "string",
        Some(b't' | b'f') => "boolean",
        Some(b'n') => "null",
        _ => "number",
    };
    if let Some((value, key)) = text.strip_prefix("cannot index ").and_then(|rest| rest.rsplit_once(" with ")) {
        let value = if ["object", "array"].contains(&value) { value } else { kind(value) };
        return format!("Cannot index {value} with {key}");
    }
    if let Some((value, _)) = text.strip_prefix("cannot use ").and_then(|rest| rest.rsplit_once(" as iterable")) {
        return format!("Cannot iterate over {} ({value})", kind(value));
    }
    text.to_owned()
}

fn shorten(text: &str) -> String {
    match text.char_indices().nth(MAX_ERROR_LENGTH) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Converts a value to JSON. A number that JSON does not support is written like in jq.
fn json(value: &Val, depth: usize) -> Result<Value, String> {
    if depth > MAX_DEPTH {
        return Err(format!("it makes a value with more than {MAX_DEPTH} levels"));
    }
    Ok(match value {
        Val::Null => Value::Null,
        Val::Bool(value) => Value::Bool(*value),
        Val::Num(number) => self::number(number),
        Val::TStr(text) | Val::BStr(text) => Value::String(String::from_utf8_lossy(text).into_owned()),
        Val::Arr(items) => Value::Array(items.iter().map(|item| json(item, depth + 1)).collect::<Result<_, _>>()?),
        Val::Obj(entries) => {
            let entry = |(key, value): (&Val, &Val)| match key {
                Val::TStr(key) => Ok((String::from_utf8_lossy(key).into_owned(), json(value, depth + 1)?)),
                _ => Err("it makes an object with a key that is not a string".to_owned()),
            };
            Value::Object(entries.iter().map(entry).collect::<Result<Map<_, _>, _>>()?)
        }
    })
}

fn number(number: &Num) -> Value {
    let float = match number {
        Num::Int(value) => return Value::from(*value),
        Num::Float(value) => *value,
        Num::BigInt(value) => return long(&value.to_string()),
        Num::Dec(text) => return long(text),
    };
    if float.is_nan() {
        return Value::Null;
    }
    Number::from_f64(float.clamp(f64::MIN, f64::MAX)).map_or(Value::Null, Value::Number)
}

/// Converts a number to a JSON number. Numbers that are not 64-bit integers become floating-point numbers.
fn long(text: &str) -> Value {
    let whole = text.parse::<u64>().map(Number::from).or_else(|_| text.parse::<i64>().map(Number::from));
    match whole {
        Ok(whole) => Value::Number(whole),
        Err(_) => number(&Num::Float(text.parse().unwrap_or(f64::NAN))),
    }
}

/// Rewrites a filter so that it is an error to index an object with a key that is not text, as in jq. The library
/// accepts such keys and finds nothing.
fn format_like_jq<'s>(term: Term<&'s str>) -> Term<&'s str> {
    let one = |term: Box<Term<&'s str>>| Box::new(format_like_jq(*term));
    let all = |terms: Vec<Term<&'s str>>| terms.into_iter().map(format_like_jq).collect();
    match term {
        Term::Id | Term::Recurse | Term::Num(_) | Term::Break(_) | Term::Var(_) => term,
        Term::Str(format, parts) => {
            let part = |part| match part {
                StrPart::Term(term) => StrPart::Term(format_like_jq(term)),
                part => part,
            };
            Term::Str(format, parts.into_iter().map(part).collect())
        }
        Term::Arr(inner) => Term::Arr(inner.map(one)),
        Term::Obj(entries) => {
            let entry = |(key, value): (_, Option<_>)| (format_like_jq(key), value.map(format_like_jq));
            Term::Obj(entries.into_iter().map(entry).collect())
        }
        Term::Neg(inner) => Term::Neg(one(inner)),
        Term::BinOp(left, operator, right) => Term::BinOp(one(left), bound_variables(operator), one(right)),
        Term::Label(name, inner) => Term::Label(name, one(inner)),
        Term::Fold(name, source, pattern, rest) => Term::Fold(name, one(source), format_pattern(pattern), all(rest)),
        Term::TryCatch(inner, catch) => Term::TryCatch(one(inner), catch.map(one)),
        Term::IfThenElse(cases, otherwise) => {
            let cases = cases.into_iter().map(|(when, then)| (format_like_jq(when), format_like_jq(then)));
            Term::IfThenElse(cases.collect(), otherwise.map(one))
        }
        Term::Def(defs, inner) => {
            let def = |def: Def<_, _>| Def { body: format_like_jq(def.body), ..def };
            Term::Def(defs.into_iter().map(def).collect(), one(inner))
        }
        Term::Call(name, arguments) => Term::Call(name, all(arguments)),
        Term::Path(from, Path(parts)) => path(format_like_jq(*from), parts),
    }
}

fn bound_variables(operator: BinaryOp<&str>) -> BinaryOp<&str> {
    match operator {
        BinaryOp::Pipe(Some(pattern)) => BinaryOp::Pipe(Some(format_pattern(pattern))),
        operator => operator,
    }
}

fn format_pattern(pattern: Pattern<&str>) -> Pattern<&str> {
    match pattern {
        Pattern::Var(name) => Pattern::Var(name),
        Pattern::Arr(inner) => Pattern::Arr(inner.into_iter().map(format_pattern).collect()),
        Pattern::Obj(entries) => {
            let entry = |(key, pattern)| (format_like_jq(key), format_pattern(pattern));
            Pattern::Obj(entries.into_iter().map(entry).collect())
        }
    }
}

/// Rewrites `FROM[KEY]…` with a key that may not be text to `. as $__input | FROM | __at($__input | KEY) | …`. The keys
/// are evaluated on the input of the whole path.
fn path<'s>(from: Term<&'s str>, parts: Vec<(Part<Term<&'s str>>, Opt)>) -> Term<&'s str> {
    let is_text = |(part, _): &(Part<Term<_>>, _)| !matches!(part, Part::Index(key) if !matches!(key, Term::Str(..)));
    if parts.iter().all(is_text) {
        let inner = |(part, opt)| match part {
            Part::Index(key) => (Part::Index(format_like_jq(key)), opt),
            Part::Range(start, end) => (Part::Range(start.map(format_like_jq), end.map(format_like_jq)), opt),
        };
        return Term::Path(Box::new(from), Path(parts.into_iter().map(inner).collect()));
    }
    let pipe = |left, pattern, right| Term::BinOp(Box::new(left), BinaryOp::Pipe(pattern), Box::new(right));
    let of_input = |term| pipe(Term::Var(INPUT), None, format_like_jq(term));
    let steps = parts.into_iter().fold(from, |steps, (part, opt)| {
        let step = match part {
            Part::Index(key) => {
                let found = Term::Call(AT, vec![of_input(key)]);
                if matches!(opt, Opt::Optional) { Term::TryCatch(Box::new(found), None) } else { found }
            }
            Part::Range(start, end) => {
                let range = Part::Range(start.map(of_input), end.map(of_input));
                Term::Path(Box::new(Term::Id), Path(vec![(range, opt)]))
            }
        };
        pipe(steps, None, step)
    });
    pipe(Term::Id, Some(Pattern::Var(INPUT)), steps)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    fn outputs(filter: &str, input: &Value) -> Result<Vec<Value>, String> {
        match stop_of(filter, input)? {
            (values, None) => Ok(values),
            (_, Some(Stop::Failed(why))) => Err(why),
            (_, Some(Stop::Halted { text, .. })) => Err(text),
        }
    }

    fn stop_of(filter: &str, input: &Value) -> Result<(Vec<Value>, Option<Stop>), String> {
        let mut values = Vec::new();
        let input: Val = serde_json::from_value(input.clone()).unwrap();
        let end = Program::new(filter)?.run(input, |value| {
            values.push(value);
            true
        });
        Ok((values, end.err()))
    }

    #[test]
    fn non_string_key_is_an_error() {
        let input = json!({"a": [1, 2, {"b": 3}], "i": 1, "k": "i"});
        for filter in [".[0]", ".[.i]", ".a[2][0]", "[.[0]]", ".a | map(.[0]?) | .[2] | .x[0], {} | .[0]", ".[0] = 1"] {
            assert!(outputs(filter, &input).is_err(), "{filter}: {:?}", outputs(filter, &input));
        }
        assert_eq!(outputs(".[0]", &input).unwrap_err(), "Cannot index object with number");
        assert_eq!(outputs(".[null]", &input).unwrap_err(), "Cannot index object with null");
        for (filter, expected) in [
            (".a[0]", json!([1])),
            (".a[.i]", json!([2])),
            (".[.k]", json!([1])),
            (".a[-1].b", json!([3])),
            (".a[0, 1]", json!([1, 2])),
            (".a[1:][0]", json!([2])),
            ("[.[0]?]", json!([[]])),
            (".a[.a[0]]", json!([2])),
            ("[.a[2][]]", json!([[3]])),
            ("(.a[0] |= . + 4) | .a[0]", json!([5])),
            ("[paths(type == \"number\")] | length", json!([4])),
            ("path(.a[.i])", json!([["a", 1]])),
            (".nothing[0]", json!([null])),
            ("reduce .a[0] as $x (0; . + $x)", json!([1])),
            ("\"\\(.a[0])\"", json!(["1"])),
            ("def f: .[0]; .a | f", json!([1])),
            ("[.a[:2][]]", json!([[1, 2]])),
        ] {
            assert_eq!(json!(outputs(filter, &input).unwrap()), expected, "{filter}");
        }
    }

    #[test]
    fn writes_non_json_numbers_like_jq() {
        let made = |filter: &str| serde_json::to_string(&outputs(filter, &Value::Null).unwrap()).unwrap();
        assert_eq!(made("nan, infinite, -infinite"), "[null,1.7976931348623157e+308,-1.7976931348623157e+308]");
        assert_eq!(
            made("[nan], 18446744073709551615, 1e1000"),
            "[[null],18446744073709551615,1.7976931348623157e+308]"
        );
        assert_eq!(made("1, 2.5, -3"), "[1,2.5,-3]");
    }

    #[test]
    fn too_deep_nesting_is_an_error() {
        let deep = |levels: usize| outputs(&format!("reduce range({levels}) as $i (0; [.])"), &Value::Null);
        assert!(deep(MAX_DEPTH).is_ok());
        assert!(deep(MAX_DEPTH + 1).unwrap_err().contains(" levels"));
    }

    #[test]
    fn does_not_compute_unneeded_outputs() {
        let mut count = 0;
        let endless = Program::new("repeat(1)").unwrap();
        endless
            .run(Val::Null, |_| {
                count += 1;
                count < 10
            })
            .unwrap();
        assert_eq!(count, 10);
        assert_eq!(outputs("1, halt, 2", &Value::Null).unwrap(), [json!(1)]);
    }

    /// Compares outputs and exit code with jq, if jq is installed.
    #[test]
    fn filters_match_jq() {
        use std::io::Write as _;
        use std::process::{Command, Stdio};

        const FILTERS: [&str; 40] = [
            ".",
            ".a",
            ".s",
            ".l[]",
            ".l[1:]",
            ".o.x",
            ".nothing",
            ".a.b",
            ".[0]",
            ".a[]",
            ".l.x",
            ".s.x",
            ".a | keys",
            "error(\"x\")",
            "error({a: 1})",
            "1, error(\"x\"), 2",
            "try error(\"x\") catch .",
            "nan",
            "[nan]",
            "infinite",
            "halt",
            "1, halt, 2",
            "halt_error",
            "\"bye\\n\" | halt_error",
            "\"bye\" | halt_error",
            "{a: 1} | halt_error",
            "\"x\" | halt_error(3)",
            "null | halt_error",
            "{} + 1",
            "empty",
            "null",
            "false",
            ".l | add",
            ".l | @csv",
            ".l | map(. * 2)",
            "[.l[] | select(. > 1)]",
            ".o | to_entries",
            ".l | tojson",
            "\"\\(.a)\"",
            "[.[]?] | length",
        ];
        let input = json!({"a": 1, "s": "text", "l": [1, 2, 3], "o": {"x": true}});
        for filter in FILTERS {
            let jq = Command::new("jq")
                .args(["-c", filter])
                .stdin(Stdio::piped())
                .stdout(Stdio::piped())
                .stderr(Stdio::piped())
                .spawn();
            let Ok(mut jq) = jq else {
                eprintln!("not compared: there is no jq here");
                return;
            };
            jq.stdin.take().unwrap().write_all(input.to_string().as_bytes()).unwrap();
            let jq_output = jq.wait_with_output().unwrap();
            let lines = String::from_utf8(jq_output.stdout).unwrap();
            let lines: Vec<Value> = lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
            let (values, stop) = stop_of(filter, &input).unwrap();
            assert_eq!(values, lines, "{filter}");
            let said = String::from_utf8(jq_output.stderr).unwrap();
            let (exit, text) = match stop {
                None => (0, String::new()),
                // Newer versions of jq have other error texts.
                Some(Stop::Failed(_)) => (5, said.clone()),
                Some(Stop::Halted { exit, text }) => (i32::from(exit), text),
            };
            assert_eq!((Some(exit), text), (jq_output.status.code(), said), "{filter}");
        }
    }

    #[test]
    fn common_errors_match_jq() {
        let input = json!({"a": 1, "l": []});
        for (filter, words) in [
            (".a.b", "Cannot index number with \"b\""),
            (".a[]", "Cannot iterate over number (1)"),
            ("error({a: 1})", "(not a string): {\"a\":1}"),
            ("error(\"x\")", "x"),
        ] {
            assert_eq!(outputs(filter, &input).unwrap_err(), words, "{filter}");
        }
    }

    #[test]
    fn limits_the_length_of_errors() {
        let long = "x".repeat(100_000);
        assert!(outputs("error", &json!(long)).unwrap_err().chars().count() < 500);
    }
}

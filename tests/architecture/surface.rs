//! Compares the public surface with that of the last release, which `docs/surface.txt` lists: commands with their
//! arguments, reports with their keys, exit codes. A change that breaks a script is named, and needs a new major
//! version (CONTRIBUTING, "Versions").
//!
//! A line of the file is a scope and its parts: `command armctl.stop --all`, `report diff same:integer`. After the
//! colon are the values of the part: constants in quotes, types of JSON, or the name of a `type` line. `required` and
//! `many` belong to arguments, `absent` to keys that a report can omit.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use armctl::command::about::schema::{self, SHARED};
use armctl_frame::failure::Kind;
use clap::CommandFactory as _;
use serde_json::Value;

use super::source::root;

/// Parts of a scope by name, each with its values.
type Parts = BTreeMap<String, BTreeSet<String>>;

#[test]
fn breaks_nothing_of_the_last_release() {
    let path = root().join("docs/surface.txt");
    let current = current();
    let blessed = std::env::var("ARMCTL_BLESS").ok();
    let released = match std::fs::read_to_string(&path) {
        Err(_) if blessed.is_some() => current.clone(),
        read => read.expect("docs/surface.txt is there"),
    };
    let Changes { breaking, additions } = Changes::between(&released, &current);
    let is_allowed = is_next_major(version(&released), version(&current)) || blessed.as_deref() == Some("breaking");
    assert!(
        breaking.is_empty() || is_allowed,
        "breaking, compared with release {}:\n{}\nKeep the old form, or set a new major version. If no release has it, run \
         `ARMCTL_BLESS=breaking cargo test --test architecture surface`.",
        version(&released),
        breaking.join("\n"),
    );
    if blessed.is_some() {
        std::fs::write(&path, current).expect("the file can be written");
    } else {
        assert!(
            released == current,
            "docs/surface.txt is not current; run `ARMCTL_BLESS=1 cargo test --test architecture`\nbreaking:\n{}\n\
             additions:\n{}",
            breaking.join("\n"),
            additions.join("\n"),
        );
    }
}

#[test]
fn names_what_breaks() {
    let old = "release 1.2.0\n\
               command armctl.stop --all --in:\"mm\"|\"pulse\" 1:many|value\n\
               command armctl.top\n\
               report stop ok:boolean mode:\"auto\"|\"manual\" at:Place\n\
               type Place x_mm:number y_mm:number\n\
               exit refused:\"3\"\n";
    let changes = |new: &[(&str, &str)]| {
        let new = new.iter().fold(old.to_owned(), |text, (from, to)| text.replace(from, to));
        let Changes { breaking, additions } = Changes::between(old, &new);
        (breaking.join("; "), additions.join("; "))
    };
    let breaks = |from: &str, to: &str| changes(&[(from, to)]).0;
    let adds = |from: &str, to: &str| {
        let (breaking, additions) = changes(&[(from, to)]);
        assert_eq!(breaking, "", "{from:?} -> {to:?}");
        additions
    };
    assert_eq!(breaks("command armctl.top\n", ""), "command armctl top is gone");
    assert_eq!(breaks(" --all", ""), "command armctl stop: --all is gone");
    assert_eq!(breaks("|\"pulse\"", ""), "command armctl stop: --in no longer takes \"pulse\"");
    assert_eq!(breaks("1:many|value", "1:value"), "command armctl stop: 1 no longer takes many");
    assert_eq!(breaks("1:many", "1:required|many"), "command armctl stop: 1 is now required");
    assert_eq!(breaks("--all", "--all --for:required|value"), "command armctl stop: --for is now required");
    assert_eq!(breaks("ok:boolean", "done:boolean"), "report stop: ok is gone");
    assert_eq!(breaks("ok:boolean", "ok:boolean|null"), "report stop: ok can now be null");
    assert_eq!(breaks("\"auto\"|", ""), "report stop: mode is no longer \"auto\"");
    assert_eq!(breaks(" y_mm:number", ""), "report stop: at.y_mm is gone");
    assert_eq!(breaks("\"3\"", "\"4\""), "exit: refused is no longer \"3\"");
    assert_eq!(
        adds("command armctl.top", "command armctl.top --all\ncommand armctl.wait"),
        "command armctl top: --all; command armctl wait"
    );
    assert_eq!(adds("\"pulse\"", "\"pulse\"|\"inch\""), "command armctl stop: --in takes \"inch\"");
    assert_eq!(adds("\"manual\"", "\"manual\"|\"step\""), "report stop: mode can be \"step\"");
    assert_eq!(adds("y_mm:number", "y_mm:number z_mm:number"), "report stop: at.z_mm");
    // A type of the file is no promise, only what it contains.
    assert_eq!(changes(&[("Place", "Position")]), (String::new(), String::new()));
}

#[test]
fn breaking_changes_need_a_new_major_version() {
    assert!(is_next_major("1.4.2", "2.0.0") && is_next_major("0.1.0", "0.2.0") && is_next_major("0.9.0", "1.0.0"));
    assert!(!is_next_major("1.4.2", "1.5.0") && !is_next_major("0.1.0", "0.1.1") && !is_next_major("1.0.0", "1.0.0"));
}

/// Differences between two surfaces, as text.
struct Changes {
    breaking: Vec<String>,
    additions: Vec<String>,
}

impl Changes {
    fn between(old: &str, new: &str) -> Self {
        let (old, new) = (parse(old), parse(new));
        let mut changes = Self { breaking: Vec::new(), additions: Vec::new() };
        for (scope, parts) in &old {
            match new.get(scope) {
                Some(now) => changes.compare(scope, parts, now),
                None => changes.breaking.push(format!("{scope} is gone")),
            }
        }
        let added = new.keys().filter(|scope| !old.contains_key(*scope));
        changes.additions.extend(added.cloned());
        changes
    }

    fn compare(&mut self, scope: &str, old: &Parts, new: &Parts) {
        let is_input = scope.starts_with("command ");
        for (part, values) in old {
            let Some(now) = new.get(part) else {
                self.breaking.push(format!("{scope}: {part} is gone"));
                continue;
            };
            for lost in values.difference(now) {
                match lost.as_str() {
                    "required" => self.additions.push(format!("{scope}: {part} is optional")),
                    _ if is_input => self.breaking.push(format!("{scope}: {part} no longer takes {lost}")),
                    _ if is_constant(lost) => self.breaking.push(format!("{scope}: {part} is no longer {lost}")),
                    _ => self.additions.push(format!("{scope}: {part} is never {lost}")),
                }
            }
            for gained in now.difference(values) {
                match gained.as_str() {
                    "required" => self.breaking.push(format!("{scope}: {part} is now required")),
                    _ if is_input => self.additions.push(format!("{scope}: {part} takes {gained}")),
                    _ if is_constant(gained) => self.additions.push(format!("{scope}: {part} can be {gained}")),
                    _ => self.breaking.push(format!("{scope}: {part} can now be {gained}")),
                }
            }
        }
        for (part, values) in new.iter().filter(|(part, _)| !old.contains_key(*part)) {
            if values.contains("required") {
                self.breaking.push(format!("{scope}: {part} is now required"));
            } else {
                self.additions.push(format!("{scope}: {part}"));
            }
        }
    }
}

fn is_constant(value: &str) -> bool {
    value.starts_with('"')
}

/// Whether a change between these versions may break: the first number is another, or the second one before 1.0.
pub fn is_next_major(old: &str, new: &str) -> bool {
    let numbers = |version: &str| -> Vec<u64> { version.split('.').filter_map(|number| number.parse().ok()).collect() };
    let (old, new) = (numbers(old), numbers(new));
    let count = if old.first() == Some(&0) { 2 } else { 1 };
    new.iter().take(count).gt(old.iter().take(count))
}

/// Version in the first line of a surface.
pub fn version(surface: &str) -> &str {
    surface.lines().find_map(|line| line.strip_prefix("release ")).unwrap_or("0.0.0")
}

/// Scopes of a surface, by name. Names of types are replaced by what the types contain.
fn parse(surface: &str) -> BTreeMap<String, Parts> {
    let mut types = BTreeMap::new();
    let mut scopes = BTreeMap::new();
    for line in surface.lines() {
        let mut words = line.split(' ');
        let kind = words.next().unwrap_or_default();
        let name = if kind == "exit" { "" } else { words.next().unwrap_or_default() };
        let parts: Parts = words.map(parse_part).collect();
        match kind {
            "release" => {}
            "type" => drop(types.insert(name.to_owned(), parts)),
            _ => drop(scopes.insert(format!("{kind} {}", name.replace('.', " ")).trim_end().to_owned(), parts)),
        }
    }
    scopes.into_iter().map(|(scope, parts)| (scope, expand(&parts, &types, &mut Vec::new()))).collect()
}

fn parse_part(word: &str) -> (String, BTreeSet<String>) {
    let (name, values) = word.split_once(':').unwrap_or((word, ""));
    (name.to_owned(), values.split('|').filter(|value| !value.is_empty()).map(ToOwned::to_owned).collect())
}

/// Replaces the names of types. `open` has the types that are being replaced: a type can contain itself.
fn expand<'a>(parts: &'a Parts, types: &'a BTreeMap<String, Parts>, open: &mut Vec<&'a str>) -> Parts {
    let mut all = Parts::new();
    for (name, values) in parts {
        all.entry(name.clone()).or_default();
        for value in values {
            let Some((value, inner)) = types.get_key_value(value) else {
                all.entry(name.clone()).or_default().insert(value.clone());
                continue;
            };
            if open.contains(&value.as_str()) {
                continue;
            }
            open.push(value);
            for (part, values) in expand(inner, types, open) {
                all.entry(join(name, &part)).or_default().extend(values);
            }
            open.pop();
        }
    }
    all
}

/// Path of a part in a part.
fn join(path: &str, part: &str) -> String {
    let separator = if path.is_empty() || part.is_empty() || part.starts_with('[') { "" } else { "." };
    format!("{path}{separator}{part}")
}

/// The surface of this program.
fn current() -> String {
    let mut text = format!("release {}\n", env!("CARGO_PKG_VERSION"));
    let exits = Kind::TABLE.iter().map(|(kind, code, _)| (quoted(&serde_json::json!(kind)).replace('"', ""), code));
    write_line(&mut text, "exit", &exits.map(|(kind, code)| (kind, [format!("\"{code}\"")].into())).collect());
    write_command(&mut text, &armctl::cli::Cli::command(), "armctl");
    let mut files = schema::files();
    let shared = files.remove(SHARED).expect("there are common definitions");
    for (name, definition) in shared["$defs"].as_object().expect("definitions have names") {
        let mut parts = Parts::new();
        flatten(definition, &Value::Null, "", &mut parts, &mut Vec::new());
        write_line(&mut text, &format!("type {name}"), &parts);
    }
    for (file, schema) in &files {
        let mut parts = Parts::new();
        flatten(schema, &schema["$defs"], "", &mut parts, &mut Vec::new());
        write_line(&mut text, &format!("report {}", file.trim_end_matches(".json")), &parts);
    }
    text
}

fn write_line(text: &mut String, scope: &str, parts: &Parts) {
    text.push_str(scope);
    for (name, values) in parts {
        assert!(!values.iter().chain([name]).any(|word| word.contains([' ', '\n'])), "{scope}: {name}: {values:?}");
        let values: Vec<&str> = values.iter().map(String::as_str).collect();
        let colon = if values.is_empty() { "" } else { ":" };
        write!(text, " {name}{colon}{}", values.join("|")).expect("a string takes all");
    }
    text.push('\n');
}

/// A line for a command, and for each command below it.
fn write_command(text: &mut String, command: &clap::Command, words: &str) {
    let aliases = command.get_all_aliases().map(|alias| (format!("={alias}"), BTreeSet::new()));
    let arguments = command.get_arguments().filter(|argument| !argument.is_hide_set() && !argument.is_positional());
    let arguments =
        arguments.flat_map(|argument| names(argument).into_iter().map(move |name| (name, values(argument))));
    let positional =
        command.get_positionals().zip(1..).map(|(argument, number)| (format!("{number}"), values(argument)));
    let parts = aliases.chain(arguments).chain(positional).collect();
    write_line(text, &format!("command {words}"), &parts);
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set()) {
        write_command(text, sub, &format!("{words}.{}", sub.get_name()));
    }
}

/// Every form of a flag, and its environment variable.
fn names(argument: &clap::Arg) -> Vec<String> {
    let longs = argument.get_long().into_iter().chain(argument.get_all_aliases().unwrap_or_default());
    let shorts = argument.get_short().into_iter().chain(argument.get_all_short_aliases().unwrap_or_default());
    let variable = argument.get_env().map(|name| format!("${}", name.to_string_lossy()));
    let flags = longs.map(|long| format!("--{long}")).chain(shorts.map(|short| format!("-{short}")));
    flags.chain(variable).collect()
}

/// What an argument takes.
fn values(argument: &clap::Arg) -> BTreeSet<String> {
    let mut values = BTreeSet::new();
    if argument.get_action().takes_values() {
        let constants = argument.get_possible_values();
        values.extend(constants.iter().map(|value| format!("\"{}\"", value.get_name())));
        if values.is_empty() {
            values.insert("value".to_owned());
        }
        let is_list = matches!(argument.get_action(), clap::ArgAction::Append);
        if is_list || argument.get_num_args().is_some_and(|count| count.max_values() > 1) {
            values.insert("many".to_owned());
        }
    }
    if argument.is_required_set() {
        values.insert("required".to_owned());
    }
    values
}

/// Collects the keys of a schema with their types. `open` has the definitions that are being read.
fn flatten<'a>(schema: &'a Value, local: &'a Value, path: &str, parts: &mut Parts, open: &mut Vec<&'a str>) {
    let mut add = |value: &str| {
        parts.entry(path.to_owned()).or_default().insert(value.to_owned());
    };
    if schema.as_bool() == Some(true) {
        add("any");
    }
    if let Some(name) = schema["$ref"].as_str().and_then(|reference| reference.rsplit('/').next()) {
        match local.get(name) {
            // What is not here is shared.
            None => add(name),
            Some(_) if open.contains(&name) => add("any"),
            Some(definition) => {
                open.push(name);
                flatten(definition, local, path, parts, open);
                open.pop();
            }
        }
        return;
    }
    if let Some(constant) = schema.get("const") {
        add(&quoted(constant));
        return;
    }
    if let Some(constants) = schema["enum"].as_array() {
        for constant in constants {
            add(&quoted(constant));
        }
        return;
    }
    let types = schema["type"].as_array().into_iter().flatten().chain(Some(&schema["type"]));
    let has_content = ["properties", "additionalProperties", "items", "anyOf", "oneOf", "allOf"];
    let has_content = has_content.iter().any(|key| schema.get(*key).is_some());
    for name in types.filter_map(Value::as_str).filter(|name| !has_content || !["object", "array"].contains(name)) {
        add(name);
    }
    if schema.get("type").is_none() && !has_content && schema.get("if").is_none() {
        add("any");
    }
    for variant in ["anyOf", "oneOf", "allOf"].iter().filter_map(|key| schema[key].as_array()).flatten() {
        flatten(variant, local, path, parts, open);
    }
    if let Some(items) = schema.get("items") {
        flatten(items, local, &format!("{path}[]"), parts, open);
    }
    if let Some(values) = schema.get("additionalProperties").filter(|values| values.as_bool() != Some(false)) {
        flatten(values, local, &join(path, "*"), parts, open);
    }
    let required: Vec<&str> = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
    for (key, value) in schema["properties"].as_object().into_iter().flatten() {
        let path = join(path, key);
        if !required.contains(&key.as_str()) {
            parts.entry(path.clone()).or_default().insert("absent".to_owned());
        }
        flatten(value, local, &path, parts, open);
    }
}

/// A constant of a schema in quotes.
fn quoted(constant: &Value) -> String {
    format!("\"{}\"", constant.as_str().map_or_else(|| constant.to_string(), ToOwned::to_owned))
}

//! `armctl schema ID`: the JSON Schema of a report.

use serde_json::Map;

use super::wireshark::WrittenDissectors;
use crate::command::families::FAMILIES;
use crate::command::fleet::report::Packed;
use crate::command::fleet::status::{Fleet, Overview};
use crate::command::fleet::{cell, common, names, record, rehearsal, robots, session, tools, wait};
#[cfg(feature = "plant")]
use crate::command::fleet::{metrics, publish};
use armctl_frame::background::Opened;
use armctl_frame::backup::check::Checked;
use armctl_frame::backup::family_backup::{Backup, Diff, Restore};
use armctl_frame::dry_run::DryRun;
use armctl_frame::output::envelope::{Envelope, ErrorBody};
use armctl_frame::prelude::*;
use armctl_frame::{CommandSet as _, SchemaEntry};

/// Print the JSON Schema of `data` in the envelope, or the names of all reports.
///
/// Three schemas belong to all commands: `envelope` (the output of `--json`), `failure` (the `error` of the envelope),
/// and `dry-run` (the data with --dry-run).
#[derive(Debug, Args)]
pub struct SchemaOf {
    /// Name of the report, such as yerc.status [default: list all names]
    #[arg(add = ValueKind::Schema)]
    id: Option<String>,
}

impl SchemaOf {
    /// Prints the schema.
    pub fn run(self, run: &Run) -> Result<()> {
        let all = all();
        let Some(id) = self.id else {
            let names: String = all.iter().map(|entry| format!("{}\n", entry.id)).collect();
            return run.screen.data(&names);
        };
        let Some(entry) = all.iter().find(|entry| entry.id == id) else {
            let failure = Failure::usage(format!("unknown report '{id}'"));
            return Err(match nearest(&id, all.iter().map(|entry| entry.id)) {
                Some(near) => failure.hint(format!("did you mean '{near}'?")),
                None => failure.hint("list the reports: `armctl schema`"),
            });
        };
        run.screen.json(&json!((entry.schema)()))
    }
}

/// Schemas of all reports, of the envelope, and of the failure and dry-run data of the envelope.
pub fn all() -> Vec<SchemaEntry> {
    let mut all: Vec<SchemaEntry> = FAMILIES.iter().flat_map(|face| (face.schemas)()).collect();
    all.extend(Overview::schemas());
    all.extend(common::schemas());
    all.push(wait::schema());
    all.extend(names::schemas());
    all.extend(Backup::<Fleet>::schemas());
    all.extend(Restore::<Fleet>::schemas());
    all.extend(Diff::<Fleet>::schemas());
    let mut others = tools::schemas();
    others.extend([
        SchemaEntry::of::<Checked>("backup.check"),
        SchemaEntry::of::<DryRun>("dry-run"),
        SchemaEntry::of::<Envelope>("envelope"),
        SchemaEntry::of::<ErrorBody>("failure"),
        SchemaEntry::of::<Packed>("report"),
        SchemaEntry::of::<robots::entry::Changed>("robots.add"),
        SchemaEntry::of::<robots::check::CheckReport>("robots.check"),
        SchemaEntry::of::<robots::discover::Discovered>("robots.discover"),
        SchemaEntry::of::<robots::entry::WasChosen>("robots.default"),
        SchemaEntry::of::<robots::edit::Edited>("robots.edit"),
        SchemaEntry::of::<robots::List>("robots.list"),
        SchemaEntry::of::<robots::edit::InventoryPath>("robots.path"),
        SchemaEntry::of::<robots::entry::Changed>("robots.remove"),
        SchemaEntry::of::<robots::entry::Renamed>("robots.rename"),
        SchemaEntry::of::<robots::entry::WasSet>("robots.set"),
        SchemaEntry::of::<robots::Shown>("robots.show"),
        #[cfg(feature = "plant")]
        SchemaEntry::of::<metrics::Listening>("serve.metrics"),
        cell::schema(),
        record::schema(),
        rehearsal::schema(),
        SchemaEntry::of::<session::Closed>("session.close"),
        SchemaEntry::of::<session::Sessions>("session.list"),
        SchemaEntry::of::<Opened>("session.open"),
        SchemaEntry::of::<robots::entry::Changed>("setup"),
        SchemaEntry::of::<WrittenDissectors>("wireshark"),
        SchemaEntry::of::<tools::Simulators>("sim"),
    ]);
    #[cfg(feature = "plant")]
    others.extend(publish::schemas());
    others.sort_unstable_by_key(|entry| entry.id);
    all.extend(others);
    all
}

/// Name of the file with the common definitions.
pub const SHARED: &str = "shared.json";

/// Name of the file that maps the name of each report to its schema.
pub const REPORTS: &str = "reports.json";

/// The schemas as files: one for each title, such as `items.json` for the items of any table, so that a change of a
/// concept changes one file. [`REPORTS`] maps the reports to them.
pub fn files() -> BTreeMap<String, Value> {
    let mut reports: BTreeMap<&str, Value> =
        all().into_iter().map(|entry| (entry.id, (entry.schema)().to_value())).collect();
    let shared = extract_shared(&mut reports);
    let mut variants: BTreeMap<String, Vec<(&str, Value)>> = BTreeMap::new();
    let mut index = BTreeMap::new();
    for (id, mut schema) in reports {
        let title = schema["title"].as_str().unwrap_or(id);
        let file = format!("{}.json", kebab_case(title));
        let known = variants.entry(file.clone()).or_default();
        let first = known.iter().find(|(_, other)| *other == schema).map(|(first, _)| *first);
        if first.is_none() {
            known.push((id, schema.take()));
        }
        index.insert(id, (file, first.unwrap_or(id)));
    }
    let has_one = |file: &str| variants[file].len() == 1;
    let index: Map<String, Value> = index
        .into_iter()
        .map(|(id, (file, first))| {
            let place = if has_one(&file) { file } else { format!("{file}{LOCAL}{first}") };
            (id.to_owned(), json!({ "$ref": place }))
        })
        .collect();
    let mut files: BTreeMap<String, Value> =
        variants.into_iter().map(|(file, variants)| (file, merge_variants(variants))).collect();
    files.insert(SHARED.to_owned(), shared);
    files.insert(REPORTS.to_owned(), Value::Object(index));
    files
}

/// Returns a single schema unchanged. Puts several schemas into one file as definitions. The name of a definition is
/// the id of the first report that uses it.
fn merge_variants(mut variants: Vec<(&str, Value)>) -> Value {
    if variants.len() == 1 {
        return variants.swap_remove(0).1;
    }
    let title = variants[0].1["title"].clone();
    let definitions: Map<String, Value> = variants
        .into_iter()
        .map(|(id, mut schema)| {
            map_references(&mut schema, &|path| Some(format!("{LOCAL}{id}/$defs/{}", path.strip_prefix(LOCAL)?)));
            if let Some(schema) = schema.as_object_mut() {
                schema.remove("$schema");
                schema.remove("title");
            }
            (id.to_owned(), schema)
        })
        .collect();
    json!({ "$schema": DIALECT, "title": title, "$defs": definitions })
}

/// `WrittenItems` as `written-items`.
fn kebab_case(title: &str) -> String {
    let mut name = String::new();
    for letter in title.chars() {
        if letter.is_uppercase() && !name.is_empty() {
            name.push('-');
        }
        name.extend(letter.to_lowercase());
    }
    name
}

/// Moves the definitions that several reports have in common into a schema of their own.
fn extract_shared(reports: &mut BTreeMap<&str, Value>) -> Value {
    let mut found: BTreeMap<String, Vec<Value>> = BTreeMap::new();
    for definitions in reports.values().filter_map(|schema| schema["$defs"].as_object()) {
        for (name, definition) in definitions {
            found.entry(name.clone()).or_default().push(definition.clone());
        }
    }
    // A name with different definitions in several schemas is not shared, and neither are definitions that refer to
    // such a name.
    found.retain(|_, definitions| definitions.len() > 1 && definitions.iter().all(|other| *other == definitions[0]));
    loop {
        let names: Vec<String> = found.keys().cloned().collect();
        found.retain(|_, definitions| references(&definitions[0]).iter().all(|name| names.contains(name)));
        if found.len() == names.len() {
            break;
        }
    }
    for schema in reports.values_mut() {
        if let Some(definitions) = schema.get_mut("$defs").and_then(Value::as_object_mut) {
            definitions.retain(|name, _| !found.contains_key(name));
            if definitions.is_empty() {
                schema.as_object_mut().and_then(|schema| schema.remove("$defs"));
            }
        }
        let is_shared = |path: &str| path.strip_prefix(LOCAL).is_some_and(|name| found.contains_key(name));
        map_references(schema, &|path| is_shared(path).then(|| format!("{SHARED}{path}")));
    }
    let definitions: Map<String, Value> =
        found.into_iter().map(|(name, mut same)| (name, same.swap_remove(0))).collect();
    json!({
        "$schema": DIALECT,
        "title": "Shared",
        "description": "Definitions that several reports use.",
        "$defs": definitions,
    })
}

/// Names of the definitions that a schema refers to.
fn references(schema: &Value) -> Vec<String> {
    match schema {
        Value::Object(fields) => {
            let own = fields.get("$ref").and_then(Value::as_str).and_then(|path| path.strip_prefix(LOCAL));
            own.map(ToOwned::to_owned).into_iter().chain(fields.values().flat_map(references)).collect()
        }
        Value::Array(items) => items.iter().flat_map(references).collect(),
        _ => Vec::new(),
    }
}

const DIALECT: &str = "https://json-schema.org/draft/2020-12/schema";

/// Prefix of a reference to a definition in the same schema.
const LOCAL: &str = "#/$defs/";

/// Replaces each reference for which `replace` returns another one.
fn map_references(schema: &mut Value, replace: &impl Fn(&str) -> Option<String>) {
    match schema {
        Value::Object(fields) => {
            if let Some(Value::String(path)) = fields.get_mut("$ref")
                && let Some(other) = replace(path)
            {
                *path = other;
            }
            fields.values_mut().for_each(|value| map_references(value, replace));
        }
        Value::Array(items) => items.iter_mut().for_each(|value| map_references(value, replace)),
        _ => {}
    }
}
